//! Members that are steered.

use lagrange_core::{Ending, Method, ensemble::Arrival, prelude::*};

use lagrange_systems::PushedSpring;

use crate::{Pendulum, arrival, noise, on_threads};

/// A spring without force; `mark` counts the calls of its controller.
type Cart = PushedSpring<f64>;

const COUNT: usize = 21;
const INTERVAL: f64 = 0.1;

/// Starts at different times.
fn cart(index: usize) -> (Cart, State<f64, 1>) {
    let cart = Cart { m: 0.5 + noise(index, 0), ..Cart::default() };
    (cart, State::new([noise(index, 1) - 0.5], [noise(index, 2) - 0.5]).at_time(0.5 * noise(index, 3)))
}

/// A spring, too.
fn sprung(index: usize) -> (Cart, State<f64, 1>) {
    let (cart, state) = cart(index);
    (Cart { k: 3.0, ..cart }, state)
}

fn steer(cart: &mut Cart, state: &State<f64, 1>) {
    cart.u = -cart.m * (4.0 * state.q[0] + 3.0 * state.v[0]);
    cart.mark[0] += 1.0;
}

fn never_fails(_: usize, cart: &mut Cart, state: &State<f64, 1>) -> Result<(), String> {
    steer(cart, state);
    Ok(())
}

/// Each interval u is constant, and the motion a polynomial.
#[test]
fn a_free_cart_moves_as_it_is_pushed() {
    let carts = || Ensemble::from_fn(COUNT, cart).controlled(INTERVAL, never_fails);
    let method = Dop853::default();
    for outcome in [carts().integrate_on_lanes(3.0, method).unwrap(), carts().integrate(3.0, method).unwrap()]
    {
        for index in 0..COUNT {
            let (mut cart, State { t, q, v }) = cart(index);
            let (mut now, mut x, mut v) = (t, q[0], v[0]);
            for call in 1.. {
                steer(&mut cart, &State::new([x], [v]));
                let (next, a) = ((t + INTERVAL * f64::from(call)).min(3.0), cart.u / cart.m);
                let h = next - now;
                (now, x, v) = (next, x + h * v + h * h / 2.0 * a, v + h * a);
                if now == 3.0 {
                    break;
                }
            }
            let state = arrival(&outcome, index).state;
            assert!((state.q[0] - x).abs().max((state.v[0] - v).abs()) < 1e-12, "member {index}: {state:?}");
        }
    }
}

/// A motion alone, advanced to the same times; with its steps.
fn alone<P: Method<Cart>>(index: usize, end: f64, method: P) -> (State<f64, 1>, usize) {
    let (cart, start) = sprung(index);
    let mut motion = Motion::new(cart, start, method).expect("a start");
    let direction = (end - start.t).signum();
    for call in 1.. {
        let state = *motion.state();
        steer(motion.system_mut(), &state);
        let next = start.t + direction * (INTERVAL * f64::from(call));
        let is_last = (next - end) * direction >= 0.0;
        motion.advance_to(if is_last { end } else { next }).expect("no end before");
        if is_last {
            break;
        }
    }
    (*motion.state(), motion.statistics().accepted)
}

/// On lanes too, to the last bit: the equations are sums and products.
#[test]
fn members_move_as_a_motion_that_is_steered() {
    let method = Dop853::with_tolerance(1e-11).first_step(1.0);
    for end in [3.0, -2.0] {
        let carts = || Ensemble::from_fn(COUNT, sprung).controlled(INTERVAL, never_fails);
        let one_by_one = carts().integrate(end, method).unwrap();
        let on_lanes = on_threads(1, || carts().integrate_on_lanes(end, method).unwrap());
        assert_eq!(on_lanes, on_threads(3, || carts().integrate_on_lanes(end, method).unwrap()));
        for index in 0..COUNT {
            for outcome in [&one_by_one, &on_lanes] {
                let Arrival { state, statistics, ending, .. } = arrival(outcome, index);
                assert_eq!((*state, statistics.accepted), alone(index, end, method));
                assert!(ending.is_complete());
            }
            let few = carts().members([index]).integrate_on_lanes(end, method).unwrap();
            assert_eq!(few.members(), &on_lanes.members()[index..=index]);
        }
    }
}

/// Calls go on where steps are longer than the interval and where they are shorter; the samples do not notice.
#[test]
fn samples_and_events_go_along() {
    let run = |interval: f64| {
        let any = cart(0).0;
        let late = any.event("late", |s| s.time() - 1.25).terminal();
        let carts = Ensemble::from_fn(COUNT, sprung).samples_at([0.5, 0.77, 1.0, 1.25, 2.0]).event(late);
        let carts = carts.quantity("calls", |s| s.system().mark[0]);
        carts.controlled(interval, never_fails).integrate_on_lanes(3.0, Dop853::default()).unwrap()
    };
    for interval in [0.01, 1.7] {
        let outcome = run(interval);
        for index in 0..COUNT {
            let Arrival { ending, samples, crossings, .. } = arrival(&outcome, index);
            assert!(matches!(ending, Ending::Event { event: "late", time: 1.25 }), "{ending}");
            assert_eq!((samples.len(), crossings.len()), (4, 1));
            let start = sprung(index).1.t;
            for (state, calls) in samples.iter().zip(outcome.quantity(index, "calls").unwrap()) {
                assert!((calls - ((state.t - start) / interval).ceil()).abs() <= 1.0, "{calls} at {state:?}");
            }
        }
    }
}

#[test]
fn a_controller_that_fails_ends_its_member_with_all_it_has() {
    let carts = |fails: fn(usize, f64) -> bool| {
        Ensemble::from_fn(COUNT, sprung).samples_at((10..30).map(|k| 0.05 * f64::from(k))).controlled(
            INTERVAL,
            move |index, cart: &mut Cart, state| match fails(index, state.t) {
                true => Err(format!("no current at {:.1}", state.t)),
                false => never_fails(index, cart, state),
            },
        )
    };
    let method = Dop853::default();
    for run in [
        |carts: Ensemble<'_, _, true>, method| carts.integrate_on_lanes(2.0, method).unwrap(),
        |carts: Ensemble<'_, _, true>, method| carts.integrate(2.0, method).unwrap(),
    ] {
        let well = run(carts(|_, _| false), method);
        let outcome = run(carts(|index, t| index == 5 && t > 1.0), method);
        assert_eq!(outcome.failures().count(), 1);
        for index in 0..COUNT {
            let (found, well) = (arrival(&outcome, index), arrival(&well, index));
            if index != 5 {
                assert_eq!(found, well);
                continue;
            }
            let Ending::ControllerFailed { time, said } = &found.ending else { panic!("{}", found.ending) };
            assert!(*time == found.state.t && *time > 1.0 && *time < 1.0 + INTERVAL + 1e-9);
            assert_eq!(*said, format!("no current at {time:.1}"));
            let kept = well.samples.iter().filter(|state| state.t <= *time).count();
            assert_eq!(found.samples, well.samples[..kept]);
            assert!(outcome.get(5).unwrap().to_string().contains(said));
        }
        let at_start = run(carts(|index, t| index == 2 && t < 0.5), method);
        let found = arrival(&at_start, 2);
        assert!(matches!(found.ending, Ending::ControllerFailed { .. }), "{}", found.ending);
        assert_eq!((found.state, found.statistics.accepted), (sprung(2).1, 0));
        assert_eq!(at_start.failures().count(), 1);
    }
}

#[test]
fn what_is_wrong_with_an_interval_is_told() {
    for interval in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let carts = Ensemble::from_fn(3, cart).controlled(interval, never_fails);
        let error = carts.integrate_on_lanes(1.0, Dop853::default()).unwrap_err();
        assert!(matches!(error, Error::Setting { name: "interval of the controller", .. }), "{error}");
    }
    let late = |index| (cart(index).0, cart(index).1.at_time(1e9));
    let carts = || Ensemble::from_fn(3, late).controlled(1e-9, never_fails);
    for outcome in [
        carts().integrate_on_lanes(1e9 + 1.0, Dop853::default()).unwrap(),
        carts().integrate(1e9 + 1.0, Dop853::default()).unwrap(),
    ] {
        for member in outcome.members() {
            let ending = &member.arrival().unwrap().ending;
            assert!(matches!(ending, Ending::TimeTooCoarse { time: 1e9, .. }), "{member}");
        }
    }
}

/// Parameters that are none, and fields that a lane cannot have for itself.
#[test]
fn what_a_controller_sets_wrongly_is_told() {
    let breaks = |index: usize, cart: &mut Cart, state: &State<f64, 1>| -> Result<(), String> {
        if state.t > 1.0 {
            match index {
                1 => cart.u = f64::NAN,
                2 => cart.label = 1,
                3 => cart.m = 0.0,
                _ => {}
            }
        }
        Ok(())
    };
    let carts = || Ensemble::from_fn(8, sprung).controlled(INTERVAL, breaks);
    let outcome = carts().integrate_on_lanes(2.0, Dop853::default()).unwrap();
    let ending = |index| &arrival(&outcome, index).ending;
    assert!(matches!(ending(1), Ending::NotFinite { .. }), "{}", ending(1));
    assert!(matches!(ending(2), Ending::ControllerFailed { .. }), "{}", ending(2));
    assert!(matches!(ending(3), Ending::Singular { .. }), "{}", ending(3));
    assert!((1..4).all(|index| ending(index).time() > 1.0 && ending(index).time() < 1.1 + 1e-9));
    assert_eq!(outcome.completed().count(), 5);
    assert!(arrival(&carts().integrate(2.0, Dop853::default()).unwrap(), 2).ending.is_complete());
}

/// On its circle as a motion alone to the last bit; a rod of another length has no bob at its end.
#[test]
fn constraints_hold_and_may_not_be_broken() {
    let rod = |index: usize| {
        let l = 1.0 + 0.1 * index as f64;
        (Pendulum { m: 2.0, g: 9.81, l, u: 0.0 }, State::at_rest([0.6 * l, -0.8 * l]))
    };
    let steers = |index: usize, rod: &mut Pendulum<f64>, state: &State<f64, 2>| -> Result<(), String> {
        rod.u = -2.0 * state.v[0];
        if index == 3 && state.t > 0.5 {
            rod.l = 3.0;
        }
        Ok(())
    };
    let method = Dopri5::with_tolerance(1e-9).first_step(1.0);
    let rods = || Ensemble::from_fn(6, rod).controlled(0.25, steers);
    for outcome in [rods().integrate_on_lanes(2.0, method).unwrap(), rods().integrate(2.0, method).unwrap()] {
        for index in 0..6 {
            let Arrival { state, ending, .. } = arrival(&outcome, index);
            if index == 3 {
                assert!(matches!(ending, Ending::Unsolved { time: 0.75, .. }), "{ending}");
                continue;
            }
            let (system, start) = rod(index);
            let mut motion = Motion::new(system, start, method).unwrap();
            for tick in 1..=8 {
                let state = *motion.state();
                steers(index, motion.system_mut(), &state).unwrap();
                motion.advance_to(0.25 * f64::from(tick)).unwrap();
            }
            assert_eq!(state, motion.state());
        }
    }
}
