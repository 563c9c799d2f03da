//! Random problems whose rows are of all sorts.

use lagrange_random::Random;

use crate::cone::{ConeDecision, ConeProblem, ConeSearch, ConeSolver, Limit, RowBlock, Set};

/// How the rows of an impact depend on one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rows {
    Independent,
    Dependent,
    /// But for 10⁻⁸ to 10⁻².
    NearlyDependent,
    /// Of bodies whose masses differ by up to 10⁸.
    OfUnlikeMasses,
    /// Of contacts that face each other but for 10⁻⁸ to 10⁻², with much friction.
    Opposed,
}

pub(super) const ALL_ROWS: [Rows; 5] =
    [Rows::Independent, Rows::Dependent, Rows::NearlyDependent, Rows::OfUnlikeMasses, Rows::Opposed];

/// A problem as it is given.
#[derive(Clone, Debug)]
pub(super) struct Case {
    pub(super) n: usize,
    pub(super) rows: Vec<Vec<f64>>,
    pub(super) q: Vec<f64>,
    pub(super) noise: Vec<f64>,
    pub(super) blocks: Vec<RowBlock>,
    /// Velocities before an impact, whose rates are q; none if it is not an impact.
    pub(super) motion: Vec<f64>,
}

pub(super) fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// A contact whose gap is block `k` and row `first`, followed by `count` rows of friction.
pub(super) fn contact(k: usize, first: usize, count: usize, mu: f64) -> [RowBlock; 2] {
    let friction = Set::Disc(Limit { radius: 0.0, mu, gap: Some(k) });
    [RowBlock { first, count: 1, set: Set::HalfLine }, RowBlock { first: first + 1, count, set: friction }]
}

impl Case {
    /// An impact without restitution of bodies with these velocities.
    pub(super) fn impact(rows: Vec<Vec<f64>>, motion: Vec<f64>, blocks: Vec<RowBlock>) -> Self {
        let q = rows.iter().map(|row| dot(row, &motion)).collect();
        let size = |row: &Vec<f64>| row.iter().zip(&motion).map(|(x, y)| (x * y).abs()).sum::<f64>();
        let noise = rows.iter().map(|row| 8.0 * f64::EPSILON * size(row)).collect();
        Self { n: motion.len(), rows, q, noise, blocks, motion }
    }

    pub(super) fn solver(&self) -> ConeSolver {
        ConeSolver::new(self.n, self.rows.concat(), [self.q.clone(), self.noise.clone()], self.blocks.clone())
    }

    pub(super) fn decision(&self) -> ConeDecision {
        let (j, [rates, noise]) = (self.rows.concat(), [self.q.clone(), self.noise.clone()]);
        ConeProblem { n: self.n, j, rates, noise, blocks: self.blocks.clone() }.decide(ConeSearch::Law)
    }

    /// Up to four contacts with friction along one or two velocities.
    pub(super) fn contacts(seed: u64, kind: Rows) -> Self {
        let mut random = Random(seed);
        let (contacts, n, count) = (1 + random.below(4), 2 + random.below(5), 1 + random.below(2));
        let mu = if kind == Rows::Opposed { 2.0 } else { random.one_of(&[0.0, 0.1, 0.3, 1.0]) };
        let spread = if kind == Rows::OfUnlikeMasses { 2.0 } else { 0.0 };
        let scales: Vec<f64> = (0..n).map(|_| 10.0_f64.powf(spread * random.number())).collect();
        let mut row = || scales.iter().map(|scale| scale * random.number()).collect::<Vec<f64>>();
        let mut rows: Vec<Vec<f64>> = (0..contacts * (1 + count)).map(|_| row()).collect();
        let motion = row().iter().zip(&scales).map(|(x, scale)| x / (scale * scale)).collect();
        let apart = if kind == Rows::Dependent { 0.0 } else { 10.0_f64.powf(random.between(-8.0, -2.0)) };
        let parts = match kind {
            Rows::Dependent | Rows::NearlyDependent => {
                Some([random.between(0.0, 1.0), random.between(0.0, 1.0)])
            }
            Rows::Opposed => Some([-1.0, 0.0]),
            _ => None,
        };
        if let Some([a, b]) = parts.filter(|_| contacts > 1) {
            let [last, second] = [contacts - 1, usize::from(contacts > 2)].map(|k| k * (1 + count));
            for (c, i) in (0..=count).flat_map(|c| (0..n).map(move |i| (c, i))) {
                rows[last + c][i] = a * rows[c][i] + b * rows[second + c][i] + apart * random.number();
            }
        }
        let blocks = (0..contacts).flat_map(|k| contact(2 * k, k * (1 + count), count, mu));
        Self::impact(rows, motion, blocks.collect())
    }

    /// Contacts that are open, stick or slide already along one velocity, with rates for which reactions exist.
    pub(super) fn pushed(seed: u64, kind: Rows) -> Self {
        let (mut case, mut random) = (Self::contacts(seed, kind), Random(!seed));
        let (mut r, mut u) = (vec![0.0; case.q.len()], vec![0.0; case.q.len()]);
        for block in &mut case.blocks {
            let Set::Disc(Limit { mu, gap: Some(gap), .. }) = block.set else { continue };
            let [push, grip, part] = random.vector();
            let normal = block.first - 1;
            let unit = dot(&case.rows[normal], &case.rows[normal]).sqrt();
            (r[normal], u[normal]) = if push > 0.0 { (push / unit, 0.0) } else { (0.0, -push * unit) };
            let rests = grip.abs() < 0.5 && block.count == 1;
            let part = if rests { part } else { -grip.signum() };
            r[block.first] = part * mu * r[normal];
            if !rests {
                block.set = Set::Ray { force: [part * mu, 0.0], gap };
            }
        }
        let x: Vec<f64> =
            (0..case.n).map(|c| case.rows.iter().zip(&r).map(|(row, r)| row[c] * r).sum()).collect();
        case.motion.clear();
        case.q = case.rows.iter().zip(u).map(|(row, u)| u - dot(row, &x)).collect();
        case
    }

    /// Balls of equal mass in a row that touch and have any velocities.
    pub(super) fn balls(seed: u64) -> Self {
        let mut random = Random(seed);
        let count = 2 + random.below(6);
        let motion: Vec<f64> = (0..count).map(|_| random.number()).collect();
        let row =
            |k: usize| (0..count).map(|i| f64::from(i32::from(i == k + 1) - i32::from(i == k))).collect();
        let blocks = (0..count - 1).map(|k| RowBlock { first: k, count: 1, set: Set::HalfLine }).collect();
        Self::impact((0..count - 1).map(row).collect(), motion, blocks)
    }

    /// Accelerations of Painlevé's rod, of length 2 and mass 1, which slides on its lower end.
    pub(super) fn rod(angle: f64, mu: f64, turns: f64) -> Self {
        let ((s, c), root) = (angle.sin_cos(), (1.0_f64 / 3.0).sqrt());
        let rows = vec![vec![0.0, 1.0, -c / root], vec![1.0, 0.0, s / root]];
        let slides = Set::Ray { force: [mu, 0.0], gap: 0 };
        let blocks = vec![
            RowBlock { first: 0, count: 1, set: Set::HalfLine },
            RowBlock { first: 1, count: 1, set: slides },
        ];
        let mut case = Self::impact(rows, vec![0.0, -1.0, 0.0], blocks);
        case.motion.clear();
        // The lower end turns about the centre.
        case.q[0] += turns * turns * s;
        case.q[1] += turns * turns * c;
        case
    }

    /// Blocks of all sets but rays; every fourth row depends on two before it.
    pub(super) fn of_all_sets(seed: u64) -> Self {
        let mut random = Random(!seed);
        let (n, count) = (3 + random.below(6), 2 + random.below(5));
        let (mut rows, mut blocks): (Vec<Vec<f64>>, Vec<RowBlock>) = (vec![], vec![]);
        for _ in 0..count {
            let count = 1 + random.below(2);
            let radius = random.between(0.0, 1.0);
            let friction = |gap: Option<usize>| Set::Disc(Limit { radius, mu: 0.5, gap });
            let (first, gap) = (rows.len(), blocks.len());
            match random.below(6) {
                0 => blocks.push(RowBlock { first, count: 1, set: Set::Line }),
                1 => blocks.push(RowBlock { first, count: 1, set: Set::HalfLine }),
                2 => blocks.push(RowBlock { first, count, set: friction(None) }),
                // As in the expansion of an impact, whose least impulses friction has in its limit.
                3 => blocks.extend([
                    RowBlock { first, count: 1, set: Set::HalfLine },
                    RowBlock { first: first + 1, count, set: friction(Some(gap)) },
                ]),
                _ => blocks.extend(contact(gap, first, count, radius)),
            }
            let count = blocks[gap..].iter().map(|block| block.count).sum::<usize>();
            for _ in 0..count {
                let is_dependent = rows.len() > 2 && random.once_in(4);
                let [a, b] = [(); 2].map(|()| random.below(rows.len().max(1)));
                rows.push(match is_dependent {
                    true => rows[a].iter().zip(&rows[b]).map(|(a, b)| a - 0.5 * b).collect(),
                    false => (0..n).map(|_| random.number()).collect(),
                });
            }
        }
        let motion = (0..n).map(|_| random.number()).collect();
        Self::impact(rows, motion, blocks)
    }

    /// A body of mass 1 in space, with friction along two velocities at points with these axes: the gap's first.
    fn body(points: &[([f64; 3], [[f64; 3]; 3])], inertia: [f64; 3], mu: f64, motion: [f64; 6]) -> Self {
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let row = |point: [f64; 3], axis: [f64; 3]| {
            let turn = cross(point, axis);
            (0..6).map(|i| if i < 3 { axis[i] } else { turn[i - 3] / inertia[i - 3].sqrt() }).collect()
        };
        let rows = points.iter().flat_map(|(point, axes)| axes.map(|axis| row(*point, axis))).collect();
        let scaled = (0..6).map(|i| if i < 3 { motion[i] } else { motion[i] * inertia[i - 3].sqrt() });
        let blocks = (0..points.len()).flat_map(|k| contact(2 * k, 3 * k, 2, mu));
        Self::impact(rows, scaled.collect(), blocks.collect())
    }

    /// A table on legs at these corners, which is pushed down, along and about.
    pub(super) fn table(seed: u64, legs: usize) -> Self {
        let mut random = Random(seed ^ 0x7ab1e);
        let up = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let (height, a, b) = (random.between(0.3, 0.8), random.between(0.5, 1.5), random.between(0.5, 1.5));
        let corners = [[a, b], [a, -b], [-a, b], [-a, -b], [a, 0.0], [-a, 0.0], [0.0, b], [0.0, -b]];
        let points: Vec<_> = corners[..legs].iter().map(|[x, y]| ([*x, *y, -height], up)).collect();
        let mu = random.one_of(&[0.1, 0.3, 0.6, 1.0]);
        let inertia = random.array(|random| random.between(0.2, 1.2));
        let pull = random.one_of(&[0.2, 0.5, 1.0, 2.0]);
        let mut motion: [f64; 6] = random.array(Random::number).map(|x| pull * x);
        motion[2] = -1.0;
        let tilt = random.between(0.0, 1.0);
        motion[3..5].iter_mut().for_each(|x| *x *= tilt);
        Self::body(&points, inertia, mu, motion)
    }
}
