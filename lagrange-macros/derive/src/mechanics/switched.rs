//! The equations of motion of a system with constraints that can be switched off: the runtime puts together those that hold.

use rustc_hash::FxHashMap;

use super::constraints::Constraints;
use super::equations::LinearEquations;
use super::form::Form;
use crate::resolve::{Entry, FrictionRows, Problem, Switch, SwitchReading};
use crate::symbolic::{Graph, Id};
use crate::variables::Variable;

/// Largest number of coordinates for which a row of F stores its zeros, too. Loops over such rows have a constant length and no
/// indices: the accelerations of a block on a floor take 70 ns, and 160 ns by rows with indices.
const DENSE: usize = 12;

/// Equations of motion in parts.
#[derive(Debug)]
pub(crate) struct SwitchedEquations {
    /// The equations where only those constraints hold that always do.
    pub(crate) free: LinearEquations,
    /// M q̈ = h without constraints, with M completed where it is singular.
    pub(crate) inertia: LinearEquations,
    pub(crate) groups: Vec<RowGroup>,
}

/// Constraints whose rows are computed together.
#[derive(Debug)]
pub(crate) struct RowGroup {
    /// Entry of the field that switches them off; `None` if they are always computed.
    pub(crate) entry: Option<Entry>,
    /// Node that is 1 while that entry lets them hold, else 0.
    pub(crate) is_on: Option<Id>,
    pub(crate) rows: Vec<Row>,
}

/// The row of a constraint, computed while its group is on.
#[derive(Debug)]
pub(crate) struct Row {
    /// Index of the constraint.
    pub(crate) constraint: usize,
    /// Coordinates with entries in F or B.
    pub(crate) columns: Vec<usize>,
    /// Entries of F in these columns.
    pub(crate) jacobian: Vec<Id>,
    /// Entries of B, which has forces of friction that slides beside those of F; `None` if it is F.
    pub(crate) push: Option<Vec<Id>>,
    /// Four numbers of the row F q̈ + γ + c λ = 0: the diagonal entry of c, which is 0 where the constraint holds and else 1; the entry of c in
    /// the column of the first row of the group; the weight σ with which the constraint completes M; and γ.
    pub(crate) numbers: [Id; 4],
}

impl SwitchedEquations {
    /// Splits the equations of motion. `multiples` has, for each entry of h, the constraints whose multipliers occur in it, with their
    /// coefficients. `None` if all constraints always hold.
    pub(super) fn of(
        graph: &mut Graph,
        problem: &Problem,
        (linear, constraints): (&LinearEquations, &Constraints),
        multiples: &[Vec<(usize, Id)>],
    ) -> Option<Self> {
        let held: Vec<usize> =
            (0..constraints.kinds.len()).filter(|&a| constraints.always_holds(a)).collect();
        if held.len() == constraints.kinds.len() {
            return None;
        }
        let mut free = linear.holding(&held);
        free.given = (0..constraints.kinds.len())
            .map(|a| (!constraints.always_holds(a)).then(|| graph.neg(constraints.bias[a])))
            .collect();
        let off = readings(graph, problem, off);
        let new = graph.all_replaced(&free.nodes(), &off);
        let free = free.map(|id| new[&id]);
        let rows = Rows { problem, constraints, multiples, weights: &linear.forms[0].completing };
        let inertia = free.without_constraints();
        Some(Self { inertia, groups: rows.groups(graph, held), free })
    }
}

/// Nodes that read switches, each with its value, for the switches that have one.
fn readings(
    graph: &mut Graph,
    problem: &Problem,
    value: impl Fn(&Problem, &Switch) -> Option<Id>,
) -> FxHashMap<Id, Id> {
    let switches = problem.parameters.switches.iter().enumerate();
    let known =
        switches.filter_map(|(k, switch)| Some((Variable::Switch(k).symbol(), value(problem, switch)?)));
    known.map(|(symbol, value)| (graph.symbol(symbol), value)).collect()
}

impl LinearEquations {
    /// The equations with these constraints only.
    fn holding(&self, held: &[usize]) -> Self {
        let of = |rows: &[Vec<Id>]| held.iter().map(|&a| rows[a].clone()).collect::<Vec<_>>();
        let place = |&(a, weight): &(usize, Id)| Some((held.iter().position(|&b| b == a)?, weight));
        let form = |form: &Form| Form {
            rows: form.rows.as_deref().map(of),
            completing: form.completing.iter().filter_map(place).collect(),
            ..form.clone()
        };
        Self {
            coordinates: self.coordinates,
            forms: self.forms.iter().map(form).collect(),
            jacobian: of(&self.jacobian),
            bias: held.iter().map(|&a| self.bias[a]).collect(),
            given: Vec::new(),
        }
    }

    fn nodes(&self) -> Vec<Id> {
        let mut nodes = Vec::new();
        self.map(|id| {
            nodes.push(id);
            id
        });
        nodes
    }

    /// The equations without constraints; M stays completed where it is singular.
    fn without_constraints(&self) -> Self {
        let form = |form: &Form| Form { rows: None, completing: Vec::new(), ..form.clone() };
        Self {
            coordinates: self.coordinates,
            forms: self.forms.iter().map(form).collect(),
            jacobian: Vec::new(),
            bias: Vec::new(),
            given: Vec::new(),
        }
    }
}

/// Value of a switch while no constraint holds that can be switched off; `None` if it has several.
fn off(problem: &Problem, switch: &Switch) -> Option<Id> {
    let is_of_contact = problem.contacts.iter().any(|contact| contact.entry == switch.entry);
    let keeps = matches!(switch.reading, SwitchReading::Holds | SwitchReading::Sticks(_));
    (is_of_contact || keeps).then_some(Id::ZERO)
}

struct Rows<'a> {
    problem: &'a Problem,
    constraints: &'a Constraints,
    multiples: &'a [Vec<(usize, Id)>],
    weights: &'a [(usize, Id)],
}

impl Rows<'_> {
    /// Groups of constraints: one of all that always hold, and one for each entry of a field that switches some.
    fn groups(&self, graph: &mut Graph, held: Vec<usize>) -> Vec<RowGroup> {
        let mut groups: Vec<(Option<Entry>, Vec<usize>)> = vec![(None, held)];
        for a in (0..self.constraints.kinds.len()).filter(|&a| !self.constraints.always_holds(a)) {
            let entry = self.entry(graph, a);
            match groups.iter_mut().find(|(of, _)| *of == entry && entry.is_some()) {
                Some((_, rows)) => rows.push(a),
                None => groups.push((entry, vec![a])),
            }
        }
        groups.retain(|(_, rows)| !rows.is_empty());
        let group = |(entry, constraints): (Option<Entry>, Vec<usize>)| {
            let rows = constraints.into_iter().map(|a| self.row(graph, a, entry)).collect();
            // Friction that slides has a force, too.
            let is_friction =
                |friction: &FrictionRows| friction.contact.is_none() && Some(friction.entry) == entry;
            let entry = entry.filter(|_| !self.problem.frictions.iter().any(is_friction));
            let is_on = entry.and_then(|entry| self.reading(graph, entry));
            RowGroup { entry, is_on, rows }
        };
        groups.into_iter().map(group).collect()
    }

    /// Node of the reading whether a constraint holds.
    fn reading(&self, graph: &mut Graph, entry: Entry) -> Option<Id> {
        let holds = Switch { entry, reading: SwitchReading::Holds };
        let index = self.problem.parameters.switches.get_index_of(&holds)?;
        Some(graph.symbol(Variable::Switch(index).symbol()))
    }

    /// Entry of the field that switches a constraint.
    fn entry(&self, graph: &Graph, a: usize) -> Option<Entry> {
        let symbol = graph.symbols(&[self.problem.switches.get(a).copied()??]).next()?;
        match Variable::of(symbol) {
            Variable::Switch(k) => Some(self.problem.parameters.switches[k].entry),
            _ => None,
        }
    }

    /// The row of a constraint while the field of this entry does not switch it off.
    fn row(&self, graph: &mut Graph, a: usize, entry: Option<Entry>) -> Row {
        let Constraints { jacobian, bias, compliance, coupling, .. } = self.constraints;
        let holds =
            |switch: &Switch| Some(switch.entry) == entry && matches!(switch.reading, SwitchReading::Holds);
        let on = readings(graph, self.problem, |_, switch| holds(switch).then_some(Id::ONE));
        let mut on = |id| graph.replaced(id, &on);
        let f: Vec<Id> = jacobian[a].iter().map(|&entry| on(entry)).collect();
        let of =
            |i: usize| self.multiples.get(i)?.iter().find(|(b, _)| *b == a).map(|&(_, multiple)| multiple);
        let more: Vec<Id> = (0..f.len()).map(|i| of(i).map_or(Id::ZERO, &mut on)).collect();
        let columns: Vec<usize> =
            (0..f.len()).filter(|&i| f.len() <= DENSE || [f[i], more[i]] != [Id::ZERO; 2]).collect();
        let coupling = coupling.iter().find(|(row, ..)| *row == a).map_or(Id::ZERO, |&(.., entry)| entry);
        let weight = self.weights.iter().find(|(b, _)| *b == a).map_or(Id::ZERO, |&(_, weight)| weight);
        let numbers = [compliance[a], coupling, weight, bias[a]].map(&mut on);
        let pushes = more.iter().any(|&entry| entry != Id::ZERO);
        let push = pushes.then(|| columns.iter().map(|&i| graph.add(f[i], more[i])).collect());
        Row { constraint: a, jacobian: columns.iter().map(|&i| f[i]).collect(), columns, push, numbers }
    }
}
