//! The energy function, its rate and the momenta by the velocities of bodies, in the place of formulas that are too long.
//!
//! Bodies in frames that move with time have ṙ = Σ q̇ ∂r/∂q + ∂r/∂t, and ω likewise, with the part Ω for q̇ = 0. Their kinetic
//! energy T adds Σ q̇ ∂T/∂q̇ − T = T − m ṙ·∂r/∂t − (I ω)·Ω to the energy function E (Goldstein, Poole and Safko, *Classical
//! Mechanics*, 1.4 and 2.7). In one frame that turns at Ω that is T − M·Ω, with the angular momentum M (Landau and Lifshitz,
//! *Mechanics*, § 39). Its rate −∂T/∂t is −m ṙ·∂ṙ/∂t − (I ω)·∂ω/∂t.

use super::formula::Formula;
use super::length::{READABLE, length};
use super::lines::{Equation, Line};
use super::page::Page;
use super::resultants::{BodyWithNames, Speed, component, dot, name, product};
use crate::mechanics::{Resultants, Turning};
use crate::resolve::Triple;
use crate::symbolic::{Id, Rational};
use crate::variables::Variable;

fn half(factors: Vec<Formula>) -> Formula {
    Formula::flat_product(Rational::new(1, 2).into(), factors, Vec::new())
}

/// ∂(vector)/∂t
fn by_time(vector: Formula) -> Formula {
    Formula::Partial { function: Box::new(vector), by: vec![name("t", 0)], arguments: Vec::new() }
}

fn is_time(variable: Variable) -> bool {
    variable == Variable::Time
}

/// Weights, and the other terms.
fn apart(weights: &Option<Vec<Formula>>, others: Option<Vec<Formula>>) -> Option<Vec<Formula>> {
    Some([weights.clone()?, others?].concat())
}

fn shortest<const N: usize>(all: [Option<Vec<Formula>>; N]) -> Option<Vec<Formula>> {
    all.into_iter().flatten().min_by_key(|terms| terms.iter().map(length).sum::<usize>())
}

impl Page<'_> {
    /// The energy function: T + U of all bodies, less what frames that move with time take off.
    pub(super) fn energy_by_bodies(&self) -> Option<Formula> {
        let (resultants, bodies) = self.named_bodies()?;
        let (mut terms, mut less) = (Vec::new(), Vec::new());
        for &named in &bodies {
            for [whole, imposed] in [self.moving(resultants, named)?, self.turning_of(resultants, named)] {
                terms.extend(whole);
                less.extend(imposed.map(Formula::negated));
            }
        }
        let weights = self.weights(&bodies, resultants.lift, |position, _| Some(position));
        let [with, without] = resultants.beside.energies.map(|part| self.term(part, Self::part_of_energy));
        let known = shortest([with, apart(&weights, without)]);
        terms.extend(known.or_else(|| apart(&weights, self.energy_of_potential(resultants)))?);
        Some(Formula::sum([terms, less].concat())).filter(|energy| length(energy) <= READABLE as usize)
    }

    /// ½ m ṙ·ṙ, and m ṙ·∂r/∂t to be taken off; only their difference if no coordinate moves the body.
    pub(super) fn moving(
        &self,
        resultants: &Resultants,
        named: BodyWithNames,
    ) -> Option<[Option<Formula>; 2]> {
        let BodyWithNames { body, own, .. } = named;
        if body.mass == Id::ZERO || !resultants.is_moving(self.graph, body) {
            return Some([None, None]);
        }
        let [position, velocity] = [0, 1].map(|dots| name(&own.position, dots));
        let mass = self.expression(body.mass).ok()?;
        let square = half(vec![mass.clone(), dot(velocity.clone(), velocity.clone())]);
        let has_coordinate = self.has(&body.position, |variable| matches!(variable, Variable::Coordinate(_)));
        Some(match self.has(&body.position, is_time) {
            true if !has_coordinate => [None, Some(square)],
            true => [Some(square), Some(product(vec![mass, dot(velocity, by_time(position))]))],
            false => [Some(square), None],
        })
    }

    /// ½ ω·(I ω), and (I ω)·Ω to be taken off; only their difference if no coordinate turns the body.
    pub(super) fn turning_of(&self, resultants: &Resultants, named: BodyWithNames) -> [Option<Formula>; 2] {
        if !named.body.has_inertia() || !resultants.is_turning(named.body.link) {
            return [None, None];
        }
        let rate = name(named.rate, 0);
        let spin = self.spin(named, rate.clone());
        let square = half(vec![dot(rate, spin.clone())]);
        match named.imposed {
            Some(imposed) if imposed == named.rate => [None, Some(square)],
            imposed => [Some(square), imposed.map(|imposed| dot(spin, name(imposed, 0)))],
        }
    }

    pub(super) fn has(&self, parts: &[Id], is_it: fn(Variable) -> bool) -> bool {
        self.graph.symbols(parts).any(|symbol| is_it(Variable::of(symbol)))
    }

    /// dE/dt = −∂L/∂t + Q·q̇ − λ·b of all bodies and of all else.
    pub(super) fn energy_rate_by_bodies(&self) -> Option<Formula> {
        let (resultants, bodies) = self.named_bodies()?;
        let mut terms = Vec::new();
        for &named in &bodies {
            let BodyWithNames { body, own, .. } = named;
            if body.mass != Id::ZERO && self.has(&body.position, is_time) {
                let velocity = name(&own.position, 1);
                let change = dot(velocity.clone(), by_time(velocity));
                terms.push(product(vec![self.expression(body.mass).ok()?, change]).negated());
            }
            if body.has_inertia() && resultants.turns_with_time(self.graph, body.link) {
                let rate = name(named.rate, 0);
                terms.push(dot(self.spin(named, rate.clone()), by_time(rate)).negated());
            }
        }
        let moved = |position, height| self.has(&[height], is_time).then(|| by_time(position));
        let weights = self.weights(&bodies, resultants.lift, moved);
        let changed = self.weights(&bodies, resultants.lift_rate, |position, _| Some(position));
        let weights = weights.zip(changed).map(|(weights, changed)| [weights, changed].concat());
        let [with, without] = resultants.beside.rates.map(|part| self.term(part, Self::expression));
        let by_arguments = self.rate_by_arguments(resultants);
        let known = shortest([with, apart(&weights, without), apart(&weights, by_arguments)]);
        terms.extend(known.or_else(|| {
            apart(&weights, self.slope_of_potential(resultants, Variable::Time).map(|slope| vec![slope]))
        })?);
        terms.extend(self.term(resultants.beside.power, Self::expression)?);
        Some(Formula::sum(terms)).filter(|rate| length(rate) <= READABLE as usize)
    }

    /// Terms m (−g) r of all bodies and axes, with `of` a component of r; `None` if one cannot be written.
    pub(super) fn weights(
        &self,
        bodies: &[BodyWithNames],
        lift: Triple,
        of: impl Fn(Formula, Id) -> Option<Formula>,
    ) -> Option<Vec<Formula>> {
        let mut terms = Vec::new();
        for BodyWithNames { body, own, .. } in bodies.iter().filter(|named| named.body.mass != Id::ZERO) {
            let axes = (0..3).filter(|&k| lift[k] != Id::ZERO && body.position[k] != Id::ZERO);
            for (k, lift) in axes.map(|k| (k, lift[k])) {
                let height = of(component(name(&own.position, 0), k), body.position[k]);
                let Some(height) = height else { continue };
                let [mass, lift] = [body.mass, lift].map(|factor| self.expression(factor).ok());
                terms.push(product(vec![mass?, lift?, height]));
            }
        }
        Some(terms)
    }

    /// A term of a sum, and none for zero; `None` if it is too long.
    fn term(&self, part: Id, write: fn(&Self, Id) -> Result<Formula, u64>) -> Option<Vec<Formula>> {
        if part == Id::ZERO { Some(Vec::new()) } else { Some(vec![write(self, part).ok()?]) }
    }

    /// The line of a momentum, with Σ m ṙ·∂ṙ/∂q̇ + (I ω)·∂ω/∂q̇ if that is shorter.
    pub(super) fn shorter_momentum(&self, line: Line, i: usize) -> Line {
        let Some(momentum) = self.momentum_by_bodies(i) else { return line };
        match &line.equation {
            Equation::Known(_, right) if length(right) <= length(&momentum) => line,
            _ => {
                let left = self.momentum_name(&self.problem.coordinates[i].text, 0);
                Line { label: None, equation: Equation::Known(left, momentum), ..line }
            }
        }
    }

    /// `None` for a quaternion, and if what the terms of L beside the bodies add is too long.
    fn momentum_by_bodies(&self, i: usize) -> Option<Formula> {
        let (resultants, bodies) = self.named_bodies()?;
        let is_of = |turning: &Turning| (turning.first..turning.first + 4).contains(&i);
        let is_of_quaternion = self.derived.turnings.all.iter().any(is_of);
        (!is_of_quaternion).then_some(())?;
        let mut terms = Vec::new();
        for named in bodies {
            let vectors = [name(&named.own.position, 1), self.spin(named, name(named.rate, 0))];
            let [moving, turning] = self.projected(resultants, named, Speed::Coordinate(i), vectors);
            let mass = self.expression(named.body.mass).ok()?;
            terms.extend(moving.map(|moving| product(vec![mass, moving])));
            terms.extend(turning);
        }
        if resultants.beside.momenta[i] != Id::ZERO {
            terms.push(self.given_momentum(resultants, i).ok()?);
        }
        Some(Formula::sum(terms))
    }
}
