//! Generalized forces as a linear function of the inertial parameters of bodies.

mod base;

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use nalgebra::{ComplexField, DMatrix, DVector};

pub use base::BaseParameters;

use crate::derivatives::tangent::Tangent;
use crate::error::Error;
use crate::error::owned::similar::{listed, nearest};
use crate::linearized::Linearized;
use crate::linearized::argument::{check_parameters, set_parameter};
use crate::names::{Entry, Row};
use crate::number::{Real, Scalar, exceeds, larger, largest, power_of_epsilon};
use crate::solution::solve::first_row;
use crate::system::{Solution, StateOf, finite::check_finite, unit};
use crate::vector::{StaticLength, Vector, zeros};

/// Generalized forces τ = M q̈ − h = Y π + τ₀ at a state with given accelerations, linear in the inertial parameters π of
/// bodies.
///
/// π has ten numbers for each body: its mass m, its first moment m c, and its inertia I_O about the origin of its frame, in
/// the axes of the frame, in the order of the upper triangle. τ₀ is what other parts of the system need: springs, damping,
/// rotors of motors, and the forces of the inputs with the opposite sign. In a motion Y π + τ₀ = Fᵀλ: without constraints
/// zero, with constraints zero along the [`free`](Self::free) directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Regressor<T> {
    /// Y: one row for each coordinate, one column for each inertial parameter.
    pub matrix: DMatrix<T>,
    /// τ₀, the forces that do not depend on the inertial parameters.
    pub offset: DVector<T>,
    /// Basis of the velocities that the constraints allow, F Z = 0, one column each; without constraints the identity.
    pub free: DMatrix<T>,
    names: Vec<String>,
}

impl<T: Real> Regressor<T> {
    /// Names of the inertial parameters, in the order of the columns: `m(body)`, `mc(body)[0]`, …, `I(body)[0][0]`, ….
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Zᵀ Y and Zᵀ τ₀: rows that hold whatever the forces of the constraints are. In a motion Zᵀ Y π = −Zᵀ τ₀.
    pub fn along_free(&self) -> (DMatrix<T>, DVector<T>) {
        (self.free.tr_mul(&self.matrix), self.free.tr_mul(&self.offset))
    }
}

/// Entries of the upper triangle of an inertia, row by row.
const TRIANGLE: [[usize; 2]; 6] = [[0, 0], [0, 1], [0, 2], [1, 1], [1, 2], [2, 2]];

/// Indices of the parameters of a body: mass, centre of mass, inertia about the centre.
type Indices = [usize; 10];

/// Finds the parameters `body.m`, `body.centre` and `body.inertia` of each of these bodies.
fn indices<L: Linearized>(bodies: &[&str]) -> Result<Vec<Indices>, Error> {
    const { check_parameters::<L>() };
    let repeated = bodies.iter().enumerate().find(|(k, body)| bodies[..*k].contains(body));
    if let Some((_, body)) = repeated {
        return Err(Error::RepeatedName { name: (*body).into() });
    }
    let of = |body: &&str| {
        let refused = |hint: &str| Error::UnknownName {
            name: (*body).into(),
            kind: "body with the members `m`, `centre: [3]` and `inertia: symmetric`",
            hint: Some(hint.into()),
            known: Vec::new(),
        };
        let index = |name: &str| L::PARAMETERS.iter().position(|known| *known == name);
        if index(&format!("{body}.inertia[1][0]")).is_some() {
            return Err(refused("its inertia is declared as any matrix; declare it as `inertia: symmetric`"));
        }
        let mut found = [0; 10];
        for (place, name) in
            found.iter_mut().zip(ten(["m", "centre", "inertia"].map(|member| format!("{body}.{member}"))))
        {
            let missing = || refused(&meant::<L>(body).unwrap_or(format!("there is no parameter `{name}`")));
            *place = index(&name).ok_or_else(missing)?;
        }
        Ok(found)
    };
    bodies.iter().map(of).collect()
}
/// Suggests a body for a name none of whose members is a parameter: of a link one may know the frame.
fn meant<L: Linearized>(name: &str) -> Option<String> {
    if L::PARAMETERS.iter().any(|known| known.strip_prefix(name).is_some_and(|rest| rest.starts_with('.'))) {
        return None;
    }
    let bodies = L::PARAMETERS.iter().filter_map(|known| known.strip_suffix(".inertia[0][0]"));
    let bodies: Vec<String> = bodies.map(Into::into).collect();
    let longer = bodies.iter().filter(|body| body.starts_with(name)).min_by_key(|body| body.len());
    Some(match longer.or_else(|| nearest(name, &bodies)) {
        Some(near) => format!("did you mean `{near}`?"),
        None if bodies.is_empty() => return None,
        None => format!("there are {}", listed(name, &bodies)),
    })
}

/// Names of a mass, of three components and of the entries of an inertia.
fn ten([mass, vector, inertia]: [String; 3]) -> impl Iterator<Item = String> {
    let components = (0..3).map(move |k| format!("{vector}[{k}]"));
    let entries = TRIANGLE.into_iter().map(move |[j, k]| format!("{inertia}[{j}][{k}]"));
    [mass].into_iter().chain(components).chain(entries)
}

fn names(bodies: &[&str]) -> Vec<String> {
    let of = |body: &&str| ten(["m", "mc", "I"].map(|symbol| format!("{symbol}({body})")));
    bodies.iter().flat_map(of).collect()
}

/// Inertial parameters (m, m c, I_O) of a body with these parameters (m, c, I about c), by Steiner's theorem.
fn inertial<T: Real>(values: [T; 10]) -> [T; 10] {
    let (m, c) = (values[0], &values[1..4]);
    let square = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
    core::array::from_fn(|k| match k {
        0 => m,
        1..4 => m * c[k - 1],
        _ => {
            let [i, j] = TRIANGLE[k - 4];
            let across = if i == j { square } else { T::constant(0.0) };
            values[k] + m * (across - c[i] * c[j])
        }
    })
}

/// See [`Linearized::inertial_parameters`].
pub(crate) fn inertial_parameters<L: Linearized<Scalar: Real>>(
    system: &L,
    bodies: &[&str],
) -> Result<DVector<L::Scalar>, Error> {
    let values = system.parameters();
    let all = indices::<L>(bodies)?;
    let all = all.iter().flat_map(|body| inertial(body.map(|k| values[k])));
    Ok(DVector::from_iterator(10 * bodies.len(), all))
}

/// See [`Linearized::regressor`].
pub(crate) fn regressor<L: Linearized<Scalar: Real> + Clone>(
    system: &L,
    state: &StateOf<L>,
    accelerations: &Vector<L::Scalar, L::N>,
    bodies: &[&str],
) -> Result<Regressor<L::Scalar>, Error> {
    check_finite(system, state)?;
    let all = indices::<L>(bodies)?;
    let matrix = columns(system, state, accelerations, &all)?;
    let offset = forces(&with(system, &all, 0.0)?, state, accelerations);
    // At two sets of parameters: a square of a mass may be the mass itself at one of them.
    for system in [system, &changed(system, &all)] {
        let expected = &matrix * inertial_parameters(system, bodies)? + &offset;
        check::<L>(&forces(system, state, accelerations), &expected, (&matrix, &offset), state)?;
    }
    Ok(Regressor { matrix, offset, free: free(system, state)?, names: names(bodies) })
}

/// τ = M q̈ − h.
fn forces<L: Linearized<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    accelerations: &Vector<L::Scalar, L::N>,
) -> DVector<L::Scalar> {
    let forces = system.inverse_dynamics(state, accelerations, &zeros());
    DVector::from_iterator(<L::N>::COUNT, forces.iter().copied())
}

/// The system whose bodies have this mass at the origins of their frames, without inertia.
fn with<L: Linearized<Scalar: Real> + Clone>(system: &L, bodies: &[Indices], mass: f64) -> Result<L, Error> {
    let mut bare = system.clone();
    for (k, &index) in bodies.iter().flat_map(|body| body.iter().enumerate()) {
        let value = L::Scalar::constant(if k == 0 { mass } else { 0.0 });
        set_parameter(&mut bare, index, value)?;
    }
    Ok(bare)
}

/// The system with other masses, centres and inertias.
fn changed<L: Linearized<Scalar: Real> + Clone>(system: &L, bodies: &[Indices]) -> L {
    let (mut changed, values) = (system.clone(), system.parameters());
    for &index in bodies.iter().flatten() {
        changed.set_parameter(index, L::Scalar::constant(1.3) * values[index] + L::Scalar::constant(0.7));
    }
    changed
}

/// Y, from the derivatives by m, c and I at m = 1, c = 0 and I = 0: there they are those by m, m c and I_O.
fn columns<L: Linearized<Scalar: Real> + Clone>(
    system: &L,
    state: &StateOf<L>,
    accelerations: &Vector<L::Scalar, L::N>,
    bodies: &[Indices],
) -> Result<DMatrix<L::Scalar>, Error> {
    let points = with(system, bodies, 1.0)?;
    let here = Solution::given(*accelerations, zeros());
    let mut matrix = DMatrix::zeros(<L::N>::COUNT, 10 * bodies.len());
    for (column, &index) in bodies.iter().flatten().enumerate() {
        let change = points.residual_change_by_parameters(state, &here, &unit(index)).motion;
        if let Some(row) = first_row::<L>(|i| !change[i].is_finite(), |_| false) {
            let entry = Entry::Parameter(L::PARAMETERS[index]);
            return Err(Error::DerivativeNotFinite { row, entry, time: state.t.to_f64() });
        }
        matrix.column_mut(column).copy_from_slice(change.as_slice());
    }
    Ok(matrix)
}

/// Requires each row of τ to be what Y π + τ₀ says, to √ε of its terms.
fn check<L: Linearized<Scalar: Real>>(
    forces: &DVector<L::Scalar>,
    expected: &DVector<L::Scalar>,
    (matrix, offset): (&DMatrix<L::Scalar>, &DVector<L::Scalar>),
    state: &StateOf<L>,
) -> Result<(), Error> {
    let most =
        larger(largest(matrix.as_slice()), larger(largest(offset.as_slice()), largest(forces.as_slice())));
    let is_off = |i: &usize| {
        let allowed = power_of_epsilon::<L::Scalar>(0.5) * most;
        exceeds(Scalar::abs(forces[*i] - expected[*i]), allowed)
    };
    match (0..forces.len()).find(is_off) {
        None => Ok(()),
        Some(i) => Err(Error::NotInertial {
            row: Row::Coordinate(L::COORDINATES[i]),
            residual: (forces[i] - expected[i]).to_f64(),
            time: state.t.to_f64(),
        }),
    }
}

/// Basis of the velocities that the constraints allow.
fn free<L: Linearized<Scalar: Real>>(system: &L, state: &StateOf<L>) -> Result<DMatrix<L::Scalar>, Error> {
    if const { <L::M>::COUNT == 0 } {
        return Ok(DMatrix::identity(<L::N>::COUNT, <L::N>::COUNT));
    }
    let tangent = Tangent::at(system, state)?;
    let columns: Vec<_> = tangent.matrices().factors.rows.null_space().collect();
    Ok(DMatrix::from_fn(<L::N>::COUNT, columns.len(), |i, j| columns[j][i]))
}
