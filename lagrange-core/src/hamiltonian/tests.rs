use crate::fixtures::{Mechanism, dependent_on_the_manifold, free, identity, spherical_pendulum};
use crate::prelude::*;

#[test]
fn contradictory_constraints_are_named() {
    let pushed = Mechanism::<1, 2, 0> {
        mass: identity,
        forcing: |_| [0.0],
        residual: |_| [0.0; 2],
        rate: |s| [s.v[0] - 1.0, s.v[0] - 2.0],
        jacobian: |_| [[1.0], [1.0]],
        bias: |_| [0.0; 2],
    };
    let error = pushed.legendre(&PhaseState::new([0.0], [0.3])).unwrap_err();
    assert!(matches!(error, Error::Contradictory { constraint: "c0" | "c1", .. }), "{error}");
}

/// Constraints that are dependent on their manifold give the same motion in (q, p).
#[cfg(feature = "alloc")]
#[test]
fn dependent_constraints_give_the_same_motion() {
    let system = dependent_on_the_manifold();
    let start = State::new([0.6, -0.8], [0.8, 0.6]);
    let method = Dop853::with_tolerance(1e-12);
    let lagrange = system.integrate(start, 10.0, method).unwrap();
    let hamilton = system.motion_in_momenta(system.phase_state(&start)).by(method).to(10.0).unwrap();
    assert!(hamilton.ending().is_complete() && !hamilton.multipliers_are_unique());
    for (one, other) in lagrange.samples(101).zip(hamilton.samples(101)) {
        assert!((one.state().q - other.state().q).norm() < 1e-9);
        assert!((one.state().v - other.state().v).norm() < 1e-9);
    }
}

/// An ending names the momentum at fault.
#[cfg(feature = "alloc")]
#[test]
fn an_ending_names_a_momentum() {
    let falling = free::<1>(|s| [1.0 / (1.0 - s.t)]);
    let phase = PhaseState::new([0.0], [0.0]);
    let path = falling.motion_in_momenta(phase).towards(2.0).unwrap();
    let text = std::format!("{}", path.ending());
    assert!(text.contains("the error of `p(x)` demands a step too small"), "{text}");
}

/// Off the constraint too, the velocity is tangential to it, and the momenta agree up to a part along the
/// constraint.
#[test]
fn the_transform_is_defined_off_the_constraints() {
    let pendulum = spherical_pendulum();
    let phase = PhaseState::new([0.7, 0.2, -0.9], [0.3, 0.4, 0.5]);
    let v = pendulum.legendre(&phase).unwrap().v;
    let along = phase.q * (phase.p.dot(&phase.q) / phase.q.norm_squared());
    assert!((v - (phase.p - along)).norm() < 1e-15);
}
