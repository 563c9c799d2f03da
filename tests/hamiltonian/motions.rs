//! More motions by Hamilton's equations: forms of L and of constraints that differ, other methods.

use std::ops::ControlFlow::{Break, Continue};

use lagrange_core::{Ending, prelude::*};
use lagrange_systems::{KnifeEdge, PolarPendulum};

use crate::closed_forms::Relativistic;
use crate::constrained::{Bead, Top};
use crate::motion::{check, drift, method};
use crate::rotating_frame::rotating;
use crate::{Potential, agree};

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

/// H depends on the time.
#[test]
fn rotating_frame() {
    check(&rotating(), State::new([0.7, -0.4, 0.5], [0.3, 0.8, -0.2]));
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
    let system = KnifeEdge { m: 1.0, inertia: 0.2, g: 0.98 };
    let path = check(&system, State::new([0.0, 0.0, 0.4], [0.4_f64.cos(), 0.4_f64.sin(), 0.7]));
    assert!(drift(&path) < 1e-9);
}

/// The other method too, and a progress that cancels.
#[test]
fn methods_and_progress_are_those_of_lagranges_equations() {
    let system = PolarPendulum { m: 1.0, l: 1.0, g: 9.81 };
    let phase = system.phase_state(&State::new([1.0, 0.0], [0.0, 1.0]));
    let one = system.motion_in_momenta(phase).by(Dopri5::with_tolerance(1e-11)).to(5.0).unwrap();
    let other = system.motion_in_momenta(phase).by(method()).to(5.0).unwrap();
    agree(one.end().state().q.as_slice(), other.end().state().q.as_slice(), 1e-8);
    let motion = system.motion_in_momenta(phase).by(method());
    let motion = motion.on_progress(|now| if now.steps == 3 { Break(()) } else { Continue(()) });
    let path = motion.to(5.0).unwrap();
    assert!(matches!(path.ending(), Ending::Cancelled { .. }) && path.steps().count() == 4);
    let header = path.csv(2).to_string();
    assert!(header.starts_with("t,theta,phi,theta_dot,phi_dot\n"), "{header}");
}
