//! A periodic orbit.

use alloc::vec::Vec;
use core::fmt::{self, Debug, Display, Formatter};

use nalgebra::{Complex, DMatrix};

use super::conditions::repeats;
use super::digits::rounded;
use super::error::OrbitError;
use super::frame::{Frame, OrbitUnits};
use super::monodromy::Monodromy;
use super::multipliers::reciprocal;
use super::shot::{Chain, Problem, Shot};
use crate::StateOf;
use crate::error::Error;
use crate::generic::StaticLength;
use crate::linearized::{DifferentiableMethod, Linearized, Stability};
use crate::number::{Real, Scalar, exceeds};

/// A periodic orbit, with its stability.
///
/// Sizes are relative: to the largest coordinate along the orbit for coordinates, to the largest velocity for velocities.
#[derive(Clone)]
pub struct PeriodicOrbit<L: Linearized> {
    /// The system, with the parameters of the orbit.
    pub system: L,
    /// State at the start, and again after a period.
    pub start: StateOf<L>,
    /// Period.
    pub period: L::Scalar,
    /// Starts of the segments, the first of which is [`start`](Self::start).
    pub nodes: Vec<StateOf<L>>,
    /// Largest gap between the end of a segment, as the method computes it, and the start of the next. This is measured.
    pub gap: L::Scalar,
    /// Estimate of the distance from a true orbit: the largest change of a node, or relative change of the period, in the step of
    /// Newton's method that would close the gaps and undo the errors of the method, as a motion back over each segment shows
    /// them. It is exact to first order, and not proved: a bound would need the second derivatives of the motion. Methods that are
    /// their own inverse, such as `Gauss` and `Verlet`, show no error on the way back: the orbit is then one of their map.
    pub error: L::Scalar,
    /// Steps of Newton's method.
    pub iterations: usize,
    /// Derivative of the motion once around.
    pub monodromy: Monodromy<L::Scalar>,
    pub(super) units: OrbitUnits<L::Scalar>,
}

impl<L: Linearized<Scalar: Real>> PeriodicOrbit<L> {
    /// Floquet multipliers; see [`Monodromy::multipliers`].
    ///
    /// # Errors
    /// [`Error::EigenvaluesNotFound`].
    pub fn multipliers(&self) -> Result<Vec<Complex<L::Scalar>>, Error> {
        self.monodromy.multipliers()
    }

    /// Stability indices (λ + 1/λ)/2 of the pairs of multipliers other than the trivial ones: real and between −1 and 1 for a pair on
    /// the unit circle. Of a motion that is not symplectic, those of all multipliers.
    ///
    /// # Errors
    /// [`Error::EigenvaluesNotFound`].
    pub fn stability_indices(&self) -> Result<Vec<Complex<L::Scalar>>, Error> {
        let half = L::Scalar::constant(0.5);
        let step = if self.monodromy.is_symplectic() { 2 } else { 1 };
        let index = |x: Complex<L::Scalar>| {
            let inverse = reciprocal(x);
            Complex::new(half * (x.re + inverse.re), half * (x.im + inverse.im))
        };
        Ok(self.monodromy.nontrivial()?.into_iter().step_by(step).map(index).collect())
    }

    /// Stability, as far as the multipliers decide; see [`Monodromy::stability`].
    ///
    /// # Errors
    /// [`Error::EigenvaluesNotFound`].
    pub fn stability(&self) -> Result<Stability, Error> {
        self.monodromy.stability()
    }

    /// Energy at the start.
    pub fn energy(&self) -> L::Scalar {
        self.system.energy(&self.start)
    }
}

/// Leaves out the system, which need not implement `Debug`.
impl<L: Linearized<Scalar: Real>> Debug for PeriodicOrbit<L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("PeriodicOrbit")
            .field("system", &L::NAME)
            .field("start", &self.start)
            .field("period", &self.period)
            .field("gap", &self.gap)
            .field("error", &self.error)
            .field("iterations", &self.iterations)
            .finish_non_exhaustive()
    }
}

/// Prints start and period to the digits that the error leaves, the error, and the [`Monodromy`].
impl<L: Linearized<Scalar: Real>> Display for PeriodicOrbit<L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let error = self.error.to_f64();
        let part = if error > L::Scalar::EPSILON { error } else { L::Scalar::EPSILON };
        let digits =
            |x: L::Scalar, unit: L::Scalar| L::Scalar::constant(rounded(x.to_f64(), part * unit.to_f64()));
        writeln!(
            f,
            "periodic orbit of {}: period {}, off by {error:.1e}",
            L::NAME,
            digits(self.period, self.period)
        )?;
        let mut start = self.start;
        start.q.iter_mut().for_each(|x| *x = digits(*x, self.units.q));
        start.v.iter_mut().for_each(|x| *x = digits(*x, self.units.v));
        writeln!(f, "start: {start}")?;
        write!(f, "{}", self.monodromy)
    }
}

/// Orthonormal basis of the components that are orthogonal to these.
fn complement<T: Real>(count: usize, directions: &[nalgebra::DVector<T>]) -> DMatrix<T> {
    let mut columns: Vec<_> = directions.to_vec();
    columns.extend((0..count).map(|i| {
        let mut unit = nalgebra::DVector::zeros(count);
        unit[i] = T::constant(1.0);
        unit
    }));
    let q = DMatrix::from_columns(&columns).qr().q();
    q.columns(directions.len(), count - directions.len()).into_owned()
}

impl<T: Real> Problem<T> {
    /// The periodic orbit of a corrected shot; its second half is the mirror image of the first, and is checked. An orbit that has
    /// shrunk to √tolerance of the guess counts as an equilibrium: it is one to the tolerance in the square of its size.
    pub(super) fn orbit<L, D>(
        &self,
        shot: &Shot<L>,
        iterations: usize,
        method: &D,
        tolerance: T,
    ) -> Result<PeriodicOrbit<L>, Error>
    where
        L: Linearized<Scalar = T> + Clone,
        D: DifferentiableMethod<L> + Clone,
    {
        let velocity = shot.size().v;
        if !self.has_clock && velocity <= Scalar::sqrt(tolerance) * shot.chain.units.v {
            let (period, velocity) = (shot.chain.period.to_f64(), velocity.to_f64());
            return Err(OrbitError::Equilibrium { period, velocity }.into());
        }
        if self.has_clock && !repeats(&shot.chain.system, &shot.chain.nodes, shot.chain.period) {
            return Err(OrbitError::NotItsClock { period: shot.chain.period.to_f64() }.into());
        }
        let whole = self.whole();
        let around = self.whole_of(&whole, shot, method)?;
        let gap = around.largest_gap();
        if self.conditions.is_half() && exceeds(gap, Scalar::sqrt(tolerance)) {
            let (entry, gap) = around.worst(&whole.conditions);
            let (gap, period) = (gap.to_f64(), shot.chain.period.to_f64());
            return Err(OrbitError::NotMirrored { entry, gap, period }.into());
        }
        let error = whole.error_of(&around, method)?;
        let monodromy = whole.monodromy(&around);
        let units = around.size();
        let Chain { system, nodes, period, .. } = around.chain;
        Ok(PeriodicOrbit { system, start: nodes[0], period, nodes, gap, error, iterations, monodromy, units })
    }

    fn whole(&self) -> Self {
        Self { conditions: self.conditions.whole(), parameter: None, ..self.clone() }
    }

    /// Monodromy of the whole orbit of a shot.
    pub(super) fn once_around<L, D>(&self, shot: &Shot<L>, method: &D) -> Result<Monodromy<T>, Error>
    where
        L: Linearized<Scalar = T> + Clone,
        D: DifferentiableMethod<L> + Clone,
    {
        let whole = self.whole();
        Ok(whole.monodromy(&self.whole_of(&whole, shot, method)?))
    }

    /// The whole orbit of a shot, with the conditions of `whole`.
    pub(super) fn whole_of<L, D>(&self, whole: &Self, shot: &Shot<L>, method: &D) -> Result<Shot<L>, Error>
    where
        L: Linearized<Scalar = T> + Clone,
        D: DifferentiableMethod<L> + Clone,
    {
        match self.conditions.is_half() {
            true => whole.shoot(self.unfolded(shot), method),
            false => Ok(whole.conditioned(shot.clone())),
        }
    }

    /// Chain of the whole orbit, from that of half of it.
    fn unfolded<L: Linearized<Scalar = T> + Clone>(&self, shot: &Shot<L>) -> Chain<L> {
        let mut chain = shot.chain.clone();
        let (n, count) = (<L::N>::COUNT, chain.nodes.len());
        let duration = chain.period / T::constant(2.0 * count as f64);
        let mirrored = |state: &StateOf<L>, k: usize| {
            let mut image = *state;
            for &i in &self.conditions.mirror {
                if i < n { image.q[i] = -image.q[i] } else { image.v[i - n] = -image.v[i - n] }
            }
            for (i, by) in &self.conditions.advance {
                image.q[*i] += *by;
            }
            image.t = chain.nodes[0].t + duration * T::constant(k as f64);
            image
        };
        let half = shot.segments[count - 1].end;
        let second = (count..2 * count).map(|k| match k == count {
            true => half.at_time(chain.nodes[0].t + duration * T::constant(k as f64)),
            false => mirrored(&chain.nodes[2 * count - k], k),
        });
        let second: Vec<_> = second.collect();
        chain.nodes.extend(second);
        chain
    }

    /// Monodromy of a closed orbit: multipliers that are 1 for every orbit of the kind are split off.
    pub(super) fn monodromy<L: Linearized<Scalar = T> + Clone>(&self, shot: &Shot<L>) -> Monodromy<T> {
        let (first, m) = (&shot.frames[0], shot.segments.len());
        let product = (0..m)
            .fold(DMatrix::identity(first.count(), first.count()), |product, k| shot.factor(k) * product);
        let norm = product.norm();
        let columns = &first.basis * (product * (&first.dual * &first.tangents));
        let start = shot.chain.nodes[0];
        let end = StateOf::<L> { t: start.t + shot.chain.period, ..start };
        let around = Monodromy::of(&shot.chain.system, [&start, &end], first.tangents.clone(), columns);
        let splits = if self.has_clock { None } else { self.trivial(shot) };
        let Some(splits) = splits else {
            return around.with_factors((0..m).map(|k| shot.factor(k)).collect(), 0, norm);
        };
        let reduced = (0..m).map(|k| splits[(k + 1) % m].tr_mul(&(shot.factor(k) * &splits[k])));
        let trivial = first.count() - splits[0].ncols();
        around.with_factors(reduced.collect(), trivial, norm)
    }

    /// Bases of the components at each node across the motion and, where the energy is conserved, along its surface: the quotient of the
    /// surface by the motion, to which the derivatives descend.
    fn trivial<L: Linearized<Scalar = T> + Clone>(&self, shot: &Shot<L>) -> Option<Vec<DMatrix<T>>> {
        let across = |(frame, node): (&Frame<T>, &StateOf<L>)| {
            let mut directions = alloc::vec![frame.along()?];
            if self.is_conservative {
                directions.push(frame.energy(&shot.chain.system, node)?.0);
            }
            Some(complement(frame.count(), &directions))
        };
        shot.frames.iter().zip(&shot.chain.nodes).map(across).collect()
    }
}
