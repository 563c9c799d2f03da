//! Constraints between neighbours along one axis: only entries of F M⁻¹ Fᵀ near its diagonal are not zero.

use super::{ConstraintRow, Inertia, ManyConstraint};
use crate::resolve::Problem;
use crate::resolve::many::{Affine, Index, Range, Slot, Unknown, totals};
use crate::symbolic::{Graph, Id};

/// Largest half-width of a band. Its rows are unrolled, so that the emitted code grows by its square; wider ones are eliminated as those
/// of any pattern.
const WIDEST: usize = 12;

/// Constraints position by position: those at position p contain elements p, p + 1, … of arrays of one length. Positions begin before the
/// first element, so that a constraint of this element alone has one that no longer constraint has.
pub(crate) struct Band {
    /// Length of the arrays.
    pub(crate) length: Affine,
    /// Number of elements in a constraint, at most.
    pub(crate) elements: usize,
    /// Array and number of each coordinate of an element.
    pub(crate) coordinates: Vec<(usize, usize)>,
    /// Constraints of which at each position one has a row at most, or as many as it has components.
    pub(crate) lanes: Vec<Vec<Place>>,
}

/// Position of a constraint.
pub(crate) struct Place {
    /// Index of the constraint.
    pub(crate) constraint: usize,
    /// Rounds of its loop; of a constraint without a loop, the index of one of its elements.
    pub(crate) rounds: Range,
    /// Position less the round.
    pub(crate) offset: i64,
}

impl Band {
    /// The band of these constraints; `None` if they have none, or a wide one.
    pub(super) fn of(
        graph: &Graph,
        problem: &Problem,
        (constraints, inertia): (&[ManyConstraint], &[Inertia]),
    ) -> Option<Self> {
        let mut length: Option<Affine> = None;
        let (mut spans, mut elements, mut coordinates) = (Vec::new(), 0, Vec::new());
        for constraint in constraints {
            let slots = slots(graph, problem, constraint)?;
            let rounds = rounds(constraint, &slots)?;
            let mut offsets = Vec::new();
            for slot in &slots {
                let [own] = &problem.many.arrays[slot.array].open[..] else { return None };
                (*length.get_or_insert_with(|| own.clone()) == *own).then_some(())?;
                offsets.push(constraint.offset(slot, &rounds)?);
                coordinates.extend(element(inertia, slot).0);
            }
            let (first, last) = (*offsets.iter().min()?, *offsets.iter().max()?);
            elements = elements.max(last - first + 1);
            spans.push((rounds, first, last));
        }
        coordinates.sort_unstable();
        coordinates.dedup();
        let mut lanes = Vec::new();
        let mut longest_first: Vec<_> = spans.into_iter().enumerate().collect();
        longest_first.sort_by_key(|(_, (_, first, last))| first - last);
        for (constraint, (rounds, first, last)) in longest_first {
            // Positions from which the window of a band reaches all elements.
            let offsets = (last - elements + 1..=first).rev();
            place(
                &mut lanes,
                constraints,
                offsets.map(|offset| Place { constraint, rounds: rounds.clone(), offset }),
            );
        }
        let band = Self { length: length?, elements: usize::try_from(elements).ok()?, coordinates, lanes };
        let is_loop = constraints.iter().any(|constraint| !constraint.ranges.is_empty());
        (is_loop && band.rows(constraints) * band.elements <= WIDEST + 1).then_some(band)
    }

    /// Number of rows at a position.
    pub(crate) fn rows(&self, constraints: &[ManyConstraint]) -> usize {
        self.lanes.iter().map(|lane| constraints[lane[0].constraint].rows.len()).sum()
    }
}

/// Puts a constraint into the first lane that has room for it in one of these places.
fn place(lanes: &mut Vec<Vec<Place>>, constraints: &[ManyConstraint], places: impl Iterator<Item = Place>) {
    let rows = |place: &Place| constraints[place.constraint].rows.len();
    let mut places: Vec<Place> = places.collect();
    for lane in &mut *lanes {
        let has_room = |new: &Place| lane.iter().all(|known| rows(known) == rows(new) && known.is_apart(new));
        if let Some(at) = places.iter().position(has_room) {
            lane.push(places.swap_remove(at));
            return;
        }
    }
    lanes.extend((!places.is_empty()).then(|| vec![places.swap_remove(0)]));
}

impl Place {
    /// True if two constraints never have the same position.
    fn is_apart(&self, other: &Self) -> bool {
        let positions = |Self { rounds, offset, .. }: &Self| Range {
            from: rounds.from.plus_number(*offset),
            to: rounds.to.plus_number(*offset),
        };
        positions(self).is_apart(&positions(other))
    }
}

/// Slots with a coefficient in a constraint; `None` if some are in loops of their own, or an expression contains a sum.
fn slots(graph: &Graph, problem: &Problem, constraint: &ManyConstraint) -> Option<Vec<Slot>> {
    let depth = constraint.ranges.len();
    let roots: Vec<Id> = constraint.rows.iter().flat_map(ConstraintRow::roots).collect();
    (depth <= 1 && totals(graph, &roots).is_empty()).then_some(())?;
    let parts = constraint.rows.iter().flat_map(|row| &row.slopes);
    parts.clone().all(|part| part.ranges.len() == depth).then_some(())?;
    Some(parts.flat_map(|part| &part.values).map(|(slot, _)| problem.many.slots[*slot].clone()).collect())
}

fn rounds(constraint: &ManyConstraint, slots: &[Slot]) -> Option<Range> {
    if let Some(range) = constraint.ranges.first() {
        return Some(range.clone());
    }
    let [Index::Affine(at)] = &slots.first()?.indices[..] else { return None };
    Some(Range { from: at.clone(), to: at.plus_number(1) })
}

impl ManyConstraint {
    /// Element of a slot less the round.
    pub(crate) fn offset(&self, slot: &Slot, rounds: &Range) -> Option<i64> {
        let [Index::Affine(index)] = &slot.indices[..] else { return None };
        let round = match self.ranges.is_empty() {
            true => rounds.from.clone(),
            false => Affine::of(Unknown::Level(0)),
        };
        index.plus(&round, -1).as_number()
    }
}

impl ConstraintRow {
    /// All expressions of the row.
    pub(crate) fn roots(&self) -> impl Iterator<Item = Id> {
        let slopes = self.slopes.iter().flat_map(|part| &part.values).map(|(_, slope)| *slope);
        self.residual.into_iter().chain([self.rate, self.bias]).chain(slopes)
    }
}

/// Array and number of the coordinates that M couples with a slot, itself included, and its place among them.
pub(crate) fn element(inertia: &[Inertia], slot: &Slot) -> (Vec<(usize, usize)>, usize) {
    let own = (slot.array, slot.number);
    let place = |block: &Inertia| block.rows.iter().position(|row| *row == own);
    match inertia.iter().find_map(|block| Some((block, place(block)?))) {
        Some((block, place)) if !block.is_diagonal() => (block.rows.clone(), place),
        _ => (vec![own], 0),
    }
}

impl Inertia {
    /// True if the velocities of an element do not multiply one another.
    pub(crate) fn is_diagonal(&self) -> bool {
        let is_apart = |(i, row): (usize, &Vec<Id>)| {
            row.iter().enumerate().all(|(j, entry)| i == j || *entry == Id::ZERO)
        };
        self.equations.forms[0].matrix.iter().enumerate().all(is_apart)
    }
}
