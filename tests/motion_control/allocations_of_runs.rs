//! What ensembles, samples, contacts and intervals allocate: their records, and nothing that grows with the steps.

use allocation_counter::measure;
use lagrange_core::contact::Contact;
use lagrange_core::linearized::DiscreteTime;
use lagrange_core::prelude::*;

use crate::allocations::{CART, free, steer};
use crate::spring_of;

#[test]
fn a_motion_steered_by_other_methods_allocates_nothing() {
    steer(Dopri5::with_tolerance(1e-6));
    steer(Dopri5::default().fixed_step(0.01));
    steer(Radau::default());
    steer(Radau::default().stages::<7>());
}

/// Samples of a motion, with and without derivatives, take as much memory at most after ten times as many steps.
#[test]
fn memory_of_samples_does_not_grow_with_the_steps() {
    let spring = spring_of(1.4);
    let method = Dop853::default().max_step(0.01).max_steps(usize::MAX);
    let derivatives = spring.sensitivity(&State::at_rest([1.0]), &["x", "k"]).expect("names");
    let most = |end: f64| {
        let never = || spring.differentiable_event("never", |s| Ok(s.coordinate("x")? + 2.0));
        let alone = || spring.motion(State::at_rest([1.0])).by(method).every(0.1 * end).to(end);
        let both = || {
            spring.motion_with_derivatives(&derivatives).by(method).event(never()).every(0.1 * end).to(end)
        };
        let alone = measure(|| assert_eq!(alone().expect("a motion").samples().len(), 11)).bytes_max;
        [alone, measure(|| assert_eq!(both().expect("a motion").samples().len(), 11)).bytes_max]
    };
    assert_eq!(most(100.0), most(10.0));
}

/// Number of allocations of the thread that the members are on.
fn on_one_thread(work: impl FnOnce() + Send) -> u64 {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    pool.install(|| measure(work)).count_total
}

/// A member of an ensemble takes one allocation for its samples, one for the values of quantities, one for the list of its
/// events and one for each event, however long it moves; on lanes and alone.
#[test]
fn a_member_allocates_its_record_and_nothing_on_its_way() {
    let springs = |count| Ensemble::from_fn(count, |k| (spring_of((k as f64).sqrt()), State::at_rest([1.0])));
    let times = || (0..100).map(|k| 0.01 * f64::from(k));
    let watched = |count| springs(count).samples_at(times()).quantity("v", |sample| sample.state().v[0]);
    let method = Dop853::default().max_step(0.02);
    let count = |count: usize, end: f64, on_lanes: bool, is_watched: bool| {
        let never = spring_of(1.0).event("never", |sample| 2.0 - sample.state().q[0]);
        let run = || match (on_lanes, is_watched) {
            (true, true) => watched(count).event(never).integrate_on_lanes(end, method),
            (true, false) => springs(count).integrate_on_lanes(end, method),
            (false, true) => watched(count).event(never).integrate(end, method),
            (false, false) => springs(count).integrate(end, method),
        };
        on_one_thread(|| drop(run()))
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
        let springs = Ensemble::from_fn(16, |k| (spring_of((k as f64).sqrt()), State::at_rest([1.0])));
        // As many steps for each, so that there are as many batches.
        let method = Taylor::default().max_step(0.05);
        let run = || {
            if on_lanes { springs.integrate_on_lanes(end, method) } else { springs.integrate(end, method) }
        };
        on_one_thread(|| drop(run()))
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
            (state, puck) = (*path.end().state(), path.system().clone());
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
    let mut cart = DiscreteTime::new(CART, method, &["a"]).expect("a parameter");
    let mut state = State::at_rest([0.2]);
    // The first interval allocates what the method needs.
    cart.advance(&state, 0.02).expect("a step");
    free(|| {
        for k in 1..=100 {
            cart.system_mut().a = state.q[0];
            cart.advance(&state, 0.02 * f64::from(k)).expect("a step");
            state = *cart.state();
        }
    });
}
