//! Constraints of any number of bodies: multipliers, projections and motions, beside the same constraints written out.

use lagrange_core::nalgebra::{Const, DVector, Dyn};
use lagrange_core::{Lagrangian, State, generic, prelude::*};
use lagrange_random::Random;

use super::written_out::{agree, positive};

/// Compares equations, names and projections of a system with those of the same system written out.
fn agree_with_constraints<const N: usize>(
    many: &impl ManyBodies<Scalar = f64>,
    fixed: &(impl Lagrangian<Scalar = f64, N = Const<N>> + Simulate),
    random: &mut Random,
) {
    agree::<N>(many, fixed, random);
    names_agree(many, fixed);
    for _ in 0..3 {
        let state = State::<f64, N>::new(random.array(Random::signed), random.array(Random::signed));
        let Ok((expected, moved)) = fixed.make_consistent(&state) else { continue };
        // Far from the constraints the sum of several corrections is not the least: states differ by its square.
        let near = State::<f64, N> { q: expected.q + (state.q - expected.q) * 1e-6, ..state };
        let expected = fixed.make_consistent(&near).expect("a state nearby").0;
        let (found, _) = many.project(&open(&near)).expect("a state nearby");
        let scale = 1.0 + moved.largest_velocity_change();
        assert!((&found.q - open(&expected).q).amax() < 1e-10, "{}, not {}", found.q, expected.q);
        assert!((&found.v - open(&expected).v).amax() < 1e-10 * scale, "{}, not {}", found.v, expected.v);
        fixed
            .check_consistent(&State { q: fixed_length(&found.q), v: fixed_length(&found.v), ..near })
            .expect("a consistent state");
    }
}

fn fixed_length<const N: usize>(x: &DVector<f64>) -> lagrange_core::nalgebra::SVector<f64, N> {
    lagrange_core::nalgebra::SVector::from_column_slice(x.as_slice())
}

fn open<const N: usize>(state: &State<f64, N>) -> generic::State<f64, Dyn> {
    let [q, v] = [state.q, state.v].map(|half| DVector::from_column_slice(half.as_slice()));
    generic::State { t: state.t, q, v }
}

fn names_agree<L: Lagrangian>(many: &impl ManyBodies, _: &L) {
    for (constraint, expected) in L::CONSTRAINTS.iter().enumerate() {
        let mut name = String::new();
        many.write_constraint_name(constraint, &mut name).expect("a text");
        assert_eq!(name, *expected);
    }
}

macro_rules! rods {
    ($name:ident, $n:tt, $($field:tt)*) => {
        /// Bobs on rods, one below the other, the first below a point that moves.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(r: [$n, 2])]
        #[parameter(m: [$n])]
        #[define(top = [sin(w*t), 0])]
        #[lagrangian(sum(i in 0..$n, m[i]/2*dot(r_dot[i], r_dot[i]) - m[i]*g*r[i][1]))]
        #[constraint(rod[0]: norm(r[0] - top) = l)]
        #[constraint(rod[i in 1..$n]: dot(r[i] - r[i-1], r[i] - r[i-1]) = l^2)]
        struct $name { $($field)* g: f64, l: f64, w: f64 }
    };
}

rods!(Rods, n, m: Vec<f64>,);
rods!(Rods2, 2, m: [f64; 2],);
rods!(Rods6, 6, m: [f64; 6],);

#[test]
fn rods() {
    let mut random = Random(11);
    macro_rules! both {
        ($fixed:ident, $n:literal) => {{
            let (m, [g, l, w]): ([f64; $n], _) = (positive(&mut random), positive(&mut random));
            let many = Rods { m: m.to_vec(), g, l, w };
            agree_with_constraints::<{ 2 * $n }>(&many, &$fixed { m, g, l, w }, &mut random);
        }};
    }
    both!(Rods2, 2);
    both!(Rods6, 6);
}

macro_rules! girder {
    ($name:ident, $n:tt, $($field:tt)*) => {
        /// Constraints over two and three neighbours beside ones at both ends, and masses that differ at
        /// one end: a band of several constraints at each position.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(s: [$n], r: [$n, 3])]
        #[parameter(m: [$n])]
        #[lagrangian(sum(i in 0..$n, m[i]/2*dot(r_dot[i], r_dot[i]) + s_dot[i]^2*(1 + i)/2 - r[i][2]^2) + sum(i in 0..2, dot(r_dot[i], r_dot[i])))]
        #[constraint(far[i in 1..$n-1]: norm(r[i+1] - r[i-1]) = d)]
        #[constraint(root: r[0][2] = sin(t)*r[0][1])]
        #[constraint(near[i in 0..$n-1]: dot(r[i+1] - r[i], r[i+1] - r[i]) + s[i]*s[i+1] = d)]
        #[constraint(tip: r[$n-1][0] - r[$n-2][1] = s[$n-1]*t)]
        #[constraint(roll[i in 0..$n]: s_dot[i] = r_dot[i][1]*cos(s[i]))]
        struct $name { $($field)* d: f64 }
    };
}

girder!(Girder, n, m: Vec<f64>,);
girder!(Girder3, 3, m: [f64; 3],);
girder!(Girder6, 6, m: [f64; 6],);

#[test]
fn several_constraints_at_each_element() {
    let mut random = Random(17);
    let m: [f64; 3] = positive(&mut random);
    agree::<12>(&Girder { m: m.to_vec(), d: 1.3 }, &Girder3 { m, d: 1.3 }, &mut random);
    let m: [f64; 6] = positive(&mut random);
    let (many, fixed) = (Girder { m: m.to_vec(), d: 1.3 }, Girder6 { m, d: 1.3 });
    agree_with_constraints::<24>(&many, &fixed, &mut random);
}

macro_rules! nested {
    ($name:ident, $rows:tt, $columns:tt, $($field:tt)*) => {
        /// Sums over a fixed range of sums that begin behind the element.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(phi: [$rows, $columns])]
        #[lagrangian(sum(i in 0..$rows, sum(j in 0..$columns, phi_dot[i][j]^2/2)))]
        #[force(phi[l in 0..$rows-1][0]: sum(s in 0..$columns-1, sum(k in l+1..$rows, phi[k][s]*phi[l][s+1])))]
        #[constraint(C[l in 0..$rows-1]: phi[l][0] + sum(s in 0..$columns-1, sum(k in l+1..$rows, phi[k][s]^2/4)) = 0)]
        struct $name { $($field)* }
    };
}

nested!(Nested, rows, columns, rows: usize, columns: usize,);
nested!(Nested32, 3, 2,);

#[test]
fn bounds_of_inner_sums_have_the_index_of_the_constraint() {
    let mut random = Random(16);
    agree_with_constraints::<6>(&Nested { rows: 3, columns: 2 }, &Nested32 {}, &mut random);
}

/// A molecule of atoms at constant distances.
#[derive(lagrange_core::Lagrangian)]
#[coordinates(r: [atoms, 3])]
#[parameter(m: [atoms]; bond: [bonds, 2]; d: [bonds])]
#[lagrangian(sum(i in 0..atoms, m[i]/2*dot(r_dot[i], r_dot[i]) - r[i][0]^3))]
#[constraint(bond[b in 0..bonds]: norm(r[bond[b][0]] - r[bond[b][1]]) = d[b])]
struct Molecule {
    m: Vec<f64>,
    bond: Vec<[usize; 2]>,
    d: Vec<f64>,
}

/// The same with the bonds written out: a ring of four atoms with a diagonal.
#[derive(lagrange_core::Lagrangian)]
#[coordinates(r: [4, 3])]
#[lagrangian(sum(i in 0..4, m[i]/2*dot(r_dot[i], r_dot[i]) - r[i][0]^3))]
#[constraint(bond[0]: norm(r[2] - r[0]) = d[0])]
#[constraint(bond[1]: norm(r[0] - r[1]) = d[1])]
#[constraint(bond[2]: norm(r[1] - r[3]) = d[2])]
#[constraint(bond[3]: norm(r[3] - r[2]) = d[3])]
#[constraint(bond[4]: norm(r[2] - r[1]) = d[4])]
struct Ring {
    m: [f64; 4],
    d: [f64; 5],
}

#[test]
fn distances_from_a_table() {
    let mut random = Random(12);
    let (m, d) = (positive(&mut random), positive(&mut random));
    let bond = vec![[2, 0], [0, 1], [1, 3], [3, 2], [2, 1]];
    let many = Molecule { m: m.to_vec(), bond, d: d.to_vec() };
    agree_with_constraints::<12>(&many, &Ring { m, d }, &mut random);
}

macro_rules! blades {
    ($name:ident, $n:tt, $($field:tt)*) => {
        /// Blades that do not slide across, each behind the one before it, with mass off their middle: velocity constraints on elements
        /// whose velocities multiply one another.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(x: [$n, 2], phi: [$n])]
        #[lagrangian(sum(i in 0..$n, dot(x_dot[i], x_dot[i])/2 + a*(x_dot[i][1]*cos(phi[i]) - x_dot[i][0]*sin(phi[i]))*phi_dot[i]
            + phi_dot[i]^2) - sum(i in 0..$n, x[i][0]*f))]
        #[constraint(edge[i in 0..$n]: x_dot[i][1]*cos(phi[i]) - x_dot[i][0]*sin(phi[i]) = w*t)]
        #[constraint(hitch[i in 1..$n]: x[i] + [cos(phi[i]), sin(phi[i])] = x[i-1] - b*[cos(phi[i-1]), sin(phi[i-1])])]
        struct $name { $($field)* a: f64, b: f64, f: f64, w: f64 }
    };
}

blades!(Blades, n, n: usize,);
blades!(Blades3, 3,);

#[test]
fn velocity_constraints_beside_holonomic_ones() {
    let mut random = Random(13);
    let [a, b, f, w] = positive(&mut random);
    let a = a / 2.0;
    agree_with_constraints::<9>(&Blades { n: 3, a, b, f, w }, &Blades3 { a, b, f, w }, &mut random);
}

macro_rules! summed {
    ($name:ident, $n:tt, $($field:tt)*) => {
        /// Sums in constraints: the centre of mass on a line, a function of a sum, and sums that grow with the element.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(q: [$n], s)]
        #[parameter(m: [$n])]
        #[lagrangian(sum(i in 0..$n, m[i]*q_dot[i]^2/2) + s_dot^2 - sum(i in 0..$n, cos(q[i])*s))]
        #[constraint(middle: sum(i in 0..$n, m[i]*q[i]) = s*t)]
        #[constraint(size: exp(sum(i in 0..$n, q[i]^2)/9) = 1 + s^2)]
        #[constraint(partial[i in 2..$n-1]: q_dot[i] + sum(j in 0..i, q_dot[j]*cos(q[j])) = s)]
        struct $name { $($field)* }
    };
}

summed!(Summed, n, m: Vec<f64>,);
summed!(Summed4, 4, m: [f64; 4],);
summed!(Summed6, 6, m: [f64; 6],);

#[test]
fn sums_in_constraints() {
    let mut random = Random(14);
    let m: [f64; 4] = positive(&mut random);
    agree::<5>(&Summed { m: m.to_vec() }, &Summed4 { m }, &mut random);
    let m: [f64; 6] = positive(&mut random);
    let (many, fixed) = (Summed { m: m.to_vec() }, Summed6 { m });
    agree::<7>(&many, &fixed, &mut random);
    names_agree(&many, &fixed);
}

macro_rules! mixed {
    ($name:ident, $n:tt, $($field:tt)*) => {
        /// A velocity constraint beside holonomic ones, of which a sum keeps the matrix from being a band.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(r: [$n, 2])]
        #[lagrangian(sum(i in 0..$n, (1 + i)*dot(r_dot[i], r_dot[i])/2))]
        #[constraint(mean: sum(i in 0..$n, r[i][0]^2) = 3)]
        #[constraint(blade[i in 0..$n-1]: r_dot[i][1]*cos(r[i][0]) = r_dot[i+1][0])]
        #[constraint(rod[i in 1..$n]: dot(r[i] - r[i-1], r[i] - r[i-1]) = 1)]
        struct $name { $($field)* }
    };
}

mixed!(Mixed, n, n: usize,);
mixed!(Mixed4, 4,);

#[test]
fn velocity_constraints_are_left_out_where_coordinates_are_projected() {
    let mut random = Random(18);
    agree_with_constraints::<8>(&Mixed { n: 4 }, &Mixed4 {}, &mut random);
}

macro_rules! sheet {
    ($name:ident, $rows:tt, $columns:tt, $($field:tt)*) => {
        /// Rods along the rows of a lattice, and bars between rows.
        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(u: [$rows, $columns, 2])]
        #[lagrangian(sum(i in 0..$rows, sum(j in 0..$columns, (1 + i + j/3)*dot(u_dot[i][j], u_dot[i][j])/2)))]
        #[constraint(along[i in 0..$rows][j in 1..$columns]: dot(u[i][j] - u[i][j-1], u[i][j] - u[i][j-1]) = 1)]
        #[constraint(across[i in 1..$rows]: u[i][0][1] - u[i-1][0][1] = 1)]
        struct $name { $($field)* }
    };
}

sheet!(Sheet, rows, columns, rows: usize, columns: usize,);
sheet!(Sheet23, 2, 3,);
sheet!(Sheet32, 3, 2,);

#[test]
fn families_of_two_indices() {
    let mut random = Random(15);
    agree_with_constraints::<12>(&Sheet { rows: 2, columns: 3 }, &Sheet23 {}, &mut random);
    agree_with_constraints::<12>(&Sheet { rows: 3, columns: 2 }, &Sheet32 {}, &mut random);
}
