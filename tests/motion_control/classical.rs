//! The classical method on lanes, with derivatives, and where the mass matrix is singular or indefinite.

use lagrange_core::{Dual, Ending, Lanes, Pack, prelude::*, runge_kutta_step};
use lagrange_systems::{DrivenSpring, Spring};

use crate::spring_of;
use crate::steered::cart;

#[test]
fn the_classical_method_runs_on_lanes_and_carries_derivatives() {
    let lanes: [f64; Lanes::COUNT] = std::array::from_fn(|lane| (lane + 1) as f64);
    // Each lane has a step of its own.
    let (omegas, steps) = (lanes.map(|k| 0.5 * k), lanes.map(|k| 0.01 * k));
    let mut lanes = spring_of(omegas[0]).pack();
    for (lane, omega) in omegas.into_iter().enumerate() {
        assert!(spring_of(omega).place(&mut lanes, lane));
    }
    let one = Lanes::constant;
    let mut state = State { t: one(0.0), q: [one(1.0)].into(), v: [one(0.0)].into() };
    let mut alone = omegas.map(|_| State::at_rest([1.0]));
    // ∂x/∂k at k = 1, through the steps.
    let stiffened = Spring { m: Dual::constant(1.0), k: Dual { value: 1.0_f64, slope: 1.0 } };
    let mut dual = State::at_rest([Dual::constant(1.0)]);
    for _ in 0..200 {
        state = runge_kutta_step(&lanes, &state, Lanes::from(steps));
        dual = runge_kutta_step(&stiffened, &dual, Scalar::constant(0.02));
        for (lane, alone) in alone.iter_mut().enumerate() {
            *alone = runge_kutta_step(&spring_of(omegas[lane]), alone, steps[lane]);
        }
    }
    for (lane, alone) in alone.iter().enumerate() {
        assert!((state.q[0].to_array()[lane] - alone.q[0]).abs() < 1e-13);
        assert_eq!(state.t.to_array()[lane], alone.t);
    }
    assert!((dual.q[0].value - 4_f64.cos()).abs() < 1e-7);
    assert!((dual.q[0].slope + 2.0 * 4_f64.sin()).abs() < 5e-7);
}

/// Of −L the motion is that of L, but its mass matrix is none that the elimination vouches for, nor one with a coupling
/// larger than the masses: the method solves in general, the plain step says that it is not a number.
#[test]
fn the_classical_method_solves_in_general_where_it_can() {
    #[derive(Lagrangian, Clone, Copy)]
    #[coordinates(x, y)]
    #[lagrangian(1/2*(m*x_dot^2 + y_dot^2) + 2*x_dot*y_dot - x^2/2 - y^2/2)]
    struct Indefinite {
        m: f64,
    }
    let system = Indefinite { m: 1e-9 };
    let start = State::new([0.3, 0.1], [0.0, 0.2]);
    assert!(runge_kutta_step(&system, &start, 0.01).q[0].is_nan());
    let path = system.integrate(start, 1.0, RungeKutta4::with_step(0.01)).unwrap();
    let exact = system.integrate(start, 1.0, Dop853::default()).unwrap();
    assert!((path.end().state().q - exact.end().state().q).norm() < 1e-8);
}

/// Its mass matrix is singular where the mass is nothing: in that lane, and in no other.
#[test]
fn the_classical_method_is_not_a_number_where_nobody_can_vouch() {
    let mut lanes = cart(1.0, 0.0).pack();
    assert!(cart(0.0, 0.0).place(&mut lanes, 2));
    let one = Lanes::constant;
    let state = State { t: one(0.0), q: [one(1.0)].into(), v: [one(1.0)].into() };
    let next = runge_kutta_step(&lanes, &state, one(0.1));
    let (q, v) = (next.q[0].to_array(), next.v[0].to_array());
    for lane in 0..Lanes::COUNT {
        assert_eq!((q[lane].is_nan(), v[lane].is_nan()), (lane == 2, lane == 2));
    }
    let massless = DrivenSpring { a: 1.0, ..cart(0.0, 0.0) };
    assert!(runge_kutta_step(&massless, &State::at_rest([0.0]), 0.1).q[0].is_nan());
    let cart = DrivenSpring { m: 1.0, ..massless };
    let mut motion = Motion::new(cart, State::at_rest([0.0]), RungeKutta4::with_step(0.1)).unwrap();
    motion.system_mut().m = 0.0;
    let ending = motion.advance_by(1.0).unwrap_err();
    assert!(matches!(ending, Ending::Singular { time: 0.0, .. }), "{ending}");
}
