//! The Lyapunov exponents of a double pendulum, from small swings to where it turns over.
//!
//! Of its four exponents two are zero (along the motion, and from one energy to the next) and the others opposite: in a
//! system of Hamilton's they come in pairs. The largest tells how fast neighbouring motions part, by e in a time 1/λ.
//! Small swings are nearly two normal modes, and λ goes to zero as ln t/t; large ones are chaos.

mod picture;

use lagrange_core::{linearized::LyapunovSpectrum, prelude::*};
use picture::{BLUE, GREY, Panel, Points, RED, Result};

#[derive(Clone, Lagrangian)]
#[coordinates(a, b)]
#[lagrangian(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b) + g*(2*cos(a) + cos(b)))]
struct DoublePendulum {
    g: f64,
}

const PENDULUM: DoublePendulum = DoublePendulum { g: 9.81 };
const END: f64 = 2000.0;

fn main() -> Result<()> {
    println!("{}", DoublePendulum::equations());
    println!("started at rest, both rods at the angle φ, for {END} s");
    println!("{:>6} {:>10} {:>10} {:>10} {:>10} {:>10}", "φ/°", "λ1 s", "± one σ", "λ2 s", "λ3 s", "λ4 s");
    let mut largest = Points::new();
    for degrees in (15..=165).step_by(15) {
        let spectrum = exponents(f64::from(degrees))?;
        let l = &spectrum.exponents;
        println!(
            "{degrees:6} {:10.5} {:10.5} {:10.5} {:10.5} {:10.5}",
            l[0], spectrum.errors[0], l[1], l[2], l[3]
        );
        largest.push((f64::from(degrees), l[0]));
    }
    let chaotic = exponents(120.0)?;
    let sums = [chaotic.exponents[0] + chaotic.exponents[3], chaotic.exponents[1] + chaotic.exponents[2]];
    println!(
        "\nat 120° the pairs sum to {:.1e} and {:.1e} of the largest",
        sums[0] / chaotic.exponents[0],
        sums[1] / chaotic.exponents[0]
    );
    let file = picture::path("lyapunov")?;
    draw(&largest, &chaotic, &file)?;
    println!("picture: {}", file.display());
    Ok(())
}

fn exponents(degrees: f64) -> Result<LyapunovSpectrum<f64>> {
    let start = State::at_rest([degrees.to_radians(); 2]);
    Ok(PENDULUM.lyapunov_spectrum(start, END, Dop853::default().max_steps(10_000_000))?)
}

fn draw(largest: &Points, chaotic: &LyapunovSpectrum<f64>, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 480))?;
    let panels = root.split_evenly((1, 2));
    let mut chart = Panel::new("The largest exponent", ["φ/°", "λ/(1/s)"]);
    chart.curve("λ", BLUE, largest);
    chart.specks(4, BLUE, largest.iter().copied());
    chart.draw(&panels[0])?;
    let curves: Vec<Points> =
        (0..4).map(|j| chaotic.running.iter().map(|(time, means)| (*time, means[j])).collect()).collect();
    let mut chart = Panel::new("All four at 120°, as they settle", ["t/s", "λ/(1/s)"]);
    for (curve, (name, color)) in curves.iter().zip([("λ₁", RED), ("λ₂", GREY), ("λ₃", GREY), ("λ₄", BLUE)])
    {
        chart.curve(name, color, curve);
    }
    chart.draw(&panels[1])?;
    root.present()?;
    Ok(())
}
