//! Motions by Hamilton's equations against those by Lagrange's, over 50 s at relative tolerance 1e-12.

use lagrange_core::{Ending, StateOf, hamiltonian::HamiltonianVectorField, prelude::*};
use lagrange_systems::{PolarPendulum, SphericalPendulum};

use crate::agree;

const END: f64 = 50.0;

pub(crate) fn method() -> Dop853 {
    Dop853::with_tolerance(1e-12)
}

/// The motion by Hamilton's equations, equal to that by Lagrange's to 1e-8 in coordinates, velocities and multipliers
/// at and between the steps; and the momenta are those of the velocities.
pub(crate) fn check<L: Lagrangian<Scalar = f64>>(
    system: &L,
    start: StateOf<L>,
) -> Trajectory<&L, HamiltonianVectorField> {
    let lagrange = system.integrate(start, END, method()).unwrap();
    let hamilton = system.motion_in_momenta(system.phase_state(&start)).by(method()).to(END).unwrap();
    assert!(hamilton.ending().is_complete(), "{}", hamilton.ending());
    for (one, other) in lagrange.samples(1001).zip(hamilton.samples(1001)) {
        assert_eq!(one.time(), other.time());
        agree(one.state().q.as_slice(), other.state().q.as_slice(), 1e-8);
        agree(one.state().v.as_slice(), other.state().v.as_slice(), 1e-8);
        let multipliers = [&one, &other].map(|sample| sample.solution().unwrap().multipliers);
        agree(multipliers[0].as_slice(), multipliers[1].as_slice(), 1e-8);
    }
    for sample in hamilton.steps() {
        let state = sample.state();
        for a in 0..L::CONSTRAINTS.len() {
            assert!(system.constraint_residual(state)[a].abs() < 1e-13);
            assert!(system.constraint_rate(state)[a].abs() < 1e-12);
        }
    }
    hamilton
}

/// The largest change of H along a trajectory.
pub(crate) fn drift<L: Lagrangian<Scalar = f64>>(path: &Trajectory<&L, HamiltonianVectorField>) -> f64 {
    path.steps().fold(0.0, |most, sample| most.max((sample.energy() - path.start().energy()).abs()))
}

/// Polar and Cartesian, from the same start: θ from the vertical, the bob thrown sideways.
#[test]
fn spherical_pendulum() {
    let (m, l, g) = (1.3, 0.8, 9.81);
    let (polar, cartesian) = (PolarPendulum { m, l, g }, SphericalPendulum { m, l, g });
    let (theta, v): (f64, f64) = (1.1, 1.4);
    let by_angles = check(&polar, State::new([theta, 0.0], [0.0, v / (l * theta.sin())]));
    let start = State::new([l * theta.sin(), 0.0, -l * theta.cos()], [0.0, v, 0.0]);
    let by_positions = check(&cartesian, start);
    for (angles, position) in by_angles.samples(1001).zip(by_positions.samples(1001)) {
        let [theta, phi]: [f64; 2] = angles.state().q.into();
        let there = [l * theta.sin() * phi.cos(), l * theta.sin() * phi.sin(), -l * theta.cos()];
        agree(position.state().q.as_slice(), &there, 1e-8);
        let l_z = angles.momentum("phi").unwrap();
        assert!((l_z - m * start.q[0] * v).abs() < 1e-9);
    }
    assert!(drift(&by_angles) < 1e-9 && drift(&by_positions) < 1e-9);
}

/// p = q̇³ − q̇ falls to −2/√27, below which no velocity near has it.
#[test]
fn a_momentum_that_no_velocity_has_ends_the_motion() {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^4/4 - x_dot^2/2 - x)]
    struct Fold;
    let phase = Fold.phase_state(&State::new([0.0], [1.1]));
    let path = Fold.motion_in_momenta(phase).towards(2.0).unwrap();
    let Ending::Unsolved { time, error: Error::MomentumNotReached { coordinate: "x", .. } } = path.ending()
    else {
        panic!("{}", path.ending());
    };
    let fold = 1.1_f64.powi(3) - 1.1 + 2.0 / 27_f64.sqrt();
    assert!((time - fold).abs() < 1e-9, "{time} is not {fold}");
}
