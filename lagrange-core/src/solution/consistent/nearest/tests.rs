use std::println;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use crate::prelude::*;
use lagrange_random::{Random, cases};

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*x_dot^2 + y_dot^2/2)]
#[constraint(ellipse: x^2/4 + y^2 = 1)]
struct Ellipse {
    m: f64,
}

/// Returns the least distance to the ellipse among 2,000 of its points.
fn least_distance(m: f64, [x, y]: [f64; 2]) -> f64 {
    let distance = |angle: f64| (m * (2.0 * angle.cos() - x).powi(2) + (angle.sin() - y).powi(2)).sqrt();
    (0..2000).map(|k| distance(f64::from(k) * std::f64::consts::PI / 1000.0)).fold(f64::MAX, f64::min)
}

/// Starts inside, outside, and on the axes, from which the first correction leads to the farthest point.
#[test]
fn the_nearest_point_of_an_ellipse_is_found_from_near_its_centre() {
    for (m, start) in [
        (1.0, [0.1, 0.1]),
        (1.0, [0.1, 0.0]),
        (1.0, [-0.3, 1e-9]),
        (1.0, [0.0, 1e-3]),
        (1.0, [3.0, 5.0]),
        (1.0, [1.999, 0.0]),
        (0.2, [0.7, 0.4]),
        (30.0, [-0.2, 0.3]),
    ] {
        let ellipse = Ellipse { m };
        let (state, moved) = ellipse.make_consistent(&State::at_rest(start)).unwrap();
        let distance = (m * moved.q[0].powi(2) + moved.q[1].powi(2)).sqrt();
        let least = least_distance(m, start);
        assert!(
            (distance - least).abs() < 1e-5 * least.max(1e-3),
            "{start:?}: {distance} for {least}, {state}"
        );
        // M (q − q₀) is parallel to the normal, (x/2, 2 y).
        let along = m * moved.q[0] * 2.0 * state.q[1] - moved.q[1] * state.q[0] / 2.0;
        assert!(along.abs() < 1e-14 * (1.0 + start[0].abs() + start[1].abs()), "{start:?}: {along:e}");
    }
}

/// A varying mass matrix and two surfaces.
#[derive(Lagrangian)]
#[coordinates(x, y, z, w)]
#[lagrangian(m[0]/2*(1 + x^2)*x_dot^2 + m[1]/2*y_dot^2 + m[2]/2*(2 + sin(y))*z_dot^2 + m[3]/2*w_dot^2 + n*x_dot*z_dot)]
#[constraint(oval: a[0]*x^2 + a[1]*y^2 + a[2]*z^2 + a[3]*w^2 + a[4]*x*y + a[5]*sin(z)*w = 1)]
#[constraint(saddle: w = b[0]*x*y + b[1]*z^2 + b[2]*cos(x + t))]
struct Curve {
    m: [f64; 4],
    n: f64,
    a: [f64; 6],
    b: [f64; 3],
}

/// Tests random curves with starts up to three times their size away. The result satisfies the equations of the nearest point, evaluated independently, and no point
/// nearby is nearer.
#[test]
fn what_is_found_satisfies_the_equations_of_the_nearest_point() {
    let count = cases([20, 40, 100_000]);
    let (mut random, mut worst, mut refused, mut nearer) = (Random(1), 0.0_f64, 0, 0);
    for _ in 0..count {
        let mut next = || random.number();
        let curve = Curve {
            m: [0; 4].map(|_| 1.0 + 0.8 * next()),
            n: 0.1 * next(),
            a: [1.0, 1.0, 1.0, 1.0, 0.0, 0.0].map(|about| about + 0.5 * next()),
            b: [0; 3].map(|_| 0.7 * next()),
        };
        let given = State::at_rest([0; 4].map(|_| 3.0 * next())).at_time(next());
        // From far away, Newton's iteration may not reach the constraints.
        let Ok((state, moved)) = curve.make_consistent(&given) else {
            refused += 1;
            continue;
        };
        let (m, f) = (curve.mass_matrix(&given), curve.constraint_jacobian(&state));
        let normals = DMatrix::from_fn(4, 2, |i, a| f[(a, i)]);
        let pull = DVector::from_iterator(4, (m * moved.q).iter().copied());
        let multipliers = normals.clone().svd(true, true).solve(&pull, 0.0).unwrap();
        let size = pull.amax().max(m.amax() * (state.q.amax() + given.q.amax()));
        let off = (&pull - &normals * &multipliers).amax() / size;
        assert!(off < 1e-12, "{off:e} from {given} to {state}");
        worst = worst.max(off);
        let square = |state: &State<f64, 4>| ((state.q - given.q).transpose() * m * (state.q - given.q))[0];
        for _ in 0..4 {
            let mut near = state;
            near.q.iter_mut().for_each(|x| *x += 1e-3 * next());
            let near = curve.make_consistent(&near).unwrap().0;
            nearer += usize::from(square(&near) < square(&state) * (1.0 - 1e-9));
        }
    }
    println!(
        "{count}, of which {refused} were not projected; off by at most {worst:.1e}; {nearer} points nearby are nearer"
    );
    assert_eq!(nearer, 0);
    assert!(50 * refused <= count, "{refused}");
}

/// A quaternion has no mass along itself; its nearest unit quaternion is parallel to it.
#[test]
fn a_quaternion_is_made_one_of_length_1() {
    #[derive(Lagrangian)]
    #[coordinates(q: [4])]
    #[define(w = quat_rate_body(q, q_dot))]
    #[lagrangian((w[0]^2 + 2*w[1]^2 + 3*w[2]^2)/2)]
    #[constraint(unit: (dot(q, q) - 1)/2 = 0)]
    struct Body;
    let given = State::new([1.2, -0.4, 0.6, 1.8], [0.0; 4]);
    let (state, _) = Body.make_consistent(&given).unwrap();
    let expected: Vec<f64> = given.q.iter().map(|x| x / given.q.norm()).collect();
    assert!(state.q.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-15), "{state}");
}

/// A chain of 16 rods that starts far from its constraints: at first the distance has negative curvature along
/// most directions.
#[test]
fn a_chain_is_nearest_too() {
    #[derive(Lagrangian)]
    #[coordinates(r: [16, 2])]
    #[lagrangian(sum(i in 0..16, dot(r_dot[i], r_dot[i])/2 - r[i][1]))]
    #[constraint(first: dot(r[0], r[0]) = 1)]
    #[constraint(rod[i in 1..16]: dot(r[i] - r[i-1], r[i] - r[i-1]) = 1)]
    struct Chain;
    let along = |k: usize| if k.is_multiple_of(2) { 0.9 * (k / 2 + 1) as f64 } else { 0.0 };
    let given = State::at_rest(std::array::from_fn(|k| 0.2 * (0.31 * k as f64).sin() + along(k)));
    let (state, moved) = Chain.make_consistent(&given).unwrap();
    let normals = Chain.constraint_jacobian(&state).transpose();
    let normals = DMatrix::from_fn(32, 16, |i, a| normals[(i, a)]);
    let pull = DVector::from_column_slice(moved.q.as_slice());
    let multipliers = normals.clone().svd(true, true).solve(&pull, 0.0).unwrap();
    let off = (&pull - normals * multipliers).amax();
    assert!(off < 1e-14, "{off:e}");
}
