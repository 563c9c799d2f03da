//! Detection of stiffness: does stability limit the steps, or the requested accuracy?
//!
//! The last stage and the new state are two states at the same time. The difference of their slopes yields the rate of
//! the fastest mode near them (Hairer and Wanner, *Solving Ordinary Differential Equations II*, IV.2). In a stiff
//! problem, the steps stay at the stability limit of the method.

use super::adaptive::Adaptive;
use super::contract::{Method, Step};
use super::pair::{Pair, SLOPES, TableauRow, combine, last};
use super::pair_memory::{PairMemory, Taken};
use crate::motion::limits::{SAFETY, TRIALS};
use crate::number::limits::ACCUMULATED;
use crate::number::{Real, Scalar};
use crate::solution::vector_field::{StagePoint, VectorField};
use crate::statistics::Statistics;
use crate::system::System;
use crate::vector::{Length, StaticLength};

impl<P: Pair> Adaptive<P> {
    /// Returns [`Pace::stiffness`](crate::error::Pace::stiffness). Only this call costs time: it tries the next steps
    /// on a copy.
    #[cold]
    pub(super) fn find_stiffness<L: System<Scalar: Real>, F: VectorField<L>>(
        &self,
        system: &L,
        memory: &PairMemory<L::Scalar, L::Length, L::M>,
        end: L::Scalar,
    ) -> Option<f64> {
        let limit = L::Scalar::constant(SAFETY * stability_limit::<P>());
        let (mut memory, mut statistics) = (memory.clone(), Statistics::default());
        let velocity = memory.slope.half_if_constant(0);
        let start = F::state(system, &StagePoint { t: memory.clock.now, y: memory.y.clone(), velocity });
        let (mut seen, mut longest, mut rate) = (0, 0, None);
        while seen < TRIALS {
            match Method::<L, F>::step(
                self,
                system,
                &mut memory,
                end,
                &start,
                &mut start.clone(),
                &mut statistics,
            ) {
                Step::Rejected => continue,
                Step::Failed(_) => return None,
                Step::Accepted => seen += 1,
            }
            if let Some((h, fastest)) = memory.fastest::<P>()
                && h * fastest > limit
            {
                (longest, rate) = (longest + 1, Some(fastest.to_f64()));
            }
        }
        rate.filter(|_| 3 * longest > TRIALS)
    }
}

impl<T: Real, N: Length, M: StaticLength> PairMemory<T, N, M> {
    /// Length of the last step, and the rate |λ| of the mode that grows or decays fastest; `None` if round-off hides
    /// it.
    ///
    /// If q̇ = λ q and q̈ = λ q̇, the product of both ratios of differences is λ², whatever the units. This also holds
    /// if only q̈ = λ² q, as in a vibration.
    fn fastest<P: Pair>(&self) -> Option<(T, T)> {
        let Taken { h, .. } = self.taken.as_ref()?;
        let (stage, end) = (&self.slopes[P::STAGES.len()], &self.slopes[last::<P>()]);
        // Leave out the common start of both states: its round-off may exceed their difference.
        let difference = |row| {
            let mut sum = self.y.clone();
            combine(&self.slopes, row, &mut sum);
            sum
        };
        let (to_stage, to_end) = (difference(P::STAGES.last()?), difference(P::WEIGHTS));
        let ratio = |half: usize| {
            let apart = squared_distance(&to_end[half], &to_stage[half]);
            let round_off = T::constant(ACCUMULATED * T::EPSILON);
            let size = to_end[half].iter().fold(T::constant(0.0), |sum, &x| sum + x * x);
            let shows = apart > round_off * round_off * size;
            shows.then(|| squared_distance(&end[half], &stage[half]) / apart)
        };
        // The ratio of differences of slopes, divided by h, is the ratio of differences of slopes to differences of
        // states.
        let (h, product) = (Scalar::abs(*h), ratio(0)? * ratio(1)?);
        Some((h, Scalar::sqrt(Scalar::sqrt(product)) / h))
    }
}

fn squared_distance<T: Real>(a: &[T], b: &[T]) -> T {
    (0..a.len()).fold(T::constant(0.0), |sum, i| sum + (a[i] - b[i]) * (a[i] - b[i]))
}

/// Largest h|λ| for which a decay of rate λ stays stable: beyond it |R(−h|λ|)| > 1, with the stability function R
/// (IV.2).
fn stability_limit<P: Pair>() -> f64 {
    let grows = |x: f64| {
        let mut slopes = [1.0; SLOPES];
        let advanced = |slopes: &[f64; SLOPES], row: TableauRow| {
            row.iter().fold(1.0, |sum, (i, coefficient)| sum - x * coefficient * slopes[*i])
        };
        for (number, row) in (1..).zip(P::STAGES) {
            slopes[number] = advanced(&slopes, row);
        }
        advanced(&slopes, P::WEIGHTS).abs() > 1.0
    };
    (1..1000).map(|k| f64::from(k) / 64.0).find(|x| grows(*x)).unwrap_or(f64::INFINITY)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{DormandPrince54, DormandPrince853};

    /// The codes DOPRI5 and DOP853 use limits of 3.25 and 6.1.
    #[test]
    fn the_limits_of_stability_are_those_of_the_methods() {
        assert!((stability_limit::<DormandPrince54>() - 3.3).abs() < 0.05);
        assert!((stability_limit::<DormandPrince853>() - 6.4).abs() < 0.05);
    }
}
