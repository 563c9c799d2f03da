//! Methods that do what no method may: each is found out, and says so.

use core::cell::Cell;

use lagrange_core::motion::{Limits, PhaseVector, Polynomial, Step};
use lagrange_core::{Ending, Method, Statistics, nalgebra::Const, prelude::*};

type Spring = lagrange_systems::Spring<f64>;

const SPRING: Spring = Spring { m: 1.0, k: 1.0 };

/// What a wrong method makes of the time.
#[derive(Clone, Copy, Debug)]
enum Fault {
    Beyond,
    Nowhere,
    Back,
    NoNumber,
}

/// Takes three right steps before the wrong one.
struct Wrong(Fault);

impl Method<Spring> for Wrong {
    /// Number of steps.
    type Memory = usize;
    type Interpolant = Polynomial<f64, [PhaseVector<f64, Const<1>>; 4]>;

    fn limits(&self) -> Limits {
        Limits::default()
    }

    fn identify(&self, to: &mut dyn std::fmt::Write) -> std::fmt::Result {
        write!(to, "Wrong {:?}", self.0)
    }

    fn check(&self) -> Result<(), Error> {
        Ok(())
    }

    fn begin(&self, _: &Spring, _: &State<f64, 1>, _: &mut Statistics) -> Result<usize, Error> {
        Ok(0)
    }

    fn step(
        &self,
        _: &Spring,
        steps: &mut usize,
        end: f64,
        _: &State<f64, 1>,
        to: &mut State<f64, 1>,
        _: &mut Statistics,
    ) -> Step {
        *steps += 1;
        to.t = match self.0 {
            _ if *steps <= 3 => to.t + 0.1 * (end - to.t).signum(),
            Fault::Beyond => end + (end - to.t),
            Fault::Nowhere => to.t,
            Fault::Back => to.t - 0.1 * (end - to.t).signum(),
            Fault::NoNumber => f64::NAN,
        };
        Step::Accepted
    }

    fn interpolant(
        &self,
        _: &Spring,
        _: &mut usize,
        [from, to]: [&State<f64, 1>; 2],
        _: &mut Statistics,
    ) -> Result<Self::Interpolant, Error> {
        let node = (PhaseVector::of(from.q, from.v), PhaseVector::filled(0.0));
        Ok(Polynomial::hermite(from.t, to.t - from.t, &node, &node))
    }
}

#[test]
fn a_step_that_leads_elsewhere_is_found_out() {
    for fault in [Fault::Beyond, Fault::Nowhere, Fault::Back, Fault::NoNumber] {
        for end in [1.0, -1.0] {
            let is_found = |ending: &Ending| {
                assert!(matches!(ending, Ending::MethodFailed { .. }), "{fault:?}: {ending}");
                assert!((ending.time() - 0.3 * end).abs() < 1e-15, "{fault:?}: {ending}");
                assert!(ending.to_string().contains("by the method"), "{ending}");
            };
            let mut motion = Motion::new(SPRING, State::at_rest([1.0]), Wrong(fault)).unwrap();
            is_found(&motion.advance_to(end).unwrap_err());
            assert!((motion.state().t - 0.3 * end).abs() < 1e-15);
            let (ending, steps) = ending_of(end, Wrong(fault));
            is_found(&ending);
            assert_eq!(steps, 3);
        }
    }
}

fn ending_of(end: f64, method: impl Method<Spring>) -> (Ending, usize) {
    let path = SPRING.motion(State::at_rest([1.0])).by(method).towards(end).expect("a start");
    (path.ending().clone(), path.steps().count() - 1)
}

/// Dormand and Prince's, but for so many interpolants that it cannot give; and may not take a step back.
struct Grudging {
    failures: Cell<usize>,
    takes_back: bool,
}

impl Method<Spring> for Grudging {
    type Memory = <Dopri5 as Method<Spring>>::Memory;
    type Interpolant = <Dopri5 as Method<Spring>>::Interpolant;

    fn limits(&self) -> Limits {
        Limits::default()
    }

    fn identify(&self, to: &mut dyn std::fmt::Write) -> std::fmt::Result {
        write!(to, "Grudging")
    }

    fn check(&self) -> Result<(), Error> {
        Ok(())
    }

    fn begin(
        &self,
        system: &Spring,
        start: &State<f64, 1>,
        statistics: &mut Statistics,
    ) -> Result<Self::Memory, Error> {
        Method::<Spring>::begin(&Dopri5::default(), system, start, statistics)
    }

    fn step(
        &self,
        system: &Spring,
        memory: &mut Self::Memory,
        end: f64,
        from: &State<f64, 1>,
        to: &mut State<f64, 1>,
        statistics: &mut Statistics,
    ) -> Step {
        Method::<Spring>::step(&Dopri5::default(), system, memory, end, from, to, statistics)
    }

    fn interpolant(
        &self,
        system: &Spring,
        memory: &mut Self::Memory,
        ends: [&State<f64, 1>; 2],
        statistics: &mut Statistics,
    ) -> Result<Self::Interpolant, Error> {
        if self.failures.get() > 0 {
            self.failures.set(self.failures.get() - 1);
            return Err(Error::EndNotFinite { end: f64::NAN });
        }
        Method::<Spring>::interpolant(&Dopri5::default(), system, memory, ends, statistics)
    }

    fn undo(&self, memory: &mut Self::Memory) -> bool {
        self.takes_back && Method::<Spring>::undo(&Dopri5::default(), memory)
    }
}

/// A step without an interpolant is none where interpolants are kept: a shorter one is tried.
#[test]
fn a_step_without_an_interpolant_is_taken_back() {
    let grudging = |takes_back| Grudging { failures: Cell::new(5), takes_back };
    let path = SPRING.integrate(State::at_rest([1.0]), 10.0, grudging(true)).unwrap();
    assert!(path.ending().is_complete() && path.statistics().rejected >= 5, "{}", path.ending());
    assert_eq!(path.steps().count(), path.statistics().accepted + 1);
    for sample in path.samples(100) {
        assert!((sample.state().q[0] - sample.time().cos()).abs() < 1e-6);
    }
    // Where it cannot be taken back the motion ends before it.
    let (ending, steps) = ending_of(10.0, grudging(false));
    assert!(matches!(ending, Ending::Unsolved { time: 0.0, .. }) && steps == 0, "{ending}");
    // Nobody asks in a motion that keeps none.
    let mut motion = Motion::new(SPRING, State::at_rest([1.0]), grudging(true)).unwrap();
    motion.advance_to(10.0).unwrap();
    assert_eq!(motion.statistics().rejected, 0);
    assert!(motion.at(motion.state().t - 1e-3).is_err());
    let kept = motion.state().q[0];
    assert!((kept - 10_f64.cos()).abs() < 1e-6 && motion.at(motion.state().t).is_ok());
}

/// Writes what is no state of the motion before it rejects a step, and before it fails.
struct Scribbling {
    fails_at: usize,
}

impl Method<Spring> for Scribbling {
    /// Number of attempts.
    type Memory = usize;
    type Interpolant = Polynomial<f64, [PhaseVector<f64, Const<1>>; 4]>;

    fn limits(&self) -> Limits {
        Limits::default()
    }

    fn identify(&self, to: &mut dyn std::fmt::Write) -> std::fmt::Result {
        write!(to, "Scribbling")
    }

    fn check(&self) -> Result<(), Error> {
        Ok(())
    }

    fn begin(&self, _: &Spring, _: &State<f64, 1>, _: &mut Statistics) -> Result<usize, Error> {
        Ok(0)
    }

    fn step(
        &self,
        _: &Spring,
        attempts: &mut usize,
        _: f64,
        from: &State<f64, 1>,
        to: &mut State<f64, 1>,
        _: &mut Statistics,
    ) -> Step {
        assert_eq!(from, to);
        *attempts += 1;
        *to = State::new([f64::NAN], [7.0]).at_time(from.t + 0.1);
        if *attempts == self.fails_at {
            return Step::Failed(Ending::MethodFailed { time: from.t, reason: "it scribbles" });
        }
        if *attempts % 2 == 1 {
            return Step::Rejected;
        }
        to.q = from.q;
        Step::Accepted
    }

    fn interpolant(
        &self,
        _: &Spring,
        _: &mut usize,
        [from, to]: [&State<f64, 1>; 2],
        _: &mut Statistics,
    ) -> Result<Self::Interpolant, Error> {
        let node = |state: &State<f64, 1>| (PhaseVector::of(state.q, state.v), PhaseVector::filled(0.0));
        Ok(Polynomial::hermite(from.t, to.t - from.t, &node(from), &node(to)))
    }
}

#[test]
fn what_a_step_leaves_that_is_not_accepted_is_not_used() {
    let mut motion = Motion::new(SPRING, State::at_rest([1.0]), Scribbling { fails_at: 7 }).unwrap();
    let ending = motion.advance_to(1.0).unwrap_err();
    assert!(matches!(ending, Ending::MethodFailed { .. }), "{ending}");
    assert_eq!((motion.state().q[0], motion.statistics().accepted), (1.0, 3));
    assert!((motion.state().t - 0.3).abs() < 1e-15);
}
