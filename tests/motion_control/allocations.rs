//! What a motion that stores nothing allocates: nothing, however many steps it takes.

use allocation_counter::measure;
use lagrange_core::{Method, StateOf, prelude::*, runge_kutta_step};
use lagrange_random::cases;
use lagrange_systems::DrivenSpring;

use crate::{ROD, Rod, swinging};

pub(crate) const CART: DrivenSpring<f64> = DrivenSpring { m: 1.0, k: 2.0, c: 0.1, a: 0.0, w: 0.0 };

/// Checks that this allocates nothing.
#[track_caller]
pub(crate) fn free<R>(mut work: impl FnMut() -> R) {
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
pub(crate) fn steer(method: impl Method<DrivenSpring<f64>> + Method<Rod> + Copy) {
    let start = State::at_rest([0.2]);
    let mut motion = begun(CART, start, method);
    free(|| {
        for k in 1..=1000 {
            motion.system_mut().a = motion.state().q[0];
            motion.advance_to(0.01 * f64::from(k)).expect("no end before");
            motion.at(0.01 * f64::from(k) - 1e-9).expect("within the last step");
        }
        let sum: f64 = motion.states_at([9.5, 8.0, 7.0]).map(|state| state.expect("a state").q[0]).sum();
        motion.set_state(start).expect("a state");
        sum
    });
    let mut motion = begun(ROD, swinging(), method);
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
    steer(RungeKutta4::with_step(0.01));
    let (mut cart, mut state) = (CART, State::at_rest([0.2]));
    // From the start on.
    free(|| {
        let mut motion = Motion::new(cart, state, RungeKutta4::with_step(0.01)).expect("a start");
        motion.advance_to(1.0).expect("no end before");
    });
    free(|| {
        for _ in 0..1000 {
            cart.a = state.q[0];
            state = runge_kutta_step(&cart, &state, 0.01);
        }
    });
}

/// At least 20 000 steps, and states at some times: no more memory than before the first.
#[test]
fn memory_does_not_grow_with_the_steps() {
    let half = cases([10, 100, 100]) as f64;
    let method = Dopri5::default().max_step(1e-3).max_steps(usize::MAX);
    let mut motion = begun(&ROD, swinging(), method);
    free(|| {
        motion.advance_to(half).expect("no end before");
        let states = motion.states_at((0..=1000).map(|k| half * (1.0 + 1e-3 * f64::from(k))));
        assert_eq!(states.filter(Result::is_ok).count(), 1001);
        assert!(motion.statistics().accepted as f64 >= 2000.0 * half);
    });
    let phase = ROD.phase_state(&swinging());
    let mut motion = Motion::in_momenta(&ROD, phase, Dop853::default()).expect("a start");
    free(|| {
        motion.advance_to(20.0).expect("no end before");
    });
}

/// Crossings of two events, one of them by name, with a change of the state at each.
#[test]
fn events_allocate_nothing() {
    let mut motion = begun(&ROD, swinging(), Dop853::default());
    free(|| {
        let mut turns = ROD.event("turns", |s| s.velocity("x"));
        let mut pulls = ROD.event("pulls", |s| Ok(s.multiplier("rod")? + 6.0));
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
