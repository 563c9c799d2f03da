//! Equations of the variations at a state of the motion.

use super::Block;
use crate::derivatives::tangent::{Tangent, WideOf};
use crate::error::Error;
use crate::linearized::Linearized;
use crate::names::Entry;
use crate::number::{Real, Scalar};
use crate::system::{Direction, Lagrangian, ResidualChange};
use crate::vector::{PhaseVector, Vector, vector, zeros};

/// The variational equations at a state. Their functions take δ(q, q̇) of a block there.
pub(in crate::linearized) struct VariationalEquations<'a, L: Linearized<Scalar: Real>> {
    pub(in crate::linearized) tangent: &'a Tangent<'a, L>,
    /// Coefficients of the derivatives by parameters; `None` if no variation changes a parameter.
    by_parameters: Option<L::ParameterSlopes>,
    arguments: &'a [Entry],
}

type BlockOf<L> = Block<WideOf<L>, <L as Lagrangian>::N, <L as Linearized>::P>;
type VariationsOf<L> = PhaseVector<WideOf<L>, <L as Lagrangian>::N>;

impl<'a, L: Linearized<Scalar: Real>> VariationalEquations<'a, L> {
    pub(super) fn at(tangent: &'a Tangent<'a, L>, arguments: &'a [Entry], blocks: &[BlockOf<L>]) -> Self {
        let varies = blocks.iter().any(|block| block.rates.is_some());
        Self { tangent, by_parameters: varies.then(|| tangent.parameter_slopes()), arguments }
    }

    /// Derivative of the residual along the variations.
    #[inline]
    pub(in crate::linearized) fn changes(
        &self,
        block: &BlockOf<L>,
        y: &VariationsOf<L>,
    ) -> ResidualChange<WideOf<L>, L::N, L::M> {
        let [q, v] = y.arrays().map(vector);
        let of_state = self.tangent.changes(&Direction { t: WideOf::<L>::constant(0.0), q, v });
        match self.by_parameters.as_ref().zip(block.rates.as_ref()) {
            None => of_state,
            Some((slopes, rates)) => of_state.plus(&self.tangent.changes_by_parameters(slopes, rates)),
        }
    }

    /// Rates δ(q̇, q̈) of the variations.
    #[inline]
    pub(in crate::linearized) fn slope(
        &self,
        block: &BlockOf<L>,
        y: &VariationsOf<L>,
    ) -> Result<VariationsOf<L>, Error> {
        let rates = self.responses(block, &self.changes(block, y))?;
        Ok(PhaseVector::new([y.half(1), rates.into()]))
    }

    /// Projects variations onto the tangent space.
    pub(in crate::linearized) fn projected(
        &self,
        block: &BlockOf<L>,
        y: VariationsOf<L>,
    ) -> Result<VariationsOf<L>, Error> {
        self.half_projected(1, block, self.half_projected(0, block, y)?)
    }

    /// Projects δq (`half` 0) or δq̇ (`half` 1), by the rows of all constraints.
    pub(super) fn half_projected(
        &self,
        half: usize,
        block: &BlockOf<L>,
        mut y: VariationsOf<L>,
    ) -> Result<VariationsOf<L>, Error> {
        let changes = self.changes(block, &y);
        let left = if half == 0 { changes.position } else { changes.rate };
        let correction =
            self.responses(block, &ResidualChange { motion: zeros(), acceleration: left, ..changes })?;
        y[half].iter_mut().zip(&correction).for_each(|(x, correction)| *x = *x + *correction);
        Ok(y)
    }

    /// The δq̈ that compensates these changes of the residual.
    #[inline]
    fn responses(
        &self,
        block: &BlockOf<L>,
        changes: &ResidualChange<WideOf<L>, L::N, L::M>,
    ) -> Result<Vector<WideOf<L>, L::N>, Error> {
        let entry = |lane: usize| self.arguments[block.first + lane];
        Ok(self.tangent.responses(block.lanes, changes, entry)?.accelerations)
    }
}
