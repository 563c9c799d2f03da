//! Motions that are taken step by step, as games and controllers do.

use lagrange_core::Sample;
use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::prelude::*;
use lagrange_random::cases;

/// Five blocks in the plane, one on another: each stands with its two lower corners on the one below.
#[derive(Clone, Lagrangian)]
#[coordinates(x: [5], y: [5], theta: [5])]
#[define(corner(i, s) = [x[i] + s*b*cos(theta[i]) + h*sin(theta[i]), y[i] + s*b*sin(theta[i]) - h*cos(theta[i])])]
#[define(above(i, s) = cos(theta[i])*(corner(i + 1, s)[1] - y[i]) - sin(theta[i])*(corner(i + 1, s)[0] - x[i]) - h)]
#[define(along(i, s) = cos(theta[i])*(corner(i + 1, s)[0] - x[i]) + sin(theta[i])*(corner(i + 1, s)[1] - y[i]))]
#[lagrangian(m/2 * (dot(x_dot, x_dot) + dot(y_dot, y_dot)) + m*(b^2 + h^2)/6 * dot(theta_dot, theta_dot) - m*g*sum(i in 0..5, y[i]))]
#[contact(floor[k in 0..2]: corner(0, 2*k - 1)[1] >= 0, friction(mu): der(corner(0, 2*k - 1)[0]))]
#[contact(left[i in 0..4]: above(i, -1) >= 0, friction(mu): der(along(i, -1)))]
#[contact(right[i in 0..4]: above(i, 1) >= 0, friction(mu): der(along(i, 1)))]
struct Stack {
    m: f64,
    b: f64,
    h: f64,
    g: f64,
    mu: f64,
    floor: [Contact; 2],
    left: [Contact; 4],
    right: [Contact; 4],
}

fn stack() -> (Stack, State<f64, 15>) {
    let (floor, four) = ([Contact::Open; 2], [Contact::Open; 4]);
    let stack = Stack { m: 1.0, b: 0.5, h: 0.25, g: 9.81, mu: 0.5, floor, left: four, right: four };
    let mut start = State::at_rest([0.0; 15]);
    (0..5).for_each(|i| start.q[5 + i] = 0.25 + 0.5 * i as f64);
    (stack, start)
}

const FRAME: f64 = 1.0 / 60.0;

/// Frames of a game: the same as one motion, bit by bit, and what is on the stack stays there.
#[test]
fn a_stack_stands_through_all_frames() {
    let ((stack, start), frames) = (stack(), cases([500, 2_000, 100_000]));
    let scheme = MoreauJean::with_step(FRAME);
    let mut stepper = stack.motion(start).by_time_stepping(scheme).stepper().unwrap();
    let path = stack.motion(start).by_time_stepping(scheme).to(FRAME * 500.0).unwrap();
    let path: Vec<_> = path.steps().collect();
    for frame in 1..=frames {
        let step = *stepper.step().unwrap();
        // Round-off adds up.
        let moved = (step.state.q - start.q).amax();
        assert!(moved < 1e-13 + 1e-15 * frame as f64, "frame {frame}: {moved:e}");
        assert!(step.state.v.amax() < 1e-12, "frame {frame}: {:e}", step.state.v.amax());
        if let Some(same) = path.get(frame).filter(|_| frame < 500) {
            assert_eq!(&step.state, same.state());
        }
    }
}

/// Each frame a motion of its own, from where the last one ended.
#[test]
fn what_ends_a_step_starts_another_motion() {
    let (stack, start) = stack();
    let mut state = start;
    for frame in 0..cases([300, 2_000, 20_000]) {
        let motion = stack.motion(State { t: 0.0, ..state }).by_time_stepping(MoreauJean::with_step(FRAME));
        let path = motion.to(FRAME).unwrap_or_else(|error| panic!("frame {frame}: {error}"));
        state = *path.end().state();
        assert!((state.q - start.q).amax() < 1e-9, "frame {frame}: {state:?}");
    }
}

/// A pendulum on a rod, which hits a wall: constraints too can be taken up where a step has left them.
#[test]
fn a_constrained_motion_goes_on_frame_by_frame() {
    use lagrange_systems::Walled;
    let pendulum = Walled { m: 1.5, l: 1.0, g: 9.81, d: 0.2, e: 0.6, ..Walled::default() };
    let mut state = State::at_rest([-0.6, -0.8]);
    for frame in 0..600 {
        let motion = pendulum.motion(state).by_time_stepping(MoreauJean::with_step(FRAME));
        let path = motion.to(state.t + FRAME).unwrap_or_else(|error| panic!("frame {frame}: {error}"));
        state = *path.end().state();
        // A step leaves constraints at a millionth of what the bob falls in it.
        let left = 1e-6 * 9.81 * FRAME * FRAME;
        assert!((state.q.norm() - 1.0).abs() < left && state.q[0] < 0.2 + left, "{state:?}");
    }
    // But not velocities along the rod.
    let off = State::new([-0.6, -0.8], [-0.6, -0.8]);
    let error = pendulum.motion(off).by_time_stepping(MoreauJean::with_step(FRAME)).to(1.0).unwrap_err();
    assert!(matches!(error, Error::Inconsistent { rate: true, .. }), "{error}");
}

/// The impulse of the rod in a step is its force, by a motion without steps of one length, times the step.
#[test]
fn impulses_of_constraints_are_their_forces() {
    use lagrange_systems::Walled;
    let pendulum = Walled { m: 1.5, l: 1.0, g: 9.81, d: 0.2, e: 0.6, ..Walled::default() };
    let start = State::at_rest([-0.6, -0.8]);
    let exact = pendulum.motion(start).by(Dop853::with_tolerance(1e-12)).with_contacts().to(0.4).unwrap();
    let off = |h: f64| {
        let path = pendulum.motion(start).by_time_stepping(MoreauJean::with_step(h)).to(0.4).unwrap();
        let off = |step: Sample<Walled>| {
            let force = exact.at(step.time() - h / 2.0).unwrap().multiplier("rod").unwrap();
            (step.multiplier("rod").unwrap() - force).abs()
        };
        path.steps().skip(1).map(off).fold(0.0, f64::max)
    };
    let errors = [0.02, 0.01, 0.005].map(off);
    assert!(errors[2] < 0.05 && errors.windows(2).all(|pair| pair[1] < 0.6 * pair[0]), "{errors:?}");
}

/// A block that a motor pulls: what changes between steps acts in the next one; a step that fails leaves the stepper where it was.
#[test]
fn inputs_change_between_steps() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
    #[force(x: motor)]
    #[contact(floor: y >= 0, friction(mu): x_dot)]
    struct Cart {
        m: f64,
        g: f64,
        mu: f64,
        motor: f64,
        floor: Contact,
    }
    let cart = Cart { m: 2.0, g: 9.81, mu: 0.5, motor: 0.0, floor: Contact::Open };
    let mut stepper = cart
        .motion(State::at_rest([0.0, 0.0]))
        .by_time_stepping(MoreauJean::with_step(0.01))
        .stepper()
        .unwrap();
    for _ in 0..100 {
        assert_eq!(stepper.step().unwrap().state.v[0], 0.0);
    }
    stepper.change(|cart| cart.motor = 9.0);
    assert_eq!(stepper.step().unwrap().state.v[0], 0.0);
    stepper.change(|cart| cart.motor = 20.0);
    let before = *stepper.state();
    let v = stepper.step().unwrap().state.v[0];
    assert!((v - 0.01 * (20.0 - 9.81) / 2.0).abs() < 1e-15, "{v}");
    stepper.change(|cart| cart.motor = f64::NAN);
    let kept = *stepper.state();
    assert!(stepper.step().unwrap_err().to_string().contains('x') && *stepper.state() == kept);
    stepper.change(|cart| cart.motor = 0.0);
    assert!((stepper.step_to(kept.t + 0.5).unwrap().state.t - kept.t - 0.5).abs() < 1e-15);
    assert!(stepper.step_to(before.t).is_err());
    assert!(stepper.step().unwrap().state.v[0].abs() < 1e-15);
}
