//! The law of bodies that touch as a complementarity problem. Friction along one velocity is the difference of two forces that are not
//! negative (Stewart and Trinkle, *International Journal for Numerical Methods in Engineering* 39, 1996); along two velocities it sticks
//! or slides in a given direction. The matrix is copositive, so that Lemke's method finds a solution for impacts.

use alloc::vec;
use alloc::vec::Vec;

use super::law::{ContactForces, Grip, Law, Rubbing, Touch};
use super::lemke::{Exchange, Exchanged};
use crate::number::Real;

/// An unknown of the problem; the number is that of its touch.
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
    /// Finds forces, with friction along two velocities that sticks or slides as its grip says: by Lemke's method or, where that finds
    /// none or is off by round-off, by trials of all that up to four contacts may do.
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
            if is_found { None } else { problem.by_choices(&self.choices(&unknowns), self.accuracy) };
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

    /// All that each contact and each friction may do. Each choice is the list of the unknowns that may exceed zero with it: none if the
    /// contact opens; its force and one of friction if it sticks; the speed as well if it slides.
    fn choices(&self, unknowns: &[(Unknown, usize)]) -> Vec<Vec<Vec<usize>>> {
        let has_open_friction = |k: usize| self.touches[k].friction.is_some_and(|of| of.grip == Grip::Open);
        let of = |(z, &(unknown, _)): (usize, &(Unknown, usize))| match unknown {
            Unknown::Hold => Some(vec![vec![z]]),
            Unknown::Push(k) => (!has_open_friction(k)).then(|| vec![vec![], vec![z]]),
            Unknown::Forth(k) => {
                let push = push_of(k, unknowns);
                let rubs = [&[z][..], &[z + 1], &[z, z + 2], &[z + 1, z + 2]];
                let with_push = rubs.map(|rubs| push.iter().chain(rubs).copied().collect());
                Some(with_push.into_iter().chain(push.map(|_| vec![])).collect())
            }
            Unknown::Back | Unknown::Speed(_) => None,
        };
        unknowns.iter().enumerate().filter_map(of).collect()
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
            let push = push_of(k, unknowns);
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
        match push_of(k, unknowns) {
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

/// Place of the force of the gap of a touch among the unknowns; `None` for dry friction.
fn push_of(touch: usize, unknowns: &[(Unknown, usize)]) -> Option<usize> {
    unknowns.iter().position(|(unknown, _)| matches!(unknown, Unknown::Push(of) if *of == touch))
}
