//! Families with two indices, and families that use each other.

use approx::assert_relative_eq;
use lagrange_core::nalgebra::SVector;
use lagrange_core::prelude::*;

/// Four bodies that attract each other, all distances by name.
#[derive(Lagrangian)]
#[coordinates(r: [4, 3])]
#[define(d[i in 0..4, j in 0..i] = norm(r[i] - r[j]))]
#[lagrangian(sum(i in 0..4, m[i]/2*dot(r_dot[i], r_dot[i]) + sum(j in 0..i, m[i]*m[j]/d[i][j])))]
struct Stars {
    m: [f64; 4],
}

#[test]
fn a_triangle_of_distances() {
    let stars = Stars { m: [1.0, 0.5, 2.0, 1.5] };
    let state = State::<f64, 12>::at_rest(std::array::from_fn(|k| (k * 7 % 11) as f64 / 3.0));
    let mut expected = SVector::<f64, 12>::zeros();
    for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))).filter(|(i, j)| i != j) {
        let apart = state.q.fixed_rows::<3>(3 * j) - state.q.fixed_rows::<3>(3 * i);
        let pull = stars.m[j] * apart / apart.norm().powi(3);
        (0..3).for_each(|k| expected[3 * i + k] += pull[k]);
    }
    assert_relative_eq!(stars.solve(&state).unwrap().accelerations, expected, max_relative = 1e-13);
    let text = Stars::equations().text();
    assert!(text.contains("d[i = 0 … 3][j = 0 … i − 1] ="), "{text}");
}

/// Families of matrices, of two recursions that need each other, of one from its end, and of a triangle's rows.
#[derive(Lagrangian)]
#[coordinates(x)]
#[define(n = 4)]
#[define(grid[i in 0..n, j in 0..3] = 10*i + j*x)]
#[define(c[0] = 1)]
#[define(s[0] = 0)]
#[define(c[k in 1..7] = c[k-1]*cos(x) - s[k-1]*sin(x))]
#[define(s[k in 1..7] = s[k-1]*cos(x) + c[k-1]*sin(x))]
#[define(even[k in 1..5] = odd[k-1] + even[k-1]*x)]
#[define(even[0] = x)]
#[define(odd[k in 0..5] = 2*even[k])]
#[define(horner[k in 0..n] = a[k] + x*horner[k+1])]
#[define(horner[n+0] = a[4])]
#[define(pascal[i in 0..6, 0] = 1)]
#[define(pascal[i in 1..6][j in 1..i] = pascal[i-1][j-1] + pascal[i-1][j])]
#[define(pascal[1, 1] = 1)]
#[define(pascal[2, 2] = 1)]
#[define(pascal[3, 3] = 1)]
#[define(pascal[4, 4] = 1)]
#[define(pascal[5, 5] = 1)]
#[lagrangian(x_dot^2/2)]
#[observable(multiple = [c[6], s[6]])]
#[observable(alternating = [even[4], odd[4]])]
#[observable(polynomial = horner[0])]
#[observable(row = grid[2])]
#[observable(by_vector = grid*[1, x, 0])]
#[observable(entry = grid[n-1][2])]
#[observable(part = grid[1..3][1][1..3])]
#[observable(binomials = [pascal[5][2], pascal[4][3], pascal[5][5]])]
struct Recursions {
    a: [f64; 5],
}

#[test]
fn elements_have_two_indices_and_rows_are_vectors() {
    let (system, x) = (Recursions { a: [1.0, -2.0, 3.0, 0.5, -1.0] }, 0.7);
    let state = State::at_rest([x]);
    assert_eq!(system.row(&state), SVector::from([20.0, 20.0 + x, 20.0 + 2.0 * x]));
    let rows = [0.0, 10.0, 20.0, 30.0].map(|ten| ten + (ten + x) * x);
    assert_relative_eq!(system.by_vector(&state), SVector::from(rows), max_relative = 1e-14);
    assert_eq!(system.entry(&state), 30.0 + 2.0 * x);
    assert_eq!(system.part(&state), SVector::from([20.0 + x, 20.0 + 2.0 * x]));
    assert_eq!(system.binomials(&state), SVector::from([10.0, 4.0, 1.0]));
}

#[test]
fn families_use_each_other_and_go_either_way() {
    let (system, x) = (Recursions { a: [1.0, -2.0, 3.0, 0.5, -1.0] }, 0.7);
    let state = State::at_rest([x]);
    let angle: f64 = 6.0 * x;
    assert_relative_eq!(
        system.multiple(&state),
        SVector::from([angle.cos(), angle.sin()]),
        max_relative = 1e-14
    );
    let even = (0..4).fold(x, |even, _| 2.0 * even + even * x);
    assert_relative_eq!(system.alternating(&state), SVector::from([even, 2.0 * even]), max_relative = 1e-14);
    let polynomial = system.a.iter().enumerate().map(|(k, a)| a * x.powi(k as i32)).sum::<f64>();
    assert_relative_eq!(system.polynomial(&state), polynomial, max_relative = 1e-14);
}

/// A net of springs and rods: constraints with two indices, of which one is a vector.
#[derive(Lagrangian)]
#[coordinates(r: [4, 2])]
#[lagrangian(sum(i in 0..4, dot(r_dot[i], r_dot[i])/2 + g*r[i][1]))]
#[constraint(rod[i in 0..2, j in 2..4]: norm(r[i] - r[j])^2 = (1 + i)^2)]
#[constraint(pin[0, 1]: r[0] - [0, 0] = 0)]
#[observable(pull = lambda(rod[1][2]))]
#[observable(rods = lambda(rod)[1][0])]
#[observable(hold = lambda(pin[0][1])[1])]
#[observable(held = lambda(pin[0][1][1]))]
struct Net {
    g: f64,
}

#[test]
fn constraints_have_two_indices() {
    assert_eq!(
        Net::CONSTRAINTS,
        ["rod[0][2]", "rod[0][3]", "rod[1][2]", "rod[1][3]", "pin[0][1][0]", "pin[0][1][1]"]
    );
    let net = Net { g: 9.81 };
    let rough = State::at_rest([0.0, 0.0, 0.1, 1.5, 1.0, 0.2, -0.9, 0.3]);
    let (state, _) = net.make_consistent(&rough).unwrap();
    let solution = net.solve(&state).unwrap();
    assert_eq!(net.pull(&state, &solution), solution.multipliers[2]);
    assert_eq!(net.rods(&state, &solution), solution.multipliers[2]);
    assert_eq!(net.hold(&state, &solution), solution.multipliers[5]);
    assert_eq!(net.held(&state, &solution), solution.multipliers[5]);
}
