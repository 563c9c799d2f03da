//! The directions in (q, t) that constraints allow, and the directions reachable by their Lie brackets.

use std::collections::{BTreeSet, VecDeque};

use super::space::{OneForm, Space};
use crate::mechanics::Evidence;
use crate::symbolic::{Forward, Id, Symbol};

/// Vector fields that span the directions in which every form vanishes. Each field is 1 along one free variable and
/// has components along the pivots. Time is always free, because it increases along every motion.
pub(super) struct Distribution {
    pivots: Vec<usize>,
    /// Number of pivots that belong to holonomic constraints.
    holonomic: usize,
    fields: Vec<(usize, Vec<Id>)>,
    /// Evidence that the constraints without a pivot depend on the others.
    evidence: Evidence,
}

/// Directions that the allowed fields generate by their Lie brackets, in addition to themselves.
pub(super) struct Closure {
    /// Lie brackets independent of the fields and of each other, by their components along the pivots.
    pub(super) reached: Vec<Vec<Id>>,
    /// Evidence that there are no further directions.
    pub(super) evidence: Evidence,
}

impl Distribution {
    /// Solves the forms for the allowed directions; `None` if the constraints contradict each other or have no values.
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

    /// Number of independent constraints besides the holonomic ones.
    pub(super) fn independent(&self) -> usize {
        self.pivots.len() - self.holonomic
    }

    /// ω(X) for each field X.
    pub(super) fn applied(&self, space: &mut Space, form: &OneForm) -> Vec<Id> {
        let applied = self.fields.iter().map(|(free, parts)| {
            let along = self.along_pivots(space, form, parts);
            space.graph.add(form[*free], along)
        });
        applied.collect()
    }

    /// ω of a direction given by its components along the pivots.
    pub(super) fn along_pivots(&self, space: &mut Space, form: &OneForm, parts: &[Id]) -> Id {
        let along: Vec<Id> = self.pivots.iter().map(|&pivot| form[pivot]).collect();
        space.graph.dot(&along, parts)
    }

    /// dω(X, Y) = X(ω(Y)) − Y(ω(X)) for every two fields. The term ω([X, Y]) vanishes: the fields are coordinate
    /// fields on each Φ = constant, so that [X, Y] = 0. Valid for the holonomic constraints alone only.
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

    /// Closes the fields under Lie brackets: X, Y, [X, Y], [X, [X, Y]] and so on. Ends when no bracket is independent,
    /// or when all directions that the holonomic constraints allow are reached.
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
        // The number of reachable directions is bounded by the components that occur in any bracket, and by the number
        // of independent constraints.
        if touched.len() == reached.len() || reached.len() == self.independent() {
            evidence = self.evidence;
        }
        let seen = if reached.is_empty() { Evidence::Proved } else { space.seen() };
        Some(Closure { reached, evidence: evidence.and(seen) })
    }

    /// Indices of the fields that can have nonzero brackets: fields with components along the pivots, and fields along
    /// a variable on which an expression depends.
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

    /// Derivative along a direction: a free variable, if any, and components along the pivots.
    fn direction(&self, space: &Space, free: Option<usize>, parts: &[Id]) -> Forward {
        let along = self.pivots.iter().map(|&pivot| space.symbols[pivot]).zip(parts.iter().copied());
        Forward::along(along.chain(free.map(|free| (space.symbols[free], Id::ONE))))
    }
}

/// The rates of change of `parts` along a direction.
fn rates(space: &mut Space, along: &mut Forward, parts: &[Id]) -> Vec<Id> {
    parts.iter().map(|&part| along.of(&mut space.graph, part)).collect()
}

/// One-forms during Gauss–Jordan elimination, each solved for one variable.
struct Elimination<'a> {
    space: &'a mut Space,
    rows: Vec<OneForm>,
    /// Row and column of each pivot.
    pivots: Vec<(usize, usize)>,
}

impl Elimination<'_> {
    /// Gauss–Jordan elimination with pivots in the first `count` rows, never in the column of time, until no pivot is
    /// left.
    fn pivot_all(&mut self, count: usize) {
        while let Some((row, column)) = self.best_pivot(count) {
            let graph = &mut self.space.graph;
            let pivot = self.rows[row][column];
            let unit: OneForm = self.rows[row].iter().map(|&entry| graph.div(entry, pivot)).collect();
            self.rows[row] = unit.clone();
            for (_, entries) in self.rows.iter_mut().enumerate().filter(|&(other, _)| other != row) {
                let factor = entries[column];
                if factor == Id::ZERO {
                    continue;
                }
                for (entry, &above) in entries.iter_mut().zip(&unit).filter(|(_, above)| **above != Id::ZERO)
                {
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

    /// Returns the best pivot: a number if possible, else the entry that is nonzero at the most points.
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
