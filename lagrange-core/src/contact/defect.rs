//! The comparison of forces with the laws of gaps and of Coulomb.

use core::ops::Range;

use super::cones::length;
use super::law::{ContactForces, Grip, Law, Rubbing, Touch};
use crate::number::{Real, Scalar, larger, smaller};

/// How far impulses may be off their law, as a part of the terms of each rate: the velocities after an impact follow from them. Forces
/// only decide what pushes and sticks from then on, for which [`BEYOND`](super::watched::BEYOND) is enough.
pub(super) const FOUND: f64 = 1e-12;

/// Largest forces, in units of the largest rate without forces, whose defect may be [`Law::accuracy`] of their terms. Contacts that press
/// a body from two sides may do so with any force, and the work that a defect of the rates does with forces of 10⁹ was ten
/// thousand times the energy before an impact.
const PRESSED: f64 = 1e3;

/// Round-off of a rate, in units of ε of its terms: a smaller defect is none.
const UNITS: f64 = 64.0;

impl<T: Real> Law<'_, T> {
    /// Whether the forces p of each gap, and of each friction that was not known to slide, satisfy their law with the rates u: of all
    /// forces that the law allows, p is the nearest to p − u/g, where g is the rate that a force of 1 causes (Jourdan, Alart and Jean,
    /// *Computer Methods in Applied Mechanics and Engineering* 155, 1998).
    ///
    /// With the exact law an impact takes energy. What a defect δu adds to it is at most Σ |p| |δu| / 2, which is bounded too.
    pub(super) fn obeys(&self, forces: &ContactForces<T>) -> bool {
        let scale = self.scale();
        let work = self.touches.iter().try_fold(T::constant(0.0), |work, touch| {
            let of_gap = touch.gap.map_or(Some(T::constant(0.0)), |gap| {
                self.work_of_defect(gap..gap + 1, forces, scale, |[push, none]| {
                    [larger(push, touch.least), none]
                })
            });
            Some(work + of_gap? + self.work_of_friction(touch, forces, scale)?)
        });
        let allowed = scale * scale * T::constant(self.accuracy * PRESSED * PRESSED);
        work.is_some_and(|work| work <= allowed)
    }

    fn work_of_friction(&self, touch: &Touch<T>, forces: &ContactForces<T>, scale: T) -> Option<T> {
        let none = Some(T::constant(0.0));
        let Some(Rubbing { place, count, grip, bounds }) = touch.friction else { return none };
        if matches!(grip, Grip::Idle | Grip::Slides(_)) {
            return none;
        }
        let press = larger(touch.gap.map_or(T::constant(1.0), |gap| forces.forces[gap]), T::constant(0.0));
        let force = |c: usize| if c < count { forces.forces[place + c] } else { T::constant(0.0) };
        // What slides does so with a force between its bounds.
        let [limit, sliding] = bounds.map(|bound| bound * press);
        let radius = larger(smaller(length([force(0), force(1)]), limit), sliding);
        self.work_of_defect(place..place + count, forces, scale, |p| {
            let size = length(p);
            if size <= radius { p } else { p.map(|part| part * (radius / size)) }
        })
    }

    /// Largest work |p| |δu| that the forces p of these rows do with the defect of their rates. `None` if they are not the nearest to
    /// p − u/g that `allowed` gives, within the accuracy.
    fn work_of_defect(
        &self,
        rows: Range<usize>,
        forces: &ContactForces<T>,
        scale: T,
        allowed: impl Fn([T; 2]) -> [T; 2],
    ) -> Option<T> {
        let zero = T::constant(0.0);
        let response = rows.clone().fold(zero, |most, row| larger(most, self.matrix[row][row]));
        if response <= zero {
            return Some(zero);
        }
        let accuracy = larger(T::constant(self.accuracy), T::constant(T::EPSILON * UNITS));
        let [mut is, mut pulled, mut terms] = [[zero; 2], [zero; 2], [zero; 2]];
        let mut noise = T::constant(FOUND) * scale * Scalar::sqrt(response);
        for (c, row) in rows.enumerate() {
            is[c] = forces.forces[row];
            pulled[c] = is[c] - forces.rates[row] / response;
            terms[c] = Scalar::abs(self.rates[row]) + self.size(row, forces);
            noise += self.noise[row];
        }
        let nearest = allowed(pulled);
        let defect = response * length([nearest[0] - is[0], nearest[1] - is[1]]);
        let terms = terms[0] + terms[1];
        // The rates themselves are as uncertain as their round-off, also where the defect happens to be zero.
        let defect_at_most = larger(defect, T::constant(T::EPSILON) * terms);
        (defect <= noise + accuracy * terms).then(|| length(is) * defect_at_most)
    }

    /// The largest rate without forces, and the largest that the smallest forces of gaps cause, each divided by √g: a unit that is the same
    /// for light and for heavy bodies.
    fn scale(&self) -> T {
        let zero = T::constant(0.0);
        self.touches.iter().fold(zero, |most, touch| {
            let rubbing = touch.friction.map_or(0..0, |of| of.place..of.place + of.count);
            touch.gap.into_iter().chain(rubbing).fold(most, |most, row| {
                let response = Scalar::sqrt(larger(self.matrix[row][row], zero));
                let least = if touch.gap == Some(row) { touch.least * response } else { zero };
                let rate = if response > zero { Scalar::abs(self.rates[row]) / response } else { zero };
                larger(most, larger(rate, least))
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::*;
    use crate::contact::law::NoForces;
    use crate::contact::watched::BEYOND;
    use lagrange_random::{Random, cases};

    /// How the rows of contacts go together.
    #[derive(Clone, Copy, Debug, PartialEq)]
    enum Kind {
        Independent,
        /// The last contact has rows that are sums of those of others.
        Dependent,
        /// As much, but for small differences.
        Nearly,
        /// Masses from 10⁻⁴ to 10⁴.
        Unlike,
        /// The last contact presses against the first, but for small differences, with much friction.
        Opposed,
    }

    /// Cases that had 27,000 times their energy after an impact: a wedge of 10⁻⁸ with impulses of 10⁹.
    const WEDGED: [u64; 2] = [2_965, 4_340];

    /// A case of dependent contacts whose forces exist although none are found: each choice leaves them undetermined.
    const DEGENERATE: u64 = 81_329;

    /// Contacts at one instant: for each, rows of its gap and of one or two velocities of friction.
    struct Case {
        rows: Vec<Vec<f64>>,
        contacts: usize,
        /// Number of velocities of each friction.
        count: usize,
        mu: f64,
        motion: Vec<f64>,
    }

    fn dot(x: &[f64], y: &[f64]) -> f64 {
        x.iter().zip(y).map(|(x, y)| x * y).sum()
    }

    impl Case {
        fn any(case: u64, kind: Kind) -> Self {
            let mut random = Random(case);
            let (contacts, motions, count) = (1 + random.below(4), 2 + random.below(5), 1 + random.below(2));
            let mu = if kind == Kind::Opposed { 2.0 } else { [0.0, 0.1, 0.3, 1.0][random.below(4)] };
            let mut many = |count: usize| (0..count).map(|_| random.number()).collect::<Vec<f64>>();
            let unlike = if kind == Kind::Unlike { 2.0 } else { 0.0 };
            let scales: Vec<f64> = many(motions).iter().map(|x| 10.0_f64.powf(unlike * x)).collect();
            let mut row = || many(motions).iter().zip(&scales).map(|(x, scale)| x * scale).collect();
            let rows: Vec<Vec<f64>> = (0..contacts * (1 + count)).map(|_| row()).collect();
            let motion = row().iter().zip(&scales).map(|(x, scale)| x / (scale * scale)).collect();
            let mut drawn = Self { rows, contacts, count, mu, motion };
            let [apart, first, second] = [0, 1, 2].map(|_| random.number());
            let apart = if kind == Kind::Dependent { 0.0 } else { 10.0_f64.powf(-5.0 + 3.0 * apart) };
            match kind {
                Kind::Dependent | Kind::Nearly => {
                    drawn.depend([first.abs(), second.abs()], apart, || random.number());
                }
                Kind::Opposed => drawn.depend([-1.0, 0.0], apart, || random.number()),
                Kind::Independent | Kind::Unlike => {}
            }
            drawn
        }

        /// Rows of a contact: gaps stand first, then the velocities of each friction.
        fn places(&self, k: usize) -> impl Iterator<Item = usize> + use<> {
            let first = self.contacts + k * self.count;
            [k].into_iter().chain(first..first + self.count)
        }

        /// Makes the rows of the last contact sums of those of others with these parts, but for small differences.
        fn depend(&mut self, parts: [f64; 2], apart: f64, mut more: impl FnMut() -> f64) {
            if self.contacts == 1 {
                return;
            }
            let other = if self.contacts > 2 { 1 } else { 0 };
            let of_others = self.places(0).zip(self.places(other));
            for (last, (first, second)) in self.places(self.contacts - 1).zip(of_others) {
                for i in 0..self.motion.len() {
                    self.rows[last][i] =
                        parts[0] * self.rows[first][i] + parts[1] * self.rows[second][i] + apart * more();
                }
            }
        }

        fn forces(&self, accuracy: f64) -> Result<ContactForces<f64>, NoForces> {
            let rates = self.rows.iter().map(|row| dot(row, &self.motion)).collect();
            let grip = if self.count == 1 { Grip::Open } else { Grip::Sticks };
            self.decided(rates, |_| grip, accuracy)
        }

        fn matrix(&self) -> Vec<Vec<f64>> {
            self.rows.iter().map(|row| self.rows.iter().map(|other| dot(row, other)).collect()).collect()
        }

        fn decided(
            &self,
            rates: Vec<f64>,
            grip: impl Fn(usize) -> Grip<f64>,
            accuracy: f64,
        ) -> Result<ContactForces<f64>, NoForces> {
            let size = |row: &Vec<f64>| row.iter().zip(&self.motion).map(|(x, y)| (x * y).abs()).sum::<f64>();
            let noise = self.rows.iter().map(|row| 8.0 * f64::EPSILON * size(row)).collect();
            let touch = |k: usize| {
                let (place, bounds) = (self.contacts + k * self.count, [self.mu; 2]);
                let friction = Rubbing { place, count: self.count, grip: grip(k), bounds };
                Touch { gap: Some(k), least: 0.0, friction: Some(friction) }
            };
            let touches = (0..self.contacts).map(touch).collect();
            Law { matrix: &self.matrix(), rates, noise, touches, accuracy }.decide()
        }

        /// What the law finds for contacts that open, stick or slide along their first velocity, pushed so that forces exist.
        fn pushed(&self, mut random: Random) -> Result<ContactForces<f64>, NoForces> {
            let (matrix, size) = (self.matrix(), self.rows.len());
            let (mut forces, mut rates, mut grips) = (vec![0.0; size], vec![0.0; size], Vec::new());
            for k in 0..self.contacts {
                let [push, grip, part] = [0, 1, 2].map(|_| random.number());
                let unit = matrix[k][k].sqrt();
                (forces[k], rates[k]) = if push > 0.0 { (push / unit, 0.0) } else { (0.0, -push * unit) };
                let rests = grip.abs() < 0.5 && self.count == 1;
                let part = if rests { part } else { -grip.signum() };
                forces[self.contacts + k * self.count] = part * self.mu * forces[k];
                grips.push(if rests { Grip::Open } else { Grip::Slides([-part, 0.0]) });
            }
            rates.iter_mut().zip(&matrix).for_each(|(rate, row)| *rate -= dot(row, &forces));
            self.decided(rates, |k| grips[k], BEYOND)
        }

        /// By how much forces violate the law, in units of what is allowed: gaps do not close nor pull, those that open do not
        /// push, friction is within its limit, and takes as much power as this limit may.
        fn worst(&self, forces: &[f64], accuracy: f64) -> f64 {
            let motions = self.motion.len();
            let change =
                |i: usize| self.rows.iter().zip(forces).map(|(row, force)| row[i] * force).sum::<f64>();
            let after: Vec<f64> = (0..motions).map(|i| self.motion[i] + change(i)).collect();
            let response = |row: usize| dot(&self.rows[row], &self.rows[row]).sqrt();
            let scale = (0..self.rows.len())
                .map(|row| dot(&self.rows[row], &self.motion).abs() / response(row))
                .fold(0.0, f64::max);
            // Terms of a rate, whose round-off it has.
            let terms = |row: usize| {
                let of = |i: usize| {
                    let changes = self.rows.iter().zip(forces).map(|(of, force)| (of[i] * force).abs());
                    self.rows[row][i].abs() * (self.motion[i].abs() + changes.sum::<f64>())
                };
                (0..motions).map(of).sum::<f64>()
            };
            let allowed = |row: usize| 4.0 * (1e-12 * scale * response(row) + accuracy * terms(row));
            // Impacts take energy.
            let mut worst = (dot(&after, &after) / dot(&self.motion, &self.motion) - 1.0) / 1e-6;
            for k in 0..self.contacts {
                let (push, rate) = (forces[k], dot(&self.rows[k], &after));
                let force = |row: usize| allowed(row) / (response(row) * response(row));
                worst = worst.max(-push / force(k)).max(-rate / allowed(k));
                worst = worst.max((rate / allowed(k)).min(push / force(k)));
                let rows = self.contacts + k * self.count..self.contacts + (k + 1) * self.count;
                let size =
                    |of: &dyn Fn(usize) -> f64| rows.clone().map(|row| of(row).powi(2)).sum::<f64>().sqrt();
                let (drag, slip) = (size(&|row| forces[row]), size(&|row| dot(&self.rows[row], &after)));
                let (slack, still) = (size(&force) + self.mu * force(k), size(&allowed));
                worst = worst.max((drag - self.mu * push) / slack);
                let power = rows.clone().map(|row| forces[row] * dot(&self.rows[row], &after)).sum::<f64>();
                let lacks = self.mu * push * slip + power;
                worst = worst.max(lacks / (slack * slip + still * (drag + self.mu * push + slack)));
            }
            worst
        }
    }

    fn number_of_cases() -> u64 {
        cases([50, 300, 50_000]) as u64
    }

    /// Where forces are not found, the motion ends with a name.
    #[test]
    fn forces_that_are_believed_satisfy_the_law() {
        let cases = number_of_cases();
        for (kind, most) in [
            (Kind::Independent, 1),
            (Kind::Dependent, 1),
            (Kind::Nearly, 2),
            (Kind::Unlike, 50),
            (Kind::Opposed, 140),
        ] {
            for accuracy in [FOUND, BEYOND] {
                let mut none = 0;
                for case in (0..cases).chain(WEDGED) {
                    let drawn = Case::any(case, kind);
                    let found = match drawn.forces(accuracy) {
                        Ok(found) => found,
                        Err(NoForces::Jammed) => panic!("{kind:?} contacts, case {case}: impacts do not jam"),
                        Err(_) => {
                            none += 1;
                            continue;
                        }
                    };
                    let worst = drawn.worst(&found.forces, accuracy);
                    assert!(worst <= 1.0, "{kind:?} contacts, case {case}: {worst}");
                }
                assert!(none * 1000 <= cases * most, "{kind:?} contacts: {none} of {cases} undecided");
            }
        }
    }
    /// Friction that slides may leave no solution, but round-off hides none.
    #[test]
    fn contacts_do_not_jam_where_forces_exist() {
        for kind in [Kind::Independent, Kind::Dependent, Kind::Nearly, Kind::Unlike, Kind::Opposed] {
            for case in (0..number_of_cases()).chain([DEGENERATE]) {
                let found = Case::any(case, kind).pushed(Random(!case));
                assert!(!matches!(found, Err(NoForces::Jammed)), "{kind:?} contacts, case {case}");
            }
        }
    }
}
