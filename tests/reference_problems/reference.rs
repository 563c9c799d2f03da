//! Problems whose motion is known, and the errors of methods on them.

use std::fmt::{self, Display, Formatter};
use std::time::Instant;

use lagrange_core::nalgebra::Const;
use lagrange_core::{Method, Sample, TaylorSeries, prelude::*};

/// Largest errors of coordinates, velocities and multipliers on a run, as fractions.
///
/// Each component is measured by its largest magnitude on the run. A component that vanishes at all times but for round-off is
/// measured by the largest magnitude of all components.
pub(crate) type Errors = [f64; 3];

/// Errors that every problem is solved to unless it states others.
pub(crate) const BAR: Errors = [1e-9, 1e-9, 1e-8];

/// Part of the largest component below which a component vanishes but for round-off.
const VANISHING: f64 = 1e-12;

/// Coordinates and velocities at a time, and multipliers if they are known.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known<const N: usize, const M: usize> {
    pub(crate) t: f64,
    pub(crate) q: [f64; N],
    pub(crate) v: [f64; N],
    pub(crate) lambda: Option<[f64; M]>,
}

/// Reads a table with the lines `t`, `q`, `v` and, for M > 0, `lambda` for each time; the start may leave out `lambda`. Another number
/// that is missing is NaN, from which every method has an error of NaN.
macro_rules! table {
    ($name:literal) => {
        $crate::reference::parse(include_str!(concat!("values/", $name, ".txt")))
    };
}
pub(crate) use table;

pub(crate) fn parse<const N: usize, const M: usize>(text: &str) -> Vec<Known<N, M>> {
    let mut known: Vec<Known<N, M>> = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let (name, numbers) = line.split_once(' ').unwrap();
        let numbers: Vec<f64> = numbers.split(' ').map(|number| number.parse().unwrap()).collect();
        if name == "t" {
            let lambda = (M == 0 || !known.is_empty()).then_some([f64::NAN; M]);
            known.push(Known { t: numbers[0], q: [f64::NAN; N], v: [f64::NAN; N], lambda });
            continue;
        }
        let last = known.last_mut().unwrap();
        match name {
            "q" => last.q = numbers.try_into().unwrap(),
            "v" => last.v = numbers.try_into().unwrap(),
            "lambda" => last.lambda = Some(numbers.try_into().unwrap()),
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
#[must_use]
pub(crate) struct Row {
    problem: &'static str,
    method: String,
    /// Infinite if the motion does not reach its end.
    pub(crate) errors: Errors,
    steps: usize,
    milliseconds: f64,
}

impl Row {
    /// Asserts that the errors are within these.
    #[track_caller]
    pub(crate) fn reaches(&self, limits: Errors) {
        assert!(self.is_within(limits), "{self}\nallowed: {limits:?}");
    }

    pub(crate) fn is_within(&self, limits: Errors) -> bool {
        self.errors.into_iter().zip(limits).all(|(error, limit)| error <= limit)
    }
}

impl Display for Row {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { problem, method, errors: [q, v, lambda], steps, milliseconds } = self;
        let reaches = if self.is_within(BAR) { "reaches the bar" } else { "" };
        write!(f, "{problem:<46} {method:<26} {q:>6.0e} {v:>6.0e} {lambda:>6.0e}")?;
        write!(f, " {steps:>6} steps {milliseconds:>9.2} ms {reaches}")
    }
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

    /// Asserts that `Taylor`, `Dop853` and, in long runs, `Dopri5` do not exceed these errors.
    #[track_caller]
    pub(crate) fn check(&self, limits: &[Errors])
    where
        L: TaylorSeries,
    {
        self.row("Taylor 2⁻⁵²", Taylor::default()).reaches(limits[0]);
        self.row("Dop853 1e-13", Dop853::with_tolerance(1e-13)).reaches(limits[1]);
        if let (true, Some(limits)) = (IS_LONG, limits.get(2)) {
            self.row("Dopri5 1e-11", Dopri5::with_tolerance(1e-11)).reaches(*limits);
        }
    }

    /// Runs a method and prints its row. The name contains the setting, a tolerance or a step.
    pub(crate) fn row<P: Method<L>>(&self, method: &str, settings: P) -> Row {
        self.measured(method, settings, true)
    }

    /// A row whose errors are measured by the known values alone: on the run, multipliers grow beyond all bounds.
    pub(crate) fn row_by_known<P: Method<L>>(&self, method: &str, settings: P) -> Row {
        self.measured(method, settings, false)
    }

    fn measured<P: Method<L>>(&self, method: &str, settings: P, by_run: bool) -> Row {
        let (method, problem, begun) = (method.to_owned(), self.name, Instant::now());
        let (errors, steps) = self.run(settings, by_run).unwrap_or_else(|error| {
            println!("{problem}, {method}: {error}");
            ([f64::INFINITY; 3], 0)
        });
        let row = Row { problem, method, errors, steps, milliseconds: 1e3 * begun.elapsed().as_secs_f64() };
        println!("{row}");
        row
    }

    /// Errors and number of steps.
    fn run<P: Method<L>>(&self, settings: P, by_run: bool) -> Result<(Errors, usize), Error> {
        let (first, last) = (&self.known[0], &self.known[self.known.len() - 1]);
        assert!(first.t < last.t, "{}: nothing is known after the start", self.name);
        let start = State::new(first.q, first.v).at_time(first.t);
        let path = self.system.integrate(start, last.t, settings)?;
        let mut components: [Vec<Component>; 3] =
            [N, N, M].map(|count| (0..count).map(|_| Component::default()).collect());
        for sample in path.steps().filter(|_| by_run) {
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
        Ok((components.map(|components| error(&components)), path.statistics().accepted))
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
        self.reached(expected);
        self.is_nonzero |= expected != 0.0;
        self.off = largest([self.off, (found - expected).abs()]);
    }
}

/// The largest error of the components of a quantity.
fn error(components: &[Component]) -> f64 {
    let whole = largest(components.iter().map(|component| component.magnitude));
    largest(components.iter().map(|component| {
        let vanishes = !component.is_nonzero || component.magnitude < VANISHING * whole;
        let scale = if vanishes { whole } else { component.magnitude };
        if component.off == 0.0 { 0.0 } else { component.off / scale }
    }))
}

/// The largest of some magnitudes; NaN if one of them is NaN.
fn largest(magnitudes: impl IntoIterator<Item = f64>) -> f64 {
    magnitudes.into_iter().fold(0.0, |largest, x| if x > largest || x.is_nan() { x } else { largest })
}

/// True if whole spans of the literature and costly methods are asked for, at the level `full`. A constant, so that what they need
/// is compiled only then.
pub(crate) const IS_LONG: bool = lagrange_random::is_full(option_env!("LAGRANGE_CASES"));

/// Asserts that a number is another to a relative error.
#[track_caller]
pub(crate) fn assert_relative(what: &str, found: f64, expected: f64, allowed: f64) {
    let error = (found - expected).abs() / expected.abs();
    assert!(error <= allowed, "{what}: {found} in place of {expected}, off by {error:e}");
}
