//! Derivatives of motions with sin t where t is so large that vector functions do not compute it.

use lagrange_core::linearized::{DifferentiableMethod, TrajectorySensitivity};
use lagrange_core::motion::Composition::KahanLi8;
use lagrange_core::nalgebra::DMatrix;
use lagrange_core::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - 2*x^2)]
#[force(x: f*sin(t))]
struct Driven<T> {
    f: T,
}

/// The motion is linear in its start and in f, so that its derivatives add up to it, whatever the steps.
#[test]
fn derivatives_far_from_zero_add_up_to_the_motion() {
    fn check<D: DifferentiableMethod<Driven<f64>>>(method: D, far: f64) {
        let start = State::new([0.7], [-0.4]).at_time(far);
        let names = ["x", "x_dot", "f"];
        let motion = Driven { f: 1.5 }.integrate_sensitivities(start, far + 10.0, method, &names).unwrap();
        let end = motion.end().unwrap();
        for (by, state) in [(&end.q, end.state.q[0]), (&end.v, end.state.v[0])] {
            let sum = by[0] * 0.7 - by[1] * 0.4 + by[2] * 1.5;
            assert!((sum - state).abs() < 1e-13, "{sum} for {state} from {far:e}");
        }
    }
    for far in [0.0, 1e6, 1e8, 3e9] {
        check(Verlet::with_step(0.1), far);
        check(Gauss::<1>::with_step(0.1), far);
        check(Gauss::<3>::with_step(0.1), far);
        check(Lobatto::<2>::with_step(0.1), far);
        check(Lobatto::<4>::with_step(0.1), far);
        check(DAlembert::with_step(0.1).composed(KahanLi8), far);
    }
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - g*y)]
#[constraint(rod: (x - f*sin(t))^2 + y^2 = 1)]
struct Shaken<T> {
    g: T,
    f: T,
}

/// A pivot that swings as sin t, at 10⁸, by another method.
#[test]
fn derivatives_far_from_zero_are_those_of_other_methods() {
    let (system, names) = (Shaken { g: 1.0, f: 0.3 }, ["x", "x_dot", "g", "f"]);
    let start = system.make_consistent(&State::new([0.5, -0.7], [0.2, 0.0]).at_time(1e8)).unwrap().0;
    let end = |motion: TrajectorySensitivity<'_, Shaken<f64>>| motion.end().unwrap().q.clone();
    let by = |method| system.integrate_sensitivities(start, 1e8 + 10.0, method, &names).unwrap();
    let exact = end(by(Dop853::with_tolerance(1e-11)));
    let apart = |found: DMatrix<f64>| (found - &exact).amax();
    let lobatto = system.integrate_sensitivities(start, 1e8 + 10.0, Lobatto::<4>::with_step(0.05), &names);
    let dalembert = DAlembert::with_step(0.1).composed(KahanLi8);
    let dalembert = system.integrate_sensitivities(start, 1e8 + 10.0, dalembert, &names);
    let taylor = system.integrate_sensitivities(start, 1e8 + 10.0, Taylor::default(), &names);
    for found in [lobatto, dalembert, taylor] {
        let off = apart(end(found.unwrap()));
        println!("{off:e}");
        assert!(off < 1e-6, "{off:e}");
    }
}
