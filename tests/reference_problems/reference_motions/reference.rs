//! Problems whose motion is known, and the errors of methods on them.

// Helpers of tests may panic as tests do.
#![allow(clippy::unwrap_used)]

use std::time::Instant;

use lagrange_core::nalgebra::Const;
use lagrange_core::{Method, Sample, TaylorSeries, prelude::*};

/// Largest errors of coordinates, velocities and multipliers on a run, as fractions.
///
/// Each component is measured by its largest magnitude on the run. A component that is known to be zero at all times is
/// measured by the largest magnitude of all components.
pub(crate) type Errors = [f64; 3];

/// Errors that at least one method must reach on each problem.
pub(crate) const BAR: Errors = [1e-9, 1e-9, 1e-8];

/// Coordinates and velocities at a time, and multipliers if they are known.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known<const N: usize, const M: usize> {
    pub(crate) t: f64,
    pub(crate) q: [f64; N],
    pub(crate) v: [f64; N],
    pub(crate) lambda: Option<[f64; M]>,
}

/// Reads a table with the lines `t`, `q`, `v` and, for M > 0, `lambda` for each time. A number that is missing is NaN,
/// from which every method has an error of NaN.
macro_rules! table {
    ($name:literal) => {
        $crate::reference_motions::reference::parse(include_str!(concat!("values/", $name, ".txt")))
    };
}
pub(crate) use table;

pub(crate) fn parse<const N: usize, const M: usize>(text: &str) -> Vec<Known<N, M>> {
    let mut known: Vec<Known<N, M>> = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let (name, numbers) = line.split_once(' ').unwrap();
        let numbers: Vec<f64> = numbers.split(' ').map(|number| number.parse().unwrap()).collect();
        let last = known.last_mut();
        match name {
            "t" => {
                let unread =
                    Known { t: numbers[0], q: [f64::NAN; N], v: [f64::NAN; N], lambda: Some([f64::NAN; M]) };
                known.push(unread);
            }
            "q" => last.unwrap().q = numbers.try_into().unwrap(),
            "v" => last.unwrap().v = numbers.try_into().unwrap(),
            "lambda" => last.unwrap().lambda = Some(numbers.try_into().unwrap()),
            _ => panic!("a line `{name}` in a table"),
        }
    }
    known
}

/// A system and its motion at some times, in their order. The first is the start.
#[derive(Debug)]
pub(crate) struct Problem<L, const N: usize, const M: usize> {
    pub(crate) name: &'static str,
    pub(crate) system: L,
    pub(crate) known: Vec<Known<N, M>>,
}

/// A row of the table: errors and cost of a method on a problem.
pub(crate) struct Row {
    method: &'static str,
    errors: Errors,
    steps: usize,
    milliseconds: f64,
}

impl<L, const N: usize, const M: usize> Problem<L, N, M>
where
    L: Lagrangian<N = Const<N>, M = Const<M>, Scalar = f64>,
{
    /// Drops the known values after this time, for a quick run.
    pub(crate) fn until(mut self, t: f64) -> Self {
        self.known.retain(|known| known.t <= t);
        self
    }

    /// Runs the methods that serve all systems, prints a row for each, and checks that those named do not exceed these
    /// errors. The error of multipliers is zero where none is known.
    pub(crate) fn check(&self, limits: &[(&str, Errors)])
    where
        L: TaylorSeries,
        Dop853: Method<L>,
        Dopri5: Method<L>,
    {
        self.check_rows(&self.rows(), limits);
    }

    /// A row for each method that serves all systems; `Dopri5` over whole spans alone. A further method is a line here. One that serves some systems
    /// only is a [`row`](Self::row) that the problem adds to these before it calls [`check_rows`](Self::check_rows).
    pub(crate) fn rows(&self) -> Vec<Row>
    where
        L: TaylorSeries,
        Dop853: Method<L>,
        Dopri5: Method<L>,
    {
        let mut rows = vec![
            self.row("Taylor 2e-16", Taylor::default()),
            self.row("Dop853 1e-13", Dop853::with_tolerance(1e-13)),
        ];
        if ARE_SPANS_WHOLE {
            rows.push(self.row("Dopri5 1e-11", Dopri5::with_tolerance(1e-11)));
        }
        rows
    }

    /// Checks that these methods do not exceed these errors, and that one method reaches the bar. A limit of `Dopri5` counts
    /// over whole spans.
    pub(crate) fn check_rows(&self, rows: &[Row], limits: &[(&str, Errors)]) {
        let named = |name: &str| rows.iter().find(|row| row.method.starts_with(name)).unwrap();
        let counts = |method: &str| ARE_SPANS_WHOLE || method != "Dopri5";
        for (method, limit) in limits.iter().filter(|(method, _)| counts(method)) {
            let errors = named(method).errors;
            assert!(is_within(errors, *limit), "{}: {method} has the errors {errors:?}", self.name);
        }
        assert!(
            rows.iter().any(|row| is_within(row.errors, BAR)),
            "{}: no method reaches the bar",
            self.name
        );
    }

    /// Runs a method and prints its row. The name contains the setting, a tolerance or a step. A run that does not reach
    /// the end has infinite errors.
    pub(crate) fn row<P: Method<L>>(&self, method: &'static str, settings: P) -> Row {
        let name = self.name;
        let row = self.run(method, settings).unwrap_or_else(|error| {
            println!("{name:<46} {method:<13} {error}");
            Row { method, errors: [f64::INFINITY; 3], steps: 0, milliseconds: 0.0 }
        });
        let Row { errors: [q, v, lambda], steps, milliseconds, .. } = row;
        let is_known = M > 0 && self.known.iter().all(|known| known.lambda.is_some());
        let lambda = if is_known { format!("{lambda:.0e}") } else { String::new() };
        let reaches = if is_within(row.errors, BAR) { "reaches the bar" } else { "" };
        println!(
            "{name:<46} {method:<13} {q:>6.0e} {v:>6.0e} {lambda:>6} {steps:>6} steps {milliseconds:>9.2} ms {reaches}"
        );
        row
    }

    fn run<P: Method<L>>(&self, method: &'static str, settings: P) -> Result<Row, Error> {
        let (first, last) = (&self.known[0], &self.known[self.known.len() - 1]);
        assert!(first.t < last.t, "{}: nothing is known after the start", self.name);
        let start = State::new(first.q, first.v).at_time(first.t);
        let begun = Instant::now();
        let path = self.system.integrate(start, last.t, settings)?;
        let milliseconds = 1e3 * begun.elapsed().as_secs_f64();
        let mut components: [Vec<Component>; 3] =
            [N, N, M].map(|count| (0..count).map(|_| Component::default()).collect());
        for sample in path.steps() {
            for (component, value) in components.iter_mut().zip(Self::values(&sample)?) {
                component.iter_mut().zip(value).for_each(|(component, value)| component.reached(value));
            }
        }
        for known in &self.known {
            let lambda = known.lambda.map_or(Vec::new(), Vec::from);
            let expected = [known.q.to_vec(), known.v.to_vec(), lambda];
            let found = Self::values(&path.at(known.t)?)?;
            for ((component, found), expected) in components.iter_mut().zip(found).zip(expected) {
                for ((component, found), expected) in component.iter_mut().zip(found).zip(expected) {
                    component.compare(found, expected);
                }
            }
        }
        let errors = components.each_ref().map(|components| error(components));
        Ok(Row { method, errors, steps: path.statistics().accepted, milliseconds })
    }

    /// Coordinates, velocities and multipliers.
    fn values(sample: &Sample<&L>) -> Result<[Vec<f64>; 3], Error> {
        let state = sample.state();
        let lambda = if M == 0 { Vec::new() } else { sample.solution()?.multipliers.as_slice().to_vec() };
        Ok([state.q.as_slice().to_vec(), state.v.as_slice().to_vec(), lambda])
    }
}

/// Largest magnitude and largest error of one component of q, q̇ or λ on a run.
#[derive(Default)]
struct Component {
    magnitude: f64,
    is_nonzero: bool,
    off: f64,
}

impl Component {
    fn reached(&mut self, value: f64) {
        self.magnitude = largest([self.magnitude, value.abs()]);
    }

    fn compare(&mut self, found: f64, expected: f64) {
        self.is_nonzero |= expected != 0.0;
        self.off = largest([self.off, (found - expected).abs()]);
    }
}

/// The largest error of the components of a quantity.
fn error(components: &[Component]) -> f64 {
    let whole = largest(components.iter().map(|component| component.magnitude));
    largest(components.iter().map(|component| {
        let scale = if component.is_nonzero { component.magnitude } else { whole };
        if component.off == 0.0 { 0.0 } else { component.off / scale }
    }))
}

/// The largest of some magnitudes; NaN if one of them is NaN.
pub(crate) fn largest(magnitudes: impl IntoIterator<Item = f64>) -> f64 {
    magnitudes.into_iter().fold(0.0, |largest, x| if x > largest || x.is_nan() { x } else { largest })
}

fn is_within(errors: Errors, limits: Errors) -> bool {
    errors.into_iter().zip(limits).all(|(error, limit)| error <= limit)
}

/// True if whole spans of the literature are asked for, at the level `full`. A constant, so
/// that what they need is compiled only then.
pub(crate) const ARE_SPANS_WHOLE: bool = lagrange_random::is_full(option_env!("LAGRANGE_CASES"));
