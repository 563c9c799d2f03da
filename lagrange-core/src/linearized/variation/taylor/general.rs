//! Derivatives of accelerations and multipliers for dependent constraints, for which the emitted elimination fails.

use crate::error::Error;
use crate::motion::taylor::expansion::General;
use crate::number::{Dual, Real, Wide};
use crate::system::{Lagrangian, RightHandSides, Solution, State};
use crate::vector::{Array, Element, Entrywise, StaticLength, from_fn, vector};

/// Factors of the general solver at a state, with the derivatives of M and F.
pub(super) struct DualGeneral<T: Element, W: Element, N: StaticLength, M: StaticLength> {
    general: General<T, N, M>,
    /// δM and δF, row by row.
    m: Array<Array<W, N>, N>,
    f: Array<Array<W, N>, M>,
}

impl<T: Real<Wide = W>, W: Wide<T>, N: StaticLength, M: StaticLength> DualGeneral<T, W, N, M> {
    #[cold]
    pub(super) fn at<L, S>(
        system: &L,
        over: &S,
        (state, varied): (&State<T, N>, &State<Dual<W>, N>),
        active: Array<bool, M>,
    ) -> Result<Self, Error>
    where
        L: Lagrangian<N = N, M = M, Scalar = T>,
        S: Lagrangian<N = N, M = M, Scalar = Dual<W>>,
    {
        let (m, f) = (over.mass_matrix(varied), over.constraint_jacobian(varied));
        let zero = W::constant(0.0);
        let f = from_fn(|a| Array::from_fn(|i| if active[a] { f[(a, i)].slope } else { zero }));
        let m = from_fn(|i| Array::from_fn(|j| m[(i, j)].slope));
        Ok(Self { general: General::at(system, state, active)?, m, f })
    }

    /// Solves M x − Fᵀλ = h and F x = −γ over dual numbers. The derivatives satisfy M δx − Fᵀδλ = δh − δM x + δFᵀλ and
    /// F δx = −δγ − δF x.
    pub(super) fn solve<L: Lagrangian<N = N, M = M, Scalar = T>>(
        &self,
        (h, gamma): &RightHandSides<Dual<W>, N, M>,
    ) -> Result<Solution<Dual<W>, N, M>, Error> {
        let values = (h.each(|x| x.value.lane(0)), gamma.each(|x| x.value.lane(0)));
        let Solution { accelerations: x, multipliers, pivot, rank } = self.general.solve::<L>(&values)?;
        let dual = |value: T| Dual { value: W::of(value), slope: W::constant(0.0) };
        let mut all = Solution {
            accelerations: x.each(dual),
            multipliers: multipliers.each(dual),
            pivot: dual(pivot),
            rank,
        };
        for lane in 0..W::COUNT {
            let (m, f) =
                (|i: usize, j: usize| self.m[i][j].lane(lane), |a: usize, i: usize| self.f[a][i].lane(lane));
            let h = vector(from_fn(|i| {
                let inertia = (0..N::COUNT).fold(h[i].slope.lane(lane), |sum, j| sum - m(i, j) * x[j]);
                (0..M::COUNT).fold(inertia, |sum, a| sum + f(a, i) * multipliers[a])
            }));
            let gamma = vector(from_fn(|a| {
                (0..N::COUNT).fold(gamma[a].slope.lane(lane), |sum, i| sum + f(a, i) * x[i])
            }));
            let change = self.general.solve::<L>(&(h, gamma))?;
            let pairs = all.accelerations.iter_mut().zip(&change.accelerations);
            let pairs = pairs.chain(all.multipliers.iter_mut().zip(&change.multipliers));
            pairs.for_each(|(x, change)| x.slope.put(lane, *change));
        }
        Ok(all)
    }
}
