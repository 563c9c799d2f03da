//! The directions in (q, t) that a set of constraints allows, and those that their motions reach.

use std::collections::{BTreeSet, VecDeque};

use super::space::{OneForm, Space};
use crate::mechanics::Evidence;
use crate::symbolic::{Forward, Id, Symbol};

/// Vector fields that span the directions in which every form vanishes. Each is 1 along a free variable of its
/// own and has parts along the pivots; time is always free, as along every motion.
pub(super) struct Distribution {
    pivots: Vec<usize>,
    /// How many of the pivots the holonomic constraints take.
    holonomic: usize,
    fields: Vec<(usize, Vec<Id>)>,
    /// Whether it is only seen at points that constraints depend on others.
    evidence: Evidence,
}

/// What the allowed directions generate by their Lie brackets, beside themselves.
pub(super) struct Closure {
    /// Independent further directions, their parts along the pivots.
    pub(super) reached: Vec<Vec<Id>>,
    /// How sure it is that there are no more.
    pub(super) evidence: Evidence,
}

impl Distribution {
    /// `None` where the constraints contradict each other or have no values.
    pub(super) fn new(space: &mut Space, velocity: &[OneForm]) -> Option<Self> {
        let (holonomic, rows) = (space.holonomic.len(), [&space.holonomic, velocity].concat());
        let mut elimination = Elimination { space, rows, pivots: Vec::new() };
        elimination.pivot_all(holonomic);
        let holonomic = elimination.pivots.len();
        elimination.pivot_all(elimination.rows.len());
        let rest = (0..elimination.rows.len()).filter(|&row| !elimination.is_pivot(row));
        let left: Vec<Id> = rest.flat_map(|row| elimination.rows[row].clone()).collect();
        let Elimination { space, rows, pivots } = elimination;
        space.settled()?;
        let (dependent, evidence) = space.vanish(&left)?;
        let columns: Vec<usize> = pivots.iter().map(|&(_, column)| column).collect();
        let free = (0..space.symbols.len()).filter(|column| !columns.contains(column));
        let fields = free.map(|column| {
            let parts = pivots.iter().map(|&(row, _)| space.graph.neg(rows[row][column]));
            (column, parts.collect())
        });
        let fields = fields.collect();
        dependent.then_some(Self { pivots: columns, holonomic, fields, evidence })
    }

    /// How many constraints there are beside the holonomic ones, those that depend on others not counted.
    pub(super) fn independent(&self) -> usize {
        self.pivots.len() - self.holonomic
    }

    /// ω of each field.
    pub(super) fn applied(&self, space: &mut Space, form: &OneForm) -> Vec<Id> {
        let applied = self.fields.iter().map(|(free, parts)| {
            let along = self.along_pivots(space, form, parts);
            space.graph.add(form[*free], along)
        });
        applied.collect()
    }

    /// ω of a direction along the pivots.
    pub(super) fn along_pivots(&self, space: &mut Space, form: &OneForm, parts: &[Id]) -> Id {
        let along: Vec<Id> = self.pivots.iter().map(|&pivot| form[pivot]).collect();
        space.graph.dot(&along, parts)
    }

    /// dω(X, Y) = X(ω(Y)) − Y(ω(X)) for every two fields: these are coordinate fields on each Φ = constant, so
    /// that [X, Y] = 0. Only for the holonomic constraints alone.
    pub(super) fn curl(&self, space: &mut Space, form: &OneForm) -> Vec<Id> {
        let applied = self.applied(space, form);
        let active = self.active(space, &applied);
        let directions = self.fields.iter().map(|(free, parts)| self.direction(space, Some(*free), parts));
        let mut along: Vec<Forward> = directions.collect();
        let mut curl = Vec::new();
        for (position, &i) in active.iter().enumerate() {
            for &j in &active[..position] {
                let [first, second] =
                    [(i, j), (j, i)].map(|(x, y)| along[x].of(&mut space.graph, applied[y]));
                curl.push(space.graph.sub(first, second));
            }
        }
        curl
    }

    /// Closes the fields under Lie brackets: X, Y, [X, Y], [X, [X, Y]] and so on, until nothing new comes or
    /// everything that the holonomic constraints leave is reached.
    pub(super) fn closure(&self, space: &mut Space) -> Option<Closure> {
        let active = self.active(space, &[]);
        let (free, mut parts): (Vec<usize>, Vec<Vec<Id>>) =
            active.iter().map(|&i| self.fields[i].clone()).unzip();
        let directions = free.into_iter().zip(&parts);
        let mut along: Vec<Forward> =
            directions.map(|(free, parts)| self.direction(space, Some(free), parts)).collect();
        let generators = along.len();
        let mut pending: VecDeque<(usize, usize)> =
            (0..generators).flat_map(|j| (0..j).map(move |i| (i, j))).collect();
        let (mut touched, mut evidence) = (BTreeSet::new(), self.evidence);
        while let Some((i, j)) = pending.pop_front() {
            if parts.len() == generators + self.independent() {
                break;
            }
            let first = rates(space, &mut along[i], &parts[j]);
            let second = rates(space, &mut along[j], &parts[i]);
            let pairs = first.into_iter().zip(second);
            let bracket: Vec<Id> = pairs.map(|(first, second)| space.graph.sub(first, second)).collect();
            space.settled()?;
            if bracket.iter().all(|&part| part == Id::ZERO) {
                continue;
            }
            touched.extend((0..bracket.len()).filter(|&p| bracket[p] != Id::ZERO));
            let known: Vec<&[Id]> = parts[generators..].iter().chain([&bracket]).map(Vec::as_slice).collect();
            let (rank, points) = space.rank(&known)?;
            if rank < known.len() {
                evidence = evidence.and(Evidence::Held(points));
                continue;
            }
            along.push(self.direction(space, None, &bracket));
            pending.extend((0..generators).map(|i| (i, parts.len())));
            parts.push(bracket);
        }
        let reached = parts.split_off(generators);
        // No more can be reached than the parts that any bracket has, nor than is left to reach.
        if touched.len() == reached.len() || reached.len() == self.independent() {
            evidence = self.evidence;
        }
        let seen = if reached.is_empty() { Evidence::Proved } else { space.seen() };
        Some(Closure { reached, evidence: evidence.and(seen) })
    }

    /// The fields that can have brackets: those that are more than a constant along their own variable, and
    /// those along a variable on which something depends.
    fn active(&self, space: &Space, values: &[Id]) -> Vec<usize> {
        let mut roots = values.to_vec();
        roots.extend(self.fields.iter().flat_map(|(_, parts)| parts));
        let occurring: BTreeSet<Symbol> = space.graph.symbols(&roots).collect();
        let is_active = |&i: &usize| {
            let (free, parts) = &self.fields[i];
            occurring.contains(&space.symbols[*free])
                || parts.iter().any(|&part| part != Id::ZERO)
                || values.get(i).is_some_and(|&value| value != Id::ZERO)
        };
        (0..self.fields.len()).filter(is_active).collect()
    }

    /// Along a free variable, if any, and the pivots.
    fn direction(&self, space: &Space, free: Option<usize>, parts: &[Id]) -> Forward {
        let along = self.pivots.iter().map(|&pivot| space.symbols[pivot]).zip(parts.iter().copied());
        Forward::along(along.chain(free.map(|free| (space.symbols[free], Id::ONE))))
    }
}

/// The rates of change of `parts` along a direction.
fn rates(space: &mut Space, along: &mut Forward, parts: &[Id]) -> Vec<Id> {
    parts.iter().map(|&part| along.of(&mut space.graph, part)).collect()
}

/// Forms that are being solved for the directions that they allow, each for a variable.
struct Elimination<'a> {
    space: &'a mut Space,
    rows: Vec<OneForm>,
    /// Row and column of each.
    pivots: Vec<(usize, usize)>,
}

impl Elimination<'_> {
    /// Gauss–Jordan elimination with pivots in the first `count` rows, none in time's column, as far as there are pivots.
    fn pivot_all(&mut self, count: usize) {
        while let Some((row, column)) = self.best_pivot(count) {
            let graph = &mut self.space.graph;
            let pivot = self.rows[row][column];
            let unit: OneForm = self.rows[row].iter().map(|&entry| graph.div(entry, pivot)).collect();
            self.rows[row] = unit.clone();
            for (_, entries) in self.rows.iter_mut().enumerate().filter(|&(other, _)| other != row) {
                let factor = entries[column];
                for (entry, &above) in entries.iter_mut().zip(&unit) {
                    let product = graph.mul(factor, above);
                    *entry = graph.sub(*entry, product);
                }
                entries[column] = Id::ZERO;
            }
            self.pivots.push((row, column));
        }
    }

    fn is_pivot(&self, row: usize) -> bool {
        self.pivots.iter().any(|&(used, _)| used == row)
    }

    /// A number where there is one, else what is not zero at the most points.
    fn best_pivot(&mut self, count: usize) -> Option<(usize, usize)> {
        let mut best = None;
        for row in (0..count).filter(|&row| !self.is_pivot(row)).collect::<Vec<_>>() {
            let entries = self.rows[row].iter().enumerate().take(self.space.symbols.len() - 1);
            for (column, &entry) in entries.filter(|&(_, &entry)| entry != Id::ZERO) {
                let values = self.space.values(&[entry]);
                let points = values.iter().filter(|value| value[0].excludes_zero()).count();
                let key = (self.space.graph.as_number(entry).is_some(), points);
                if points > 0 && best.is_none_or(|(known, _)| key > known) {
                    best = Some((key, (row, column)));
                }
            }
        }
        best.map(|(_, place)| place)
    }
}
