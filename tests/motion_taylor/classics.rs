//! Motions whose values are known.

use lagrange_core::prelude::*;
use lagrange_systems::{DoublePendulum, Planet};

use super::end;

/// e = 0.9, 300 times around.
#[test]
fn an_ellipse_closes() -> Result<(), Error> {
    let start = State::new([0.1, 0.0], [0.0, 19.0_f64.sqrt()]);
    let planet = Planet { mu: 1.0 };
    let path = planet.integrate(start, 600.0 * std::f64::consts::PI, Taylor::default())?;
    let state = *path.end().state();
    let energy = (planet.energy(&state) / planet.energy(&start) - 1.0).abs();
    let off = (state.q - start.q).norm();
    assert!(off < 2e-9 && energy < 2e-13, "{off:e} {energy:e}");
    Ok(())
}

/// From this start every fourth coefficient alone is not zero. Values of Taylor runs with 113 and 170 bits.
#[test]
fn a_double_pendulum_falls_from_the_horizontal() -> Result<(), Error> {
    let right = std::f64::consts::FRAC_PI_2;
    let double = DoublePendulum { m: [1.0; 2], l: [1.0; 2], g: 9.81 };
    let state = end(&double, State::at_rest([right; 2]), 10.0)?;
    let off = [(state.q[0] + 0.568_474_664_015_950_2).abs(), (state.q[1] + 0.526_393_727_932_404_7).abs()];
    assert!(off.iter().all(|off| *off < 1e-12), "{off:?}");
    // Looser tolerances have lower orders, and are not fooled either.
    for tolerance in [1e-6, 1e-9, 1e-12] {
        let path = double.integrate(State::at_rest([right; 2]), 10.0, Taylor::with_tolerance(tolerance))?;
        let off = (path.end().coordinate("a")? - state.q[0]).abs();
        assert!(off < 200.0 * tolerance, "{tolerance:e}: {off:e}");
    }
    Ok(())
}

#[derive(Lagrangian)]
#[coordinates(x, phi)]
#[lagrangian(m/2*x_dot^2 + m*a^2/5*phi_dot^2 + m*g*x*sin(alpha))]
#[constraint(no_slip: x_dot = a*phi_dot)]
struct Sphere {
    m: f64,
    a: f64,
    g: f64,
    alpha: f64,
}

/// Its series ends: one step, and exact.
#[test]
fn a_rolling_sphere_is_exact() -> Result<(), Error> {
    let sphere = Sphere { m: 1.0, a: 0.5, g: 9.81, alpha: 0.3 };
    let path = sphere.integrate(State::at_rest([0.0, 0.0]), 3.0, Taylor::default())?;
    let exact = 0.5 * 5.0 / 7.0 * 9.81 * 0.3_f64.sin() * 9.0;
    let x = path.end().coordinate("x")?;
    assert!((x - exact).abs() <= 2.0 * f64::EPSILON * exact, "{x} {exact}");
    assert_eq!(path.statistics().accepted, 1);
    Ok(())
}
