//! Choice of the samples and quantities of a motion that keeps no steps.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::fmt::{self, Debug, Formatter, Write};

use nalgebra::ComplexField;

use crate::error::Error;
use crate::motion::event::EventValue;
use crate::motion::limits::RESERVED;
use crate::motion::run::is_between;
use crate::number::limits::SUM;
use crate::number::{Real, Scalar, larger};
use crate::solution::Sample;
use crate::system::System;

/// Times of the samples of a motion, or of each member of an ensemble, and the quantities to evaluate there.
pub struct RecordPlan<'a, L: System> {
    pub(crate) times: SampleTimes<L::Scalar>,
    pub(super) quantities: Vec<(&'static str, Box<Observed<'a, L>>)>,
}

impl<L: System> Debug for RecordPlan<'_, L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let names = self.quantities.iter().map(|(name, _)| *name);
        f.debug_struct("RecordPlan").field("quantities", &names.collect::<Vec<_>>()).finish_non_exhaustive()
    }
}

/// A number computed from a state.
pub(crate) type Observed<'a, L> =
    dyn Fn(&Sample<&L>) -> Result<<L as System>::Scalar, Error> + Send + Sync + 'a;

/// Times of the samples.
pub(crate) enum SampleTimes<T> {
    /// At these times, in the order of the motion.
    At(Vec<T>),
    /// At the start, and after every interval.
    Every(T),
}

impl<T: Real> SampleTimes<T> {
    /// Time of sample `number`; `None` after the end.
    pub(super) fn get(&self, number: usize, [start, end]: [T; 2]) -> Option<T> {
        match self {
            Self::At(times) => times.get(number).copied(),
            Self::Every(interval) => {
                let passed = *interval * T::constant(number as f64);
                let time = if end < start { start - passed } else { start + passed };
                // A multiple that differs from the end by rounding alone is the end.
                let is_end = Scalar::abs(time - end) <= round_off(start, end);
                let time = if is_end { end } else { time };
                is_between(start, time, end).then_some(time)
            }
        }
    }

    /// Number of samples to reserve memory for: all, but of regular ones at most [`RESERVED`].
    pub(super) fn capacity(&self, [start, end]: [T; 2]) -> usize {
        match self {
            Self::At(times) => times.len(),
            Self::Every(interval) => {
                let intervals = Scalar::abs(end - start) / *interval;
                (intervals.to_f64() as usize).min(RESERVED - 1) + 1
            }
        }
    }

    /// Checks the conditions that do not depend on start and end.
    fn check(&self) -> Result<(), Error> {
        match self {
            Self::At(times) => check_order(times),
            Self::Every(interval) => check_interval("interval of the samples", *interval),
        }
    }

    /// Checks that all times lie between start and end, in the order of the motion.
    pub(super) fn check_within(&self, [start, end]: [T; 2]) -> Result<(), Error> {
        match self {
            Self::At(times) => {
                let outside = times.iter().find(|time| !is_between(start, **time, end));
                if let Some(time) = outside {
                    let [time, start, end] = [*time, start, end].map(Real::to_f64);
                    return Err(Error::OutsideTrajectory { time, start, end });
                }
                let first = times.first().copied().unwrap_or(start);
                match times.iter().position(|time| !is_between(first, *time, end)) {
                    Some(index) => Err(Error::SampleTime { index, time: times[index].to_f64() }),
                    None => Ok(()),
                }
            }
            // With a longer interval, multiples are different times, and at most one of them is taken for the end.
            Self::Every(interval)
                if start != end && *interval <= T::constant(SUM) * round_off(start, end) =>
            {
                Err(Error::Setting { name: "interval of the samples", value: interval.to_f64() })
            }
            Self::Every(_) => Ok(()),
        }
    }
}

/// Bound on the rounding error of start + k · interval at the end. Let ε be the distance from 1 to the next number, and
/// a the larger magnitude of start and end. The interval as a number has a relative error of up to ε/2, and so has the
/// multiple, which is at most 2a long: together 2εa. The sum has an error of up to εa/2.
fn round_off<T: Real>(start: T, end: T) -> T {
    T::constant(SUM * T::EPSILON) * larger(Scalar::abs(start), Scalar::abs(end))
}

/// Checks that the times are finite and monotonic.
fn check_order<T: Real>(times: &[T]) -> Result<(), Error> {
    let goes_back = times.last() < times.first();
    let turns = |pair: &[T]| if goes_back { pair[1] > pair[0] } else { pair[1] < pair[0] };
    let infinite = times.iter().position(|t| !ComplexField::is_finite(t));
    let wrong = infinite.or_else(|| times.windows(2).position(turns).map(|before| before + 1));
    match wrong {
        Some(index) => Err(Error::SampleTime { index, time: times[index].to_f64() }),
        None => Ok(()),
    }
}

/// Checks that an interval is positive and finite.
pub(crate) fn check_interval<T: Real>(name: &'static str, interval: T) -> Result<(), Error> {
    let is_right = ComplexField::is_finite(&interval) && interval > T::constant(0.0);
    if is_right { Ok(()) } else { Err(Error::Setting { name, value: interval.to_f64() }) }
}

impl<'a, L: System<Scalar: Real>> RecordPlan<'a, L> {
    /// Creates a plan with samples at these times, without quantities.
    pub(crate) fn of(times: SampleTimes<L::Scalar>) -> Self {
        Self { times, quantities: Vec::new() }
    }

    pub(crate) fn quantity<V: EventValue<L::Scalar>>(
        &mut self,
        name: &'static str,
        function: impl Fn(&Sample<&L>) -> V + Send + Sync + 'a,
    ) {
        self.quantities.push((name, Box::new(move |sample: &Sample<&L>| function(sample).value())));
    }

    /// Checks the conditions that do not depend on start and end: the times, and that no two quantities have one name.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let repeated = |(k, name): &(usize, _)| self.quantities().take(*k).any(|earlier| earlier == *name);
        match self.quantities().enumerate().find(repeated) {
            Some((_, name)) => Err(Error::RepeatedName { name: name.into() }),
            None => self.times.check(),
        }
    }

    /// Names of the quantities.
    pub(crate) fn quantities(&self) -> impl Iterator<Item = &'static str> {
        self.quantities.iter().map(|(name, _)| *name)
    }

    /// Writes the times and the names of the quantities, to tell plans apart; functions are not part of it.
    pub(crate) fn identify(&self, to: &mut dyn Write) -> fmt::Result {
        match &self.times {
            SampleTimes::At(times) => times.iter().try_for_each(|t| write!(to, " at {:?}", t.to_f64()))?,
            SampleTimes::Every(interval) => write!(to, " at every {:?}", interval.to_f64())?,
        }
        self.quantities.iter().try_for_each(|(name, _)| write!(to, " of {name:?}"))
    }
}

#[cfg(test)]
mod tests {
    use super::SampleTimes;
    use lagrange_random::{Random, cases};

    /// Equal parts of an interval of time end at its end, whatever the rounding errors of the multiples. They do not
    /// end there if the interval is changed by more than these errors.
    #[test]
    fn multiples_of_an_interval_end_at_the_end() {
        let mut random = Random(7);
        for _ in 0..cases([20_000, 100_000, 1_000_000]) {
            let scales = [(); 2].map(|()| 2.0_f64.powf(20.0 * random.number()));
            let (start, length) = (random.number() * scales[0], random.number() * scales[1]);
            let parts = (1 + random.below(300)) as f64;
            let (end, round_off) = (start + length, f64::EPSILON * start.abs().max((start + length).abs()));
            let every = (length / parts).abs();
            if every < 1e3 * round_off {
                continue;
            }
            let times = SampleTimes::Every(every);
            let taken =
                |end: f64| (0..).map_while(|number| times.get(number, [start, end])).collect::<Vec<_>>();
            let all = taken(end);
            assert_eq!((all.len(), all.last()), (parts as usize + 1, Some(&end)), "{start} {end} {parts}");
            assert!(all.windows(2).all(|pair| (pair[1] - pair[0]) * length > 0.0));
            let off = 16.0 * round_off * length.signum();
            assert_eq!(taken(end - off).len(), parts as usize);
            assert!(taken(end + off).last().is_some_and(|last| *last != end + off));
        }
    }
}
