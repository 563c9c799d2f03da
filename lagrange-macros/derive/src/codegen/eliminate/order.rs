//! Order in which the variables of a quadratic form are reduced. A variable is ready when no remaining definition
//! contains it. Among the ready ones the variable with the fewest neighbors goes first (minimum degree: George and
//! Liu, *SIAM Review* 31, 1989). A definition is substituted only if no free variable is ready.

use std::collections::BTreeSet;

/// Sparsity pattern of a form.
pub(super) struct Pattern {
    /// Nonzero entries of the matrix, by rows.
    pub(super) matrix: Vec<Vec<bool>>,
    /// Variables in the definition of each defined variable; the defined variables are the last ones.
    pub(super) definitions: Vec<Vec<usize>>,
    /// Variables that must precede each variable; empty if there are no such restrictions.
    pub(super) after: Vec<Vec<usize>>,
}

/// Returns the order, and its number of multiplications and additions.
pub(super) fn reduction_order(pattern: &Pattern) -> (Vec<usize>, usize) {
    let mut reduction = Reduction::new(pattern);
    while let Some(next) = reduction.next() {
        reduction.cost += match next.checked_sub(reduction.free) {
            Some(k) => reduction.put_in(next, &pattern.definitions[k]),
            None => reduction.eliminate(next),
        };
        reduction.order.push(next);
    }
    (reduction.order, reduction.cost)
}

struct Reduction<'p> {
    pattern: &'p Pattern,
    /// Number of free variables, which precede the defined ones.
    free: usize,
    neighbours: Vec<BTreeSet<usize>>,
    /// For each variable, the number of remaining definitions that contain it and of variables that must precede it.
    needed: Vec<usize>,
    left: BTreeSet<usize>,
    order: Vec<usize>,
    cost: usize,
}

impl<'p> Reduction<'p> {
    fn new(pattern: &'p Pattern) -> Self {
        let n = pattern.matrix.len();
        let entry = |i: usize, j: usize| pattern.matrix[i][j] || pattern.matrix[j][i];
        let mut needed = vec![0; n];
        pattern.definitions.iter().flatten().for_each(|&variable| needed[variable] += 1);
        pattern.after.iter().enumerate().for_each(|(variable, before)| needed[variable] += before.len());
        Self {
            pattern,
            free: n - pattern.definitions.len(),
            neighbours: (0..n).map(|i| (0..n).filter(|&j| j != i && entry(i, j)).collect()).collect(),
            needed,
            left: (0..n).collect(),
            order: Vec::with_capacity(n),
            cost: 0,
        }
    }

    /// Returns the next variable: a free one before a defined one, with the fewest neighbors.
    fn next(&self) -> Option<usize> {
        let ready = self.left.iter().copied().filter(|&variable| self.needed[variable] == 0);
        let rank = |variable: usize| match variable.checked_sub(self.free) {
            None => (false, self.neighbours[variable].len(), variable),
            Some(k) => (true, self.tied(variable, &self.pattern.definitions[k]), usize::MAX - variable),
        };
        ready.min_by_key(|&variable| rank(variable))
    }

    /// Number of variables that are neighbors of one another after the definition is substituted.
    fn tied(&self, variable: usize, definition: &[usize]) -> usize {
        let beside = &self.neighbours[variable];
        beside.len() + definition.iter().filter(|&i| !beside.contains(i)).count()
    }

    fn take(&mut self, variable: usize) -> BTreeSet<usize> {
        self.left.remove(&variable);
        let neighbours = std::mem::take(&mut self.neighbours[variable]);
        for &i in &neighbours {
            self.neighbours[i].remove(&variable);
        }
        neighbours
    }

    fn eliminate(&mut self, variable: usize) -> usize {
        let clique = self.take(variable);
        for &i in &clique {
            self.neighbours[i].extend(clique.iter().filter(|&&j| j != i));
        }
        for (later, before) in self.pattern.after.iter().enumerate() {
            self.needed[later] -= before.iter().filter(|&&i| i == variable).count();
        }
        clique.len() * (clique.len() + 2)
    }

    fn put_in(&mut self, variable: usize, definition: &[usize]) -> usize {
        let beside = self.take(variable);
        for &i in definition {
            self.needed[i] -= 1;
            for &j in beside.iter().chain(definition).filter(|&&j| j != i) {
                self.neighbours[i].insert(j);
                self.neighbours[j].insert(i);
            }
        }
        definition.len() * (2 * beside.len() + definition.len() + 5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(n: usize, occupied: impl Fn(usize, usize) -> bool) -> Pattern {
        let matrix = (0..n).map(|i| (0..n).map(|j| i == j || occupied(i, j)).collect()).collect();
        Pattern { matrix, definitions: Vec::new(), after: Vec::new() }
    }

    #[test]
    fn the_hub_of_an_arrow_goes_last_and_nothing_fills_in() {
        let (order, cost) = reduction_order(&matrix(6, |i, j| i == 0 || j == 0));
        assert!(order.iter().position(|&i| i == 0) >= Some(4), "{order:?}");
        assert_eq!(cost, 5 * 3);
    }

    #[test]
    fn a_band_costs_as_much_as_its_length() {
        let cost = |n| reduction_order(&matrix(n, |i, j| i.abs_diff(j) == 1)).1;
        assert_eq!((cost(5), cost(10), cost(20)), (4 * 3, 9 * 3, 19 * 3));
    }

    /// Chain: angles 0..n, and velocities n + i. The velocity of link i is the previous velocity plus the
    /// contribution of the angle.
    #[test]
    fn a_chain_goes_from_its_tip_to_its_root() {
        let n = 4;
        let matrix = (0..2 * n).map(|i| (0..2 * n).map(|j| i == j && i >= n).collect()).collect();
        let definitions = (0..n).map(|i| if i == 0 { vec![0] } else { vec![i, n + i - 1] }).collect();
        let (order, _) = reduction_order(&Pattern { matrix, definitions, after: Vec::new() });
        assert_eq!(order, [7, 3, 6, 2, 5, 1, 4, 0]);
    }
}
