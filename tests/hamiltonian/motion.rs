//! Motions by Hamilton's equations against those by Lagrange's, over 50 s at relative tolerance 1e-12.

use lagrange_core::{Ending, StateOf, hamiltonian::HamiltonianVectorField, prelude::*};

use crate::closed_forms::{Polar, Relativistic};
use crate::constrained::{Bead, Cartesian, Top};
use crate::{Potential, agree};

const END: f64 = 50.0;

fn method() -> Dop853 {
    Dop853::with_tolerance(1e-12)
}

/// The motion by Hamilton's equations, equal to that by Lagrange's to 1e-8 in coordinates, velocities and multipliers
/// at and between the steps; and the momenta are those of the velocities.
fn check<L: Simulate<Scalar = f64>>(system: &L, start: StateOf<L>) -> Trajectory<&L, HamiltonianVectorField> {
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
fn drift<L: Lagrangian<Scalar = f64>>(path: &Trajectory<&L, HamiltonianVectorField>) -> f64 {
    path.steps().fold(0.0, |most, sample| most.max((sample.energy() - path.start().energy()).abs()))
}

/// Polar and Cartesian, from the same start: θ from the vertical, the bob thrown sideways.
#[test]
fn spherical_pendulum() {
    let (m, l, g) = (1.3, 0.8, 9.81);
    let (polar, cartesian) = (Polar { m, l, g }, Cartesian { m, l, g });
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

#[test]
fn relativistic_particle() {
    let system = Relativistic { m: 0.7, c: 1.5, potential: Potential };
    let path = check(&system, State::new([0.3, -0.5, 0.4], [0.9, 0.6, -0.4]));
    assert!(drift(&path) < 1e-9);
}

/// The mass matrix is singular off the constraint; the vertical angular momentum is conserved.
#[test]
fn symmetric_top_with_a_unit_quaternion() {
    let system = Top { i: [0.5, 0.5, 0.3], mgl: 1.7 };
    let q = [0.3_f64.cos(), 0.3_f64.sin(), 0.0, 0.0];
    // q̇ = ½ q ω with ω = (0.2, 0.1, 6) in the body.
    let (w, x) = (q[0], q[1]);
    let v = [-0.1 * x, 0.1 * w, 0.05 * w - 3.0 * x, 3.0 * w + 0.05 * x];
    let path = check(&system, State::new(q, v));
    assert!(drift(&path) < 1e-9);
}

#[test]
fn bead_on_a_turning_ring() {
    let system = Bead { m: 0.4, g: 9.81, a: 0.5, omega: 6.0 };
    let start = system.state_from(&[("x", 0.3), ("z", -0.4), ("y_dot", 1.8)]).unwrap();
    check(&system, start);
}

/// A sleigh on a slope: its constraint is not integrable.
#[test]
fn sleigh() {
    #[derive(Lagrangian)]
    #[coordinates(x, y, phi)]
    #[lagrangian(m/2 * (x_dot^2 + y_dot^2) + k/2 * phi_dot^2 - m*g*y*sin(alpha))]
    #[constraint(edge: x_dot*sin(phi) = y_dot*cos(phi))]
    struct Sleigh {
        m: f64,
        k: f64,
        g: f64,
        alpha: f64,
    }
    let system = Sleigh { m: 1.0, k: 0.2, g: 9.81, alpha: 0.1 };
    let path = check(&system, State::new([0.0, 0.0, 0.4], [0.4_f64.cos(), 0.4_f64.sin(), 0.7]));
    assert!(drift(&path) < 1e-9);
}

/// The other method too, and a progress that cancels.
#[test]
fn methods_and_progress_are_those_of_lagranges_equations() {
    let system = Polar { m: 1.0, l: 1.0, g: 9.81 };
    let phase = system.phase_state(&State::new([1.0, 0.0], [0.0, 1.0]));
    let one = system.motion_in_momenta(phase).by(Dopri5::with_tolerance(1e-11)).to(5.0).unwrap();
    let other = system.motion_in_momenta(phase).by(method()).to(5.0).unwrap();
    agree(one.end().state().q.as_slice(), other.end().state().q.as_slice(), 1e-8);
    let path = system
        .motion_in_momenta(phase)
        .by(method())
        .on_progress(|now| {
            if now.steps == 3 {
                std::ops::ControlFlow::Break(())
            } else {
                std::ops::ControlFlow::Continue(())
            }
        })
        .to(5.0)
        .unwrap();
    assert!(matches!(path.ending(), Ending::Cancelled { .. }) && path.steps().count() == 4);
    let header = path.csv(2).to_string();
    assert!(header.starts_with("t,theta,phi,theta_dot,phi_dot\n"), "{header}");
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
