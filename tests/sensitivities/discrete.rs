//! Systems in discrete time: A and B are the derivatives of the map of an interval.

use lagrange_core::linearized::{DifferentiableMethod, DiscreteTime};
use lagrange_core::nalgebra::{Const, DMatrix, DVector};
use lagrange_core::{Dual, prelude::*, runge_kutta_step};

use crate::differences::{changed, difference, flat, flow, names};
use crate::{BEAD, DAMPED, bead_start};

/// A pole on a cart that a spring holds, whose third derivative is not there at x = 0; the angle is measured from the upright.
#[derive(Clone, Debug, Lagrangian)]
#[coordinates(x, theta)]
#[define(bob = [x + l*sin(theta), l*cos(theta)])]
#[lagrangian(cart/2*x_dot^2 + m/2*dot(der(bob), der(bob)) - m*g*bob[1] - k*x^(5/2))]
#[dissipation(c/2*theta_dot^2)]
#[force(x: push)]
struct CartPole<T> {
    cart: T,
    m: T,
    l: T,
    g: T,
    c: T,
    push: T,
    k: T,
}

const CART_POLE: CartPole<f64> = CartPole { cart: 1.0, m: 0.2, l: 0.6, g: 9.81, c: 0.02, push: 3.0, k: 0.1 };

/// Steps of the classical method over dual numbers, on which nothing is factored and no equation differentiated.
fn by_dual_numbers(state: &State<f64, 2>, h: f64, steps: usize, j: usize) -> DVector<f64> {
    let dual = |value: f64, slope: f64| Dual { value, slope };
    let at = |k: usize| if k == j { 1.0 } else { 0.0 };
    let CartPole { cart, m, l, g, c, push, k } = CART_POLE;
    let [cart, l, g, c, k] = [cart, l, g, c, k].map(|x| dual(x, 0.0));
    let over = CartPole { cart, m: dual(m, at(4)), l, g, c, push: dual(push, at(5)), k };
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
            let exact = by_dual_numbers(&state, h, steps, j);
            let off = (found - &exact).amax() / exact.amax();
            assert!(off < 1e-14, "column {j} after {steps} steps: off by {off:e} of itself");
        }
    }
}

/// The state is that of a motion that is kept, bit for bit, whatever interval came before; so are its derivatives, but for one
/// more projection.
#[test]
fn intervals_are_motions_with_derivatives() {
    let start = State::new([1.0], [0.5]);
    same(&DAMPED, start, Radau::default(), &["c", "a"]);
    same(&BEAD, bead_start(), RungeKutta4::with_step(0.07), &["k", "c"]);
}

fn same<S, D, const N: usize>(system: &S, start: State<f64, N>, method: D, inputs: &[&str])
where
    S: Linearized<N = Const<N>, Scalar = f64> + Clone,
    D: DifferentiableMethod<S> + Copy,
{
    let start = system.make_consistent(&start).unwrap().0;
    let mut discrete = DiscreteTime::new(system.clone(), method, inputs).unwrap();
    let names = names::<S>();
    let names: Vec<&str> = names[..2 * N].iter().map(String::as_str).chain(inputs.iter().copied()).collect();
    for end in [1.3, 0.4, 0.9] {
        discrete.advance(&start, end).unwrap();
        let kept = system.integrate_sensitivities(start, end, method, &names).unwrap();
        let kept = kept.derivatives_at_end().unwrap();
        assert_eq!(*discrete.state(), kept.state, "{}", S::NAME);
        let all = flow(kept);
        let off = (discrete.a() - all.columns(0, 2 * N)).amax();
        let off = off.max((discrete.b() - all.columns(2 * N, inputs.len())).amax()) / all.amax();
        let allowed = if S::CONSTRAINTS.is_empty() { 0.0 } else { 1e-14 };
        assert!(off <= allowed, "{}: off by {off:e}", S::NAME);
    }
}

/// On constraints, images of changes along them are those of differences of motions by the same steps, but for what a step leaves
/// to the projection.
#[test]
fn on_constraints_the_map_has_its_derivatives() {
    let start = BEAD.make_consistent(&bead_start()).unwrap().0;
    let method = RungeKutta4::with_step(0.005);
    let mut discrete = DiscreteTime::new(BEAD, method, &["k"]).unwrap();
    discrete.advance(&start, 1.0).unwrap();
    for j in 0..7 {
        // The stiffness is the last of six parameters.
        let exact = difference(2e-3, |by| {
            let (bead, start) = changed(&BEAD, &start, if j < 6 { j } else { 11 }, by).unwrap();
            flat(bead.integrate(start, 1.0, method).unwrap().end().state())
        });
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
            let (pole, state) = changed(&CART_POLE, &state, [0, 1, 2, 3, 5, 9][j], by).unwrap();
            let mut discrete = new(pole);
            discrete.advance(&state, end).unwrap();
            let by = |matrix: &DMatrix<f64>| matrix.tr_mul(&weight).iter().copied().collect::<Vec<_>>();
            DVector::from_vec([by(discrete.a()), by(discrete.b())].concat())
        };
        let exact = difference(2e-3, gradient);
        let off = (second.column(j) - &exact).amax();
        assert!(off < 1e-10 * second.amax(), "column {j}: off by {off:e} of {:e}", exact.amax());
    }
    assert!((&second - second.transpose()).amax() < 1e-13 * second.amax());
    let fixed = |matrix: &DMatrix<f64>| matrix.iter().all(|x| *x == 0.0);
    assert!(fixed(&new(CART_POLE).second_derivatives(&state, 1.0, &weights).unwrap()));
}

#[test]
fn an_interval_of_no_length_changes_nothing() {
    let mut discrete = DiscreteTime::new(DAMPED, Radau::default(), &["c"]).unwrap();
    let state = State::new([0.3], [-0.5]);
    discrete.advance(&state, 0.0).unwrap();
    assert_eq!((*discrete.state(), discrete.a()), (state, &DMatrix::identity(2, 2)));
    assert_eq!(*discrete.b(), DMatrix::zeros(2, 1));
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
    let weights = [[1.0, 0.0].into(), [0.0, 0.0].into()];
    let second = discrete.second_derivatives(&State::at_rest([0.0, 2.0]), 0.1, &weights).unwrap_err();
    assert!(second.to_string().contains("`x`"), "{second}");
    discrete.system_mut().k = f64::NAN;
    assert!(discrete.second_derivatives(&state, 0.1, &weights).is_err());
    discrete.system_mut().k = 0.1;
    discrete.system_mut().m = f64::NAN;
    let broken = discrete.advance(&state, 0.1).unwrap_err();
    assert!(broken.to_string().contains("m"), "{broken}");
    assert_eq!(kept, (*discrete.state(), discrete.a().clone(), discrete.b().clone()));
}
