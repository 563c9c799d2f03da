//! Poisson's law of impact, against impacts by hand.

use lagrange_core::contact::Contacts;
use lagrange_core::nalgebra::Const;
use lagrange_core::prelude::*;
use lagrange_random::{Random, cases};
use lagrange_systems::{PoissonRod, Rod};

/// A uniform rod without weight.
pub(crate) fn rod([m, a, e, mu]: [f64; 4]) -> PoissonRod {
    PoissonRod { m, j: m * a * a / 3.0, a, e: [e; 2], mu, ..PoissonRod::default() }
}

/// The lower end of a rod of the length 2a on the floor.
fn leaning(a: f64, theta: f64, v: [f64; 3]) -> State<f64, 3> {
    State::new([0.0, a * theta.sin(), theta], v)
}

/// Velocities after an impact at the start.
pub(crate) fn after<L: Contacts<N = Const<3>, Scalar = f64> + Clone>(
    system: &L,
    start: State<f64, 3>,
) -> [f64; 3] {
    system.motion(start).with_contacts().to(1e-9).expect("an impact").end().state().v.into()
}

/// The rows of the lower end, and their responses G = W M⁻¹ Wᵀ.
struct End {
    rows: [[f64; 3]; 2],
    response: [[f64; 2]; 2],
    masses: [f64; 3],
}

impl End {
    fn of(rod: &PoissonRod, theta: f64) -> Self {
        let rows = [[0.0, 1.0, -rod.a * theta.cos()], [1.0, 0.0, rod.a * theta.sin()]];
        let masses = [rod.m, rod.m, rod.j];
        let response =
            [0, 1].map(|i| [0, 1].map(|j| (0..3).map(|k| rows[i][k] * rows[j][k] / masses[k]).sum()));
        Self { rows, response, masses }
    }

    fn rates(&self, v: [f64; 3]) -> [f64; 2] {
        self.rows.map(|row| (0..3).map(|k| row[k] * v[k]).sum())
    }

    fn push(&self, v: [f64; 3], [n, t]: [f64; 2]) -> [f64; 3] {
        [0, 1, 2].map(|k| v[k] + (self.rows[0][k] * n + self.rows[1][k] * t) / self.masses[k])
    }

    /// Coulomb's law for impulses at these rates, with at least the impulse `least` against the gap: sticking, and sliding each
    /// way, with the gap at rest or the least impulse, are tried one after another.
    fn impulses(&self, [u, w]: [f64; 2], least: f64, mu: f64) -> [f64; 2] {
        let [[a, b], [_, c]] = self.response;
        let all = [None, Some(-1.0), Some(1.0)].into_iter().flat_map(|slide| {
            let at_rest = match slide {
                None => (c * -u + b * w) / (a * c - b * b),
                Some(sign) => -u / (a - b * mu * sign),
            };
            [at_rest, least].map(|n| {
                let t = slide.map_or(-(w + b * n) / c, |sign: f64| -mu * sign * n);
                let after = [u + a * n + b * t, w + b * n + c * t];
                let tangent = match slide {
                    None => mu * n - t.abs(),
                    Some(sign) => sign * after[1],
                };
                ([n, t], (n - least).min(after[0]).min(tangent))
            })
        });
        // The one that satisfies the inequalities best: all of them but for round-off.
        let (impulses, slack) = all.max_by(|one, other| one.1.total_cmp(&other.1)).expect("six");
        assert!(slack > -1e-12, "{slack:e}");
        impulses
    }

    /// Velocities after compression, and after expansion.
    fn poisson(&self, rod: &PoissonRod, v: [f64; 3]) -> [[f64; 3]; 2] {
        let compression = self.impulses(self.rates(v), 0.0, rod.mu);
        let compressed = self.push(v, compression);
        let expansion = self.impulses(self.rates(compressed), rod.e[0] * compression[0], rod.mu);
        [compressed, self.push(compressed, expansion)]
    }

    fn newton(&self, rod: &PoissonRod, v: [f64; 3]) -> [f64; 3] {
        let [u, w] = self.rates(v);
        self.push(v, self.impulses([(1.0 + rod.e[0]) * u, w], 0.0, rod.mu))
    }
}

pub(crate) fn distance(one: [f64; 3], other: [f64; 3]) -> f64 {
    one.iter().zip(&other).fold(0.0, |most: f64, (x, y)| most.max((x - y).abs()))
}

/// 10⁴ impacts of random rods: by hand, and without a gain of energy, which Newton's law has in some.
#[test]
fn a_rod_bounces_by_both_stages_and_gains_no_energy() {
    let mut random = Random(5);
    let [mut differ, mut sticks, mut newton_gains] = [0; 3];
    let count = cases([500, 10_000, 100_000]);
    for case in 0..count {
        let mut next = |low: f64, high: f64| random.between(low, high);
        // Up to a coefficient of 4/3 each stage has one solution.
        let rod = rod([next(0.5, 2.0), next(0.3, 1.0), next(0.0, 1.0), next(0.0, 1.3)]);
        let theta = next(0.1, 3.0);
        let v = [next(-2.0, 2.0), next(-2.0, 2.0), next(-2.0, 2.0)];
        let end = End::of(&rod, theta);
        if end.rates(v)[0] > -1e-3 {
            continue;
        }
        let [compressed, expected] = end.poisson(&rod, v);
        let found = after(&rod, leaning(rod.a, theta, v));
        assert!(distance(found, expected) < 1e-12, "case {case}: {found:?} for {expected:?}");
        let energy = |v: [f64; 3]| rod.energy(&leaning(rod.a, theta, v));
        let (before, gain) = (energy(v), energy(found) - energy(v));
        assert!(gain <= before * 1e-14, "case {case}: {gain}");
        let newton = end.newton(&rod, v);
        differ += usize::from(distance(newton, expected) > 1e-3);
        sticks += usize::from(end.rates(compressed)[1].abs() < 1e-12);
        newton_gains += usize::from(energy(newton) > before * (1.0 + 1e-6));
    }
    println!("differ {differ}, stick in compression {sticks}, Newton's law would gain {newton_gains}");
    assert!(differ > count / 10 && sticks > count / 10 && newton_gains > count / 1_000);
}

/// With G = (a b; b c): a rod that sticks in compression with the rate −v and the velocity s along the floor takes the impulse
/// (c v + b s)/(a c − b²), and reopens at e (v + b s/c); one that slides all the way reopens at e v, as by Newton's law.
#[test]
fn a_rod_sticks_or_slides_in_compression() {
    let theta = 1.0_f64;
    for (mu, s, sticks) in [(1.2, 0.3, true), (1.2, -0.3, true), (0.05, 2.0, false), (0.05, -2.0, false)] {
        let (b, c) = (-0.75 * theta.sin() * theta.cos() * 2.0, (1.0 + 3.0 * theta.sin().powi(2)) / 2.0);
        let v = after(&rod([2.0, 0.5, 0.6, mu]), leaning(0.5, theta, [s, -1.0, 0.0]));
        let [opens, slides] = [v[1] - 0.5 * theta.cos() * v[2], v[0] + 0.5 * theta.sin() * v[2]];
        let expected = if sticks { 0.6 * (1.0 + b * s / c) } else { 0.6 };
        assert!((opens - expected).abs() < 1e-14, "{mu}, {s}: {opens} for {expected}");
        assert_eq!(slides.abs() < 1e-15, sticks, "{mu}, {s}: {slides}");
    }
}

#[test]
fn one_contact_without_friction_bounces_alike_by_both_laws() {
    let mut random = Random(6);
    for _ in 0..cases([100, 1_000, 10_000]) {
        let mut next = |low: f64, high: f64| random.between(low, high);
        let (m, a, e, theta) = (next(0.5, 2.0), next(0.3, 1.0), next(0.0, 1.0), next(0.1, 3.0));
        let start = leaning(a, theta, [next(-2.0, 2.0), -2.0, next(-1.0, 1.0)]);
        let newton = Rod { m, j: m * a * a / 3.0, a, e, left: -9.0, ..Rod::default() };
        let [newton, poisson] = [after(&newton, start), after(&rod([m, a, e, 0.0]), start)];
        assert!(distance(newton, poisson) < 1e-13, "{newton:?} {poisson:?}");
    }
}

/// A block with two corners on the floor, of two coefficients.
#[test]
fn a_block_with_two_corners_gains_no_energy() {
    let mut random = Random(8);
    for case in 0..cases([100, 2_000, 100_000]) {
        let mut next = |low: f64, high: f64| random.between(low, high);
        let (a, h) = (next(0.2, 1.0), next(0.2, 2.0));
        let (j, e, mu) = (next(0.05, 1.0), [next(0.0, 1.0), next(0.0, 1.0)], next(0.0, 1.0));
        let block = PoissonRod { m: 1.0, j, a, h, e, mu, ..PoissonRod::default() };
        let start = State::new([0.0, h, 0.0], [next(-2.0, 2.0), -1.0, next(-1.0, 1.0) / a]);
        let end = State { v: after(&block, start).into(), ..start };
        let [before, after] = [start, end].map(|state| block.energy(&state));
        assert!(after <= before * (1.0 + 1e-13), "case {case}: {}", after - before);
    }
}
