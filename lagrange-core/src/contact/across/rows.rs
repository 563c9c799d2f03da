//! The rows of bodies that touch.

use alloc::rc::Rc;
use alloc::vec;
use alloc::vec::Vec;
use core::marker::PhantomData;

use super::Contacts;
use super::bodies::Bodies;
use super::kinetic::KineticFactor;
use super::span::RowSpan;
use super::states::LegStates;
use crate::error::Error;
use crate::names::Names;
use crate::number::limits::CANCELLED;
use crate::number::limits::HALF_THE_DIGITS;
use crate::number::{Real, Scalar};
use crate::numerics::bare::{dot, sqrt};
use crate::solution::solve::solve;
use crate::system::StateOf;
use crate::vector::{Array, StaticLength, Vector, vector};

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
    mass: Rc<KineticFactor>,
    system: PhantomData<fn(&L)>,
}

/// Rows of a matrix, as W of all constraints, by their entries that are not zero.
pub(super) struct SparseRows {
    /// Where the entries of each row are.
    places: Vec<[usize; 2]>,
    entries: Vec<(usize, f64)>,
}

impl SparseRows {
    fn zero(rows: usize) -> Self {
        Self { places: vec![[0; 2]; rows], entries: Vec::new() }
    }

    fn set(&mut self, row: usize, entries: impl Iterator<Item = (usize, f64)>) {
        let start = self.entries.len();
        self.entries.extend(entries.filter(|(_, w)| *w != 0.0));
        self.places[row] = [start, self.entries.len()];
    }

    pub(super) fn row(&self, a: usize) -> &[(usize, f64)] {
        let [start, end] = self.places[a];
        &self.entries[start..end]
    }

    /// All entries, by rows, with their columns.
    fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> + Clone + '_ {
        (0..self.places.len()).flat_map(|a| self.row(a).iter().map(move |&(i, w)| (a, i, w)))
    }

    /// W v of one row.
    pub(super) fn along(&self, a: usize, v: &[f64]) -> f64 {
        self.row(a).iter().fold(0.0, |sum, &(i, w)| sum + w * v[i])
    }
}

/// The mass matrix in coordinates of kinetic energy. Coordinates without mass have constraints that move them: a least mass along these
/// rows changes nothing but their reactions.
pub(super) struct Inertia {
    pub(super) factor: Rc<KineticFactor>,
    /// The mass along the row of each constraint.
    pub(super) along: Vec<f64>,
}

impl<L: Contacts<Scalar: Real> + Clone> Bodies<L> {
    /// The rows of these contacts, of all friction that may act with them, and of all other constraints.
    pub(super) fn rows(&self, touching: Vec<usize>, state: &StateOf<L>) -> Result<TouchingRows<L>, Error> {
        let jacobian = self.jacobian(state);
        let inertia = self.inertia(&self.mass(state), &[], (&jacobian, state))?;
        Ok(TouchingRows::of(touching, &jacobian, inertia.factor))
    }

    /// Rows of closed contacts and of friction that sticks, and of the constraints that hold with open ones.
    pub(super) fn jacobian(&self, state: &StateOf<L>) -> SparseRows {
        let (mut all, is_free) = (SparseRows::zero(<L::M>::COUNT), free::<L>());
        let mut numbers = Array::filled(L::Scalar::constant(0.0));
        for (group, rows) in L::GROUPS.iter().enumerate() {
            let system = if is_free[rows[0].constraint] { &self.open } else { &self.closed };
            if !system.may_hold(group) {
                continue;
            }
            system.rows(group, state, &mut numbers);
            for row in rows.iter() {
                let entries = row.jacobian(&numbers).iter().map(|w| w.to_f64());
                all.set(row.constraint, row.columns.iter().copied().zip(entries));
            }
        }
        all
    }

    /// The mass matrix.
    pub(super) fn mass(&self, state: &StateOf<L>) -> SparseRows {
        let (mut all, masses) = (SparseRows::zero(<L::N>::COUNT), self.open.masses(state));
        let mut entries = L::MASSES.iter().zip(&masses).peekable();
        while let Some(&(&[i, _], _)) = entries.peek() {
            let row = core::iter::from_fn(|| entries.next_if(|(place, _)| place[0] == i));
            all.set(i, row.map(|(&[_, k], mass)| (k, mass.to_f64())));
        }
        all
    }

    /// Decomposes the sum of a mass matrix and these entries, with a least mass along the rows of constraints.
    pub(super) fn inertia(
        &self,
        mass: &SparseRows,
        added: &[(usize, usize, f64)],
        (jacobian, state): (&SparseRows, &StateOf<L>),
    ) -> Result<Inertia, Error> {
        let n = <L::N>::COUNT;
        let mut diagonal = vec![0.0; n];
        let all = || mass.entries().chain(added.iter().copied());
        all().filter(|(i, k, _)| i == k).for_each(|(i, _, x)| diagonal[i] += x);
        let largest = diagonal.iter().fold(0.0, |most: f64, mass| most.max(mass.abs()));
        let (mut along, mut of_rows) = (vec![0.0; <L::M>::COUNT], Vec::new());
        for ((a, along), _) in along.iter_mut().enumerate().zip(free::<L>()).filter(|(_, is_free)| *is_free) {
            let row = jacobian.row(a);
            let most = row.iter().fold(0.0, |most, &(i, _)| f64::max(most, diagonal[i]));
            // A unit quaternion near (1, 0, 0, 0) has the square of its round-off as a mass.
            let masses = row.iter().map(|&(i, _)| diagonal[i]).filter(|mass| *mass > HALF_THE_DIGITS * most);
            let least = masses.fold(f64::INFINITY, f64::min);
            let least = if least.is_finite() { least } else { largest };
            *along = least / row.iter().map(|(_, w)| w * w).sum::<f64>();
            *along = if along.is_finite() { *along } else { 0.0 };
            let entry = |&(i, of): &(usize, f64), &(k, w): &(usize, f64)| (i, k, *along * of * w);
            of_rows.extend(
                row.iter().flat_map(|of| row.iter().map(move |w| (of, w))).map(|(of, w)| entry(of, w)),
            );
        }
        // The general solver says which coordinates have no mass.
        let Some(factor) = KineticFactor::of(n, all().chain(of_rows.iter().copied())) else {
            solve(&self.open, state)?;
            return Err(Error::Singular { coordinates: Names::default(), time: state.t.to_f64() });
        };
        Ok(Inertia { factor: Rc::new(factor), along })
    }
}

/// Which constraints are not of contacts nor of friction.
fn free<L: Contacts>() -> Vec<bool> {
    let mut is_free = vec![true; <L::M>::COUNT];
    L::CONTACTS.iter().for_each(|&a| is_free[a] = false);
    L::FRICTIONS.iter().for_each(|friction| is_free[friction.rows()].fill(false));
    is_free
}

impl<L: Contacts<Scalar: Real>> TouchingRows<L> {
    /// The rows of these contacts, of all friction that may act with them, and of all other constraints.
    pub(super) fn of(touching: Vec<usize>, jacobian: &SparseRows, mass: Rc<KineticFactor>) -> Self {
        let (mut touches, mut frictions) = (vec![false; L::CONTACTS.len()], Vec::new());
        touching.iter().for_each(|&k| touches[k] = true);
        let mut all: Vec<usize> = touching.iter().map(|&k| L::CONTACTS[k]).collect();
        for (f, friction) in L::FRICTIONS.iter().enumerate() {
            if friction.contact.is_none_or(|k| touches[k]) {
                frictions.push((f, all.len()));
                all.extend(friction.rows());
            }
        }
        let count = all.len();
        all.extend((0..).zip(free::<L>()).filter(|(_, is_free)| *is_free).map(|(a, _)| a));
        let n = <L::N>::COUNT;
        let mut j = vec![0.0; all.len() * n];
        for (&a, row) in all.iter().zip(j.chunks_exact_mut(n.max(1))) {
            jacobian.row(a).iter().for_each(|&(i, w)| row[i] = w);
            mass.solve_lower(row);
        }
        Self { all, touching, frictions, count, j, n, mass, system: PhantomData }
    }

    pub(super) fn row(&self, place: usize) -> &[f64] {
        &self.j[place * self.n..][..self.n]
    }

    /// What a change of x changes a rate by.
    pub(super) fn along(&self, place: usize, x: &[f64]) -> f64 {
        dot(self.row(place), x)
    }

    /// |J| of a row.
    pub(super) fn length(&self, place: usize) -> f64 {
        sqrt(self.response(place, place))
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

    /// The root of twice the kinetic energy of these velocities.
    pub(super) fn speed(&self, v: &Vector<L::Scalar, L::N>) -> f64 {
        let v: Vec<f64> = v.iter().map(|v| v.to_f64()).collect();
        self.mass.speed(&v)
    }

    /// Round-off that the motion of all bodies leaves in rates: |J x| ≤ |J| |x|, in any coordinates. Those of a wedge and a block on it
    /// have no other size.
    pub(super) fn motion_noise(&self, state: &StateOf<L>) -> Vec<f64> {
        let speed = L::Scalar::EPSILON * CANCELLED * self.speed(&state.v);
        (0..self.count).map(|place| speed * self.length(place)).collect()
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
