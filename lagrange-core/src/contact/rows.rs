//! The rows of bodies that touch.

use alloc::vec::Vec;
use core::marker::PhantomData;

use super::Contacts;
use super::bodies::{Bodies, UNITS};
use super::kinetic::KineticFactor;
use super::span::RowSpan;
use super::states::LegStates;
use crate::cone::{dot, sqrt};
use crate::error::Error;
use crate::names::Names;
use crate::number::{Real, Scalar};
use crate::solution::solve::solve;
use crate::system::StateOf;
use crate::vector::{Array, Length, Vector, vector};

/// Rows W of gaps, velocities of friction and constraints, in coordinates x = Lᵀ q̇ with M = L Lᵀ, in which |x|² is twice the kinetic
/// energy: J = W L⁻ᵀ. Reactions r change the velocities by x = Jᵀ r.
pub(super) struct TouchingRows<L> {
    /// Index of each among the constraints: gaps, then velocities of friction, then constraints that are not of contacts.
    pub(super) all: Vec<usize>,
    /// Contacts that touch, in the order of their rows.
    pub(super) touching: Vec<usize>,
    /// Friction of these, and dry friction, each with the place of its first row.
    pub(super) frictions: Vec<(usize, usize)>,
    /// Number of rows of contacts and friction.
    pub(super) count: usize,
    /// J by rows, of n entries each.
    j: Vec<f64>,
    pub(super) n: usize,
    mass: KineticFactor,
    system: PhantomData<fn(&L)>,
}

impl<L: Contacts<Scalar: Real> + Clone> Bodies<L> {
    /// The rows of these contacts, of all friction that may act with them, and of all other constraints.
    pub(super) fn rows(&self, touching: Vec<usize>, state: &StateOf<L>) -> Result<TouchingRows<L>, Error> {
        let mut all: Vec<usize> = touching.iter().map(|&k| L::CONTACTS[k]).collect();
        let mut frictions = Vec::new();
        for (f, friction) in L::FRICTIONS.iter().enumerate() {
            if friction.contact.is_none_or(|k| touching.contains(&k)) {
                frictions.push((f, all.len()));
                all.extend(friction.rows());
            }
        }
        let count = all.len();
        let is_free =
            |a: &usize| !L::CONTACTS.contains(a) && !L::FRICTIONS.iter().any(|of| of.rows().contains(a));
        all.extend((0..<L::M>::COUNT).filter(is_free));
        let (j, mass) = self.kinetic(&all, count, state)?;
        let n = <L::N>::COUNT;
        Ok(TouchingRows { all, touching, frictions, count, j, n, mass, system: PhantomData })
    }

    /// Rows in the coordinates of kinetic energy. Coordinates without mass have constraints that move them: a least mass along these rows
    /// changes nothing, since they do not move.
    fn kinetic(
        &self,
        all: &[usize],
        count: usize,
        state: &StateOf<L>,
    ) -> Result<(Vec<f64>, KineticFactor), Error> {
        let n = <L::N>::COUNT;
        let (jacobian, of_constraints) =
            (self.closed.constraint_jacobian(state), self.open.constraint_jacobian(state));
        let entry = |place: usize, i: usize| match place < count {
            true => jacobian[(all[place], i)].to_f64(),
            false => of_constraints[(all[place], i)].to_f64(),
        };
        let mut j: Vec<f64> = (0..all.len())
            .flat_map(|place| (0..n).map(move |i| (place, i)))
            .map(|(place, i)| entry(place, i))
            .collect();
        let masses = self.open.mass_matrix(state);
        let mut mass: Vec<f64> =
            (0..n).flat_map(|i| (0..n).map(move |k| (i, k))).map(|(i, k)| masses[(i, k)].to_f64()).collect();
        let largest = (0..n).fold(0.0, |most, i| f64::max(most, mass[i * n + i].abs()));
        for row in j.chunks_exact(n.max(1)).skip(count) {
            let along = |i: usize| mass[i * n + i] / (row[i] * row[i]);
            let along = (0..n).map(along).filter(|along| *along > 0.0 && along.is_finite());
            let least = along.fold(f64::INFINITY, f64::min);
            let least = if least.is_finite() { least } else { largest };
            for (i, of) in row.iter().enumerate() {
                mass[i * n..][..n].iter_mut().zip(row).for_each(|(m, w)| *m += least * of * w);
            }
        }
        // The general solver says which coordinates have no mass.
        let Some(mass) = KineticFactor::of(mass, n) else {
            solve(&self.open, state)?;
            return Err(Error::Singular { coordinates: Names::default(), time: state.t.to_f64() });
        };
        j.chunks_exact_mut(n.max(1)).for_each(|row| mass.solve_lower(row));
        Ok((j, mass))
    }
}

impl<L: Contacts<Scalar: Real>> TouchingRows<L> {
    pub(super) fn row(&self, place: usize) -> &[f64] {
        &self.j[place * self.n..][..self.n]
    }

    /// By how much a reaction of 1 of one row changes the rate of another one.
    pub(super) fn response(&self, one: usize, other: usize) -> f64 {
        dot(self.row(one), self.row(other))
    }

    /// Change of the velocities q̇ by this one of x.
    pub(super) fn velocities(&self, x: &[f64]) -> Vector<L::Scalar, L::N> {
        let mut v = x.to_vec();
        self.mass.solve_upper(&mut v);
        vector(Array::from_fn(|i| L::Scalar::constant(v[i])))
    }

    /// What this reaction of a row changes the velocities q̇ by.
    pub(super) fn change(&self, place: usize, reaction: f64) -> Vector<L::Scalar, L::N> {
        let x: Vec<f64> = self.row(place).iter().map(|x| x * reaction).collect();
        self.velocities(&x)
    }

    /// Size of the terms of what reactions change a rate by.
    pub(super) fn size(&self, place: usize, reactions: &[f64]) -> f64 {
        let terms = reactions.iter().enumerate().filter(|(_, r)| **r != 0.0);
        terms.fold(0.0, |sum, (of, r)| sum + (self.response(place, of) * r).abs())
    }

    /// Round-off that the motion of all bodies leaves in rates: |J x| ≤ |J| |x|, in any coordinates. Those of a wedge and a block on it
    /// have no other size.
    pub(super) fn motion_noise(&self, state: &StateOf<L>) -> Vec<f64> {
        let v: Vec<f64> = (0..self.n).map(|i| state.v[i].to_f64()).collect();
        let speed = L::Scalar::EPSILON * UNITS * self.mass.speed(&v);
        (0..self.count).map(|place| speed * sqrt(self.response(place, place))).collect()
    }

    /// Rows that stay at rest: closed gaps, and velocities of friction that sticks.
    pub(super) fn active(&self, states: &LegStates) -> Vec<usize> {
        let gaps = (0..self.touching.len()).filter(|&place| states.is_closed(self.touching[place]));
        let sticks = self.frictions.iter().flat_map(|&(f, place)| {
            let is_kept =
                move |c: &usize| states.is_pressed::<L>(f) && states.frictions[f].friction.keeps(*c);
            (0..L::FRICTIONS[f].count).filter(is_kept).map(move |c| place + c)
        });
        gaps.chain(sticks).collect()
    }

    /// Place of the gap of a touching contact.
    pub(super) fn gap(&self, contact: usize) -> Option<usize> {
        self.touching.iter().position(|&k| k == contact)
    }

    /// The span of rows.
    pub(super) fn span(&self, places: impl IntoIterator<Item = usize>) -> RowSpan<'_, L> {
        RowSpan::of(self, places)
    }
}
