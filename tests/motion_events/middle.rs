//! Functions that are zero, but for their round-off, where a step begins and where it is halved.

use lagrange_core::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2)]
struct Particle;

/// Zero at the start, at the middle of the step, and positive between: it lands once, whatever the round-off at either.
#[test]
fn a_bounce_that_lands_at_the_middle_of_a_step() {
    let units = [-4.0, -1.0, 0.0, 0.5, 1.0, 4.0];
    for (start, middle) in units.into_iter().flat_map(|start| units.map(|middle| (start, middle))) {
        for (height, width) in [(4e-5, 1.0), (1.0, 1.0), (1e-9, 0.004), (1e-3, 1e-5)] {
            let lands = Particle.event("lands", |sample| {
                let [x, y, z] = [0, 1, 2].map(|i| sample.state().q[i]);
                let x = x / width;
                // Less than the round-off of y − z, 10⁻¹⁵ a unit.
                let round_off = 1e-15 * if x < 0.5 { start } else { middle };
                height * x * (1.0 - x) + (y - z) + round_off
            });
            let motion = Particle.motion(State::new([0.0, 7.0, 7.0], [1.0, 0.0, 0.0]));
            let path = motion.by(RungeKutta4::with_step(2.0 * width)).event(lands.falling()).to(2.0 * width);
            let found: Vec<f64> =
                path.unwrap().crossings().iter().map(|found| found.state.t / width).collect();
            assert!(
                matches!(found[..], [t] if (t - 1.0).abs() < 1e-3),
                "{start} {middle} {height:e}: {found:?}"
            );
        }
    }
}
