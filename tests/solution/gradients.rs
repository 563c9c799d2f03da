//! Constraints whose gradient vanishes where they hold are refused, and no others, by an adversary who knows which is which.
//!
//! A failure says the number of its case.

use std::f64::consts::PI;

use lagrange_core::error::Row;
use lagrange_core::nalgebra::Vector3;
use lagrange_core::prelude::*;
use lagrange_random::{Random, cases};

/// A holonomic constraint of three coordinates.
macro_rules! constrained {
    ($(#[doc = $doc:literal])* $name:ident: $($constraint:tt)*) => {
        $(#[doc = $doc])*
        #[derive(Lagrangian)]
        #[coordinates(x, y, z)]
        #[lagrangian((x_dot^2 + 2*y_dot^2 + 3*z_dot^2 + x_dot*y_dot)/2 - g*(x + 2*y))]
        #[constraint(c: $($constraint)*)]
        #[allow(dead_code, reason = "not every constraint has all of them")]
        struct $name {
            g: f64,
            a: [f64; 3],
            l: f64,
            k: f64,
        }
    };
}
constrained!(Cosine: cos(a[0]*x + a[1]*y + a[2]*z - l) = 1);
constrained!(Sine: sin(a[0]*x + a[1]*y + a[2]*z - l) = 0);
constrained!(SquaredPlane: k*(a[0]*x + a[1]*y + a[2]*z - l)^2 = 0);
constrained!(Plane: k*(a[0]*x + a[1]*y + a[2]*z - l) = 0);
constrained!(SquaredSphere: k*((x - a[0])^2 + (y - a[1])^2 + (z - a[2])^2 - l^2)^2 = 0);
constrained!(Sphere: k*((x - a[0])^2 + (y - a[1])^2 + (z - a[2])^2 - l^2) = 0);
constrained!(Level: y = l - l*cos(x/l));
constrained!(Slope: cos(a[0]*x) = k);

/// Three links that turn about y, of which the last must point along x.
#[derive(Lagrangian)]
#[coordinates(p: [3])]
#[frame(u[0]: rotate_y(p[0]), translate([l[0], 0, 0]))]
#[frame(u[1] in u[0]: rotate_y(p[1]), translate([l[1], 0, 0]))]
#[frame(u[2] in u[1]: rotate_y(p[2]), translate([l[2], 0, 0]))]
#[lagrangian(sum(k in 0..3, m/2*norm(velocity(u[k]))^2))]
#[constraint(c: express(vector(u[2], [1, 0, 0]), fixed)[0] = 1)]
struct Links {
    l: [f64; 3],
    m: f64,
}

/// Cases of each kind.
fn count() -> u64 {
    cases([40, 300, 30_000]) as u64
}

/// A number of either sign and any size from 0.001 to 1,000, or now and then zero.
fn number(random: &mut Random) -> f64 {
    random.one_of(&[-1.0, 1.0, -1.0, 1.0, 0.0]) * random.size(1e-3, 1e3)
}

fn coefficients(random: &mut Random) -> [f64; 3] {
    std::array::from_fn(|_| random.one_of(&[-1.0, 1.0]) * random.size(0.1, 10.0))
}

/// A point on a·q = l to round-off, and a velocity in the plane, or none.
fn in_plane(random: &mut Random, a: [f64; 3], l: f64) -> State<f64, 3> {
    let solved = |[x, y]: [f64; 2], l: f64| [x, y, (l - a[0] * x - a[1] * y) / a[2]];
    let q = solved([number(random), number(random)], l);
    let v = if random.below(2) == 0 { [0.0; 3] } else { solved([number(random), number(random)], 0.0) };
    State::new(q, v)
}

/// The same on the sphere about `a` of radius `l`; now and then one whose coordinates are those of the centre, but for one.
fn on_sphere(random: &mut Random, a: [f64; 3], l: f64) -> State<f64, 3> {
    let mut n = Vector3::from(coefficients(random)).map(|x| if x.abs() < 0.3 { 0.0 } else { x });
    if n.amax() == 0.0 {
        n[random.below(3)] = 1.0;
    }
    n.normalize_mut();
    let across = n.cross(&Vector3::from(coefficients(random)));
    let q: [f64; 3] = std::array::from_fn(|i| a[i] + l * n[i]);
    State::new(q, if random.below(2) == 0 { [0.0; 3] } else { across.into() })
}

/// Whether no coordinate is so small beside what is taken from it that a difference is rounded by more than the coordinate's own
/// round-off tells.
fn is_told(state: &State<f64, 3>, a: [f64; 3], l: f64) -> bool {
    (0..3).all(|i| state.q[i].abs() >= 1e-3 * (a[i].abs() + l))
}

fn is_without_gradient<T>(found: &Result<T, Error>) -> bool {
    matches!(found, Err(Error::NoGradient { constraint: Row::Constraint("c"), .. }))
}

#[test]
fn constraints_without_a_gradient_are_refused() {
    for case in 0..count() {
        let random = &mut Random(case);
        let (a, k, turns) = (coefficients(random), random.size(1e-9, 1e9), random.below(40) as f64 - 20.0);
        let (l, radius) = (number(random), random.size(1e-3, 1e3));
        let plane = in_plane(random, a, l);
        let angle = in_plane(random, a, l + 2.0 * PI * turns);
        let sphere = on_sphere(random, a, radius);
        if !is_told(&sphere, a, radius) {
            continue;
        }
        let g = 9.81;
        let of_angle = Cosine { g, a, l, k };
        let of_plane = SquaredPlane { g, a, l, k };
        let of_sphere = SquaredSphere { g, a, l: radius, k };
        let found = [
            of_angle.check_consistent(&angle),
            of_plane.check_consistent(&plane),
            of_sphere.check_consistent(&sphere),
            of_sphere.make_consistent(&sphere).map(drop),
        ];
        for (kind, found) in found.into_iter().enumerate() {
            assert!(is_without_gradient(&found), "case {case}, {kind}: {found:?} of {a:?}, {l}, {k}");
        }
        let [p, q] = [random.between(-3.0, 3.0), random.between(-3.0, 3.0)];
        let [s, t] = [number(random), number(random)];
        let links = Links { l: coefficients(random), m: 2.0 };
        let found = links.check_consistent(&State::new([p, q, -p - q], [s, t, -s - t]));
        assert!(is_without_gradient(&found), "case {case}: {found:?} of links at {p}, {q}");
    }
}

/// Whatever else may be wrong, as a state that round-off of a large centre leaves off a small sphere.
#[track_caller]
fn has_gradient<T>(case: u64, found: &Result<T, Error>) {
    assert!(!is_without_gradient(found), "case {case}");
}

#[test]
fn all_others_are_let_pass() {
    for case in 0..count() {
        let random = &mut Random(case);
        let (a, turns) = (coefficients(random), random.below(1_000_000) as f64);
        let k = [0.0, random.size(1e-200, 1e200), random.size(1e-9, 1e9)][random.below(3)];
        let (l, radius) = (number(random), random.size(1e-9, 1e9));
        let g = 9.81;
        let angle = in_plane(random, a, l + 2.0 * PI * turns);
        has_gradient(case, &Sine { g, a, l, k }.check_consistent(&angle));
        let plane = in_plane(random, a, l);
        has_gradient(case, &Plane { g, a, l, k }.check_consistent(&plane));
        let centre = a.map(|a| a * radius * [0.0, 1e-3, 1.0, 1e6][random.below(4)]);
        let sphere = on_sphere(random, centre, radius);
        has_gradient(case, &Sphere { g, a: centre, l: radius, k }.check_consistent(&sphere));
        let level = State::at_rest([0.0, 0.0, number(random)]);
        has_gradient(case, &Level { g, a, l: radius, k }.check_consistent(&level));
        // The nearer the cosine to 1, the smaller its slope, which is felt as long as the angle is.
        let x = (1.0 - random.size(1e-12, 1.0)).acos() + 2.0 * PI * random.below(100) as f64;
        let slope = Slope { g, a: [1.0; 3], l, k: x.cos() };
        has_gradient(case, &slope.check_consistent(&State::at_rest([x, 0.0, 0.0])));
    }
}
