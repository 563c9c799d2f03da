//! Gauss's principle of least constraint: the accelerations make ½ aᵀMa − hᵀa least, subject to F a + γ = 0.
//!
//! Where velocities are named by definitions, `vx[i] = vx[i-1] + …`, the same form over the rates of those
//! velocities as well is sparse: M of a chain is dense, but its kinetic energy is a sum of squares of link
//! velocities. Eliminating an acceleration as soon as it occurs in no definition that is left is then the
//! articulated-body algorithm (Featherstone, *Rigid Body Dynamics Algorithms*, chapter 7), found from the definitions.

use super::completion;
use super::constraints::Constraints;
use super::euler_lagrange::{Motion, generalized_forces};
use super::twists::Twists;
use crate::resolve::Problem;
use crate::symbolic::{Forward, Graph, Id, Node, Rational};
use crate::variables::{Variable, drift, symbols};

/// The most variables that a form has: each is differentiated by each.
const LIMIT: usize = 500;

/// ½ xᵀHx − bᵀx, where x is the accelerations and then, in the order of their definitions, the rates of the named
/// velocities that they cause.
#[derive(Debug)]
pub(crate) struct Form {
    /// H, by rows.
    pub(crate) matrix: Vec<Vec<Id>>,
    /// b
    pub(crate) linear: Vec<Id>,
    /// For each named velocity its rate as a sum over the x before it: which, and its coefficient.
    pub(crate) definitions: Vec<Vec<(usize, Id)>>,
    /// F over x, if it is not that over the accelerations alone.
    pub(crate) rows: Option<Vec<Vec<Id>>>,
    /// b_i/H_ii of an acceleration that is tied to nothing else.
    pub(crate) alone: Vec<Option<Id>>,
    /// The constraints a with σ_a F_aᵀF_a in H and −σ_a γ_a F_a in b, each with its σ: a solve for other h and γ takes
    /// the same from its h.
    pub(crate) completing: Vec<(usize, Id)>,
}

impl Form {
    /// Over the accelerations alone, and over the velocities that definitions name as well where there are any and
    /// exact arithmetic can write it.
    pub(super) fn all(
        graph: &mut Graph,
        problem: &Problem,
        motion: &Motion,
        twists: Option<&Twists>,
        constraints: &Constraints,
    ) -> Vec<Self> {
        let plain = Self::new(motion.mass.clone(), motion.forcing.clone(), Vec::new());
        let others = match twists {
            Some(twists) => twists.forms(graph),
            None => {
                let velocities = Velocities::named(graph, problem);
                Vec::from_iter((!velocities.rows.is_empty()).then(|| velocities.form(graph, problem)))
            }
        };
        let others = others.into_iter().filter(|form| form.matrix.len() <= LIMIT);
        let others: Vec<Self> = others.filter(|_| graph.take_fault().is_none()).collect();
        let mut forms: Vec<Self> = [plain].into_iter().chain(others).collect();
        let completing = completion::completing(graph, problem, &motion.mass, constraints);
        for form in &mut forms {
            form.complete(graph, constraints, &completing);
            form.divide_what_is_alone(graph);
        }
        forms
    }

    /// With each variable after the accelerations as a sum over those before it.
    pub(super) fn over(matrix: Vec<Vec<Id>>, linear: Vec<Id>, rows: &[Vec<Id>]) -> Self {
        let entries =
            |row: &Vec<Id>| row.iter().copied().enumerate().filter(|&(_, entry)| entry != Id::ZERO).collect();
        Self::new(matrix, linear, rows.iter().map(entries).collect())
    }

    fn new(matrix: Vec<Vec<Id>>, linear: Vec<Id>, definitions: Vec<Vec<(usize, Id)>>) -> Self {
        let alone = vec![None; matrix.len()];
        Self { matrix, linear, definitions, rows: None, alone, completing: Vec::new() }
    }

    /// The same with constraints on all its variables.
    pub(super) fn with(self, rows: Vec<Vec<Id>>) -> Self {
        Self { rows: Some(rows), ..self }
    }

    /// H + FᵀσF and b − Fᵀσγ, of the constraints given with their σ; as it is where exact arithmetic cannot write that.
    fn complete(&mut self, graph: &mut Graph, constraints: &Constraints, completing: &[(usize, Id)]) {
        let (mut matrix, mut linear) = (self.matrix.clone(), self.linear.clone());
        for &(a, weight) in completing {
            let row = constraints.jacobian[a].iter().enumerate().filter(|&(_, &entry)| entry != Id::ZERO);
            let row: Vec<(usize, Id)> = row.map(|(i, &entry)| (i, entry)).collect();
            for &(i, entry) in &row {
                let weighted = graph.mul(weight, entry);
                for &(j, other) in &row {
                    let part = graph.mul(weighted, other);
                    let sum = graph.add(matrix[i][j], part);
                    matrix[i][j] = shorter(graph, sum);
                }
                let part = graph.mul(weighted, constraints.bias[a]);
                linear[i] = graph.sub(linear[i], part);
            }
        }
        if graph.take_fault().is_none() {
            (self.matrix, self.linear, self.completing) = (matrix, linear, completing.to_vec());
        }
    }

    fn divide_what_is_alone(&mut self, graph: &mut Graph) {
        let free = self.matrix.len() - self.definitions.len();
        for i in (0..free).filter(|&i| self.is_alone(i)).collect::<Vec<_>>() {
            let quotient = graph.div(self.linear[i], self.matrix[i][i]);
            self.alone[i] = graph.take_fault().is_none().then_some(quotient);
        }
    }

    fn is_alone(&self, i: usize) -> bool {
        let is_defined_by = self.definitions.iter().flatten().any(|&(j, _)| j == i);
        let mut row = self.matrix[i].iter().enumerate();
        !is_defined_by && row.all(|(j, &entry)| (j == i) == (entry != Id::ZERO))
    }
}

/// The same without the boundaries of definitions, where those hide that terms cancel.
pub(super) fn shorter(graph: &mut Graph, entry: Id) -> Id {
    const LONG: usize = 100;
    let length = |graph: &Graph, root| graph.reachable(&[root]).len();
    let before = length(graph, entry);
    if before > LONG {
        return entry;
    }
    let through = graph.looked_through(entry);
    if length(graph, through) < before { through } else { entry }
}

/// The velocities that definitions name, as variables beside the generalized ones.
pub(super) struct Velocities {
    /// q̇, then the named velocities.
    pub(super) nodes: Vec<Id>,
    /// ∂(named velocity)/∂(each of the nodes before it)
    pub(super) rows: Vec<Vec<Id>>,
}

impl Velocities {
    /// The definitions in L that are linear in the velocities; none where very many contain a velocity.
    fn named(graph: &mut Graph, problem: &Problem) -> Self {
        let n = problem.coordinates.len();
        let q_dot: Vec<Id> = symbols(n, Variable::Velocity).iter().map(|&v| graph.symbol(v)).collect();
        let mut named = Self { nodes: q_dot, rows: Vec::new() };
        let mut moving = Moving::default();
        moving.extend(graph);
        let mut candidates: Vec<(Id, Id)> = Vec::new();
        for id in graph.reachable(&[problem.lagrangian]) {
            match *graph.node(id) {
                Node::Defined(inner) if moving.contains(id) => candidates.push((id, inner)),
                _ => {}
            }
        }
        if n + candidates.len() > LIMIT {
            return named;
        }
        for (id, inner) in candidates {
            let row = graph.gradient_to(inner, &named.nodes);
            moving.extend(graph);
            if row.iter().all(|&entry| !moving.contains(entry)) {
                named.nodes.push(id);
                named.rows.push(row);
            }
        }
        named
    }

    /// L is ℓ(q, q̇, w), the named velocities w are f(q, q̇, w) one after the other, and the adjoints of those are
    /// μ = ∂ℓ/∂w + Σ μ ∂f/∂w. Then p = ∂ℓ/∂q̇ + Σ μ ∂f/∂q̇, and the parts of d/dt p = ∂L/∂q + Q go to the x that
    /// they are the coefficients of.
    fn form(&self, graph: &mut Graph, problem: &Problem) -> Form {
        let local = graph.gradient_to(problem.lagrangian, &self.nodes);
        let linear = self.linear(graph, problem, &local);
        self.form_of(graph, &local, linear)
    }

    /// From the momenta ∂ℓ/∂(q̇, w) and b.
    pub(super) fn form_of(&self, graph: &mut Graph, local: &[Id], linear: Vec<Id>) -> Form {
        let matrix = self.hessian(graph, local);
        Form::over(matrix, linear, &self.rows)
    }

    /// ∂²ℓ/∂(q̇, w)²
    fn hessian(&self, graph: &mut Graph, local: &[Id]) -> Vec<Vec<Id>> {
        let row = |j: usize| {
            let rates = self.nodes.iter().enumerate();
            let rates = rates.map(|(i, &node)| (node, if i == j { Id::ONE } else { Id::ZERO }));
            let mut along = Forward::along([]).through(graph, rates);
            local.iter().map(|&part| along.of(graph, part)).collect()
        };
        (0..local.len()).map(row).collect()
    }

    fn linear(&self, graph: &mut Graph, problem: &Problem, local: &[Id]) -> Vec<Id> {
        let n = problem.coordinates.len();
        let one = Rational::from_integer(1);
        let adjoints = self.adjoints(graph, local);
        let mut along = drift(graph, n);
        let mut linear = Vec::with_capacity(local.len());
        for (j, &part) in local.iter().enumerate() {
            let mut terms = vec![(along.of(graph, part), -one)];
            for (row, &adjoint) in self.rows.iter().zip(&adjoints) {
                let Some(&entry) = row.get(j).filter(|&&entry| entry != Id::ZERO) else { continue };
                let turn = along.of(graph, entry);
                terms.push((graph.mul(adjoint, turn), -one));
            }
            linear.push(terms);
        }
        for (terms, force) in linear.iter_mut().zip(self.forces(graph, problem, &adjoints)) {
            terms.extend(force.into_iter().map(|force| (force, one)));
        }
        linear.into_iter().map(|terms| graph.sum(terms)).collect()
    }

    /// μ: named velocities that build on others hand theirs on.
    fn adjoints(&self, graph: &mut Graph, local: &[Id]) -> Vec<Id> {
        let n = local.len() - self.rows.len();
        let one = Rational::from_integer(1);
        let mut adjoints: Vec<Id> = vec![Id::ZERO; self.rows.len()];
        for k in (0..self.rows.len()).rev() {
            let mut terms = vec![(local[n + k], one)];
            let users = self.rows.iter().zip(&adjoints).skip(k + 1);
            for (row, &later) in users.filter(|(row, _)| row[n + k] != Id::ZERO) {
                terms.push((graph.mul(later, row[n + k]), one));
            }
            let adjoint = graph.sum(terms);
            adjoints[k] = graph.defined(adjoint);
        }
        adjoints
    }

    /// ∂L/∂q + Q by its parts: ∂ℓ/∂q, Q and Σ μ ∂f/∂q.
    fn forces(&self, graph: &mut Graph, problem: &Problem, adjoints: &[Id]) -> Vec<Vec<Id>> {
        let n = problem.coordinates.len();
        let q: Vec<Id> = symbols(n, Variable::Coordinate).iter().map(|&q| graph.symbol(q)).collect();
        let held: Vec<Id> = q.iter().chain(&self.nodes).copied().collect();
        let slopes = graph.gradient_to(problem.lagrangian, &held);
        let mut forces: Vec<Vec<Id>> = slopes[..n].iter().map(|&slope| vec![slope]).collect();
        for (k, &adjoint) in adjoints.iter().enumerate() {
            let Node::Defined(inner) = *graph.node(self.nodes[n + k]) else { continue };
            let held: Vec<Id> = q.iter().chain(&self.nodes[..n + k]).copied().collect();
            let slopes = graph.gradient_to(inner, &held);
            for (force, slope) in forces.iter_mut().zip(slopes).filter(|(_, slope)| *slope != Id::ZERO) {
                force.push(graph.mul(adjoint, slope));
            }
        }
        for (force, given) in forces.iter_mut().zip(generalized_forces(graph, problem)) {
            force.push(given);
        }
        forces
    }
}

/// What contains a velocity, of all nodes so far.
#[derive(Default)]
struct Moving(Vec<bool>);

impl Moving {
    fn contains(&self, id: Id) -> bool {
        self.0[id.index()]
    }

    fn extend(&mut self, graph: &Graph) {
        for id in graph.ids().skip(self.0.len()) {
            let mut any = match graph.node(id) {
                Node::Symbol(symbol) => matches!(Variable::of(*symbol), Variable::Velocity(_)),
                _ => false,
            };
            graph.operands(id, |operand| any |= self.contains(operand));
            self.0.push(any);
        }
    }
}
