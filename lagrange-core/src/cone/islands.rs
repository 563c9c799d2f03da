//! Problems that fall apart: blocks that change no velocity in common are decided on their own.

use alloc::vec;
use alloc::vec::Vec;

use super::limits::WORK;
use super::{ConeDecision, ConeSearch, ConeSolver, Face, Limit, RowBlock, Set};

/// A problem as it is stated.
pub(crate) struct ConeProblem {
    pub(crate) n: usize,
    /// Rows J of length n.
    pub(crate) j: Vec<f64>,
    /// Rates without reactions, and their round-off.
    pub(crate) rates: Vec<f64>,
    pub(crate) noise: Vec<f64>,
    pub(crate) blocks: Vec<RowBlock>,
}

/// Blocks that share velocities, directly or by others, with their rows and these velocities.
struct Island {
    blocks: Vec<usize>,
    rows: Vec<usize>,
    columns: Vec<usize>,
}

/// The least number of the set to which `k` belongs.
fn root(parents: &mut [usize], mut k: usize) -> usize {
    while parents[k] != k {
        parents[k] = parents[parents[k]];
        k = parents[k];
    }
    k
}

fn join(parents: &mut [usize], one: usize, other: usize) {
    let [one, other] = [root(parents, one), root(parents, other)];
    parents[one.max(other)] = one.min(other);
}

impl ConeProblem {
    /// Finds reactions.
    pub(crate) fn decide(&self, search: ConeSearch) -> ConeDecision {
        let (m, zeros) = (self.rates.len(), |count: usize| vec![0.0; count]);
        let mut all = ConeDecision {
            is_found: true,
            residual: 0.0,
            reactions: zeros(m),
            rates: zeros(m),
            faces: vec![Face::Open; self.blocks.len()],
            change: zeros(self.n),
        };
        for island in self.islands() {
            let mut solver = self.solver(&island);
            let found = match search {
                ConeSearch::Law => solver.decide(search),
                ConeSearch::Near { faces, tolerance } => {
                    let faces: Vec<Face> = island.blocks.iter().map(|&k| faces[k]).collect();
                    solver.decide(ConeSearch::Near { faces: &faces, tolerance })
                }
            };
            all.is_found &= found.is_found;
            all.residual = all.residual.max(found.residual);
            for (k, &i) in island.rows.iter().enumerate() {
                (all.reactions[i], all.rates[i]) = (found.reactions[k], found.rates[k]);
            }
            island.blocks.iter().zip(found.faces).for_each(|(&k, face)| all.faces[k] = face);
            island.columns.iter().zip(found.change).for_each(|(&c, x)| all.change[c] = x);
        }
        all
    }

    /// Whether some blocks have no reactions, by trials of all faces.
    pub(crate) fn is_jammed(&self) -> bool {
        self.islands().iter().any(|island| {
            let slides = |&k: &usize| matches!(self.blocks[k].set, Set::Ray { .. });
            let mut solver = self.solver(island);
            island.blocks.iter().any(slides)
                && !solver.decide(ConeSearch::Law).is_found
                && solver.solutions(WORK / island.rows.len()).is_some_and(|solutions| solutions.is_empty())
        })
    }

    fn row(&self, i: usize) -> &[f64] {
        &self.j[i * self.n..][..self.n]
    }

    fn islands(&self) -> Vec<Island> {
        let mut parents: Vec<usize> = (0..self.blocks.len()).collect();
        let mut owners = vec![None; self.n];
        for (k, block) in self.blocks.iter().enumerate() {
            if let Set::Disc(Limit { gap: Some(gap), .. }) | Set::Ray { gap, .. } = block.set {
                join(&mut parents, gap, k);
            }
            for (owner, x) in block.rows().flat_map(|i| (0..self.n).zip(self.row(i))) {
                if *x != 0.0 {
                    join(&mut parents, *owners[owner].get_or_insert(k), k);
                }
            }
        }
        let (mut islands, mut places) = (Vec::<Island>::new(), vec![usize::MAX; self.blocks.len()]);
        for (k, block) in self.blocks.iter().enumerate() {
            let first = root(&mut parents, k);
            if first == k {
                places[k] = islands.len();
                islands.push(Island { blocks: vec![], rows: vec![], columns: vec![] });
            }
            let island = &mut islands[places[first]];
            island.blocks.push(k);
            island.rows.extend(block.rows());
        }
        for (column, owner) in owners.into_iter().enumerate() {
            let island = owner.map(|k| places[root(&mut parents, k)]);
            island.into_iter().for_each(|place| islands[place].columns.push(column));
        }
        islands
    }

    fn solver(&self, island: &Island) -> ConeSolver {
        let of = |all: &[f64]| island.rows.iter().map(|&i| all[i]).collect::<Vec<_>>();
        let entries = island.rows.iter().flat_map(|&i| island.columns.iter().map(move |&c| self.row(i)[c]));
        let place = |gap: usize| island.blocks.iter().position(|&k| k == gap).unwrap_or(usize::MAX);
        let mut first = 0;
        let block = |&k: &usize| {
            let RowBlock { count, set, .. } = self.blocks[k];
            let set = match set {
                Set::Disc(limit) => Set::Disc(Limit { gap: limit.gap.map(place), ..limit }),
                Set::Ray { force, gap } => Set::Ray { force, gap: place(gap) },
                set => set,
            };
            first += count;
            RowBlock { first: first - count, count, set }
        };
        let blocks = island.blocks.iter().map(block).collect();
        ConeSolver::new(island.columns.len(), entries.collect(), [of(&self.rates), of(&self.noise)], blocks)
    }
}
