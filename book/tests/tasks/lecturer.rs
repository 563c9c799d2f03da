//! For a class.

use std::f64::consts::{FRAC_PI_2, PI};

use lagrange_core::prelude::*;

/// “Show that a bead on a hoop that turns about its vertical diameter leaves the lowest point beyond a certain rate, where it goes,
/// and with what frequency it swings about that. Is its energy conserved?”
#[test]
fn a_bead_on_a_turning_hoop() -> Result<(), Error> {
    /// `theta` is measured from the lowest point.
    #[derive(Clone, Lagrangian)]
    #[coordinates(theta)]
    #[lagrangian(m*a^2/2 * (theta_dot^2 + omega^2*sin(theta)^2) + m*g*a*cos(theta))]
    #[observable(t_plus_u = m*a^2/2 * (theta_dot^2 + omega^2*sin(theta)^2) - m*g*a*cos(theta))]
    struct Bead {
        m: f64,
        a: f64,
        g: f64,
        omega: f64,
    }

    let (a, g) = (0.5, 9.81_f64);
    let critical = (g / a).sqrt();
    for (rate, expected) in
        [(0.9, 0.0), (1.2, (1.0 / 1.44_f64).acos()), (2.0, 0.25_f64.acos())].map(|(x, at)| (x * critical, at))
    {
        let bead = Bead { m: 0.1, a, g, omega: rate };
        let rest = bead.equilibrium(&State::at_rest([expected + 0.05]), &["theta"])?;
        assert!((rest.state.q[0] - expected).abs() < 1e-9);
        let frequency = rest.system.linearize(&rest.state, &[])?.natural_frequencies()?[0];
        let square = match expected {
            0.0 => critical.powi(2) - rate.powi(2),
            theta => rate.powi(2) * theta.sin().powi(2),
        };
        assert!((frequency - square.sqrt()).abs() < 1e-9);
    }

    // The energy function is conserved, what one would call the energy is not: the hoop is driven.
    let bead = Bead { m: 0.1, a, g, omega: 2.0 * critical };
    let path = bead.integrate(State::at_rest([0.5]), 5.0, Dop853::default())?;
    let quarter = path.at(0.3)?;
    assert!((path.end().energy() - path.start().energy()).abs() < 1e-8);
    assert!((quarter.observable("t_plus_u")? - path.start().observable("t_plus_u")?).abs() > 1e-2);
    Ok(())
}

/// “Huygens: make a pendulum whose period does not depend on its amplitude.” Its bob must move on a cycloid.
#[test]
fn a_pendulum_that_keeps_time() -> Result<(), Error> {
    /// On a cycloid rolled off by circles of radius `a`, its lowest point at `phi` = 0.
    #[derive(Lagrangian)]
    #[coordinates(phi)]
    #[define(x = a*(phi + sin(phi)))]
    #[define(y = -a*cos(phi))]
    #[lagrangian(m/2 * (der(x)^2 + der(y)^2) - m*g*y)]
    struct Cycloid {
        m: f64,
        a: f64,
        g: f64,
    }

    let cycloid = Cycloid { m: 1.0, a: 0.25, g: 9.81 };
    for amplitude in [0.01, 0.5, 1.5, 2.5] {
        let lowest = cycloid.event("lowest", |sample| sample.coordinate("phi")).falling().terminal();
        let start = State::at_rest([amplitude]);
        let path = cycloid.motion(start).by(Dop853::with_tolerance(1e-12)).event(lowest).towards(10.0)?;
        // A quarter of 2π √(4a/g).
        assert!((path.end().time() - FRAC_PI_2 * (4.0 * 0.25 / 9.81_f64).sqrt()).abs() < 1e-9);
    }
    Ok(())
}

/// “A hoop rolls down inside a half-pipe. How does its period compare with that of a bead that glides, and how large a coefficient of
/// friction does it need?”
#[test]
fn a_hoop_in_a_half_pipe() -> Result<(), Error> {
    /// `theta` is where the hoop touches, from the lowest point; it turns by `phi`.
    #[derive(Clone, Lagrangian)]
    #[coordinates(r, theta, phi)]
    #[lagrangian(m/2 * (r_dot^2 + r^2*theta_dot^2) + m*a^2/2 * phi_dot^2 + m*g*r*cos(theta))]
    #[constraint(touches: r = pipe - a)]
    #[constraint(rolls: r*theta_dot - a*phi_dot = 0)]
    #[observable(press = -lambda(touches))]
    #[observable(friction = lambda(rolls))]
    struct Hoop {
        m: f64,
        a: f64,
        pipe: f64,
        g: f64,
    }

    let hoop = Hoop { m: 2.0, a: 0.1, pipe: 1.1, g: 9.81 };
    // Half of its inertia is in turning: the period is √2 that of the bead.
    let small = State::at_rest([1.0, 1e-3, 0.0]);
    let lowest = hoop.event("lowest", |sample| sample.coordinate("theta")).falling().terminal();
    let swing = hoop.motion(small).by(Dop853::with_tolerance(1e-12)).event(lowest).towards(10.0)?;
    assert!((swing.end().time() - FRAC_PI_2 * (2.0 / 9.81_f64).sqrt()).abs() < 1e-6);

    // Released at θ₀ it presses with m g (2 cos θ − cos θ₀), and friction is ½ m g sin θ: most is needed where it starts.
    let start = State::at_rest([1.0, PI / 3.0, 0.0]);
    let lowest = hoop.event("lowest", |sample| sample.coordinate("theta")).falling().terminal();
    let path = hoop.motion(start).event(lowest).towards(10.0)?;
    let mut needed: f64 = 0.0;
    for sample in path.samples(200) {
        let (theta, press) = (sample.coordinate("theta")?, sample.observable("press")?);
        assert!((press - 2.0 * 9.81 * (2.0 * theta.cos() - 0.5)).abs() < 1e-6);
        needed = needed.max((sample.observable("friction")? / press).abs());
    }
    assert!((needed - 0.5 * (PI / 3.0).tan()).abs() < 1e-6);
    Ok(())
}
