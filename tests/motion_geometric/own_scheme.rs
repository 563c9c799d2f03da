//! A scheme that is written against the public interface alone has all that the methods of the crate have.

use core::fmt;

use lagrange_core::motion::Composition::KahanLi8;
use lagrange_core::motion::{CompensatedState, FixedStep, NotSettled, Parts, Scheme, SymmetricScheme};
use lagrange_core::structure::{ConstantMassMatrix, Unconstrained, VelocityFreeForces};
use lagrange_core::{Ending, StateOf, prelude::*};

use crate::symplectic;
use crate::systems::*;

/// Half a step of the coordinates, a step of the velocities, half a step of the coordinates.
#[derive(Clone, Copy, Debug, Default)]
struct DriftKickDrift;

impl SymmetricScheme for DriftKickDrift {}

impl<L> Scheme<L> for DriftKickDrift
where
    L: Lagrangian<Scalar: Parts> + ConstantMassMatrix + VelocityFreeForces + Unconstrained,
{
    type Carried = ();

    const ORDER: usize = 2;

    fn identify(to: &mut dyn fmt::Write) -> fmt::Result {
        to.write_str("drift, kick, drift")
    }

    fn start(_: &L, _: &StateOf<L>) {}

    fn advance(
        system: &L,
        point: &mut CompensatedState<L::Scalar, L::N>,
        _: &mut (),
        (h, to): (L::Scalar, L::Scalar),
    ) -> Result<usize, NotSettled> {
        let half = L::Scalar::constant(0.5) * h;
        point.set_time(point.state().t + half);
        point.change_coordinates(|state, i| half * state.v[i]);
        let forces = system.accelerations_unchecked(point.state());
        point.change_velocities(|_, i| h * forces.accelerations[i]);
        point.change_coordinates(|state, i| half * state.v[i]);
        point.set_time(to);
        Ok(1)
    }
}

type Drifting = FixedStep<DriftKickDrift>;

#[test]
fn it_has_its_order_and_those_of_its_compositions() {
    let problem = henon_heiles();
    let exact = reference(&problem, 4.0);
    let order = |method: fn(f64) -> Drifting, step: f64| {
        let off = |h| error(problem.0.integrate(problem.1, 4.0, method(h)).unwrap().end().state(), &exact);
        (off(step) / off(step / 2.0)).log2()
    };
    let orders =
        [order(Drifting::with_step, 0.02), order(|h| Drifting::with_step(h).composed(KahanLi8), 1.0)];
    assert!((orders[0] - 2.0).abs() < 0.05 && (orders[1] - 8.0).abs() < 0.5, "{orders:?}");
}

#[test]
fn it_has_dense_output_and_events() {
    let (system, start) = kepler();
    let method = Drifting::with_step(0.02).composed(KahanLi8);
    let apocentre = system.event("apocentre", |sample| {
        let state = sample.state();
        state.q.dot(&state.v)
    });
    let path = system.motion(start).by(method).event(apocentre.falling()).to(6.0).unwrap();
    // Half of a turn of 2π.
    assert!((path.crossings()[0].state.t - core::f64::consts::PI).abs() < 1e-9);
    let exact = system.integrate(start, 6.0, Taylor::default()).unwrap();
    for k in 0..600 {
        let t = 0.01 * f64::from(k);
        assert!(error(path.at(t).unwrap().state(), exact.at(t).unwrap().state()) < 1e-8, "t = {t}");
    }
}

#[test]
fn it_has_derivatives() {
    symplectic::check("a scheme of one's own", &henon_heiles(), Drifting::with_step(0.05));
}

/// Takes five steps of its own length, and no more.
#[derive(Clone, Copy, Debug, Default)]
struct Unsettled;

impl<L: Lagrangian<Scalar: Parts>> Scheme<L> for Unsettled {
    type Carried = usize;

    const ORDER: usize = 1;

    fn identify(to: &mut dyn fmt::Write) -> fmt::Result {
        to.write_str("unsettled")
    }

    fn start(_: &L, _: &StateOf<L>) -> usize {
        0
    }

    fn advance(
        _: &L,
        point: &mut CompensatedState<L::Scalar, L::N>,
        steps: &mut usize,
        (_, to): (L::Scalar, L::Scalar),
    ) -> Result<usize, NotSettled> {
        *steps += 1;
        point.set_time(to);
        if *steps > 5 { Err(NotSettled) } else { Ok(0) }
    }
}

#[test]
fn its_failures_are_endings() {
    let (system, start) = henon_heiles();
    let method = FixedStep::<Unsettled>::with_step(0.25);
    let path = system.motion(start).by(method).towards(10.0).unwrap();
    let Ending::MethodFailed { time: 1.25, reason } = path.ending() else { panic!("{}", path.ending()) };
    assert!(reason.contains("take shorter steps"));
    assert_eq!(path.steps().count(), 6);
}
