//! Dense output passes through states and accelerations at both ends of a step, and evaluates no forces twice.

use lagrange_core::motion::Composition::KahanLi8;
use lagrange_core::nalgebra::Const;
use lagrange_core::{Lagrangian, Linearized, Method, prelude::*};

use crate::systems::*;

/// Asserts that at both ends of each step the slopes of coordinates and velocities are velocities and accelerations, and that
/// no more forces are evaluated than `per_step`, and two at the start.
fn check<L, P, const N: usize>(name: &str, (system, start): (L, State<f64, N>), per_step: usize, method: P)
where
    L: Lagrangian<N = Const<N>, Scalar = f64>,
    P: Method<L>,
{
    let path = system.integrate(start, 2.0, method).unwrap();
    let states: Vec<_> = path.steps().map(|step| *step.state()).collect();
    for pair in states.windows(2) {
        let near = 1e-4 * (pair[1].t - pair[0].t);
        for (end, near) in [(&pair[0], near), (&pair[1], -near)] {
            let beside = *path.at(end.t + near).unwrap().state();
            let accelerations = system.solve(end).unwrap().accelerations;
            let slopes = [(beside.q - end.q) / near - end.v, (beside.v - end.v) / near - accelerations];
            let off = slopes[0].amax().max(slopes[1].amax());
            assert!(off < 1e-3 * (1.0 + accelerations.amax()), "{name}: slopes off by {off:e} at {}", end.t);
        }
    }
    let statistics = path.statistics();
    let evaluations = statistics.evaluations - 2;
    assert!(evaluations <= per_step * statistics.accepted, "{name}: {statistics:?}");
}

#[test]
fn dense_output_has_the_rates_of_the_ends() {
    check("Verlet", kepler(), 1, Verlet::with_step(0.01));
    check("order 8", kepler(), 17 + 4, Verlet::with_step(0.02).composed(KahanLi8));
    check("RATTLE", spherical(), 1, Verlet::with_step(0.01));
    check("RATTLE with two rods", two_bobs(), 1, Verlet::with_step(0.01));
    check("RATTLE on a moving rod", shaken(), 1, Verlet::with_step(0.01));
    check("Gauss 2", double_pendulum(), 2 * 15 + 1, Gauss::<2>::with_step(0.01));
    check("Gauss 3", charge(), 3 * 15 + 5, Gauss::<3>::with_step(0.01));
    check("Lobatto 3", bowl(), 3 * 15 + 1, Lobatto::<3>::with_step(0.01));
    check("DAlembert", sleigh(), 2 * 15 + 1, DAlembert::with_step(0.01));
}

/// Accelerations that an earlier step left are not those of another system, nor of another state.
#[test]
fn changes_of_the_system_reach_dense_output() {
    fn check<L, P, const N: usize>((system, start): (L, State<f64, N>), method: P, parameter: usize)
    where
        L: Linearized<N = Const<N>, Scalar = f64> + Clone,
        P: Method<L> + Copy,
    {
        let middle = |begins_anew: bool| {
            let mut motion = Motion::new(system.clone(), start, method).unwrap();
            motion.advance_to(0.01).unwrap();
            motion.at(0.005).unwrap();
            assert!(motion.system_mut().set_parameter(parameter, 50.0));
            if begins_anew {
                motion = Motion::new(motion.system().clone(), *motion.state(), method).unwrap();
            }
            motion.advance_to(0.02).unwrap();
            motion.at(0.015).unwrap()
        };
        assert_eq!(middle(false), middle(true));
    }
    check(kepler(), Verlet::with_step(0.01), 0);
    check(spherical(), Verlet::with_step(0.01), 1);
    check(double_pendulum(), Gauss::<2>::with_step(0.01), 0);
    check(bowl(), Lobatto::<3>::with_step(0.01), 1);
}
