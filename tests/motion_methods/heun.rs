//! Heun's method of order 2, written against the contract of methods alone. It chooses its steps by the error of Euler's
//! method and rejects those that are too long, returns to the constraints, and has an interpolant of its own.

use lagrange_core::generic::Length;
use lagrange_core::motion::{
    Interpolant, LagrangianVectorField, Limits, PhaseVector, Polynomial, StagePoint, Step, VelocityField,
};
use lagrange_core::{Ending, Method, StateOf, Statistics, System, nalgebra::Const, prelude::*};
use lagrange_systems::{Chain, DrivenSpring};

use crate::midpoint::Bead;

/// All steps have the length `step` without a tolerance.
#[derive(Clone, Copy)]
struct Heun {
    step: f64,
    tolerance: Option<f64>,
}

/// Rates at a point.
fn rates<L, F>(
    system: &L,
    point: &StagePoint<f64, L::Length>,
    statistics: &mut Statistics,
) -> Result<PhaseVector<f64, L::Length>, Error>
where
    L: System<Scalar = f64>,
    F: VelocityField<L>,
{
    statistics.evaluations += 1;
    let mut rates = point.y.clone();
    F::evaluate(system, point, None, &mut rates).map(|_| rates)
}

/// The point at the time `t` that is as far from another as these rates lead in the time h.
fn moved<N: Length>(
    from: &StagePoint<f64, N>,
    t: f64,
    h: f64,
    rates: &PhaseVector<f64, N>,
) -> StagePoint<f64, N> {
    let mut y = from.y.clone();
    y.flat_mut().iter_mut().zip(rates.flat()).for_each(|(y, rate)| *y += h * rate);
    StagePoint::at(t, y)
}

/// For every system: of any length, with a Lagrangian or accelerations of its own.
impl<L: System<Scalar = f64>, F: VelocityField<L>> Method<L, F> for Heun {
    /// Length of the next step.
    type Memory = f64;
    type Interpolant = Dense<L::Length>;

    fn limits(&self) -> Limits {
        Limits::default()
    }

    fn identify(&self, to: &mut dyn std::fmt::Write) -> std::fmt::Result {
        write!(to, "Heun {:?} {:?}", self.step, self.tolerance)
    }

    fn check(&self) -> Result<(), Error> {
        if self.step > 0.0 { Ok(()) } else { Err(Error::Setting { name: "step", value: self.step }) }
    }

    fn begin(&self, _: &L, _: &StateOf<L>, _: &mut Statistics) -> Result<f64, Error> {
        Ok(self.step)
    }

    fn step(
        &self,
        system: &L,
        planned: &mut f64,
        end: f64,
        from: &StateOf<L>,
        to: &mut StateOf<L>,
        statistics: &mut Statistics,
    ) -> Step {
        let left = end - from.t;
        let is_last = left.abs() <= *planned * (1.0 + 1e-9);
        let time = if is_last { end } else { from.t + *planned * left.signum() };
        let (h, start) = (time - from.t, StagePoint::of(from));
        let mut attempt = || {
            let first = rates::<L, F>(system, &start, statistics)?;
            let euler = moved(&start, time, h, &first);
            let last = rates::<L, F>(system, &euler, statistics)?;
            let next = moved(&moved(&start, time, h / 2.0, &first), time, h / 2.0, &last);
            let apart = next.y.flat().iter().zip(euler.y.flat()).map(|(next, euler)| (next - euler).abs());
            Ok::<_, Error>((apart.fold(0.0, f64::max), F::project(system, &next)?))
        };
        let Ok((error, next)) = attempt() else {
            return Step::Failed(Ending::MethodFailed { time: from.t, reason: "a stage has no solution" });
        };
        if let Some(tolerance) = self.tolerance {
            let error = error / tolerance;
            *planned = h.abs() * (0.9 * error.max(1e-9).powf(-0.5)).clamp(0.2, 5.0);
            if error > 1.0 {
                return Step::Rejected;
            }
        }
        *to = next;
        Step::Accepted
    }

    fn interpolant(
        &self,
        system: &L,
        _: &mut f64,
        ends: [&StateOf<L>; 2],
        statistics: &mut Statistics,
    ) -> Result<Dense<L::Length>, Error> {
        let mut node = |state: &StateOf<L>| {
            let point = StagePoint::of(state);
            rates::<L, F>(system, &point, statistics).map(|rates| (point.y, rates))
        };
        let (first, last) = (node(ends[0])?, node(ends[1])?);
        Ok(Dense(Polynomial::hermite(ends[0].t, ends[1].t - ends[0].t, &first, &last)))
    }
}

/// The states within a step.
struct Dense<N: Length>(Polynomial<f64, [PhaseVector<f64, N>; 4]>);

impl<N: Length> Interpolant<f64, N> for Dense<N> {
    fn at(&self, t: f64) -> StagePoint<f64, N> {
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

/// Of a chain whose length is known when the program runs, with an event.
#[test]
fn it_moves_systems_of_any_length() {
    let chain = Chain { masses: 7, beta: 0.5 };
    let exact = chain.integrate(Chain::start(7), 8.0, Dop853::with_tolerance(1e-12)).unwrap();
    let errors = |step: f64| {
        let first = chain.event("first", |sample| sample.state().q[0]);
        let motion = chain.motion(Chain::start(7)).by(Heun { step, tolerance: None }).event(first);
        let path = motion.to(8.0).unwrap();
        let crossing = &path.crossings()[0].state;
        let off = |at: &StateOf<Chain>| (&at.q - &exact.at(at.t).unwrap().state().q).norm();
        [off(path.end().state()), off(crossing)]
    };
    let (coarse, fine) = (errors(0.02), errors(0.02 / 8.0));
    let orders = [0, 1].map(|k| (coarse[k] / fine[k]).log2() / 3.0);
    assert!(orders.iter().all(|order| (order - 2.0).abs() < 0.15), "{orders:?}");
}

/// The interpolant meets both ends, with its velocity.
#[test]
fn its_interpolant_meets_the_states() {
    let (system, start, mut next) = (damped(1.0), sine(0.0), sine(0.0));
    let method: &dyn Method<_, LagrangianVectorField, Memory = f64, Interpolant = Dense<Const<1>>> =
        &Heun { step: 0.3, tolerance: None };
    let (mut planned, mut statistics) = (0.3, Statistics::default());
    let step = method.step(&system, &mut planned, 1.0, &start, &mut next, &mut statistics);
    assert_eq!(step, Step::Accepted);
    let interpolant = method.interpolant(&system, &mut planned, [&start, &next], &mut statistics).unwrap();
    for state in [sine(0.0), next] {
        let point = interpolant.at(state.t);
        let off = [point.y[0][0] - state.q[0], point.y[1][0] - state.v[0], point.velocity[0] - state.v[0]];
        assert!(off.iter().all(|x| x.abs() < 1e-14), "{off:?}");
    }
}
