//! Printed equations of motion of one element: the sum over all loop iterations that contribute to it.

use rustc_hash::FxHashMap;

use super::inertia::{Condition, MassEntry, at_element};
use super::{Scatter, slots};
use crate::resolve::Problem;
use crate::resolve::many::{Affine, Index, NewIndices, Range, Slot, Unknown};
use crate::symbolic::{Graph, Id};
use crate::variables::Variable;

/// Equations of the elements of an array in a region.
#[derive(Clone)]
pub(crate) struct ElementRows {
    pub(crate) region: Region,
    /// For each component of the element: its slot, M q̈, and the terms of h that are not sums.
    pub(crate) rows: Vec<(usize, Id, Id)>,
    pub(crate) sums: Vec<ElementSum>,
}

/// Elements to which an equation applies.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum Region {
    /// All of an array of this length along its axis, if it has one.
    All { length: Option<Affine> },
    /// The element i.
    Element(Affine),
    /// from ≤ i < to
    Within(Range),
    /// Elements away from both ends of every axis, for arrays of several axes.
    Interior,
}

/// Sum over other elements. The element has running index 0, the summand running index 1.
#[derive(Clone)]
pub(crate) struct ElementSum {
    pub(crate) over: Over,
    /// Summand of each component of the element.
    pub(crate) values: Vec<Id>,
}

#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum Over {
    Range(Range),
    /// All of a range but the element itself.
    Others(Range),
    /// Rows of a table in which this entry is the element.
    Entries(Range, Index),
}

/// Term that one slot contributes to one component of an element.
struct Contribution {
    number: usize,
    conditions: Vec<Condition>,
    over: Option<Over>,
    value: Id,
}

/// Equations of all arrays; `None` for an array whose loops have no closed form for one element.
pub(super) fn rows(
    graph: &mut Graph,
    problem: &mut Problem,
    forcing: &[Scatter],
    mass: &[MassEntry],
) -> Vec<Option<Vec<ElementRows>>> {
    (0..problem.many.arrays.len()).map(|array| rows_of(graph, problem, array, (forcing, mass))).collect()
}

fn rows_of(
    graph: &mut Graph,
    problem: &mut Problem,
    array: usize,
    (forcing, mass): (&[Scatter], &[MassEntry]),
) -> Option<Vec<ElementRows>> {
    let mut forces = Vec::new();
    for scatter in forcing {
        for (slot, value) in &scatter.values {
            let slot = problem.many.slots[*slot].clone();
            if slot.array == array {
                forces.push(contribution(graph, problem, &slot, (&scatter.ranges, *value))?);
            }
        }
    }
    let forces = paired(forces);
    let inertia: Vec<&MassEntry> = mass.iter().filter(|entry| entry.rows[0].0 == array).collect();
    let conditions = forces.iter().flat_map(|force| &force.conditions);
    let conditions = conditions.chain(inertia.iter().flat_map(|entry| &entry.conditions));
    let regions = regions(problem, array, conditions.cloned().collect())?;
    let rows =
        regions.into_iter().map(|region| in_region(graph, problem, (array, region), (&forces, &inertia)));
    Some(rows.collect())
}

fn contribution(
    graph: &mut Graph,
    problem: &mut Problem,
    slot: &Slot,
    (ranges, value): (&[Range], Id),
) -> Option<Contribution> {
    let number = slot.number;
    if let Some((new, conditions)) = at_element(problem, slot, ranges) {
        let value = problem.shifted(graph, value, &new);
        return Some(Contribution { number, conditions, over: None, value });
    }
    let [index] = &slot.indices[..] else { return None };
    match (index, ranges) {
        (Index::Entry(..), [range]) => {
            let new: NewIndices = [(0, Affine::of(Unknown::Level(1)))].into_iter().collect();
            let value = problem.shifted(graph, value, &new);
            let entry = index.shifted(&new);
            let value = at_entry(graph, problem, value, &entry);
            let over = Some(Over::Entries(range.clone(), entry));
            Some(Contribution { number, conditions: Vec::new(), over, value })
        }
        (Index::Affine(index), [first, second]) => {
            let mut levels = index.levels();
            let (Some(own), None) = (levels.next(), levels.next()) else { return None };
            let offset = index.plus(&Affine::of(Unknown::Level(own)), -1);
            (index.factor(Unknown::Level(own)) == 1).then_some(())?;
            let element = Affine::of(Unknown::Level(0)).plus(&offset, -1);
            let new: NewIndices =
                [(own, element), (1 - own, Affine::of(Unknown::Level(1)))].into_iter().collect();
            let value = problem.shifted(graph, value, &new);
            let range = if own == 0 { second.shifted(&new) } else { outer(first, second, &new)? };
            let own_range = if own == 0 { first } else { second };
            let length = &problem.many.arrays[slot.array].open[0];
            // Elements beyond a bound that varies have empty sums.
            let [from, to] = [(&own_range.from, Affine::number(0)), (&own_range.to, length.clone())]
                .map(|(bound, end)| if is_free(bound) { bound.plus(&offset, 1) } else { end });
            let own_range = Range { from, to };
            let is_all = own_range == Range::up_to(length);
            let conditions = (!is_all).then_some(Condition { level: 0, range: own_range });
            let over = Some(Over::Range(range));
            Some(Contribution { number, conditions: conditions.into_iter().collect(), over, value })
        }
        _ => None,
    }
}

fn is_free(bound: &Affine) -> bool {
    bound.levels().next().is_none()
}

/// Range of the outer index of two loops, for a given inner one; `None` if it has two lower or two upper bounds.
fn outer(first: &Range, second: &Range, new: &NewIndices) -> Option<Range> {
    let inner = &new[&1];
    let outer = Unknown::Level(0);
    let mut range = first.clone();
    // inner < outer + c and inner ≥ outer + c bound the outer index.
    let bound =
        |inner: &Affine, bound: &Affine| inner.plus(bound, -1).plus(&Affine::of(outer), 1).plus_number(1);
    let is_at_most =
        |one: &Affine, other: &Affine| other.plus(one, -1).as_number().is_some_and(|rest| rest >= 0);
    match (second.from.factor(outer), second.to.factor(outer)) {
        (0, 0) => {}
        (0, 1) => {
            is_at_most(&first.from, &bound(&second.from, &second.to)).then_some(())?;
            range.from = bound(inner, &second.to);
        }
        (1, 0) => {
            let most = bound(&second.to.plus_number(-1), &second.from);
            is_at_most(&most, &first.to).then_some(())?;
            range.to = bound(inner, &second.from);
        }
        _ => return None,
    }
    Some(range)
}

/// Substitutes the element itself for the entry of a table in a value.
fn at_entry(graph: &mut Graph, problem: &mut Problem, value: Id, entry: &Index) -> Id {
    let mut new = FxHashMap::default();
    for k in slots(graph, value) {
        let slot = problem.many.slots[k].clone();
        if slot.indices == [entry.clone()] {
            let indices = vec![Index::Affine(Affine::of(Unknown::Level(0)))];
            let own = problem.many.slot(Slot { indices, ..slot });
            for variable in [Variable::Coordinate as fn(usize) -> Variable, Variable::Velocity] {
                let node = graph.symbol(variable(own).symbol());
                new.insert(variable(k).symbol(), node);
            }
        }
    }
    graph.substituted(value, |symbol| new.get(&symbol).copied())
}

/// Merges equal sums over the preceding and the following elements into a sum over all others.
fn paired(contributions: Vec<Contribution>) -> Vec<Contribution> {
    let element = Affine::of(Unknown::Level(0));
    let mut joined: Vec<Contribution> = Vec::new();
    for contribution in contributions {
        let other = joined.iter_mut().find(|known| {
            known.number == contribution.number
                && known.value == contribution.value
                && known.conditions == contribution.conditions
                && others(&element, known.over.as_ref(), contribution.over.as_ref()).is_some()
        });
        match other {
            Some(known) => known.over = others(&element, known.over.as_ref(), contribution.over.as_ref()),
            None => joined.push(contribution),
        }
    }
    joined
}

fn others(element: &Affine, one: Option<&Over>, other: Option<&Over>) -> Option<Over> {
    let (Over::Range(one), Over::Range(other)) = (one?, other?) else { return None };
    let (before, behind) = if one.to == *element { (one, other) } else { (other, one) };
    let is_joined = before.to == *element && behind.from == element.plus_number(1);
    is_joined.then(|| Over::Others(Range { from: before.from.clone(), to: behind.to.clone() }))
}

/// Regions of elements with the same terms, in arrays long enough to contain each region. Returns `None` if a bound is
/// an offset from neither end, or if elements inside an array of several axes differ.
fn regions(problem: &Problem, array: usize, conditions: Vec<Condition>) -> Option<Vec<Region>> {
    let open = &problem.many.arrays[array].open;
    let [length] = &open[..] else {
        let region = if conditions.is_empty() { Region::All { length: None } } else { Region::Interior };
        let is_known = |condition: &Condition| condition.has_interior(open) || condition.is_edge(open);
        return conditions.iter().all(is_known).then(|| vec![region]);
    };
    let mut bounds: Vec<Affine> =
        conditions.into_iter().flat_map(|one| [one.range.from, one.range.to]).collect();
    bounds.extend([Affine::number(0), length.clone()]);
    let is_from_end = |bound: &Affine| length.plus(bound, -1).as_number().is_some();
    bounds.iter().all(|bound| bound.as_number().is_some() || is_from_end(bound)).then_some(())?;
    // Bounds counted from the start come before those counted from the end.
    bounds.sort_by_key(|bound| (bound.as_number().is_none(), bound.constant));
    bounds.dedup();
    let region = |pair: &[Affine]| match pair[1].plus(&pair[0], -1).as_number() {
        Some(1) => Region::Element(pair[0].clone()),
        _ => Region::Within(Range { from: pair[0].clone(), to: pair[1].clone() }),
    };
    Some(match bounds.len() {
        2 => vec![Region::All { length: Some(length.clone()) }],
        _ => bounds.windows(2).map(region).collect(),
    })
}

impl Condition {
    /// True if all elements but the outermost meet it.
    fn has_interior(&self, open: &[Affine]) -> bool {
        let outside = [self.range.from.clone(), open[self.level].plus(&self.range.to, -1)];
        outside.into_iter().all(|outside| outside.as_number().is_some_and(|count| count <= 1))
    }

    /// True if the first or the last element alone meets it.
    fn is_edge(&self, open: &[Affine]) -> bool {
        let Range { from, to } = &self.range;
        let is_one = to.plus(from, -1).as_number() == Some(1);
        is_one && (*from == Affine::number(0) || *to == open[self.level])
    }
}

/// True if elements of the region meet the conditions.
fn holds(region: &Region, conditions: &[Condition], open: &[Affine]) -> bool {
    let is_below = |one: &Affine, other: &Affine| {
        other.plus(one, -1).as_number().map_or(one.as_number().is_some(), |difference| difference >= 0)
    };
    if let Region::Interior = region {
        return conditions.iter().all(|condition| condition.has_interior(open));
    }
    conditions.iter().all(|Condition { range, .. }| match region {
        Region::All { .. } | Region::Interior => true,
        Region::Element(at) => is_below(&range.from, at) && is_below(&at.plus_number(1), &range.to),
        Region::Within(own) => is_below(&range.from, &own.from) && is_below(&own.to, &range.to),
    })
}

fn in_region(
    graph: &mut Graph,
    problem: &mut Problem,
    (array, region): (usize, Region),
    (forces, inertia): (&[Contribution], &[&MassEntry]),
) -> ElementRows {
    let new: NewIndices = match &region {
        Region::Element(at) => [(0, at.clone())].into_iter().collect(),
        _ => NewIndices::default(),
    };
    let open = problem.many.arrays[array].open.clone();
    let axes = open.len();
    let element: Vec<Index> =
        (0..axes).map(|axis| Index::Affine(Affine::of(Unknown::Level(axis)).shifted(&new))).collect();
    let count = crate::syntax::numbers(&problem.many.arrays[array].lengths);
    let active: Vec<&Contribution> =
        forces.iter().filter(|force| holds(&region, &force.conditions, &open)).collect();
    let mut rows = Vec::new();
    for number in 0..count {
        let slot = problem.many.slot(Slot { array, indices: element.clone(), number });
        let mut terms = Vec::new();
        for entry in inertia
            .iter()
            .filter(|entry| entry.rows[0].1 == number && holds(&region, &entry.conditions, &open))
        {
            let (other, number) = entry.rows[1];
            let other = problem.many.slot(Slot { array: other, indices: element.clone(), number });
            let acceleration = graph.symbol(Variable::Acceleration(other).symbol());
            let value = problem.shifted(graph, entry.value, &new);
            terms.push(graph.mul(value, acceleration));
        }
        let own = active.iter().filter(|force| force.number == number && force.over.is_none());
        let own: Vec<Id> = own.map(|force| problem.shifted(graph, force.value, &new)).collect();
        rows.push((slot, graph.total(terms), graph.total(own)));
    }
    let sums = sums(graph, problem, &active, (&new, count));
    ElementRows { region, rows, sums }
}

fn sums(
    graph: &mut Graph,
    problem: &mut Problem,
    active: &[&Contribution],
    (new, count): (&NewIndices, usize),
) -> Vec<ElementSum> {
    let mut sums: Vec<ElementSum> = Vec::new();
    for force in active {
        let Some(over) = &force.over else { continue };
        let over = match over {
            Over::Range(range) => Over::Range(range.shifted(new)),
            Over::Others(range) => Over::Others(range.shifted(new)),
            Over::Entries(range, entry) => Over::Entries(range.clone(), entry.clone()),
        };
        let value = problem.shifted(graph, force.value, new);
        let place = sums.iter().position(|known| known.over == over).unwrap_or_else(|| {
            sums.push(ElementSum { over, values: vec![Id::ZERO; count] });
            sums.len() - 1
        });
        let known = &mut sums[place].values[force.number];
        *known = graph.add(*known, value);
    }
    sums
}
