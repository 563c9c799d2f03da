//! Kinetic terms that are not quadratic in the velocities, but whose Legendre transform is known in closed form.
//!
//! A term s X^ε depends on the velocities through X = a + g·q̇ + q̇ᵀB q̇ alone. With u = q̇ + ½B⁻¹g, and π the momentum
//! without the parts that other terms contribute, X = c + uᵀB u and π = 2 ε s X^(ε−1) B u. So P = πᵀB⁻¹π tells X, and the
//! transform is π·q̇ − s X^ε = T(P) − ½ π·B⁻¹g, with
//!
//! - T = −s √(c (1 − P/s²)) for a root, ε = ½: √(m²c⁴ + p²c²) of a relativistic particle, where s = −m c² and P = −p²c²;
//! - T = (2ε − 1) s (√P/(2 ε s))^(2ε/(2ε − 1)) for a power, c = 0.

use num_traits::One;

use super::evidence::vanishes;
use super::hamilton::{NoHamiltonian, inverse_of_block};
use crate::resolve::Problem;
use crate::symbolic::{Function, Graph, Id, Node, Rational, Sample, Symbol, times};
use crate::variables::{Variable, has_velocity, nodes, symbols};

/// L = Σ s X^ε + linear(q̇).
pub(super) struct PowerTerms {
    pub(super) powers: Vec<PowerTerm>,
    /// Sum of the terms that are at most linear in the velocities of the powers.
    pub(super) others: Id,
}

/// A term s X^ε of the Lagrangian.
pub(super) struct PowerTerm {
    scale: Id,
    base: Id,
    exponent: Id,
}

impl PowerTerms {
    /// Splits off the terms of L that are nonlinear in the velocities of the coordinates `block`; `None` if one of them
    /// is no power.
    pub(super) fn of(graph: &mut Graph, lagrangian: Id, block: &[usize]) -> Option<Self> {
        let velocities: Vec<_> = block.iter().map(|&i| Variable::Velocity(i).symbol()).collect();
        let (mut powers, mut others) = (Vec::new(), Vec::new());
        for (coefficient, term) in terms(graph, lagrangian)? {
            let slopes = graph.gradient(term, &velocities);
            if slopes.iter().any(|&slope| has_velocity(graph, &[slope])) {
                let scale = graph.number(coefficient);
                powers.push(PowerTerm { scale, base: term, exponent: Id::ONE }.reduced(graph)?);
            } else {
                others.push((term, coefficient));
            }
        }
        let others = graph.sum(others);
        Some(Self { powers, others })
    }
}

/// Terms of a sum, with definitions that depend on the velocities written out.
fn terms(graph: &Graph, root: Id) -> Option<Vec<(Rational, Id)>> {
    const LIMIT: usize = 200;
    let (mut terms, mut pending) = (Vec::new(), vec![(Rational::one(), root)]);
    while let Some((coefficient, id)) = pending.pop() {
        (terms.len() + pending.len() < LIMIT).then_some(())?;
        match graph.node(id) {
            Node::Sum(parts) => {
                for &(part, c) in parts {
                    pending.push((times(coefficient, c)?, part));
                }
            }
            Node::Defined(inner) if has_velocity(graph, &[id]) => pending.push((coefficient, *inner)),
            _ => terms.push((coefficient, id)),
        }
    }
    Some(terms)
}

impl PowerTerm {
    /// The same term with a base that is a sum or a symbol.
    fn reduced(self, graph: &mut Graph) -> Option<Self> {
        let Self { scale, base, exponent } = self;
        match graph.node(base).clone() {
            Node::Defined(inner) => Self { base: inner, ..self }.reduced(graph),
            Node::Power(base, inner) => {
                let exponent = graph.mul(exponent, inner);
                Self { scale, base, exponent }.reduced(graph)
            }
            Node::Function(Function::Abs, inner) => {
                let half = graph.number(Rational::new_raw(1, 2));
                let (base, exponent) = (graph.square(inner), graph.mul(exponent, half));
                Some(Self { scale, base, exponent })
            }
            Node::Product(factors) => {
                let (moving, still): (Vec<_>, Vec<_>) =
                    factors.iter().copied().partition(|&(factor, _)| has_velocity(graph, &[factor]));
                let [(base, inner)] = moving[..] else { return None };
                let still = graph.product(still);
                let still = graph.power(still, exponent);
                let scale = graph.mul(scale, still);
                let is_even = inner.is_integer() && inner.numer() % 2 == 0;
                // An even power of a velocity is a power of its square.
                if is_even && is_linear(graph, base) {
                    let half = graph.number(inner / Rational::from_integer(2));
                    let (base, exponent) = (graph.square(base), graph.mul(exponent, half));
                    return Some(Self { scale, base, exponent });
                }
                // (X²)^½ is |X|, and not X.
                (!is_even || exponent == Id::ONE).then_some(())?;
                let exponent = graph.sum([(exponent, inner)]);
                Self { scale, base, exponent }.reduced(graph)
            }
            Node::Sum(_) => Some(self),
            _ => None,
        }
    }

    /// Legendre transform of the term and its velocities, as functions of the momenta `moving` of the coordinates `block`.
    pub(super) fn transform(
        &self,
        graph: &mut Graph,
        problem: &Problem,
        (block, moving): (&[usize], &[Id]),
    ) -> Result<(Id, Vec<Id>), NoHamiltonian> {
        let n = problem.coordinates.len();
        let at_rest = nodes(graph, n, Variable::Velocity);
        let slopes = graph.gradient(self.base, &symbols(n, Variable::Velocity));
        let mut form = vec![vec![Id::ZERO; n]; n];
        for &i in block {
            let row = graph.gradient(slopes[i], &symbols(n, Variable::Velocity));
            if has_velocity(graph, &row) {
                return Err(NoHamiltonian::NotSolved);
            }
            form[i] = row.into_iter().map(|entry| graph.sum([(entry, Rational::new_raw(1, 2))])).collect();
        }
        let slopes: Vec<Id> = block.iter().map(|&i| graph.without(slopes[i], &at_rest)).collect();
        let inverse = inverse_of_block(graph, problem, &form, block).map_err(|_| NoHamiltonian::NotSolved)?;
        let square = quadratic(graph, &inverse, moving);
        let shift: Vec<Id> = inverse.iter().map(|row| graph.dot(row, &slopes)).collect();
        let [along, own] = [moving, &slopes].map(|side| graph.dot(side, &shift));
        let rest = graph.without(self.base, &at_rest);
        let rest = graph.sum([(rest, Rational::one()), (own, Rational::new_raw(-1, 4))]);
        let momenta: Vec<_> = block.iter().map(|&i| Variable::Momentum(i).symbol()).collect();
        let (whole, velocities) = match graph.as_number(self.exponent) {
            Some(exponent) if exponent == Rational::new_raw(1, 2) => {
                let whole = self.of_root(graph, problem, rest, square)?;
                (whole, graph.gradient(whole, &momenta))
            }
            _ if vanishes(graph, problem, rest).is_some() => {
                let (whole, speed) = self.of_power(graph, problem, (square, moving))?;
                let along = inverse.iter().map(|row| graph.dot(row, moving)).collect::<Vec<_>>();
                (whole, along.into_iter().map(|along| graph.mul(along, speed)).collect())
            }
            _ => return Err(NoHamiltonian::NotSolved),
        };
        let shifted = |graph: &mut Graph, whole, along| {
            graph.sum([(whole, Rational::one()), (along, Rational::new_raw(-1, 2))])
        };
        let velocities = velocities.into_iter().zip(shift).map(|(one, other)| shifted(graph, one, other));
        let velocities = velocities.collect();
        Ok((shifted(graph, whole, along), velocities))
    }

    fn of_root(
        &self,
        graph: &mut Graph,
        problem: &Problem,
        rest: Id,
        square: Id,
    ) -> Result<Id, NoHamiltonian> {
        if vanishes(graph, problem, rest).is_some() {
            return Err(NoHamiltonian::Singular);
        }
        if sign(graph, problem, rest) != Some(1) {
            return Err(NoHamiltonian::NotSolved);
        }
        let scaled = graph.square(self.scale);
        match sign(graph, problem, self.scale) {
            Some(sign) => {
                let (squared, moving) = (graph.mul(rest, scaled), graph.mul(rest, square));
                let inside = graph.sub(squared, moving);
                let root = graph.sqrt(inside);
                Ok(if sign < 0 { root } else { graph.neg(root) })
            }
            None => {
                let ratio = graph.div(square, scaled);
                let inside = graph.sub(Id::ONE, ratio);
                let inside = graph.mul(rest, inside);
                let root = graph.sqrt(inside);
                let product = graph.mul(self.scale, root);
                Ok(graph.neg(product))
            }
        }
    }

    /// The transform T, and the factor of B⁻¹π in the velocities, (√P/(2 ε s))^(1/(2ε − 1))/√P.
    fn of_power(
        &self,
        graph: &mut Graph,
        problem: &Problem,
        (square, moving): (Id, &[Id]),
    ) -> Result<(Id, Id), NoHamiltonian> {
        let degree = graph.sum([(self.exponent, Rational::from_integer(2))]);
        let less = graph.sub(degree, Id::ONE);
        if vanishes(graph, problem, less).is_some() {
            return Err(NoHamiltonian::Singular);
        }
        let slope = graph.mul(degree, self.scale);
        if [slope, square].iter().any(|&id| sign(graph, problem, id) != Some(1)) {
            return Err(NoHamiltonian::NotSolved);
        }
        let size = match moving {
            [single] => {
                let squared = graph.square(*single);
                let ratio = graph.div(square, squared);
                let (size, factor) = (graph.function(Function::Abs, *single), graph.sqrt(ratio));
                graph.mul(size, factor)
            }
            _ => graph.sqrt(square),
        };
        let ratio = graph.div(size, slope);
        let [whole, speed] = [degree, Id::ONE].map(|above| {
            let exponent = graph.div(above, less);
            graph.power(ratio, exponent)
        });
        let factors = [less, self.scale, whole].map(|factor| (factor, Rational::one()));
        Ok((graph.product(factors), graph.div(speed, size)))
    }
}

/// True if the slopes of an expression do not depend on the velocities.
fn is_linear(graph: &mut Graph, id: Id) -> bool {
    let velocities: Vec<_> = graph.symbols(&[id]).filter(|&symbol| is_velocity(symbol)).collect();
    let slopes = graph.gradient(id, &velocities);
    !has_velocity(graph, &slopes)
}

fn is_velocity(symbol: Symbol) -> bool {
    matches!(Variable::of(symbol), Variable::Velocity(_))
}

/// πᵀB⁻¹π. If B is diagonal, with the first entry of B⁻¹ taken out, as in c² (p_x² + p_y²).
fn quadratic(graph: &mut Graph, inverse: &[Vec<Id>], moving: &[Id]) -> Id {
    let is_diagonal = inverse
        .iter()
        .enumerate()
        .all(|(i, row)| row.iter().enumerate().all(|(j, &x)| i == j || x == Id::ZERO));
    if !is_diagonal {
        let velocities: Vec<Id> = inverse.iter().map(|row| graph.dot(row, moving)).collect();
        return graph.dot(moving, &velocities);
    }
    let first = inverse[0][0];
    let squares = moving.iter().enumerate().map(|(i, &momentum)| {
        let (square, ratio) = (graph.square(momentum), graph.div(inverse[i][i], first));
        graph.mul(ratio, square)
    });
    let squares: Vec<Id> = squares.collect();
    let sum = graph.total(squares);
    graph.mul(first, sum)
}

/// Sign of an expression, if it is the same at random points, where parameters are in their ranges.
fn sign(graph: &Graph, problem: &Problem, id: Id) -> Option<i32> {
    const DRAWS: u64 = 16;
    let values = (0..DRAWS).map(|draw| {
        let drawn = |symbol, draw| problem.drawn(symbol, draw);
        Sample::new(graph.symbols(&[id]), draw, drawn).values(graph, &[id])[0].value
    });
    let signs: Vec<i32> = values.map(|value| i32::from(value > 0.0) - i32::from(value < 0.0)).collect();
    signs.iter().all(|sign| *sign == signs[0] && *sign != 0).then(|| signs[0])
}
