//! Fields of every kind on lanes: each member keeps its own.

use lagrange_core::nalgebra::{SMatrix, Vector2};
use lagrange_core::prelude::*;
use lagrange_core::{Lanes, Pack};

use crate::noise;

#[derive(Lagrangian, Clone)]
#[coordinates(r: [2])]
#[lagrangian(m/2*dot(r_dot, r_dot) + dot(b, r) + dot(w, a*r) - k[1]*dot(r, r)/2 - rows[1][0]*r[0]^4 - rows[0][1]*r[1]^2)]
struct Shaped<T> {
    m: T,
    k: [T; 2],
    b: Vector2<T>,
    w: [T; 2],
    a: SMatrix<T, 2, 2>,
    rows: [[T; 2]; 2],
    /// Nothing uses it.
    name: &'static str,
}

fn shaped(index: usize) -> Shaped<f64> {
    let n = |entry| 0.5 + noise(index, entry);
    Shaped {
        m: n(0),
        k: [n(1), n(2)],
        b: [n(3), n(4)].into(),
        w: [n(5), n(6)],
        a: SMatrix::from_row_slice(&[n(7), n(8), n(9), n(10)]),
        rows: [[n(11), n(12)], [n(13), n(14)]],
        name: ["even", "odd"][index % 2],
    }
}

#[test]
fn numbers_arrays_vectors_and_matrices_have_their_lanes() {
    let systems: [Shaped<f64>; 4] = std::array::from_fn(|lane| shaped(2 * lane));
    let mut packed: Shaped<Lanes> = systems[0].pack();
    for (lane, system) in systems.iter().enumerate().skip(1) {
        assert!(system.place(&mut packed, lane));
    }
    let state = |lane: usize| State::new([noise(lane, 20), noise(lane, 21)], [0.3, noise(lane, 22)]);
    let entry = |pick: fn(&State<f64, 2>) -> f64| Lanes::from(std::array::from_fn(|lane| pick(&state(lane))));
    let lanes = State::new([entry(|s| s.q[0]), entry(|s| s.q[1])], [entry(|s| s.v[0]), entry(|s| s.v[1])]);
    let accelerations = packed.accelerations_unchecked(&lanes).accelerations;
    for (lane, system) in systems.iter().enumerate() {
        let alone = system.accelerations_unchecked(&state(lane)).accelerations;
        for i in 0..2 {
            assert_eq!(accelerations[i].to_array()[lane], alone[i], "lane {lane}");
        }
    }
}

#[test]
fn a_member_with_another_shared_field_does_not_fit() {
    let (even, odd) = (shaped(0), shaped(1));
    let mut packed: Shaped<Lanes> = even.pack();
    let before = packed.clone();
    assert!(!odd.place(&mut packed, 1));
    assert_eq!((packed.m, packed.a, packed.name), (before.m, before.a, "even"));
    assert!(shaped(2).place(&mut packed, 1) && packed.m != before.m);
}

#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Power {
    strength: f64,
}

impl Function<1, 1> for Power {
    fn eval<S: Scalar>(&self, [x]: [S; 1]) -> [S; 1] {
        [S::constant(self.strength) * x * x * x * x]
    }
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[function(U(x) = potential)]
#[lagrangian(m/2*x_dot^2 - U(x))]
pub(crate) struct Trapped<T> {
    m: T,
    potential: Power,
}

/// Every third member has another potential, which no lane may take from its neighbour.
pub(crate) fn trapped(index: usize) -> (Trapped<f64>, State<f64, 1>) {
    let potential = Power { strength: [1.0, 1.0, 3.0][index % 3] };
    (Trapped { m: 1.0 + noise(index, 0), potential }, State::at_rest([1.0]))
}

#[test]
fn members_with_other_functions_do_not_mix() {
    let outcome = Ensemble::from_fn(20, trapped).integrate_on_lanes(3.0, Dop853::default()).unwrap();
    assert_eq!(outcome.completed().count(), 20);
    for (index, state) in outcome.completed() {
        let (system, start) = trapped(index);
        let path = system.integrate(start, 3.0, Dop853::default()).unwrap();
        assert!((state.q[0] - path.end().state().q[0]).abs() < 1e-12, "member {index}");
    }
}
