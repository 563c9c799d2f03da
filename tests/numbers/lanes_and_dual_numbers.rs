//! f64, f32, SIMD lanes and dual numbers through the same generic struct, and through a function that is supplied to it.

use lagrange_core::function::{FunctionWithDerivatives, WithDerivatives};
use lagrange_core::{Dual, nalgebra::Const, prelude::*};
use num_dual::Dual64;
use simba::simd::{SimdValue, WideF64x4};

/// x⁴/4 + sin(y)
#[derive(Clone, Copy)]
struct Valley;

impl Function<2, 1> for Valley {
    fn eval<S: Scalar>(&self, [x, y]: [S; 2]) -> [S; 1] {
        [x * x * x * x * S::constant(0.25) + y.sin()]
    }
}

/// The same by hand.
#[derive(Clone, Copy)]
struct ValleyByHand;

impl FunctionWithDerivatives<2, 1> for ValleyByHand {
    fn value(&self, [x, y]: [f64; 2]) -> [f64; 1] {
        [x.powi(4) / 4.0 + y.sin()]
    }

    fn gradient(&self, [x, y]: [f64; 2]) -> [[f64; 2]; 1] {
        [[x.powi(3), y.cos()]]
    }

    fn hessian(&self, [x, y]: [f64; 2]) -> [[[f64; 2]; 2]; 1] {
        [[[3.0 * x * x, 0.0], [0.0, -y.sin()]]]
    }
}

/// A pendulum on a string whose length changes, with a spring, friction and a motor, over a valley that pulls at the string
/// too: constants, `pi`, powers, elementary functions and second derivatives of a supplied one all occur.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y)]
#[function(U(x, y) = valley)]
#[define(length = l*(1 + exp(-t)/4))]
#[define(spring = k/3*(2 + x^2)^(4/3)*cos(pi*t/2) - 2/5*k*atan2(y_dot, 2)*x)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y - spring - U(x, y) - k*U(y, y))]
#[constraint(string: (x^2 + y^2 - length^2)/2 + U(y, x)/9 = 0)]
#[dissipation(k/7*sqrt(1 + x_dot^2)*(2 + tanh(y)))]
#[force(y: k*sin(t)*abs(x_dot))]
#[observable(height = y + length)]
#[observable(tension = -lambda(string)*length)]
#[observable(acceleration = [der(x_dot), y_ddot])]
#[observable(depth = U(x, y))]
struct Pendulum<T, F> {
    m: T,
    g: T,
    l: T,
    k: T,
    valley: F,
}

/// m, g, l, k, t, x, y, ẋ, ẏ.
type Inputs = [f64; 9];

const INPUTS: [Inputs; 4] = [
    [1.0, 9.81, 1.2, 0.7, 0.3, 0.4, -0.9, 1.1, 0.2],
    [0.5, 1.62, 0.8, 1.7, 2.3, -0.6, 0.5, -0.3, 0.9],
    [2.0, 3.71, 0.5, 0.1, 0.0, 0.2, 0.7, -1.3, -0.4],
    [1.5, 24.8, 2.0, 3.0, 1.1, -1.4, -0.8, 0.6, -1.9],
];

/// Everything that the trait gives, in one list.
fn everything_with<T: Scalar, F>([m, g, l, k, t, x, y, vx, vy]: [T; 9], valley: F) -> Vec<T>
where
    Pendulum<T, F>: Lagrangian<N = Const<2>, M = Const<1>, Scalar = T>,
{
    let pendulum = Pendulum { m, g, l, k, valley };
    let state = State::new([x, y], [vx, vy]).at_time(t);
    let solution = pendulum.accelerations_unchecked(&state);
    let mut all = vec![pendulum.lagrangian(&state), pendulum.energy(&state), solution.pivot];
    all.extend(&pendulum.momentum(&state));
    all.extend(&pendulum.mass_matrix(&state));
    all.extend(&pendulum.forcing(&state));
    all.extend(&pendulum.constraint_residual(&state));
    all.extend(&pendulum.constraint_rate(&state));
    all.extend(&pendulum.constraint_jacobian(&state));
    all.extend(&pendulum.constraint_bias(&state));
    all.extend(&pendulum.constraint_force(&state, &solution.multipliers));
    all.extend(&solution.accelerations);
    all.extend(&solution.multipliers);
    all.extend((0..6).map_while(|index| pendulum.observable(index, &state, &solution)));
    // L, E and the pivot; p, M, h; Φ, dΦ/dt, F, γ, Fᵀλ; q̈, λ; observables.
    assert_eq!(all.len(), 3 + (2 + 4 + 2) + (1 + 1 + 2 + 1 + 2) + 3 + 5);
    all
}

fn everything<T: Scalar>(inputs: [T; 9]) -> Vec<T>
where
    Pendulum<T, Valley>: Lagrangian<N = Const<2>, M = Const<1>, Scalar = T>,
{
    everything_with(inputs, Valley)
}

#[test]
fn observables_are_what_they_say() {
    let [m, g, l, k, t, x, y, vx, vy] = INPUTS[0];
    let pendulum = Pendulum { m, g, l, k, valley: Valley };
    let state = State::new([x, y], [vx, vy]).at_time(t);
    let solution = pendulum.accelerations_unchecked(&state);
    let length = l * (1.0 + (-t).exp() / 4.0);
    assert!((pendulum.height(&state) - (y + length)).abs() < 1e-15);
    let tension = -solution.multipliers[0] * length;
    assert!((pendulum.tension(&state, &solution) - tension).abs() < 1e-14 * tension.abs());
    assert_eq!(pendulum.acceleration(&state, &solution), solution.accelerations);
    assert!((pendulum.depth(&state) - (x.powi(4) / 4.0 + y.sin())).abs() < 1e-15);
    let names = ["height", "tension", "acceleration[0]", "acceleration[1]", "depth"];
    assert_eq!(Pendulum::<f64, Valley>::OBSERVABLES, names);
    let by_method = [pendulum.height(&state), pendulum.tension(&state, &solution)];
    let by_method = by_method.into_iter().chain(solution.accelerations.iter().copied());
    let by_index = (0..5).map_while(|index| pendulum.observable(index, &state, &solution));
    assert!(by_index.eq(by_method.chain([pendulum.depth(&state)])));
}

#[test]
fn a_function_by_hand_is_the_same_as_one_for_every_scalar() {
    for inputs in INPUTS {
        let by_hand = everything_with(inputs, WithDerivatives(ValleyByHand));
        for (x, y) in everything(inputs).iter().zip(by_hand) {
            assert!((x - y).abs() <= 1e-14 * x.abs().max(1.0), "{x} and {y}");
        }
    }
}

#[test]
fn single_precision_agrees_to_its_digits() {
    for inputs in INPUTS {
        let double = everything(inputs);
        let single = everything(inputs.map(|x| x as f32));
        for (index, (&x, &y)) in double.iter().zip(&single).enumerate() {
            let error = (x - f64::from(y)).abs() / x.abs().max(1.0);
            assert!(error < 4e-6, "entry {index} of {inputs:?}: {x} and {y} differ by {error:e}");
        }
    }
}

#[test]
fn each_lane_is_a_system_of_its_own() {
    let lanes = everything::<WideF64x4>(std::array::from_fn(|i| INPUTS.map(|inputs| inputs[i]).into()));
    for (lane, inputs) in INPUTS.into_iter().enumerate() {
        for (index, (&x, y)) in everything(inputs).iter().zip(&lanes).enumerate() {
            let y = y.extract(lane);
            // A few roundings, which the elimination passes on.
            assert!((x - y).abs() <= 2e-15 * x.abs(), "entry {index} in lane {lane}: {x} and {y}");
        }
    }
}

/// Everything along a straight line through the inputs.
fn along(inputs: Inputs, direction: Inputs, s: f64) -> Vec<f64> {
    everything(std::array::from_fn(|i| inputs[i] + s * direction[i]))
}

/// The slope by central differences of sixth order.
fn slope(inputs: Inputs, direction: Inputs) -> Vec<f64> {
    const STEP: f64 = 2e-3;
    let differences = [1.0, 2.0, 3.0].map(|k| {
        let (right, left) = (along(inputs, direction, k * STEP), along(inputs, direction, -k * STEP));
        right.into_iter().zip(left).map(|(right, left)| right - left).collect::<Vec<_>>()
    });
    let [near, middle, far] = differences;
    (0..near.len()).map(|i| (45.0 * near[i] - 9.0 * middle[i] + far[i]) / (60.0 * STEP)).collect()
}

#[test]
fn a_dual_number_carries_the_derivative() {
    let direction = [0.3, -0.7, 0.2, 0.5, 0.4, -0.3, 0.6, 0.8, -0.2];
    for inputs in INPUTS {
        let dual = everything(std::array::from_fn(|i| Dual64::new(inputs[i], direction[i])));
        let ours = everything(std::array::from_fn(|i| Dual { value: inputs[i], slope: direction[i] }));
        let (values, slopes) = (everything(inputs), slope(inputs, direction));
        for (index, number) in dual.iter().enumerate() {
            let apart = (number.eps - ours[index].slope).abs() / number.eps.abs().max(1.0);
            assert!(apart < 1e-11, "entry {index}: {} and {}", number.eps, ours[index].slope);
            let (value, slope) = (values[index], slopes[index]);
            assert!((number.re - value).abs() <= 1e-13 * value.abs().max(1.0), "entry {index}");
            let error = (number.eps - slope).abs() / slope.abs().max(1.0);
            assert!(error < 1e-9, "entry {index}: {} and {slope} differ by {error:e}", number.eps);
        }
    }
}
