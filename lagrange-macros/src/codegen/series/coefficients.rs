//! Quantities along the motion, by their Taylor coefficients in the schedule of an order that is being built.

use indexmap::{IndexMap, IndexSet};
use rustc_hash::FxHashMap;

use crate::codegen::operation::{Call, Operation, Register};
use crate::codegen::schedule::Schedule;
use crate::symbolic::Function;

/// A quantity along the motion, by its place among all.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(super) struct SeriesQuantity(pub(super) usize);

/// Its coefficients, in the schedule that is being built.
#[derive(Clone, Copy)]
pub(super) struct Coefficients {
    /// That of order 0.
    first: Register,
    /// The newest, in its [parts](Stage); a register that is not there is a zero. `None` for a constant of the motion.
    pub(super) newest: Option<[Option<Register>; 2]>,
}

/// The parts of a newest coefficient: accelerations and multipliers of that order are what it is computed for.
#[derive(Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Stage {
    /// With zeros in their place.
    #[default]
    Known,
    /// What they add.
    Added,
}

pub(super) const STAGES: [Stage; 2] = [Stage::Known, Stage::Added];

/// What a sum is taken of, with j from 1 to k − 1.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Sum {
    /// Σ x_j y_{k−j}
    Product(SeriesQuantity, SeriesQuantity),
    /// Σ j x_j y_{k−j}
    Weighted(SeriesQuantity, SeriesQuantity),
    /// Σ x_j y_{k−j}/((j + 1)(k − j + 1)), of the means that these have had since order 0
    Mean(SeriesQuantity, SeriesQuantity),
    /// No sum, but a place where an argument of a function that the user supplies is kept.
    Argument(SeriesQuantity),
    /// What such a function adds, by the place among the calls and that of the result.
    Value(usize, u32),
}

/// The schedule of an order, with that of order 0 in it.
#[derive(Default)]
pub(super) struct Recurrences {
    pub(super) schedule: Schedule,
    /// Which part of the newest coefficients is being made.
    stage: Stage,
    pub(super) coordinates: usize,
    /// Whether velocities stand for their means since order 0, of which they are k + 1 times the newest coefficients.
    pub(super) of_means: bool,
    pub(super) quantities: Vec<Coefficients>,
    pub(super) sums: IndexSet<Sum>,
    /// Values of roots, each with the place of a sum whose right factor it is.
    pub(super) roots: Vec<(usize, Register)>,
    /// Arguments of steep functions (exp, tanh, sinh, cosh), with the number 0, and bases of high powers, with the exponent: a register
    /// where it is known at run time only, else the number.
    pub(super) steep: IndexMap<(SeriesQuantity, Option<Register>), u32>,
    /// Bases and exponents of whole powers.
    pub(super) powers: FxHashMap<SeriesQuantity, (SeriesQuantity, u32)>,
    /// Calls of functions that the user supplies.
    pub(super) calls: IndexSet<Call<SeriesQuantity>>,
    /// Sine and cosine of an angle.
    pub(super) turns: FxHashMap<(Function, SeriesQuantity), [SeriesQuantity; 2]>,
}

impl Recurrences {
    /// Of a system with so many coordinates.
    pub(super) fn new(coordinates: usize) -> Self {
        Self { coordinates, ..Self::default() }
    }

    /// A part of the newest coefficient; a zero where there is none.
    pub(super) fn newest(&mut self, of: SeriesQuantity, stage: Stage) -> Register {
        self.part(of, stage).unwrap_or_else(|| self.schedule.constant(0.0))
    }

    pub(super) fn part(&self, of: SeriesQuantity, stage: Stage) -> Option<Register> {
        self.quantities[of.0].newest.and_then(|newest| newest[stage as usize])
    }

    pub(super) fn add(&mut self, first: Register, newest: Option<[Option<Register>; 2]>) -> SeriesQuantity {
        self.quantities.push(Coefficients { first, newest });
        SeriesQuantity(self.quantities.len() - 1)
    }

    /// What does not depend on anything that moves.
    pub(super) fn at_rest(&mut self, operation: Operation) -> SeriesQuantity {
        let first = self.schedule.push(operation);
        self.add(first, None)
    }

    pub(super) fn first(&self, of: SeriesQuantity) -> Register {
        self.quantities[of.0].first
    }

    pub(super) fn is_at_rest(&self, of: SeriesQuantity) -> bool {
        self.quantities[of.0].newest.is_none()
    }

    /// An operation by order 0, and by the newest coefficients as `newest` makes it of those of `operands`, part by part.
    pub(super) fn moving<const K: usize>(
        &mut self,
        first: Register,
        operands: [SeriesQuantity; K],
        mut newest: impl FnMut(&mut Self, [Option<Register>; K]) -> Option<Register>,
    ) -> SeriesQuantity {
        let both = STAGES.map(|stage| {
            self.stage = stage;
            let operands = operands.map(|x| self.part(x, stage));
            newest(self, operands)
        });
        self.add(first, Some(both))
    }

    /// What does not depend on the newest coefficients, in the part to which it belongs.
    pub(super) fn known(&self, x: Register) -> Option<Register> {
        (self.stage == Stage::Known).then_some(x)
    }

    /// A quantity by a recurrence that it occurs in itself: known by its place before it is by its coefficients.
    pub(super) fn defined(
        &mut self,
        first: Register,
        recurrence: impl FnOnce(&mut Self, SeriesQuantity) -> SeriesQuantity,
    ) -> SeriesQuantity {
        let quantity = self.add(first, Some([None; 2]));
        let made = recurrence(self, quantity);
        self.quantities[quantity.0] = self.quantities[made.0];
        quantity
    }

    pub(super) fn reciprocal(&mut self, x: Register) -> Register {
        let one = self.schedule.constant(1.0);
        self.schedule.push(Operation::Divide(one, x))
    }

    pub(super) fn sum(&mut self, x: Option<Register>, y: Option<Register>) -> Option<Register> {
        match (x, y) {
            (Some(x), Some(y)) => Some(self.schedule.push(Operation::Add(x, y))),
            _ => x.or(y),
        }
    }

    pub(super) fn difference(&mut self, x: Option<Register>, y: Option<Register>) -> Option<Register> {
        match (x, y) {
            (Some(x), Some(y)) => Some(self.schedule.push(Operation::Subtract(x, y))),
            (None, y) => self.negative(y),
            (x, None) => x,
        }
    }

    pub(super) fn negative(&mut self, x: Option<Register>) -> Option<Register> {
        x.map(|x| self.schedule.push(Operation::Negate(x)))
    }

    pub(super) fn times(&mut self, number: Register, x: Option<Register>) -> Option<Register> {
        x.map(|x| self.schedule.push(Operation::Multiply(number, x)))
    }
}
