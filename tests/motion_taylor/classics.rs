//! Motions whose values are known.

use lagrange_core::prelude::*;

use super::end;

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 + 1/sqrt(x^2 + y^2))]
struct Kepler;

/// e = 0.9, 300 times around.
#[test]
fn an_ellipse_closes() -> Result<(), Error> {
    let start = State::new([0.1, 0.0], [0.0, 19.0_f64.sqrt()]);
    let method = Taylor::default();
    let path = Kepler.integrate(start, 600.0 * std::f64::consts::PI, method)?;
    let state = *path.end().state();
    let energy = (Kepler.energy(&state) / Kepler.energy(&start) - 1.0).abs();
    let off = (state.q - start.q).norm();
    println!("300 orbits: {off:e} off, energy {energy:e}, {} steps", path.statistics().accepted);
    assert!(off < 2e-9 && energy < 2e-13, "{off:e} {energy:e}");
    Ok(())
}

#[derive(Lagrangian)]
#[coordinates(a, b)]
#[lagrangian(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b) + 2*g*cos(a) + g*cos(b))]
struct Double {
    g: f64,
}

/// From this start every fourth coefficient alone is not zero. Values of Taylor runs with 113 and 170 bits.
#[test]
fn a_double_pendulum_falls_from_the_horizontal() -> Result<(), Error> {
    let right = std::f64::consts::FRAC_PI_2;
    let state = end(&Double { g: 9.81 }, State::at_rest([right; 2]), 10.0)?;
    let off = [(state.q[0] + 0.568_474_664_015_950_2).abs(), (state.q[1] + 0.526_393_727_932_404_7).abs()];
    println!("{off:?}");
    assert!(off.iter().all(|off| *off < 1e-12), "{off:?}");
    // Looser tolerances have lower orders, and are not fooled either.
    for tolerance in [1e-6, 1e-9, 1e-12] {
        let path = Double { g: 9.81 }.integrate(
            State::at_rest([right; 2]),
            10.0,
            Taylor::with_tolerance(tolerance),
        )?;
        let off = (path.end().coordinate("a")? - state.q[0]).abs();
        println!("{tolerance:e}: {off:e}");
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

#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 - g*z)]
#[constraint(rod: (x^2 + y^2 + z^2 - 1)/2 = 0)]
struct Spherical {
    g: f64,
}

/// The constraint, and the energy over a thousand seconds: with a constraint kept to a few ulp only it grows by 4e-13.
#[test]
fn a_spherical_pendulum_keeps_what_it_keeps() -> Result<(), Error> {
    let system = Spherical { g: 9.81 };
    let start = State::new([0.6, 0.0, -0.8], [0.0, 1.0, 0.0]);
    let mut motion = Motion::new(&system, start, Taylor::default())?;
    let (mut position, mut rate, mut energy) = (0.0_f64, 0.0_f64, 0.0_f64);
    for second in 1..=2000 {
        assert_eq!(motion.advance_to(f64::from(second) * 0.5), Ok(()));
        let state = motion.state();
        position = position.max(system.constraint_residual(state)[0].abs());
        rate = rate.max(system.constraint_rate(state)[0].abs());
        energy = energy.max((system.energy(state) - system.energy(&start)).abs());
    }
    println!("{position:e} {rate:e} {energy:e}");
    assert!(position <= 2.0 * f64::EPSILON && rate <= 4.0 * f64::EPSILON && energy < 2e-13);
    Ok(())
}

#[derive(Lagrangian)]
#[coordinates(x1, y1, x2, y2)]
#[lagrangian((x1_dot^2 + y1_dot^2 + x2_dot^2 + y2_dot^2)/2 - g*(y1 + y2))]
#[constraint(upper: x1^2 + y1^2 = 1)]
#[constraint(lower: (x2 - x1)^2 + (y2 - y1)^2 = 1)]
struct Rods {
    g: f64,
}

/// On the average over motions: without the refinement of the accelerations by what is left of the constraints' equations it
/// grows by 4·10⁻¹⁴ in all of them.
#[test]
fn energy_on_rods_does_not_grow() -> Result<(), Error> {
    let system = Rods { g: 9.81 };
    let mut mean = 0.0;
    for k in 0..8 {
        let (sin, cos) = (0.5 + 0.1 * f64::from(k)).sin_cos();
        let start = State::at_rest([sin, -cos, 2.0 * sin, -2.0 * cos]);
        let reached = end(&system, start, 150.0)?;
        mean += 0.125 * (system.energy(&reached) - system.energy(&start));
    }
    println!("{mean:e}");
    assert!(mean.abs() < 2e-14, "{mean:e}");
    Ok(())
}
