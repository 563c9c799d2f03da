//! Definitions by recursion along lengths that are known when the program runs, beside the same ones written out.

use lagrange_core::System;
use lagrange_core::prelude::*;
use lagrange_random::Random;

use super::written_out::{agree, positive};

macro_rules! links {
    ($name:ident, $n:tt, $($field:tt)*) => {
        /// Links in absolute angles, with springs and dampers between them, below a pivot that is shaken.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(q: [$n])]
        #[parameter(m: [$n])]
        #[define(x[0] = a*sin(w*t) + l*sin(q[0]); y[0] = -l*cos(q[0]))]
        #[define(x[i in 1..$n] = x[i-1] + l*sin(q[i]))]
        #[define(y[i in 1..$n] = y[i-1] - l*cos(q[i]))]
        #[lagrangian(sum(i in 0..$n, m[i]/2*(der(x[i])^2 + der(y[i])^2) - m[i]*g*y[i])
            - sum(i in 1..$n, k/2*(q[i] - q[i-1])^2))]
        #[dissipation(c/2*sum(i in 1..$n, (q_dot[i] - q_dot[i-1])^2) + c/2*der(y[$n-1])^2)]
        #[force(q[$n-1]: sin(t))]
        struct $name { $($field)* l: f64, g: f64, k: f64, c: f64, a: f64, w: f64 }
    };
}

links!(Links, n, m: Vec<f64>,);
links!(Links2, 2, m: [f64; 2],);
links!(Links5, 5, m: [f64; 5],);

#[test]
fn links_below_a_pivot_that_is_shaken() {
    let mut random = Random(1);
    macro_rules! both {
        ($fixed:ident, $n:literal) => {{
            let (m, [l, g, k, c, a, w]): ([f64; $n], _) = (positive(&mut random), positive(&mut random));
            let many = Links { m: m.to_vec(), l, g, k, c, a, w };
            agree(&many, &$fixed { m, l, g, k, c, a, w }, &mut random);
        }};
    }
    both!(Links2, 2);
    both!(Links5, 5);
    const { assert!(!Links::ENERGY_IS_CONSERVED) };
}

macro_rules! arm {
    ($name:ident, $n:tt, $($field:tt)*) => {
        /// Joints that turn each link against the one before it, links that are sprung in length, on a cart.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(turn: [$n], length: [$n], u: [$n])]
        #[parameter(m: [$n]; j: [$n])]
        #[define(phi[0] = turn[0])]
        #[define(phi[i in 1..$n] = phi[i-1] + turn[i])]
        #[define(r[0] = [length[0], 0])]
        #[define(r[i in 1..$n] = r[i-1] + length[i]*[cos(phi[i]), sin(phi[i])])]
        #[lagrangian(sum(i in 0..$n, m[i]/2*dot(der(r[i]), der(r[i])) + j[i]/2*der(phi[i])^2 + b*turn_dot[i]*der(phi[i])/8
            + j[i]/4*(length_dot[i]^2 + turn_dot[i]^2) - m[i]*g*r[i][1] - k/2*dot(r[i], r[i])^2 - k*phi[i]^2/2
            + (1 + dot(r[i], r[i]))*u_dot[i]^2/2 - k/2*(u[i] - r[i][0])^2))]
        struct $name { $($field)* g: f64, k: f64, b: f64 }
    };
}

arm!(Arm, n, m: Vec<f64>, j: Vec<f64>,);
arm!(Arm2, 2, m: [f64; 2], j: [f64; 2],);
arm!(Arm4, 4, m: [f64; 4], j: [f64; 4],);

/// Two coordinates of an element, vectors, one recursion in terms of another, and forces and masses that depend on them.
#[test]
fn an_arm_whose_joints_turn_and_slide() {
    let mut random = Random(2);
    macro_rules! both {
        ($fixed:ident, $n:literal) => {{
            let [m, j]: [[f64; $n]; 2] = [positive(&mut random), positive(&mut random)];
            let [g, k, b] = positive(&mut random);
            let many = Arm { m: m.to_vec(), j: j.to_vec(), g, k, b };
            agree::<{ 3 * $n }>(&many, &$fixed { m, j, g, k, b }, &mut random);
        }};
    }
    both!(Arm2, 2);
    both!(Arm4, 4);
}

/// Rods in space that hang from one another as a table says.
#[derive(lagrange_core::Lagrangian)]
#[coordinates(angle: [n, 2])]
#[parameter(m: [n]; parent: [n])]
#[define(along(a) = l*[sin(a[0])*cos(a[1]), sin(a[0])*sin(a[1]), -cos(a[0])])]
#[define(r[0] = along(angle[0]))]
#[define(r[i in 1..n] = r[parent[i]] + along(angle[i]))]
#[lagrangian(sum(i in 0..n, m[i]/2*dot(der(r[i]), der(r[i])) - m[i]*g*r[i][2] - k*r[i][0]^4))]
#[observable(moment = sum(i in 0..n, m[i]*cross(r[i], der(r[i]))))]
struct Tree {
    m: Vec<f64>,
    parent: Vec<usize>,
    l: f64,
    g: f64,
    k: f64,
}

#[derive(lagrange_core::Lagrangian)]
#[coordinates(angle: [5, 2])]
#[define(along(a) = l*[sin(a[0])*cos(a[1]), sin(a[0])*sin(a[1]), -cos(a[0])])]
#[define(r[0] = along(angle[0]); r[1] = r[0] + along(angle[1]); r[2] = r[0] + along(angle[2]))]
#[define(r[3] = r[1] + along(angle[3]); r[4] = r[1] + along(angle[4]))]
#[lagrangian(sum(i in 0..5, m[i]/2*dot(der(r[i]), der(r[i])) - m[i]*g*r[i][2] - k*r[i][0]^4))]
#[observable(moment = sum(i in 0..5, m[i]*cross(r[i], der(r[i]))))]
struct Tree5 {
    m: [f64; 5],
    l: f64,
    g: f64,
    k: f64,
}

#[test]
fn a_tree_by_its_table() {
    let mut random = Random(3);
    let (m, [l, g, k]): ([f64; 5], _) = (positive(&mut random), positive(&mut random));
    let many = Tree { m: m.to_vec(), parent: vec![0, 0, 0, 1, 1], l, g, k };
    let fixed = Tree5 { m, l, g, k };
    agree::<10>(&many, &fixed, &mut random);
    let (q, v): ([f64; 10], [f64; 10]) = (positive(&mut random), positive(&mut random));
    let difference = many.moment(&many.state(q, v)) - fixed.moment(&State::new(q, v));
    assert!(difference.amax() < 1e-14);
    let astray = Tree { parent: vec![0, 0, 2, 1, 1], ..many };
    let told = "entry 2 of `parent` is 2, and there are 2: indices, like entries, count from 0";
    assert_eq!(astray.check().unwrap_err().to_string(), told);
}

/// A cart that carries a chain, whose first coordinate is a place: a step of its own kind.
#[derive(lagrange_core::Lagrangian)]
#[coordinates(q: [n])]
#[define(x[0] = q[0]; y[0] = 0)]
#[define(x[i in 1..n] = x[i-1] + l*sin(q[i]); y[i in 1..n] = y[i-1] - l*cos(q[i]))]
#[lagrangian(sum(i in 0..n, m/2*(der(x[i])^2 + der(y[i])^2) - m*g*y[i]))]
struct OnACart {
    n: usize,
    m: f64,
    l: f64,
    g: f64,
}

#[derive(lagrange_core::Lagrangian)]
#[coordinates(q: [3])]
#[define(x = [q[0], q[0] + l*sin(q[1]), q[0] + l*sin(q[1]) + l*sin(q[2])])]
#[define(y = [0, -l*cos(q[1]), -l*cos(q[1]) - l*cos(q[2])])]
#[lagrangian(sum(i in 0..3, m/2*(der(x[i])^2 + der(y[i])^2) - m*g*y[i]))]
struct OnACart3 {
    m: f64,
    l: f64,
    g: f64,
}

#[test]
fn a_chain_on_a_cart() {
    let [m, l, g] = [1.5, 0.7, 9.81];
    agree::<3>(&OnACart { n: 3, m, l, g }, &OnACart3 { m, l, g }, &mut Random(4));
    let [alone, none] = [1, 0].map(|n| OnACart { n, m, l, g });
    let mut a = [1.0];
    alone.accelerations(0.0, &[0.3], &[2.0], &mut a);
    assert_eq!((a, alone.energy(&alone.state([0.3], [2.0]))), ([0.0], 3.0));
    assert!(none.check().unwrap_err().to_string().starts_with("`q[0]` does not exist"));
}

/// Small oscillations of a hanging chain of n equal links about its rest: ω² = (g/l) x with the zeros x of Laguerre's polynomial L_n
/// (Daniel Bernoulli, 1733).
#[test]
fn a_hanging_chain_swings_by_the_zeros_of_a_laguerre_polynomial() {
    // Smallest zero of L_10 (Salzer and Zucker, Bulletin of the American Mathematical Society 55, 1949).
    let x = 0.137_793_470_540_492;
    let laguerre = |k: usize| {
        let next = |[before, own]: [f64; 2], j: usize| {
            let j = j as f64;
            [own, ((2.0 * j + 1.0 - x) * own - j * before) / (j + 1.0)]
        };
        (0..k).fold([0.0, 1.0], next)[1]
    };
    // Mass k above the free end is displaced by L_k(x).
    let (chain, small) = (Held { n: 10, l: 0.5, g: 2.0 }, 1e-6);
    let angle = |i: usize| (laguerre(9 - i) - laguerre(10 - i)) * small / chain.l;
    let start = chain.at_rest((0..10).map(angle));
    let mut a = vec![0.0; 10];
    chain.accelerations(0.0, start.q.as_slice(), start.v.as_slice(), &mut a);
    for (a, q) in a.iter().zip(&start.q) {
        let expected = -chain.g / chain.l * x * q;
        assert!((a - expected).abs() < 1e-10 * small, "{a}, not {expected}");
    }
}

/// Links of mass one below a point at rest.
#[derive(lagrange_core::Lagrangian)]
#[coordinates(q: [n])]
#[define(x[0] = l*sin(q[0]); y[0] = -l*cos(q[0]))]
#[define(x[i in 1..n] = x[i-1] + l*sin(q[i]); y[i in 1..n] = y[i-1] - l*cos(q[i]))]
#[lagrangian(sum(i in 0..n, (der(x[i])^2 + der(y[i])^2)/2 - g*y[i]))]
struct Held {
    n: usize,
    l: f64,
    g: f64,
}

#[test]
fn a_long_chain_keeps_its_energy() {
    let chain = Held { n: 100, l: 0.1, g: 9.81 };
    let start = chain.at_rest((0..100).map(|i| 0.5 + 0.01 * f64::from(i)));
    let path = chain.integrate(start.clone(), 1.0, Dop853::with_tolerance(1e-10)).expect("a motion");
    let (before, after) = (chain.energy(&start), path.end().energy());
    assert!((after - before).abs() < 1e-7 * before.abs(), "{before} to {after}");
    const { assert!(Held::ENERGY_IS_CONSERVED) };
}

/// Where a straight link without mass takes up no force along it, nothing determines its acceleration.
#[test]
fn an_element_without_inertia_is_named() {
    let mut chain = Links { m: vec![1.0, 0.0, 1.0], l: 1.0, g: 1.0, k: 1.0, c: 0.0, a: 0.0, w: 0.0 };
    let bent = chain.at_rest([0.3, 0.5, 1.1]);
    assert!(chain.integrate(bent, 0.1, Dop853::default()).is_ok());
    let straight = chain.at_rest([0.3; 3]);
    let error = chain.integrate(straight.clone(), 0.1, Dop853::default()).unwrap_err().to_string();
    assert!(error.contains("q[1]"), "{error}");
    chain.m = vec![1.0, 1.0, 0.0];
    let error = chain.integrate(straight, 0.1, Dop853::default()).unwrap_err().to_string();
    assert!(error.contains("q[2]"), "{error}");
}

macro_rules! signs {
    ($name:ident, $n:tt, $($field:tt)*) => {
        /// Masses of both signs: what is left of a pivot may have another sign than the whole.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(q: [$n])]
        #[define(x[0] = q[0])]
        #[define(x[i in 1..$n] = x[i-1] + q[i])]
        #[lagrangian(sum(i in 0..$n, der(x[i])^2/2 - k*q_dot[i]^2 - cos(x[i])))]
        struct $name { $($field)* k: f64 }
    };
}

signs!(Signs, n, n: usize,);
signs!(Signs2, 2,);

#[test]
fn masses_of_both_signs() {
    let (q, v) = ([0.5, 1.25], [0.75, -0.5]);
    let mut a = [f64::NAN; 2];
    Signs { n: 2, k: 1.2 }.accelerations(0.0, &q, &v, &mut a);
    let expected = Signs2 { k: 1.2 }.solve(&State::new(q, v)).expect("a regular mass matrix").accelerations;
    assert!(
        a.iter().zip(&expected).all(|(a, expected)| (a - expected).abs() < 1e-14 * expected.abs()),
        "{a:?}, not {expected}"
    );
}

/// Any number type, a length that is a const generic, and names that the emitted code uses, too.
#[derive(lagrange_core::Lagrangian)]
#[coordinates(pivot: [N])]
#[parameter(element: [N])]
#[define(rows[0] = element[0]*sin(pivot[0]); whole[0] = -element[0]*cos(pivot[0]))]
#[define(rows[i in 1..N] = rows[i-1] + element[i]*sin(pivot[i]); whole[i in 1..N] = whole[i-1] - element[i]*cos(pivot[i]))]
#[lagrangian(sum(i in 0..N, (der(rows[i])^2 + der(whole[i])^2)/2 - memory*whole[i]))]
struct Generic<T, const N: usize> {
    element: Vec<T>,
    memory: T,
}

#[test]
fn any_number_type() {
    let (q, v) = ([0.5, 0.25, -0.75], [1.0, -0.5, 0.25]);
    let double = Generic::<f64, 3> { element: vec![1.0; 3], memory: 9.75 };
    let single = Generic::<f32, 3> { element: vec![1.0; 3], memory: 9.75 };
    let mut a = [0.0; 3];
    double.accelerations(0.0, &q, &v, &mut a);
    let (q_single, v_single, mut a_single) = (q.map(|q| q as f32), v.map(|v| v as f32), [0.0; 3]);
    single.accelerations(0.0, &q_single, &v_single, &mut a_single);
    assert!(
        a.iter().zip(a_single).all(|(a, single)| (a - f64::from(single)).abs() < 1e-5),
        "{a:?}, {a_single:?}"
    );
    let energies =
        [double.energy(&double.state(q, v)), single.energy(&single.state(q_single, v_single)).into()];
    assert!((energies[0] - energies[1]).abs() < 1e-5, "{energies:?}");
}
