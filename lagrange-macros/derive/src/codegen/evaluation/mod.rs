//! Functions of a system as [`Tape`]s, for use without a compiler.

mod tape;
mod unsupported;
mod value;

use super::passes::Program;
use super::solving::Solving;
use crate::mechanics::{ConservedKind, Derived, Equations, Facts};
use crate::resolve::{Entry, Parameters, Problem};
use crate::symbolic::{Graph, Id};
pub use tape::{Arguments, Tape};
pub use unsupported::Unsupported;

/// The functions that a motion evaluates, each with its results in the order that is stated.
///
/// The elimination, the order of its operations and the energy are those of the code that `#[derive(Lagrangian)]` emits. Set the
/// parameters by [`bind`](Self::bind) first.
///
/// ```
/// use lagrange_derive::{Arguments, System};
///
/// let rail = System::parse(
///     "#[coordinates(x, y)]
///      #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
///      #[constraint(rail: y = x)]
///      struct Bead { m: f64, g: f64 }",
/// )?;
/// let mut tapes = rail.tapes()?;
/// tapes.bind(&[2.0, 10.0]);
/// let at = Arguments { q: &[1.0, 1.0], v: &[0.0, 0.0], ..Arguments::default() };
/// let mut registers = Vec::new();
///
/// let elimination = tapes.elimination.as_ref().expect("a short elimination");
/// assert_eq!(elimination.accelerations.evaluate(&at, &mut registers)[..3], [-5.0, -5.0, 10.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Tapes {
    /// Fields with the parameters.
    pub parameters: Vec<ParameterField>,
    /// For each parameter of the program its place in the order of the fields.
    ranks: Vec<usize>,
    /// Solution of the equations of motion; `None` if it would be so long that loops over [`equations`](Self::equations) are faster.
    pub elimination: Option<Elimination>,
    /// M by rows, h, F by rows and γ, of M q̈ = h + Fᵀλ and F q̈ + γ = 0: reads t, q and v.
    pub equations: Tape,
    /// Φ of each constraint, zero for velocity constraints; F q̇ + b of each; F by rows; γ. Reads t, q and v.
    pub constraints: Tape,
    /// Energy E = p·q̇ − L, Lagrangian L, and the momenta p: reads t, q and v.
    pub energies: Tape,
    /// Observables, in the order of [`System::observables`](crate::System::observables): reads t, q, v, accelerations and multipliers.
    pub observables: Tape,
    /// Conserved quantities, in the order of [`Facts::conserved`](crate::facts::Facts::conserved): reads t, q and v.
    pub conserved: Tape,
}

/// Sparse elimination of the equations of motion, in the order with little fill-in that the emitted code has.
#[derive(Clone, Debug)]
pub struct Elimination {
    /// Accelerations, multipliers and the smallest ratio of a pivot to its diagonal entry: reads t, q and v. A solution is to be trusted if
    /// this ratio is more than ε^(1/3), and all results are finite.
    pub accelerations: Tape,
    /// Numbers of the factorization: reads t, q and v.
    pub factor: Tape,
    /// Solves M x = h + Fᵀλ and F x + γ = 0 for x, λ and the pivot: reads factor, forcing h and bias γ.
    pub solve: Tape,
}

/// A field of the struct whose numbers the equations contain.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParameterField {
    /// Name of the field; `body.m` for a number in a struct.
    pub name: String,
    /// Lengths of its arrays, outermost first; empty for a number.
    pub lengths: Vec<usize>,
    /// For each number, in row-major order, its index among [`System::parameters`](crate::System::parameters); `None` if the equations do
    /// not contain it. The two entries of a symmetric matrix are one parameter.
    pub entries: Vec<Option<usize>>,
}

impl Tapes {
    pub(crate) fn of(graph: &Graph, problem: &Problem, derived: &Derived) -> Self {
        let Equations { linear, residual, rate, mass, forcing, energy, momentum, .. } = &derived.equations;
        let tape = |roots: &[Id]| {
            let program = Program::of(graph, roots);
            Tape::of(&program.schedule, &program.results)
        };
        let (jacobian, bias) = (linear.jacobian.concat(), &linear.bias);
        let observables: Vec<Id> =
            problem.observables.iter().flat_map(|observed| &observed.values).copied().collect();
        Self {
            parameters: fields(&problem.parameters),
            ranks: ranks(&problem.parameters),
            elimination: Elimination::of(graph, &derived.equations),
            equations: tape(&[&mass.concat(), &**forcing, &jacobian, bias].concat()),
            constraints: tape(&[&**residual, rate, &jacobian, bias].concat()),
            energies: tape(&[&[*energy, problem.lagrangian], &**momentum].concat()),
            observables: tape(&observables),
            conserved: tape(&conserved(problem, &derived.equations, &derived.facts)),
        }
    }

    /// Sets the parameters, in the order of [`System::parameters`](crate::System::parameters). A parameter that is missing is NaN.
    pub fn bind(&mut self, parameters: &[f64]) {
        let values: Vec<f64> =
            self.ranks.iter().map(|&rank| parameters.get(rank).copied().unwrap_or(f64::NAN)).collect();
        let of_elimination = self
            .elimination
            .iter_mut()
            .flat_map(|found| [&mut found.accelerations, &mut found.factor, &mut found.solve]);
        let others = [
            &mut self.equations,
            &mut self.constraints,
            &mut self.energies,
            &mut self.observables,
            &mut self.conserved,
        ];
        of_elimination.chain(others).for_each(|tape| tape.bind_to(&values));
    }
}

impl Elimination {
    fn of(graph: &Graph, equations: &Equations) -> Option<Self> {
        let Solving { accelerations, factoring } = Solving::of(graph, equations);
        let tape = |program: &Program| Tape::of(&program.schedule, &program.results);
        let [factor, solve] = factoring?;
        Some(Self { accelerations: tape(&accelerations?), factor: tape(&factor), solve: tape(&solve) })
    }
}

fn conserved(problem: &Problem, equations: &Equations, facts: &Facts) -> Vec<Id> {
    let value = |kind: &ConservedKind| match *kind {
        ConservedKind::Energy => equations.energy,
        ConservedKind::Momentum(coordinate) => equations.momentum[coordinate],
        ConservedKind::Total(.., [value, _]) => value,
        ConservedKind::Observable(observable, entry) => problem.observables[observable].values[entry],
    };
    facts.conserved.iter().map(|conserved| value(&conserved.quantity)).collect()
}

/// Place of each parameter in the order of the fields.
fn ranks(parameters: &Parameters) -> Vec<usize> {
    let order = parameters.by_field();
    let mut ranks = vec![0; order.len()];
    order.into_iter().enumerate().for_each(|(rank, k)| ranks[k] = rank);
    ranks
}

/// Fields in use, in their order.
fn fields(parameters: &Parameters) -> Vec<ParameterField> {
    let ranks = ranks(parameters);
    let rank =
        |entry: Entry| Some(ranks[parameters.entries.get_index_of(&parameters.representative(entry))?]);
    let fields = parameters.fields.iter().enumerate().filter_map(|(index, field)| {
        let layout = &field.shape.as_ref().ok()?.layout;
        let entries: Vec<_> =
            (0..layout.numbers()).map(|number| rank(Entry { field: index, number })).collect();
        let name = field.text();
        entries.iter().any(Option::is_some).then(|| ParameterField {
            name,
            lengths: layout.lengths.clone(),
            entries,
        })
    });
    fields.collect()
}
