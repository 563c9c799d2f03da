//! Quantities along the motion, represented by their Taylor coefficients in the schedule under construction.

use indexmap::{IndexMap, IndexSet};
use rustc_hash::FxHashMap;

use crate::codegen::operation::{Call, Operation, Register};
use crate::codegen::schedule::Schedule;
use crate::symbolic::Function;

/// Index of a quantity in [`Recurrences::quantities`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(super) struct SeriesQuantity(pub(super) usize);

/// Taylor coefficients of a quantity: registers of the schedule under construction.
#[derive(Clone, Copy)]
pub(super) struct Coefficients {
    /// Coefficient of order 0.
    first: Register,
    /// Coefficient of the current order k, in its two [parts](Stage); `None` for a part that is zero. `None`
    /// as a whole for a constant of the motion.
    pub(super) newest: Option<[Option<Register>; 2]>,
}

/// Parts of the coefficient of order k of a quantity. The coefficient is linear in the unknown accelerations
/// and multipliers of order k.
#[derive(Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Stage {
    /// Value with zero in place of the accelerations and multipliers of order k.
    #[default]
    Known,
    /// Contribution of the accelerations and multipliers of order k.
    Added,
}

pub(super) const STAGES: [Stage; 2] = [Stage::Known, Stage::Added];

/// Convolution sum for order k, over j from 1 to k − 1.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Sum {
    /// Σ x_j y_{k−j}
    Product(SeriesQuantity, SeriesQuantity),
    /// Σ j x_j y_{k−j}
    Weighted(SeriesQuantity, SeriesQuantity),
    /// Σ x_j y_{k−j}/((j + 1)(k − j + 1)): convolution of the mean values of x and y since t₀
    Mean(SeriesQuantity, SeriesQuantity),
    /// Storage for the series of an argument of a user-supplied function; not a sum.
    Argument(SeriesQuantity),
    /// Contribution of lower orders to a result of a user-supplied function: index of the call, and index of the
    /// result.
    Value(usize, u32),
}

/// Recurrences for the Taylor coefficients of order k from those of lower orders. Their schedule also
/// computes the values of order 0.
#[derive(Default)]
pub(super) struct Recurrences {
    pub(super) schedule: Schedule,
    /// Part of the coefficients of order k that is under construction.
    stage: Stage,
    pub(super) coordinates: usize,
    /// If set, velocities stand for their mean values since t₀. The coefficient v_k of a velocity is (k + 1)
    /// times that of its mean.
    pub(super) of_means: bool,
    pub(super) quantities: Vec<Coefficients>,
    pub(super) sums: IndexSet<Sum>,
    /// Roots: index of a sum whose right factor is the root, and value of order 0.
    pub(super) roots: Vec<(usize, Register)>,
    /// Arguments of steep functions (exp, tanh, sinh, cosh), with the number 0, and bases of high powers, with the
    /// exponent. The exponent of an integer power is the number; any other exponent is the register, with the number
    /// 1.
    pub(super) steep: IndexMap<(SeriesQuantity, Option<Register>), u32>,
    /// Base and exponent of each quantity that is an integer power.
    pub(super) powers: FxHashMap<SeriesQuantity, (SeriesQuantity, u32)>,
    /// Calls of functions that the user supplies.
    pub(super) calls: IndexSet<Call<SeriesQuantity>>,
    /// Sine and cosine of an angle, or hyperbolic sine and cosine.
    pub(super) turns: FxHashMap<(Function, SeriesQuantity), [SeriesQuantity; 2]>,
}

impl Recurrences {
    /// Starts the recurrences of a system with `coordinates` coordinates.
    pub(super) fn new(coordinates: usize) -> Self {
        Self { coordinates, ..Self::default() }
    }

    /// Returns the register of a part of the coefficient of order k. If the part vanishes, the register holds 0.
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

    /// Adds a quantity that is constant along the motion.
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

    /// Adds a quantity with value `first` at order 0. `newest` computes each part of its coefficient of order
    /// k from the same part of `operands`.
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

    /// Returns a term of lower orders while the known part is under construction, else `None`: such a term
    /// belongs to the known part alone.
    pub(super) fn known(&self, x: Register) -> Option<Register> {
        (self.stage == Stage::Known).then_some(x)
    }

    /// Adds a quantity whose recurrence refers to the quantity itself. `recurrence` gets its index before its
    /// coefficients are set.
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
