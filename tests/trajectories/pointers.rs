//! A system behind a reference or a smart pointer is that system.

use std::rc::Rc;
use std::sync::Arc;

use lagrange_core::prelude::*;
use lagrange_core::{facts::Classification, nalgebra::Const};

use crate::Spring;

/// A velocity constraint with an integral, observables, conserved quantities.
#[derive(Clone, Debug, PartialEq, Lagrangian)]
#[coordinates(x, phi, psi)]
#[lagrangian(m/2 * x_dot^2 + m*a^2/5 * phi_dot^2 + m/2 * psi_dot^2 * (1 + x^2) + m*g*x*sin(0.3))]
#[constraint(no_slip: x_dot - a*phi_dot = 0)]
#[observable(kinetic = m/2 * x_dot^2)]
#[observable(friction = lambda(no_slip))]
struct Sphere<T> {
    m: T,
    a: T,
    g: T,
}

const SPHERE: Sphere<f64> = Sphere { m: 2.0, a: 0.1, g: 9.81 };

/// Everything that a system says about itself and gives at a state.
fn all<L: Lagrangian<N = Const<3>, M = Const<1>, Scalar = f64>>(system: &L) -> String {
    let state = &State::new([0.4, 0.2, 0.1], [0.3, 3.0, -0.7]).at_time(0.5);
    let solution = &system.accelerations_unchecked(state);
    let constants = (
        (L::NAME, L::COORDINATES, L::CONSTRAINTS, L::CONSTRAINT_KINDS, L::OBSERVABLES),
        (L::CONSTRAINT_CLASSES, L::INTEGRALS, L::MOMENTA_ARE_LINEAR, L::FACTS),
    );
    let numbers = (
        (system.lagrangian(state), system.energy(state), system.momentum(state), system.momentum_rate(state)),
        (system.mass_matrix(state), system.forcing(state), solution),
        (system.constraint_residual(state), system.constraint_rate(state), system.constraint_jacobian(state)),
        (system.residual_magnitude(state), system.rate_magnitude(state)),
        system.solve_with(&system.factor(state), &system.forcing(state), &system.constraint_bias(state)),
        (system.constraint_bias(state), system.constraint_force(state, &solution.multipliers)),
        [0, 1].map(|index| system.constraint_integral(index, state)),
        [0, 1, 2].map(|index| system.observable(index, state, solution)),
        [0, 1, 2].map(|index| system.conserved(index, state)),
    );
    format!("{constants:#?} {numbers:#?}")
}

#[test]
fn pointers_forward_everything() {
    // Nothing here is what a default would give.
    assert!(Sphere::<f64>::INTEGRALS.is_some() && !Sphere::<f64>::OBSERVABLES.is_empty());
    assert_ne!(Sphere::<f64>::CONSTRAINT_CLASSES[0], Classification::UNDECIDED);
    assert!(SPHERE.constraint_integral(0, &State::at_rest([1.0; 3])).is_some());
    const { assert!(Sphere::<f64>::MOMENTA_ARE_LINEAR) };
    let whole = all(&SPHERE);
    for behind in
        [all(&&SPHERE), all(&&&SPHERE), all(&Box::new(SPHERE)), all(&Rc::new(SPHERE)), all(&Arc::new(SPHERE))]
    {
        assert_eq!(behind, whole);
    }
}

/// Derivatives are those of the system itself, whose parameters can be set.
#[test]
fn behind_a_pointer_parameters_can_be_sought() -> Result<(), Error> {
    let spring = Spring { k: 9.81, ..Spring::default() };
    let borrowed = &&spring;
    for held in [
        Arc::new(spring).equilibrium(&State::at_rest([0.5]), &["u"])?,
        borrowed.equilibrium(&State::at_rest([0.5]), &["u"])?,
    ] {
        assert!((held.system.u - 9.81 * 0.5).abs() < 1e-14);
    }
    Ok(())
}

/// One system, not copied, from many starts.
#[cfg(feature = "thorough")]
#[test]
fn members_of_an_ensemble_share_a_system() -> Result<(), Error> {
    use lagrange_core::{Lanes, Pack};
    let start = |k: usize| State::at_rest([k as f64, 0.0, 0.0]);
    let copies = Ensemble::from_fn(9, |k| (SPHERE, start(k))).integrate_on_lanes(1.0, Dop853::default())?;
    let borrowed = Ensemble::from_fn(9, |k| (&SPHERE, start(k)));
    assert_eq!(borrowed.integrate_on_lanes(1.0, Dop853::default())?, copies);
    let shared = Arc::new(SPHERE);
    let shared = Ensemble::from_fn(9, |k| (shared.clone(), start(k)));
    assert_eq!(shared.integrate_on_lanes(1.0, Dop853::default())?, copies);
    let packed: Sphere<Lanes> = Box::new(SPHERE).pack();
    assert_eq!(packed, SPHERE.pack());
    Ok(())
}
