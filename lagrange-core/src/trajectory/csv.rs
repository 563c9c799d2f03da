//! Trajectories as comma-separated values.

use core::fmt::{self, Debug, Display, Formatter};

use super::Trajectory;
use crate::names::Entry;
use crate::number::{Real, Scalar};
use crate::solution::flow::{Flow, LagrangianFlow};
use crate::solution::solve::solve;
use crate::system::{Lagrangian, State};

/// A table of a trajectory, one line a sample: `t`, coordinates `x`, velocities `x_dot`, multipliers
/// `lambda(no_slip)`, constraint forces `force(x)` and observables.
///
/// Numbers are the shortest that read back the same. Where the equations have no solution, what depends on it
/// is `NaN`.
pub struct Csv<'t, S: Lagrangian<N, M>, const N: usize, const M: usize, F = LagrangianFlow> {
    trajectory: &'t Trajectory<S, N, M, F>,
    count: usize,
}

impl<S: Lagrangian<N, M>, F, const N: usize, const M: usize> Trajectory<S, N, M, F> {
    /// A table of `count` states at evenly spaced times, as comma-separated values.
    ///
    /// Print it, or write `path.csv(200).to_string()` to a file.
    pub fn csv(&self, count: usize) -> Csv<'_, S, N, M, F> {
        Csv { trajectory: self, count }
    }
}

impl<S: Lagrangian<N, M, Scalar: Real>, F: Flow<S, N, M>, const N: usize, const M: usize> Display
    for Csv<'_, S, N, M, F>
{
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        header::<S, N, M>(f)?;
        let Trajectory { system, .. } = self.trajectory;
        self.trajectory.states(self.count).try_for_each(|state| line(f, system, &state))
    }
}

impl<S: Lagrangian<N, M>, F, const N: usize, const M: usize> Debug for Csv<'_, S, N, M, F> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Csv").field("trajectory", self.trajectory).field("count", &self.count).finish()
    }
}

fn header<L: Lagrangian<N, M>, const N: usize, const M: usize>(f: &mut Formatter<'_>) -> fmt::Result {
    f.write_str("t")?;
    L::COORDINATES.iter().try_for_each(|name| write!(f, ",{name}"))?;
    L::COORDINATES.iter().try_for_each(|name| write!(f, ",{}", Entry::Velocity(name)))?;
    L::CONSTRAINTS.iter().try_for_each(|name| write!(f, ",lambda({name})"))?;
    if M > 0 {
        L::COORDINATES.iter().try_for_each(|name| write!(f, ",force({name})"))?;
    }
    L::OBSERVABLES.iter().try_for_each(|name| write!(f, ",{name}"))?;
    writeln!(f)
}

fn line<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    f: &mut Formatter<'_>,
    system: &L,
    state: &State<L::Scalar, N>,
) -> fmt::Result {
    let solution = solve(system, state).ok();
    let multipliers = solution.map(|s| s.multipliers);
    let force = multipliers.map(|lambda| system.constraint_force(state, &lambda));
    // `Debug` of a number is its shortest form that reads back the same, with an exponent where that is shorter.
    write!(f, "{:?}", state.t)?;
    state.q.iter().chain(&state.v).try_for_each(|x| write!(f, ",{x:?}"))?;
    (0..M).try_for_each(|a| cell(f, multipliers.map(|lambda| lambda[a])))?;
    if M > 0 {
        (0..N).try_for_each(|i| cell(f, force.map(|force| force[i])))?;
    }
    let observable = |k: usize| solution.as_ref().and_then(|s| system.observable(k, state, s));
    (0..L::OBSERVABLES.len()).try_for_each(|k| cell(f, observable(k)))?;
    writeln!(f)
}

fn cell<T: Scalar>(f: &mut Formatter<'_>, value: Option<T>) -> fmt::Result {
    match value {
        Some(value) => write!(f, ",{value:?}"),
        None => write!(f, ",NaN"),
    }
}
