//! Accelerations of systems of any number of bodies, against loops by hand, and few bodies against a length that is a literal.
//!
//! `cargo bench -p lagrange-benches --bench many_bodies`
//!
//! Both are timed in turn; the medians count.

use std::cell::RefCell;
use std::hint::black_box;
use std::time::Instant;

use lagrange_core::nalgebra::{Const, Dyn};
use lagrange_core::{System, prelude::*};

const ROUNDS: usize = 21;

/// Fermi, Pasta, Ulam and Tsingou's chain between walls.
#[derive(Lagrangian)]
#[coordinates(x: [n])]
#[define(U(d) = d^2/2 + beta*d^4/4)]
#[lagrangian(sum(i in 0..n, x_dot[i]^2/2) - U(x[0]) - U(x[n-1]) - sum(i in 0..n-1, U(x[i+1] - x[i])))]
struct Chain {
    n: usize,
    beta: f64,
}

fn chain(Chain { beta, .. }: &Chain, x: &[f64], a: &mut [f64]) {
    let pull = |d: f64| d + beta * d * d * d;
    let mut from_left = pull(x[0]);
    for (a, pair) in a.iter_mut().zip(x.windows(2)) {
        let from_right = pull(pair[1] - pair[0]);
        *a = from_right - from_left;
        from_left = from_right;
    }
    let last = x.len() - 1;
    a[last] = pull(-x[last]) - from_left;
}

/// Toda's chain with free ends.
#[derive(Lagrangian)]
#[coordinates(x: [n])]
#[parameter(m: [n])]
#[lagrangian(sum(i in 0..n, m[i]*x_dot[i]^2/2) - sum(i in 0..n-1, exp(x[i+1] - x[i])))]
struct Toda {
    n: usize,
    m: Vec<f64>,
}

fn toda(Toda { m, .. }: &Toda, x: &[f64], a: &mut [f64]) {
    let mut from_left = 0.0;
    for ((a, pair), m) in a.iter_mut().zip(x.windows(2)).zip(m) {
        let from_right = (pair[1] - pair[0]).exp();
        *a = (from_right - from_left) / m;
        from_left = from_right;
    }
    let last = x.len() - 1;
    a[last] = -from_left / m[last];
}

/// Bodies that attract one another.
#[derive(Lagrangian)]
#[coordinates(r: [n, 3])]
#[parameter(m: [n])]
#[lagrangian(sum(i in 0..n, m[i]/2*dot(r_dot[i], r_dot[i])) + sum(i in 0..n, sum(j in 0..i, gamma*m[i]*m[j]/norm(r[i] - r[j]))))]
struct Cluster {
    m: Vec<f64>,
    gamma: f64,
}

fn cluster(Cluster { m, gamma }: &Cluster, r: &[f64], a: &mut [f64]) {
    let r = r.as_chunks::<3>().0;
    let a = a.as_chunks_mut::<3>().0;
    a.fill([0.0; 3]);
    for i in 0..r.len() {
        let mut own = [0.0; 3];
        for j in 0..i {
            let d = [r[j][0] - r[i][0], r[j][1] - r[i][1], r[j][2] - r[i][2]];
            let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            let factor = gamma / (square * square.sqrt());
            for c in 0..3 {
                own[c] += m[j] * factor * d[c];
                a[j][c] -= m[i] * factor * d[c];
            }
        }
        for c in 0..3 {
            a[i][c] += own[c];
        }
    }
}

/// Atoms and springs between them.
#[derive(Lagrangian)]
#[coordinates(r: [n, 3])]
#[parameter(bond: [bonds, 2])]
#[lagrangian(sum(i in 0..n, dot(r_dot[i], r_dot[i])/2) - sum(b in 0..bonds, k/2*(norm(r[bond[b][0]] - r[bond[b][1]]) - l)^2))]
struct Molecule {
    n: usize,
    bond: Vec<[usize; 2]>,
    k: f64,
    l: f64,
}

fn molecule(Molecule { bond, k, l, .. }: &Molecule, r: &[f64], a: &mut [f64]) {
    let r = r.as_chunks::<3>().0;
    let a = a.as_chunks_mut::<3>().0;
    a.fill([0.0; 3]);
    for &[i, j] in bond {
        let d = [r[j][0] - r[i][0], r[j][1] - r[i][1], r[j][2] - r[i][2]];
        let length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        let pull = k * (length - l) / length;
        for c in 0..3 {
            a[i][c] += pull * d[c];
            a[j][c] -= pull * d[c];
        }
    }
}

/// Masses in a net, with springs to their neighbours.
#[derive(Lagrangian)]
#[coordinates(r: [n, n, 3])]
#[define(U(d) = k/2*(norm(d) - l)^2)]
#[lagrangian(sum(i in 0..n, sum(j in 0..n, dot(r_dot[i][j], r_dot[i][j])/2))
    - sum(i in 0..n-1, sum(j in 0..n, U(r[i+1][j] - r[i][j]))) - sum(i in 0..n, sum(j in 0..n-1, U(r[i][j+1] - r[i][j]))))]
struct Net {
    n: usize,
    k: f64,
    l: f64,
}

fn net(&Net { n, k, l }: &Net, r: &[f64], a: &mut [f64]) {
    let r = r.as_chunks::<3>().0;
    let a = a.as_chunks_mut::<3>().0;
    a.fill([0.0; 3]);
    let mut spring = |one: usize, other: usize| {
        let d = [r[other][0] - r[one][0], r[other][1] - r[one][1], r[other][2] - r[one][2]];
        let length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        let pull = k * (length - l) / length;
        for c in 0..3 {
            a[one][c] += pull * d[c];
            a[other][c] -= pull * d[c];
        }
    };
    for i in 0..n {
        for j in 0..n {
            let own = i * n + j;
            if i + 1 < n {
                spring(own, own + n);
            }
            if j + 1 < n {
                spring(own, own + 1);
            }
        }
    }
}

/// Masses on rods, one below the other.
#[derive(Lagrangian)]
#[coordinates(r: [n, 3])]
#[parameter(m: [n])]
#[lagrangian(sum(i in 0..n, m[i]/2*dot(r_dot[i], r_dot[i]) - m[i]*g*r[i][2]))]
#[constraint(rod[0]: (dot(r[0], r[0]) - l^2)/2 = 0)]
#[constraint(rod[i in 1..n]: (dot(r[i] - r[i-1], r[i] - r[i-1]) - l^2)/2 = 0)]
struct Rods {
    m: Vec<f64>,
    g: f64,
    l: f64,
}

/// Accelerations by Thomas' elimination; `work` has each rod with its pivot and right-hand side.
fn rods(Rods { m, g, .. }: &Rods, r: &[f64], v: &[f64], a: &mut [f64], work: &mut [([f64; 3], f64, f64)]) {
    let dot = |x: &[f64; 3], y: &[f64; 3]| x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    let less = |x: &[f64; 3], y: &[f64; 3]| [x[0] - y[0], x[1] - y[1], x[2] - y[2]];
    let (r, v, a) = (r.as_chunks::<3>().0, v.as_chunks::<3>().0, a.as_chunks_mut::<3>().0);
    let (mut above, mut speed, mut light) = ([0.0; 3], [0.0; 3], 0.0);
    let (mut before, mut pivot, mut known) = ([0.0; 3], 1.0, 0.0);
    for i in 0..m.len() {
        let (rod, turn) = (less(&r[i], &above), less(&v[i], &speed));
        let own = 1.0 / m[i];
        let beside = -dot(&rod, &before) * light;
        let factor = beside * pivot;
        // Gravity accelerates both ends alike, but the first rod hangs from a point.
        let pull = if i == 0 { g * rod[2] } else { 0.0 };
        pivot = 1.0 / (dot(&rod, &rod) * (own + light) - factor * beside);
        known = pull - dot(&turn, &turn) - factor * known;
        work[i] = (rod, pivot, known);
        (before, above, speed, light) = (rod, r[i], v[i], own);
    }
    let (mut below, mut last) = ([0.0; 3], 0.0);
    for i in (0..m.len()).rev() {
        let ((rod, pivot, known), light) = (work[i], 1.0 / m[i]);
        let multiplier = (known + dot(&rod, &below) * light * last) * pivot;
        a[i] = [0, 1, 2].map(|c| (rod[c] * multiplier - below[c] * last) * light);
        a[i][2] -= g;
        (below, last) = (rod, multiplier);
    }
}

/// Links in a plane, by their angles against the vertical.
#[derive(Lagrangian)]
#[coordinates(q: [n])]
#[parameter(m: [n]; l: [n])]
#[define(x[0] = l[0]*sin(q[0]); y[0] = -l[0]*cos(q[0]))]
#[define(x[i in 1..n] = x[i-1] + l[i]*sin(q[i]); y[i in 1..n] = y[i-1] - l[i]*cos(q[i]))]
#[lagrangian(sum(i in 0..n, m[i]/2*(der(x[i])^2 + der(y[i])^2) - m[i]*g*y[i]))]
struct Links {
    m: Vec<f64>,
    l: Vec<f64>,
    g: f64,
}

/// Accelerations by articulated bodies, without a check of pivots; `work` has what the second sweep needs.
fn links(Links { m, l, g }: &Links, q: &[f64], v: &[f64], a: &mut [f64], work: &mut [[f64; 7]]) {
    let n = q.len();
    let (m, l, v, a, work) = (&m[..n], &l[..n], &v[..n], &mut a[..n], &mut work[..n]);
    let (mut xx, mut xy, mut yy, mut x, mut y) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for i in (0..n).rev() {
        let (sin, cos) = q[i].sin_cos();
        let (j_x, j_y) = (l[i] * cos, l[i] * sin);
        let (c_x, c_y) = (-j_y * v[i] * v[i], j_x * v[i] * v[i]);
        (xx, yy) = (xx + m[i], yy + m[i]);
        (x, y) = (x - xx * c_x - xy * c_y, y - m[i] * g - xy * c_x - yy * c_y);
        let (u_x, u_y) = (xx * j_x + xy * j_y, xy * j_x + yy * j_y);
        let pivot = 1.0 / (u_x * j_x + u_y * j_y);
        let (k_x, k_y, own) = (u_x * pivot, u_y * pivot, (j_x * x + j_y * y) * pivot);
        work[i] = [k_x, k_y, own, j_x, j_y, c_x, c_y];
        (xx, xy, yy) = (xx - u_x * k_x, xy - u_x * k_y, yy - u_y * k_y);
        (x, y) = (x - u_x * own, y - u_y * own);
    }
    let (mut x, mut y) = (0.0, 0.0);
    for (a, [k_x, k_y, own, j_x, j_y, c_x, c_y]) in a.iter_mut().zip(work) {
        *a = *own - *k_x * x - *k_y * y;
        (x, y) = (x + *j_x * *a + *c_x, y + *j_y * *a + *c_y);
    }
}

/// Chain and cluster with literals as lengths.
macro_rules! with_literals {
    ($chain:ident, $cluster:ident, $n:literal) => {
        #[derive(Lagrangian)]
        #[coordinates(x: [$n])]
        #[define(U(d) = d^2/2 + beta*d^4/4)]
        #[lagrangian(sum(i in 0..$n, x_dot[i]^2/2) - U(x[0]) - U(x[$n-1]) - sum(i in 0..$n-1, U(x[i+1] - x[i])))]
        struct $chain {
            beta: f64,
        }

        #[derive(Lagrangian)]
        #[coordinates(r: [$n, 3])]
        #[lagrangian(sum(i in 0..$n, m[i]/2*dot(r_dot[i], r_dot[i])) + sum(i in 0..$n, sum(j in 0..i, gamma*m[i]*m[j]/norm(r[i] - r[j]))))]
        struct $cluster {
            m: [f64; $n],
            gamma: f64,
        }
    };
}

with_literals!(ChainOf3, ClusterOf3, 3);
with_literals!(ChainOf10, ClusterOf10, 10);

/// Accelerations of a system of `N` coordinates at rest, on slices.
fn on_slices<const N: usize>(
    system: &impl System<Scalar = f64, Length = Const<N>>,
    q: &[f64],
    a: &mut [f64],
) {
    let (q, a) = (q.try_into().expect("N coordinates"), a.try_into().expect("N accelerations"));
    system.accelerations(0.0, q, &[0.0; N], a);
}

/// Compares the accelerations of a system with others, and prints both times for each of `count` parts.
fn compare<L: System<Scalar = f64, Length = Dyn>>(
    name: &str,
    system: &L,
    count: usize,
    others: impl Fn(&L, &[f64], &mut [f64]),
) {
    compare_moving(name, system, (count, 0.0), |system, q, _, a| others(system, q, a));
}

/// The same with velocities of some size.
fn compare_moving<L: System<Scalar = f64, Length = Dyn>>(
    name: &str,
    system: &L,
    (count, speed): (usize, f64),
    others: impl Fn(&L, &[f64], &[f64], &mut [f64]),
) {
    let n = system.length().0;
    let q: Vec<f64> = (0..n).map(|i| 0.7 * (i / 3) as f64 + (1.0 + 1.7 * i as f64).sin()).collect();
    let q: Vec<f64> = if name.contains("chain") { q.iter().map(|x| x.sin()).collect() } else { q };
    let v: Vec<f64> = (0..n).map(|i| speed * (2.3 * i as f64).cos()).collect();
    let (mut a, mut b) = (vec![0.0; n], vec![0.0; n]);
    system.accelerations(0.0, &q, &v, &mut a);
    others(system, &q, &v, &mut b);
    let scale = b.iter().fold(1.0, |most: f64, b| most.max(b.abs()));
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-11 * scale), "{name}");
    let repeats = (2_000_000 / count.max(1)).clamp(1, 100_000);
    let timed = |run: &mut dyn FnMut()| {
        let begun = Instant::now();
        (0..repeats).for_each(|_| run());
        begun.elapsed().as_secs_f64() * 1e9 / (repeats * count) as f64
    };
    let mut times: Vec<[f64; 2]> = (0..ROUNDS)
        .map(|_| {
            let one = timed(&mut || system.accelerations(0.0, black_box(&q), &v, black_box(&mut a)));
            let other = timed(&mut || others(system, black_box(&q), &v, black_box(&mut b)));
            [one, other]
        })
        .collect();
    times.sort_by(|one, other| (one[0] / one[1]).total_cmp(&(other[0] / other[1])));
    let [one, other] = times[ROUNDS / 2];
    println!(
        "{name:10} {n:8} coordinates: {one:7.2} ns a part, against {other:7.2} ns, ratio {:.2}",
        one / other
    );
}

fn main() {
    println!("against loops by hand:");
    for n in [10, 1_000, 1_000_000] {
        compare("chain", &Chain { n, beta: 0.7 }, n, chain);
        compare("Toda chain", &Toda { n, m: vec![1.5; n] }, n, toda);
    }
    for n in [10, 100, 1_000] {
        compare("cluster", &Cluster { m: vec![1.5; n], gamma: 1.0 }, n * (n - 1) / 2, cluster);
    }
    for n in [10, 1_000, 30_000] {
        let bond: Vec<[usize; 2]> = (0..3 * n).map(|b| [b / 3, (b / 3 + 1 + b % 3 * 2) % n]).collect();
        compare("molecule", &Molecule { n, bond, k: 2.0, l: 0.5 }, 3 * n, molecule);
    }
    for n in [3, 30, 300] {
        compare("net", &Net { n, k: 2.0, l: 0.5 }, 2 * n * (n - 1), net);
    }
    for n in [10, 1_000, 100_000] {
        let work = RefCell::new(vec![([0.0; 3], 0.0, 0.0); n]);
        let system = Rods { m: (0..n).map(|i| 1.0 + (i % 3) as f64).collect(), g: 9.81, l: 0.1 };
        let others = |system: &Rods, r: &[f64], v: &[f64], a: &mut [f64]| {
            rods(system, r, v, a, &mut work.borrow_mut());
        };
        compare_moving("rods", &system, (n, 1.0), others);
    }
    for n in [3, 20, 1_000, 100_000] {
        let work = RefCell::new(vec![[0.0; 7]; n]);
        let some = |own: f64| (0..n).map(|i| own + 0.1 * (i as f64).sin()).collect();
        let system = Links { m: some(1.0), l: some(0.8), g: 9.81 };
        let others = |system: &Links, q: &[f64], v: &[f64], a: &mut [f64]| {
            links(system, q, v, a, &mut work.borrow_mut());
        };
        compare_moving("links", &system, (n, 1.0), others);
    }
    println!("against literals:");
    let beta = black_box(0.7);
    let (three, ten) = (ChainOf3 { beta }, ChainOf10 { beta });
    compare("chain", &Chain { n: 3, beta }, 3, |_, q, a| on_slices(&three, q, a));
    compare("chain", &Chain { n: 10, beta }, 10, |_, q, a| on_slices(&ten, q, a));
    let (m, gamma) = (black_box(1.5), 1.0);
    let stars = |n| Cluster { m: vec![m; n], gamma };
    let (three, ten) = (ClusterOf3 { m: [m; 3], gamma }, ClusterOf10 { m: [m; 10], gamma });
    compare("cluster", &stars(3), 3, |_, q, a| on_slices(&three, q, a));
    compare("cluster", &stars(10), 45, |_, q, a| on_slices(&ten, q, a));
}
