//! Block-diagonal mass matrix: the kinetic energy couples only velocities of one element.

use rustc_hash::FxHashMap;

use super::Pattern;
use crate::diagnostics::Diagnostics;
use crate::mechanics::LinearEquations;
use crate::mechanics::hamilton::{self, NoHamiltonian};
use crate::resolve::Problem;
use crate::resolve::many::{Affine, Index, NewIndices, Range, Slot, Unknown};
use crate::symbolic::{Graph, Id};
use crate::variables::{Variable, has_velocity};

/// Equations M q̈ = h of the coordinates of one element, the same for each element.
pub(crate) struct Inertia {
    /// Number of elements along each axis. The running index of axis k has depth k.
    pub(crate) lengths: Vec<Affine>,
    /// Array and component of each row.
    pub(crate) rows: Vec<(usize, usize)>,
    /// Entries of M that are zero for some elements.
    pub(crate) guarded: Vec<Guarded>,
    /// M and h, in terms of the `Variable::Term`s of `guarded` and of `Variable::Forcing`, one for each row.
    pub(crate) equations: LinearEquations,
}

/// Entries of M that are nonzero only for elements that meet all conditions.
pub(crate) struct Guarded {
    pub(crate) conditions: Vec<Condition>,
    /// Entries of M: k of the `Variable::Term(k)` that stands for the entry, and its value.
    pub(crate) values: Vec<(usize, Id)>,
}

/// from ≤ running index < to
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Condition {
    pub(crate) level: usize,
    pub(crate) range: Range,
}

/// Entry of M: the second derivative of a pattern by two velocities of one element.
pub(super) struct MassEntry {
    /// Array and component of the row, and of the column.
    pub(super) rows: [(usize, usize); 2],
    pub(super) conditions: Vec<Condition>,
    pub(super) value: Id,
}

/// Solves for the accelerations of each element. Reports velocities of different elements that meet, and coordinates without a
/// velocity in L. The arrays `chained` share a block, whose elements may have no mass.
pub(super) fn blocks(
    graph: &mut Graph,
    problem: &mut Problem,
    (patterns, chained): (&[Pattern], &[usize]),
    diagnostics: &mut Diagnostics,
) -> Option<(Vec<Inertia>, Vec<MassEntry>)> {
    let mut entries = Vec::new();
    for pattern in patterns {
        entries.extend(entries_of(graph, problem, pattern, diagnostics)?);
    }
    let groups = groups(problem, &entries, chained);
    let blocks: Vec<Option<Inertia>> = groups
        .into_iter()
        .map(|arrays| {
            let is_chained = chained.contains(&arrays[0]);
            block(graph, problem, (&arrays, is_chained), &entries, diagnostics)
        })
        .collect();
    Some((blocks.into_iter().collect::<Option<_>>()?, entries))
}

fn entries_of(
    graph: &mut Graph,
    problem: &mut Problem,
    pattern: &Pattern,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<MassEntry>> {
    let slots = super::slots(graph, pattern.body);
    let momenta = super::gradient(graph, pattern.body, &slots, Variable::Velocity);
    let mut entries = Vec::new();
    for (&a, momentum) in slots.iter().zip(momenta) {
        let row = super::gradient(graph, momentum, &slots, Variable::Velocity);
        for (&b, value) in slots.iter().zip(row) {
            if value != Id::ZERO {
                let entry = entry(graph, problem, &pattern.ranges, [a, b], value);
                match entry {
                    Ok(entry) => entries.push(entry),
                    Err(message) => {
                        diagnostics.error(problem.place, message);
                        return None;
                    }
                }
            }
        }
    }
    Some(entries)
}

fn entry(
    graph: &mut Graph,
    problem: &mut Problem,
    ranges: &[Range],
    [a, b]: [usize; 2],
    value: Id,
) -> Result<MassEntry, String> {
    let [one, other] = [a, b].map(|k| problem.many.slots[k].clone());
    if one.indices != other.indices
        || problem.many.arrays[one.array].open != problem.many.arrays[other.array].open
    {
        let labels = problem.many.labels(&problem.parameters);
        let (one, other) = (&labels[a].text, &labels[b].text);
        return Err(format!(
            "the velocities of `{one}` and `{other}` multiply one another in the Lagrangian, and the mass matrix would couple one element to the next: with a length that is known when the program runs, only velocities of one element may do so yet"
        ));
    }
    let (new, conditions) = at_element(problem, &one, ranges).ok_or_else(|| {
        let labels = problem.many.labels(&problem.parameters);
        format!(
            "`{}` has a velocity in a sum whose rounds are no elements of it, so that its mass would be a sum, too: write the kinetic energy as a sum over its elements",
            labels[a].text
        )
    })?;
    let value = problem.shifted(graph, value, &new);
    let rows = [&one, &other].map(|slot| (slot.array, slot.number));
    Ok(MassEntry { rows, conditions, value })
}

/// Solves for the loop indices at which a slot is the element (i, j, …). Also returns the conditions on i, j, … under which
/// they are in range. Returns `None` if several iterations reach one element.
pub(super) fn at_element(
    problem: &Problem,
    slot: &Slot,
    ranges: &[Range],
) -> Option<(NewIndices, Vec<Condition>)> {
    let mut new: NewIndices = FxHashMap::default();
    let mut fixed = Vec::new();
    for (axis, index) in slot.indices.iter().enumerate() {
        let Index::Affine(index) = index else { return None };
        let mut levels = index.levels();
        let element = Affine::of(Unknown::Level(axis));
        match (levels.next(), levels.next()) {
            (None, _) => fixed.push((axis, index.clone())),
            (Some(level), None) if index.factor(Unknown::Level(level)) == 1 && !new.contains_key(&level) => {
                let offset = index.plus(&Affine::of(Unknown::Level(level)), -1);
                new.insert(level, element.plus(&offset, -1));
            }
            _ => return None,
        }
    }
    (new.len() == ranges.len()).then_some(())?;
    let mut conditions: Vec<Condition> = fixed
        .into_iter()
        .map(|(level, at)| Condition { level, range: Range { to: at.plus_number(1), from: at } })
        .collect();
    for (level, range) in ranges.iter().enumerate() {
        let at = &new[&level];
        let (axis, offset) = at.terms.iter().find_map(|(unknown, _)| match unknown {
            Unknown::Level(axis) => Some((*axis, at.plus(&Affine::of(*unknown), -1))),
            Unknown::Length(_) => None,
        })?;
        let bound = |bound: &Affine| bound.shifted(&new).plus(&offset, -1);
        conditions
            .push(Condition { level: axis, range: Range { from: bound(&range.from), to: bound(&range.to) } });
    }
    let lengths = &problem.many.arrays[slot.array].open;
    let is_all = |Condition { level, range }: &Condition| {
        range.from == Affine::number(0) && range.to == lengths[*level]
    };
    conditions.retain(|condition| !is_all(condition));
    conditions.sort_by_key(|condition| condition.level);
    Some((new, conditions))
}

/// Arrays whose elements share entries of M, in the order of the coordinates.
fn groups(problem: &Problem, entries: &[MassEntry], chained: &[usize]) -> Vec<Vec<usize>> {
    let mut group: Vec<usize> = (0..problem.many.arrays.len()).collect();
    let by_mass = entries.iter().map(|entry| entry.rows.map(|(array, _)| array));
    let by_recursion = chained.windows(2).map(|pair| [pair[0], pair[1]]);
    for [one, other] in by_mass.chain(by_recursion) {
        let (one, other) = (group[one], group[other]);
        group.iter_mut().filter(|known| **known == other.max(one)).for_each(|known| *known = other.min(one));
    }
    let arrays = |first: usize| (0..group.len()).filter(|&array| group[array] == first).collect();
    (0..group.len()).filter(|&array| group[array] == array).map(arrays).collect()
}

fn block(
    graph: &mut Graph,
    problem: &Problem,
    (arrays, may_be_massless): (&[usize], bool),
    entries: &[MassEntry],
    diagnostics: &mut Diagnostics,
) -> Option<Inertia> {
    let rows: Vec<(usize, usize)> = arrays
        .iter()
        .flat_map(|&array| {
            let count = crate::syntax::numbers(&problem.many.arrays[array].lengths);
            (0..count).map(move |number| (array, number))
        })
        .collect();
    let mut mass = vec![vec![Id::ZERO; rows.len()]; rows.len()];
    let mut guarded: Vec<Guarded> = Vec::new();
    let mut terms = 0;
    for MassEntry { rows: at, conditions, value } in entries {
        let place = at.map(|row| rows.iter().position(|known| *known == row));
        let [Some(i), Some(j)] = place else { continue };
        let value = match conditions.is_empty() {
            true => *value,
            false => {
                push(&mut guarded, conditions, (terms, *value));
                terms += 1;
                graph.symbol(Variable::Term(terms - 1).symbol())
            }
        };
        mass[i][j] = graph.add(mass[i][j], value);
    }
    let partly = || massless(problem, &rows, entries);
    let mut fault = || undetermined(graph, problem, &rows, &mass).or_else(partly);
    if !may_be_massless && let Some((row, message)) = fault() {
        diagnostics.error(problem.many.arrays[rows[row].0].place, message);
        return None;
    }
    let forcing = (0..rows.len()).map(|row| graph.symbol(Variable::Forcing(row).symbol())).collect();
    let equations = LinearEquations::of_masses(graph, mass, forcing);
    let lengths = problem.many.arrays[arrays[0]].open.clone();
    Some(Inertia { lengths, rows, guarded, equations })
}

/// Row of M at fault, and why M does not determine the accelerations of an element, or an elimination without exchanges does not find
/// them.
fn undetermined(
    graph: &mut Graph,
    problem: &Problem,
    rows: &[(usize, usize)],
    mass: &[Vec<Id>],
) -> Option<(usize, String)> {
    let name = |row: usize| &problem.many.arrays[rows[row].0].name;
    let all: Vec<usize> = (0..rows.len()).collect();
    if let Some(&row) = all.iter().find(|&&row| mass[row].iter().all(|&entry| entry == Id::ZERO)) {
        return Some((
            row,
            format!(
                "the velocity of `{}` does not occur in the Lagrangian, so that nothing determines its acceleration",
                name(row)
            ),
        ));
    }
    if let Some(&row) = all.iter().find(|&&row| mass[row][row] == Id::ZERO) {
        return Some((
            row,
            format!(
                "the square of the velocity of `{}` does not occur in the Lagrangian: where the number of coordinates is known when the program runs, the square of each velocity must; for a product of two velocities, take the sum and the difference of their coordinates",
                name(row)
            ),
        ));
    }
    let is_singular =
        matches!(hamilton::inverse_of_block(graph, problem, mass, &all), Err(NoHamiltonian::Singular));
    let message = || {
        format!(
            "the Lagrangian does not determine the accelerations of an element of `{}`: some motion of it has no kinetic energy, which makes its mass matrix singular",
            name(0)
        )
    };
    is_singular.then(|| (0, message()))
}

/// Row whose velocity has a square for some elements only, of an array along one axis.
fn massless(problem: &Problem, rows: &[(usize, usize)], entries: &[MassEntry]) -> Option<(usize, String)> {
    let row = rows.iter().position(|row| {
        let [length] = &problem.many.arrays[row.0].open[..] else { return false };
        let own = entries.iter().filter(|entry| entry.rows == [*row; 2]);
        let ranges = own.map(|entry| match &entry.conditions[..] {
            [condition] => condition.range.clone(),
            _ => Range::up_to(length),
        });
        !is_covered(ranges.collect(), length)
    })?;
    let name = &problem.many.arrays[rows[row].0].name;
    Some((
        row,
        format!(
            "the square of the velocity of `{name}` occurs in the Lagrangian for some elements only, so that nothing determines the accelerations of the others: sum the kinetic energy over all elements"
        ),
    ))
}

/// True if ranges that begin where others end reach from 0 to the length.
fn is_covered(mut ranges: Vec<Range>, length: &Affine) -> bool {
    let rest = |to: &Affine, from: &Affine| to.plus(from, -1).as_number();
    let mut reached = Affine::number(0);
    while rest(length, &reached).is_none_or(|rest| rest > 0) {
        let goes_on = |range: &Range| {
            rest(&reached, &range.from).is_some_and(|rest| rest >= 0)
                && rest(&range.to, &reached).is_none_or(|rest| rest > 0)
        };
        let Some(next) = ranges.iter().position(goes_on) else { return false };
        reached = ranges.swap_remove(next).to;
    }
    true
}

fn push(guarded: &mut Vec<Guarded>, conditions: &[Condition], value: (usize, Id)) {
    match guarded.iter_mut().find(|known| known.conditions == conditions) {
        Some(known) => known.values.push(value),
        None => guarded.push(Guarded { conditions: conditions.to_vec(), values: vec![value] }),
    }
}

impl Inertia {
    pub(super) fn has_velocity(&self, graph: &Graph) -> bool {
        let guarded = self.guarded.iter().flat_map(|guarded| &guarded.values).map(|(_, value)| *value);
        has_velocity(
            graph,
            &self.equations.forms[0].matrix.concat().into_iter().chain(guarded).collect::<Vec<_>>(),
        )
    }
}
