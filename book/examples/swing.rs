//! A bob on a string, and the way that it takes, seen from above: `cargo run --release > swing.svg`.

use lagrange_core::prelude::*;

/// A bob of mass `m` on a string of length `l`.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
#[constraint(string: x^2 + y^2 + z^2 = l^2)]
struct Bob {
    m: f64,
    g: f64,
    l: f64,
}

fn main() -> Result<(), Error> {
    let bob = Bob { m: 1.0, g: 9.81, l: 1.0 };
    let start = bob.state_from(&[("x", 0.6), ("z", -0.8), ("y_dot", 0.7)])?;
    let path = bob.integrate(start, 20.0, Dop853::default())?;
    let points: Vec<String> = path
        .samples(2000)
        .map(|sample| format!("{:.4},{:.4}", sample.state().q[0], -sample.state().q[1]))
        .collect();
    println!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="-0.7 -0.7 1.4 1.4" width="700" height="700">
<polyline points="{}" fill="none" stroke="steelblue" stroke-width="0.004"/>
</svg>"#,
        points.join(" ")
    );
    // The constraint force on the bob is λ ∂Φ/∂r = 2λ r.
    eprintln!("at the end the string pulls with {:.4} N", -2.0 * bob.l * path.end().multiplier("string")?);
    Ok(())
}
