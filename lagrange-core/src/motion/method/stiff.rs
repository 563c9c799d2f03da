//! Whether it is stability that keeps the steps short, not the accuracy asked for.
//!
//! The last stage and the new state are two states at one time; what their slopes differ by tells how fast the fastest
//! motion near them grows or dies (Hairer and Wanner, *Solving Ordinary Differential Equations II*, IV.2). In a stiff
//! problem, step after step is as long as the method stays stable.

use super::adaptive::Adaptive;
use super::contract::{Method, Step};
use super::pair::{Pair, SLOPES, TableauRow, combine, last};
use super::step::{PairMemory, Taken};
use crate::number::{Real, Scalar};
use crate::solution::vector_field::VectorField;
use crate::statistics::Statistics;
use crate::system::Lagrangian;

/// How many of the next steps are looked at. A third of them must be as long as they can be.
const STEPS: usize = 15;

impl<P: Pair> Adaptive<P> {
    /// See [`Pace::stiffness`](crate::error::Pace::stiffness). Nothing is spent on it before it is asked for: the next steps are tried.
    #[cold]
    pub(super) fn find_stiffness<L, F, const N: usize, const M: usize>(
        &self,
        system: &L,
        memory: &PairMemory<L::Scalar, N, M>,
        end: L::Scalar,
    ) -> Option<f64>
    where
        L: Lagrangian<N, M, Scalar: Real>,
        F: VectorField<L, N, M>,
    {
        let limit = L::Scalar::constant(0.9 * stability_limit::<P>());
        let (mut memory, mut statistics) = (memory.clone(), Statistics::default());
        let (mut seen, mut longest, mut rate) = (0, 0, None);
        while seen < STEPS {
            match Method::<L, N, M, F>::step(self, system, &mut memory, end, &mut statistics) {
                Step::Rejected => continue,
                Step::Failed(_) => return None,
                Step::Accepted(_) => seen += 1,
            }
            if let Some((h, fastest)) = memory.fastest::<P>()
                && h * fastest > limit
            {
                (longest, rate) = (longest + 1, Some(fastest.to_f64()));
            }
        }
        rate.filter(|_| 3 * longest > STEPS)
    }
}

impl<T: Real, const N: usize, const M: usize> PairMemory<T, N, M> {
    /// The length of the last step, and the rate |λ| of the motion that grows or dies fastest, if it shows there.
    ///
    /// Where q̇ = λ q and q̈ = λ q̇, the product of both ratios is λ², whatever the units. So it is where q̈ = λ² q alone
    /// holds, as in a vibration.
    fn fastest<P: Pair>(&self) -> Option<(T, T)> {
        let Taken { h, .. } = self.taken.as_ref()?;
        let (stage, end) = (&self.slopes[P::STAGES.len()], &self.slopes[last::<P>()]);
        // Without the state that both start from, whose round-off may be more than they differ by.
        let (to_stage, to_end) =
            (combine(&self.slopes, P::STAGES.last()?), combine(&self.slopes, P::WEIGHTS));
        let ratio = |half: usize| {
            let apart = squared_distance(&to_end[half], &to_stage[half]);
            let round_off = T::constant(128.0 * T::EPSILON);
            let shows =
                apart > round_off * round_off * squared_distance(&to_end[half], &[T::constant(0.0); N]);
            shows.then(|| squared_distance(&end[half], &stage[half]) / apart)
        };
        // A ratio of slopes to slopes is that of slopes to states times h.
        let (h, product) = (Scalar::abs(*h), ratio(0)? * ratio(1)?);
        Some((h, Scalar::sqrt(Scalar::sqrt(product)) / h))
    }
}

fn squared_distance<T: Real, const N: usize>(a: &[T; N], b: &[T; N]) -> T {
    (0..N).fold(T::constant(0.0), |sum, i| sum + (a[i] - b[i]) * (a[i] - b[i]))
}

/// The h|λ| up to which a decay of the rate λ stays one: beyond, |R(−h|λ|)| > 1 (R is the stability function, IV.2).
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

    /// The codes DOPRI5 and DOP853 take 3.25 and 6.1 for the limit.
    #[test]
    fn the_limits_of_stability_are_those_of_the_methods() {
        assert!((stability_limit::<DormandPrince54>() - 3.3).abs() < 0.05);
        assert!((stability_limit::<DormandPrince853>() - 6.4).abs() < 0.05);
    }
}
