//! f64, f32, SIMD lanes and dual numbers through the same generic struct.

use lagrange_core::prelude::*;
use num_dual::Dual64;
use simba::simd::{SimdValue, WideF64x4};

/// A pendulum on a string whose length changes, with a spring, friction and a motor: constants, `pi`, powers
/// and elementary functions all occur.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y)]
#[define(length = l*(1 + exp(-t)/4))]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y - k/3*(2 + x^2)^(4/3)*cos(pi*t/2) + 2/5*k*atan2(y_dot, 2)*x)]
#[constraint(string: (x^2 + y^2 - length^2)/2 = 0)]
#[dissipation(k/7*sqrt(1 + x_dot^2)*(2 + tanh(y)))]
#[force(y: k*sin(t)*abs(x_dot))]
#[observable(height = y + length)]
#[observable(tension = -lambda(string)*length)]
#[observable(acceleration = [der(x_dot), y_ddot])]
struct Pendulum<T> {
    m: T,
    g: T,
    l: T,
    k: T,
}

/// m, g, l, k, t, x, y, ẋ, ẏ.
type Inputs = [f64; 9];

const INPUTS: [Inputs; 4] = [
    [1.0, 9.81, 1.2, 0.7, 0.3, 0.4, -0.9, 1.1, 0.2],
    [0.5, 1.62, 0.8, 1.7, 2.3, -0.6, 0.5, -0.3, 0.9],
    [2.0, 3.71, 0.5, 0.1, 0.0, 0.2, 0.7, -1.3, -0.4],
    [1.5, 24.8, 2.0, 3.0, 1.1, -1.4, -0.8, 0.6, -1.9],
];

/// Everything that the trait and the observables give, in one list.
fn everything<T: Scalar>([m, g, l, k, t, x, y, vx, vy]: [T; 9]) -> Vec<T> {
    let pendulum = Pendulum { m, g, l, k };
    let state = State::new([x, y], [vx, vy]).at_time(t);
    let solution = pendulum.accelerations_unchecked(&state);
    let mut all = vec![pendulum.lagrangian(&state), solution.pivot];
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
    all.extend([pendulum.height(&state), pendulum.tension(&state, &solution)]);
    all.extend(&pendulum.acceleration(&state, &solution));
    all.extend((0..5).map_while(|index| pendulum.observable(index, &state, &solution)));
    all
}

#[test]
fn the_list_is_complete() {
    assert_eq!(Pendulum::<f64>::OBSERVABLES, ["height", "tension", "acceleration[0]", "acceleration[1]"]);
    // L and the pivot; p, M, h; Φ, dΦ/dt, F, γ, Fᵀλ; q̈, λ; each observable by its method and by its index.
    assert_eq!(everything(INPUTS[0]).len(), 2 + (2 + 4 + 2) + (1 + 1 + 2 + 1 + 2) + 3 + 4 + 4);
}

#[test]
fn observables_are_the_same_by_method_and_by_index() {
    for inputs in INPUTS {
        let all = everything(inputs);
        let (rest, by_index) = all.split_at(all.len() - 4);
        assert_eq!(&rest[rest.len() - 4..], by_index);
    }
}

#[test]
fn observables_are_what_they_say() {
    let [m, g, l, k, t, x, y, vx, vy] = INPUTS[0];
    let pendulum = Pendulum { m, g, l, k };
    let state = State::new([x, y], [vx, vy]).at_time(t);
    let solution = pendulum.accelerations_unchecked(&state);
    let length = l * (1.0 + (-t).exp() / 4.0);
    assert!((pendulum.height(&state) - (y + length)).abs() < 1e-15);
    let tension = -solution.multipliers[0] * length;
    assert!((pendulum.tension(&state, &solution) - tension).abs() < 1e-14 * tension.abs());
    assert_eq!(pendulum.acceleration(&state, &solution), solution.accelerations);
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
            assert!((x - y).abs() <= 1e-15 * x.abs(), "entry {index} in lane {lane}: {x} and {y}");
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
        let (values, slopes) = (everything(inputs), slope(inputs, direction));
        for (index, number) in dual.iter().enumerate() {
            let (value, slope) = (values[index], slopes[index]);
            assert!((number.re - value).abs() <= 1e-13 * value.abs().max(1.0), "entry {index}");
            let error = (number.eps - slope).abs() / slope.abs().max(1.0);
            assert!(error < 1e-9, "entry {index}: {} and {slope} differ by {error:e}", number.eps);
        }
    }
}

/// θ̈ = −(g/l) sin θ, differentiated by hand.
#[test]
fn the_derivative_of_an_acceleration_is_exact() {
    #[derive(Lagrangian)]
    #[coordinates(theta)]
    #[lagrangian(m*l^2/2*theta_dot^2 + m*g*l*cos(theta))]
    struct Plane<T> {
        m: T,
        g: T,
        l: T,
    }

    let (g, l, theta) = (9.81, 1.3, 0.8_f64);
    let at = |length: Dual64, angle: Dual64| {
        let plane = Plane { m: Dual64::from_re(2.0), g: Dual64::from_re(g), l: length };
        plane.accelerations_unchecked(&State::at_rest([angle])).accelerations[0].eps
    };
    let by_length = at(Dual64::new(l, 1.0), Dual64::from_re(theta));
    let by_angle = at(Dual64::from_re(l), Dual64::new(theta, 1.0));
    assert!((by_length - g / l.powi(2) * theta.sin()).abs() < 1e-14);
    assert!((by_angle + g / l * theta.cos()).abs() < 1e-14);
}
