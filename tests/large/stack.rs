//! Large systems on the stack that a thread has by default, 2 MiB: motions of 1,000 coordinates by every method, and derivatives of
//! 100 coordinates on 50 constraints.

use std::thread::Builder;

use lagrange_core::{Method, StateDerivatives, linearized::DifferentiableMethod, prelude::*};

#[derive(Clone, Copy, Lagrangian)]
#[coordinates(x: [1000])]
#[lagrangian(sum(i in 0..1000, x_dot[i]^2/2 - k*x[i]^2/2))]
struct Springs {
    k: f64,
}

/// Of each pair x moves twice as far as y.
#[derive(Clone, Copy, Lagrangian)]
#[coordinates(x: [50], y: [50])]
#[lagrangian(sum(i in 0..50, (x_dot[i]^2 + y_dot[i]^2)/2 - k*x[i]^4/4))]
#[constraint(lever[i in 0..50]: x[i] - 2*y[i] = 0)]
struct Levers<T> {
    k: T,
}

/// Runs this on a thread of its own, with this start.
fn on_a_thread<S: 'static>(start: fn() -> S, work: impl FnOnce(S) + Send + 'static) {
    on_a_thread_of(2048, move || work(start()));
}

fn on_a_thread_of(kibibytes: usize, work: impl FnOnce() + Send + 'static) {
    let thread = Builder::new().stack_size(kibibytes << 10).spawn(work).expect("a thread");
    thread.join().expect("no panic");
}

fn springs() -> (Springs, State<f64, 1000>) {
    (Springs { k: 4.0 }, State::at_rest([1.0; 1000]))
}

/// Goes on from rest by this method, the path stored, looked into and searched for an event; and step by step.
fn move_springs(method: impl Method<Springs> + Copy + Send + 'static) {
    let is_close = |x: f64, t: f64| (x - (2.0 * t).cos()).abs() < 1e-6;
    on_a_thread(springs, move |(springs, start)| {
        let path = springs.integrate(start, 0.5, method).expect("a motion");
        assert!(is_close(path.end().state().q[999], 0.5));
        assert!(is_close(path.at(0.3).expect("a time").state().q[500], 0.3));
    });
    on_a_thread(springs, move |(springs, start)| {
        let mut half = springs.event("half", |sample| sample.state().q[7] - 0.6_f64.cos());
        let path = springs.motion(start).by(method).event(&mut half).towards(0.5).expect("a motion");
        assert!((path.crossings()[0].state.t - 0.3).abs() < 1e-6);
    });
    on_a_thread(springs, move |(springs, start)| {
        let mut motion = Motion::new(springs, start, method).expect("a start");
        motion.advance_to(0.4).expect("no end before");
        motion.advance_to(0.5).expect("no end before");
        assert!(is_close(motion.state().q[0], 0.5));
        assert!(motion.at(0.495).is_ok_and(|state| is_close(state.q[0], 0.495)));
    });
}

#[test]
fn a_thousand_coordinates_move_by_every_method() {
    move_springs(Dop853::default());
    move_springs(Dopri5::default());
    move_springs(RungeKutta4::with_step(0.01));
    move_springs(Taylor::default());
    on_a_thread(springs, |(springs, start)| {
        let phase = springs.phase_state(&start);
        let path = springs.motion_in_momenta(phase).to(0.5).expect("a motion");
        assert!((path.end().state().q[0] - 1.0_f64.cos()).abs() < 1e-6);
    });
}

fn levers() -> (Levers<f64>, State<f64, 100>) {
    let q = std::array::from_fn(|i| if i < 50 { 1.0 } else { 0.5 });
    (Levers { k: 2.0 }, State::at_rest(q))
}

/// ∂ẍ/∂x along the constraint: (1 + 1/4) ẍ = −k x³.
const SLOPE: f64 = -2.0 * 3.0 / 1.25;

#[test]
fn the_derivatives_of_a_hundred_coordinates_on_fifty_constraints() {
    on_a_thread(levers, |(levers, state)| {
        let jacobian = levers.jacobian(&state).expect("a Jacobian");
        assert!((jacobian.accelerations.q[(7, 7)] - SLOPE).abs() < 1e-12);
        assert!((jacobian.accelerations.parameters[(7, 0)] + 1.0 / 1.25).abs() < 1e-12);
    });
    on_a_thread(levers, |(levers, state)| {
        let jacobian = levers.state_jacobian(&state).expect("a Jacobian");
        assert!((jacobian.accelerations.q[(49, 49)] - SLOPE).abs() < 1e-12);
    });
    on_a_thread(levers, |(levers, state)| {
        let by = levers.jacobian_by(&state, &["x[3]", "k"]).expect("a Jacobian");
        assert!((by.accelerations[(3, 0)] - SLOPE).abs() < 1e-12);
        let inputs = levers.inputs_for(&state, &by.solution.accelerations, &["k"]).expect("inputs");
        assert!((inputs.inputs[0] - 2.0).abs() < 1e-12);
    });
    on_a_thread(levers, |(levers, state)| {
        let near = levers.linearize(&state, &["k"]).expect("a linear system");
        assert_eq!((near.a.nrows(), near.b.ncols()), (100, 1));
    });
}

#[test]
fn the_derivatives_of_a_motion_of_a_hundred_coordinates_on_fifty_constraints() {
    fn sensitivities(method: impl DifferentiableMethod<Levers<f64>> + Copy + Send + 'static) {
        on_a_thread(levers, move |(levers, state)| {
            let motion =
                levers.integrate_sensitivities(state, 0.1, method, &["x[3]", "k"]).expect("a motion");
            // For small times δx = (1 + SLOPE t²/2) along the constraint, of which x has four fifths.
            let change = motion.at(0.01).expect("a time").q[(3, 0)];
            assert!((change - 0.8 * (1.0 + SLOPE * 0.01 * 0.01 / 2.0)).abs() < 1e-6, "{change}");
        });
    }
    sensitivities(Dop853::default());
    sensitivities(Taylor::default());
}

/// The nearest state is sought off the constraints, where they curve. Optimised that takes 1000 KiB, so that it fits into the 1 MiB of a
/// program in a browser; unoptimised, where what is moved is copied, 2.7 MiB. The level `full` is run optimised.
#[test]
fn a_start_of_a_hundred_coordinates_comes_to_fifty_constraints() {
    /// Fifty bobs on rods of their own.
    #[derive(Lagrangian)]
    #[coordinates(x: [50], y: [50])]
    #[lagrangian(sum(i in 0..50, (x_dot[i]^2 + y_dot[i]^2)/2))]
    #[constraint(rod[i in 0..50]: x[i]^2 + y[i]^2 = 1)]
    struct Bobs;

    let kib = lagrange_random::cases([3072, 3072, 1024]);
    on_a_thread_of(kib, || {
        let start = State::new([2.0; 100], [0.5; 100]);
        let (state, _) = Bobs.make_consistent(&start).expect("a state");
        let nearest = 0.5_f64.sqrt();
        assert!(state.q.iter().all(|x| (x - nearest).abs() < 1e-15));
        assert!(state.v.iter().all(|v| v.abs() < 1e-15));
        assert!(Motion::new(&Bobs, state, Dop853::default()).is_ok());
    });
}
