//! Shares of friction at rest that leave it a reserve: forces that several contacts share are not unique.

use alloc::vec;
use alloc::vec::Vec;

use super::complementarity::Complementarity;
use super::cones::length;
use crate::number::{Real, Scalar, larger, largest, order};

/// Largest number of Newton steps. Those towards a limit multiply u by 1.5 each, and a few find it.
const STEPS: usize = 200;

/// Halvings of one Newton step.
const HALVINGS: usize = 40;

/// |u|²/g at which friction has reached its limit: its force is within 5·10⁻¹¹ of it. Of 500,000 random loads on three contacts, none
/// slides at 1 − 10⁻⁶ of its limit, and none is held at 1 + 10⁻⁸.
const AT_LIMIT: f64 = 1e10;

/// |u|²/g from which friction slides where others have reached their limits: its force is within 5·10⁻⁵ of its own.
const MOVES: f64 = 1e4;

/// Imbalance of forces, relative to the sum of their limits, below which they are found; Newton steps go on to round-off
/// while they halve it. Near the limit round-off leaves more than 10⁻¹⁵ of one in six loads.
const FOUND: f64 = 1e-12;

/// Friction at rest whose force is shared out anew.
#[derive(Clone, Copy, Debug)]
pub(super) struct Resting<T> {
    /// Place of its first velocity among the rows.
    pub(super) place: usize,
    pub(super) count: usize,
    /// Largest force.
    pub(super) limit: T,
}

/// What friction at rest that shares its forces does.
pub(super) struct Reserve<T> {
    /// Force of each friction.
    pub(super) forces: Vec<[T; 2]>,
    /// Direction in which each begins to slide, where together they have reached their limits.
    pub(super) slips: Vec<Option<[T; 2]>>,
    /// Velocities, in some unit, of the motion in which they begin to slide.
    pub(super) velocities: Vec<[T; 2]>,
}

/// Friction with its limit s and its mean response g, and the rows of its velocities u = C x.
struct SharedFriction<T> {
    limit: T,
    response: T,
    combinations: Vec<Vec<T>>,
}

impl<T: Real> SharedFriction<T> {
    fn velocity(&self, x: &[T]) -> [T; 2] {
        let of = |row: &Vec<T>| row.iter().zip(x).fold(T::constant(0.0), |sum, (&c, &x)| sum + c * x);
        let mut u = [T::constant(0.0); 2];
        u.iter_mut().zip(&self.combinations).for_each(|(u, row)| *u = of(row));
        u
    }

    /// |u|²/g.
    fn far(&self, [x, y]: [T; 2]) -> T {
        (x * x + y * y) / self.response
    }

    /// s u/√(g + |u|²).
    fn force(&self, [x, y]: [T; 2]) -> [T; 2] {
        let size = Scalar::sqrt(self.response + x * x + y * y);
        [x, y].map(|u| self.limit * u / size)
    }

    /// Derivatives of the force by u.
    fn derivatives(&self, u: [T; 2]) -> [[T; 2]; 2] {
        let square = self.response + u[0] * u[0] + u[1] * u[1];
        let factor = self.limit / (square * Scalar::sqrt(square));
        let across = -(factor * u[0] * u[1]);
        let along = |other: usize| factor * (self.response + u[other] * u[other]);
        [[along(1), across], [across, along(0)]]
    }
}

/// Shares out forces T of friction at rest with limits s and mean responses g. Of all forces within the limits that act in the
/// same way, it gives those for which Σ √g √(s² − |T|²) is largest. By duality T = s u/√(g + |u|²) with velocities u of a motion of
/// the bodies, which grow without end as the forces come to their limits together; the bodies then begin to slide along −u.
/// Newton's method minimizes the convex Σ s √(g + |u|²) − Tᵀu.
pub(super) fn reserve<T: Real>(
    problem: &Complementarity<T>,
    resting: &[Resting<T>],
    forces: &[T],
) -> Option<Reserve<T>> {
    let parts = parts(problem, resting, forces)?;
    let size = parts.first()?.combinations.first()?.len();
    let imbalance = |x: &[T]| {
        let mut sum = vec![T::constant(0.0); size];
        for (part, of) in parts.iter().zip(resting) {
            let force = part.force(part.velocity(x));
            for (c, row) in part.combinations.iter().enumerate() {
                let more = force[c] - forces[of.place + c];
                sum.iter_mut().zip(row).for_each(|(sum, &entry)| *sum += entry * more);
            }
        }
        sum
    };
    let scale = parts.iter().fold(T::constant(0.0), |sum, part| {
        let entries = part.combinations.iter().flatten();
        sum + part.limit * entries.fold(T::constant(0.0), |most, &entry| larger(most, Scalar::abs(entry)))
    });
    let mut x = vec![T::constant(0.0); size];
    let mut left = imbalance(&x);
    for _ in 0..STEPS {
        let velocities: Vec<[T; 2]> = parts.iter().map(|part| part.velocity(&x)).collect();
        let most = parts.iter().zip(&velocities).map(|(part, &u)| part.far(u)).fold(T::constant(0.0), larger);
        let is_at_limit = most > T::constant(AT_LIMIT);
        let off = largest(&left);
        let [is_exact, is_found] = [T::EPSILON, FOUND].map(|part| off <= T::constant(part) * scale);
        let goes_on = !is_exact && !is_at_limit;
        let next = goes_on.then(|| descent(&x, &left, curvature(&parts, &velocities), imbalance)).flatten();
        match next.filter(|(_, after)| !is_found || largest(after) <= T::constant(0.5) * off) {
            Some(next) => (x, left) = next,
            None if is_found || is_at_limit => return Some(outcome(&parts, &velocities, is_at_limit)),
            None => return None,
        }
    }
    None
}

/// Forces of friction with these velocities; at the limit it slides, but for what moves slowly beside the fastest.
fn outcome<T: Real>(parts: &[SharedFriction<T>], velocities: &[[T; 2]], is_at_limit: bool) -> Reserve<T> {
    let both = || parts.iter().zip(velocities);
    let moves = |(part, &u): (&SharedFriction<T>, &[T; 2])| is_at_limit && part.far(u) > T::constant(MOVES);
    let slip = |of: (&SharedFriction<T>, &[T; 2])| moves(of).then(|| of.1.map(|u| -(u / length(*of.1))));
    Reserve {
        forces: both().map(|(part, &u)| part.force(u)).collect(),
        slips: both().map(slip).collect(),
        velocities: velocities.iter().map(|velocity| velocity.map(|u| -u)).collect(),
    }
}

/// The next x: a Newton step, halved until the slope along it does not rise to more than it fell.
fn descent<T: Real>(
    x: &[T],
    left: &[T],
    curvature: Vec<Vec<T>>,
    imbalance: impl Fn(&[T]) -> Vec<T>,
) -> Option<(Vec<T>, Vec<T>)> {
    let noise = vec![T::constant(0.0); x.len()];
    let all: Vec<usize> = (0..x.len()).collect();
    let step = Complementarity { matrix: curvature, constant: left.to_vec(), noise }.equality(&all);
    let slope = |left: &[T]| left.iter().zip(&step).fold(T::constant(0.0), |sum, (&l, &s)| sum + l * s);
    let before = slope(left);
    let mut part = T::constant(1.0);
    for _ in 0..HALVINGS {
        let next: Vec<T> = x.iter().zip(&step).map(|(&x, &step)| x + part * step).collect();
        let left = imbalance(&next);
        if slope(&left) <= -before {
            return Some((next, left));
        }
        part *= T::constant(0.5);
    }
    None
}

/// `None` if friction without a limit has to hold what nothing else does.
fn parts<T: Real>(
    problem: &Complementarity<T>,
    resting: &[Resting<T>],
    forces: &[T],
) -> Option<Vec<SharedFriction<T>>> {
    // What has no limit moves along with the others.
    let with_force = resting.iter().filter(|of| of.limit > T::constant(0.0));
    let rows: Vec<usize> = with_force.flat_map(|of| of.place..of.place + of.count).collect();
    let active = independent(problem, &rows);
    let is_held = |row: usize| {
        forces[row] == T::constant(0.0) || active.contains(&row) || problem.depends(row, &active)
    };
    if !resting.iter().flat_map(|of| of.place..of.place + of.count).all(is_held) {
        return None;
    }
    let part = |&Resting { place, count, limit }: &Resting<T>| {
        let rows = place..place + count;
        let response = rows.clone().fold(T::constant(0.0), |sum, row| sum + problem.matrix[row][row]);
        let response = response / T::constant(count as f64);
        SharedFriction {
            limit,
            response,
            combinations: rows.map(|row| problem.combination(row, &active)).collect(),
        }
    };
    Some(resting.iter().map(part).collect())
}

/// Rows on which all depend, each the most independent one of those before: in another order, round-off of one that all but
/// depends on others makes more of them independent than there are motions.
fn independent<T: Real>(problem: &Complementarity<T>, rows: &[usize]) -> Vec<usize> {
    let mut active = Vec::new();
    loop {
        let rest = rows.iter().filter(|row| !active.contains(*row));
        let part = |&row: &usize| Some((row, problem.response(row, &active)? / problem.matrix[row][row]));
        let most = rest.filter_map(part).max_by(|one, other| order(one.1, other.1));
        let Some((row, _)) = most else { return active };
        active.push(row);
    }
}

fn curvature<T: Real>(parts: &[SharedFriction<T>], velocities: &[[T; 2]]) -> Vec<Vec<T>> {
    let size = parts[0].combinations[0].len();
    let mut sum = vec![vec![T::constant(0.0); size]; size];
    for (part, &u) in parts.iter().zip(velocities) {
        let derivatives = part.derivatives(u);
        for (a, one) in part.combinations.iter().enumerate() {
            for (b, other) in part.combinations.iter().enumerate() {
                for (row, &entry) in sum.iter_mut().zip(one) {
                    row.iter_mut().zip(other).for_each(|(sum, &by)| *sum += entry * derivatives[a][b] * by);
                }
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use lagrange_random::Random;

    const POINTS: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.3], [-0.4, 0.8]];

    /// Forces on three points of a body of unit mass and inertia that hold it against a force and a moment about the origin,
    /// and whether they slide.
    fn held([x, turn]: [f64; 2], points: [[f64; 2]; 3], limits: [f64; 3]) -> Option<([[f64; 2]; 3], bool)> {
        let rows: Vec<[f64; 3]> =
            points.iter().flat_map(|&[px, py]| [[1.0, 0.0, -py], [0.0, 1.0, px]]).collect();
        let dot = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let matrix = rows.iter().map(|row| rows.iter().map(|other| dot(row, other)).collect()).collect();
        let problem = Complementarity { matrix, constant: vec![0.0; 6], noise: vec![0.0; 6] };
        let [px, py] = [0, 1].map(|c| points[1][c] - points[0][c]);
        let moment = turn + points[0][1] * x;
        let couple = [-py, px].map(|part| part * moment / (px * px + py * py));
        let forces = [-x + couple[0], couple[1], -couple[0], -couple[1], 0.0, 0.0];
        let resting: Vec<Resting<f64>> =
            (0..3).map(|k| Resting { place: 2 * k, count: 2, limit: limits[k] }).collect();
        let found = reserve(&problem, &resting, &forces)?;
        let shared = [found.forces[0], found.forces[1], found.forces[2]];
        // They act as those given.
        let moment = |forces: &[[f64; 2]; 3]| {
            points.iter().zip(forces).map(|([px, py], [fx, fy])| px * fy - py * fx).sum::<f64>()
        };
        let sum = |c: usize| shared.iter().map(|force| force[c]).sum::<f64>();
        let off = [sum(0) + x, sum(1), moment(&shared) + turn].map(f64::abs);
        let slides = found.slips.iter().any(Option::is_some);
        // Three rows that are independent, with entries up to 1, and combinations of them are each off by up to `FOUND`.
        let bound = 3.0 * FOUND * limits.iter().sum::<f64>();
        assert!(slides || off.iter().all(|off| *off < bound), "{off:?}");
        Some((shared, slides))
    }

    /// Limits 1, 2 and 1/2 hold a pull of up to 3.5 whose line passes the centre of the limits.
    #[test]
    fn forces_come_to_their_limits_together() {
        let limits = [1.0, 2.0, 0.5];
        for (load, slides) in
            [(0.1, false), (0.9, false), (0.999_999, false), (1.0 - 1e-9, false), (1.0, true)]
        {
            let (forces, slide) = held([3.5 * load, -load], POINTS, limits).expect("forces");
            assert_eq!(slide, slides, "{load}");
            for (force, limit) in forces.iter().zip(limits) {
                let part = f64::hypot(force[0], force[1]) / limit;
                assert!(part < 1.0 && part > load - 0.06, "{load}: {part}");
            }
        }
    }

    /// A contact without a limit takes no force.
    #[test]
    fn what_has_no_limit_takes_no_force() {
        let (forces, slides) = held([1.0, 0.2], POINTS, [1.0, 2.0, 0.0]).expect("forces");
        assert!(forces[2] == [0.0; 2] && !slides, "{forces:?}");
    }

    /// The least value of a convex function, by golden sections.
    fn least(of: impl Fn(f64) -> f64) -> f64 {
        let (mut low, mut high, part) = (-50.0, 50.0, (5.0_f64.sqrt() - 1.0) / 2.0);
        while high - low > 1e-10 {
            let [one, other] = [high - part * (high - low), low + part * (high - low)];
            if of(one) < of(other) { high = other } else { low = one }
        }
        of((low + high) / 2.0)
    }

    /// Friction holds a load until some motion takes no more power from friction than the load gives (limit analysis). For motions
    /// in which a load of 1 gives the power 1, the limit is thus the least power of friction; golden sections find it.
    #[test]
    fn random_loads_are_held_up_to_their_limit() {
        let cases = lagrange_random::cases([50, 200, 50_000]) as u64;
        for case in 0..cases {
            let mut random = Random(case);
            let points = [0, 1, 2].map(|_| [random.number() / 2.0, random.number() / 2.0]);
            let limits = [0, 1, 2].map(|_| 0.6 + random.number() / 2.0);
            let turn = 0.2 * random.number();
            let power = |v: f64, w: f64| {
                let of = |[px, py]: [f64; 2]| f64::hypot(1.0 - turn * w - py * w, v + px * w);
                points.iter().zip(limits).map(|(&point, limit)| limit * of(point)).sum::<f64>()
            };
            let load = least(|w| least(|v| power(v, w)));
            for (part, slides) in
                [(0.5, false), (1.0 - 1e-6, false), (1.0 + 1e-8, true), (1.1, true), (3.0, true)]
            {
                let (_, found) = held([part * load, part * load * turn], points, limits).expect("forces");
                assert_eq!(found, slides, "case {case}: {part} of the limit {load}");
            }
        }
    }
}
