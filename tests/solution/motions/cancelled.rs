//! Results that constraints without a gradient, or dependent ones, would spoil.

use lagrange_core::prelude::*;
use lagrange_random::Random;

use crate::cancelled_gradients::{is_refused, linkage};
use crate::dependence::{self, ALL_DISTANCES, ALL_LENGTHS, beads, points};

/// Whatever uses the constraints says so.
#[test]
fn no_result_follows_from_a_row_that_parameters_cancel() {
    let random = &mut Random(1);
    for _ in 0..100 {
        let (linkage, state) = linkage(random, 0.0);
        let row = linkage.constraint_jacobian(&state).row(2).into_owned();
        if row.amax() == 0.0 {
            continue;
        }
        let found = [
            linkage.check_consistent(&state),
            linkage.make_consistent(&state).map(drop),
            linkage.assemble(&state).map(drop),
            linkage.linearize(&state, &["m"]).map(drop),
            linkage.equilibrium(&state, &[]).map(drop),
            linkage.inputs_for(&state, &[0.0; 3].into(), &["torque"]).map(drop),
            linkage.complete_accelerations(&state, &[1.0; 3].into(), &["p"]).map(drop),
            linkage.hamilton_equations(&linkage.phase_state(&state)).map(drop),
            linkage.integrate(state, 1.0, Radau::default()).map(drop),
            linkage.integrate_hamiltonian(linkage.phase_state(&state), 1.0, Dop853::default()).map(drop),
            linkage.integrate_sensitivities(state, 1.0, Dop853::default(), &["m"]).map(drop),
            linkage.monodromy(&state, 1.0, Dop853::default()).map(drop),
        ];
        assert!(found.iter().all(is_refused), "{found:?}, {row}");
    }
}

#[test]
fn no_motion_starts_where_constraints_are_dependent_to_first_order() {
    for case in 0..30 {
        let random = &mut Random(case);
        let (beads, state) = beads(random);
        dependence::is_refused(case, &beads.integrate(state, 1.0, Dop853::default()).map(drop), ALL_LENGTHS);
        dependence::is_refused(case, &beads.integrate(state, 1.0, Taylor::default()).map(drop), ALL_LENGTHS);
        let (plate, state) = points(random, true);
        dependence::is_refused(
            case,
            &plate.integrate(state, 1.0, Dop853::default()).map(drop),
            ALL_DISTANCES,
        );
    }
}
