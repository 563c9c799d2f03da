//! Particles whose positions are one coordinate, an array of vectors.

use approx::assert_relative_eq;
use lagrange_core::nalgebra::{SVector, Vector3};
use lagrange_core::prelude::*;
use lagrange_random::Random;

/// Four masses joined by rods, with a wind along the second one's way and a pull at the third's height.
#[derive(Lagrangian)]
#[coordinates(r: [4, 3])]
#[lagrangian(sum(i in 0..4, m[i]/2*dot(r_dot[i], r_dot[i]) - m[i]*g*r[i][2]))]
#[constraint(rod[i in 0..3]: norm(r[i+1] - r[i])^2 = l[i]^2)]
#[force(r: [[t, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, r_dot[3][2]]])]
#[force(r[1]: wind - c*r_dot[1])]
#[force(r[2][2]: pull)]
#[force(r[k in 2..4, 1]: k*r[k][0])]
#[observable(area = cross(r[1] - r[0], r[2] - r[0]))]
#[observable(rates = r_dot[1..3][1])]
#[observable(corner = r[3][0..2])]
#[observable(tension = lambda(rod[2]))]
#[observable(felt = r_ddot[2])]
struct Chain {
    m: [f64; 4],
    l: [f64; 3],
    g: f64,
    c: f64,
    wind: Vector3<f64>,
    pull: f64,
}

fn chain() -> Chain {
    Chain {
        m: [1.0, 2.0, 0.5, 1.5],
        l: [1.0, 2.0, 1.5],
        g: 9.81,
        c: 0.3,
        wind: Vector3::new(1.0, -2.0, 0.5),
        pull: 4.0,
    }
}

/// At its rods' lengths, and moving along them at no rate: what is left of random numbers.
fn moving() -> State<f64, 12> {
    let random = &mut Random(2);
    let rough = State::new(random.vector(), random.vector());
    let (state, _) = chain().make_consistent(&rough.at_time(2.0)).unwrap();
    state
}

fn particle(of: &SVector<f64, 12>, i: usize) -> Vector3<f64> {
    of.fixed_rows::<3>(3 * i).into_owned()
}

/// Newton's second law with forces along the rods, which hold (r − r')·(r̈ − r̈') = −(ṙ − ṙ')².
#[test]
fn rods_between_particles_pull_as_newton_has_it() {
    let (chain, state) = (chain(), moving());
    let solution = chain.solve(&state).unwrap();
    let [r, v, a] =
        [state.q, state.v, solution.accelerations].map(|of| [0, 1, 2, 3].map(|i| particle(&of, i)));
    for i in 0..4 {
        let mut force = match i {
            0 => Vector3::new(state.t, 0.0, 0.0),
            1 => chain.wind - chain.c * v[1],
            2 => Vector3::new(0.0, 2.0 * r[2].x, chain.pull),
            _ => Vector3::new(0.0, 3.0 * r[3].x, v[3].z),
        };
        force.z -= chain.m[i] * chain.g;
        if i > 0 {
            force += 2.0 * solution.multipliers[i - 1] * (r[i] - r[i - 1]);
        }
        if i < 3 {
            force -= 2.0 * solution.multipliers[i] * (r[i + 1] - r[i]);
            let (d, u) = (r[i + 1] - r[i], v[i + 1] - v[i]);
            assert_relative_eq!(d.dot(&(a[i + 1] - a[i])), -u.dot(&u), max_relative = 1e-11);
        }
        assert_relative_eq!(chain.m[i] * a[i], force, max_relative = 1e-11);
    }
    assert_eq!(chain.tension(&state, &solution), solution.multipliers[2]);
    assert_eq!(chain.felt(&state, &solution), particle(&solution.accelerations, 2));
}

#[test]
fn rows_are_vectors_and_their_entries_numbers() {
    let (chain, state) = (chain(), moving());
    let r = |i| particle(&state.q, i);
    assert_relative_eq!(chain.area(&state), (r(1) - r(0)).cross(&(r(2) - r(0))), max_relative = 1e-13);
    assert_eq!(chain.rates(&state), particle(&state.v, 2));
    assert_eq!(chain.corner(&state), r(3).fixed_rows::<2>(0).into_owned());
}

#[test]
fn entries_are_named_by_both_of_their_indices() {
    assert_eq!(Chain::COORDINATES[..4], ["r[0][0]", "r[0][1]", "r[0][2]", "r[1][0]"]);
    assert_eq!(Chain::COORDINATES[7], "r[2][1]");
    let chain = chain();
    let state = chain.state_from(&[("r[2][1]", 1.5), ("r_dot[2][1]", -0.5)]).unwrap();
    assert_eq!((state.q[7], state.v[7]), (1.5, -0.5));
    assert_eq!((state.q.sum(), state.v.sum()), (1.5, -0.5));
    let unknown = chain.state_from(&[("r[4][1]", 1.5)]).unwrap_err().to_string();
    assert!(unknown.contains("r[4][1]"), "{unknown}");
}

#[test]
fn equations_are_written_with_both_indices() {
    let equations = Chain::equations();
    let text = equations.text();
    assert!(text.contains("r̈[3][1]") && text.contains("rod[i = 0 … 2]"), "{text}");
    assert!(text.contains("Q_r[k = 2 … 3][1]"), "{text}");
    assert!(equations.latex().contains(r"\ddot r_{3, 1}"), "{}", equations.latex());
}

/// A potential of all entries: the field of two fixed centres on two particles.
struct Centres;

impl Function<6, 1> for Centres {
    fn eval<S: Scalar>(&self, r: [S; 6]) -> [S; 1] {
        let square = |i: usize| (0..3).fold(S::constant(0.0), |sum, k| sum + r[3 * i + k] * r[3 * i + k]);
        [(square(0) * S::constant(3.0) + square(1)) * S::constant(0.5) + r[2] * r[3]]
    }
}

/// The rows of a matrix that depends on the time.
struct Drift;

impl Function<1, 6> for Drift {
    fn eval<S: Scalar>(&self, [t]: [S; 1]) -> [S; 6] {
        std::array::from_fn(|k| t * S::constant(k as f64))
    }
}

#[derive(Lagrangian)]
#[coordinates(r: [2, 3])]
#[function(U(r) = centres)]
#[function(a(t): [2, 3] = drift)]
#[lagrangian(sum(i in 0..2, dot(r_dot[i], r_dot[i])/2) - U(r))]
#[force(r: a(t))]
struct Pair {
    centres: Centres,
    drift: Drift,
}

#[test]
fn functions_take_and_give_arrays_of_vectors() {
    let pair = Pair { centres: Centres, drift: Drift };
    let q = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    let state = State { t: 0.5, ..State::at_rest(q) };
    let expected = [-3.0, -6.0 + 0.5, -9.0 - 4.0 + 1.0, -4.0 - 3.0 + 1.5, -5.0 + 2.0, -6.0 + 2.5];
    assert_eq!(pair.solve(&state).unwrap().accelerations, SVector::from(expected));
    let text = Pair::equations().text();
    assert!(text.contains("∂U/∂r[1]") && text.contains("a[1](t)"), "{text}");
}
