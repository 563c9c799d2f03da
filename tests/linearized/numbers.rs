//! Other number types, and functions that the user supplies.

use lagrange_core::function::{FunctionWithDerivatives, WithDerivatives};
use lagrange_core::nalgebra::SVector;
use lagrange_core::{Jacobian, Solution, linearized::Stability, prelude::*};
use num_dual::Dual64;

/// A bob on a spring whose upper end moves, in a wind, on a turning wire.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[define(end = [a*sin(w*t), 0])]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y - k/2*(norm([x, y] - end) - l)^2)]
#[dissipation(c/4*(x_dot^2 + y_dot^2)^2)]
#[constraint(wire: y_dot - x_dot*x*t = b*y)]
#[force(x: wind*exp(-y^2))]
struct Bob<T> {
    m: T,
    g: T,
    k: T,
    l: T,
    a: T,
    w: T,
    c: T,
    b: T,
    wind: T,
}

fn bob<T: Scalar>(parameters: [T; 9]) -> Bob<T> {
    let [m, g, k, l, a, w, c, b, wind] = parameters;
    Bob { m, g, k, l, a, w, c, b, wind }
}

const PARAMETERS: [f64; 9] = [1.3, 9.81, 20.0, 0.8, 0.3, 2.0, 0.7, 0.4, 1.5];
const ARGUMENTS: [f64; 5] = [0.9, 0.3, -0.7, 0.5, 1.1]; // t, q, v

/// Accelerations and multiplier with a dual number in one place.
fn dual(place: usize) -> (SVector<f64, 2>, f64) {
    let mut all = [ARGUMENTS.map(Dual64::from_re).as_slice(), &PARAMETERS.map(Dual64::from_re)].concat();
    all[place] = all[place].derivative();
    let state = State::new([all[1], all[2]], [all[3], all[4]]).at_time(all[0]);
    let Solution { accelerations, multipliers, .. } =
        bob(std::array::from_fn(|k| all[5 + k])).accelerations_unchecked(&state);
    (accelerations.map(|x| x.eps), multipliers[0].eps)
}

/// Through the emitted elimination, which shares nothing with the derivative of the residual.
#[test]
fn dual_numbers_put_through_the_elimination_give_the_same_jacobian() {
    let [t, x, y, vx, vy] = ARGUMENTS;
    let state = State::new([x, y], [vx, vy]).at_time(t);
    let Jacobian { accelerations: a, multipliers: l, .. } = bob(PARAMETERS).jacobian(&state).unwrap();
    let compare = |place, column: SVector<f64, 2>, multiplier: f64| {
        let (expected, expected_multiplier) = dual(place);
        assert!((column - expected).amax() <= 1e-13 * a.q.amax(), "{place}: {column} {expected}");
        assert!((multiplier - expected_multiplier).abs() <= 1e-13 * l.q.amax(), "{place}");
    };
    compare(0, a.t, l.t[0]);
    for i in 0..2 {
        compare(1 + i, a.q.column(i).into(), l.q[i]);
        compare(3 + i, a.v.column(i).into(), l.v[i]);
    }
    for k in 0..9 {
        compare(5 + k, a.parameters.column(k).into(), l.parameters[k]);
    }
    assert_eq!(Bob::<f64>::PARAMETERS, ["m", "g", "k", "l", "a", "w", "c", "b", "wind"]);
    assert_eq!(bob(PARAMETERS).parameters().as_slice(), PARAMETERS);
}

#[test]
fn single_precision_has_jacobians_equilibria_and_eigenvalues_too() {
    let [t, x, y, vx, vy] = ARGUMENTS;
    let wide = bob(PARAMETERS).jacobian(&State::new([x, y], [vx, vy]).at_time(t)).unwrap();
    let [t, x, y, vx, vy] = ARGUMENTS.map(|x| x as f32);
    let state = State::new([x, y], [vx, vy]).at_time(t);
    let narrow = bob(PARAMETERS.map(|x| x as f32)).jacobian(&state).unwrap();
    let difference = narrow.accelerations.q.map(f64::from) - wide.accelerations.q;
    assert!(difference.amax() < 1e-5 * wide.accelerations.q.amax(), "{difference}");

    let pendulum = Pendulum { g: 9.81_f32, l: 0.5 };
    let found = pendulum.equilibrium(&State::at_rest([0.4, -0.2]), &[]).unwrap();
    assert!((found.state.q[0]).abs() < 1e-7 && (found.state.q[1] + 0.5).abs() < 1e-7);
    let near = pendulum.linearize(&State::at_rest([0.0, -0.5]), &[]).unwrap();
    assert_eq!(near.a.shape(), (2, 2));
    assert!((near.natural_frequencies().unwrap()[0] - 19.62_f32.sqrt()).abs() < 1e-5);
    assert_eq!(near.stability(), Ok(Stability::Undecided));
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - g*y)]
#[constraint(rod: x^2 + y^2 = l^2)]
struct Pendulum {
    g: f32,
    l: f32,
}

/// Morse's potential D (1 − e^{−a s})².
#[derive(Clone)]
struct Morse {
    depth: f64,
    a: f64,
}

impl Function<1, 1> for Morse {
    fn eval<S: Scalar>(&self, [s]: [S; 1]) -> [S; 1] {
        let e = S::constant(1.0) - (S::constant(-self.a) * s).exp();
        [S::constant(self.depth) * e * e]
    }
}

impl FunctionWithDerivatives<1, 1> for Morse {
    fn value(&self, x: [f64; 1]) -> [f64; 1] {
        self.eval(x)
    }

    fn gradient(&self, [s]: [f64; 1]) -> [[f64; 1]; 1] {
        let e = (-self.a * s).exp();
        [[2.0 * self.depth * self.a * (1.0 - e) * e]]
    }

    fn hessian(&self, [s]: [f64; 1]) -> [[[f64; 1]; 1]; 1] {
        let e = (-self.a * s).exp();
        [[[2.0 * self.depth * self.a.powi(2) * (2.0 * e * e - e)]]]
    }
}

/// A molecule of two atoms that turns.
#[derive(Clone, Lagrangian)]
#[coordinates(r, phi)]
#[function(U(s) = bond)]
#[lagrangian(mass/2*(r_dot^2 + r^2*phi_dot^2) - U(r - length))]
struct Molecule<F> {
    mass: f64,
    length: f64,
    bond: F,
}

/// ω² = U″/m at rest. Second derivatives by hand are as good as any: the potential needs no more.
#[test]
fn a_supplied_potential_is_differentiated_once_more() {
    let bond = Morse { depth: 3.0, a: 1.2 };
    let frequency = (2.0 * 3.0 * 1.44 / 0.5_f64).sqrt();
    let general = Molecule { mass: 0.5, length: 2.0, bond: bond.clone() };
    let by_hand = Molecule { mass: 0.5, length: 2.0, bond: WithDerivatives(bond) };
    let found = general.equilibrium(&State::at_rest([2.3, 0.0]), &[]).unwrap();
    assert!((found.state.q[0] - 2.0).abs() < 1e-15);
    for near in [general.linearize(&found.state, &[]), by_hand.linearize(&found.state, &[])] {
        assert!((near.unwrap().natural_frequencies().unwrap()[0] - frequency).abs() < 1e-13);
    }
    // Turning at a rate Ω it is longer: m r Ω² = U′.
    let turning = State::new([2.1, 0.0], [0.0, 0.8]);
    let longer = by_hand.equilibrium(&turning, &["r"]).unwrap().state;
    let stretch = by_hand.bond.0.gradient([longer.q[0] - 2.0])[0][0];
    assert!((stretch - 0.5 * longer.q[0] * 0.64).abs() < 1e-15);
}
