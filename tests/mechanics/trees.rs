//! Derivatives of trees of bodies by the bodies that each joint carries, against dual numbers in the inverse dynamics and
//! in the accelerations.

use lagrange_core::nalgebra::{Const, Matrix3, Rotation3, SVector, Vector3};
use lagrange_core::number::{FourLanes, Wide};
use lagrange_core::{Direction, Dual, Lanes, Scalar, Solution, StateDerivatives, prelude::*};
use lagrange_random::cases;

/// Largest accepted error, relative to the largest entry of a row: thousands of operations, each rounded by 10⁻¹⁶.
const TOLERANCE: f64 = 1e-12;

/// Numbers between −1 and 1 without a pattern.
fn irregular(k: usize) -> f64 {
    (1.0 + 12.9898 * k as f64).sin()
}

/// A crane that turns and runs out before it carries anything: one coordinate in two joints, gears, axes of any length and
/// axes that turn with a coordinate, links without a body, several bodies in a frame, a body that rests; a second tree on a
/// free body; beside them forces and a potential that change in time, a magnetic field, a closed loop and a wheel that rolls.
#[derive(Lagrangian)]
#[coordinates(arm: [2], q: [10], ball: [4], p: [5], r: [3], turn: [4])]
#[parameter(inertia: symmetric)]
#[frame(track: rotate_z(arm[0]), translate([arm[1], 0, 0]))]
#[frame(hub in track: rotate(mount), rotate_z(-arm[0]))]
#[frame(light in hub: translate(at[0]), rotate(axis[0], q[0]))]
#[frame(upper in light: rotate(axis[1], k*q[1] + q[0]))]
#[frame(slide in upper: translate(p[0]*axis[2]))]
#[frame(tool in slide: translate(at[1]), rotate([cos(q[2]), sin(q[2]), k], q[3]))]
#[frame(hand in tool: translate(at[2]), rotate(ball))]
#[frame(thumb in hand: translate(at[3] + p[1]^2*axis[0]), rotate_y(q[4]))]
#[frame(tip in thumb: translate(at[0]), rotate_z(q[5]), rotate_x(p[2]), translate(at[4]))]
#[frame(other in hub: translate(at[1]), rotate_x(q[6]), translate([p[3], p[3]*p[4], sin(p[4])]))]
#[frame(wheel in other: translate(at[2]), rotate_z(q[7]))]
#[frame(cart: translate(r), rotate(turn))]
#[frame(pole in cart: rotate_y(q[8]), rotate(mount), rotate_x(q[9] - k*q[8]))]
#[define(weight = sin(w*t)*position(tip)[0] + cos(w*t)*dot(axis[0], position(wheel)))]
#[lagrangian(
    kinetic(hub, m[0], centre, inertia) + kinetic(upper, m[1], centre, inertia) + kinetic(upper, m[2], at[0])
    + kinetic(tool, m[3], centre, inertia) + kinetic(hand, m[4], centre, inertia) + kinetic(thumb, m[5], centre, inertia)
    + 2*kinetic(tip, m[6], centre, inertia) + kinetic(other, m[7], centre, inertia) + kinetic(wheel, m[8], at[3], inertia)
    + kinetic(pole, m[0], centre, inertia) + kinetic(cart, m[1], centre, inertia) + kinetic(fixed, m[2], centre, inertia)
    + m[0]*dot(g, position(hub, centre)) + m[3]*dot(g, position(tool, centre)) + m[4]*dot(g, position(hand, centre))
    + m[6]*dot(g, position(tip, centre)) + m[8]*dot(g, position(wheel, at[3])) + m[0]*dot(g, position(pole, centre))
    + weight + k*dot(express(velocity(tip), fixed), vector(fixed, [0, position(tip)[0], 0]))
)]
#[dissipation(k/2*dot(velocity(tip), velocity(tip)) + k/4*(q_dot[3]^2 + p_dot[0]^2)^2)]
#[force(q[4]: cos(w*t)*q_dot[0] - k*q[4]^3)]
#[constraint(closed[i in 0..2]: position(tip)[i] = position(wheel)[i])]
#[constraint(rolling: r_dot[0] = k*q_dot[7]*cos(q[8]))]
struct Crane<T: Scalar> {
    mount: Rotation3<T>,
    axis: [Vector3<T>; 3],
    at: [Vector3<T>; 5],
    centre: Vector3<T>,
    inertia: Matrix3<T>,
    m: [T; 9],
    g: Vector3<T>,
    k: T,
    w: T,
}

fn crane<T: Scalar>(of: impl Fn(f64) -> T + Copy) -> Crane<T> {
    let vector = |first: usize| Vector3::from_fn(|i, _| of(irregular(first + i)));
    let mount = Rotation3::from_euler_angles(0.3, -0.5, 1.1).into_inner().map(of);
    Crane {
        mount: Rotation3::from_matrix_unchecked(mount),
        axis: [80, 83, 86].map(|first| Vector3::from_fn(|i, _| of(3.0 * irregular(first + i)))),
        at: [40, 43, 46, 49, 52].map(vector),
        centre: vector(60),
        inertia: Matrix3::from_fn(|i, j| {
            of(if i == j { 2.0 + irregular(i) } else { 0.3 * irregular(i + j) })
        }),
        m: [0, 1, 2, 3, 4, 5, 6, 7, 8].map(|k| of(1.5 + irregular(70 + k))),
        g: vector(90),
        k: of(0.7),
        w: of(1.3),
    }
}

/// States at any time, on and off the unit spheres of the quaternions and off the constraints.
fn state<const N: usize>(seed: usize) -> State<f64, N> {
    let of = |first: usize| std::array::from_fn::<f64, N, _>(|i| irregular(100 * seed + first + i));
    State::new(of(0), of(N)).at_time(irregular(seed))
}

fn irregular_solution<const N: usize, const M: usize>(seed: usize) -> Solution<f64, N, M> {
    let accelerations: [f64; N] = std::array::from_fn(|i| irregular(7 * seed + i));
    let multipliers: [f64; M] = std::array::from_fn(|i| irregular(11 * seed + i));
    Solution { accelerations: accelerations.into(), multipliers: multipliers.into(), pivot: 1.0, rank: M }
}

/// The same numbers over another type.
fn over<T: Scalar, const N: usize, const M: usize>(
    Solution { accelerations, multipliers, pivot, rank }: &Solution<f64, N, M>,
    of: impl Fn(f64) -> T + Copy,
) -> Solution<T, N, M> {
    Solution {
        accelerations: accelerations.map(of),
        multipliers: multipliers.map(of),
        pivot: of(*pivot),
        rank: *rank,
    }
}

fn direction_over<T: Scalar, const N: usize>(
    Direction { t, q, v }: &Direction<f64, N>,
    of: impl Fn(f64) -> T + Copy,
) -> Direction<T, N> {
    Direction { t: of(*t), q: q.map(of), v: v.map(of) }
}

fn constant<T: Scalar>(value: T) -> Dual<T> {
    Dual { value, slope: T::constant(0.0) }
}

fn along<T: Scalar, const N: usize>(state: &State<T, N>, direction: &Direction<T, N>) -> State<Dual<T>, N> {
    let along = |value: T, slope: T| Dual { value, slope };
    State::new(state.q.zip_map(&direction.q, along), state.v.zip_map(&direction.v, along))
        .at_time(along(state.t, direction.t))
}

/// Directions of the time, of each coordinate and of each velocity.
fn directions<const N: usize>() -> Vec<Direction<f64, N>> {
    let coordinates = (0..N).map(Direction::of_coordinate);
    [Direction::of_time()].into_iter().chain(coordinates).chain((0..N).map(Direction::of_velocity)).collect()
}

/// Largest difference, relative to the largest entry or `least`.
fn error<'a>(found: impl IntoIterator<Item = &'a f64>, expected: &[f64], least: f64) -> f64 {
    let scale = expected.iter().fold(least, |scale, x| scale.max(x.abs()));
    let differences = found.into_iter().zip(expected).map(|(x, y)| (x - y).abs() / scale);
    // A NaN is no small error.
    differences.fold(0.0, |worst, x| if x <= worst { worst } else { x })
}

/// Compares the derivatives of the residual with dual numbers in the inverse dynamics, and those of accelerations and
/// multipliers with dual numbers in these.
fn check<L, D, const N: usize, const M: usize>(system: &L, over_duals: &D, seed: usize) -> [f64; 2]
where
    L: StateDerivatives<N = Const<N>, M = Const<M>, Scalar = f64>,
    D: Lagrangian<N = Const<N>, M = Const<M>, Scalar = Dual<f64>>,
{
    let (state, solution) = (state::<N>(seed), irregular_solution::<N, M>(seed));
    let slopes = system.residual_slopes(&state, &solution);
    assert!(L::motion_gradients(&slopes).is_some(), "{} has no tree", L::NAME);
    let Solution { accelerations, multipliers, .. } = over(&solution, constant);
    let jacobian = system.state_jacobian(&state).expect("a regular state");
    let mut worst = [0.0_f64; 2];
    for (k, direction) in directions::<N>().iter().enumerate() {
        let dual = along(&state, direction);
        let expected = over_duals.inverse_dynamics(&dual, &accelerations, &multipliers).map(|x| x.slope);
        let one = system.residual_change_by::<FourLanes>(&slopes, std::iter::once(k)).motion;
        let along = system.residual_change_with(&slopes, direction).motion;
        for found in [one.map(|x| x.lane(0)), along] {
            worst[0] = worst[0].max(error(&found, expected.as_slice(), 1.0));
        }
        let expected = over_duals.accelerations_unchecked(&dual);
        let slopes = |x: &[Dual<f64>]| x.iter().map(|x| x.slope).collect::<Vec<_>>();
        let (a, l) = (&jacobian.accelerations, &jacobian.multipliers);
        let (a, l): (SVector<f64, N>, SVector<f64, M>) = match k.checked_sub(1) {
            None => (a.t, l.t),
            Some(i) if i < N => (a.q.column(i).into(), l.q.column(i).into()),
            Some(i) => (a.v.column(i - N).into(), l.v.column(i - N).into()),
        };
        worst[1] = worst[1].max(error(&a, &slopes(expected.accelerations.as_slice()), 1.0));
        worst[1] = worst[1].max(error(&l, &slopes(expected.multipliers.as_slice()), 1.0));
    }
    worst
}

#[test]
fn derivatives_are_those_of_dual_numbers() {
    for seed in 0..cases([5, 20, 1_000]) {
        let [residual, solved] = check(&crane(|x| x), &crane(constant), seed);
        println!("{residual:.1e} {solved:.1e}");
        assert!(residual < TOLERANCE, "seed {seed}: {residual:e}");
        // The matrices of the equations have condition numbers up to 10⁴.
        assert!(solved < 1e4 * TOLERANCE, "seed {seed}: {solved:e}");
    }
}

#[test]
fn second_derivatives_are_those_of_dual_numbers_of_dual_numbers() {
    let (system, over_duals) = (crane(constant), crane(|x| constant(constant(x))));
    let (state, other) = (state::<28>(1), state::<28>(2));
    let moved = along(&state, &Direction { t: other.t, q: other.q, v: other.v });
    let solution = over(&irregular_solution::<28, 5>(3), constant);
    let Solution { accelerations, multipliers, .. } =
        over(&irregular_solution::<28, 5>(3), |x| constant(constant(x)));
    let slopes = system.residual_slopes(&moved, &solution);
    for (k, direction) in directions::<28>().iter().enumerate() {
        let direction = direction_over(direction, constant);
        let found = system.residual_change_with(&slopes, &direction).motion.map(|x| x.slope);
        let expected = over_duals.inverse_dynamics(&along(&moved, &direction), &accelerations, &multipliers);
        let error = error(&found, expected.map(|x| x.slope.slope).as_slice(), 1.0);
        assert!(error < TOLERANCE, "argument {k}: {error:e}");
    }
}

/// Each lane has a state of its own; single precision has those of double precision to its digits.
#[test]
fn lanes_and_single_precision_have_the_same_derivatives() {
    let (one, single) = (crane(|x| x), crane(|x| x as f32));
    let states: [State<f64, 28>; Lanes::COUNT] = std::array::from_fn(state);
    let solution = irregular_solution::<28, 5>(3);
    let of = |at: &dyn Fn(&State<f64, 28>) -> f64| Lanes::from(states.each_ref().map(at));
    let all = State::new(
        std::array::from_fn::<_, 28, _>(|i| of(&|state| state.q[i])),
        std::array::from_fn::<_, 28, _>(|i| of(&|state| state.v[i])),
    )
    .at_time(of(&|state| state.t));
    let number = Lanes::constant;
    let wide = crane(number);
    let slopes = wide.residual_slopes(&all, &over(&solution, number));
    for (k, direction) in directions::<28>().iter().enumerate() {
        let found = wide.residual_change_with(&slopes, &direction_over(direction, number)).motion;
        for (lane, state) in states.iter().enumerate() {
            let expected = one.residual_change(state, &solution, direction).motion;
            let error = error(&found.map(|x| x.to_array()[lane]), expected.as_slice(), 1.0);
            assert!(error < TOLERANCE, "lane {lane}, argument {k}: {error:e}");
        }
    }
    let small = |x: f64| x as f32;
    for state in &states {
        let exact = one.state_jacobian(state).expect("a regular state").accelerations;
        let state = State::<f32, 28>::new(state.q.map(small), state.v.map(small)).at_time(small(state.t));
        let found = single.state_jacobian(&state).expect("a regular state").accelerations;
        for (found, exact) in [(found.q, exact.q), (found.v, exact.v)] {
            let error = error(&found.map(f64::from), exact.as_slice(), 1.0);
            // Condition numbers up to 10⁴ times the rounding of 6·10⁻⁸.
            assert!(error < 1e-3, "{error:e}");
        }
    }
}

/// Distances are counted from the hub, which is 1000 km away from the fixed frame and rests.
#[test]
fn no_digits_are_lost_far_from_the_fixed_frame() {
    // Without forces and terms that depend on the place.
    let (system, over_duals) =
        (Crane { k: 0.0, ..crane(|x| x) }, Crane { k: constant(0.0), ..crane(constant) });
    let mut state = state::<28>(1);
    let mut solution = irregular_solution::<28, 5>(1);
    (state.q[1], state.v[0], solution.accelerations[0]) = (1e6, 0.0, 0.0);
    solution.multipliers.fill(0.0);
    let slopes = system.residual_slopes(&state, &solution);
    let mut largest = 0.0_f64;
    for i in 2..28 {
        for direction in [Direction::of_coordinate(i), Direction::of_velocity(i)] {
            let found = system.residual_change_with(&slopes, &direction).motion;
            let Solution { accelerations, multipliers, .. } = over(&solution, constant);
            let expected =
                over_duals.inverse_dynamics(&along(&state, &direction), &accelerations, &multipliers);
            let [found, expected] = [found, expected.map(|x| x.slope)].map(|x| x.as_slice()[2..].to_vec());
            largest = largest.max(error(&found, &expected, 1.0));
        }
    }
    println!("{largest:.1e}");
    assert!(largest < TOLERANCE, "{largest:e}");
}

/// Columns that are asked for by name are those of the whole matrix.
#[test]
fn columns_by_name_are_those_of_the_jacobian() {
    let (system, state) = (crane(|x| x), state::<28>(4));
    let whole = system.state_jacobian(&state).expect("a regular state").accelerations;
    let some = system.jacobian_by(&state, &["q[3]", "ball_dot[1]", "r[0]", "k"]).expect("a regular state");
    assert_eq!(some.accelerations.column(0), whole.q.column(5));
    assert_eq!(some.accelerations.column(1), whole.v.column(13));
    assert_eq!(some.accelerations.column(2), whole.q.column(21));
}

/// A chain on a car that runs along y = x^2.5, whose third derivative is infinite at x = 0.
#[derive(Lagrangian)]
#[coordinates(x, q: [19])]
#[frame(car: translate([x, x^2.5, 0]))]
#[frame(link[0] in car: rotate_z(q[0]))]
#[frame(link[i in 1..19] in link[i-1]: translate([1, 0, 0]), rotate_z(q[i]))]
#[lagrangian(kinetic(car, 1, [0, 0, 0]) + sum(i in 0..19, kinetic(link[i], 1, [1/2, 0, 0])))]
struct Train;

/// No number is given where a derivative has none, in the columns beside it either.
#[test]
fn derivatives_that_are_infinite_are_not_given() {
    let mut state = state::<20>(1);
    let slopes = Train.residual_slopes(&state, &irregular_solution(1));
    assert!(Train::motion_gradients(&slopes).is_some(), "no tree");
    state.q[0] = 0.25;
    assert!(Train.state_jacobian(&state).is_ok());
    for v in [0.0, 0.5] {
        (state.q[0], state.v[0]) = (0.0, v);
        assert!(Train.solve(&state).is_ok());
        let error = Train.state_jacobian(&state).unwrap_err();
        assert!(matches!(error, Error::DerivativeNotFinite { .. }), "{v}: {error}");
    }
}
