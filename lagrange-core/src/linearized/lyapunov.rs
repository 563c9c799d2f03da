//! Lyapunov exponents: long-time growth rates of variations of a motion.

use alloc::{vec, vec::Vec};

use nalgebra::DMatrix;

use super::Linearized;
use super::limits::PARTS;
use super::variation::{DifferentiableMethod, Variations, VariedRun};
use crate::derivatives::tangent::Tangent;
use crate::error::{Ending, Error};
use crate::motion::run::{Observer, Run, Watchdog, check_end};
use crate::number::{Real, Scalar, order};
use crate::system::finite::check_finite;
use crate::system::{StateOf, check_contacts, entry};
use crate::vector::{StaticLength, from_fn, vector};

/// Lyapunov exponents of a motion, with their standard errors.
#[derive(Clone, Debug, PartialEq)]
pub struct LyapunovSpectrum<T> {
    /// Exponents in descending order: the mean rates d(ln |δ|)/dt. In a motion backwards in time, dt is negative: a
    /// variation that grows along it has a negative exponent.
    pub exponents: Vec<T>,
    /// Standard error of each exponent, from the scatter of its means over parts of the motion.
    pub errors: Vec<T>,
    /// Convergence of the estimates: for each part its end time and the means up to then, in the order of the
    /// exponents.
    pub running: Vec<(T, Vec<T>)>,
}

/// See [`Linearized::lyapunov_spectrum`].
pub(crate) fn spectrum<L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>>(
    system: &L,
    state: &StateOf<L>,
    end: L::Scalar,
    method: &D,
) -> Result<LyapunovSpectrum<L::Scalar>, Error> {
    const { check_contacts(L::HAS_CONTACTS) };
    check_finite(system, state)?;
    check_end(end)?;
    let (mut run, _) = Run::<L, _>::begin(system, state, method)?;
    let start = run.state;
    let tangent = Tangent::at(system, &start)?;
    let basis = match const { <L::M>::COUNT == 0 } {
        true => DMatrix::identity(2 * <L::N>::COUNT, 2 * <L::N>::COUNT),
        false => tangent.space()?,
    };
    let most = |j: usize| entry::<L>(basis.column(j).icamax());
    let column = |j: usize| [0, <L::N>::COUNT].map(|half| vector(from_fn(|i| basis[(half + i, j)])));
    let variations = Variations::begin(&tangent, (0..basis.ncols()).map(most).collect(), column)?;
    let memory = method.companion(system, &start, &variations)?;
    let limits = Watchdog::new(method.limits(), &run.statistics);
    let growth = vec![L::Scalar::constant(0.0); variations.count()];
    let mut exponents = Growth { system, start: start.t, end, variations, memory, growth, parts: Vec::new() };
    run.drive(method, &limits, &mut exponents)?;
    Ok(LyapunovSpectrum::of(&exponents.parts[1..]))
}

/// Growth of variations along a motion.
struct Growth<'a, L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>> {
    system: &'a L,
    start: L::Scalar,
    end: L::Scalar,
    variations: Variations<L>,
    /// Memory of the method for the next step of the variations.
    memory: D::VariationMemory,
    /// Logarithm of the growth of each variation in the current part.
    growth: Vec<L::Scalar>,
    /// End time of each completed part, and the mean growth rates in it.
    parts: Vec<(L::Scalar, Vec<L::Scalar>)>,
}

impl<L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>> Growth<'_, L, D> {
    /// End time of the current part.
    fn stop(&self) -> L::Scalar {
        let part = self.parts.len() + 1;
        let done = L::Scalar::constant(part as f64 / (PARTS + 1) as f64);
        if part > PARTS { self.end } else { self.start + (self.end - self.start) * done }
    }

    /// Completes the current part: stores its mean rates.
    fn end_part(&mut self, stop: L::Scalar) {
        let from = self.parts.last().map_or(self.start, |(time, _)| *time);
        let rates = self.growth.iter().map(|growth| *growth / (stop - from)).collect();
        self.parts.push((stop, rates));
        self.growth.fill(L::Scalar::constant(0.0));
    }
}

impl<L, D> Observer<L, D> for Growth<'_, L, D>
where
    L: Linearized<Scalar: Real>,
    D: DifferentiableMethod<L>,
{
    fn system(&self) -> &L {
        self.system
    }

    fn goal(&mut self, method: &D, run: &mut Run<L, D>) -> Result<Option<L::Scalar>, Ending> {
        while self.parts.len() <= PARTS {
            let stop = self.stop();
            if run.state.t != stop {
                let Self { system, variations, memory, .. } = self;
                method.prepare(VariedRun { system, run, variations, memory }, stop)?;
                return Ok(Some(stop));
            }
            self.end_part(stop);
        }
        Ok(None)
    }

    fn follow(&mut self, method: &D, run: &mut Run<L, D>) -> Result<(), Ending> {
        let Self { system, variations, memory, .. } = self;
        method.follow(VariedRun { system, run, variations, memory })
    }

    fn keep(&mut self, _: &D, _: &mut Run<L, D>) -> Result<(), Ending> {
        let Self { variations, memory, growth, .. } = self;
        let linear = &mut D::linear(memory);
        variations.orthonormalize(linear, |j, length| growth[j] += Scalar::ln(length));
        Ok(())
    }
}

impl<T: Real> LyapunovSpectrum<T> {
    /// Averages the means over equal parts, each given with its end time.
    fn of(parts: &[(T, Vec<T>)]) -> Self {
        let zero = T::constant(0.0);
        let mut sums = vec![zero; parts.first().map_or(0, |(_, means)| means.len())];
        let running = (1..).zip(parts).map(|(count, (time, means))| {
            sums.iter_mut().zip(means).for_each(|(sum, mean)| *sum += *mean);
            (*time, sums.iter().map(|sum| *sum / T::constant(f64::from(count))).collect::<Vec<_>>())
        });
        let mut running: Vec<(T, Vec<T>)> = running.collect();
        let means = running.last().map_or(Vec::new(), |(_, means)| means.clone());
        let count = T::constant(parts.len() as f64);
        let error = |j: usize| {
            let off = |part: &(T, Vec<T>)| part.1[j] - means[j];
            let squares = parts.iter().fold(zero, |sum, part| sum + off(part) * off(part));
            Scalar::sqrt(squares / (count * (count - T::constant(1.0))))
        };
        let mut descending: Vec<usize> = (0..means.len()).collect();
        descending.sort_by(|&j, &k| order(means[k], means[j]));
        let sorted = |all: &[T]| descending.iter().map(|&j| all[j]).collect::<Vec<T>>();
        running.iter_mut().for_each(|(_, means)| *means = sorted(means));
        let errors = descending.iter().map(|&j| error(j)).collect();
        Self { exponents: sorted(&means), errors, running }
    }
}
