//! A method from outside of the crate: the explicit midpoint rule, as its coefficients alone. It can be asked for all that the methods
//! of the crate can.

use core::ops::ControlFlow;

use lagrange_core::motion::{Adaptive, Pair, TableauRow};
use lagrange_core::{Ending, prelude::*};
use lagrange_systems::Spring;

/// The midpoint rule of order 2 (Runge 1895), with Euler's rule to estimate the error.
#[derive(Clone, Copy, Debug)]
struct Midpoint;

impl Pair for Midpoint {
    const NODES: &'static [f64] = &[0.0, 0.5, 1.0];
    const STAGES: &'static [TableauRow] = &[&[(0, 0.5)]];
    const WEIGHTS: TableauRow = &[(1, 1.0)];
    const ERROR: TableauRow = &[(0, -1.0), (1, 1.0)];
    const LOWER_ERROR: TableauRow = &[];
    const INTERPOLATION_STAGES: &'static [TableauRow] = &[];
    const INTERPOLATION: &'static [TableauRow] = &[];
    const ORDER: f64 = 2.0;
    const DAMPING: f64 = 0.0;
    const SHRINK: f64 = 0.2;
    const GROWTH: f64 = 5.0;
    type Coefficients<X: Clone + Send + Sync + 'static> = [X; 4];
    fn coefficients<X: Clone + Send + Sync + 'static>(all: X) -> [X; 4] {
        std::array::from_fn(|_| all.clone())
    }
}

/// A bead on a circle of radius 1, held by a spring along x, so that there are constraints.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - k/2 * x^2)]
#[constraint(circle: x^2 + y^2 = 1)]
pub(crate) struct Bead<T> {
    pub(crate) k: T,
}

const BEAD: Bead<f64> = Bead { k: 2.0 };
const END: f64 = 3.0;

fn start() -> State<f64, 2> {
    State::new([0.6, 0.8], [0.8, -0.6])
}

fn midpoint() -> Adaptive<Midpoint> {
    Adaptive::with_tolerance(1e-6).max_steps(1_000_000)
}

/// The end by a method of order 8.
fn exact(k: f64, end: f64) -> State<f64, 2> {
    let bead = Bead { k };
    *bead.integrate(start(), end, Dop853::with_tolerance(1e-13)).expect("a motion").end().state()
}

fn assert_near(state: &State<f64, 2>, expected: &State<f64, 2>, bound: f64) {
    assert!((state.q - expected.q).norm() + (state.v - expected.v).norm() < bound, "{state:?} {expected:?}");
}

#[test]
fn its_order_is_two_and_its_error_is_controlled() {
    let error = |step: f64| {
        let path = BEAD.integrate(start(), END, midpoint().fixed_step(step)).expect("a motion");
        (path.end().state().q - exact(2.0, END).q).norm()
    };
    let order = (error(2e-3) / error(1e-3)).log2();
    assert!((order - 2.0).abs() < 0.1, "{order}");
    for end in [END, -END] {
        let path = BEAD.integrate(start(), end, midpoint()).expect("a motion");
        assert_near(path.end().state(), &exact(2.0, end), 1e-3);
        // Between its steps, on the constraint.
        assert_near(path.at(0.5 * end).expect("within").state(), &exact(2.0, 0.5 * end), 1e-3);
        assert!(path.samples(100).all(|sample| (sample.state().q.norm() - 1.0).abs() < 1e-12));
    }
}

#[test]
fn it_has_events_samples_progress_and_a_controller() {
    let side = BEAD.event("side", |s| s.coordinate("x")).terminal();
    let mut steps = 0;
    let asked = BEAD.motion(start()).by(midpoint()).every(0.1).event(side).on_progress(|_| {
        steps += 1;
        ControlFlow::Continue(())
    });
    let arrival = asked.to(END).expect("a motion");
    assert!(matches!(arrival.ending(), Ending::Event { event: "side", .. }) && steps > 10);
    assert!(arrival.end().state().q[0].abs() < 1e-12);
    for state in arrival.samples() {
        assert_near(state, &exact(2.0, state.t), 1e-3);
    }
    let steered = BEAD.motion(start()).by(midpoint()).controlled(0.5, |bead, _| {
        bead.k = 3.0;
        Ok::<_, Error>(())
    });
    assert_near(steered.to(END).expect("a motion").end().state(), &exact(3.0, END), 1e-3);
}

#[cfg(feature = "thorough")]
#[test]
fn it_has_sensitivities_and_exponents() {
    let given = BEAD.sensitivity(&start(), &["k"]).expect("a name");
    let motion = BEAD.motion_with_derivatives(&given).by(midpoint()).to(END).expect("a motion");
    let slope = (exact(2.0 + 1e-5, END).q - exact(2.0 - 1e-5, END).q) / 2e-5;
    let found = motion.derivatives_at_end().expect("the end").q.column(0).into_owned();
    assert!((&found - slope).norm() < 1e-2 * slope.norm(), "{found} {slope}");
    let spectrum = BEAD.lyapunov_spectrum(start(), 20.0, midpoint()).expect("a motion");
    let expected = BEAD.lyapunov_spectrum(start(), 20.0, Dop853::default()).expect("a motion");
    for (exponent, expected) in spectrum.exponents.iter().zip(&expected.exponents) {
        assert!((exponent - expected).abs() < 1e-3, "{exponent} {expected}");
    }
}

#[cfg(feature = "thorough")]
#[test]
fn it_integrates_ensembles_alone_and_on_lanes() {
    let beads = || Ensemble::from_fn(9, |n| (Bead { k: n as f64 }, start())).every(0.5);
    for outcome in [beads().integrate(END, midpoint()), beads().integrate_on_lanes(END, midpoint())] {
        for (index, state) in outcome.expect("an ensemble").completed() {
            assert_near(state, &exact(index as f64, END), 1e-2);
        }
    }
}

#[test]
fn it_integrates_hamiltons_equations() {
    let spring = Spring { m: 1.0, k: 1.0 };
    let path = spring.motion_in_momenta(PhaseState::new([1.0], [0.0])).by(midpoint()).to(END);
    assert!((path.expect("a motion").end().state().q[0] - END.cos()).abs() < 1e-3);
}
