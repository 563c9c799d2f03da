//! The law of touching bodies as a complementarity problem, for friction of one velocity or in given directions: with two opposite
//! forces for each velocity (Stewart and Trinkle, *International Journal for Numerical Methods in Engineering* 39, 1996) its matrix is
//! copositive, and Lemke's method finds a solution for impacts.

use alloc::vec;
use alloc::vec::Vec;

use super::law::{ContactForces, Grip, Law, Rubbing, Touch};
use super::lemke::{Exchange, Exchanged};
use crate::number::Real;

/// An unknown of the problem, with the touch that it belongs to.
#[derive(Clone, Copy)]
enum Unknown {
    /// Force of a gap.
    Push(usize),
    /// Force of friction forwards.
    Forth(usize),
    /// Force of friction backwards.
    Back,
    /// Speed of sliding.
    Speed(usize),
    /// Force of a velocity that stays zero.
    Hold,
}

impl<T: Real> Law<'_, T> {
    /// Finds forces with which friction of two velocities does what its grip says: by Lemke's method or, where round-off leads it
    /// astray, by trying all that a few contacts may do. `None` for a few contacts thus says that there are none.
    pub(super) fn solve(&self) -> Option<ContactForces<T>> {
        let unknowns = self.unknowns();
        let (pushes, known) = self.pushes(&unknowns);
        let (zero, size) = (T::constant(0.0), unknowns.len());
        let times = |row: &[T], column: &dyn Fn(usize) -> T| {
            row.iter().enumerate().fold(zero, |sum, (k, &entry)| sum + entry * column(k))
        };
        let mut problem = Exchange {
            matrix: vec![vec![zero; size]; size],
            constant: vec![zero; size],
            noise: vec![zero; size],
            is_free: unknowns.iter().map(|(unknown, _)| matches!(unknown, Unknown::Hold)).collect(),
        };
        for (w, &(unknown, place)) in unknowns.iter().enumerate() {
            if let Unknown::Speed(touch) = unknown {
                self.reserve(touch, w, &unknowns, &mut problem);
                continue;
            }
            let sign = T::constant(if matches!(unknown, Unknown::Back) { -1.0 } else { 1.0 });
            for z in 0..size {
                problem.matrix[w][z] = sign * times(&self.matrix[place], &|row| pushes[row][z]);
            }
            problem.constant[w] = sign * (self.rates[place] + times(&self.matrix[place], &|row| known[row]));
            problem.noise[w] = self.noise[place];
            match unknown {
                Unknown::Forth(_) => problem.matrix[w][w + 2] = T::constant(1.0),
                Unknown::Back => problem.matrix[w][w + 1] = T::constant(1.0),
                _ => {}
            }
        }
        let solved = problem.solve();
        let is_found = solved.as_ref().is_some_and(|found| problem.is_solved(found, self.accuracy));
        let chosen =
            if is_found { None } else { problem.by_choices(&Self::choices(&unknowns), self.accuracy) };
        let solved = chosen.or(solved)?;
        let force = |row: usize| known[row] + times(&pushes[row], &|z| solved.z[z]);
        let forces: Vec<T> = (0..self.rates.len()).map(force).collect();
        let rate = |row: usize| self.rates[row] + times(&self.matrix[row], &|other| forces[other]);
        let rates = (0..forces.len()).map(rate).collect();
        Some(self.outcome(forces, rates, &unknowns, &solved))
    }

    /// The unknowns, each with the place of its row. The three of friction follow one another.
    fn unknowns(&self) -> Vec<(Unknown, usize)> {
        let mut unknowns = Vec::new();
        for (k, touch) in self.touches.iter().enumerate() {
            unknowns.extend(touch.gap.map(|gap| (Unknown::Push(k), gap)));
            let Some(Rubbing { place, count, grip, .. }) = touch.friction else { continue };
            match grip {
                Grip::Open => {
                    let three = [Unknown::Forth(k), Unknown::Back, Unknown::Speed(k)];
                    unknowns.extend(three.map(|unknown| (unknown, place)));
                }
                Grip::Sticks => unknowns.extend((0..count).map(|c| (Unknown::Hold, place + c))),
                Grip::Slides(_) | Grip::Idle => {}
            }
        }
        unknowns
    }

    /// What each contact may do, by the unknowns that may exceed zero: it opens, sticks with friction forwards or backwards, or slides
    /// against it.
    fn choices(unknowns: &[(Unknown, usize)]) -> Vec<Vec<Vec<usize>>> {
        let mut groups: Vec<Vec<Vec<usize>>> = Vec::new();
        let mut pressed = None;
        for (z, &(unknown, _)) in unknowns.iter().enumerate() {
            match unknown {
                Unknown::Hold => groups.push(vec![vec![z]]),
                Unknown::Push(k) => {
                    groups.push(vec![vec![], vec![z]]);
                    pressed = Some((k, z));
                }
                Unknown::Forth(k) => {
                    let push = pressed.filter(|&(of, _)| of == k).map(|(_, push)| push);
                    if push.is_some() {
                        groups.pop();
                    }
                    let with = |others: &[usize]| push.into_iter().chain(others.iter().copied()).collect();
                    let mut group: Vec<Vec<usize>> =
                        [&[z][..], &[z + 1], &[z, z + 2], &[z + 1, z + 2]].map(with).into();
                    group.extend(push.map(|_| vec![]));
                    groups.push(group);
                }
                Unknown::Back | Unknown::Speed(_) => {}
            }
        }
        groups
    }

    /// Forces of the rows: their multiples of the unknowns, and what does not depend on them, of dry friction and of the smallest
    /// forces of gaps.
    fn pushes(&self, unknowns: &[(Unknown, usize)]) -> (Vec<Vec<T>>, Vec<T>) {
        let (zero, one) = (T::constant(0.0), T::constant(1.0));
        let rows = self.rates.len();
        let (mut pushes, mut known) = (vec![vec![zero; unknowns.len()]; rows], vec![zero; rows]);
        for (z, &(unknown, place)) in unknowns.iter().enumerate() {
            match unknown {
                Unknown::Speed(_) => {}
                Unknown::Back => pushes[place][z] = -one,
                _ => pushes[place][z] = one,
            }
        }
        for (k, touch) in self.touches.iter().enumerate() {
            touch.gap.iter().for_each(|&gap| known[gap] = touch.least);
            let Some(Rubbing { place, count, grip: Grip::Slides(direction), bounds: [_, sliding] }) =
                touch.friction
            else {
                continue;
            };
            let against = direction.map(|component| sliding * component);
            let push =
                unknowns.iter().position(|(unknown, _)| matches!(unknown, Unknown::Push(of) if *of == k));
            for (component, &force) in against.iter().enumerate().take(count) {
                match push {
                    Some(push) => {
                        pushes[place + component][push] = -force;
                        known[place + component] = -force * touch.least;
                    }
                    None => known[place + component] = -force,
                }
            }
        }
        (pushes, known)
    }

    /// What is left of the limit, as the row of the speed of sliding.
    fn reserve(&self, k: usize, w: usize, unknowns: &[(Unknown, usize)], problem: &mut Exchange<T>) {
        let minus = T::constant(-1.0);
        (problem.matrix[w][w - 2], problem.matrix[w][w - 1]) = (minus, minus);
        let Touch { least, friction: Some(Rubbing { bounds: [limit, _], .. }), .. } = self.touches[k] else {
            return;
        };
        match unknowns.iter().position(|(unknown, _)| matches!(unknown, Unknown::Push(of) if *of == k)) {
            Some(push) => (problem.matrix[w][push], problem.constant[w]) = (limit, limit * least),
            None => problem.constant[w] = limit,
        }
    }

    fn outcome(
        &self,
        forces: Vec<T>,
        rates: Vec<T>,
        unknowns: &[(Unknown, usize)],
        solved: &Exchanged<T>,
    ) -> ContactForces<T> {
        let (one, zero) = (T::constant(1.0), T::constant(0.0));
        let mut pushes = vec![false; self.touches.len()];
        let mut grips: Vec<Option<Grip<T>>> =
            self.touches.iter().map(|touch| touch.friction.map(|friction| friction.grip)).collect();
        for (z, &(unknown, place)) in unknowns.iter().enumerate() {
            match unknown {
                Unknown::Push(k) => pushes[k] = solved.is_basic[z],
                Unknown::Forth(k) => {
                    grips[k] = Some(match solved.is_basic[z..z + 3] {
                        [true, false, true] => Grip::Slides([-one, zero]),
                        [false, true, true] => Grip::Slides([one, zero]),
                        [false, false, true] => {
                            let back = rates[place] < zero;
                            Grip::Slides([if back { -one } else { one }, zero])
                        }
                        [false, false, false] => Grip::Idle,
                        _ => Grip::Sticks,
                    });
                }
                Unknown::Back | Unknown::Speed(_) | Unknown::Hold => {}
            }
        }
        ContactForces { forces, rates, pushes, grips, motion: None }
    }
}
