//! Systems in discrete time: A and B are the derivatives of the map of an interval.

use lagrange_core::linearized::{DifferentiableMethod, DiscreteTime};
use lagrange_core::nalgebra::{DMatrix, DVector};
use lagrange_core::{Dual, prelude::*, runge_kutta_step};

use crate::{ChaplyginSleigh, DAMPED, SliderCrank};

/// A pole on a cart; the angle is measured from the upright.
#[derive(Clone, Debug, Lagrangian)]
#[coordinates(x, theta)]
#[define(bob = [x + l*sin(theta), l*cos(theta)])]
#[lagrangian(cart/2*x_dot^2 + m/2*dot(der(bob), der(bob)) - m*g*bob[1])]
#[dissipation(c/2*theta_dot^2)]
#[force(x: push)]
struct CartPole<T> {
    cart: T,
    m: T,
    l: T,
    g: T,
    c: T,
    push: T,
}

const CART_POLE: CartPole<f64> = CartPole { cart: 1.0, m: 0.2, l: 0.6, g: 9.81, c: 0.02, push: 3.0 };

/// A force whose second derivative is not there at x = 0.
#[derive(Clone, Debug, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - k*x^(5/2))]
struct Root<T> {
    k: T,
}

/// Steps of the classical method over dual numbers, on which nothing is factored and no equation differentiated.
fn by_dual_numbers(
    pole: &CartPole<f64>,
    state: &State<f64, 2>,
    h: f64,
    steps: usize,
    j: usize,
) -> DVector<f64> {
    let dual = |value: f64, slope: f64| Dual { value, slope };
    let at = |k: usize| if k == j { 1.0 } else { 0.0 };
    let CartPole { cart, m, l, g, c, push } = *pole;
    let over = CartPole {
        cart: dual(cart, 0.0),
        m: dual(m, at(4)),
        l: dual(l, 0.0),
        g: dual(g, 0.0),
        c: dual(c, 0.0),
        push: dual(push, at(5)),
    };
    let mut state = State {
        t: dual(state.t, 0.0),
        q: [0, 1].map(|i| dual(state.q[i], at(i))).into(),
        v: [0, 1].map(|i| dual(state.v[i], at(2 + i))).into(),
    };
    for _ in 0..steps {
        state = runge_kutta_step(&over, &state, dual(h, 0.0));
    }
    DVector::from_iterator(4, state.q.iter().chain(&state.v).map(|x| x.slope))
}

#[test]
fn the_map_of_the_classical_method_has_its_derivatives() {
    let state = State::new([0.3, 2.0], [-0.5, 4.0]).at_time(1.0);
    for steps in [1, 7] {
        let h = 0.05;
        let mut discrete = DiscreteTime::new(CART_POLE, RungeKutta4::with_step(h), &["m", "push"]).unwrap();
        discrete.advance(&state, 1.0 + h * steps as f64).unwrap();
        for j in 0..6 {
            let found = if j < 4 { discrete.a().column(j) } else { discrete.b().column(j - 4) };
            let exact = by_dual_numbers(&CART_POLE, &state, h, steps, j);
            let off = (found - &exact).amax() / exact.amax();
            assert!(off < 1e-14, "column {j} after {steps} steps: off by {off:e} of itself");
        }
    }
}

/// The state is that of a motion that is kept, bit for bit, whatever interval came before; so are its derivatives, but for one
/// more projection.
#[test]
fn intervals_are_motions_with_derivatives() {
    same(&CART_POLE, State::new([0.3, 2.0], [-0.5, 4.0]), Dop853::default(), &["push", "l"]);
    same(&CART_POLE, State::new([0.3, 2.0], [-0.5, 4.0]), Taylor::default(), &["push", "l"]);
    same(&DAMPED, State::new([1.0], [0.5]), Radau::default(), &["c"]);
    let crank = SliderCrank { r: 0.3, l: 1.0, crank: 0.2, rod: 1.5, slider: 2.0, k: 1.0, c: 0.4 };
    let start = crank.make_consistent(&State::new([1.0, -0.25, 1.13], [0.5, 0.0, 0.0])).unwrap().0;
    same(&crank, start, Dopri5::with_tolerance(1e-8), &["k", "r"]);
    same(&crank, start, RungeKutta4::with_step(0.07), &["k", "r"]);
    let sleigh = ChaplyginSleigh { m: 1.1, a: 0.4, inertia: 0.3 };
    let start = sleigh.make_consistent(&State::new([0.0, 0.0, 0.5], [0.8, 0.4, 1.5])).unwrap().0;
    same(&sleigh, start, RungeKutta4::with_step(0.07), &["a"]);
}

fn same<S, D>(system: &S, start: lagrange_core::StateOf<S>, method: D, inputs: &[&str])
where
    S: Linearized<Scalar = f64> + Clone,
    D: DifferentiableMethod<S> + Copy,
{
    let mut discrete = DiscreteTime::new(system.clone(), method, inputs).unwrap();
    let mut names: Vec<String> = S::COORDINATES.iter().map(|name| (*name).into()).collect();
    names.extend(S::COORDINATES.iter().map(|name| format!("{name}_dot")));
    names.extend(inputs.iter().map(|name| (*name).into()));
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    for end in [1.3, 0.4, 0.9] {
        discrete.advance(&start, end).unwrap();
        let kept = system.integrate_sensitivities(start, end, method, &names).unwrap();
        let kept = kept.end().unwrap();
        assert_eq!(*discrete.state(), kept.state, "{}", S::NAME);
        let (states, rows) = (discrete.a().ncols(), S::COORDINATES.len());
        let all = DMatrix::from_fn(states, names.len(), |i, j| {
            if i < rows { kept.q[(i, j)] } else { kept.v[(i - rows, j)] }
        });
        let off = (discrete.a() - all.columns(0, states)).amax();
        let off = off.max((discrete.b() - all.columns(states, inputs.len())).amax()) / all.amax();
        let allowed = if S::CONSTRAINTS.is_empty() { 0.0 } else { 1e-14 };
        assert!(off <= allowed, "{}: off by {off:e}", S::NAME);
    }
}

/// On constraints, images of changes along them are those of differences of motions by the same steps, but for what a step leaves
/// to the projection.
#[test]
fn on_constraints_the_map_has_its_derivatives() {
    let crank = SliderCrank { r: 0.3, l: 1.0, crank: 0.2, rod: 1.5, slider: 2.0, k: 1.0, c: 0.4 };
    let start = crank.make_consistent(&State::new([1.0, -0.25, 1.13], [0.5, 0.0, 0.0])).unwrap().0;
    let method = RungeKutta4::with_step(0.01);
    let mut discrete = DiscreteTime::new(crank.clone(), method, &["k"]).unwrap();
    discrete.advance(&start, 0.5).unwrap();
    let vector = |state: &State<f64, 3>| DVector::from_iterator(6, state.q.iter().chain(&state.v).copied());
    for j in 0..7 {
        let moved = |by: f64| {
            let (mut crank, mut start) = (crank.clone(), start);
            match j {
                0..3 => start.q[j] += by,
                3..6 => start.v[j - 3] += by,
                _ => crank.k += by,
            }
            let start = crank.make_consistent(&start).unwrap().0;
            vector(crank.integrate(start, 0.5, method).unwrap().end().state())
        };
        let exact = crate::differences::difference(2e-3, moved);
        let found = if j < 6 { discrete.a().column(j) } else { discrete.b().column(0) };
        let off = (found - &exact).amax();
        assert!(off < 1e-9, "column {j}: off by {off:e} of {:e}", exact.amax());
    }
}

/// Against differences of A and B.
#[test]
fn the_map_of_the_classical_method_has_its_second_derivatives() {
    let state = State::new([0.3, 2.0], [-0.5, 4.0]).at_time(1.0);
    let weights = [[0.7, -1.1].into(), [0.4, 2.0].into()];
    let weight = DVector::from_column_slice(&[0.7, -1.1, 0.4, 2.0]);
    let new =
        |pole: CartPole<f64>| DiscreteTime::new(pole, RungeKutta4::with_step(0.05), &["m", "push"]).unwrap();
    // Five steps and a shorter one.
    let end = 1.27;
    let second = new(CART_POLE).second_derivatives(&state, end, &weights).unwrap();
    for j in 0..6 {
        let gradient = |by: f64| {
            let (mut pole, mut state) = (CART_POLE, state);
            match j {
                0 | 1 => state.q[j] += by,
                2 | 3 => state.v[j - 2] += by,
                4 => pole.m += by,
                _ => pole.push += by,
            }
            let mut discrete = new(pole);
            discrete.advance(&state, end).unwrap();
            let by = |matrix: &DMatrix<f64>| matrix.tr_mul(&weight).iter().copied().collect::<Vec<_>>();
            DVector::from_vec([by(discrete.a()), by(discrete.b())].concat())
        };
        let exact = crate::differences::difference(2e-3, gradient);
        let off = (second.column(j) - &exact).amax();
        assert!(off < 1e-10 * second.amax(), "column {j}: off by {off:e} of {:e}", exact.amax());
    }
    assert!((&second - second.transpose()).amax() < 1e-13 * second.amax());
    let fixed = |matrix: &DMatrix<f64>| matrix.iter().all(|x| *x == 0.0);
    assert!(fixed(&new(CART_POLE).second_derivatives(&state, 1.0, &weights).unwrap()));
}

#[test]
fn an_interval_of_no_length_changes_nothing() {
    let mut discrete = DiscreteTime::new(CART_POLE, Dop853::default(), &["push"]).unwrap();
    let state = State::new([0.3, 2.0], [-0.5, 4.0]);
    discrete.advance(&state, 0.0).unwrap();
    assert_eq!((*discrete.state(), discrete.a()), (state, &DMatrix::identity(4, 4)));
    assert_eq!(*discrete.b(), DMatrix::zeros(4, 1));
}

#[test]
fn what_fails_leaves_the_last_interval() {
    let new = |inputs: &[&str]| DiscreteTime::new(CART_POLE, RungeKutta4::with_step(0.1), inputs);
    let told = |inputs: &[&str]| new(inputs).unwrap_err().to_string();
    assert!(told(&["pull"]).contains("no parameter `pull`"), "{}", told(&["pull"]));
    assert!(told(&["push", "push"]).contains("`push`"), "{}", told(&["push", "push"]));
    assert!(told(&["x"]).contains("no parameter `x`"), "{}", told(&["x"]));
    let none = DiscreteTime::new(CART_POLE, RungeKutta4::with_step(-0.1), &[]).unwrap_err();
    assert!(none.to_string().contains("fixed step"), "{none}");
    let mut discrete = new(&["push"]).unwrap();
    let state = State::new([0.3, 2.0], [-0.5, 4.0]);
    discrete.advance(&state, 0.1).unwrap();
    let kept = (*discrete.state(), discrete.a().clone(), discrete.b().clone());
    let broken = discrete.advance(&State::new([0.3, f64::NAN], [0.0, 0.0]), 0.1).unwrap_err();
    assert!(broken.to_string().contains("theta"), "{broken}");
    assert!(discrete.advance(&state, f64::INFINITY).is_err());
    let mut at_root = DiscreteTime::new(Root { k: 1.0 }, RungeKutta4::with_step(0.1), &["k"]).unwrap();
    let weights = [[1.0].into(), [0.0].into()];
    let second = at_root.second_derivatives(&State::at_rest([0.0]), 0.1, &weights).unwrap_err();
    assert!(second.to_string().contains("`x`"), "{second}");
    at_root.system_mut().k = f64::NAN;
    assert!(at_root.second_derivatives(&State::at_rest([1.0]), 0.1, &weights).is_err());
    discrete.system_mut().m = f64::NAN;
    let broken = discrete.advance(&state, 0.1).unwrap_err();
    assert!(broken.to_string().contains("m"), "{broken}");
    assert_eq!(kept, (*discrete.state(), discrete.a().clone(), discrete.b().clone()));
}
