//! What it costs to watch contacts in steps without a transition, beside the same system with constraints in their place.
//!
//! `RUSTFLAGS="-C target-cpu=native" cargo bench -p lagrange-benches --bench contacts`
//!
//! Both keep a trajectory with its dense output, and take the same steps. They are timed in turn; of 301 rounds each the
//! least time counts.

use std::hint::black_box;
use std::time::Instant;

use lagrange_core::contact::{Contact, Contacts};
use lagrange_core::{Method, StateOf, TaylorSeries, prelude::*};

/// A sphere that rolls to and fro on a floor, between springs.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, phi)]
#[lagrangian(x_dot^2/2 + y_dot^2/2 + r^2/5 * phi_dot^2 - g*y - x^2/2 - x^4/4)]
#[contact(floor: y - r >= 0, friction(mu): x_dot - r*phi_dot)]
struct Sphere {
    g: f64,
    r: f64,
    mu: f64,
    floor: Contact,
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, phi)]
#[lagrangian(x_dot^2/2 + y_dot^2/2 + r^2/5 * phi_dot^2 - g*y - x^2/2 - x^4/4)]
#[constraint(floor: y - r = 0)]
#[constraint(roll: x_dot - r*phi_dot = 0)]
struct Rolling {
    g: f64,
    r: f64,
}

/// A double pendulum whose bob rides on a floor.
#[derive(Clone, Lagrangian)]
#[coordinates(a, b)]
#[lagrangian(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b) + 2*g*cos(a) + g*cos(b))]
#[contact(floor: h - cos(a) - cos(b) >= 0)]
struct Riding {
    g: f64,
    h: f64,
    floor: Contact,
}

#[derive(Clone, Lagrangian)]
#[coordinates(a, b)]
#[lagrangian(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b) + 2*g*cos(a) + g*cos(b))]
#[constraint(floor: h - cos(a) - cos(b) = 0)]
struct Rider {
    g: f64,
    h: f64,
}

/// A double pendulum that swings above a floor.
#[derive(Clone, Lagrangian)]
#[coordinates(a, b)]
#[lagrangian(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b) + 2*g*cos(a) + g*cos(b))]
struct Swinging {
    g: f64,
}

/// Balls on a floor, between springs.
#[derive(Clone, Lagrangian)]
#[coordinates(x: [5], y: [5])]
#[lagrangian(sum(i in 0..5, x_dot[i]^2/2 + y_dot[i]^2/2 - g*y[i] - x[i]^4/4) - sum(i in 1..5, (x[i] - x[i-1])^2/2))]
#[contact(floor[i in 0..5]: y[i] >= 0)]
struct Balls {
    g: f64,
    floor: [Contact; 5],
}

#[derive(Clone, Lagrangian)]
#[coordinates(x: [5], y: [5])]
#[lagrangian(sum(i in 0..5, x_dot[i]^2/2 + y_dot[i]^2/2 - g*y[i] - x[i]^4/4) - sum(i in 1..5, (x[i] - x[i-1])^2/2))]
#[constraint(floor[i in 0..5]: y[i] = 0)]
struct Beads {
    g: f64,
}

fn rounds() -> usize {
    if std::env::args().any(|argument| argument == "--test") { 1 } else { 301 }
}

/// Time in seconds, and the number of steps.
fn timed(work: impl FnOnce() -> usize) -> (f64, usize) {
    let start = Instant::now();
    let steps = black_box(work());
    (start.elapsed().as_secs_f64(), steps)
}

fn compare<L, K, P>(name: &str, (watched, plain): (&L, &K), start: StateOf<L>, end: f64, method: P)
where
    L: Contacts<Scalar = f64> + Clone,
    K: Lagrangian<Scalar = f64, N = L::N>,
    P: Method<L> + Method<K> + Clone,
{
    let mut least = [f64::MAX; 2];
    let mut count = 0;
    for _ in 0..rounds() {
        let (slow, steps) = timed(|| {
            let path = watched.motion(start).by(method.clone()).with_contacts().to(end).expect("a motion");
            assert!(path.transitions().is_empty(), "{:?}", path.transitions());
            path.statistics().accepted
        });
        let (fast, plain_steps) = timed(|| {
            let path = plain.motion(start).by(method.clone()).to(end).expect("a motion");
            path.statistics().accepted
        });
        assert_eq!(steps, plain_steps, "the same steps");
        count = steps;
        least = [least[0].min(slow), least[1].min(fast)];
    }
    let [slow, fast] = least;
    println!(
        "{name:40} {:.3}   a step with constraints takes {:.2} µs",
        slow / fast,
        fast / count as f64 * 1e6
    );
}

fn by_all<L, K>(name: &str, systems: (&L, &K), start: StateOf<L>, end: f64)
where
    L: Contacts<Scalar = f64> + TaylorSeries + Clone,
    K: TaylorSeries<Scalar = f64, N = L::N>,
{
    compare(&format!("{name}, Dop853"), systems, start, end, Dop853::default());
    compare(&format!("{name}, Dop853 to 1e-12"), systems, start, end, Dop853::with_tolerance(1e-12));
    compare(&format!("{name}, Dopri5"), systems, start, end, Dopri5::default());
    compare(&format!("{name}, Taylor"), systems, start, end, Taylor::default());
}

fn main() {
    let end = if rounds() == 1 { 1.0 } else { 100.0 };
    let sphere = Sphere { g: 9.81, r: 0.3, mu: 0.8, floor: Contact::Closed };
    let start = State::new([0.5, 0.3, 0.0], [0.3, 0.0, 1.0]);
    by_all("rolling sphere", (&sphere, &Rolling { g: 9.81, r: 0.3 }), start, end);
    let (a, b) = (0.3_f64, (1.8 - 0.3_f64.cos()).acos());
    let riding = Riding { g: 9.81, h: 1.8, floor: Contact::Closed };
    by_all("bob on a floor", (&riding, &Rider { g: 9.81, h: 1.8 }), State::at_rest([a, b]), end);
    let aloft = Riding { g: 9.81, h: 2.5, floor: Contact::Open };
    by_all("bob above a floor", (&aloft, &Swinging { g: 9.81 }), State::at_rest([0.5, 0.7]), end);
    let places = [0.5, -0.3, 0.4, -0.6, 0.2, 0.0, 0.0, 0.0, 0.0, 0.0];
    let balls = Balls { g: 9.81, floor: [Contact::Closed; 5] };
    by_all("5 balls on a floor", (&balls, &Beads { g: 9.81 }), State::at_rest(places), end);
}
