//! The same equations, whether lengths are fields or numbers: accelerations, momenta, energies and Lagrangians at random states.

use lagrange_core::nalgebra::{DVector, Dyn};
use lagrange_core::{Lagrangian, ManyBodies, State, generic};
use lagrange_random::{Random, cases};

/// Compares a system of any number of bodies with one of `N` coordinates at random states.
pub(super) fn agree<const N: usize>(
    many: &impl ManyBodies<Scalar = f64>,
    fixed: &impl Lagrangian<Scalar = f64, N = lagrange_core::nalgebra::Const<N>>,
    random: &mut Random,
) {
    many.check().expect("lengths that fit");
    assert_eq!(many.length(), Dyn(N));
    for _ in 0..cases([3, 20, 1000]) {
        let state = State::<f64, N>::new(random.array(Random::signed), random.array(Random::signed));
        let state = state.at_time(random.between(0.0, 3.0));
        let open: generic::State<f64, Dyn> = generic::State {
            t: state.t,
            q: DVector::from_column_slice(state.q.as_slice()),
            v: DVector::from_column_slice(state.v.as_slice()),
        };
        let mut a = vec![f64::NAN; N];
        many.accelerations(open.t, open.q.as_slice(), open.v.as_slice(), &mut a);
        let solution = fixed.accelerations_unchecked(&state);
        let expected = solution.accelerations;
        let scale = 1.0 + expected.amax();
        for (i, (one, other)) in a.iter().zip(&expected).enumerate() {
            assert!((one - other).abs() <= 1e-12 * scale, "a[{i}] of {N}: {one}, not {other}");
        }
        let multipliers = many.multipliers(&open).expect("independent constraints");
        let scale = 1.0 + solution.multipliers.iter().fold(0.0_f64, |most, lambda| most.max(lambda.abs()));
        assert_eq!(multipliers.len(), solution.multipliers.len());
        for (i, (one, other)) in multipliers.iter().zip(&solution.multipliers).enumerate() {
            assert!((one - other).abs() <= 1e-12 * scale, "λ[{i}]: {one}, not {other}");
        }
        let momenta = fixed.momentum(&state);
        assert!((many.momenta(&open) - DVector::from_column_slice(momenta.as_slice())).amax() < 1e-12);
        let close = |one: f64, other: f64| {
            assert!((one - other).abs() <= 1e-12 * (1.0 + other.abs()), "{one}, not {other}");
        };
        close(many.energy(&open), fixed.energy(&state));
        close(many.lagrangian(&open), fixed.lagrangian(&state));
        let mut names = Vec::new();
        for i in 0..N {
            let mut name = String::new();
            many.write_name(i, &mut name).expect("a text");
            names.push(name);
        }
        assert_eq!(names, fixed.names());
    }
}

/// Names of the coordinates.
trait Names {
    fn names(&self) -> Vec<String>;
}

impl<L: Lagrangian> Names for L {
    fn names(&self) -> Vec<String> {
        L::COORDINATES.iter().map(|name| (*name).to_owned()).collect()
    }
}

/// Random positive numbers.
pub(super) fn positive<const N: usize>(random: &mut Random) -> [f64; N] {
    random.array(|random| random.between(0.5, 1.5))
}

macro_rules! chain {
    ($name:ident, $n:tt, $($field:tt)*) => {
        /// Chain with one spring constant more than masses.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(q: [$n])]
        #[parameter(m: [$n])]
        #[define(d[i in 0..$n-1] = q[i+1] - q[i])]
        #[define(U(x) = k*x^2/2 + alpha*x^3/3)]
        #[lagrangian(sum(i in 0..$n, m[i]*q_dot[i]^2/2) - sum(i in 0..$n-1, U(d[i])) - U(q[0]) - U(-q[$n-1]))]
        #[dissipation(c/2*sum(i in 0..$n-1, der(d[i])^2))]
        #[force(q[i in 1..$n-1]: sin(t + i*h))]
        #[force(q[$n-1]: f)]
        struct $name { $($field)* k: f64, alpha: f64, c: f64, h: f64, f: f64 }
    };
}

chain!(Chain, n, n: usize, m: Vec<f64>,);
chain!(Chain3, 3, m: [f64; 3],);
chain!(Chain6, 6, m: [f64; 6],);

#[test]
fn chains() {
    let mut random = Random(1);
    macro_rules! both {
        ($fixed:ident, $n:literal) => {{
            let [k, alpha, c, h, f] = positive(&mut random);
            let m: [f64; $n] = positive(&mut random);
            let many = Chain { n: $n, m: m.to_vec(), k, alpha, c, h, f };
            agree(&many, &$fixed { m, k, alpha, c, h, f }, &mut random);
        }};
    }
    both!(Chain3, 3);
    both!(Chain6, 6);
}

macro_rules! cluster {
    ($name:ident, $n:tt, $($field:tt)*) => {
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(r: [$n, 3])]
        #[parameter(m: [$n])]
        #[lagrangian(sum(i in 0..$n, m[i]/2*dot(r_dot[i], r_dot[i]) - dot(g, r[i])*m[i])
            + sum(i in 0..$n, sum(j in 0..i, gamma*m[i]*m[j]/norm(r[i] - r[j]))))]
        struct $name { $($field)* gamma: f64, g: [f64; 3] }
    };
}

cluster!(Cluster, n, m: Vec<f64>,);
cluster!(Cluster2, 2, m: [f64; 2],);
cluster!(Cluster4, 4, m: [f64; 4],);

#[test]
fn clusters() {
    let mut random = Random(2);
    macro_rules! both {
        ($fixed:ident, $n:literal, $count:literal) => {{
            let [gamma] = positive(&mut random);
            let (m, g): ([f64; $n], [f64; 3]) = (positive(&mut random), positive(&mut random));
            agree::<$count>(&Cluster { m: m.to_vec(), gamma, g }, &$fixed { m, gamma, g }, &mut random);
        }};
    }
    both!(Cluster2, 2, 6);
    both!(Cluster4, 4, 12);
}

macro_rules! pairs {
    ($name:ident, $n:tt, $($field:tt)*) => {
        /// Pairs counted upwards, with masses at one end and a coordinate beside.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(x, r: [$n, 2])]
        #[lagrangian(mass/2*x_dot^2 + sum(i in 0..$n, dot(r_dot[i], r_dot[i])/2) + mass*dot(r_dot[0], r_dot[0])
            - sum(i in 0..$n-1, sum(j in i+1..$n, exp(-dot(r[i] - r[j], r[i] - r[j])) + (i - j)^2*r[i][0]*r[j][1]))
            - sum(k in 0..$n, (r[k][0] - x)^2 + x*r[$n-1-k][1]))]
        struct $name { $($field)* mass: f64 }
    };
}

pairs!(Pairs, n, n: usize,);
pairs!(Pairs2, 2,);
pairs!(Pairs5, 5,);

#[test]
fn pairs_beside_one_coordinate() {
    let mut random = Random(3);
    agree::<5>(&Pairs { n: 2, mass: 0.7 }, &Pairs2 { mass: 0.7 }, &mut random);
    agree::<11>(&Pairs { n: 5, mass: 0.7 }, &Pairs5 { mass: 0.7 }, &mut random);
}

macro_rules! shared {
    ($name:ident, $n:tt, $($field:tt)*) => {
        /// One body over six ranges, with neighbours one and two places away.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(q: [$n])]
        #[define(F(x) = x^2/2 + x^4/4)]
        #[lagrangian(sum(i in 0..$n, q_dot[i]^2/2) - sum(i in 0..$n-1, F(q[i+1] - q[i])) - sum(i in 1..$n-1, F(q[i+1] - q[i]))
            - sum(i in 0..$n-2, F(q[i+2] - q[i])) - sum(i in 1..$n, F(q[i] - q[i-1])) - sum(i in 2..$n-2, F(q[i+2] - q[i-2]))
            - sum(i in 4..$n-3, F(q[i+1] - q[i])))]
        struct $name { $($field)* }
    };
}

shared!(Shared, n, n: usize,);
shared!(Shared8, 8,);
shared!(Shared11, 11,);

#[test]
fn one_body_over_six_ranges() {
    let mut random = Random(4);
    agree::<8>(&Shared { n: 8 }, &Shared8 {}, &mut random);
    agree::<11>(&Shared { n: 11 }, &Shared11 {}, &mut random);
}

macro_rules! lattice {
    ($name:ident, $rows:tt, $columns:tt, $($field:tt)*) => {
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(u: [$rows, $columns, 2])]
        #[lagrangian(sum(i in 0..$rows, sum(j in 0..$columns, dot(u_dot[i][j], u_dot[i][j])/2 - (1 + i + 10*j)*u[i][j][0]^4))
            - sum(i in 0..$rows-1, sum(j in 0..$columns, norm(u[i+1][j] - u[i][j] + [3, 0])))
            - sum(i in 0..$rows, sum(j in 0..$columns-1, norm(u[i][j+1] - u[i][j] + [0, 3]))))]
        struct $name { $($field)* }
    };
}

lattice!(Lattice, rows, columns, rows: usize, columns: usize,);
lattice!(Lattice23, 2, 3,);
lattice!(Lattice32, 3, 2,);

#[test]
fn lattices() {
    let mut random = Random(5);
    agree::<12>(&Lattice { rows: 2, columns: 3 }, &Lattice23 {}, &mut random);
    agree::<12>(&Lattice { rows: 3, columns: 2 }, &Lattice32 {}, &mut random);
}

macro_rules! coupled {
    ($name:ident, $n:tt, $($field:tt)*) => {
        /// Velocities of one element that multiply one another: of several arrays, and with an inertia that varies.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(x: [$n, 2], phi: [$n])]
        #[lagrangian(sum(i in 0..$n, (2 + sin(i))/2*dot(x_dot[i], x_dot[i]) + (x_dot[i][0]*cos(phi[i]) + x_dot[i][1]*sin(phi[i]))*phi_dot[i]*a
            + (1 + x[i][0]^2)*phi_dot[i]^2) + sum(i in 1..$n, x_dot[i][0]^2/2) + x_dot[0][1]*phi_dot[0]/9
            - sum(i in 0..$n-1, cos(phi[i+1] - phi[i]) + phi[i+1]*x[i][1]) + sum(i in 0..$n, w*x[i][0]*x_dot[i][1]))]
        struct $name { $($field)* a: f64, w: f64 }
    };
}

coupled!(Coupled, n, n: usize,);
coupled!(Coupled2, 2,);
coupled!(Coupled4, 4,);

#[test]
fn velocities_of_one_element_are_coupled() {
    let mut random = Random(6);
    agree::<6>(&Coupled { n: 2, a: 0.4, w: 0.7 }, &Coupled2 { a: 0.4, w: 0.7 }, &mut random);
    agree::<12>(&Coupled { n: 4, a: 0.4, w: 0.7 }, &Coupled4 { a: 0.4, w: 0.7 }, &mut random);
}

/// Atoms and bonds between them, some of them twice, and one from an atom to itself.
#[derive(lagrange_core::Lagrangian)]
#[coordinates(r: [atoms, 2])]
#[parameter(bond: [bonds, 2]; k: [bonds]; m: [atoms])]
#[lagrangian(sum(i in 0..atoms, m[i]/2*dot(r_dot[i], r_dot[i]))
    - sum(b in 0..bonds, k[b]/2*dot(r[bond[b][0]] - r[bond[b][1]], r[bond[b][0]] - 2*r[bond[b][1]])))]
struct Molecule {
    m: Vec<f64>,
    bond: Vec<[usize; 2]>,
    k: Vec<f64>,
}

/// The same with the bonds written out.
#[derive(lagrange_core::Lagrangian)]
#[coordinates(r: [4, 2])]
#[define(U(a, b) = dot(a - b, a - 2*b)/2)]
#[lagrangian(sum(i in 0..4, m[i]/2*dot(r_dot[i], r_dot[i]))
    - k[0]*U(r[0], r[1]) - k[1]*U(r[1], r[0]) - k[2]*U(r[2], r[2]) - k[3]*U(r[1], r[3]) - k[4]*U(r[1], r[3]))]
struct WrittenOut {
    m: [f64; 4],
    k: [f64; 5],
}

#[test]
fn bonds_from_a_table() {
    let mut random = Random(7);
    let (m, k) = (positive(&mut random), positive(&mut random));
    let bond = vec![[0, 1], [1, 0], [2, 2], [1, 3], [1, 3]];
    agree::<8>(&Molecule { m: m.to_vec(), bond, k: k.to_vec() }, &WrittenOut { m, k }, &mut random);
}

macro_rules! driven {
    ($name:ident, $n:tt, $($field:tt)*) => {
        /// Sums in forces and in definitions, and `f32`.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(q: [$n])]
        #[define(mean = sum(i in 0..$n, q[i])/$n)]
        #[define(rate = der(mean))]
        #[lagrangian(sum(i in 0..$n, q_dot[i]^2/2) - sum(i in 0..$n, q[i]^2*sin(t)))]
        #[force(q[i in 0..$n]: max(-f, min(f, (mean - q[i])*rate^2)) + sum(j in 0..i+1, q[j]))]
        #[observable(spread = sqrt(sum(i in 0..$n, (q[i] - mean)^2)))]
        #[observable(moments = [mean, rate, sum(i in 0..$n, q[i]^2)])]
        struct $name { $($field)* f: f64 }
    };
}

driven!(Driven, N,);
driven!(Driven4, 4,);
const N: usize = 4;

#[test]
fn sums_in_forces_and_observables() {
    let mut random = Random(8);
    let (many, fixed) = (Driven { f: 0.3 }, Driven4 { f: 0.3 });
    agree::<4>(&many, &fixed, &mut random);
    let state = State::<f64, 4>::new(random.array(Random::signed), random.array(Random::signed));
    let open: generic::State<f64, Dyn> = generic::State {
        t: 0.0,
        q: DVector::from_column_slice(state.q.as_slice()),
        v: DVector::from_column_slice(state.v.as_slice()),
    };
    assert!((many.spread(&open) - fixed.spread(&state)).abs() < 1e-14);
    assert!((many.moments(&open) - fixed.moments(&state)).amax() < 1e-14);
}

macro_rules! embedded {
    ($name:ident, $n:tt, $($field:tt)*) => {
        /// Functions of sums: atoms in the density of all others, and collective forces.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(r: [$n, 2])]
        #[define(rho[i in 0..$n] = sum(j in 0..$n, c[j]*exp(-dot(r[i] - r[j], r[i] - r[j]))))]
        #[define(middle = sum(i in 0..$n, r[i])/$n)]
        #[parameter(c: [$n])]
        #[lagrangian(sum(i in 0..$n, dot(r_dot[i], r_dot[i])/2) + sum(i in 0..$n, c[i]*sqrt(1 + rho[i])) - cos(sum(i in 0..$n, r[i][0]))
            - r[0][1]*sum(i in 0..$n, r[i][0]^2)*sum(i in 0..$n-1, r[i+1][1]*r[i][1]) - dot(middle, middle)^2*exp(-t))]
        #[dissipation(sum(i in 0..$n, dot(r_dot[i], r_dot[i]))*dot(middle, middle)/9)]
        #[observable(densities = sum(i in 0..$n, rho[i]^2))]
        struct $name { $($field)* }
    };
}

embedded!(Embedded, n, n: usize, c: Vec<f64>,);
embedded!(Embedded2, 2, c: [f64; 2],);
embedded!(Embedded4, 4, c: [f64; 4],);

#[test]
fn functions_of_sums() {
    let mut random = Random(9);
    let c: [f64; 2] = positive(&mut random);
    agree::<4>(&Embedded { n: 2, c: c.to_vec() }, &Embedded2 { c }, &mut random);
    let c: [f64; 4] = positive(&mut random);
    agree::<8>(&Embedded { n: 4, c: c.to_vec() }, &Embedded4 { c }, &mut random);
}
