//! Methods along whose steps variations go.

use alloc::vec::Vec;

use super::{Linearized, Variations};
use crate::error::{Ending, Error};
use crate::linearized::tangent::WideOf;
use crate::motion::Method;
use crate::motion::run::Run;
use crate::number::Real;
use crate::solution::vector_field::PhaseVector;
use crate::system::State;

/// A [`Method`] whose steps can be differentiated, so that derivatives of a motion go along with it.
///
/// [`Dop853`](crate::Dop853), [`Dopri5`](crate::Dopri5) and other embedded [`Pair`](crate::motion::Pair)s differentiate their
/// stages. [`Taylor`](crate::Taylor) expands the motion over dual numbers, for which the number type of the system must be a
/// type parameter. There are no others.
#[diagnostic::on_unimplemented(
    message = "the steps of `{Self}` cannot be differentiated along motions of `{L}`",
    label = "no derivatives of its steps",
    note = "`Dop853` and `Dopri5` can, of every system",
    note = "`Taylor` can where the number type is a parameter, `struct X<T> {{ m: T, l: [T; 2] }}`"
)]
pub trait DifferentiableMethod<L, const N: usize, const M: usize, const P: usize>: Method<L, N, M>
where
    L: Linearized<N, M, P, Scalar: Real>,
{
    /// What variations take along beside their values.
    #[doc(hidden)]
    type VariationMemory;

    /// At the start.
    #[doc(hidden)]
    fn companion(
        &self,
        system: &L,
        start: &State<L::Scalar, N>,
        variations: &Variations<L, N, M, P>,
    ) -> Result<Self::VariationMemory, Error>;

    /// What is linear in the variations, block by block: it goes with them where they are combined. Nothing, where it
    /// is made anew from step to step.
    #[doc(hidden)]
    fn linear(companion: &mut Self::VariationMemory) -> Vec<&mut [WideOf<L, N, M>]> {
        let _ = companion;
        Vec::new()
    }

    /// Before a step towards `end`: it will be short enough for the variations.
    #[doc(hidden)]
    fn prepare(
        &self,
        system: &L,
        run: &mut Run<Self::Memory, L::Scalar, N>,
        end: L::Scalar,
        variations: &Variations<L, N, M, P>,
        companion: &mut Self::VariationMemory,
    ) -> Result<(), Ending> {
        let _ = (system, run, end, variations, companion);
        Ok(())
    }

    /// Goes along with the step that the run has taken, if it is short enough for the variations too. The error is why
    /// it is to be taken back; the variations are then what they were.
    #[doc(hidden)]
    fn follow(
        &self,
        system: &L,
        run: &mut Run<Self::Memory, L::Scalar, N>,
        variations: &mut Variations<L, N, M, P>,
        companion: &mut Self::VariationMemory,
    ) -> Result<(), Ending>;

    /// Adds what lies within the step followed last: of the motion, and of the variations as coefficients, as many for each block
    /// and step. The error is why the step is to be taken back.
    #[doc(hidden)]
    fn interpolate(
        &self,
        system: &L,
        run: &mut Run<Self::Memory, L::Scalar, N>,
        variations: &mut Variations<L, N, M, P>,
        companion: &mut Self::VariationMemory,
        within: &mut Vec<Self::Interpolant>,
        coefficients: &mut Vec<PhaseVector<WideOf<L, N, M>, N>>,
    ) -> Result<(), Ending>;

    /// The variations of a block after this part of a step, by its coefficients.
    #[doc(hidden)]
    fn between(
        coefficients: &[PhaseVector<WideOf<L, N, M>, N>],
        part: WideOf<L, N, M>,
    ) -> PhaseVector<WideOf<L, N, M>, N>;
}
