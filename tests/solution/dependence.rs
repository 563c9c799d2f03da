//! Constraints that depend on one another to first order alone are refused, and no others, by an adversary who knows which is which.
//!
//! A failure says the number of its case.

use std::fmt::Debug;

use lagrange_core::nalgebra::Vector3;
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
pub(crate) struct Beads {
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
pub(crate) struct Points {
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
    cases([40, 300, 30_000]) as u64
}

fn vector(random: &mut Random, most: f64) -> Vector3<f64> {
    Vector3::from(random.vector()) * most
}

/// The constraints that are said to depend on one another, as they are printed.
fn names<T>(found: &Result<T, Error>) -> Option<String> {
    match found {
        Err(Error::DependentToFirstOrder { constraints, .. }) => Some(constraints.to_string()),
        _ => None,
    }
}

/// Beads on their rod, which may turn in the vertical plane of the guide.
pub(crate) fn beads(random: &mut Random) -> (Beads, State<f64, 6>) {
    let scale = random.size(0.1, 1e3);
    let [k, l] = [random.size(0.1, 10.0) * scale, random.size(0.1, 10.0) * scale];
    let [m, n] = [random.size(1e-2, 1e2), random.size(1e-2, 1e2)];
    let e = vector(random, 1.0).normalize();
    let beads = Beads { m, n, g: random.between(0.0, 20.0), k, l, s: e[1].atan2(e[0]) };
    let at = |e: Vector3<f64>| -> [f64; 6] {
        std::array::from_fn(|i| if i < 3 { k * e[i] } else { (k + l) * e[i - 3] })
    };
    let turn = e.cross(&Vector3::z()).cross(&e) * random.one_of(&[0.0, 1.0]);
    (beads, State::new(at(e), at(turn)))
}

#[track_caller]
pub(crate) fn is_refused<T: Debug>(case: u64, found: &Result<T, Error>, all: &str) {
    assert!(names(found).is_some_and(|names| names.starts_with(all)), "case {case}: {found:?}");
}

pub(crate) const ALL_LENGTHS: &str = "`upper`, `lower`, `whole`";
pub(crate) const ALL_DISTANCES: &str = "`ab`, `ac`, `ad`, `bc` and 2 more";

#[test]
fn beads_on_a_rod_by_three_lengths_are_refused() {
    for case in 0..count() {
        let random = &mut Random(case);
        let (beads, state) = beads(random);
        is_refused(case, &beads.solve(&state), ALL_LENGTHS);
        // Projected, it is off by the root of round-off.
        let rough = State::at_rest(state.q.map(|q| q * (1.0 + 1e-3 * random.number())));
        match beads.make_consistent(&rough) {
            Err(Error::NotProjected { .. }) => {}
            projected => {
                is_refused(case, &projected.and_then(|(near, _)| beads.solve(&near)), ALL_LENGTHS);
            }
        }
    }
}

/// Four points and their squared distances; in a plane, or not.
pub(crate) fn points(random: &mut Random, flat: bool) -> (Points, State<f64, 12>) {
    let scale = random.size(1e-3, 1e3);
    let e = vector(random, 1.0).normalize();
    let f = e.cross(&vector(random, 1.0)).normalize();
    let n = e.cross(&f);
    let spread: [[f64; 3]; 4] = std::array::from_fn(|i| {
        let [x, y] = [[0.0, 0.0], [1.0, 0.1], [0.9, 1.2], [-0.2, 0.8]][i];
        [x + random.between(-0.2, 0.2), y + random.between(-0.2, 0.2), [0.0, 0.0, 0.0, 0.7][i]]
    });
    let centre = vector(random, 1.0);
    let height = if flat { 0.0 } else { 1.0 };
    let p = spread.map(|[x, y, z]| scale * (centre + x * e + y * f + height * z * n));
    let s = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
        .map(|(i, j): (usize, usize)| (p[i] - p[j]).norm_squared());
    let m = std::array::from_fn(|_| random.size(1e-2, 1e2));
    let (omega, moves) = (vector(random, 1.0), vector(random, scale));
    let rate = random.one_of(&[0.0, 1.0]);
    let v: [f64; 12] = std::array::from_fn(|i| rate * (moves + omega.cross(&p[i / 3]))[i % 3]);
    let q: [f64; 12] = std::array::from_fn(|i| p[i / 3][i % 3]);
    (Points { m, g: random.between(0.0, 20.0), s }, State::new(q, v))
}

#[test]
fn a_plate_by_all_distances_of_four_points_is_refused() {
    for case in 0..count() {
        let (plate, state) = points(&mut Random(case), true);
        is_refused(case, &plate.solve(&state), ALL_DISTANCES);
    }
}

#[track_caller]
fn is_let_pass<T>(case: u64, found: &Result<T, Error>) {
    assert!(names(found).is_none(), "case {case}: {:?}", found.as_ref().err());
}

#[test]
fn all_others_are_let_pass() {
    for case in 0..count() {
        let random = &mut Random(case);
        let (body, state) = points(random, false);
        is_let_pass(case, &body.solve(&state));

        let (l, s) = (random.size(1e-2, 1e2), std::array::from_fn(|_| random.between(-3.0, 3.0)));
        let table = Table { m: random.size(1e-2, 1e2), i: random.size(1e-2, 1e2), g: 9.81, l, s };
        let (turn, rate) = (random.between(0.1, 3.0), random.one_of(&[0.0, 1.0]));
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
        let (m, reach) = (random.size(1e-2, 1e2), k * off.cos() + 2.0 * k * q.cos());
        let links = Links { m, g: 9.81, k, l: 2.0 * k, reach };
        is_let_pass(case, &links.solve(&State::at_rest([off, q])));
    }
}
