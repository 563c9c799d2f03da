//! Straight-line programs that are evaluated without a compiler.

use std::fmt::{self, Debug, Formatter};

use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;
use crate::symbolic::Symbol;
use crate::variables::Variable;

/// Straight-line program of a function of the state: a list of operations on `f64` registers, the same that the emitted code has.
///
/// The registers hold constants, parameters and what depends on these alone, which [`Tapes::bind`](super::Tapes::bind) computes once; then the
/// arguments; then one result after another.
///
/// ```
/// use lagrange_derive::{Arguments, System};
///
/// let pendulum = System::parse(
///     "#[coordinates(theta)]
///      #[lagrangian(m/2 * l^2 * theta_dot^2 + m*g*l*cos(theta))]
///      struct Pendulum { m: f64, l: f64, g: f64 }",
/// )?;
/// let mut tapes = pendulum.tapes()?;
/// assert_eq!(pendulum.parameters(), ["m", "l", "g"]);
/// tapes.bind(&[2.0, 0.5, 9.81]);
/// let at = Arguments { q: &[0.0], v: &[1.0], ..Arguments::default() };
/// assert_eq!(tapes.energies.evaluate(&at, &mut Vec::new()), [0.25 - 9.81, 0.25 + 9.81, 0.5]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Tape {
    /// Registers that are the same at all states.
    bound: Vec<f64>,
    constants: usize,
    parameters: Vec<Symbol>,
    of_parameters: Vec<Operation>,
    inputs: Vec<Symbol>,
    operations: Vec<Operation>,
    results: Vec<Register>,
}

/// Arguments of the functions of a system. A function reads those that it depends on; the others may be left empty. An argument that is
/// too short reads as NaN.
#[derive(Clone, Copy, Debug, Default)]
pub struct Arguments<'a> {
    /// Time t.
    pub t: f64,
    /// Generalized coordinates q.
    pub q: &'a [f64],
    /// Generalized velocities q̇.
    pub v: &'a [f64],
    /// Generalized accelerations q̈.
    pub accelerations: &'a [f64],
    /// Multipliers λ, one for each constraint.
    pub multipliers: &'a [f64],
    /// Factorization of the mass matrix and of the constraints, as [`Elimination::factor`](super::Elimination::factor) returns it.
    pub factor: &'a [f64],
    /// Right-hand side h of the equations of motion, one entry for each coordinate.
    pub forcing: &'a [f64],
    /// Right-hand side γ of the constraints, one entry for each.
    pub bias: &'a [f64],
}

/// Parts of the registers, in the order in which they are stored.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Group {
    Constants,
    Parameters,
    OfParameters,
    Inputs,
    Results,
}

impl Tape {
    /// Lists the operations that the results depend on.
    pub(in crate::codegen) fn of(schedule: &Schedule, results: &[Register]) -> Self {
        let groups = groups(schedule);
        let uses = schedule.uses(results);
        let mut order: Vec<usize> = (0..groups.len()).filter(|&index| uses[index] > 0).collect();
        order.sort_by_key(|&index| groups[index]);
        let mut places = vec![Register::at(0); groups.len()];
        order.iter().enumerate().for_each(|(place, &index)| places[index] = Register::at(place));
        let place = |register: Register| places[register.index()];
        let operations = |group: Group| {
            let of_group = order.iter().filter(|&&index| groups[index] == group);
            of_group.map(|&index| schedule.operations[index].with_operands(place)).collect::<Vec<_>>()
        };
        let symbols = |group| {
            let symbol = |operation| match operation {
                Operation::Input(symbol) => Some(symbol),
                _ => None,
            };
            operations(group).into_iter().filter_map(symbol).collect()
        };
        let constants = operations(Group::Constants).into_iter();
        let constants: Vec<f64> =
            constants.map(|operation| operation.value(|_| f64::NAN, |_| f64::NAN)).collect();
        Self {
            constants: constants.len(),
            bound: constants,
            parameters: symbols(Group::Parameters),
            of_parameters: operations(Group::OfParameters),
            inputs: symbols(Group::Inputs),
            operations: operations(Group::Results),
            results: results.iter().map(|&result| place(result)).collect(),
        }
    }

    /// Sets the parameters, in the order of the program.
    pub(super) fn bind_to(&mut self, parameters: &[f64]) {
        self.bind(|symbol| match Variable::of(symbol) {
            Variable::Parameter(k) => parameters[k],
            _ => f64::NAN,
        });
    }

    /// Sets the parameters, and computes what depends on them alone.
    fn bind(&mut self, parameter: impl Fn(Symbol) -> f64) {
        self.bound.truncate(self.constants);
        self.bound.extend(self.parameters.iter().map(|&symbol| parameter(symbol)));
        run(&self.of_parameters, &mut self.bound);
    }

    /// Evaluates the function, and returns its results in the order in which they are documented. `registers` may hold anything; a buffer
    /// that is used again spares the allocation.
    pub fn evaluate<'a>(&self, at: &Arguments<'_>, registers: &'a mut Vec<f64>) -> &'a [f64] {
        self.run(|symbol| at.value(symbol), registers)
    }

    /// Fills the registers, and appends the results.
    fn run<'a>(&self, input: impl Fn(Symbol) -> f64, registers: &'a mut Vec<f64>) -> &'a [f64] {
        let count = self.bound.len() + self.inputs.len() + self.operations.len();
        registers.clear();
        registers.reserve(count + self.results.len());
        registers.extend_from_slice(&self.bound);
        registers.extend(self.inputs.iter().map(|&symbol| input(symbol)));
        run(&self.operations, registers);
        self.results.iter().for_each(|result| registers.push(registers[result.index()]));
        &registers[count..]
    }

    /// Results for parameters and arguments by their symbols.
    #[cfg(test)]
    pub(in crate::codegen) fn results_by(mut self, input: impl Fn(Symbol) -> f64) -> Vec<f64> {
        self.bind(&input);
        self.run(input, &mut Vec::new()).to_vec()
    }

    /// Number of results.
    pub fn results(&self) -> usize {
        self.results.len()
    }

    /// Number of operations at each state.
    pub fn operations(&self) -> usize {
        self.operations.len()
    }
}

/// Computes operations one after the other, and appends the value of each to the registers.
fn run(operations: &[Operation], registers: &mut Vec<f64>) {
    for operation in operations {
        let value = operation.value(|_| f64::NAN, |register| registers[register.index()]);
        registers.push(value);
    }
}

/// For each operation of a schedule, the part of the registers that its value belongs to.
fn groups(schedule: &Schedule) -> Vec<Group> {
    let mut groups = Vec::with_capacity(schedule.operations.len());
    for operation in &schedule.operations {
        groups.push(match operation {
            Operation::Constant(_) => Group::Constants,
            Operation::Input(symbol) => match Variable::of(*symbol) {
                Variable::Parameter(_) => Group::Parameters,
                _ => Group::Inputs,
            },
            _ => match schedule.operands(*operation).map(|operand| groups[operand.index()]).max() {
                Some(Group::Inputs | Group::Results) | None => Group::Results,
                Some(_) => Group::OfParameters,
            },
        });
    }
    groups
}

impl Arguments<'_> {
    fn value(&self, symbol: Symbol) -> f64 {
        let (list, index) = match Variable::of(symbol) {
            Variable::Time => return self.t,
            Variable::Coordinate(i) => (self.q, i),
            Variable::Velocity(i) => (self.v, i),
            Variable::Acceleration(i) => (self.accelerations, i),
            Variable::Multiplier(a) => (self.multipliers, a),
            Variable::Factor(k) => (self.factor, k),
            Variable::Forcing(i) => (self.forcing, i),
            Variable::Bias(a) => (self.bias, a),
            _ => (&[][..], 0),
        };
        list.get(index).copied().unwrap_or(f64::NAN)
    }
}

impl Debug for Tape {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let (operations, results) = (self.operations(), self.results());
        f.debug_struct("Tape")
            .field("operations", &operations)
            .field("results", &results)
            .finish_non_exhaustive()
    }
}
