//! Vectors and matrices of a system, of which products are recognized.

use rustc_hash::FxHashSet;

use super::super::axes::NamedAxes;
use super::super::formula::Formula;
use super::super::letters::{Letters, PageQuantity};
use super::atoms::Meaning;
use super::expand::Expansion;
use crate::mechanics::Derived;
use crate::resolve::{Problem, vector};
use crate::symbolic::{Graph, Id, Node};
use crate::variables::Variable;

impl Expansion<'_> {
    /// Names rotation matrices, and the vectors and moments of inertia that they are multiplied with.
    pub(super) fn name_tensors(
        &mut self,
        (problem, derived, letters): (&Problem, &Derived, &Letters),
        axes: &[NamedAxes],
    ) {
        for axes in axes {
            self.same.extend(axes.nodes.iter().map(|&(node, [i, j])| (node, axes.entries[i][j])));
        }
        let renamed =
            derived.turnings.renamed.iter().filter(|(_, definition)| self.names.contains(definition));
        self.same.extend(renamed.copied());
        for axes in axes {
            // A matrix contains its named columns, such as the axis of a body, by their names.
            let known = |id: Id| self.same.get(&id).copied().unwrap_or(id);
            let entries = axes.entries.map(|row| row.map(known));
            let entries = entries.map(|row| row.map(|id| self.atoms.atom(Meaning::Definition(id))));
            self.atoms.tensors.add_matrix(axes.name(), entries, true);
        }
        let matrices = matrices(self.graph, problem, derived);
        for (written, components) in vectors((problem, derived, letters), &self.names) {
            if matrices.iter().any(|(matrix, _)| written.has_name(matrix)) {
                continue;
            }
            let components = components.map(|meaning| self.atoms.atom(meaning));
            self.atoms.add_vector(written, components);
        }
        for (written, entries) in matrices {
            let entries =
                entries.map(|row| row.map(|k| self.atoms.atom(Meaning::Variable(Variable::Parameter(k)))));
            self.atoms.tensors.add_matrix(written, entries, false);
        }
        self.name_products(problem);
    }

    /// Names the products that definitions stand for, as n = Aᵀ e.
    fn name_products(&mut self, problem: &Problem) {
        for (_, places) in definitions(problem, &self.names) {
            let values = places.map(|id| match self.graph.node(id) {
                &Node::Defined(inner) => self.of(inner),
                _ => None,
            });
            let components = places.map(|id| self.atoms.atom(Meaning::Definition(id)));
            if let [Some(x), Some(y), Some(z)] = &values {
                self.atoms.name_product([x, y, z], components);
            }
        }
    }
}

/// Vectors of three: coordinates with their rates and momenta, angular velocities, parameters, multipliers, and definitions
/// that keep their names.
fn vectors(
    (problem, derived, letters): (&Problem, &Derived, &Letters),
    names: &FxHashSet<Id>,
) -> Vec<(Formula, [Meaning; 3])> {
    let variable = |i: usize, of: fn(usize) -> Variable| Meaning::Variable(of(i));
    let texts: Vec<&str> = problem.coordinates.iter().map(|label| &*label.text).collect();
    let mut all = Vec::new();
    for (base, [i, j, k]) in triples(&texts) {
        let kinds = [
            (0, Variable::Coordinate as fn(usize) -> Variable),
            (1, Variable::Velocity),
            (2, Variable::Acceleration),
        ];
        all.extend(
            kinds.map(|(dots, of)| (Formula::labelled(&base, dots), [i, j, k].map(|i| variable(i, of)))),
        );
        all.push((
            letters.name_of(PageQuantity::Momentum, &base, 0),
            [i, j, k].map(|i| variable(i, Variable::Momentum)),
        ));
    }
    for turning in &derived.turnings.all {
        let quaternion = vector(&problem.coordinates[turning.first].text).unwrap_or_default();
        let kinds = [(0, Variable::Velocity as fn(usize) -> Variable), (1, Variable::Acceleration)];
        all.extend(kinds.map(|(dots, of)| {
            let name = letters.name_of(PageQuantity::AngularVelocity, quaternion, dots);
            (name, [0, 1, 2].map(|axis| variable(turning.rate + axis, of)))
        }));
    }
    let parameters = parameter_names(problem);
    let parameters: Vec<&str> = parameters.iter().map(String::as_str).collect();
    all.extend(triples(&parameters).into_iter().map(|(base, places)| {
        (Formula::labelled(&base, 0), places.map(|k| variable(k, Variable::Parameter)))
    }));
    let constraints: Vec<&str> = problem.constraints.iter().map(|(label, _)| &*label.text).collect();
    all.extend(triples(&constraints).into_iter().map(|(base, places)| {
        (Formula::Multiplier(base), places.map(|a| variable(a, Variable::Multiplier)))
    }));
    let definitions = definitions(problem, names).into_iter();
    all.extend(definitions.map(|(base, ids)| (Formula::labelled(&base, 0), ids.map(Meaning::Definition))));
    all
}

/// Definitions that are vectors of three and keep their names.
fn definitions(problem: &Problem, names: &FxHashSet<Id>) -> Vec<(String, [Id; 3])> {
    let named = names.iter().filter_map(|id| Some((*id, &**problem.names.get(id)?)));
    let mut named: Vec<(Id, &str)> = named.collect();
    named.sort_unstable();
    let texts: Vec<&str> = named.iter().map(|(_, text)| *text).collect();
    triples(&texts).into_iter().map(|(base, places)| (base, places.map(|place| named[place].0))).collect()
}

/// Parameters that are matrices of three by three. Of two equal moments of inertia, that on the other side of the diagonal
/// stands for both.
fn matrices(graph: &Graph, problem: &Problem, derived: &Derived) -> Vec<(Formula, [[usize; 3]; 3])> {
    let names = parameter_names(problem);
    let moments = derived.turnings.all.iter().filter_map(|turning| turning.euler.as_ref());
    let moments: FxHashSet<usize> = moments.flat_map(|euler| parameters_in(graph, &euler.inertia)).collect();
    let at = |text: String| names.iter().position(|known| *known == text);
    let matrix = |base: &str| {
        let own = |i: usize, j: usize| at(format!("{base}[{i}][{j}]"));
        let entry = |i: usize, j: usize| {
            let both = [own(i, j), own(j, i)];
            let moment = both.into_iter().flatten().find(|k| moments.contains(k));
            moment.or(both[0]).or(both[1])
        };
        let mut entries = [[0; 3]; 3];
        for (i, row) in entries.iter_mut().enumerate() {
            for (j, k) in row.iter_mut().enumerate() {
                *k = entry(i, j)?;
            }
        }
        let is_larger = [[0, 3], [3, 0]].iter().any(|&[i, j]| own(i, j).is_some());
        (!is_larger).then(|| (Formula::labelled(base, 0), entries))
    };
    names.iter().filter_map(|name| name.strip_suffix("[0][0]")).filter_map(matrix).collect()
}

fn parameter_names(problem: &Problem) -> Vec<String> {
    (0..problem.parameters.entries.len()).map(|k| problem.parameters.name(k)).collect()
}

fn parameters_in(graph: &Graph, matrix: &[[Id; 3]; 3]) -> Vec<usize> {
    let parameter = |symbol| match Variable::of(symbol) {
        Variable::Parameter(k) => Some(k),
        _ => None,
    };
    graph.symbols(&matrix.concat()).filter_map(parameter).collect()
}

/// Names with the indices 0 to 2 and no others, and the places of these.
fn triples(texts: &[&str]) -> Vec<(String, [usize; 3])> {
    let at = |text: String| texts.iter().position(|known| *known == text);
    let firsts = texts.iter().filter_map(|text| text.strip_suffix("[0]"));
    let triple = |base: &str| {
        let place = |k: usize| at(format!("{base}[{k}]"));
        let places = [place(0)?, place(1)?, place(2)?];
        place(3).is_none().then(|| (base.to_owned(), places))
    };
    firsts.filter_map(triple).collect()
}
