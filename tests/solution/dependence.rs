//! Constraints that depend on one another to first order alone are refused, and no others, by an adversary who knows which is which.
//!
//! A failure says the number of its case.

use lagrange_core::prelude::*;
use lagrange_random::{Random, cases};

/// Two beads on a straight rod that hangs at the origin, by three lengths, of which the third is the sum of the others.
#[derive(Lagrangian)]
#[coordinates(a: [3], b: [3])]
#[lagrangian(m/2*dot(a_dot, a_dot) + n/2*dot(b_dot, b_dot) - g*(m*a[2] + n*b[2]))]
#[constraint(upper: dot(a, a) = k^2)]
#[constraint(lower: dot(b - a, b - a) = l^2)]
#[constraint(whole: dot(b, b) = (k + l)^2)]
#[constraint(guide: a[1]*cos(s) = a[0]*sin(s))]
struct Beads {
    m: f64,
    n: f64,
    g: f64,
    k: f64,
    l: f64,
    s: f64,
}

/// Four points with all of their distances.
#[derive(Lagrangian)]
#[coordinates(a: [3], b: [3], c: [3], d: [3])]
#[lagrangian(
    m[0]/2*dot(a_dot, a_dot) + m[1]/2*dot(b_dot, b_dot) + m[2]/2*dot(c_dot, c_dot) + m[3]/2*dot(d_dot, d_dot)
    - g*(m[0]*a[2] + m[1]*b[2] + m[2]*c[2] + m[3]*d[2])
)]
#[constraint(ab: dot(a - b, a - b) = s[0])]
#[constraint(ac: dot(a - c, a - c) = s[1])]
#[constraint(ad: dot(a - d, a - d) = s[2])]
#[constraint(bc: dot(b - c, b - c) = s[3])]
#[constraint(bd: dot(b - d, b - d) = s[4])]
#[constraint(cd: dot(c - d, c - d) = s[5])]
struct Points {
    m: [f64; 4],
    g: f64,
    s: [f64; 6],
}

/// A table that `legs` parallel cranks carry, of which two would do.
#[derive(Lagrangian)]
#[coordinates(x, y, th)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + i/2*th_dot^2 - m*g*y)]
#[constraint(legs[j in 0..4]: (x + s[j]*cos(th) - s[j])^2 + (y + s[j]*sin(th))^2 = l^2)]
struct Table {
    m: f64,
    i: f64,
    g: f64,
    l: f64,
    s: [f64; 4],
}

/// A sphere said twice, and planes that are next to dependent.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
#[constraint(sphere: x^2 + y^2 + z^2 = l^2)]
#[constraint(again: (x^2 + y^2 + z^2 - l^2)*(2 + sin(x*y)) = 0)]
#[constraint(plane: x*cos(e) = y*sin(e)*(1 + d))]
#[constraint(plane_again: x*cos(e) = y*sin(e))]
struct Twice {
    m: f64,
    g: f64,
    l: f64,
    e: f64,
    d: f64,
}

/// Two links and a slider on a straight guide, whose second pose of one line is singular.
#[derive(Lagrangian)]
#[coordinates(p, q)]
#[lagrangian(m*k^2/2*p_dot^2 + m*l^2/2*q_dot^2 - m*g*k*sin(p))]
#[constraint(guide: k*sin(p) + l*sin(q) = 0)]
#[constraint(stop: k*cos(p) + l*cos(q) = reach)]
struct Links {
    m: f64,
    g: f64,
    k: f64,
    l: f64,
    reach: f64,
}

/// Cases of each kind.
fn count() -> u64 {
    cases([100, 300, 30_000]) as u64
}

fn vector(random: &mut Random, most: f64) -> [f64; 3] {
    std::array::from_fn(|_| random.between(-most, most))
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let size = a.iter().map(|x| x * x).sum::<f64>().sqrt();
    a.map(|x| x / size)
}

/// The constraints that are said to depend on one another, as they are printed.
fn names<T>(found: &Result<T, Error>) -> Option<String> {
    match found {
        Err(Error::DependentToFirstOrder { constraints, .. }) => Some(constraints.to_string()),
        _ => None,
    }
}

#[test]
fn beads_on_a_rod_by_three_lengths_are_refused() {
    for case in 0..count() {
        let random = &mut Random(case);
        let scale = random.size(0.1, 1e3);
        let [k, l] = [random.size(0.1, 10.0) * scale, random.size(0.1, 10.0) * scale];
        let [m, n] = [random.size(1e-2, 1e2), random.size(1e-2, 1e2)];
        let e = unit(vector(random, 1.0));
        let beads = Beads { m, n, g: random.between(0.0, 20.0), k, l, s: e[1].atan2(e[0]) };
        let at = |e: [f64; 3]| -> [f64; 6] {
            std::array::from_fn(|i| if i < 3 { k * e[i] } else { (k + l) * e[i - 3] })
        };
        // It may turn in the vertical plane of the guide.
        let rate = [0.0, 1.0][random.below(2)];
        let turn = cross(cross(e, [0.0, 0.0, 1.0]), e).map(|x| x * rate);
        let state = State::new(at(e), at(turn));
        let rough = State::at_rest(state.q.map(|q| q * (1.0 + 1e-3 * random.between(-1.0, 1.0))));
        let found = [
            beads.solve(&state).map(drop),
            beads.integrate(state, 1.0, Dop853::default()).map(drop),
            beads.integrate(state, 1.0, Taylor::default()).map(drop),
            // Projected, it is off by the root of round-off.
            beads.make_consistent(&rough).and_then(|(near, _)| beads.solve(&near)).map(drop),
        ];
        for (how, found) in found.iter().enumerate() {
            if how == 3 && matches!(found, Err(Error::NotProjected { .. })) {
                continue;
            }
            let all = names(found).is_some_and(|names| names.starts_with("`upper`, `lower`, `whole`"));
            assert!(all, "case {case}, {how}: {found:?} at {state}");
        }
    }
}

/// Four points and their squared distances; in a plane, or not.
fn points(random: &mut Random, flat: bool) -> (Points, State<f64, 12>) {
    let scale = random.size(1e-3, 1e3);
    let e = unit(vector(random, 1.0));
    let f = unit(cross(e, vector(random, 1.0)));
    let n = cross(e, f);
    let spread: [[f64; 3]; 4] = std::array::from_fn(|i| {
        let [x, y] = [[0.0, 0.0], [1.0, 0.1], [0.9, 1.2], [-0.2, 0.8]][i];
        [x + random.between(-0.2, 0.2), y + random.between(-0.2, 0.2), [0.0, 0.0, 0.0, 0.7][i]]
    });
    let centre = vector(random, 1.0);
    let p: [[f64; 3]; 4] = spread.map(|[x, y, z]| {
        let z = if flat { 0.0 } else { z };
        std::array::from_fn(|i| scale * (centre[i] + x * e[i] + y * f[i] + z * n[i]))
    });
    let distance = |i: usize, j: usize| (0..3).map(|k| (p[i][k] - p[j][k]).powi(2)).sum::<f64>();
    let s = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)].map(|(i, j)| distance(i, j));
    let m = std::array::from_fn(|_| random.size(1e-2, 1e2));
    let (omega, moves) = (vector(random, 1.0), vector(random, scale));
    let rate = [0.0, 1.0][random.below(2)];
    let v: [f64; 12] = std::array::from_fn(|i| rate * (moves[i % 3] + cross(omega, p[i / 3])[i % 3]));
    let q: [f64; 12] = std::array::from_fn(|i| p[i / 3][i % 3]);
    (Points { m, g: random.between(0.0, 20.0), s }, State::new(q, v))
}

#[test]
fn a_plate_by_all_distances_of_four_points_is_refused() {
    for case in 0..count() {
        let (plate, state) = points(&mut Random(case), true);
        let found = [plate.solve(&state).map(drop), plate.integrate(state, 1.0, Dop853::default()).map(drop)];
        for found in &found {
            let all = names(found).is_some_and(|names| names == "`ab`, `ac`, `ad`, `bc` and 2 more");
            assert!(all, "case {case}: {found:?} at {state}");
        }
    }
}

#[track_caller]
fn is_let_pass<T>(case: u64, found: &Result<T, Error>) {
    assert!(
        !matches!(found, Err(Error::DependentToFirstOrder { .. })),
        "case {case}: {:?}",
        found.as_ref().err()
    );
}

#[test]
fn all_others_are_let_pass() {
    for case in 0..count() {
        let random = &mut Random(case);
        let (body, state) = points(random, false);
        is_let_pass(case, &body.solve(&state));

        let (l, s) = (random.size(1e-2, 1e2), std::array::from_fn(|_| random.between(-3.0, 3.0)));
        let table = Table { m: random.size(1e-2, 1e2), i: random.size(1e-2, 1e2), g: 9.81, l, s };
        let (turn, rate) = (random.between(0.1, 3.0), [0.0, 1.0][random.below(2)]);
        let (sine, cosine) = turn.sin_cos();
        let state = State::new([l * cosine, l * sine, 0.0], [-rate * l * sine, rate * l * cosine, 0.0]);
        let solved = table.solve(&state);
        is_let_pass(case, &solved);
        assert!(!solved.expect("a table that moves").multipliers_are_unique(), "case {case}");

        let d = [0.0, random.size(1e-15, 1.0)][random.below(2)];
        let e = random.between(0.1, 1.4);
        let twice = Twice { m: random.size(1e-2, 1e2), g: 9.81, l, e, d };
        let (height, side) = (random.between(-1.0, 1.0), [1.0, 0.0][usize::from(d > 0.0)]);
        let across = side * l * (1.0 - height * height).sqrt();
        let z = if side == 0.0 { l } else { l * height };
        is_let_pass(case, &twice.solve(&State::at_rest([across * e.sin(), across * e.cos(), z])));

        // The nearer to the pose of one line, the shorter is what is left of a row.
        let (k, off) = (random.size(1e-1, 1e1), random.size(1e-4, 1.0));
        let q = -(k / (2.0 * k) * off.sin()).asin();
        let links = Links {
            m: random.size(1e-2, 1e2),
            g: 9.81,
            k,
            l: 2.0 * k,
            reach: k * off.cos() + 2.0 * k * q.cos(),
        };
        is_let_pass(case, &links.solve(&State::at_rest([off, q])));
    }
}
