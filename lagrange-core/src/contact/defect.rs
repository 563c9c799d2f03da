//! How far forces are off their law.

use super::cones::length;
use super::law::{ContactForces, Grip, Law, Rubbing, Touch};
use crate::number::{Real, Scalar, larger, smaller};

/// Defect of the law, relative to the terms of a rate, within which forces are found. That of impulses may be no more; forces say
/// what pushes and sticks from then on, for which [`BEYOND`](super::watched::BEYOND) is enough.
pub(super) const FOUND: f64 = 1e-12;

/// Largest terms of a rate, in units of the largest rate without forces, that count: bodies wedged between contacts take forces
/// of any size, and those of 10¹⁴ left velocities that were round-off.
const TERMS: f64 = 1e3;

/// Units of round-off of the terms, which remain in any case.
const UNITS: f64 = 64.0;

impl<T: Real> Law<'_, T> {
    /// Whether forces satisfy the law of all gaps, and of friction whose force was to be decided: those of each are the allowed ones
    /// that are nearest to p − u/g, with the forces p, the rates u and their response g.
    pub(super) fn obeys(&self, forces: &ContactForces<T>) -> bool {
        let scale = self.scale();
        self.touches.iter().all(|touch| {
            let pushes = touch.gap.is_none_or(|gap| {
                self.are_nearest([gap].into_iter(), forces, scale, |[push, none]| {
                    [larger(push, touch.least), none]
                })
            });
            pushes && self.obeys_friction(touch, forces, scale)
        })
    }

    fn obeys_friction(&self, touch: &Touch<T>, forces: &ContactForces<T>, scale: T) -> bool {
        let Some(Rubbing { place, count, grip, bounds }) = touch.friction else { return true };
        if matches!(grip, Grip::Idle | Grip::Slides(_)) {
            return true;
        }
        let press = larger(touch.gap.map_or(T::constant(1.0), |gap| forces.forces[gap]), T::constant(0.0));
        let force = |c: usize| if c < count { forces.forces[place + c] } else { T::constant(0.0) };
        // What slides does so with a force between its bounds.
        let [limit, sliding] = bounds.map(|bound| bound * press);
        let radius = larger(smaller(length([force(0), force(1)]), limit), sliding);
        self.are_nearest(place..place + count, forces, scale, |p| {
            let size = length(p);
            if size <= radius { p } else { p.map(|part| part * (radius / size)) }
        })
    }

    /// Whether the forces of a gap or of a friction are the allowed ones that are nearest.
    fn are_nearest(
        &self,
        rows: impl Iterator<Item = usize> + Clone,
        forces: &ContactForces<T>,
        scale: T,
        allowed: impl Fn([T; 2]) -> [T; 2],
    ) -> bool {
        let zero = T::constant(0.0);
        let response = rows.clone().fold(zero, |most, row| larger(most, self.matrix[row][row]));
        if response <= zero {
            return true;
        }
        let accuracy = larger(T::constant(self.accuracy), T::constant(T::EPSILON * UNITS));
        let scale = scale * Scalar::sqrt(response);
        let [mut is, mut pulled, mut round_off] = [[zero; 2], [zero; 2], [zero; 2]];
        for (c, row) in rows.enumerate() {
            is[c] = forces.forces[row];
            pulled[c] = is[c] - forces.rates[row] / response;
            let terms = Scalar::abs(self.rates[row]) + self.size(row, forces);
            round_off[c] = self.noise[row] + accuracy * smaller(terms, T::constant(TERMS) * scale);
        }
        let nearest = allowed(pulled);
        let defect = response * length([nearest[0] - is[0], nearest[1] - is[1]]);
        defect <= T::constant(FOUND) * scale + round_off[0] + round_off[1]
    }

    /// The largest rate without forces or with the smallest ones of gaps, in units of the square root of energy.
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

    /// A number from −1 to 1, by a linear congruence.
    struct Random(u64);

    impl Random {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        }

        fn many(&mut self, count: usize) -> Vec<f64> {
            (0..count).map(|_| self.next()).collect()
        }
    }

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
    }

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
            random.many(5);
            let mut below = |count: u64| (0.5 * (random.next() + 1.0) * count as f64) as usize;
            let (contacts, motions, count) = (1 + below(4), 2 + below(5), 1 + below(2));
            let mu = [0.0, 0.1, 0.3, 1.0][below(4)];
            let mut row = || {
                let scale = |_| if kind == Kind::Unlike { 10.0_f64.powf(2.0 * random.next()) } else { 1.0 };
                let scales: Vec<f64> = (0..motions).map(scale).collect();
                (scales, random.many(motions))
            };
            let (scales, _) = row();
            let mut scaled = || row().1.iter().zip(&scales).map(|(x, scale)| x * scale).collect::<Vec<f64>>();
            let mut rows: Vec<Vec<f64>> = (0..contacts * (1 + count)).map(|_| scaled()).collect();
            let motion = scaled().iter().zip(&scales).map(|(x, scale)| x / (scale * scale)).collect();
            if matches!(kind, Kind::Dependent | Kind::Nearly) && contacts > 1 {
                let apart = if kind == Kind::Nearly { 10.0_f64.powf(-5.0 + 3.0 * scaled()[0]) } else { 0.0 };
                let parts = scaled();
                // Gaps stand first, then the velocities of each friction.
                let places =
                    |k: usize| [k].into_iter().chain(contacts + k * count..contacts + (k + 1) * count);
                let other = if contacts > 2 { 1 } else { 0 };
                for ((last, first), second) in places(contacts - 1).zip(places(0)).zip(places(other)) {
                    let more = scaled();
                    rows[last] = (0..motions)
                        .map(|i| {
                            parts[0].abs() * rows[first][i]
                                + parts[1].abs() * rows[second][i]
                                + apart * more[i]
                        })
                        .collect();
                }
            }
            Self { rows, contacts, count, mu, motion }
        }

        fn forces(&self, accuracy: f64) -> Result<ContactForces<f64>, NoForces> {
            let matrix: Vec<Vec<f64>> =
                self.rows.iter().map(|row| self.rows.iter().map(|other| dot(row, other)).collect()).collect();
            let rates: Vec<f64> = self.rows.iter().map(|row| dot(row, &self.motion)).collect();
            let size = |row: &Vec<f64>| row.iter().zip(&self.motion).map(|(x, y)| (x * y).abs()).sum::<f64>();
            let noise = self.rows.iter().map(|row| 8.0 * f64::EPSILON * size(row)).collect();
            let grip = if self.count == 1 { Grip::Open } else { Grip::Sticks };
            let touch = |k: usize| {
                let (place, bounds) = (self.contacts + k * self.count, [self.mu; 2]);
                let friction = Rubbing { place, count: self.count, grip, bounds };
                Touch { gap: Some(k), least: 0.0, friction: Some(friction) }
            };
            let touches = (0..self.contacts).map(touch).collect();
            Law { matrix: &matrix, rates, noise, touches, accuracy }.decide()
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
            let mut worst: f64 = 0.0;
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

    /// `LAGRANGE_SHARES` says how many cases are drawn. Where forces are not found, the motion ends with a name.
    #[test]
    fn forces_that_are_believed_satisfy_the_law() {
        let cases = std::env::var("LAGRANGE_SHARES").map_or(1_000, |text| text.parse().expect("a number"));
        for (kind, most) in
            [(Kind::Independent, 1), (Kind::Dependent, 1), (Kind::Nearly, 2), (Kind::Unlike, 25)]
        {
            for accuracy in [FOUND, BEYOND] {
                let mut none = 0;
                for case in 0..cases {
                    let drawn = Case::any(case, kind);
                    let found = match drawn.forces(accuracy) {
                        Ok(found) => found,
                        Err(NoForces::Jammed) if drawn.count == 1 => {
                            panic!("{kind:?} contacts, case {case}: impacts have a solution")
                        }
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
}
