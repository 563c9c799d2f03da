//! Variations along the steps of Radau: the derivative of each step, by the implicit function theorem at its stages.
//!
//! The step length is held fixed, and so is the chart. Another chart changes a step by no more than its error, so that the
//! variations differ by as little from those of the map with the chart of each start.

mod equations;
mod estimate;
mod stage;

use alloc::vec::Vec;

use nalgebra::Const;

use super::Radau;
use super::tableau::{RadauStages, Transformation, basis, inverse};
use crate::derivatives::tangent::WideOf;
use crate::error::{Ending, Error};
use crate::linearized::Linearized;
use crate::linearized::variation::{DifferentiableMethod, Variations, VariedRun};
use crate::number::{Broadcast, Real, Scalar, Wide};
use crate::system::StateOf;
use crate::vector::{Element, PhaseVector, StaticLength};
use equations::StepEquations;

/// Variations at the start and the stages of the last step.
#[derive(Debug)]
pub struct RadauVariations<W: Element, N: StaticLength, const S: usize> {
    /// The method's matrix.
    a: [[f64; S]; S],
    /// For each block, the variations at the start of the step, then their changes up to each stage.
    steps: Vec<Vec<PhaseVector<W, N>>>,
}

impl<L: Linearized<Scalar: Real>, const S: usize> DifferentiableMethod<L> for Radau<S>
where
    Const<S>: RadauStages,
{
    type VariationMemory = RadauVariations<WideOf<L>, L::N, S>;

    fn companion(&self, _: &L, _: &StateOf<L>, _: &Variations<L>) -> Result<Self::VariationMemory, Error> {
        Ok(RadauVariations { a: inverse(&Transformation::<S>::new().slopes), steps: Vec::new() })
    }

    fn follow(&self, at: VariedRun<'_, L, Self>) -> Result<(), Ending> {
        let VariedRun { system, run, variations, memory: companion } = at;
        let time = run.before.t.to_f64();
        let equations = StepEquations::at(system, &run.memory, variations, &companion.a);
        let equations = equations.map_err(|error| Ending::of(error, time))?;
        let stages = equations.and_then(|equations| equations.solve(variations));
        let Some(stages) = stages else {
            return Err(Ending::MethodFailed { time, reason: "a step has no derivatives" });
        };
        let found = self.error_of(system, &run.memory, variations, &stages);
        let (error, worst) = found.map_err(|error| Ending::of(error, time))?;
        if error > 1.0 {
            return Err(Ending::StepTooSmall { time, entry: variations.arguments()[worst] });
        }
        run.memory.shorten(self, error);
        companion.steps.clear();
        for (k, block) in variations.blocks.iter_mut().enumerate() {
            let start = block.y;
            let change = |stage| stages.change(stage, k, &start);
            companion.steps.push([start].into_iter().chain((0..S).map(change)).collect());
            block.y = stages.at(S - 1, k);
        }
        Ok(())
    }

    fn interpolate(
        &self,
        VariedRun { system, run, memory: companion, .. }: VariedRun<'_, L, Self>,
        within: &mut Vec<Self::Interpolant>,
        coefficients: &mut Vec<PhaseVector<WideOf<L>, L::N>>,
    ) -> Result<(), Ending> {
        run.look_within(system, self, within)?;
        companion.steps.iter().for_each(|step| coefficients.extend(step));
        Ok(())
    }

    /// The polynomial through the start and the stages, as for the motion.
    fn between(
        coefficients: &[PhaseVector<WideOf<L>, L::N>],
        part: WideOf<L>,
    ) -> PhaseVector<WideOf<L>, L::N> {
        let theta = part.lane(0).to_f64();
        let mut y = coefficients[0];
        for (j, change) in coefficients[1..].iter().enumerate() {
            let [weight, _] = basis(<Const<S>>::NODES, j, theta);
            let weight = WideOf::<L>::of(L::Scalar::constant(weight));
            y.flat_mut().iter_mut().zip(change.flat()).for_each(|(y, x)| *y = *y + weight * *x);
        }
        y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::derivatives::tangent::Tangent;
    use crate::motion::Method;
    use crate::motion::run::{Run, Watchdog};
    use crate::names::Entry;
    use crate::prelude::*;
    use crate::system::unit;

    /// Two bobs on rods, the upper pivot shaken, and a blade on the lower bob.
    #[derive(Clone, Lagrangian)]
    #[coordinates(r: [2], s: [3])]
    #[lagrangian((dot(r_dot, r_dot) + dot(s_dot, s_dot))/2 - 9.81*(r[1] + s[1]))]
    #[constraint(upper: (r[0] - a*sin(3*t))^2 + r[1]^2 = l^2)]
    #[constraint(lower: (s[0] - r[0])^2 + (s[1] - r[1])^2 = l^2)]
    #[constraint(blade: s_dot[2] = b*s_dot[0]*s[1])]
    struct Shaken {
        a: f64,
        b: f64,
        l: f64,
    }

    /// Variations at the end of each step, before any projection: changes of Φ and of F q̇ + b by all of them are round-off.
    #[test]
    fn variations_end_steps_on_the_constraints() {
        let system = Shaken { a: 0.2, b: 0.7, l: 1.0 };
        let guess = State::new([0.6, -0.8, 1.6, -0.8, 0.0], [0.3, 0.0, 0.1, 0.5, 0.0]);
        let (start, _) = system.make_consistent(&guess).expect("a start");
        let method = Radau::with_tolerance(1e-6);
        let (mut run, _) = Run::<_, _>::begin(&system, &start, &method).expect("a start");
        let arguments = vec![
            Entry::Coordinate("r[0]"),
            Entry::Parameter("a"),
            Entry::Parameter("b"),
            Entry::Parameter("l"),
            Entry::Velocity("s[0]"),
        ];
        let column = |j: usize| [unit(if j == 0 { 0 } else { 9 }), unit(if j == 4 { 2 } else { 9 })];
        let tangent = Tangent::at(&system, &start).expect("a start");
        let mut variations = Variations::<_>::begin(&tangent, arguments, column).expect("a start");
        let limits = Watchdog::new(Method::<Shaken>::limits(&method), &run.statistics);
        let mut companion = method.companion(&system, &start, &variations).expect("a start");
        for _ in 0..20 {
            run.step(&system, &method, 1.0, &limits).expect("a step");
            let at = VariedRun {
                system: &system,
                run: &mut run,
                variations: &mut variations,
                memory: &mut companion,
            };
            method.follow(at).expect("a step");
            let tangent = Tangent::at(&system, &run.state).expect("a state");
            let equations = variations.equations(&tangent);
            for block in &variations.blocks {
                let change = equations.changes(block, &block.y);
                for lane in 0..block.lanes {
                    let change = change.lane::<f64>(lane);
                    let size = block.y.flat().iter().fold(1.0, |most, x| f64::max(most, x.lane(lane).abs()));
                    let off = change.position.amax().max(change.rate.amax());
                    assert!(off < 1e-12 * size, "{off:e} of {size:e} in lane {lane}");
                }
            }
        }
    }
}
