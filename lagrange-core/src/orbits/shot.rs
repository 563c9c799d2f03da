//! Segments of a nearly closed orbit, and the linear equations for its correction.
//!
//! The nodes between are eliminated (condensing: Bock and Plitt 1984; Deuflhard 1974): their changes follow from that of the start, so
//! the equations left are as many as for one segment. Corrections are repeated until the gaps stay, so what the elimination loses to
//! round-off is corrected by the next.

use alloc::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::conditions::Conditions;
use super::frame::{Frame, OrbitUnits, flat, shifted};
use super::segment::Segment;
use crate::StateOf;
use crate::error::{Entry, Error};
use crate::generic::StaticLength;
use crate::linearized::{DifferentiableMethod, Linearized, Singular};
use crate::motion::Simulate;
use crate::number::{Real, Scalar, larger, power_of_epsilon};
use crate::system::entry;

/// Nodes of an orbit, its period, and the system with the parameter in question.
#[derive(Clone)]
pub(super) struct Chain<L: Linearized> {
    pub(super) system: L,
    pub(super) nodes: Vec<StateOf<L>>,
    pub(super) period: L::Scalar,
    /// Units in which gaps and steps are measured; they stay during a search.
    pub(super) units: OrbitUnits<L::Scalar>,
}

/// What is solved, beside the chain.
#[derive(Clone, Debug)]
pub(super) struct Problem<T> {
    pub(super) conditions: Conditions<T>,
    /// Parameter that changes along a family.
    pub(super) parameter: Option<usize>,
    /// Unit of the parameter, the same along a family, which may pass through zero.
    pub(super) parameter_unit: T,
    /// True if the equations depend on the time.
    pub(super) has_clock: bool,
    /// True if the energy is conserved: closing the orbit then leaves one equation that follows from the others.
    pub(super) is_conservative: bool,
}

/// A chain, integrated and differentiated.
#[derive(Clone)]
pub(super) struct Shot<L: Linearized> {
    pub(super) chain: Chain<L>,
    pub(super) frames: Vec<Frame<L::Scalar>>,
    pub(super) segments: Vec<Segment<L>>,
    /// Gap at the start of each node but the first, in components there.
    pub(super) gaps: Vec<DVector<L::Scalar>>,
    /// Residuals of closing and of the other conditions, before elimination.
    pub(super) closing: DVector<L::Scalar>,
    /// Change of the components at each node by the unknowns: components at the start, period, parameter, unfolding.
    pub(super) spread: Vec<DMatrix<L::Scalar>>,
    /// Derivative of the conditions by the unknowns.
    pub(super) jacobian: DMatrix<L::Scalar>,
}

impl<T: Real> Problem<T> {
    /// Column of the period.
    fn period_column(&self, count: usize) -> Option<usize> {
        self.conditions.period_is_free().then_some(count)
    }

    /// Column of the parameter.
    pub(super) fn parameter_column(&self, count: usize) -> Option<usize> {
        self.parameter.map(|_| count + usize::from(self.conditions.period_is_free()))
    }

    /// True if the gradient of the energy is an unknown: without it closing would be one equation too many (unfolding;
    /// Muñoz-Almaraz, Freire, Galán, Doedel and Vanderbauwhede, *Physica D* 181, 2003). Its factor vanishes at a closed orbit.
    fn is_unfolded(&self) -> bool {
        self.is_conservative && !self.conditions.is_half()
    }

    /// Number of unknowns for so many components at the start.
    pub(super) fn unknowns(&self, count: usize) -> usize {
        count
            + usize::from(self.conditions.period_is_free())
            + usize::from(self.parameter.is_some())
            + usize::from(self.is_unfolded())
    }

    /// Integrates the segments of a chain, and finds gaps and derivatives.
    pub(super) fn shoot<L, D>(&self, chain: Chain<L>, method: &D) -> Result<Shot<L>, Error>
    where
        L: Linearized<Scalar = T> + Clone,
        D: DifferentiableMethod<L> + Clone,
    {
        let (units, count) = (chain.units, chain.nodes.len());
        let duration = self.conditions.part() * chain.period / T::constant(count as f64);
        let (mut frames, mut segments) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for node in &chain.nodes {
            frames.push(Frame::at(&chain.system, node, units)?);
            segments.push(Segment::from(&chain.system, node, duration, method.clone(), self.parameter)?);
        }
        let gaps = (1..count)
            .map(|k| &frames[k].dual * (flat::<L>(&segments[k - 1].end) - flat::<L>(&chain.nodes[k])))
            .collect();
        let (closing, jacobian) = (DVector::zeros(0), DMatrix::zeros(0, 0));
        Ok(self.conditioned(Shot { chain, frames, segments, gaps, closing, spread: Vec::new(), jacobian }))
    }

    /// A shot of the same segments with these conditions.
    pub(super) fn conditioned<L: Linearized<Scalar = T> + Clone>(&self, mut shot: Shot<L>) -> Shot<L> {
        let last = self.spread(&mut shot);
        self.close(&mut shot, &last);
        shot
    }

    /// Derivative of the end of segment `k` by the unknowns, from that of its start.
    fn follow<L: Linearized<Scalar = T>>(&self, shot: &Shot<L>, k: usize) -> DMatrix<T> {
        let (segment, frame) = (&shot.segments[k], &shot.frames[k]);
        let mut end = &segment.by_state * (&frame.basis * &shot.spread[k]);
        let segments = T::constant(shot.segments.len() as f64);
        // The start of a segment moves in time too, which matters if there is a clock.
        let later = &segment.rate - &segment.by_state * &frame.rate;
        let per_period =
            (&segment.rate + later * T::constant(k as f64)) * (self.conditions.part() / segments);
        let count = frame.count();
        if let Some(column) = self.period_column(count) {
            let mut column = end.column_mut(column);
            column += &per_period * shot.chain.period;
        }
        if let (Some(column), Some([by, _])) = (self.parameter_column(count), &segment.by_parameter) {
            let (value, unit) = self.parameter_of(&shot.chain.system);
            let by_period = self.conditions.period_by(self.parameter, value, shot.chain.period);
            let mut column = end.column_mut(column);
            column += (by + per_period * by_period) * unit;
        }
        end
    }

    /// Value of the parameter, and its unit.
    pub(super) fn parameter_of<L: Linearized<Scalar = T>>(&self, system: &L) -> (T, T) {
        let value = self.parameter.map_or(T::constant(0.0), |k| system.parameters()[k]);
        (value, self.parameter_unit)
    }

    /// Change of node `k` with the parameter, where a constraint moves with it.
    fn moved<L: Linearized<Scalar = T>>(&self, shot: &Shot<L>, k: usize) -> Option<DVector<T>> {
        let [_, start] = shot.segments[k].by_parameter.as_ref()?;
        Some(start * self.parameter_of(&shot.chain.system).1)
    }

    /// Fills the changes of the nodes by the unknowns; returns that of the end.
    fn spread<L: Linearized<Scalar = T>>(&self, shot: &mut Shot<L>) -> DMatrix<T> {
        let count = shot.frames[0].count();
        shot.spread = alloc::vec![DMatrix::identity(count, self.unknowns(count))];
        for k in 0..shot.segments.len() - 1 {
            let mut end = self.follow(shot, k);
            if let (Some(column), Some(moved)) = (self.parameter_column(count), self.moved(shot, k + 1)) {
                let mut column = end.column_mut(column);
                column -= moved;
            }
            shot.spread.push(&shot.frames[k + 1].dual * end);
        }
        self.follow(shot, shot.segments.len() - 1)
    }

    /// Fills the conditions: the orbit closes, or meets its mirror image; the start does not slide along the orbit; the energy is as
    /// demanded.
    fn close<L: Linearized<Scalar = T> + Clone>(&self, shot: &mut Shot<L>, last: &DMatrix<T>) {
        let (frame, n, count) = (&shot.frames[0], <L::N>::COUNT, shot.frames[0].count());
        let (start, end) =
            (flat::<L>(&shot.chain.nodes[0]), flat::<L>(&shot.segments[shot.segments.len() - 1].end));
        let energy = frame.energy(&shot.chain.system, &shot.chain.nodes[0]);
        let column = self.parameter_column(count);
        let mut first = &frame.basis * &shot.spread[0];
        if let (Some(column), Some(moved)) = (column, self.moved(shot, 0)) {
            let mut column = first.column_mut(column);
            column += moved;
        }
        let mut rows: Vec<(T, DVector<T>)> = Vec::new();
        let row_of = |a: &DMatrix<T>, i: usize| a.row(i).transpose() / shot.chain.units.unit(i, n);
        if self.conditions.is_half() {
            for &i in &self.conditions.mirror {
                let half = self.advance(i) * T::constant(0.5);
                rows.push((start[i] / shot.chain.units.unit(i, n), row_of(&first, i)));
                rows.push(((end[i] - half) / shot.chain.units.unit(i, n), row_of(last, i)));
            }
        } else {
            let advanced = DVector::from_fn(2 * n, |i, _| start[i] + self.advance(i));
            let gap = &frame.dual * (end - advanced);
            let mut by = &frame.dual * (last - &first);
            if let (true, Some((gradient, _))) = (self.is_unfolded(), &energy) {
                let unfolding = by.ncols() - 1;
                by.column_mut(unfolding).copy_from(gradient);
            }
            rows.extend((0..count).map(|i| (gap[i], by.row(i).transpose())));
            if let (false, Some(along)) = (self.has_clock, frame.along()) {
                rows.push((T::constant(0.0), (along.transpose() * &shot.spread[0]).transpose()));
            }
        }
        if let (Some(demanded), Some((gradient, length))) = (self.conditions.energy, &energy) {
            let off = (shot.chain.system.energy(&shot.chain.nodes[0]) - demanded) / *length;
            let mut by = (gradient.transpose() * &shot.spread[0]).transpose();
            if let Some(column) = column {
                by[column] += self.energy_by_parameter(&shot.chain) / *length;
            }
            rows.push((off, by));
        }
        shot.closing = DVector::from_iterator(rows.len(), rows.iter().map(|(off, _)| *off));
        shot.jacobian = DMatrix::from_fn(rows.len(), self.unknowns(count), |i, j| rows[i].1[j]);
    }

    /// Growth of entry `i` of (q, q̇) in a period.
    fn advance(&self, i: usize) -> T {
        let found = self.conditions.advance.iter().find(|(j, _)| *j == i);
        found.map_or(T::constant(0.0), |(_, by)| *by)
    }

    /// Derivative of the energy by the parameter, in its unit, by a central difference of a state that follows the constraints.
    fn energy_by_parameter<L: Linearized<Scalar = T> + Clone>(&self, chain: &Chain<L>) -> T {
        let Some(k) = self.parameter else { return T::constant(0.0) };
        let (value, unit) = self.parameter_of(&chain.system);
        let step = power_of_epsilon::<T>(1.0 / 3.0);
        let [ahead, behind] = [step, -step].map(|by| {
            let mut system = chain.system.clone();
            system.set_parameter(k, value + by * unit);
            let start = system.make_consistent(&chain.nodes[0]).map_or(chain.nodes[0], |found| found.0);
            system.energy(&start)
        });
        (ahead - behind) / (step + step)
    }

    /// The chain moved by these changes of the unknowns; gaps between are closed to first order.
    pub(super) fn moved_by<L: Linearized<Scalar = T> + Clone>(
        &self,
        shot: &Shot<L>,
        step: &DVector<T>,
        closes_gaps: bool,
    ) -> Result<Chain<L>, Error> {
        let count = shot.frames[0].count();
        let mut chain = shot.chain.clone();
        if let (Some(k), Some(column)) = (self.parameter, self.parameter_column(count)) {
            let (value, unit) = self.parameter_of(&chain.system);
            chain.system.set_parameter(k, value + step[column] * unit);
        }
        if let Some(column) = self.period_column(count) {
            chain.period *= T::constant(1.0) + step[column];
        } else if let Some(period) = self.conditions.given(&chain.system) {
            chain.period = period;
        }
        let offsets = shot.offsets();
        let first = chain.nodes[0].t;
        let duration = self.conditions.part() * chain.period / T::constant(chain.nodes.len() as f64);
        for (k, node) in chain.nodes.iter_mut().enumerate() {
            let mut by = &shot.spread[k] * step;
            if closes_gaps {
                by += &offsets[k];
            }
            node.t = first + duration * T::constant(k as f64);
            *node = shifted::<L>(node, &(&shot.frames[k].basis * by));
            if const { <L::M>::COUNT > 0 } {
                *node = chain.system.make_consistent(node)?.0;
            }
        }
        Ok(chain)
    }
}

impl<L: Linearized<Scalar: Real>> Shot<L> {
    /// Derivative of segment `k` between the frames at its ends; the frame after the last segment is the first.
    pub(super) fn factor(&self, k: usize) -> DMatrix<L::Scalar> {
        let next = (k + 1) % self.segments.len();
        &self.frames[next].dual * (&self.segments[k].by_state * &self.frames[k].basis)
    }

    /// Changes of the nodes that close the gaps between, for a start that stays.
    fn offsets(&self) -> Vec<DVector<L::Scalar>> {
        self.offsets_of(&self.gaps)
    }

    pub(super) fn offsets_of(&self, gaps: &[DVector<L::Scalar>]) -> Vec<DVector<L::Scalar>> {
        let mut offsets = alloc::vec![DVector::zeros(self.frames[0].count())];
        for (k, gap) in gaps.iter().enumerate() {
            let next = self.factor(k) * &offsets[k] + gap;
            offsets.push(next);
        }
        offsets
    }

    /// Change of the conditions if the nodes move by the offsets.
    pub(super) fn folded(&self, offset: &DVector<L::Scalar>, mirror: &[usize]) -> DVector<L::Scalar> {
        let k = self.segments.len() - 1;
        let end = &self.segments[k].by_state * (&self.frames[k].basis * offset);
        let mut folded = DVector::zeros(self.closing.len());
        if mirror.is_empty() {
            let components = &self.frames[0].dual * end;
            folded.rows_mut(0, components.len()).copy_from(&components);
        } else {
            let n = <L::N>::COUNT;
            for (row, &i) in mirror.iter().enumerate() {
                folded[2 * row + 1] = end[i] / self.chain.units.unit(i, n);
            }
        }
        folded
    }

    /// Right-hand side of the condensed equations.
    pub(super) fn condensed(&self, mirror: &[usize]) -> DVector<L::Scalar> {
        let offsets = self.offsets();
        &self.closing + self.folded(&offsets[offsets.len() - 1], mirror)
    }

    /// Largest coordinate and velocity along the orbit.
    pub(super) fn size(&self) -> OrbitUnits<L::Scalar> {
        self.segments
            .iter()
            .map(|segment| segment.size)
            .reduce(OrbitUnits::united)
            .unwrap_or(self.chain.units)
    }

    /// Length of all residuals.
    pub(super) fn distance(&self) -> L::Scalar {
        let squares = self.gaps.iter().fold(self.closing.norm_squared(), |sum, gap| sum + gap.norm_squared());
        Scalar::sqrt(squares)
    }

    /// Largest gap, relative to the size of the orbit.
    pub(super) fn largest_gap(&self) -> L::Scalar {
        self.gaps.iter().fold(self.closing.amax(), |most, gap| larger(most, gap.amax()))
    }

    /// Entry of the state with the largest gap, and the gap.
    pub(super) fn worst(&self, conditions: &Conditions<L::Scalar>) -> (Entry, L::Scalar) {
        let (n, size) = (<L::N>::COUNT, |x: L::Scalar| Scalar::abs(x));
        let mut worst = (0, L::Scalar::constant(0.0));
        let mut see = |i: usize, gap: L::Scalar| {
            if size(gap) / self.chain.units.unit(i, n) > size(worst.1) / self.chain.units.unit(worst.0, n) {
                worst = (i, gap);
            }
        };
        for (k, gap) in self.gaps.iter().enumerate() {
            (&self.frames[k + 1].basis * gap).iter().enumerate().for_each(|(i, gap)| see(i, *gap));
        }
        if conditions.is_half() {
            let ends = conditions.mirror.iter().flat_map(|i| [*i; 2]);
            ends.zip(self.closing.iter()).for_each(|(i, off)| see(i, *off * self.chain.units.unit(i, n)));
        } else {
            let gap = self.closing.rows(0, self.frames[0].count()).into_owned();
            (&self.frames[0].basis * gap).iter().enumerate().for_each(|(i, gap)| see(i, *gap));
        }
        (entry::<L>(worst.0), worst.1)
    }
}

/// Least step u with A u = −r, damped, over the singular values above `part` of the largest.
pub(super) fn least_step<T: Real>(
    a: &DMatrix<T>,
    r: &DVector<T>,
    damping: T,
    part: T,
) -> Result<DVector<T>, Error> {
    let factors = Singular::of(a).ok_or(Error::EigenvaluesNotFound)?;
    Ok(factors.step(r.iter().copied(), (factors.norm() * part, damping), |_, x| x))
}
