//! A point of the velocity phase space at a time, and what the equations of motion give there.

use core::fmt::{self, Debug, Display, Formatter};

use nalgebra::SVector;

use super::entries::Entries;
use crate::number::Scalar;

/// The time `t`, the generalized coordinates `q` and the generalized velocities `v` = q̇.
///
/// Entries are in the order of the `coordinates` attribute.
///
/// ```
/// use lagrange_core::State;
/// let state = State::new([0.1, 0.0], [0.0, 2.0]).at_time(1.0);
/// assert_eq!((state.t, state.q[0], state.v[1]), (1.0, 0.1, 2.0));
/// assert_eq!(state.to_string(), "t = 1.0: q = (0.1, 0.0), q̇ = (0.0, 2.0)");
/// assert_eq!(format!("{state:.3}"), "t = 1.000: q = (0.100, 0.000), q̇ = (0.000, 2.000)");
/// ```
///
/// With the feature `serde` it is written and read: `{"t": 0.0, "q": [0.1], "v": [0.0]}`. JSON has no NaN and no infinities:
/// `serde_json` writes them as `null`, which is an error where a state is read. It reads a number back to the last bit with its
/// feature `float_roundtrip` alone (`serde_json = { version = "1", features = ["float_roundtrip"] }`), otherwise to
/// the bit beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: nalgebra::Scalar + serde::Serialize",
        deserialize = "T: nalgebra::Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct State<T, const N: usize> {
    /// Time.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "super::read::number"))]
    pub t: T,
    /// Generalized coordinates.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "super::read::numbers"))]
    pub q: SVector<T, N>,
    /// Generalized velocities.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "super::read::numbers"))]
    pub v: SVector<T, N>,
}

impl<T: Scalar, const N: usize> State<T, N> {
    /// Coordinates and velocities at `t = 0`.
    pub fn new(q: impl Entries<T, N>, v: impl Entries<T, N>) -> Self {
        Self { t: T::constant(0.0), q: q.into_vector(), v: v.into_vector() }
    }

    /// Coordinates at rest at `t = 0`.
    pub fn at_rest(q: impl Entries<T, N>) -> Self {
        Self::new(q, [T::constant(0.0); N])
    }

    /// The same coordinates and velocities at the time `t`.
    #[must_use]
    pub fn at_time(self, t: T) -> Self {
        Self { t, ..self }
    }
}

/// `t = 1.0: q = (0.1, 0.0), q̇ = (0.0, 2e-17)`, each number as the format says: `{state:.3}`.
impl<T: Scalar, const N: usize> Display for State<T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write_state(f, &self.t, [("q", self.q.as_slice()), ("q̇", self.v.as_slice())])
    }
}

/// Numbers as `Debug` writes them: small and large ones, and round-off in the place of zero, by powers of ten.
pub(crate) fn write_state<T: Scalar>(f: &mut Formatter<'_>, t: &T, parts: [(&str, &[T]); 2]) -> fmt::Result {
    f.write_str("t = ")?;
    Debug::fmt(t, f)?;
    for ((name, entries), before) in parts.into_iter().zip([": ", ", "]) {
        write!(f, "{before}{name} = ")?;
        for (i, entry) in entries.iter().enumerate() {
            f.write_str(if i == 0 { "(" } else { ", " })?;
            Debug::fmt(entry, f)?;
        }
        f.write_str(")")?;
    }
    Ok(())
}

/// What the equations of motion give at a state: accelerations q̈ and multipliers λ, from
///
/// ```text
/// [ M  −Fᵀ ] [ q̈ ]   [  h ]
/// [ F   0  ] [ λ ] = [ −γ ]
/// ```
///
/// The constraint force on coordinate a is Σ_α λ_α F_αa (Milton (8.7), (8.13)).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: nalgebra::Scalar + serde::Serialize",
        deserialize = "T: nalgebra::Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct Solution<T, const N: usize, const M: usize> {
    /// Generalized accelerations q̈.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "super::read::numbers"))]
    pub accelerations: SVector<T, N>,
    /// Lagrange multipliers λ, one a scalar constraint, in the order written.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "super::read::numbers"))]
    pub multipliers: SVector<T, M>,
    /// The smallest pivot of the elimination, as a fraction of the diagonal entry it came from: 1 is
    /// perfect, 0 singular, NaN or negative a system that this elimination cannot solve, or of which the numbers are so
    /// large or small that their products are none, or have lost digits.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "super::read::number"))]
    pub pivot: T,
    /// How many of the `M` constraints are independent here. Where it is less than `M` the multipliers
    /// are not unique; those given are the ones of least Euclidean norm.
    pub rank: usize,
}

impl<T, const N: usize, const M: usize> Solution<T, N, M> {
    /// Whether the multipliers are determined by the equations: false where constraints depend on one another.
    pub fn multipliers_are_unique(&self) -> bool {
        self.rank == M
    }
}
