//! Variations along the steps of Runge–Kutta pairs: each stage of the motion is differentiated, with its own
//! factorization.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::ComplexField;

use super::{Block, DifferentiableMethod, Linearized, Variations, VariedRun};
use crate::derivatives::tangent::{Tangent, WideOf};
use crate::error::{Ending, Error};
use crate::linearized::StateDerivatives;
use crate::motion::method::control::VariedEnds;
use crate::motion::method::pair::{Slopes, advance, last};
use crate::motion::method::pair_memory::PairMemory;
use crate::motion::{Adaptive, Pair, TableauRow};
use crate::number::{Broadcast, Real, Scalar, Wide, exceeds};
use crate::room::Room;
use crate::solution::interpolant::hermite;
use crate::solution::solve::solve_near;
use crate::solution::vector_field::LagrangianVectorField;
use crate::system::{Solution, State, StateOf};
use crate::vector::{Array, Element, PhaseVector, StaticLength, vector, zeros};

/// Stage slopes of a block of variations.
#[derive(Clone, Debug)]
pub struct Stages<W: Element, N: StaticLength> {
    /// Variations at the start of the last step.
    start: PhaseVector<W, N>,
    /// Slopes of that step; the first is the slope at its start.
    slopes: Room<Slopes<W, N>>,
    /// Slope at the end of that step.
    slope: PhaseVector<W, N>,
}

impl<Q: Pair, L: Linearized<Scalar: Real>> DifferentiableMethod<L> for Adaptive<Q> {
    type VariationMemory = Vec<Stages<WideOf<L>, L::N>>;

    fn companion(
        &self,
        system: &L,
        start: &StateOf<L>,
        variations: &Variations<L>,
    ) -> Result<Self::VariationMemory, Error> {
        let zero = PhaseVector::filled(WideOf::<L>::constant(0.0));
        let none = Stages { start: zero, slopes: Room::filled(zero), slope: zero };
        let mut all = vec![none; variations.blocks.len()];
        set_out(system, start, variations, &mut all)?;
        Ok(all)
    }

    fn restart(&self, at: VariedRun<'_, L, Self>) -> Result<(), Error> {
        set_out(at.system, &at.run.state, at.variations, at.memory)
    }

    fn linear(companion: &mut Self::VariationMemory) -> Vec<&mut PhaseVector<WideOf<L>, L::N>> {
        companion.iter_mut().map(|stages| &mut stages.slope).collect()
    }

    fn follow(&self, at: VariedRun<'_, L, Self>) -> Result<(), Ending> {
        let VariedRun { system, run, variations, memory: all } = at;
        for (block, stages) in variations.blocks.iter().zip(&mut *all) {
            (stages.start, stages.slopes[0]) = (block.y, stages.slope);
        }
        let time = run.before.t.to_f64();
        let slope = run.memory.ensure_slope::<L, LagrangianVectorField>(system, &mut run.statistics);
        let followed = slope.and_then(|()| go::<Q, L>(system, &run.memory, variations, all));
        let followed = followed.map_err(|error| Ending::of(error, time));
        let (error, worst) = followed
            .inspect_err(|_| step_back(variations, all))
            .map(|()| self.error_of(&run.memory, variations, all))?;
        if self.accepts(error) {
            self.accept_with(&mut run.memory, error);
            return Ok(());
        }
        step_back(variations, all);
        Err(Ending::StepTooSmall { time, entry: variations.arguments()[worst] })
    }

    fn interpolate(
        &self,
        VariedRun { system, run, variations, memory: all }: VariedRun<'_, L, Self>,
        within: &mut Vec<Self::Interpolant>,
        coefficients: &mut Vec<PhaseVector<WideOf<L>, L::N>>,
    ) -> Result<(), Ending> {
        let known = within.len();
        let more = (last::<Q>() + 1, Q::INTERPOLATION_STAGES);
        let found = run.look_within(system, self, within).and_then(|()| {
            let found = stages::<Q, L>(system, &run.memory, variations, all, more);
            found.map_err(|error| Ending::of(error, run.before.t.to_f64()))
        });
        if let Err(ending) = found {
            within.truncate(known);
            step_back(variations, all);
            return Err(ending);
        }
        let memory = &run.memory;
        if let Some((_, h, _)) = memory.last_step() {
            let h = WideOf::<L>::of(h);
            let steps = variations.blocks.iter().zip(all);
            steps.for_each(|(block, stages)| stages.push_coefficients::<Q>(h, &block.y, coefficients));
        }
        Ok(())
    }
}

impl<Q: Pair> Adaptive<Q> {
    /// Largest error of a variation relative to its tolerance, and the index of that variation.
    fn error_of<L: Linearized<Scalar: Real>>(
        &self,
        memory: &PairMemory<L::Scalar, L::N, L::M>,
        variations: &Variations<L>,
        all: &[Stages<WideOf<L>, L::N>],
    ) -> (L::Scalar, usize) {
        let zero = L::Scalar::constant(0.0);
        let Some((from, h, _)) = memory.last_step() else { return (zero, 0) };
        let (lanes, tolerance) = (<WideOf<L> as Wide<L::Scalar>>::COUNT, self.tolerance::<L::Scalar>());
        let places = [&from.y, &memory.y];
        let error = |(block, stages): (&Block<_, L::N, L::P>, &Stages<_, L::N>)| {
            let step = VariedEnds { variations: [&stages.start, &block.y], places, unit: block.unit };
            tolerance.error_of_variations::<Q, _, _, L::N>(&stages.slopes, h, &step)
        };
        let errors: Vec<_> = variations.blocks.iter().zip(all).map(error).collect();
        // NaN counts as infinite.
        let size = |error: L::Scalar| {
            if error.is_finite() { error } else { L::Scalar::constant(f64::INFINITY) }
        };
        let each = (0..variations.count()).map(|j| (size(errors[j / lanes].lane(j % lanes)), j));
        each.fold((zero, 0), |worst, one| if exceeds(one.0, worst.0) { one } else { worst })
    }
}

/// Computes the slopes of the variations at the start of a motion.
fn set_out<L: Linearized<Scalar: Real>>(
    system: &L,
    start: &StateOf<L>,
    variations: &Variations<L>,
    all: &mut [Stages<WideOf<L>, L::N>],
) -> Result<(), Error> {
    let tangent = Tangent::at(system, start)?;
    let equations = variations.equations(&tangent);
    for (block, stages) in variations.blocks.iter().zip(all) {
        stages.slope = equations.slope(block, &block.y)?;
    }
    Ok(())
}

/// Restores the variations to the start of the last step.
fn step_back<L: Linearized<Scalar: Real>>(
    variations: &mut Variations<L>,
    all: &mut [Stages<WideOf<L>, L::N>],
) {
    for (block, stages) in variations.blocks.iter_mut().zip(all) {
        (block.y, stages.slope) = (stages.start, stages.slopes[0]);
    }
}

/// Advances the variations to the end of the step that the motion has taken.
fn go<Q: Pair, L: Linearized<Scalar: Real>>(
    system: &L,
    memory: &PairMemory<L::Scalar, L::N, L::M>,
    variations: &mut Variations<L>,
    all: &mut [Stages<WideOf<L>, L::N>],
) -> Result<(), Error> {
    stages::<Q, L>(system, memory, variations, all, (1, Q::STAGES))?;
    let Some((_, h, _)) = memory.last_step() else { return Ok(()) };
    for (block, stages) in variations.blocks.iter_mut().zip(&*all) {
        advance(&stages.start, WideOf::<L>::of(h), &stages.slopes, Q::WEIGHTS, &mut block.y);
    }
    let state = state_at(memory.clock.now, &memory.y);
    let tangent = tangent_at(system, &state, &memory.slope.half(1), &memory.active)?;
    variations.arrive(&tangent)?;
    let equations = variations.equations(&tangent);
    for (block, stages) in variations.blocks.iter().zip(all) {
        stages.slope = equations.slope(block, &block.y)?;
        stages.slopes[last::<Q>()] = stages.slope;
    }
    Ok(())
}

/// Computes the slopes of these stages of the last step; `first` is the number of the first stage.
fn stages<Q: Pair, L: Linearized<Scalar: Real>>(
    system: &L,
    memory: &PairMemory<L::Scalar, L::N, L::M>,
    variations: &mut Variations<L>,
    all: &mut [Stages<WideOf<L>, L::N>],
    (first, rows): (usize, &[TableauRow]),
) -> Result<(), Error> {
    let Some((from, h, slopes)) = memory.last_step() else { return Ok(()) };
    let (mut place, wide) = (from.y, WideOf::<L>::of(h));
    for (number, row) in (first..).zip(rows) {
        advance(&from.y, h, slopes, row, &mut place);
        let state = state_at(from.t + h * L::Scalar::constant(Q::NODES[number]), &place);
        let tangent = tangent_at(system, &state, &slopes[number].half(1), &memory.active)?;
        for (block, Stages { start, slopes, .. }) in variations.blocks.iter_mut().zip(&*all) {
            advance(start, wide, slopes, row, &mut block.at_stage);
        }
        let equations = variations.equations(&tangent);
        for (block, stages) in variations.blocks.iter().zip(&mut *all) {
            stages.slopes[number] = equations.slope(block, &block.at_stage)?;
        }
    }
    Ok(())
}

fn state_at<T: Real, N: StaticLength>(t: T, y: &PhaseVector<T, N>) -> State<T, N> {
    State { t, q: vector(y.half(0)), v: vector(y.half(1)) }
}

/// Linearized equations at a stage. The accelerations are known from the motion; with constraints the equations are
/// solved again for the multipliers.
#[inline]
fn tangent_at<'a, L: StateDerivatives<Scalar: Real>>(
    system: &'a L,
    state: &'a StateOf<L>,
    accelerations: &Array<L::Scalar, L::N>,
    active: &Array<bool, L::M>,
) -> Result<Tangent<'a, L>, Error> {
    if const { <L::M>::COUNT > 0 } {
        return Ok(Tangent::of(
            system,
            state,
            solve_near(system, state, Some(active), |solution, _| *solution)?,
        ));
    }
    Ok(Tangent::of(system, state, Solution::given(vector(*accelerations), zeros())))
}

impl<W: Scalar, N: StaticLength> Stages<W, N> {
    /// Appends the coefficients of dense output for the step that led to `y`.
    fn push_coefficients<Q: Pair>(
        &self,
        h: W,
        y: &PhaseVector<W, N>,
        coefficients: &mut Vec<PhaseVector<W, N>>,
    ) {
        let zero = PhaseVector::filled(W::constant(0.0));
        let cubic = coefficients.len();
        coefficients.extend([zero; 4]);
        hermite(h, (&self.start, &self.slopes[0]), (y, &self.slope), &mut coefficients[cubic..]);
        for row in Q::INTERPOLATION {
            let mut coefficient = zero;
            advance(&zero, h, &self.slopes, row, &mut coefficient);
            coefficients.push(coefficient);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::derivatives::tangent::Tangent;
    use crate::motion::run::{Run, Watchdog};
    use crate::motion::{Adaptive, Method};
    use crate::{Dop853, error::Entry, prelude::*};

    use super::{DifferentiableMethod, Variations, VariedRun};

    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 - x^2/2)]
    struct Spring;

    /// A NaN error of one variation is not masked by the others: the step is rejected.
    #[test]
    fn an_error_that_is_no_number_refuses_the_step() {
        let (system, method) = (Spring, Dop853::default());
        let start = State::at_rest([1.0]);
        let (mut run, _) = Run::<_, _>::begin(&system, &start, &method).expect("a start");
        let arguments = vec![Entry::Coordinate("x"), Entry::Velocity("x")];
        let unit = |j: usize| [[1.0 - j as f64].into(), [j as f64].into()];
        let tangent = Tangent::at(&system, &start).expect("a start");
        let mut variations = Variations::<_>::begin(&tangent, arguments, unit).expect("a start");
        let limits = Watchdog::new(Method::<Spring>::limits(&method), &run.statistics);
        run.step(&system, &method, 1.0, &limits).expect("a step");
        let mut stages = method.companion(&system, &start, &variations).expect("a start");
        let at =
            VariedRun { system: &system, run: &mut run, variations: &mut variations, memory: &mut stages };
        method.follow(at).expect("a step");
        let (error, _) = method.error_of(&run.memory, &variations, &stages);
        assert!(method.accepts(error));
        // Break the first of the two variations.
        let broken = &mut stages[0].slopes[0][1][0];
        crate::number::Wide::put(broken, 0, f64::NAN);
        assert_eq!(method.error_of(&run.memory, &variations, &stages), (f64::INFINITY, 0));
        assert!(!Adaptive::accepts(&method, f64::INFINITY));
    }
}
