//! A motion with its derivatives by where it starts and by parameters.

use alloc::{format, string::String, vec::Vec};
use core::fmt::{self, Debug, Formatter};

use nalgebra::DMatrix;

use super::Linearized;
use super::argument::Argument;
use super::tangent::{Tangent, WideOf};
use super::variation::Variations;
use crate::ending::Ending;
use crate::error::Error;
use crate::motion::method::interpolant::evaluate;
use crate::motion::run::{Run, Watchdog, check_end};
use crate::motion::{Adaptive, Pair};
use crate::number::{Over, Real, Scalar, Wide};
use crate::solution::flow::{LagrangianFlow, Phase};
use crate::system::finite::check_finite;
use crate::system::{State, lookup};
use crate::trajectory::{Path, Trajectory};

/// A motion, and how it changes with entries of its start and with parameters.
///
/// What changes is named in the call that integrates: coordinates and velocities of the start, and parameters. On
/// constraints, derivatives lie in their tangent space at every time.
pub struct Sensitivities<
    'a,
    L: Linearized<N, M, P, Scalar: Real>,
    const N: usize,
    const M: usize,
    const P: usize,
> {
    trajectory: Trajectory<&'a L, N, M>,
    variations: Variations<L, N, M, P>,
    names: Vec<String>,
    /// Start and length of each step.
    steps: Vec<[L::Scalar; 2]>,
    /// Step by step and block by block, the coefficients of what lies between, as many for each.
    coefficients: Vec<Phase<WideOf<L, N, M>, N>>,
}

/// Derivatives of a state of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity<T, const N: usize> {
    /// The state.
    pub state: State<T, N>,
    /// Of the coordinates, a row each, by each argument, a column each.
    pub q: DMatrix<T>,
    /// Of the velocities.
    pub v: DMatrix<T>,
}

/// See [`Linearized::integrate_sensitivities`].
pub(super) fn integrate<'a, L, Q, const N: usize, const M: usize, const P: usize>(
    system: &'a L,
    state: &State<L::Scalar, N>,
    end: L::Scalar,
    method: &Adaptive<Q>,
    names: &[&str],
) -> Result<Sensitivities<'a, L, N, M, P>, Error>
where
    L: Linearized<N, M, P, Scalar: Real>,
    Q: Pair,
{
    let arguments = Argument::named::<L, N, M, P>(names)?;
    let names = arguments.iter().map(|argument| format!("{}", argument.entry::<L, N, M, P>())).collect();
    check_finite(system, state)?;
    check_end(end)?;
    let (mut run, adjustment) = Run::begin::<L, LagrangianFlow, _, M>(system, state, method)?;
    let mut path = Path::from(run.state);
    let mut variations = Variations::begin(system, &run.state, arguments)?;
    let limits = Watchdog::new(method.limits(), &run.statistics);
    let (mut steps, mut coefficients) = (Vec::new(), Vec::new());
    let ending = loop {
        if run.state.t == end {
            break Ending::Complete { time: end.to_f64() };
        }
        let along = |run: &mut Run<_, _, N>| {
            variations.follow(system, method, run)?;
            variations.interpolate(system, method, run, &mut coefficients)
        };
        match run.step_with::<L, LagrangianFlow, _, _, M>(system, method, end, &limits, along) {
            Ok(interpolant) => path.push(run.state, interpolant),
            Err(ending) => break ending,
        }
        steps.push([run.before.t, run.state.t - run.before.t]);
    };
    let trajectory = Trajectory::new(system, path.finish(), ending, run.statistics, adjustment).finished()?;
    Ok(Sensitivities { trajectory, variations, names, steps, coefficients })
}

impl<L, const N: usize, const M: usize, const P: usize> Debug for Sensitivities<'_, L, N, M, P>
where
    L: Linearized<N, M, P, Scalar: Real>,
{
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut sensitivities = f.debug_struct("Sensitivities");
        sensitivities.field("trajectory", &self.trajectory).field("arguments", &self.names).finish()
    }
}

impl<'a, L, const N: usize, const M: usize, const P: usize> Sensitivities<'a, L, N, M, P>
where
    L: Linearized<N, M, P, Scalar: Real>,
{
    /// The motion.
    pub fn trajectory(&self) -> &Trajectory<&'a L, N, M> {
        &self.trajectory
    }

    /// The names of the arguments, in the order of the columns.
    pub fn arguments(&self) -> &[String] {
        &self.names
    }

    /// The state at this time and its derivatives.
    ///
    /// # Errors
    /// As [`Trajectory::at`]; as [`Linearized::jacobian`].
    pub fn at(&self, t: L::Scalar) -> Result<Sensitivity<L::Scalar, N>, Error> {
        let state = *self.trajectory.at(t)?.state();
        let (count, blocks) = (self.names.len(), self.variations.blocks());
        let (mut q, mut v) = (DMatrix::zeros(N, count), DMatrix::zeros(N, count));
        let lanes = <WideOf<L, N, M> as Wide<L::Scalar>>::COUNT;
        let found = if t == self.trajectory.end().time() { None } else { self.step(t) };
        let tangent =
            if const { M > 0 } { Some(Tangent::at(*self.trajectory.system(), &state)) } else { None };
        let tangent = tangent.transpose()?;
        for block in 0..blocks {
            let mut y = match found {
                None => *self.variations.block(block),
                Some((step, part)) => {
                    let each = self.coefficients.len() / (self.steps.len() * blocks);
                    let first = each * (step * blocks + block);
                    evaluate(&self.coefficients[first..first + each], WideOf::<L, N, M>::of(part)).0
                }
            };
            if let Some(tangent) = &tangent {
                y = self.variations.projected(block, tangent, y)?;
            }
            for column in lanes * block..count.min(lanes * (block + 1)) {
                for i in 0..N {
                    q[(i, column)] = y[0][i].lane(column - lanes * block);
                    v[(i, column)] = y[1][i].lane(column - lanes * block);
                }
            }
        }
        Ok(Sensitivity { state, q, v })
    }

    /// The derivative of coordinate `coordinate` by `argument` at this time.
    ///
    /// # Errors
    /// As [`at`](Self::at); [`Error::UnknownName`].
    pub fn coordinate(&self, t: L::Scalar, coordinate: &str, argument: &str) -> Result<L::Scalar, Error> {
        let row = lookup::index::<L, N, M>(&L::COORDINATES, "coordinate", coordinate)?;
        let column = lookup::index::<L, N, M>(&self.names, "argument of these derivatives", argument)?;
        Ok(self.at(t)?.q[(row, column)])
    }

    /// The step of this time, and which part of it has passed.
    fn step(&self, t: L::Scalar) -> Option<(usize, L::Scalar)> {
        let is_past = |[start, length]: &[L::Scalar; 2]| (t - *start) / *length >= L::Scalar::constant(0.0);
        let step = self.steps.partition_point(is_past).checked_sub(1)?;
        let [start, length] = self.steps[step];
        Some((step, (t - start) / length))
    }
}
