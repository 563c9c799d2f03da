//! The variational equations, along the steps of a motion.
//!
//! A step of the variations is the derivative of the step of the motion, its length held: the stages are those of the
//! motion, differentiated, each by its own factor (internal differentiation: Bock, *Numerical treatment of inverse problems
//! in chemical reaction kinetics*, 1981; Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, II.6,
//! "Sensitivity analysis"). What a step ends in is projected onto the tangent space, which is the derivative of the
//! projection of the state where that lies on the constraints: δq += x with M x = Fᵀμ, F x = −δΦ, then δq̇ by
//! δ(F q̇ + b).

use alloc::vec::Vec;

use nalgebra::{ComplexField, SVector};

use super::argument::parameter;
use super::tangent::{Tangent, WideOf};
use super::{Direction, Linearized, ResidualChange, StateDerivatives};
use crate::ending::Ending;
use crate::error::Error;
use crate::motion::method::interpolant::hermite;
use crate::motion::method::pair::{SLOPES, Slopes, advance, last};
use crate::motion::method::step::Memory;
use crate::motion::run::Run;
use crate::motion::{Adaptive, Combination, Method, Pair};
use crate::names::Entry;
use crate::number::{Over, Real, Scalar, Wide, exceeds, vector};
use crate::solution::flow::{LagrangianFlow, Phase};
use crate::solution::solve::solve_near;
use crate::system::{Solution, State};

/// What lies within a step of the motion.
type Within<Q, L, const N: usize, const M: usize> = <Adaptive<Q> as Method<L, N, M>>::Interpolant;

/// Variations of a motion, as many as there are lanes.
struct Block<W, const N: usize, const P: usize> {
    /// δ(q, q̇), and where the step taken last starts.
    y: Phase<W, N>,
    start: Phase<W, N>,
    /// Of the step taken last; the first that of its start.
    slopes: Slopes<W, N>,
    /// Where it ends, the slope.
    slope: Phase<W, N>,
    /// At which parameters change, if any does.
    rates: Option<SVector<W, P>>,
    /// One over the size of what is varied: that of a parameter, or 1.
    unit: W,
    /// How many of the lanes are taken.
    lanes: usize,
}

/// Variations of a motion by some of what it depends on.
pub(super) struct Variations<
    L: Linearized<N, M, P, Scalar: Real>,
    const N: usize,
    const M: usize,
    const P: usize,
> {
    arguments: Vec<Entry>,
    blocks: Vec<Block<WideOf<L, N, M>, N, P>>,
}

impl<L, const N: usize, const M: usize, const P: usize> Variations<L, N, M, P>
where
    L: Linearized<N, M, P, Scalar: Real>,
{
    /// At the start, along each of these columns of δ(q, q̇), and by those of the arguments that are parameters. On
    /// constraints they go to the tangent space: parameters may shift the start, and of a change of it nothing but the part along
    /// the constraints changes the motion.
    pub(super) fn begin(
        tangent: &Tangent<'_, L, N, M>,
        arguments: Vec<Entry>,
        column: impl Fn(usize) -> [SVector<L::Scalar, N>; 2],
    ) -> Result<Self, Error> {
        let lanes = <WideOf<L, N, M> as Wide<L::Scalar>>::COUNT;
        let parameters: Vec<_> = arguments.iter().map(|entry| parameter::<L, N, M, P>(*entry)).collect();
        let values = tangent.system.parameters();
        let mut blocks: Vec<Block<WideOf<L, N, M>, N, P>> =
            parameters.chunks(lanes).map(|parameters| Block::of(parameters, &values)).collect();
        for j in 0..arguments.len() {
            let column = column(j);
            let entries = column.iter().flat_map(SVector::iter);
            blocks[j / lanes].y_mut().iter_mut().zip(entries).for_each(|(wide, x)| wide.put(j % lanes, *x));
        }
        let mut variations = Self { arguments, blocks };
        variations.arrive(tangent)?;
        Ok(variations)
    }

    /// How many variations there are.
    pub(super) fn count(&self) -> usize {
        self.arguments.len()
    }

    /// Makes the variations orthonormal, one after the other (Gram and Schmidt, each twice), and gives to `take` how long each
    /// was beside those before it. Slopes go with them: they are linear.
    pub(super) fn orthonormalize(&mut self, mut take: impl FnMut(usize, L::Scalar)) {
        let lanes = <WideOf<L, N, M> as Wide<L::Scalar>>::COUNT;
        let count = self.count();
        for j in 0..count {
            for k in (0..j).chain(0..j) {
                let along = self.dot(j, k);
                let [into, from] = [j, k].map(|j| (j / lanes, j % lanes));
                for i in 0..2 * N {
                    for of in [Block::y_mut, Block::slope_mut] {
                        let x = of(&mut self.blocks[from.0])[i].lane(from.1);
                        let entry = &mut of(&mut self.blocks[into.0])[i];
                        let left = entry.lane(into.1) - along * x;
                        entry.put(into.1, left);
                    }
                }
            }
            let length = Scalar::sqrt(self.dot(j, j));
            for of in [Block::y_mut, Block::slope_mut] {
                for entry in of(&mut self.blocks[j / lanes]) {
                    let scaled = entry.lane(j % lanes) / length;
                    entry.put(j % lanes, scaled);
                }
            }
            take(j, length);
        }
    }

    /// The scalar product of two variations.
    fn dot(&self, j: usize, k: usize) -> L::Scalar {
        let lanes = <WideOf<L, N, M> as Wide<L::Scalar>>::COUNT;
        let entries =
            |j: usize| self.blocks[j / lanes].y.as_flattened().iter().map(move |x| x.lane(j % lanes));
        entries(j).zip(entries(k)).fold(L::Scalar::constant(0.0), |sum, (x, y)| sum + x * y)
    }

    /// Of what they are, in their order.
    pub(super) fn arguments(&self) -> &[Entry] {
        &self.arguments
    }

    /// How many blocks there are.
    pub(super) fn blocks(&self) -> usize {
        self.blocks.len()
    }

    /// δ(q, q̇) in a block.
    pub(super) fn block(&self, index: usize) -> &Phase<WideOf<L, N, M>, N> {
        &self.blocks[index].y
    }

    /// Goes along with the step that the run has taken, if it is short enough for the variations too.
    ///
    /// # Errors
    /// Why it is to be taken back.
    pub(super) fn follow<Q: Pair>(
        &mut self,
        system: &L,
        method: &Adaptive<Q>,
        run: &mut Run<Memory<L::Scalar, N, M>, L::Scalar, N>,
    ) -> Result<(), Ending> {
        self.blocks.iter_mut().for_each(|block| (block.start, block.slopes[0]) = (block.y, block.slope));
        let time = run.before.t.to_f64();
        let slope = run.memory.ensure_slope::<L, LagrangianFlow>(system, &mut run.statistics);
        let followed = slope.and_then(|()| self.go::<Q>(system, &run.memory));
        let followed = followed.map_err(|error| Ending::of(error, time));
        let (error, worst) =
            followed.inspect_err(|_| self.step_back()).map(|()| self.error(method, &run.memory))?;
        if method.accepts(error) {
            method.accept_with(&mut run.memory, error);
            return Ok(());
        }
        self.step_back();
        Err(Ending::StepTooSmall { time, entry: self.arguments[worst] })
    }

    /// As before the step followed last.
    fn step_back(&mut self) {
        self.blocks.iter_mut().for_each(|block| (block.y, block.slope) = (block.start, block.slopes[0]));
    }

    fn go<Q: Pair>(&mut self, system: &L, memory: &Memory<L::Scalar, N, M>) -> Result<(), Error> {
        self.stages::<Q>(system, memory, (1, Q::STAGES))?;
        self.end::<Q>(system, memory)
    }

    /// The largest error of a variation as a part of the tolerance, and of which.
    fn error<Q: Pair>(&self, method: &Adaptive<Q>, memory: &Memory<L::Scalar, N, M>) -> (L::Scalar, usize) {
        let zero = L::Scalar::constant(0.0);
        let Some((from, h, _)) = memory.last_step() else { return (zero, 0) };
        let (lanes, tolerance) =
            (<WideOf<L, N, M> as Wide<L::Scalar>>::COUNT, method.tolerance::<L::Scalar>());
        let places = [&from.y, &memory.y];
        let error = |block: &Block<_, N, P>| {
            let ends = [&block.start, &block.y];
            tolerance.error_of_variations::<Q, _, _, N>(&block.slopes, h, ends, places, block.unit)
        };
        let errors: Vec<_> = self.blocks.iter().map(error).collect();
        // What is no number is larger than any.
        let size = |error: L::Scalar| {
            if error.is_finite() { error } else { L::Scalar::constant(f64::INFINITY) }
        };
        let each = (0..self.count()).map(|j| (size(errors[j / lanes].lane(j % lanes)), j));
        each.fold((zero, 0), |worst, one| if exceeds(one.0, worst.0) { one } else { worst })
    }

    /// What lies within the step followed last: of the motion, and of the variations as coefficients, which are added.
    ///
    /// # Errors
    /// Why the step is to be taken back.
    pub(super) fn interpolate<Q: Pair>(
        &mut self,
        system: &L,
        method: &Adaptive<Q>,
        run: &mut Run<Memory<L::Scalar, N, M>, L::Scalar, N>,
        coefficients: &mut Vec<Phase<WideOf<L, N, M>, N>>,
    ) -> Result<Within<Q, L, N, M>, Ending> {
        let Run { memory, statistics, before, .. } = run;
        let interpolant = Method::<L, N, M>::interpolant(method, system, memory, statistics);
        let more = (last::<Q>() + 1, Q::INTERPOLATION_STAGES);
        let within = interpolant.and_then(|within| self.stages::<Q>(system, memory, more).map(|()| within));
        let within = within.map_err(|error| Ending::of(error, before.t.to_f64()));
        let within = within.inspect_err(|_| self.step_back())?;
        if let Some((_, h, _)) = memory.last_step() {
            let h = WideOf::<L, N, M>::of(h);
            self.blocks.iter().for_each(|block| block.push_coefficients::<Q>(h, coefficients));
        }
        Ok(within)
    }

    /// The slopes of these stages of a step taken, the first of which has the number given.
    fn stages<Q: Pair>(
        &mut self,
        system: &L,
        memory: &Memory<L::Scalar, N, M>,
        (first, rows): (usize, &[Combination]),
    ) -> Result<(), Error> {
        let Some((from, h, slopes)) = memory.last_step() else { return Ok(()) };
        let mut place = from.y;
        for (number, row) in (first..).zip(rows) {
            advance(&from.y, h, slopes, row, &mut place);
            let state = state_at(from.t + h * L::Scalar::constant(Q::NODES[number]), &place);
            let tangent = tangent_at(system, &state, &slopes[number][1], &memory.active)?;
            let by_parameters = self.parameter_slopes(&tangent);
            for (k, block) in self.blocks.iter_mut().enumerate() {
                let names = lane_names::<L, N, M>(&self.arguments, k);
                let mut y = block.start;
                advance(&block.start, WideOf::<L, N, M>::of(h), &block.slopes, row, &mut y);
                block.slopes[number] = block.slope_at(&tangent, &by_parameters, &y, &names)?;
            }
        }
        Ok(())
    }

    /// The end of a step, on the tangent space, and the slope there.
    fn end<Q: Pair>(&mut self, system: &L, memory: &Memory<L::Scalar, N, M>) -> Result<(), Error> {
        let Some((_, h, _)) = memory.last_step() else { return Ok(()) };
        for block in &mut self.blocks {
            advance(&block.start, WideOf::<L, N, M>::of(h), &block.slopes, Q::WEIGHTS, &mut block.y);
        }
        let state = state_at(memory.clock.now, &memory.y);
        self.arrive(&tangent_at(system, &state, &memory.slope[1], &memory.active)?)?;
        self.blocks.iter_mut().for_each(|block| block.slopes[last::<Q>()] = block.slope);
        Ok(())
    }

    /// Onto the tangent space of a state, with the slopes there.
    fn arrive(&mut self, tangent: &Tangent<'_, L, N, M>) -> Result<(), Error> {
        let by_parameters = self.parameter_slopes(tangent);
        for (k, block) in self.blocks.iter_mut().enumerate() {
            let names = lane_names::<L, N, M>(&self.arguments, k);
            if const { M > 0 } {
                block.y = block.projected(tangent, &by_parameters, block.y, &names)?;
            }
            block.slope = block.slope_at(tangent, &by_parameters, &block.y, &names)?;
        }
        Ok(())
    }

    /// δ(q, q̇) of a block at a state in between, on the tangent space there.
    pub(super) fn projected(
        &self,
        index: usize,
        tangent: &Tangent<'_, L, N, M>,
        y: Phase<WideOf<L, N, M>, N>,
    ) -> Result<Phase<WideOf<L, N, M>, N>, Error> {
        let names = lane_names::<L, N, M>(&self.arguments, index);
        self.blocks[index].projected(tangent, &self.parameter_slopes(tangent), y, &names)
    }

    /// Where parameters change.
    fn parameter_slopes(&self, tangent: &Tangent<'_, L, N, M>) -> Option<L::ParameterSlopes> {
        self.blocks.iter().any(|block| block.rates.is_some()).then(|| tangent.parameter_slopes())
    }
}

/// What the lanes of a block are called.
fn lane_names<L, const N: usize, const M: usize>(arguments: &[Entry], block: usize) -> impl Fn(usize) -> Entry
where
    L: StateDerivatives<N, M, Scalar: Real>,
{
    let lanes = <WideOf<L, N, M> as Wide<L::Scalar>>::COUNT;
    move |lane| arguments[lanes * block + lane]
}

fn state_at<T: Real, const N: usize>(t: T, [q, v]: &Phase<T, N>) -> State<T, N> {
    State { t, q: vector(*q), v: vector(*v) }
}

/// The equations at a stage, of which the accelerations are known; multipliers are not.
#[inline]
fn tangent_at<'a, L: StateDerivatives<N, M, Scalar: Real>, const N: usize, const M: usize>(
    system: &'a L,
    state: &'a State<L::Scalar, N>,
    accelerations: &[L::Scalar; N],
    active: &[bool; M],
) -> Result<Tangent<'a, L, N, M>, Error> {
    if const { M > 0 } {
        return Ok(Tangent::of(
            system,
            state,
            solve_near(system, state, Some(active), |solution, _| *solution)?,
        ));
    }
    let (zero, one) = (L::Scalar::constant(0.0), L::Scalar::constant(1.0));
    let (accelerations, multipliers) = (vector(*accelerations), vector([zero; M]));
    Ok(Tangent::of(system, state, Solution { accelerations, multipliers, pivot: one, rank: M }))
}

impl<W: Scalar, const N: usize, const P: usize> Block<W, N, P> {
    /// Of no state yet, by these parameters, a lane each.
    fn of<T: Real>(parameters: &[Option<usize>], values: &SVector<T, P>) -> Self
    where
        W: Wide<T>,
    {
        let (zero, one) = (W::constant(0.0), T::constant(1.0));
        let (mut rates, mut unit) = (None, W::constant(1.0));
        for (lane, k) in parameters.iter().enumerate().filter_map(|(lane, k)| Some((lane, (*k)?))) {
            rates.get_or_insert_with(|| SVector::<W, P>::from_element(zero))[k].put(lane, one);
            let size = Scalar::abs(values[k]);
            unit.put(lane, if size > T::constant(0.0) { one / size } else { one });
        }
        let slopes = [[[zero; N]; 2]; SLOPES];
        let y = slopes[0];
        Self { y, start: y, slopes, slope: y, rates, unit, lanes: parameters.len() }
    }

    fn y_mut(&mut self) -> &mut [W] {
        self.y.as_flattened_mut()
    }

    fn slope_mut(&mut self) -> &mut [W] {
        self.slope.as_flattened_mut()
    }

    /// How the residual changes with these variations.
    #[inline]
    fn changes<L, const M: usize>(
        &self,
        tangent: &Tangent<'_, L, N, M>,
        by_parameters: &Option<L::ParameterSlopes>,
        [q, v]: &Phase<W, N>,
    ) -> ResidualChange<W, N, M>
    where
        L: Linearized<N, M, P, Scalar: Real<Wide = W>>,
    {
        let of_state = tangent.changes(&Direction { t: W::constant(0.0), q: vector(*q), v: vector(*v) });
        let Some((slopes, rates)) = by_parameters.as_ref().zip(self.rates.as_ref()) else { return of_state };
        of_state.plus(&tangent.changes_by_parameters(slopes, rates))
    }

    /// δ(q̇, q̈)
    #[inline]
    fn slope_at<L, const M: usize>(
        &self,
        tangent: &Tangent<'_, L, N, M>,
        by_parameters: &Option<L::ParameterSlopes>,
        y: &Phase<W, N>,
        names: &impl Fn(usize) -> Entry,
    ) -> Result<Phase<W, N>, Error>
    where
        L: Linearized<N, M, P, Scalar: Real<Wide = W>>,
    {
        let changes = self.changes(tangent, by_parameters, y);
        Ok([y[1], tangent.responses(self.lanes, &changes, names)?.accelerations.into()])
    }

    /// The nearest variations on the tangent space.
    fn projected<L, const M: usize>(
        &self,
        tangent: &Tangent<'_, L, N, M>,
        by_parameters: &Option<L::ParameterSlopes>,
        mut y: Phase<W, N>,
        names: &impl Fn(usize) -> Entry,
    ) -> Result<Phase<W, N>, Error>
    where
        L: Linearized<N, M, P, Scalar: Real<Wide = W>>,
    {
        for half in 0..2 {
            let changes = self.changes(tangent, by_parameters, &y);
            let left = if half == 0 { changes.position } else { changes.rate };
            let demands = ResidualChange {
                motion: changes.motion.map(|_| W::constant(0.0)),
                acceleration: left,
                ..changes
            };
            let correction = tangent.responses(self.lanes, &demands, names)?.accelerations;
            y[half].iter_mut().zip(&correction).for_each(|(x, correction)| *x = *x + *correction);
        }
        Ok(y)
    }

    /// Adds the coefficients of the step that led here.
    fn push_coefficients<Q: Pair>(&self, h: W, coefficients: &mut Vec<Phase<W, N>>) {
        let zero = [[W::constant(0.0); N]; 2];
        let cubic = coefficients.len();
        coefficients.extend([zero; 4]);
        hermite(h, (&self.start, &self.slopes[0]), (&self.y, &self.slope), &mut coefficients[cubic..]);
        for row in Q::INTERPOLATION {
            let mut coefficient = zero;
            advance(&zero, h, &self.slopes, row, &mut coefficient);
            coefficients.push(coefficient);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::linearized::tangent::Tangent;
    use crate::motion::run::{Run, Watchdog};
    use crate::motion::{Adaptive, Method};
    use crate::{Dop853, Entry, prelude::*};

    use super::{LagrangianFlow, Variations};

    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 - x^2/2)]
    struct Spring;

    /// An error that is no number is not lost among others: it is too large.
    #[test]
    fn an_error_that_is_no_number_refuses_the_step() {
        let (system, method) = (Spring, Dop853::default());
        let start = State::at_rest([1.0]);
        let (mut run, _) = Run::begin::<_, LagrangianFlow, _, 0>(&system, &start, &method).expect("a start");
        let arguments = vec![Entry::Coordinate("x"), Entry::Velocity("x")];
        let unit = |j: usize| [[1.0 - j as f64].into(), [j as f64].into()];
        let tangent = Tangent::at(&system, &start).expect("a start");
        let mut variations = Variations::<_, 1, 0, 0>::begin(&tangent, arguments, unit).expect("a start");
        let limits = Watchdog::new(Method::<Spring, 1, 0>::limits(&method), &run.statistics);
        run.step::<_, LagrangianFlow, _, 0>(&system, &method, 1.0, &limits).expect("a step");
        variations.follow(&system, &method, &mut run).expect("a step");
        let (error, _) = variations.error(&method, &run.memory);
        assert!(method.accepts(error));
        // Of the first of the two.
        let broken = &mut variations.blocks[0].slopes[0][1][0];
        crate::number::Wide::put(broken, 0, f64::NAN);
        assert_eq!(variations.error(&method, &run.memory), (f64::INFINITY, 0));
        assert!(!Adaptive::accepts(&method, f64::INFINITY));
    }
}
