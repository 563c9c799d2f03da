//! Lyapunov exponents: long-time growth rates of variations of a motion.

use alloc::{vec, vec::Vec};
use core::cmp::Ordering;

use nalgebra::DMatrix;

use super::Linearized;
use super::tangent::Tangent;
use super::variation::{DifferentiableMethod, Variations};
use crate::error::Error;
use crate::motion::run::{Run, Watchdog, check_end};
use crate::number::{Real, Scalar};
use crate::solution::vector_field::LagrangianVectorField;
use crate::system::State;
use crate::system::finite::check_finite;
use crate::system::lookup::entry;

/// The Lyapunov exponents of a motion, and how far they can be relied on.
#[derive(Clone, Debug, PartialEq)]
pub struct LyapunovSpectrum<T> {
    /// The exponents, the largest first: the mean rates d(ln |δ|)/dt. Along a motion that goes backwards they are rates
    /// by the time as well, not by the way back: what grows on that way has a negative one.
    pub exponents: Vec<T>,
    /// One standard error of each, from how the means over parts of the motion scatter.
    pub errors: Vec<T>,
    /// How the estimates settle: at the end of each part, the time and the means until then, in the order of the exponents.
    pub running: Vec<(T, Vec<T>)>,
}

/// Number of parts of the motion for the standard errors, after a first part in which the variations align with the growing directions.
const PARTS: usize = 20;

/// See [`Linearized::lyapunov_spectrum`].
pub(super) fn spectrum<L, D, const N: usize, const M: usize, const P: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    end: L::Scalar,
    method: &D,
) -> Result<LyapunovSpectrum<L::Scalar>, Error>
where
    L: Linearized<N, M, P, Scalar: Real>,
    D: DifferentiableMethod<L, N, M, P>,
{
    check_finite(system, state)?;
    check_end(end)?;
    let (mut run, _) = Run::begin::<L, LagrangianVectorField, _, M>(system, state, method)?;
    let start = run.state;
    let tangent = Tangent::at(system, &start)?;
    let basis = match const { M == 0 } {
        true => DMatrix::identity(2 * N, 2 * N),
        false => tangent.space()?,
    };
    let most = |j: usize| entry::<L, N, M>(basis.column(j).icamax());
    let column = |j: usize| [0, N].map(|half| basis.fixed_view::<N, 1>(half, j).into_owned());
    let mut variations = Variations::begin(&tangent, (0..basis.ncols()).map(most).collect(), column)?;
    let mut companion = method.companion(system, &start, &variations)?;
    let limits = Watchdog::new(method.limits(), &run.statistics);
    let mut parts = Vec::with_capacity(PARTS + 1);
    for part in 1..=PARTS + 1 {
        let done = L::Scalar::constant(part as f64 / (PARTS + 1) as f64);
        let stop = if part > PARTS { end } else { start.t + (end - start.t) * done };
        let (mut growth, from) = (vec![L::Scalar::constant(0.0); basis.ncols()], run.state.t);
        while run.state.t != stop {
            let prepared = method.prepare(system, &mut run, stop, &variations, &mut companion);
            let along = |run: &mut Run<_, _, N>| method.follow(system, run, &mut variations, &mut companion);
            let step = prepared.and_then(|()| {
                run.step_with::<L, LagrangianVectorField, _, _, M>(system, method, stop, &limits, along)
            });
            step?;
            let linear = &mut D::linear(&mut companion);
            variations.orthonormalize(linear, |j, length| growth[j] += Scalar::ln(length));
        }
        parts.push((stop, growth.into_iter().map(|x| x / (stop - from)).collect::<Vec<_>>()));
    }
    Ok(LyapunovSpectrum::of(&parts[1..]))
}

impl<T: Real> LyapunovSpectrum<T> {
    /// Of the means over equal parts, each with the time of its end.
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
        let mut order: Vec<usize> = (0..means.len()).collect();
        order.sort_by(|&j, &k| means[k].partial_cmp(&means[j]).unwrap_or(Ordering::Equal));
        let sorted = |all: &[T]| order.iter().map(|&j| all[j]).collect::<Vec<T>>();
        running.iter_mut().for_each(|(_, means)| *means = sorted(means));
        let errors = order.iter().map(|&j| error(j)).collect();
        Self { exponents: sorted(&means), errors, running }
    }
}
