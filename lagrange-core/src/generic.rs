//! Types over the lengths of vectors, for functions that are generic over the system.
//!
//! The number of coordinates of a system is a type, [`Lagrangian::N`](crate::Lagrangian::N), and so is the number
//! of its constraints. (That of a [`System`](crate::System) may be a value, a [`Dyn`](nalgebra::Dyn): its states are
//! [`State<f64, Dyn>`](State), with vectors on the heap.) For a known system they are [`Const<2>`](nalgebra::Const) and the like, and
//! [`State<f64, 2>`](crate::State) is short for [`State<f64, Const<2>>`](State).
//!
//! A function for any system writes `StateOf::<L>::new(q, v)` or `generic::State { t, q, v }`, because the `State` of
//! the prelude asks for a number. Of nalgebra's operations on a [`Vector`], those that need no new storage work at
//! once: indices, `iter`, `dot`, `norm`, `amax`, `+=`, `-=`, `*=`, `axpy`, `gemv`, `copy_from`. The others, such as `+`
//! and `map`, work with the bound `DefaultAllocator: Allocator<L::N>`, and their results are copied to a [`Vector`] by
//! `copy_from`; or with `L: Lagrangian<N = Const<N>>` and a const parameter `N`, for which [`Vector`] is `SVector`.
//!
//! ```
//! # use lagrange_core::prelude::*;
//! use lagrange_core::{StateOf, generic};
//!
//! /// Kinetic energy at most quadratic in the velocities, ½ q̇ᵀ M q̇.
//! fn kinetic<L: Lagrangian<Scalar = f64>>(system: &L, state: &StateOf<L>) -> f64 {
//!     let mut p = state.v;
//!     p.gemv(1.0, &system.mass_matrix(state), &state.v, 0.0);
//!     p.dot(&state.v) / 2.0
//! }
//!
//! /// The same state with velocities reversed.
//! fn reversed<L: Lagrangian<Scalar = f64>>(state: &StateOf<L>) -> StateOf<L> {
//!     let mut v = state.v;
//!     v *= -1.0;
//!     generic::State { v, ..*state }
//! }
//! # #[derive(Lagrangian)]
//! # #[coordinates(x, y)]
//! # #[lagrangian(m/2 * (x_dot^2 + x_dot*y_dot + y_dot^2))]
//! # struct Pair { m: f64 }
//!
//! let (pair, state) = (Pair { m: 2.0 }, State::new([0.0, 0.0], [1.0, 2.0]));
//! assert_eq!((kinetic(&pair, &state), kinetic(&pair, &reversed::<Pair>(&state))), (7.0, 7.0));
//! ```

pub use crate::hamiltonian::PhaseState;
pub use crate::system::{Direction, ResidualChange, Solution, State};
#[cfg(feature = "alloc")]
pub use crate::vector::run_time::{RunTime, TwoParts};
pub use crate::vector::{
    Array, Constant, Contiguous, Element, FixedArray, Kind, Length, Matrix, Numbers, PhaseVector,
    StaticLength, Vector, VectorOf, ViewOf,
};
