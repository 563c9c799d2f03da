//! The Hamiltonian and Hamilton's equations in symbols, for display. Computations use the numerical Legendre transform
//! instead.

use num_traits::One;
use rustc_hash::FxHashMap;

use super::equations::Equations;
use super::euler_lagrange::generalized_forces;
use super::evidence::vanishes;
use super::legendre::PowerTerms;
use crate::resolve::{Limit, Problem};
use crate::symbolic::{Approximate, Graph, Id, Rational, Sample, rank};
use crate::variables::{Variable, has_velocity, nodes, symbols};

/// H(t, q, p) and its derivatives.
#[derive(Debug)]
pub(crate) struct Hamilton {
    pub(crate) hamiltonian: Id,
    /// The part of H with momenta, T if H is T + U, and −L at q̇ = 0
    pub(crate) energies: [Id; 2],
    /// q̇ = ∂H/∂p
    pub(crate) velocities: Vec<Id>,
    /// ṗ = −∂H/∂q + Q + Fᵀλ
    pub(crate) rates: Vec<Id>,
    /// Calls of `min`, `max` and `clamp` in forces, by momenta.
    pub(crate) limits: Vec<Limit>,
    /// Entries of M, row by row, kept as definitions: simplifying them shortens H.
    pub(crate) entries: Vec<Id>,
}

/// Reason why H is not written in symbols.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum NoHamiltonian {
    /// No closed form of the velocities by the momenta is known.
    NotSolved,
    /// M has no inverse, as with quaternions and massless coordinates.
    Singular,
    Long,
}

/// Largest number of coordinates: H of more would be too long to read.
pub(super) const COORDINATES: usize = 9;

/// Largest block of M that is inverted by Cramer's rule: the inverse of a block of four has hundreds of terms.
const BLOCK: usize = 3;

impl Hamilton {
    /// Derives H = p·q̇ − L. Each block of coordinates that M couples is solved by itself: by ½ (p − b)ᵀM⁻¹(p − b) where p
    /// = M q̇ + b, or by the transform of a [power](super::legendre). Returns the reason if H is not written.
    pub(super) fn derive(
        graph: &mut Graph,
        problem: &Problem,
        equations: &Equations,
    ) -> Result<Self, NoHamiltonian> {
        let n = problem.coordinates.len();
        if n > COORDINATES {
            return Err(NoHamiltonian::Long);
        }
        let mut parts = Parts { terms: Vec::new(), velocities: vec![Id::ZERO; n] };
        let (at_rest, mut still) = (nodes(graph, n, Variable::Velocity), problem.lagrangian);
        let mass: Vec<Vec<Id>> = equations
            .mass
            .iter()
            .map(|row| row.iter().map(|&entry| graph.defined(entry)).collect())
            .collect();
        for block in blocks(&mass) {
            let entries: Vec<Id> =
                block.iter().flat_map(|&i| block.iter().map(|&j| mass[i][j]).collect::<Vec<_>>()).collect();
            match has_velocity(graph, &entries) {
                false => parts.quadratic(graph, problem, (equations, &mass), &block)?,
                true => still = parts.power(graph, problem, &block, still)?,
            }
        }
        let at_rest = graph.without(still, &at_rest);
        let energies = [graph.sum(parts.terms), graph.neg(at_rest)];
        let hamiltonian = graph.total(energies);
        let by_momenta = by_momenta(problem, graph, &parts.velocities);
        let rates = rates(graph, problem, equations, hamiltonian, &by_momenta);
        let limits = problem.limits.iter().map(|limit| limit.map(|id| graph.replaced(id, &by_momenta)));
        let limits = limits.collect();
        let entries = mass.concat();
        let is_exact = graph.take_fault().is_none();
        let velocities = parts.velocities;
        is_exact
            .then_some(Self { hamiltonian, energies, velocities, rates, limits, entries })
            .ok_or(NoHamiltonian::Long)
    }
}

/// H as a sum of terms with coefficients, and the velocities, of the blocks solved so far.
struct Parts {
    terms: Vec<(Id, Rational)>,
    velocities: Vec<Id>,
}

impl Parts {
    /// Adds a block whose momenta are linear in the velocities.
    fn quadratic(
        &mut self,
        graph: &mut Graph,
        problem: &Problem,
        (equations, mass): (&Equations, &[Vec<Id>]),
        block: &[usize],
    ) -> Result<(), NoHamiltonian> {
        let at_rest = nodes(graph, mass.len(), Variable::Velocity);
        let rest: Vec<Id> = block.iter().map(|&i| graph.without(equations.momentum[i], &at_rest)).collect();
        let moving = moving(graph, block, &rest);
        let inverse = inverse_of_block(graph, problem, mass, block)?;
        for (&i, row) in block.iter().zip(&inverse) {
            self.velocities[i] = graph.dot(row, &moving);
        }
        let velocities: Vec<Id> = block.iter().map(|&i| self.velocities[i]).collect();
        let twice = graph.dot(&moving, &velocities);
        self.terms.push((twice, Rational::new(1, 2)));
        Ok(())
    }

    /// Adds a block whose velocities enter L by one power, and returns L without the power.
    fn power(
        &mut self,
        graph: &mut Graph,
        problem: &Problem,
        block: &[usize],
        lagrangian: Id,
    ) -> Result<Id, NoHamiltonian> {
        let split = PowerTerms::of(graph, lagrangian, block).ok_or(NoHamiltonian::NotSolved)?;
        let velocities: Vec<_> = block.iter().map(|&i| Variable::Velocity(i).symbol()).collect();
        let slopes = graph.gradient(split.others, &velocities);
        let moving = moving(graph, block, &slopes);
        let [power] = &split.powers[..] else { return Err(NoHamiltonian::NotSolved) };
        let (whole, velocities) = power.transform(graph, problem, (block, &moving))?;
        block.iter().zip(velocities).for_each(|(&i, velocity)| self.velocities[i] = velocity);
        self.terms.push((whole, Rational::one()));
        Ok(split.others)
    }
}

/// p − b of a block of coordinates.
fn moving(graph: &mut Graph, block: &[usize], rest: &[Id]) -> Vec<Id> {
    let momenta: Vec<Id> = block.iter().map(|&i| graph.symbol(Variable::Momentum(i).symbol())).collect();
    momenta.into_iter().zip(rest).map(|(momentum, &rest)| graph.sub(momentum, rest)).collect()
}

/// Replacements of the velocities, and of switches, which are on.
fn by_momenta(problem: &Problem, graph: &mut Graph, velocities: &[Id]) -> FxHashMap<Id, Id> {
    let speeds = nodes(graph, velocities.len(), Variable::Velocity);
    let switches = symbols(problem.parameters.switches.len(), Variable::Switch).into_iter();
    let on =
        switches.filter_map(|symbol| Some((graph.symbol(symbol), problem.parameters.switched_on(symbol)?)));
    on.chain(speeds.into_iter().zip(velocities.iter().copied())).collect()
}

fn rates(
    graph: &mut Graph,
    problem: &Problem,
    equations: &Equations,
    hamiltonian: Id,
    by_momenta: &FxHashMap<Id, Id>,
) -> Vec<Id> {
    let forces = generalized_forces(graph, problem);
    let slopes = graph.gradient(hamiltonian, &symbols(forces.len(), Variable::Coordinate));
    let rate = |(i, (slope, force)): (usize, (Id, Id))| {
        let force = graph.replaced(force, by_momenta);
        let applied = graph.sub(force, slope);
        graph.add(applied, equations.printed_force.get(i).copied().unwrap_or(Id::ZERO))
    };
    slopes.into_iter().zip(forces).enumerate().map(rate).collect()
}

/// Groups the coordinates into the diagonal blocks of M: the coordinates that off-diagonal entries couple.
fn blocks(mass: &[Vec<Id>]) -> Vec<Vec<usize>> {
    let mut blocks: Vec<Vec<usize>> = Vec::new();
    for (i, row) in mass.iter().enumerate() {
        let is_tied = |block: &Vec<usize>| block.iter().any(|&j| row[j] != Id::ZERO);
        let (tied, mut others): (Vec<_>, Vec<_>) = blocks.into_iter().partition(is_tied);
        let mut block = tied.concat();
        block.push(i);
        others.push(block);
        blocks = others;
    }
    blocks
}

/// The inverse of a symmetric matrix, block by block.
pub(super) fn inverse(
    graph: &mut Graph,
    problem: &Problem,
    matrix: &[Vec<Id>],
) -> Result<Vec<Vec<Id>>, NoHamiltonian> {
    let mut inverse = vec![vec![Id::ZERO; matrix.len()]; matrix.len()];
    for block in blocks(matrix) {
        for (&i, row) in block.iter().zip(inverse_of_block(graph, problem, matrix, &block)?) {
            block.iter().zip(row).for_each(|(&j, entry)| inverse[i][j] = entry);
        }
    }
    Ok(inverse)
}

/// The inverse of a block of M: adjugate over determinant.
pub(super) fn inverse_of_block(
    graph: &mut Graph,
    problem: &Problem,
    mass: &[Vec<Id>],
    block: &[usize],
) -> Result<Vec<Vec<Id>>, NoHamiltonian> {
    let matrix: Vec<Vec<Id>> = block.iter().map(|&i| block.iter().map(|&j| mass[i][j]).collect()).collect();
    if block.len() > BLOCK {
        let is_singular = is_singular(graph, problem, &matrix);
        return Err(if is_singular { NoHamiltonian::Singular } else { NoHamiltonian::Long });
    }
    let whole = determinant(graph, &matrix);
    if vanishes(graph, problem, whole).is_some() {
        return Err(NoHamiltonian::Singular);
    }
    let indices = 0..block.len();
    let rows = indices.clone().map(|i| {
        let entries = indices.clone().map(|j| {
            let minor = determinant(graph, &without(&matrix, j, i));
            let cofactor = if (i + j) % 2 == 0 { minor } else { graph.neg(minor) };
            graph.div(cofactor, whole)
        });
        entries.collect()
    });
    Ok(rows.collect())
}

/// True if the matrix has full rank at none of a few random points.
fn is_singular(graph: &Graph, problem: &Problem, matrix: &[Vec<Id>]) -> bool {
    const DRAWS: u64 = 16;
    const POINTS: usize = 3;
    let entries = matrix.concat();
    let values = (0..DRAWS).filter_map(|draw| {
        let drawn = |symbol, draw| problem.drawn(symbol, draw);
        let values = Sample::new(graph.symbols(&entries), draw, drawn).values(graph, &entries);
        values.iter().all(|entry| entry.value.is_finite()).then_some(values)
    });
    let values: Vec<_> = values.take(POINTS).collect();
    let is_regular = |values: &Vec<Approximate>| {
        rank(values.chunks(matrix.len()).map(<[_]>::to_vec).collect()) == matrix.len()
    };
    !values.is_empty() && !values.iter().any(is_regular)
}

fn without(matrix: &[Vec<Id>], row: usize, column: usize) -> Vec<Vec<Id>> {
    let kept = |of: usize| move |&(i, _): &(usize, &Id)| i != of;
    let rows = matrix.iter().enumerate().filter(|&(i, _)| i != row);
    rows.map(|(_, entries)| entries.iter().enumerate().filter(kept(column)).map(|(_, &id)| id).collect())
        .collect()
}

/// Determinant by expansion along the first row.
fn determinant(graph: &mut Graph, matrix: &[Vec<Id>]) -> Id {
    let Some(first) = matrix.first() else { return Id::ONE };
    let terms: Vec<(Id, Rational)> = first
        .iter()
        .enumerate()
        .map(|(j, &entry)| {
            let minor = determinant(graph, &without(matrix, 0, j));
            (graph.mul(entry, minor), Rational::from_integer(if j % 2 == 0 { 1 } else { -1 }))
        })
        .collect();
    graph.sum(terms)
}
