//! What frames are asked for, against differences of poses.

use approx::assert_relative_eq;
use lagrange_core::nalgebra::{Matrix3, Vector3};
use lagrange_core::prelude::*;

use crate::frames::moving::{machine, point, pose, rate, state};

const TIMES: [f64; 3] = [-0.4, 0.1, 0.8];

/// Along the fixed axes.
fn world(t: f64) -> Vector3<f64> {
    pose(t, "arm[2]").transform_point(&point(t).into()).coords
}

fn axes(t: f64, frame: &str) -> Matrix3<f64> {
    pose(t, frame).rotation.to_rotation_matrix().into_inner()
}

/// ω along the frame's own axes: S ω = Rᵀ Ṙ.
fn spin(t: f64, frame: &'static str) -> Vector3<f64> {
    let skew = axes(t, frame).transpose() * rate(|t| axes(t, frame), t);
    Vector3::new(skew[(2, 1)], skew[(0, 2)], skew[(1, 0)])
}

fn assert_same(ours: impl Into<Vector3<f64>>, theirs: Vector3<f64>, tolerance: f64) {
    assert_relative_eq!(ours.into(), theirs, epsilon = tolerance, max_relative = tolerance);
}

#[test]
fn positions_velocities_and_what_is_expressed_elsewhere() {
    let machine = machine();
    for t in TIMES {
        let (state, _) = state(t);
        assert_same(machine.at(&state), world(t), 1e-14);
        assert_same(machine.origin(&state), pose(t, "arm[1]").translation.vector, 1e-14);
        assert_same(machine.tool(&state), axes(t, "arm[2]").transpose() * rate(world, t), 1e-11);
        assert_same(machine.spin(&state), spin(t, "arm[2]"), 1e-11);
        let vector = axes(t, "arm[2]") * Vector3::new(1.0, 2.0, 3.0);
        assert_same(machine.turned(&state), axes(t, "arm[0]").transpose() * vector, 1e-14);
        assert_same(machine.sideways(&state), axes(t, "platform").transpose() * vector, 1e-14);
    }
}

#[test]
fn rates_of_vectors_are_seen_from_where_it_is_said() {
    let machine = machine();
    for t in TIMES {
        let (state, accelerations) = state(t);
        let mut solution = machine.solve(&state).unwrap();
        solution.accelerations = accelerations.into();
        let acceleration = rate(|t| rate(world, t), t);
        assert_same(machine.felt(&state, &solution), axes(t, "arm[2]").transpose() * acceleration, 1e-8);
        // Components along the axes of the frame that it is seen from change as they do.
        let seen = |frame: &'static str, vector: &dyn Fn(f64) -> Vector3<f64>| {
            axes(t, frame) * rate(|t| axes(t, frame).transpose() * vector(t), t)
        };
        let velocity = |t: f64| rate(world, t);
        assert_same(machine.felt_on_platform(&state, &solution), seen("platform", &velocity), 1e-8);
        let arm = |t: f64| axes(t, "arm[2]") * point(t);
        assert_same(machine.from_body(&state), seen("body", &arm), 1e-11);
    }
}

#[test]
fn kinetic_energies_are_those_of_koenigs_theorem() {
    let machine = machine();
    let centre = |t: f64| pose(t, "arm[2]").transform_point(&Vector3::new(0.3, -0.2, 0.7).into()).coords;
    for t in TIMES {
        let (state, _) = state(t);
        let moving = |of: &dyn Fn(f64) -> Vector3<f64>| machine.m / 2.0 * rate(of, t).norm_squared();
        let spin = spin(t, "arm[2]");
        let turning = spin.dot(&(machine.inertia * spin)) / 2.0;
        assert_relative_eq!(machine.work(&state), moving(&centre) + turning, max_relative = 1e-11);
        assert_relative_eq!(machine.of_point(&state), moving(&world), max_relative = 1e-11);
        let origin = |t: f64| pose(t, "arm[2]").translation.vector;
        assert_relative_eq!(machine.bare(&state), moving(&origin), max_relative = 1e-11);
    }
}
