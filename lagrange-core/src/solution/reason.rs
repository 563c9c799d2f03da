//! Reasons for an error that the parameters and the state tell better than the equations.

use nalgebra::ComplexField;

use crate::error::Error;
use crate::number::limits::CANCELLED;
use crate::number::{Real, Scalar};
use crate::system::{ConstraintKind, Lagrangian, StateOf};
use crate::vector::StaticLength;

/// Replaces an error of the equations at a given state by its reason, if a parameter is not finite or a quaternion is zero.
#[cold]
pub(crate) fn reason<L: Lagrangian<Scalar: Real>>(system: &L, state: &StateOf<L>, error: Error) -> Error {
    if !matches!(
        error,
        Error::EquationsNotFinite { .. } | Error::Singular { .. } | Error::NotProjected { .. }
    ) {
        return error;
    }
    parameter_not_finite(system).or_else(|| zero_quaternion(system, state)).unwrap_or(error)
}

/// The first parameter that is not finite.
#[cold]
pub(crate) fn parameter_not_finite<L: Lagrangian<Scalar: Real>>(system: &L) -> Option<Error> {
    let mut found = None;
    system.visit_parameters(&mut |name, value| {
        if found.is_none() && !value.is_finite() {
            found = Some(Error::ParameterNotFinite { name, value: value.to_f64() });
        }
    });
    found
}

/// Finds four entries of one vector that are zero, where a constraint holds for each of the four unit vectors but not for zero.
fn zero_quaternion<L: Lagrangian<Scalar: Real>>(system: &L, state: &StateOf<L>) -> Option<Error> {
    let (zero, one) = (L::Scalar::constant(0.0), L::Scalar::constant(1.0));
    let is_constrained = |first: usize| {
        let residual = |entry: Option<usize>, a: usize| {
            let mut state = *state;
            entry.into_iter().for_each(|k| state.q[first + k] = one);
            Scalar::abs(system.constraint_residual(&state)[a])
        };
        let round_off = L::Scalar::constant(CANCELLED * L::Scalar::EPSILON);
        (0..<L::M>::COUNT)
            .filter(|&a| L::CONSTRAINT_KINDS[a] == ConstraintKind::Holonomic)
            .any(|a| residual(None, a) > round_off && (0..4).all(|k| residual(Some(k), a) <= round_off))
    };
    (0..(<L::N>::COUNT + 1).saturating_sub(4)).find_map(|first| {
        let name = four_entries(&L::COORDINATES[first..])?;
        let is_zero = (first..first + 4).all(|i| state.q[i] == zero);
        (is_zero && is_constrained(first)).then_some(Error::ZeroQuaternion { name })
    })
}

/// Name of the vector whose four entries these names begin with.
fn four_entries(names: &[&'static str]) -> Option<&'static str> {
    let name = names.first()?.strip_suffix("[0]")?;
    let is_entry = |at: usize, end: &str| {
        names.get(at).and_then(|entry| entry.strip_prefix(name)).is_some_and(|rest| rest == end)
    };
    let are_four = is_entry(1, "[1]") && is_entry(2, "[2]") && is_entry(3, "[3]") && !is_entry(4, "[4]");
    are_four.then_some(name)
}

#[cfg(test)]
mod tests {
    use crate::prelude::*;

    #[derive(Clone, Lagrangian)]
    #[coordinates(r: [3], q: [4])]
    #[frame(body: translate(r), rotate(q))]
    #[lagrangian(kinetic(body, m, [0, 0, 0], inertia))]
    struct Body {
        m: f64,
        inertia: nalgebra::Matrix3<f64>,
    }

    /// A top without frames, and a vector of four entries that is no quaternion.
    #[derive(Clone, Lagrangian)]
    #[coordinates(u: [4], q: [4])]
    #[define(w = quat_rate_body(q, q_dot))]
    #[lagrangian(dot(w, w)/2 + dot(u_dot, u_dot)/(2*dot(u, u)) - g*u[0])]
    #[constraint(unit: (dot(q, q) - 1)/2 = 0)]
    struct Top {
        g: f64,
    }

    #[test]
    fn a_quaternion_of_zeros_is_named() {
        let says = "the quaternion `q` is zero, which is no rotation: its length must be 1; for no turn at all set `q[0]` to 1";
        let body = Body { m: 1.0, inertia: nalgebra::Matrix3::identity() };
        let zero = State::at_rest([0.0; 7]);
        for error in [
            body.solve(&zero).expect_err("no rotation"),
            body.integrate(zero, 1.0, Dop853::default()).expect_err("no rotation"),
            body.make_consistent(&zero).expect_err("no rotation"),
        ] {
            assert_eq!(error.to_string(), says);
        }
        let top = Top { g: 1.0 };
        let start = State::at_rest([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(top.solve(&start).expect_err("no rotation").to_string(), says);
        // The other vector is at a pole, and the quaternion is none.
        let pole = State::at_rest([0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
        assert!(matches!(top.solve(&pole), Err(Error::EquationsNotFinite { .. })));
    }

    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian(m/2*(x_dot^2 + y_dot^2) - k[0]*x^2/2 - k[2]*y - 1/x)]
    struct Springs {
        m: f64,
        k: [f64; 3],
    }

    #[test]
    fn parameters_that_are_no_numbers_are_named() {
        let start = State::at_rest([1.0, 0.0]);
        let said = |m: f64, k: [f64; 3]| Springs { m, k }.integrate(start, 1.0, Dop853::default()).err();
        let text = said(1.0, [1.0, 2.0, f64::NAN]).map(|error| error.to_string());
        let says = "the parameter `k[2]` is NaN: every parameter in the equations must be finite";
        assert_eq!(text.as_deref(), Some(says));
        let infinite = said(1.0, [f64::INFINITY, 2.0, 3.0]);
        assert!(
            matches!(infinite, Some(Error::ParameterNotFinite { name: "k[0]", value: f64::INFINITY })),
            "{infinite:?}"
        );
        // No expression names `k[1]`.
        assert!(said(1.0, [1.0, f64::NAN, 3.0]).is_none());
        // Every parameter is finite, and the state at a pole.
        let pole = Springs { m: 1.0, k: [1.0; 3] }.solve(&State::at_rest([0.0, 0.0]));
        assert!(matches!(pole, Err(Error::EquationsNotFinite { .. })));
    }
}
