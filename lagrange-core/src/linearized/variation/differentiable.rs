//! Methods whose steps can be differentiated.

use alloc::vec::Vec;
use core::fmt::{self, Debug, Formatter};

use super::{Linearized, Variations};
use crate::derivatives::tangent::WideOf;
use crate::error::{Ending, Error};
use crate::motion::Method;
use crate::motion::run::Run;
use crate::number::Real;
use crate::solution::interpolant::evaluate;
use crate::system::StateOf;
use crate::vector::PhaseVector;

/// A motion during its integration, with its variations and the memory of the method for them.
pub struct VariedRun<'r, L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>> {
    pub(in crate::linearized) system: &'r L,
    pub(in crate::linearized) run: &'r mut Run<L, D>,
    pub(in crate::linearized) variations: &'r mut Variations<L>,
    pub(in crate::linearized) memory: &'r mut D::VariationMemory,
}

impl<L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>> Debug for VariedRun<'_, L, D> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("VariedRun").field("variations", &self.variations.arguments()).finish_non_exhaustive()
    }
}

/// A [`Method`] whose steps can be differentiated, so that derivatives of a motion can be integrated with it.
///
/// [`Dop853`](crate::Dop853), [`Dopri5`](crate::Dopri5), other embedded [`Pair`](crate::motion::Pair)s and
/// [`RungeKutta4`](crate::RungeKutta4) differentiate their stages, and [`Radau`](crate::linearized::Radau) the equations of its
/// stages. [`Taylor`](crate::Taylor) expands the motion over dual numbers, and the methods that keep the structure of mechanics
/// ([`FixedStep`](crate::motion::FixedStep)) take their steps over dual numbers; for both, the number type of the system must be a
/// type parameter. Derivatives by a `FixedStep` are those of the discrete map, so they are a symplectic matrix along a symplectic
/// method, to round-off.
#[diagnostic::on_unimplemented(
    message = "the steps of `{Self}` cannot be differentiated along motions of `{L}`",
    label = "no derivatives of its steps",
    note = "take `Dop853`, `Dopri5` or `RungeKutta4`, for every system, or `Radau` if it is stiff",
    note = "or, where the number type is a parameter, `struct X<T> {{ m: T, l: [T; 2] }}`: `Taylor`, `Verlet`, `Gauss`, `Lobatto` or `DAlembert`"
)]
pub trait DifferentiableMethod<L: Linearized<Scalar: Real>>: Method<L> + Sized {
    /// Memory of the method for the variations, beside their values.
    #[doc(hidden)]
    type VariationMemory;

    /// Creates the memory at the start of a motion.
    #[doc(hidden)]
    fn companion(
        &self,
        system: &L,
        start: &StateOf<L>,
        variations: &Variations<L>,
    ) -> Result<Self::VariationMemory, Error>;

    /// Prepares the memory for a motion from another start, or of a changed system.
    #[doc(hidden)]
    fn restart(&self, at: VariedRun<'_, L, Self>) -> Result<(), Error> {
        *at.memory = self.companion(at.system, &at.run.state, at.variations)?;
        Ok(())
    }

    /// Parts of the memory that are linear in the variations, block by block: linear combinations of variations apply
    /// to them too. Empty if the memory is recomputed at each step.
    #[doc(hidden)]
    fn linear(companion: &mut Self::VariationMemory) -> Vec<&mut PhaseVector<WideOf<L>, L::N>> {
        let _ = companion;
        Vec::new()
    }

    /// Called before a step towards `end`: limits its length to what the variations allow.
    #[doc(hidden)]
    fn prepare(&self, at: VariedRun<'_, L, Self>, end: L::Scalar) -> Result<(), Ending> {
        let _ = (at, end);
        Ok(())
    }

    /// Applies the step that the run has taken to the variations, if it is short enough for them. An error means that
    /// the step is to be taken back; the variations are then unchanged.
    #[doc(hidden)]
    fn follow(&self, at: VariedRun<'_, L, Self>) -> Result<(), Ending>;

    /// Appends dense output of the last step: an interpolant of the motion, and coefficients for the variations, the
    /// same number for each block and step. An error means that the step is to be taken back.
    #[doc(hidden)]
    fn interpolate(
        &self,
        at: VariedRun<'_, L, Self>,
        within: &mut Vec<Self::Interpolant>,
        coefficients: &mut Vec<PhaseVector<WideOf<L>, L::N>>,
    ) -> Result<(), Ending>;

    /// Variations of a block at a fraction of a step, from its coefficients: by default those of the interpolants of pairs.
    #[doc(hidden)]
    fn between(
        coefficients: &[PhaseVector<WideOf<L>, L::N>],
        part: WideOf<L>,
    ) -> PhaseVector<WideOf<L>, L::N> {
        evaluate(coefficients, part).0
    }
}
