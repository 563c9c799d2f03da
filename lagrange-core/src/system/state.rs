//! States of a system, and solutions of the equations of motion at a state.

use core::fmt::{self, Debug, Display, Formatter};

use super::entries::Entries;
use super::moving::System;
use crate::number::{Scalar, Wide};
use crate::vector::{Array, Element, Entrywise, Length, Numbers, StaticLength, Vector, VectorOf};

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
/// rustc before 1.96 crashes on the struct update of a state that a closure captures, `|v| State { v, ..start }`. A copy
/// in the closure, `let start = start;`, avoids that.
///
/// With the feature `serde` a state can be serialized and deserialized: `{"t": 0.0, "q": [0.1], "v": [0.0]}`.
/// JSON has neither NaN nor infinities: `serde_json` writes them as `null`, which is an error when a state is
/// read. Numbers are read back to the last bit only with the feature `float_roundtrip`
/// (`serde_json = { version = "1", features = ["float_roundtrip"] }`), otherwise with an error of up to one unit
/// in the last place.
#[derive(Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(
        serialize = "T: nalgebra::Scalar + serde::Serialize",
        deserialize = "T: nalgebra::Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct State<T: Element, N: Length> {
    /// Time.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "crate::system::serial::number"))]
    pub t: T,
    /// Generalized coordinates.
    #[cfg_attr(feature = "serde", serde(with = "crate::system::serial::numbers"))]
    pub q: VectorOf<T, N>,
    /// Generalized velocities.
    #[cfg_attr(feature = "serde", serde(with = "crate::system::serial::numbers"))]
    pub v: VectorOf<T, N>,
}

/// `clone_from` reuses the memory of the vectors.
impl<T: Element, N: Length> Clone for State<T, N> {
    #[inline(always)]
    fn clone(&self) -> Self {
        Self { t: self.t, q: self.q.clone(), v: self.v.clone() }
    }

    #[inline(always)]
    fn clone_from(&mut self, source: &Self) {
        self.t = source.t;
        self.q.copy_from(&source.q);
        self.v.copy_from(&source.v);
    }
}

impl<T: Element, N: Length> Copy for State<T, N> where VectorOf<T, N>: Copy {}

impl<T: Element, N: Length> State<T, N> {
    /// Combines two states entry by entry: times, coordinates and velocities.
    pub(crate) fn each_with(&self, other: &Self, mut what_becomes: impl FnMut(T, T) -> T) -> Self {
        let mut state = self.clone();
        state.t = what_becomes(self.t, other.t);
        for (x, y) in state.q.entries_mut().iter_mut().zip(other.q.entries()) {
            *x = what_becomes(*x, *y);
        }
        for (x, y) in state.v.entries_mut().iter_mut().zip(other.v.entries()) {
            *x = what_becomes(*x, *y);
        }
        state
    }
}

impl<T: Scalar, N: StaticLength> State<T, N> {
    /// Creates a state of coordinates and velocities at `t = 0`.
    pub fn new(q: impl Entries<T, N>, v: impl Entries<T, N>) -> Self {
        Self { t: T::constant(0.0), q: q.into_vector(), v: v.into_vector() }
    }

    /// Creates a state at rest at `t = 0`.
    pub fn at_rest(q: impl Entries<T, N>) -> Self {
        Self::new(q, Array::filled(T::constant(0.0)))
    }

    /// Returns the same coordinates and velocities at the time `t`.
    #[must_use]
    pub fn at_time(self, t: T) -> Self {
        Self { t, ..self }
    }
}

/// Formats a state as `t = 1.0: q = (0.1, 0.0), q̇ = (0.0, 2e-17)`. Format options apply to each number:
/// `{state:.3}`.
impl<T: Scalar, N: Length> Display for State<T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write_state(f, &self.t, [("q", self.q.entries()), ("q̇", self.v.entries())])
    }
}

/// Writes a state with numbers as in `Debug`, so very small and very large numbers have powers of ten.
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

/// Solution of the equations of motion at a state: accelerations q̈ and multipliers λ, from
///
/// ```text
/// [ M  −Fᵀ ] [ q̈ ]   [  h ]
/// [ F   0  ] [ λ ] = [ −γ ]
/// ```
///
/// The constraint force on coordinate a is Σ_α λ_α F_αa (Milton (8.7), (8.13)).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(
        serialize = "T: nalgebra::Scalar + serde::Serialize",
        deserialize = "T: nalgebra::Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct Solution<T: Element, N: StaticLength, M: StaticLength> {
    /// Generalized accelerations q̈.
    #[cfg_attr(feature = "serde", serde(with = "crate::system::serial::numbers"))]
    pub accelerations: Vector<T, N>,
    /// Lagrange multipliers λ, one per scalar constraint, in the order written.
    #[cfg_attr(feature = "serde", serde(with = "crate::system::serial::numbers"))]
    pub multipliers: Vector<T, M>,
    /// Smallest pivot of the elimination, relative to the diagonal entry that it replaces: 1 is perfect, 0
    /// singular. NaN or negative if this elimination cannot solve the system, or if products of its numbers
    /// overflow, underflow or lose digits.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "crate::system::serial::number"))]
    pub pivot: T,
    /// Number of independent constraints at this state. If it is less than `M` the multipliers are not unique;
    /// the given ones have the least norm in units in which masses are 1 and the rows of F have length 1. A constraint that is
    /// stated twice carries half of the force by each statement, whatever factor either is multiplied by.
    pub rank: usize,
}

/// State of a system: `StateOf<Pendulum>`, `StateOf<L>` in a generic function.
pub type StateOf<L> = State<<L as System>::Scalar, <L as System>::Length>;

/// Solution of the equations of motion of a system.
pub type SolutionOf<L> =
    Solution<<L as System>::Scalar, <<L as System>::Length as Length>::Static, <L as System>::M>;

impl<T: Scalar, N: StaticLength, M: StaticLength> Solution<T, N, M> {
    /// Joins accelerations and multipliers that are given, not computed by an elimination.
    pub(crate) fn given(accelerations: Vector<T, N>, multipliers: Vector<T, M>) -> Self {
        Self { accelerations, multipliers, pivot: T::constant(1.0), rank: M::COUNT }
    }

    /// Accelerations and multipliers that are not known: NaN.
    pub(crate) fn unknown() -> Self {
        let unknown = T::constant(f64::NAN);
        Self::given(Array::filled(unknown).into(), Array::filled(unknown).into())
    }
}

impl<T: Element, N: StaticLength, M: StaticLength> Solution<T, N, M> {
    /// Returns the solution in one SIMD lane.
    pub(crate) fn lane<X: Element>(&self, lane: usize) -> Solution<X, N, M>
    where
        T: Wide<X>,
    {
        Solution {
            accelerations: self.accelerations.each(|x| x.lane(lane)),
            multipliers: self.multipliers.each(|x| x.lane(lane)),
            pivot: self.pivot.lane(lane),
            rank: self.rank,
        }
    }

    /// True if the equations determine the multipliers; false if constraints depend on one another.
    pub fn multipliers_are_unique(&self) -> bool {
        self.rank == M::COUNT
    }
}
