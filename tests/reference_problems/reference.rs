//! Errors of motions against reference values.
//!
//! The error of a quantity is the largest |error| of its components, each relative to the largest magnitude of the component on
//! the run. Coordinates, velocities and multipliers are separate quantities.

use std::fmt::{self, Display, Formatter};
use std::sync::Once;
use std::time::{Duration, Instant};

use lagrange_core::nalgebra::{Const, SVector};
use lagrange_core::{Method, prelude::*};

/// Number of evenly spaced samples of a run that scale the errors, beside the reference moments.
const SCALING_SAMPLES: usize = 101;

/// Part of the largest component below which a component vanishes but for round-off.
const VANISHING: f64 = 1e-12;

/// Reference values at a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment<const N: usize, const M: usize> {
    pub(crate) t: f64,
    pub(crate) q: [f64; N],
    pub(crate) v: [f64; N],
    /// `None` if the constraints do not determine the multipliers.
    pub(crate) lambda: Option<[f64; M]>,
}

/// Samples that determine the largest magnitudes of the components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Scale {
    /// Evenly spaced samples of the run, and the reference moments.
    Run,
    /// The reference moments alone: on the run, multipliers grow beyond all bounds.
    Moments,
}

/// Errors of coordinates, velocities and multipliers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Errors {
    pub(crate) q: f64,
    pub(crate) v: f64,
    /// `None` without multipliers, or if nothing determines them.
    pub(crate) lambda: Option<f64>,
}

/// Largest errors allowed unless a problem states others.
pub(crate) const BAR: Errors = Errors { q: 1e-9, v: 1e-9, lambda: Some(1e-8) };

impl Errors {
    /// True if all errors that have a reference are within the bar.
    fn are_within(&self, bar: Self) -> bool {
        let multipliers = self.lambda.zip(bar.lambda).is_none_or(|(error, bar)| error <= bar);
        self.q <= bar.q && self.v <= bar.v && multipliers
    }
}

/// A system with its start and reference values at later times. The motion ends at the last of them.
pub(crate) struct Problem<L, const N: usize, const M: usize> {
    pub(crate) name: &'static str,
    pub(crate) system: L,
    pub(crate) start: State<f64, N>,
    pub(crate) moments: Vec<Moment<N, M>>,
    pub(crate) scale: Scale,
    pub(crate) bar: Errors,
}

/// A method on a problem: its setting, the errors or the reason why the motion ended early, and the cost.
#[must_use]
pub(crate) struct Row {
    problem: &'static str,
    method: String,
    pub(crate) outcome: Result<Errors, String>,
    bar: Errors,
    pub(crate) steps: usize,
    time: Duration,
}

impl<L, const N: usize, const M: usize> Problem<L, N, M>
where
    L: Lagrangian<N = Const<N>, M = Const<M>, Scalar = f64>,
{
    /// Integrates by a method, prints the row of the table, and returns it.
    pub(crate) fn run<P: Method<L>>(&self, method: &str, by: P) -> Row {
        let Self { name, system, start, moments, bar, .. } = self;
        let begun = Instant::now();
        let run = system.motion(*start).by(by).towards(moments.last().unwrap().t);
        let time = begun.elapsed();
        let (steps, outcome) = match run {
            Err(error) => (0, Err(error.to_string())),
            Ok(path) => {
                let steps = path.statistics().accepted;
                match path.finished() {
                    Err(error) => (steps, Err(error.to_string())),
                    Ok(path) => (steps, self.errors(&path).map_err(|error| error.to_string())),
                }
            }
        };
        let row = Row { problem: name, method: method.to_owned(), outcome, bar: *bar, steps, time };
        row.print();
        row
    }

    fn errors(&self, path: &Trajectory<&L>) -> Result<Errors, Error> {
        let mut largest = [Largest::default(), Largest::default(), Largest::default()];
        for moment in &self.moments {
            let sample = path.at(moment.t)?;
            let (state, lambda) = (sample.state(), sample.solution()?.multipliers);
            largest[0].compare(&state.q, &moment.q);
            largest[1].compare(&state.v, &moment.v);
            if let Some(expected) = &moment.lambda {
                largest[2].compare(&lambda, expected);
            }
        }
        if self.scale == Scale::Run {
            for sample in path.samples(SCALING_SAMPLES) {
                largest[0].scale(&sample.state().q);
                largest[1].scale(&sample.state().v);
                largest[2].scale(&sample.solution()?.multipliers);
            }
        }
        let [q, v, lambda] = largest.map(|largest| largest.relative());
        // A motion without coordinates has no error, and would be within every bar.
        Ok(Errors { q: q.unwrap(), v: v.unwrap(), lambda })
    }
}

/// Largest error and largest magnitude of each component.
#[derive(Default)]
struct Largest {
    errors: Vec<f64>,
    magnitudes: Vec<f64>,
}

impl Largest {
    fn compare<const K: usize>(&mut self, found: &SVector<f64, K>, expected: &[f64; K]) {
        self.errors.resize(K, 0.0);
        for ((error, found), expected) in self.errors.iter_mut().zip(found).zip(expected) {
            *error = larger(*error, (found - expected).abs());
        }
        self.scale(&SVector::from(*expected));
    }

    fn scale<const K: usize>(&mut self, values: &SVector<f64, K>) {
        self.magnitudes.resize(K, 0.0);
        for (magnitude, value) in self.magnitudes.iter_mut().zip(values) {
            *magnitude = magnitude.max(value.abs());
        }
    }

    /// The largest relative error; `None` if nothing was compared. A component that vanishes to round-off is compared with the
    /// largest of the others.
    fn relative(&self) -> Option<f64> {
        let largest = self.magnitudes.iter().copied().fold(0.0, f64::max);
        let relative = |(error, magnitude): (&f64, &f64)| {
            let scale = if *magnitude < VANISHING * largest { largest } else { *magnitude };
            if *error == 0.0 { 0.0 } else { error / scale }
        };
        self.errors.iter().zip(&self.magnitudes).map(relative).reduce(larger)
    }
}

/// The larger of two numbers; NaN if one is NaN.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

impl Row {
    /// Asserts that the motion is within the bar of its problem.
    #[track_caller]
    pub(crate) fn reaches_bar(&self) {
        assert!(self.is_within_bar(), "{self}\nallowed: {:?}", self.bar);
    }

    pub(crate) fn is_within_bar(&self) -> bool {
        self.outcome.as_ref().is_ok_and(|errors| errors.are_within(self.bar))
    }

    fn print(&self) {
        static HEAD: Once = Once::new();
        HEAD.call_once(|| {
            println!("| problem | method | q | q̇ | λ | reaches the bar | steps | ms |");
            println!("|---|---|---:|---:|---:|---|---:|---:|");
        });
        println!("{self}");
    }
}

impl Display for Row {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { problem, method, outcome, steps, time, .. } = self;
        write!(f, "| {problem} | {method} | ")?;
        match outcome {
            Ok(Errors { q, v, lambda }) => {
                let lambda = lambda.map_or_else(|| "—".to_owned(), |lambda| format!("{lambda:.1e}"));
                write!(f, "{q:.1e} | {v:.1e} | {lambda}")?;
            }
            Err(reason) => write!(f, "{reason} | | ")?,
        }
        let reached = if self.is_within_bar() { "yes" } else { "no" };
        write!(f, " | {reached} | {steps} | {:.1} |", 1e3 * time.as_secs_f64())
    }
}

/// True if long motions and costly methods are asked for. A constant, so that what they need is compiled only then.
pub(crate) const IS_LONG: bool = lagrange_random::is_full(option_env!("LAGRANGE_CASES"));

/// Asserts that a number is another to a relative error.
#[track_caller]
pub(crate) fn assert_relative(what: &str, found: f64, expected: f64, allowed: f64) {
    let error = (found - expected).abs() / expected.abs();
    assert!(error <= allowed, "{what}: {found} in place of {expected}, off by {error:e}");
}
