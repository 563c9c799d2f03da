//! Elimination of the element of a recursion, in the graph: zeros and ones in its matrices leave no operations.

use super::constraints::rate_of;
use std::ops::Range;

use super::gradient;
use super::recursion::Step;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id};
use crate::variables::Variable;

/// A matrix by rows.
pub(super) type Matrix = Vec<Vec<Id>>;

/// The mass matrix of an element, and the k of the `Variable::Term(k)`s that stand for what other elements and loops give.
pub(super) struct Elimination<'a> {
    /// M, its coordinates before what is carried.
    pub(super) mass: Matrix,
    pub(super) behind: &'a [usize],
    pub(super) reciprocals: &'a [usize],
    pub(super) forces: &'a [Vec<usize>; 2],
    pub(super) solved: &'a [Vec<usize>; 2],
    pub(super) before: &'a [usize],
    pub(super) kept: &'a [usize],
}

impl Elimination<'_> {
    /// Eliminates an element whose numbers have these values. `slots` are those of its parent, none of the first element, and its
    /// own coordinates.
    pub(super) fn step(
        &self,
        graph: &mut Graph,
        problem: &mut Problem,
        values: &[Id],
        slots: [&[usize]; 2],
    ) -> Step {
        let (q, c) = (self.forces[0].len(), values.len());
        let rates: Vec<Id> = values.iter().map(|&value| rate_of(graph, problem, value)).collect();
        let biases: Vec<Id> = rates.iter().map(|&rate| rate_of(graph, problem, rate)).collect();
        let mut slopes = slots.map(|slots| -> Matrix {
            values.iter().map(|&value| gradient(graph, value, slots, Variable::Coordinate)).collect()
        });
        if slots[0].is_empty() {
            slopes[0] = vec![vec![Id::ZERO; c]; c];
        }
        let all: Vec<Id> = slopes.iter().flatten().flatten().copied().chain(biases).collect();
        let mut kept = Vec::new();
        let mut named = all.into_iter().zip(self.kept).map(|(entry, &term)| {
            if graph.as_number(entry).is_some() {
                return entry;
            }
            kept.push((term, entry));
            graph.symbol(Variable::Term(term).symbol())
        });
        let mut matrix =
            |columns: usize| -> Matrix { (0..c).map(|_| named.by_ref().take(columns).collect()).collect() };
        let [g, j, gamma] = [c, q, 1].map(&mut matrix);
        let gamma = gamma.concat();
        let (pivots, solved, to_parent) = self.eliminated(graph, [&g, &j], &gamma);
        let accelerations = self.accelerations(graph, [&g, &j], &gamma);
        Step { values: values.to_vec(), rates, slopes, kept, to_parent, solved, pivots, accelerations }
    }

    /// Pivots of D with the entries that they are what is left of, D⁻¹U and D⁻¹g, and what the element adds to its parent.
    fn eliminated(
        &self,
        graph: &mut Graph,
        [g, j]: [&Matrix; 2],
        gamma: &[Id],
    ) -> (Vec<[Id; 2]>, [Vec<Id>; 2], Vec<Id>) {
        let c = gamma.len();
        let triangle = c * (c + 1) / 2;
        let behind = symbols(graph, self.behind);
        let [h_q, h_c] = self.forces.each_ref().map(|terms| symbols(graph, terms));
        let [m_qq, m_qc, m_cc] = self.blocks();
        let [a, whole] = [0, triangle].map(|from| plus(graph, &symmetric(&behind[from..], c), &m_cc));
        let [d, whole] = [&a, &whole].map(|a| inertia(graph, [a, j], [&m_qq, &m_qc]));
        let a_gamma = along(graph, &a, gamma);
        let w = sum(graph, &[&behind[2 * triangle..], &h_c], &a_gamma);
        let j_t = transposed(j);
        let (j_a, j_w) = (times(graph, &j_t, &a), along(graph, &j_t, &w));
        let (pull, m_qc_gamma) = (plus(graph, &j_a, &m_qc), along(graph, &m_qc, gamma));
        let u = times(graph, &pull, g);
        let mut sides = transposed(&u);
        sides.push(sum(graph, &[&j_w, &h_q], &m_qc_gamma));
        let reciprocals = symbols(graph, self.reciprocals);
        let pivots = solve(graph, d, &reciprocals, &mut sides);
        let d_g = sides.pop().unwrap_or_default();
        let d_u = transposed(&sides);
        let to_parent = to_parent(graph, [g, &a, &u], &w, (&d_u, &d_g));
        let pivots = pivots.into_iter().enumerate().map(|(i, pivot)| [pivot, whole[i][i]]).collect();
        (pivots, [d_u.concat(), d_g], to_parent)
    }

    /// M_qq, M_qc and M_cc.
    fn blocks(&self) -> [Matrix; 3] {
        let (q, n) = (self.forces[0].len(), self.mass.len());
        let part = |rows: Range<usize>, columns: Range<usize>| -> Matrix {
            self.mass[rows].iter().map(|row| row[columns.clone()].to_vec()).collect()
        };
        [part(0..q, 0..q), part(0..q, q..n), part(q..n, q..n)]
    }

    /// q̈ = D⁻¹g − D⁻¹U c̈₋ and c̈ = G c̈₋ + J q̈ + γ.
    fn accelerations(&self, graph: &mut Graph, [g, j]: [&Matrix; 2], gamma: &[Id]) -> [Vec<Id>; 2] {
        let [d_u, d_g] = self.solved.each_ref().map(|terms| symbols(graph, terms));
        let before: Vec<Id> = symbols(graph, self.before);
        let is_first = g.iter().flatten().all(|&entry| entry == Id::ZERO);
        let pulled: Vec<Id> = match is_first {
            true => vec![Id::ZERO; d_g.len()],
            false => along(graph, &d_u.chunks(before.len()).map(<[Id]>::to_vec).collect(), &before),
        };
        let own = sum(graph, &[&d_g], &pulled);
        let (carried, driven) = (along(graph, g, &before), along(graph, j, &own));
        let carried = sum(graph, &[&carried, &driven, gamma], &vec![Id::ZERO; gamma.len()]);
        [own, carried]
    }
}

/// JᵀAJ + JᵀM_cq + M_qc J + M_qq
fn inertia(graph: &mut Graph, [a, j]: [&Matrix; 2], [m_qq, m_qc]: [&Matrix; 2]) -> Matrix {
    let (a_j, m_qc_j) = (times(graph, a, j), times(graph, m_qc, j));
    let j_a_j = times(graph, &transposed(j), &a_j);
    let coupled = plus(graph, &m_qc_j, &transposed(&m_qc_j));
    let own = plus(graph, m_qq, &coupled);
    plus(graph, &j_a_j, &own)
}

/// P₋ = GᵀAG − UᵀD⁻¹U and GᵀAG by upper triangles, and p₋ = Gᵀw − UᵀD⁻¹g.
fn to_parent(graph: &mut Graph, [g, a, u]: [&Matrix; 3], w: &[Id], (d_u, d_g): (&Matrix, &[Id])) -> Vec<Id> {
    let (g_t, u_t, a_g) = (transposed(g), transposed(u), times(graph, a, g));
    let (g_a_g, lost) = (times(graph, &g_t, &a_g), times(graph, &u_t, d_u));
    let left: Matrix = g_a_g.iter().zip(&lost).map(|(whole, lost)| sum(graph, &[whole], lost)).collect();
    let (g_w, lost) = (along(graph, &g_t, w), along(graph, &u_t, d_g));
    [upper(&left), upper(&g_a_g), sum(graph, &[&g_w], &lost)].concat()
}

fn symbols(graph: &mut Graph, terms: &[usize]) -> Vec<Id> {
    terms.iter().map(|&term| graph.symbol(Variable::Term(term).symbol())).collect()
}

/// Solves D x = r by LDLᵀ for several r, in their place. Returns the pivots, in terms of the reciprocals of those before.
fn solve(graph: &mut Graph, d: Matrix, reciprocals: &[Id], sides: &mut [Vec<Id>]) -> Vec<Id> {
    let n = d.len();
    let (mut pivots, mut lower): (Vec<Id>, Matrix) = (Vec::new(), vec![vec![Id::ZERO; n]; n]);
    for j in 0..n {
        let weighted: Vec<Id> = (0..j).map(|k| graph.mul(lower[j][k], pivots[k])).collect();
        for i in j..n {
            let known = graph.dot(&lower[i][..j], &weighted);
            lower[i][j] = graph.sub(d[i][j], known);
        }
        pivots.push(std::mem::replace(&mut lower[j][j], Id::ONE));
        for row in &mut lower[j + 1..] {
            row[j] = graph.mul(row[j], reciprocals[j]);
        }
    }
    for x in sides {
        for i in 0..n {
            let known = graph.dot(&lower[i][..i], &x[..i]);
            x[i] = graph.sub(x[i], known);
        }
        for i in (0..n).rev() {
            let column: Vec<Id> = (i + 1..n).map(|k| lower[k][i]).collect();
            let known = graph.dot(&column, &x[i + 1..]);
            let own = graph.mul(x[i], reciprocals[i]);
            x[i] = graph.sub(own, known);
        }
    }
    pivots
}

fn plus(graph: &mut Graph, one: &Matrix, other: &Matrix) -> Matrix {
    let mut row =
        |(one, other): (&Vec<Id>, &Vec<Id>)| one.iter().zip(other).map(|(&x, &y)| graph.add(x, y)).collect();
    one.iter().zip(other).map(&mut row).collect()
}

/// Σ of vectors, less one.
fn sum(graph: &mut Graph, vectors: &[&[Id]], less: &[Id]) -> Vec<Id> {
    let entry = |(i, &less): (usize, &Id)| {
        let sum = graph.total(vectors.iter().map(|vector| vector[i]));
        graph.sub(sum, less)
    };
    less.iter().enumerate().map(entry).collect()
}

fn times(graph: &mut Graph, one: &Matrix, other: &Matrix) -> Matrix {
    let columns = transposed(other);
    one.iter().map(|row| columns.iter().map(|column| graph.dot(row, column)).collect()).collect()
}

fn along(graph: &mut Graph, matrix: &Matrix, x: &[Id]) -> Vec<Id> {
    matrix.iter().map(|row| graph.dot(row, x)).collect()
}

fn transposed(matrix: &Matrix) -> Matrix {
    let columns = matrix.first().map_or(0, Vec::len);
    (0..columns).map(|j| matrix.iter().map(|row| row[j]).collect()).collect()
}

/// Entries on the diagonal and above it, by rows.
fn upper(matrix: &Matrix) -> Vec<Id> {
    matrix.iter().enumerate().flat_map(|(i, row)| row[i..].to_vec()).collect()
}

/// The symmetric matrix with these entries on its diagonal and above it.
fn symmetric(upper: &[Id], n: usize) -> Matrix {
    let place = |i: usize, j: usize| i * n - i * (i + 1) / 2 + j;
    (0..n).map(|i| (0..n).map(|j| upper[place(i.min(j), i.max(j))]).collect()).collect()
}
