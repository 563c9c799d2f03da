//! Taylor's series of order 3, its derivatives by dual numbers through the emitted accelerations; its interpolant is the
//! series itself, a type of its own.

use lagrange_core::motion::{Interpolant, Limits, PhaseVector, StagePoint, Step};
use lagrange_core::{Dual, Method, Statistics, nalgebra::Const, prelude::*};

use crate::orders;

/// A pendulum under a force that makes its motion sin t.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 + g*cos(x))]
#[force(x: g*sin(sin(t)) - sin(t) + c*(cos(t) - x_dot))]
struct Pendulum<T> {
    g: T,
    c: T,
}

#[derive(Clone, Copy)]
struct Taylor {
    step: f64,
}

/// x and its derivatives at a time.
#[derive(Clone, Copy)]
struct Series {
    t: f64,
    derivatives: [f64; 5],
}

impl Series {
    /// The derivatives of the accelerations along the motion, each from those before it.
    fn at(system: &Pendulum<f64>, state: &State<f64, 1>) -> Self {
        let (t, x, v) = (state.t, state.q[0], state.v[0]);
        let a = system.accelerations_unchecked(state).accelerations[0];
        let along = |value: f64, slope: f64| Dual { value, slope };
        let once = Pendulum { g: along(system.g, 0.0), c: along(system.c, 0.0) };
        let first = State::new([along(x, v)], [along(v, a)]).at_time(along(t, 1.0));
        let jerk = once.accelerations_unchecked(&first).accelerations[0].slope;
        let nested = |x: f64, dx: f64, ddx: f64| Dual { value: along(x, dx), slope: along(dx, ddx) };
        let twice = Pendulum { g: nested(system.g, 0.0, 0.0), c: nested(system.c, 0.0, 0.0) };
        let second = State::new([nested(x, v, a)], [nested(v, a, jerk)]).at_time(nested(t, 1.0, 0.0));
        let snap = twice.accelerations_unchecked(&second).accelerations[0].slope.slope;
        Self { t, derivatives: [x, v, a, jerk, snap] }
    }
}

impl Interpolant<f64, Const<1>> for Series {
    fn at(&self, t: f64) -> StagePoint<f64, Const<1>> {
        let [x, v, a, jerk, snap] = self.derivatives;
        let h = t - self.t;
        let velocity = v + h * (a + h / 2.0 * (jerk + h / 3.0 * snap));
        let place = x + h * (v + h / 2.0 * (a + h / 3.0 * (jerk + h / 4.0 * snap)));
        let y = PhaseVector::new([[place].into(), [velocity].into()]);
        StagePoint { t, y, velocity: [velocity].into() }
    }
}

impl Method<Pendulum<f64>> for Taylor {
    /// The series of the last step, and the state.
    type Memory = (Option<Series>, State<f64, 1>);
    type Interpolant = Series;

    fn limits(&self) -> Limits {
        Limits::default()
    }

    fn identify(&self, to: &mut dyn std::fmt::Write) -> std::fmt::Result {
        write!(to, "Taylor {:?}", self.step)
    }

    fn check(&self) -> Result<(), Error> {
        Ok(())
    }

    fn begin(
        &self,
        _: &Pendulum<f64>,
        start: &State<f64, 1>,
        _: &mut Statistics,
    ) -> Result<Self::Memory, Error> {
        Ok((None, *start))
    }

    fn step(
        &self,
        system: &Pendulum<f64>,
        (last, state): &mut Self::Memory,
        end: f64,
        statistics: &mut Statistics,
    ) -> Step<f64, Const<1>> {
        let left = end - state.t;
        let time =
            if left.abs() <= self.step * (1.0 + 1e-9) { end } else { state.t + self.step * left.signum() };
        statistics.evaluations += 3;
        let series = Series::at(system, state);
        let [q, v] = series.at(time).y.arrays();
        (*last, *state) = (Some(series), State::new(q, v).at_time(time));
        Step::Accepted(*state)
    }

    fn interpolant(
        &self,
        _: &Pendulum<f64>,
        (last, state): &mut Self::Memory,
        _: &mut Statistics,
    ) -> Result<Series, Error> {
        let [time, start, end] = [state.t; 3];
        last.ok_or(Error::OutsideTrajectory { time, start, end })
    }
}

const PENDULUM: Pendulum<f64> = Pendulum { g: 9.81, c: 0.5 };

fn sine(t: f64) -> State<f64, 1> {
    State::new([t.sin()], [t.cos()]).at_time(t)
}

#[test]
fn it_is_of_order_three() {
    for end in [4.0, -2.0] {
        let [at_end, between] = orders((&PENDULUM, sine), end, 0.05, |step| Taylor { step });
        assert!((at_end - 3.0).abs() < 0.2 && (between - 3.0).abs() < 0.2, "{at_end}, {between}");
    }
}

#[test]
fn its_derivatives_are_those_of_the_motion() {
    let Series { derivatives, .. } = Series::at(&PENDULUM, &sine(0.7));
    let (s, c) = 0.7_f64.sin_cos();
    for (found, exact) in derivatives.into_iter().zip([s, c, -s, -c, s]) {
        assert!((found - exact).abs() < 1e-13, "{derivatives:?}");
    }
}

/// The trajectory's dense output is the series, and so is what a steered motion says of its last step.
#[test]
fn its_interpolant_is_the_series() {
    let path = PENDULUM.integrate(sine(0.0), 0.3, Taylor { step: 0.1 }).unwrap();
    let mut motion = Motion::new(PENDULUM, sine(0.0), Taylor { step: 0.1 }).unwrap();
    motion.advance_to(0.1).unwrap();
    for k in 1..10 {
        let t = 0.01 * f64::from(k);
        let [q, v] = Series::at(&PENDULUM, &sine(0.0)).at(t).y.arrays();
        let expected = State::new(q, v).at_time(t);
        assert_eq!((*path.at(t).unwrap().state(), motion.at(t).unwrap()), (expected, expected));
    }
}
