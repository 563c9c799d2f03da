//! Observables that are matrices or families, and forces and powers that are families.

use approx::assert_relative_eq;
use lagrange_core::nalgebra::{Rotation3, SMatrix, SVector, Vector3};
use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(a, b, y: [3])]
#[define(n = 3)]
#[lagrangian(a_dot^2/2 + b_dot^2/2 + dot(y_dot, y_dot)/2)]
#[force(y[i in 0..n]: -k[i]*y_dot[i])]
#[force(y[i in 1..n]: k[i-1]*y[0])]
#[observable(R = rot_x(a)*rot_z(b))]
#[observable(wide = [[a, b, 1], [y[0], y[1], 2]])]
#[observable(height[i in 0..n] = i*y[i])]
#[observable(products[i in 0..2, j in 0..n] = height[j] + i*wide[i][j])]
#[observable(drops[i in 0..2] = [y_ddot[i], i])]
#[observable(alone[i in 0..1] = a)]
struct Shown<T> {
    k: [T; 3],
}

#[test]
fn matrices_and_families_are_matrices() {
    let shown = Shown { k: [0.5, 1.0, 2.0] };
    let state = State::new([0.3, 0.7, 1.0, 2.0, 4.0], [0.0, 0.0, 1.0, -2.0, 3.0]);
    let turn = Rotation3::from_axis_angle(&Vector3::x_axis(), 0.3)
        * Rotation3::from_axis_angle(&Vector3::z_axis(), 0.7);
    let found: SMatrix<f64, 3, 3> = shown.R(&state);
    assert_relative_eq!(found, turn.into_inner(), epsilon = 1e-15);
    assert_eq!(shown.wide(&state), SMatrix::<f64, 2, 3>::new(0.3, 0.7, 1.0, 1.0, 2.0, 2.0));
    assert_eq!(shown.height(&state), SVector::from([0.0, 2.0, 8.0]));
    assert_eq!(shown.products(&state), SMatrix::<f64, 2, 3>::new(0.0, 2.0, 8.0, 1.0, 4.0, 10.0));
    let solution = shown.solve(&state).unwrap();
    assert_eq!(solution.accelerations, SVector::from([0.0, 0.0, -0.5, 2.0 + 0.5, -6.0 + 1.0]));
    assert_eq!(shown.drops(&state, &solution), SMatrix::<f64, 2, 2>::new(-0.5, 0.0, 2.5, 1.0));
    // An array of one number is that number, as it is elsewhere.
    assert_eq!(shown.alone(&state), 0.3);
}

#[test]
fn every_number_is_named_and_found_by_its_name() {
    let names = <Shown<f64> as Lagrangian>::OBSERVABLES;
    assert_eq!(names[..4], ["R[0][0]", "R[0][1]", "R[0][2]", "R[1][0]"]);
    assert_eq!(
        names[9..16],
        ["wide[0][0]", "wide[0][1]", "wide[0][2]", "wide[1][0]", "wide[1][1]", "wide[1][2]", "height[0]"]
    );
    let shown = Shown { k: [0.5, 1.0, 2.0] };
    let start = State::new([0.3, 0.7, 1.0, 2.0, 4.0], [0.0, 0.0, 1.0, -2.0, 3.0]);
    let solution = shown.solve(&start).unwrap();
    let by_name = |name: String| {
        let index = names.iter().position(|known| *known == name).unwrap();
        shown.observable(index, &start, &solution).unwrap()
    };
    let (turn, products) = (shown.R(&start), shown.products(&start));
    for (i, j) in (0..2).flat_map(|i| (0..3).map(move |j| (i, j))) {
        assert_eq!(by_name(format!("R[{i}][{j}]")), turn[(i, j)]);
        assert_eq!(by_name(format!("products[{i}][{j}]")), products[(i, j)]);
    }
    let single = Shown { k: [0.5_f32, 1.0, 2.0] };
    let state = State::new([0.3_f32, 0.7, 1.0, 2.0, 4.0], [0.0; 5]);
    assert!((single.R(&state).determinant() - 1.0).abs() < 1e-6);
}

/// Two particles that pull each other: both momenta together, and their angular momenta, are conserved.
#[derive(Lagrangian)]
#[coordinates(r: [2, 3])]
#[lagrangian(sum(i in 0..2, m[i]/2*dot(r_dot[i], r_dot[i])) - k/2*dot(r[1] - r[0], r[1] - r[0]))]
#[define(momentum[i in 0..2] = m[i]*r_dot[i])]
#[conserved(all[k in 0..2] = [momentum[0] + momentum[1], cross(r[0], momentum[0]) + cross(r[1], momentum[1])][k])]
struct Pulled {
    m: [f64; 2],
    k: f64,
}

#[test]
fn families_are_conserved_number_by_number() {
    let names: Vec<_> = Pulled::FACTS.conserved.iter().map(|conserved| conserved.name).collect();
    assert!(
        ["all[0][0]", "all[0][2]", "all[1][0]", "all[1][2]"].iter().all(|name| names.contains(name)),
        "{names:?}"
    );
    let text = Pulled::equations();
    assert!(text.text().contains("all[k = 0 … 1] ="), "{}", text.text());
    let (pulled, start) =
        (Pulled { m: [1.0, 2.0], k: 3.0 }, State::new([0.0, 1.0, 2.0, -1.0, 0.5, 0.0], [1.0; 6]));
    let row = SMatrix::<f64, 1, 3>::new(3.0, 3.0, 3.0);
    assert_relative_eq!(pulled.all(&start).row(0).into_owned(), row, epsilon = 1e-15);
}

/// Three fins on an arm of three links, each of which the wind pushes at.
#[derive(Lagrangian)]
#[coordinates(q: [3])]
#[frame(link[0]: rotate_z(q[0]))]
#[frame(link[i in 1..3] in link[i-1]: translate([1, 0, 0]), rotate_y(q[i]))]
#[lagrangian(dot(q_dot, q_dot)/2)]
#[power(i in 0..3, fin[i] - c[i]*velocity(link[i], tip), velocity(link[i], tip))]
#[observable(at[i in 0..3] = position(link[i], tip))]
#[observable(push[i in 0..3] = express(fin[i] - c[i]*velocity(link[i], tip), fixed))]
struct Fins {
    fin: [Vector3<f64>; 3],
    c: [f64; 3],
    tip: Vector3<f64>,
}

/// Q_a = Σ F·∂x/∂q_a, by differences of the places of the tips.
#[test]
fn a_family_of_powers_is_their_sum() {
    let fins = Fins {
        fin: [Vector3::new(1.0, 2.0, -1.0), Vector3::new(0.5, 0.0, 2.0), Vector3::new(-1.0, 1.0, 0.3)],
        c: [0.3, 0.7, 0.2],
        tip: Vector3::new(0.8, 0.1, -0.4),
    };
    let (q, v) = ([0.4, -0.6, 1.1], [0.5, 1.5, -0.7]);
    let state = State::new(q, v);
    let push = fins.push(&state);
    let found = fins.solve(&state).unwrap().accelerations;
    for a in 0..3 {
        let at = |step: f64| {
            let mut q = q;
            q[a] += step;
            fins.at(&State::at_rest(q))
        };
        let step = 1e-3;
        let slope = (8.0 * (at(step) - at(-step)) - at(2.0 * step) + at(-2.0 * step)) / (12.0 * step);
        assert_relative_eq!(found[a], push.component_mul(&slope).sum(), epsilon = 1e-10);
    }
}
