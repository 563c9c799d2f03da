//! Laws of gaps and Coulomb's law of friction for bodies that touch, as one complementarity problem: for impulses and
//! velocities, or for forces and accelerations (Pfeiffer and Glocker, *Multibody Dynamics with Unilateral Contacts*, 1996,
//! chapters 5 and 8).

use alloc::vec::Vec;

use super::cones::length;
use super::enumeration::TRIED;
use crate::number::{Real, Scalar, larger};

/// Largest number of corrections of the directions in which bodies slide, and of damped ones after those. For one contact a few are
/// usual. Where a force just beyond its limit gives a small acceleration, whose direction changes much with that of the force, corrections
/// do not converge unless they are damped.
const CORRECTIONS: usize = 200;

/// Change of a direction, in units of round-off, below which it counts as none.
const STEADY: f64 = 16.0;

/// What friction does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Grip<T> {
    /// The force of one velocity is to be decided: it keeps the velocity at zero within its limit, or slides.
    Open,
    /// The velocity stays zero without a force.
    Idle,
    /// The velocities stay zero, whatever forces it takes.
    Sticks,
    /// The force acts against this direction, of length 1.
    Slides([T; 2]),
}

/// Friction between bodies that touch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rubbing<T> {
    /// Place of its first velocity among the rows.
    pub(super) place: usize,
    /// Number of its velocities.
    pub(super) count: usize,
    pub(super) grip: Grip<T>,
    /// Limit of sticking, and force of sliding; as multiples of the force of the contact if there is one.
    pub(super) bounds: [T; 2],
}

/// A contact, dry friction, or a contact with friction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch<T> {
    /// Place of its gap among the rows.
    pub(super) gap: Option<usize>,
    /// Smallest force of the gap: it has a larger one only while its rate is zero.
    pub(super) least: T,
    pub(super) friction: Option<Rubbing<T>>,
}

/// Rows W of gaps and velocities of friction: G = W K⁻¹ Wᵀ, and the rates that they have without forces.
#[derive(Clone)]
pub(super) struct Law<'a, T> {
    pub(super) matrix: &'a [Vec<T>],
    pub(super) rates: Vec<T>,
    /// Round-off of each rate.
    pub(super) noise: Vec<T>,
    pub(super) touches: Vec<Touch<T>>,
    /// How far forces may be off the law, as a part of the terms of each rate.
    pub(super) accuracy: f64,
}

/// What the law gives.
#[derive(Clone)]
pub(super) struct ContactForces<T> {
    /// Force or impulse of each row.
    pub(super) forces: Vec<T>,
    /// Rate of each row with these forces.
    pub(super) rates: Vec<T>,
    /// Whether the gap of each touch stays closed.
    pub(super) pushes: Vec<bool>,
    /// What the friction of each touch does: it sticks or slides.
    pub(super) grips: Vec<Option<Grip<T>>>,
    /// Velocities of the rows, in some unit, with which bodies begin to slide whose forces have reached their limits together.
    pub(super) motion: Option<Vec<T>>,
}

/// Why no forces were found.
#[derive(Clone, Copy, Debug)]
pub(super) enum NoForces {
    /// None satisfy the laws.
    Jammed,
    /// The directions of sliding do not come to rest, or the forces found are off their law.
    Undecided,
}

impl<T: Real> Law<'_, T> {
    /// Finds forces that satisfy the law, also for friction of two velocities: it sticks if forces within its limit keep the
    /// bodies together, and else slides in the direction that its forces lead to. All forces are compared with the law
    /// ([`obeys`](Self::obeys)), by whatever method they were found.
    pub(super) fn decide(&self) -> Result<ContactForces<T>, NoForces> {
        let found = if self.is_shared() { self.shared() } else { self.unshared() };
        let mut forces = found.map_err(|why| if self.may_jam() { why } else { NoForces::Undecided })?;
        self.close_idle(&mut forces);
        Ok(forces)
    }

    /// Whether a failed search may mean Painlevé's paradox. It means nothing where no friction slides yet, since forces then exist (Stewart
    /// and Trinkle 1996); for more than [`TRIED`] contacts, since not everything that they may do is tried; and for gaps whose rows depend
    /// on one another, since equations with dependent rows have no single solution, and trials of them are passed over.
    fn may_jam(&self) -> bool {
        let slides = |touch: &Touch<T>| matches!(touch.friction, Some(Rubbing { grip: Grip::Slides(_), .. }));
        let (problem, mut gaps) = (self.problem(), Vec::new());
        let is_independent = |gap: usize| {
            let is_independent = !problem.depends(gap, &gaps);
            gaps.push(gap);
            is_independent
        };
        self.touches.len() <= TRIED
            && self.touches.iter().any(slides)
            && self.touches.iter().filter_map(|touch| touch.gap).all(is_independent)
    }

    fn unshared(&self) -> Result<ContactForces<T>, NoForces> {
        self.in_directions().or_else(|why| self.by_cones().ok_or(why))
    }

    /// Finds forces by corrections of the directions in which bodies slide.
    pub(super) fn in_directions(&self) -> Result<ContactForces<T>, NoForces> {
        let mut law = self.clone();
        let is_planar = |touch: &Touch<T>| {
            touch.friction.is_some_and(|friction| friction.count == 2 && friction.grip == Grip::Sticks)
        };
        let planar: Vec<usize> = (0..self.touches.len()).filter(|&k| is_planar(&self.touches[k])).collect();
        for number in 0..2 * CORRECTIONS {
            let is_damped = number >= CORRECTIONS;
            let outcome = law.solve().ok_or(NoForces::Jammed)?;
            let correction = |&k: &usize| Some((k, law.correction(k, is_damped, &outcome)?));
            let corrections: Vec<(usize, Grip<T>)> = planar.iter().filter_map(correction).collect();
            if corrections.is_empty() {
                return if self.obeys(&outcome) { Ok(outcome) } else { Err(NoForces::Undecided) };
            }
            for (k, grip) in corrections {
                law.touches[k].friction.iter_mut().for_each(|friction| friction.grip = grip);
            }
        }
        Err(NoForces::Undecided)
    }

    /// Correction of friction along two velocities whose law is not satisfied. Bodies that slide do so along the velocity u that they
    /// get; a damped correction takes the direction of u − g T, with the force T and the response g.
    fn correction(&self, k: usize, is_damped: bool, outcome: &ContactForces<T>) -> Option<Grip<T>> {
        let Touch { gap, friction, .. } = self.touches[k];
        let Rubbing { place, grip, bounds: [limit, _], .. } = friction?;
        let press = gap.map_or(T::constant(1.0), |gap| outcome.forces[gap]);
        let unit = T::constant(T::EPSILON * STEADY);
        let of = |all: &[T]| [all[place], all[place + 1]];
        match grip {
            Grip::Sticks => {
                let [x, y] = of(&outcome.forces);
                let size = length([x, y]);
                (size > limit * press * (T::constant(1.0) + unit))
                    .then(|| Grip::Slides([-x / size, -y / size]))
            }
            Grip::Slides(known) => {
                let [x, y] = of(&outcome.rates);
                if length([x, y]) <= larger(self.noise[place], self.noise[place + 1]) {
                    return None;
                }
                let response = self.matrix[place][place] + self.matrix[place + 1][place + 1];
                let damping = if is_damped { response } else { T::constant(0.0) };
                let forces = of(&outcome.forces);
                let towards = [x - damping * forces[0], y - damping * forces[1]];
                let direction = towards.map(|part| part / length(towards));
                let change =
                    larger(Scalar::abs(direction[0] - known[0]), Scalar::abs(direction[1] - known[1]));
                (change > unit).then_some(Grip::Slides(direction))
            }
            Grip::Open | Grip::Idle => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::defect::FOUND;

    /// A block on a floor with gap and one or two velocities, in units of its mass.
    fn block(rates: [f64; 3], grip: Grip<f64>, count: usize) -> ContactForces<f64> {
        let matrix: Vec<Vec<f64>> =
            (0..3).map(|i| (0..3).map(|j| if i == j { 1.0 } else { 0.0 }).collect()).collect();
        let friction = Rubbing { place: 1, count, grip, bounds: [0.5, 0.5] };
        let touches = vec![Touch { gap: Some(0), least: 0.0, friction: Some(friction) }];
        let law =
            Law { matrix: &matrix, rates: rates.to_vec(), noise: vec![1e-15; 3], touches, accuracy: FOUND };
        law.decide().expect("forces")
    }

    #[test]
    fn a_block_sticks_and_slides_each_way_and_parts() {
        for (pull, grip, force) in [
            (0.25, Grip::Sticks, -0.25),
            (0.0, Grip::Idle, 0.0),
            (2.0, Grip::Slides([1.0, 0.0]), -0.5),
            (-2.0, Grip::Slides([-1.0, 0.0]), 0.5),
        ] {
            let outcome = block([-1.0, pull, 0.0], Grip::Open, 1);
            assert_eq!((outcome.grips[0], outcome.pushes[0]), (Some(grip), true));
            assert_eq!(outcome.forces, [1.0, force, 0.0]);
        }
        assert!(!block([1.0, 2.0, 0.0], Grip::Open, 1).pushes[0]);
    }

    /// A block that is four times as heavy along one axis, pulled askew by a little more than its friction holds: its acceleration is small,
    /// and its direction changes much with that of the force.
    #[test]
    fn a_block_that_is_all_but_held_slides_along_its_acceleration() {
        let matrix = [[1.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 1.0]].map(Vec::from);
        let friction = Rubbing { place: 1, count: 2, grip: Grip::Sticks, bounds: [0.5, 0.5] };
        let touches = vec![Touch { gap: Some(0), least: 0.0, friction: Some(friction) }];
        // Forces of 0.3 and 0.4 hold it within the limit of 0.5.
        let (beyond, noise) = (1.0 + 1e-7, vec![1e-15; 3]);
        let rates = vec![-1.0, 4.0 * 0.3 * beyond, 0.4 * beyond];
        let found = Law { matrix: &matrix, rates, noise, touches, accuracy: FOUND }.in_directions();
        let found = found.expect("forces");
        let ([x, y], [u, v]) = ([found.forces[1], found.forces[2]], [found.rates[1], found.rates[2]]);
        assert!((f64::hypot(x, y) - 0.5).abs() < 1e-15 && u > 0.0, "{x}, {y}, {u}, {v}");
        assert!((x * v - y * u).abs() < 1e-13, "{x}, {y}, {u}, {v}");
    }

    #[test]
    fn a_block_slides_against_the_pull_in_the_plane() {
        let outcome = block([-1.0, 3.0, 4.0], Grip::Sticks, 2);
        assert_eq!(outcome.forces, [1.0, -0.3, -0.4]);
        assert_eq!(block([-1.0, 0.3, 0.4], Grip::Sticks, 2).forces, [1.0, -0.3, -0.4]);
        assert_eq!(block([-1.0, 0.0, 0.1], Grip::Sticks, 2).grips[0], Some(Grip::Sticks));
    }
}
