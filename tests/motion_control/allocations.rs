//! What a motion that stores nothing allocates: nothing, however many steps it takes.

use allocation_counter::measure;
use lagrange_core::contact::Contact;
use lagrange_core::linearized::DiscreteTime;
use lagrange_core::{Method, StateOf, prelude::*, runge_kutta_step};

/// Two links, the second driven at the elbow.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(a, b)]
#[lagrangian(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b) + 2*g*cos(a) + g*cos(b))]
#[force(a: -u)]
#[force(b: u)]
struct Acrobot {
    g: f64,
    u: f64,
}

#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y)]
#[lagrangian(1/2 * (x_dot^2 + y_dot^2) - g*y)]
#[constraint(rod: 1/2 * (x^2 + y^2 - l^2) = 0)]
#[force(x: u)]
struct Pendulum {
    g: f64,
    l: f64,
    u: f64,
}

/// Checks that this allocates nothing.
#[track_caller]
fn free<R>(mut work: impl FnMut() -> R) {
    let allocated = measure(|| {
        std::hint::black_box(work());
    });
    assert_eq!((allocated.count_total, allocated.bytes_total), (0, 0), "{allocated:?}");
}

#[test]
fn the_counter_counts() {
    assert!(measure(|| drop(std::hint::black_box(vec![0_u8; 1000]))).bytes_total >= 1000);
}

/// A motion that has its room, that for what lies within a step included.
fn begun<L: Lagrangian<Scalar = f64>, P: Method<L>>(system: L, start: StateOf<L>, method: P) -> Motion<L, P> {
    let mut motion = Motion::new(system, start, method).expect("a start");
    motion.advance_by(1e-3).expect("no end before");
    motion.at(motion.state().t - 1e-9).expect("within the last step");
    motion
}

/// With inputs, looks into steps, states set, samples, and the way back.
fn steer(method: impl Method<Acrobot> + Method<Pendulum> + Copy) {
    let start = State::new([0.1, 0.2], [0.0, 0.0]);
    let mut motion = begun(Acrobot { g: 9.81, u: 0.0 }, start, method);
    free(|| {
        for k in 1..=1000 {
            motion.system_mut().u = motion.state().q[1];
            motion.advance_to(0.01 * f64::from(k)).expect("no end before");
            motion.at(0.01 * f64::from(k) - 1e-9).expect("within the last step");
        }
        let sum: f64 = motion.states_at([9.5, 8.0, 7.0]).map(|state| state.expect("a state").q[0]).sum();
        motion.set_state(start).expect("a state");
        sum
    });
    let start = State::new([0.6, -0.8], [0.8, 0.6]);
    let mut motion = begun(Pendulum { g: 9.81, l: 1.0, u: 0.0 }, start, method);
    free(|| {
        for k in 1..=100 {
            motion.system_mut().u = -motion.state().v[0];
            motion.advance_to(0.01 * f64::from(k)).expect("no end before");
        }
    });
}

#[test]
fn a_steered_motion_allocates_nothing() {
    steer(Dop853::default());
    steer(Dopri5::with_tolerance(1e-6));
    steer(Dopri5::default().fixed_step(0.01));
    steer(RungeKutta4::with_step(0.01));
    steer(Radau::default());
    steer(Radau::default().stages::<7>());
    let (mut acrobot, mut state) = (Acrobot { g: 9.81, u: 0.0 }, State::at_rest([0.1, 0.2]));
    // From the start on.
    free(|| {
        let mut motion = Motion::new(acrobot, state, RungeKutta4::with_step(0.01)).expect("a start");
        motion.advance_to(1.0).expect("no end before");
    });
    free(|| {
        for _ in 0..1000 {
            acrobot.u = state.q[1];
            state = runge_kutta_step(&acrobot, &state, 0.01);
        }
    });
}

/// 200 000 steps, and states at some times: no more memory than before the first.
#[test]
fn memory_does_not_grow_with_the_steps() {
    let pendulum = Pendulum { g: 9.81, l: 1.0, u: 0.0 };
    let method = Dopri5::default().max_step(1e-3).max_steps(usize::MAX);
    let mut motion = begun(&pendulum, State::new([0.6, -0.8], [0.8, 0.6]), method);
    free(|| {
        motion.advance_to(100.0).expect("no end before");
        let states = motion.states_at((0..=1000).map(|k| 100.0 + 0.1 * f64::from(k)));
        assert_eq!(states.filter(Result::is_ok).count(), 1001);
        assert!(motion.statistics().accepted >= 200_000);
    });
    let phase = pendulum.phase_state(&State::new([0.6, -0.8], [0.8, 0.6]));
    let mut motion = Motion::in_momenta(&pendulum, phase, Dop853::default()).expect("a start");
    free(|| {
        motion.advance_to(20.0).expect("no end before");
    });
}

/// Samples of a motion, with and without derivatives, take as much memory at most after ten times as many steps.
#[test]
fn memory_of_samples_does_not_grow_with_the_steps() {
    let spring = Spring { k: 2.0 };
    let method = Dop853::default().max_step(0.01).max_steps(usize::MAX);
    let derivatives = spring.sensitivity(&State::at_rest([1.0]), &["x", "k"]).expect("names");
    let most = |end: f64| {
        let never = || spring.differentiable_event("never", |s| Ok(s.coordinate("x")? + 2.0));
        let alone = || spring.motion(State::at_rest([1.0])).by(method).every(0.1 * end).to(end);
        let both = || {
            spring.motion_with_derivatives(&derivatives).by(method).event(never()).every(0.1 * end).to(end)
        };
        let alone = measure(|| assert_eq!(alone().expect("a motion").samples.len(), 11)).bytes_max;
        [alone, measure(|| assert_eq!(both().expect("a motion").samples.len(), 11)).bytes_max]
    };
    assert_eq!(most(100.0), most(10.0));
}

/// Crossings of two events, one of them by name, with a change of the state at each.
#[test]
fn events_allocate_nothing() {
    let pendulum = Pendulum { g: 9.81, l: 1.0, u: 0.0 };
    let mut motion = begun(&pendulum, State::new([0.6, -0.8], [0.8, 0.6]), Dop853::default());
    free(|| {
        let mut turns = pendulum.event("turns", |s| s.velocity("x"));
        let mut pulls = pendulum.event("pulls", |s| Ok(s.multiplier("rod")? + 12.0));
        let mut count = 0;
        while let Some(crossing) =
            motion.advance_to_event(20.0, &mut [&mut turns, &mut pulls]).expect("a motion")
        {
            if crossing.event == "pulls" {
                motion.set_state(State { v: crossing.state.v * 0.999, ..crossing.state }).expect("a state");
            }
            count += 1;
        }
        assert!(count > 20, "{count}");
        count
    });
}

#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - k/2 * x^2)]
struct Spring<T> {
    k: T,
}

/// A member of an ensemble takes one allocation for its samples, one for the values of quantities, one for the list of its
/// events and one for each event, however long it moves; on lanes and alone.
#[test]
fn a_member_allocates_its_record_and_nothing_on_its_way() {
    let springs = |count| Ensemble::from_fn(count, |k| (Spring { k: k as f64 }, State::at_rest([1.0])));
    let times = || (0..100).map(|k| 0.01 * f64::from(k));
    let method = Dop853::default().max_step(0.02);
    let count = |count: usize, end: f64, on_lanes: bool, is_watched: bool| {
        let never = Spring { k: 1.0 }.event("never", |sample| 2.0 - sample.state().q[0]);
        let run = || match (on_lanes, is_watched) {
            (true, true) => {
                let springs = springs(count).samples_at(times()).quantity("v", |sample| sample.state().v[0]);
                springs.event(never).integrate_on_lanes(end, method)
            }
            (true, false) => springs(count).integrate_on_lanes(end, method),
            (false, true) => {
                let springs = springs(count).samples_at(times()).quantity("v", |sample| sample.state().v[0]);
                springs.event(never).integrate(end, method)
            }
            (false, false) => springs(count).integrate(end, method),
        };
        // Counted is the thread that the members are on.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
        pool.install(|| measure(|| drop(run()))).count_total
    };
    for on_lanes in [true, false] {
        let more = |members, end| count(members, end, on_lanes, true) - count(members, end, on_lanes, false);
        assert_eq!(more(48, 1.0) - more(16, 1.0), 4 * 32);
        assert_eq!(more(16, 10.0), more(16, 1.0));
    }
}

/// Taylor's method has its memory from the start of a member, and on lanes from that of a batch.
#[test]
fn members_by_series_allocate_nothing_on_their_way() {
    let count = |end: f64, on_lanes: bool| {
        let springs = Ensemble::from_fn(16, |k| (Spring { k: k as f64 }, State::at_rest([1.0])));
        // As many steps for each, so that there are as many batches.
        let method = Taylor::default().max_step(0.05);
        let run = || {
            if on_lanes { springs.integrate_on_lanes(end, method) } else { springs.integrate(end, method) }
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
        pool.install(|| measure(|| drop(run()))).count_total
    };
    for on_lanes in [true, false] {
        assert_eq!(count(10.0, on_lanes), count(1.0, on_lanes));
    }
}

/// From frame to frame, through bounces, sliding and rest.
#[test]
fn frames_across_contacts_free_what_they_allocate() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
    #[contact(floor: y >= 0, restitution: e, friction(mu): x_dot)]
    struct Puck {
        m: f64,
        g: f64,
        e: f64,
        mu: f64,
        floor: Contact,
    }
    let mut puck = Puck { m: 0.2, g: 9.81, e: 0.5, mu: 0.03, floor: Contact::Open };
    let mut state = State::new([0.0, 0.5], [1.0, 0.0]);
    let mut largest = [0; 2];
    for frame in 1..=400 {
        let used = measure(|| {
            let motion = puck.motion(state).by(RungeKutta4::with_step(1.0 / 240.0)).with_contacts();
            let path = motion.to(f64::from(frame) / 60.0).expect("no end before");
            (state, puck) = (*path.end(), path.system().clone());
        });
        assert_eq!(used.bytes_current, 0, "frame {frame}: {used:?}");
        let half = &mut largest[usize::from(frame > 200)];
        *half = used.bytes_max.max(*half);
    }
    assert_eq!((puck.floor, state.v[0]), (Contact::Closed, 0.0));
    assert!(largest[1] <= largest[0], "{largest:?}");
}

/// An interval with its derivatives, without constraints.
#[test]
fn an_interval_with_derivatives() {
    let method = RungeKutta4::with_step(0.01);
    let mut acrobot = DiscreteTime::new(Acrobot { g: 9.81, u: 0.0 }, method, &["u"]).expect("a parameter");
    let mut state = State::new([0.1, 0.2], [0.0, 0.0]);
    // The first interval allocates what the method needs.
    acrobot.advance(&state, 0.02).expect("a step");
    free(|| {
        for k in 1..=100 {
            acrobot.system_mut().u = state.q[1];
            acrobot.advance(&state, 0.02 * f64::from(k)).expect("a step");
            state = *acrobot.state();
        }
    });
}
