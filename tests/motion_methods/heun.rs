//! Heun's method of order 2, written against the contract of methods alone. It chooses its steps by the error of Euler's
//! method and rejects those that are too long, returns to the constraints, and has an interpolant of its own.

use lagrange_core::motion::{Interpolant, Limits, PhaseVector, Polynomial, StagePoint, Step};
use lagrange_core::{Ending, Method, Statistics, nalgebra::Const, prelude::*};
use lagrange_systems::DrivenSpring;

use crate::midpoint::Bead;

/// All steps have the length `step` without a tolerance.
#[derive(Clone, Copy)]
struct Heun {
    step: f64,
    tolerance: Option<f64>,
}

impl<L, const N: usize> Method<L> for Heun
where
    L: Lagrangian<N = Const<N>, Scalar = f64>,
{
    /// Length of the next step.
    type Memory = f64;
    type Interpolant = Dense<N>;

    fn limits(&self) -> Limits {
        Limits::default()
    }

    fn identify(&self, to: &mut dyn std::fmt::Write) -> std::fmt::Result {
        write!(to, "Heun {:?} {:?}", self.step, self.tolerance)
    }

    fn check(&self) -> Result<(), Error> {
        if self.step > 0.0 { Ok(()) } else { Err(Error::Setting { name: "step", value: self.step }) }
    }

    fn begin(&self, _: &L, _: &State<f64, N>, _: &mut Statistics) -> Result<f64, Error> {
        Ok(self.step)
    }

    fn step(
        &self,
        system: &L,
        planned: &mut f64,
        end: f64,
        from: &State<f64, N>,
        to: &mut State<f64, N>,
        statistics: &mut Statistics,
    ) -> Step {
        let left = end - from.t;
        let is_last = left.abs() <= *planned * (1.0 + 1e-9);
        let time = if is_last { end } else { from.t + *planned * left.signum() };
        let h = time - from.t;
        let failed =
            |_| Step::Failed(Ending::MethodFailed { time: from.t, reason: "a stage has no solution" });
        statistics.evaluations += 2;
        let first = match system.solve(from) {
            Ok(solution) => solution.accelerations,
            Err(error) => return failed(error),
        };
        let euler = State { t: time, q: from.q + from.v * h, v: from.v + first * h };
        let last = match system.solve(&euler) {
            Ok(solution) => solution.accelerations,
            Err(error) => return failed(error),
        };
        let (q, v) = (from.q + (from.v + euler.v) * (h / 2.0), from.v + (first + last) * (h / 2.0));
        if let Some(tolerance) = self.tolerance {
            let error = (q - euler.q).norm().max((v - euler.v).norm()) / tolerance;
            *planned = h.abs() * (0.9 * error.max(1e-9).powf(-0.5)).clamp(0.2, 5.0);
            if error > 1.0 {
                return Step::Rejected;
            }
        }
        match system.make_consistent(&State { t: time, q, v }) {
            Ok((next, _)) => {
                *to = next;
                Step::Accepted
            }
            Err(error) => failed(error),
        }
    }

    fn interpolant(
        &self,
        system: &L,
        _: &mut f64,
        [from, to]: [&State<f64, N>; 2],
        _: &mut Statistics,
    ) -> Result<Dense<N>, Error> {
        let node = |state: &State<f64, N>| {
            let rates = PhaseVector::of(state.v, system.solve(state)?.accelerations);
            Ok::<_, Error>((PhaseVector::of(state.q, state.v), rates))
        };
        Ok(Dense(Polynomial::hermite(from.t, to.t - from.t, &node(from)?, &node(to)?)))
    }
}

/// The states within a step.
struct Dense<const N: usize>(Polynomial<f64, [PhaseVector<f64, Const<N>>; 4]>);

impl<const N: usize> Interpolant<f64, Const<N>> for Dense<N> {
    fn at(&self, t: f64) -> StagePoint<f64, Const<N>> {
        self.0.at(t)
    }
}

/// x = sin t, whatever the damping, which a force balances.
fn damped(c: f64) -> DrivenSpring<f64> {
    DrivenSpring { m: 1.0, k: 1.0, c, a: c, w: 1.0 }
}

fn sine(t: f64) -> State<f64, 1> {
    State::new([t.sin()], [t.cos()]).at_time(t)
}

fn off<const N: usize>(state: &State<f64, N>, exact: fn(f64) -> State<f64, N>) -> f64 {
    let exact = exact(state.t);
    (state.q - exact.q).norm() + (state.v - exact.v).norm()
}

/// Asserts the slopes of log error over log step, in four halvings from t = 0 to `end`: at the end, and of the worst error in
/// between.
fn is_of_order_two<L, const N: usize>(system: &L, exact: fn(f64) -> State<f64, N>, end: f64)
where
    L: Lagrangian<N = Const<N>, Scalar = f64>,
{
    let errors = |step: f64| {
        let path = system.integrate(exact(0.0), end, Heun { step, tolerance: None }).expect("a motion");
        let between = path.samples(997).map(|sample| off(sample.state(), exact)).fold(0.0, f64::max);
        [off(path.end().state(), exact), between]
    };
    let (coarse, fine) = (errors(0.1), errors(0.1 / 16.0));
    let orders = [0, 1].map(|k| (coarse[k] / fine[k]).log2() / 4.0);
    assert!(orders.iter().all(|order| (order - 2.0).abs() < 0.15), "{orders:?}");
}

#[test]
fn it_is_of_order_two_at_the_end_and_between() {
    is_of_order_two(&damped(0.0), sine, 8.0);
    is_of_order_two(&damped(0.0), sine, -8.0);
    // With time and velocities in the forces.
    is_of_order_two(&damped(1.0), sine, 8.0);
    // On a constraint.
    let circle = |t: f64| State::new([t.cos(), t.sin()], [-t.sin(), t.cos()]).at_time(t);
    is_of_order_two(&Bead { k: 0.0 }, circle, 3.0);
    let (bead, method) = (Bead { k: 0.0 }, Heun { step: 0.05, tolerance: None });
    let path = bead.integrate(circle(0.0), 3.0, method).unwrap();
    assert!(path.samples(100).all(|sample| (sample.state().q.norm() - 1.0).abs() < 1e-12));
}

#[test]
fn its_steps_are_rejected_until_they_are_short_enough() {
    let (system, method) = (damped(1.0), Heun { step: 10.0, tolerance: Some(1e-5) });
    let path = system.integrate(sine(0.0), 10.0, method).unwrap();
    let statistics = path.statistics();
    assert!(path.ending().is_complete() && statistics.rejected > 3, "{statistics:?}");
    assert!((500..5000).contains(&statistics.accepted), "{statistics:?}");
    assert!(path.steps().chain(path.samples(999)).all(|sample| off(sample.state(), sine) < 1e-4));
    // Steered, on a system behind a reference.
    let mut motion = Motion::new(&system, sine(0.0), method).unwrap();
    for k in 1..=10 {
        motion.advance_to(f64::from(k)).unwrap();
        assert!(off(motion.state(), sine) < 1e-4);
        assert!(off(&motion.at(f64::from(k) - 1e-6).unwrap(), sine) < 1e-4);
    }
}

/// The interpolant meets both ends, with its velocity.
#[test]
fn its_interpolant_meets_the_states() {
    let (system, method) = (damped(1.0), Heun { step: 0.3, tolerance: None });
    let mut statistics = Statistics::default();
    let mut memory = method.begin(&system, &sine(0.0), &mut statistics).unwrap();
    let mut next = sine(0.0);
    let step = method.step(&system, &mut memory, 1.0, &sine(0.0), &mut next, &mut statistics);
    assert_eq!(step, Step::Accepted);
    let interpolant = method.interpolant(&system, &mut memory, [&sine(0.0), &next], &mut statistics).unwrap();
    for state in [sine(0.0), next] {
        let point = interpolant.at(state.t);
        let off = [point.y[0][0] - state.q[0], point.y[1][0] - state.v[0], point.velocity[0] - state.v[0]];
        assert!(off.iter().all(|x| x.abs() < 1e-14), "{off:?}");
    }
}
