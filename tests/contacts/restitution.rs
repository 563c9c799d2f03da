//! Poisson's law of impact, against impacts by hand.

use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::prelude::*;

use lagrange_random::{Random, cases};

/// A uniform rod that hits a floor with its lower end.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2)]
#[contact(floor: y - a*sin(theta) >= 0, restitution(poisson): e, friction(mu): x_dot + a*sin(theta)*theta_dot)]
struct Rod {
    m: f64,
    a: f64,
    e: f64,
    mu: f64,
    floor: Contact,
}

impl Rod {
    /// Velocities after an impact at this angle.
    fn after(&self, theta: f64, v: [f64; 3]) -> [f64; 3] {
        let start = State::new([0.0, self.a * theta.sin(), theta], v);
        let path = self.motion(start).with_contacts().to(1e-9).expect("an impact");
        path.end().v.into()
    }

    fn energy_at(&self, v: [f64; 3]) -> f64 {
        self.m / 2.0 * (v[0] * v[0] + v[1] * v[1]) + self.m * self.a * self.a / 6.0 * v[2] * v[2]
    }
}

/// The rows of the lower end, and their responses G = W M⁻¹ Wᵀ.
struct End {
    rows: [[f64; 3]; 2],
    response: [[f64; 2]; 2],
    masses: [f64; 3],
}

impl End {
    fn of(rod: &Rod, theta: f64) -> Self {
        let rows = [[0.0, 1.0, -rod.a * theta.cos()], [1.0, 0.0, rod.a * theta.sin()]];
        let masses = [rod.m, rod.m, rod.m * rod.a * rod.a / 3.0];
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
    fn poisson(&self, rod: &Rod, v: [f64; 3]) -> [[f64; 3]; 2] {
        let compression = self.impulses(self.rates(v), 0.0, rod.mu);
        let compressed = self.push(v, compression);
        let expansion = self.impulses(self.rates(compressed), rod.e * compression[0], rod.mu);
        [compressed, self.push(compressed, expansion)]
    }

    fn newton(&self, rod: &Rod, v: [f64; 3]) -> [f64; 3] {
        let [u, w] = self.rates(v);
        self.push(v, self.impulses([(1.0 + rod.e) * u, w], 0.0, rod.mu))
    }
}

fn distance(one: [f64; 3], other: [f64; 3]) -> f64 {
    one.iter().zip(&other).fold(0.0, |most: f64, (x, y)| most.max((x - y).abs()))
}

/// 10⁴ impacts of random rods: by hand, and without a gain of energy, which Newton's law has in some.
#[test]
fn a_rod_bounces_by_both_stages_and_gains_no_energy() {
    let mut random = Random(5);
    let [mut differ, mut sticks, mut newton_gains] = [0; 3];
    for case in 0..cases([2_000, 10_000, 100_000]) {
        let mut next = |low: f64, high: f64| random.between(low, high);
        let rod = Rod {
            m: next(0.5, 2.0),
            a: next(0.3, 1.0),
            e: next(0.0, 1.0),
            // Up to 4/3 each stage has one solution.
            mu: next(0.0, 1.3),
            floor: Contact::Open,
        };
        let theta = next(0.1, 3.0);
        let v = [next(-2.0, 2.0), next(-2.0, 2.0), next(-2.0, 2.0)];
        let end = End::of(&rod, theta);
        if end.rates(v)[0] > -1e-3 {
            continue;
        }
        let [compressed, expected] = end.poisson(&rod, v);
        let found = rod.after(theta, v);
        assert!(distance(found, expected) < 1e-12, "case {case}: {found:?} for {expected:?}");
        let before = rod.energy_at(v);
        assert!(
            rod.energy_at(found) <= before * (1.0 + 1e-14),
            "case {case}: {}",
            rod.energy_at(found) - before
        );
        let newton = end.newton(&rod, v);
        differ += usize::from(distance(newton, expected) > 1e-3);
        sticks += usize::from(end.rates(compressed)[1].abs() < 1e-12);
        newton_gains += usize::from(rod.energy_at(newton) > before * (1.0 + 1e-6));
    }
    println!("differ {differ}, stick in compression {sticks}, Newton's law would gain {newton_gains}");
    assert!(differ > 1_000 && sticks > 1_000 && newton_gains > 10, "{differ} {sticks} {newton_gains}");
}

/// With G = (a b; b c): a rod that sticks in compression with the rate −v and the velocity s along the floor takes the impulse
/// (c v + b s)/(a c − b²), and reopens at e (v + b s/c); one that slides all the way reopens at e v, as by Newton's law.
#[test]
fn a_rod_sticks_or_slides_in_compression() {
    let theta = 1.0_f64;
    for (mu, s, sticks) in [(1.2, 0.3, true), (1.2, -0.3, true), (0.05, 2.0, false), (0.05, -2.0, false)] {
        let rod = Rod { m: 2.0, a: 0.5, e: 0.6, mu, floor: Contact::Open };
        let (b, c) = (-0.75 * theta.sin() * theta.cos() * 2.0, (1.0 + 3.0 * theta.sin().powi(2)) / 2.0);
        let v = rod.after(theta, [s, -1.0, 0.0]);
        let [opens, slides] = [v[1] - 0.5 * theta.cos() * v[2], v[0] + 0.5 * theta.sin() * v[2]];
        let expected = if sticks { 0.6 * (1.0 + b * s / c) } else { 0.6 };
        assert!((opens - expected).abs() < 1e-14, "{mu}, {s}: {opens} for {expected}");
        assert_eq!(slides.abs() < 1e-15, sticks, "{mu}, {s}: {slides}");
    }
}

/// The rod without friction.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2)]
#[contact(floor: y - a*sin(theta) >= 0, restitution(newton): e)]
struct ByNewton {
    m: f64,
    a: f64,
    e: f64,
    floor: Contact,
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2)]
#[contact(floor: y - a*sin(theta) >= 0, restitution(poisson): e)]
struct ByPoisson {
    m: f64,
    a: f64,
    e: f64,
    floor: Contact,
}

#[test]
fn one_contact_without_friction_bounces_alike_by_both_laws() {
    let mut random = Random(6);
    for _ in 0..1_000 {
        let mut next = |low: f64, high: f64| random.between(low, high);
        let (m, a, e, theta) = (next(0.5, 2.0), next(0.3, 1.0), next(0.0, 1.0), next(0.1, 3.0));
        let start = State::new([0.0, a * theta.sin(), theta], [next(-2.0, 2.0), -2.0, next(-1.0, 1.0)]);
        let newton = ByNewton { m, a, e, floor: Contact::Open };
        let poisson = ByPoisson { m, a, e, floor: Contact::Open };
        let newton: [f64; 3] = newton.motion(start).with_contacts().to(1e-9).unwrap().end().v.into();
        let poisson: [f64; 3] = poisson.motion(start).with_contacts().to(1e-9).unwrap().end().v.into();
        assert!(distance(newton, poisson) < 1e-13, "{newton:?} {poisson:?}");
    }
}

/// Three balls in a row that touch.
#[derive(Clone, Lagrangian)]
#[coordinates(x: [3])]
#[lagrangian(sum(i in 0..3, m[i]/2 * x_dot[i]^2))]
#[contact(balls[i in 0..2]: x[i + 1] - x[i] >= 0, restitution(poisson): e[i])]
struct Balls {
    m: [f64; 3],
    e: [f64; 2],
    balls: [Contact; 2],
}

#[derive(Clone, Lagrangian)]
#[coordinates(x: [3])]
#[lagrangian(sum(i in 0..3, m[i]/2 * x_dot[i]^2))]
#[contact(balls[i in 0..2]: x[i + 1] - x[i] >= 0, restitution: e[i])]
struct NewtonBalls {
    m: [f64; 3],
    e: [f64; 2],
    balls: [Contact; 2],
}

#[derive(Clone, Lagrangian)]
#[coordinates(x: [3])]
#[lagrangian(sum(i in 0..3, m[i]/2 * x_dot[i]^2))]
#[contact(first: x[1] - x[0] >= 0, restitution: e[0])]
#[contact(second: x[2] - x[1] >= 0, restitution(poisson): e[1])]
struct MixedBalls {
    m: [f64; 3],
    e: [f64; 2],
    first: Contact,
    second: Contact,
}

/// Compression leaves all balls with 1/3, by impulses of 2/3 and 1/3. The second contact returns its 1/3, and the first one pushes
/// with 1/6, so that the first two stay together. By Newton's law, a contact at rest returns nothing.
#[test]
fn a_ball_hits_two_at_rest() {
    let start = State::new([1.0; 3], [1.0, 0.0, 0.0]);
    let (m, e, balls) = ([1.0; 3], [0.0, 1.0], [Contact::Open; 2]);
    let poisson: [f64; 3] =
        Balls { m, e, balls }.motion(start).with_contacts().to(1e-3).unwrap().end().v.into();
    assert!(distance(poisson, [1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0]) < 1e-15, "{poisson:?}");
    let newton: [f64; 3] =
        NewtonBalls { m, e, balls }.motion(start).with_contacts().to(1e-3).unwrap().end().v.into();
    assert!(distance(newton, [1.0 / 3.0; 3]) < 1e-15, "{newton:?}");
}

/// Without friction and with one coefficient, each impulse of expansion is e times that of compression, and so by Newton's law.
/// With several, and with both laws in one impact, no energy is gained.
#[test]
fn three_balls_gain_no_energy() {
    let mut random = Random(7);
    for case in 0..2_000 {
        let mut next = |low: f64, high: f64| random.between(low, high);
        let m = [next(0.1, 2.0), next(0.01, 2.0), next(0.1, 2.0)];
        let is_one = case % 4 == 0;
        let first = next(0.0, 1.0);
        let e = [first, if is_one { first } else { next(0.0, 1.0) }];
        let [u, w] = [next(0.0, 2.0), if case % 2 == 0 { 0.0 } else { next(0.0, 2.0) }];
        let start = State::new([1.0; 3], [u, 0.0, -w]);
        let balls = [Contact::Open; 2];
        let poisson: [f64; 3] =
            Balls { m, e, balls }.motion(start).with_contacts().to(1e-9).unwrap().end().v.into();
        let [first, second] = balls;
        let mixed = MixedBalls { m, e, first, second };
        let mixed: [f64; 3] = mixed.motion(start).with_contacts().to(1e-9).unwrap().end().v.into();
        if is_one {
            let newton: [f64; 3] =
                NewtonBalls { m, e, balls }.motion(start).with_contacts().to(1e-9).unwrap().end().v.into();
            assert!(distance(newton, poisson) < 1e-12, "case {case}: {newton:?} {poisson:?}");
        }
        let energy = |v: [f64; 3]| (0..3).map(|k| m[k] * v[k] * v[k] / 2.0).sum::<f64>();
        let before = energy(start.v.into());
        for after in [poisson, mixed] {
            assert!(energy(after) <= before * (1.0 + 1e-13), "case {case}: {}", energy(after) - before);
        }
    }
}

/// A block with two corners on the floor, of two coefficients.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[define(corner(s) = [x + s*b*cos(theta) + h*sin(theta), y + s*b*sin(theta) - h*cos(theta)])]
#[lagrangian((x_dot^2 + y_dot^2)/2 + j/2 * theta_dot^2)]
#[contact(floor[i in 0..2]: corner(2*i - 1)[1] >= 0, restitution(poisson): e[i], friction(mu): der(corner(2*i - 1))[0])]
struct Block {
    j: f64,
    b: f64,
    h: f64,
    e: [f64; 2],
    mu: f64,
    floor: [Contact; 2],
}

#[test]
fn a_block_with_two_corners_gains_no_energy() {
    let mut random = Random(8);
    for case in 0..cases([500, 2_000, 100_000]) {
        let mut next = |low: f64, high: f64| random.between(low, high);
        let (b, h) = (next(0.2, 1.0), next(0.2, 2.0));
        let block = Block {
            j: next(0.05, 1.0),
            b,
            h,
            e: [next(0.0, 1.0), next(0.0, 1.0)],
            mu: next(0.0, 1.0),
            floor: [Contact::Open; 2],
        };
        let start = State::new([0.0, h, 0.0], [next(-2.0, 2.0), -1.0, next(-1.0, 1.0) / b]);
        let path =
            block.motion(start).with_contacts().to(1e-9).unwrap_or_else(|error| panic!("{case}: {error}"));
        let energy = |state: &State<f64, _>| block.energy(state);
        let [before, after] = [energy(&start), energy(path.end())];
        assert!(after <= before * (1.0 + 1e-13), "case {case}: {}", after - before);
    }
}

/// Where the rod slides all the way, the derivatives are those of differences of motions; where it sticks, the friction is named.
#[test]
fn derivatives_where_the_rod_slides() {
    let method = Dop853::with_tolerance(1e-13);
    let end = |e: f64, mu: f64, s: f64| {
        let rod = Rod { m: 2.0, a: 0.5, e, mu, floor: Contact::Open };
        rod.motion(State::new([0.0, 1.0, 1.0], [s, -1.0, 0.2])).by(method).with_contacts().to(1.0).unwrap()
    };
    let found = end(0.6, 0.05, 2.0).sensitivity(&["e", "mu", "x_dot"], method).unwrap();
    let step = 1e-5;
    for (column, [e, mu, s]) in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].into_iter().enumerate() {
        let at = |part: f64| end(0.6 + part * e, 0.05 + part * mu, 2.0 + part * s).end().v;
        let difference = (at(step) - at(-step)) / (2.0 * step);
        let error = (difference - found.v.column(column)).amax();
        assert!(error < 1e-8, "{column}: {error:e}");
    }
    let sticks = end(0.6, 1.2, 0.2).sensitivity(&["e"], method);
    let Err(Error::NoDerivativeAcross { contact: "floor", reason, .. }) = sticks else {
        panic!("{sticks:?}")
    };
    assert!(reason.contains("sticks in an impact by Poisson's law"), "{reason}");
}

#[test]
fn time_stepping_names_the_law() {
    let rod = Rod { m: 2.0, a: 0.5, e: 0.6, mu: 0.3, floor: Contact::Open };
    let start = State::new([0.0, 1.0, 1.0], [0.0, -1.0, 0.0]);
    let path = rod.motion(start).by_time_stepping(MoreauJean::with_step(1e-2)).to(1.0);
    assert!(matches!(path, Err(Error::ImpactLaw { contact: "floor" })));
}
