//! Functions that the user supplies, in every form and over every number type.

use lagrange_core::function::{FunctionWithDerivatives, SmoothTable, Table};
use lagrange_core::{function::WithDerivatives, nalgebra::Const, prelude::*};
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

/// A particle in a valley, on the curve where the valley is as high as given: second derivatives are needed.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y)]
#[function(U(x, y) = valley)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - U(x, y) - k*U(y, y))]
#[constraint(level: U(x, y) = h)]
#[observable(height = U(x, y))]
struct Particle<T, F> {
    m: T,
    k: T,
    h: T,
    valley: F,
}

const INPUTS: [[f64; 7]; 4] = [
    [1.0, 0.5, 0.3, 0.7, -0.4, 1.1, 0.2],
    [2.0, 0.1, 0.9, -0.6, 1.3, -0.5, 0.8],
    [0.7, 1.5, -0.2, 1.2, 0.1, 0.0, -1.0],
    [1.4, 0.8, 0.1, -1.1, -0.9, 0.6, 0.3],
];

fn everything<T: Scalar, F>([m, k, h, x, y, vx, vy]: [T; 7], valley: F) -> Vec<T>
where
    Particle<T, F>: Lagrangian<N = Const<2>, M = Const<1>, Scalar = T>,
{
    let particle = Particle { m, k, h, valley };
    let state = State::new([x, y], [vx, vy]);
    let solution = particle.accelerations_unchecked(&state);
    let mut all = vec![particle.lagrangian(&state), particle.energy(&state)];
    all.extend(&particle.forcing(&state));
    all.extend(&particle.constraint_residual(&state));
    all.extend(&particle.constraint_jacobian(&state));
    all.extend(&particle.constraint_bias(&state));
    all.extend(&solution.accelerations);
    all.extend(&solution.multipliers);
    all.extend(particle.observable(0, &state, &solution));
    all
}

#[track_caller]
fn assert_close(ours: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!((ours.len(), expected.len()), (12, 12));
    for (ours, expected) in ours.iter().zip(expected) {
        assert!((ours - expected).abs() <= tolerance * expected.abs().max(1.0), "{ours} {expected}");
    }
}

#[test]
fn a_function_by_hand_is_the_same_as_one_for_every_scalar() {
    for inputs in INPUTS {
        let (general, by_hand) =
            (everything(inputs, Valley), everything(inputs, WithDerivatives(ValleyByHand)));
        assert_close(&by_hand, &general, 1e-14);
    }
}

#[test]
fn single_precision() {
    for inputs in INPUTS {
        let single: Vec<f64> =
            everything(inputs.map(|x| x as f32), Valley).into_iter().map(f64::from).collect();
        assert_close(&single, &everything(inputs, Valley), 2e-5);
    }
}

#[test]
fn each_lane_is_a_system_of_its_own() {
    let lanes = std::array::from_fn(|k| WideF64x4::from(INPUTS.map(|inputs| inputs[k])));
    let all = everything(lanes, Valley);
    for (lane, inputs) in INPUTS.into_iter().enumerate() {
        let ours: Vec<f64> = all.iter().map(|value| value.extract(lane)).collect();
        assert_close(&ours, &everything(inputs, Valley), 1e-12);
    }
}

/// The derivative by one input, through the macro's equations and the function in them.
#[test]
fn dual_numbers_of_either_kind_go_through() {
    for (k, inputs) in (0..7).flat_map(|k| INPUTS.map(|inputs| (k, inputs))) {
        let slope = |i: usize| if i == k { 1.0 } else { 0.0 };
        let theirs = everything(std::array::from_fn(|i| Dual64::new(inputs[i], slope(i))), Valley);
        let ours = everything(
            std::array::from_fn(|i| lagrange_core::Dual { value: inputs[i], slope: slope(i) }),
            Valley,
        );
        let [theirs, ours]: [Vec<f64>; 2] =
            [theirs.iter().map(|x| x.eps).collect(), ours.iter().map(|x| x.slope).collect()];
        assert_close(&ours, &theirs, 1e-11);
    }
}

/// A body on a spring whose force was measured, in a lift whose height is known at some times.
#[derive(Lagrangian)]
#[coordinates(x)]
#[function(U(x))]
#[function(height(t) = lift)]
#[lagrangian(m/2*(x_dot + der(height(t)))^2 - U(x) - m*g*(x + height(t)))]
#[expect(non_snake_case, reason = "as it is written in the Lagrangian")]
struct Lift {
    m: f64,
    g: f64,
    U: Table,
    lift: Table,
}

#[test]
fn tables_are_potentials_and_motions() -> Result<(), Error> {
    // Both parabolas x² inside, away from the ends where the spline straightens.
    let parabola: Vec<_> = (-400..=400).map(|i| f64::from(i) / 40.0).map(|x| (x, x * x)).collect();
    let table = Table::new(&parabola)?;
    let lift = Lift { m: 2.0, g: 9.81, U: table.clone(), lift: table };
    let state = State::new([0.3], [0.1]).at_time(0.2);
    // m (ẍ + height″) = −U′ − m g
    let expected = -2.0 - 2.0 * 0.3 / 2.0 - 9.81;
    assert!((lift.solve(&state)?.accelerations[0] - expected).abs() < 1e-12);
    Ok(())
}

/// U′ and U″ in the Lagrangian itself: the equations need the third derivative.
#[derive(Lagrangian)]
#[coordinates(x)]
#[function(height(t) = lift)]
#[lagrangian(x_dot^2/2 + x_dot*der(der(height(t))))]
struct Jerked<F> {
    lift: F,
}

struct Cubic;

impl Function<1, 1> for Cubic {
    fn eval<S: Scalar>(&self, [t]: [S; 1]) -> [S; 1] {
        [t * t * t]
    }
}

#[test]
fn third_derivatives_are_known_of_what_is_written_for_every_scalar() {
    let solution = Jerked { lift: Cubic }.accelerations_unchecked(&State::at_rest([0.0]).at_time(0.7));
    assert_eq!(solution.accelerations[0], -6.0);
}

#[test]
fn a_smooth_table_has_third_derivatives() -> Result<(), Error> {
    let parabola: Vec<_> = (0..9).map(f64::from).map(|t| (t, t * t)).collect();
    let lift = SmoothTable::new(&parabola)?;
    assert!(
        Jerked { lift }.accelerations_unchecked(&State::at_rest([0.0]).at_time(3.7)).accelerations[0].abs()
            < 1e-11
    );
    let sines: Vec<_> = (0..=80).map(|i| f64::from(i) / 10.0).map(|t| (t, t.sin())).collect();
    let lift = SmoothTable::new(&sines)?;
    let solution = Jerked { lift }.accelerations_unchecked(&State::at_rest([0.0]).at_time(4.03));
    assert!((solution.accelerations[0] - 4.03_f64.cos()).abs() < 1e-4);
    Ok(())
}

/// A diatomic molecule whose potential is tabulated.
#[derive(Lagrangian)]
#[coordinates(x)]
#[function(U(x) = potential)]
#[lagrangian(x_dot^2/2 - U(x))]
struct Tabulated<F> {
    potential: F,
}

/// The largest change of the energy in twenty oscillations through the points of a Morse potential, in tolerances of 10⁻¹², and
/// the number of steps.
fn drift<F>(potential: F) -> Result<[f64; 2], Error>
where
    Tabulated<F>: Lagrangian<N = Const<1>, M = Const<0>, Scalar = f64>,
{
    let molecule = Tabulated { potential };
    let run = molecule.integrate(State::at_rest([0.8]), 100.0, Dop853::with_tolerance(1e-12))?;
    let first = run.start().energy();
    let change = run.steps().map(|sample| (sample.energy() - first).abs() / 1e-12).fold(0.0, f64::max);
    Ok([change, run.steps().count() as f64])
}

/// Measured: 36,700 tolerances and 6,634 steps through the points of a cubic spline, 7.4 and 889 of a quintic one, 1.7 and 889 without.
#[test]
fn points_of_a_smooth_table_cost_few_digits() -> Result<(), Error> {
    let morse = |x: f64| (x, (1.0 - (-x).exp()).powi(2));
    let points: Vec<_> = (-80..=240).map(|i| morse(f64::from(i) / 80.0)).collect();
    let [cubic, smooth] = [drift(Table::new(&points)?)?, drift(SmoothTable::new(&points)?)?];
    assert!(smooth[0] < 30.0 && cubic[0] > 100.0 * smooth[0], "{cubic:?} and {smooth:?}");
    assert!(cubic[1] > 5.0 * smooth[1], "{cubic:?} and {smooth:?}");
    Ok(())
}

/// Nothing is asked of a function that no expression calls.
#[derive(Lagrangian)]
#[coordinates(x)]
#[function(U(x) = spare)]
#[lagrangian(x_dot^2/2)]
struct Free {
    #[expect(dead_code, reason = "no expression calls it")]
    spare: &'static str,
}

#[test]
fn a_function_that_is_not_called_may_be_anything() {
    assert_eq!(Free { spare: "" }.accelerations_unchecked(&State::at_rest([0.0])).accelerations[0], 0.0);
}

/// A reference to a function, and a function shared by two names.
#[derive(Lagrangian)]
#[coordinates(x)]
#[function(U(x) = potential)]
#[function(again(s) = potential)]
#[lagrangian(x_dot^2/2 - U(x) - again(2*x))]
struct Shared<'a, F: ?Sized> {
    potential: &'a F,
}

#[test]
fn a_function_may_be_borrowed_and_named_twice() {
    let shared = Shared { potential: &Cubic };
    // −(x³ + 8x³)′ at 2
    assert_eq!(shared.forcing(&State::at_rest([2.0]))[0], -108.0);
}

/// The smaller of x and a number that nothing here comes near.
struct Capped;

impl Function<1, 1> for Capped {
    fn eval<S: Scalar>(&self, [x]: [S; 1]) -> [S; 1] {
        [x.min(S::constant(1e16))]
    }
}

#[test]
fn a_bound_far_away_leaves_value_and_force() {
    let capped = Shared { potential: &Capped };
    let state = State::at_rest([1.5]);
    // −U(x) − U(2x) with U(x) = x
    assert_eq!(capped.lagrangian(&state), -4.5);
    assert_eq!(capped.forcing(&state)[0], -3.0);
}
