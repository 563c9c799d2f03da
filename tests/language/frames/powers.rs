//! Forces along velocities against the same forces as potentials, dissipation and forces on coordinates.

use approx::assert_relative_eq;
use lagrange_core::nalgebra::{Matrix3, Vector3};
use lagrange_core::prelude::*;
use lagrange_random::Random;
use lagrange_systems::random_state;

macro_rules! links {
    ($($(#[$attribute:meta])* $name:ident;)*) => {
        $($(#[$attribute])*
        #[coordinates(x, a, b)]
        #[frame(upper: translate([x, 0, 0]), rotate_y(a))]
        #[frame(lower in upper: translate(elbow), rotate(axis, b))]
        #[define(inertias = kinetic(upper, m, centre, inertia) + kinetic(lower, m, centre, inertia) + m*x_dot^2)]
        struct $name {
            m: f64,
            elbow: Vector3<f64>,
            axis: Vector3<f64>,
            centre: Vector3<f64>,
            inertia: Matrix3<f64>,
            tool: Vector3<f64>,
            push: Vector3<f64>,
            drag: f64,
            torque: f64,
            brake: f64,
        }

        impl $name {
            fn new() -> Self {
                Self {
                    m: 1.2,
                    elbow: Vector3::new(0.1, 0.2, -0.9),
                    axis: Vector3::new(1.0, 1.0, -0.5),
                    centre: Vector3::new(0.0, 0.1, -0.4),
                    inertia: Matrix3::new(0.3, 0.01, 0.02, 0.01, 0.2, 0.0, 0.02, 0.0, 0.1),
                    tool: Vector3::new(0.2, 0.0, -0.8),
                    push: Vector3::new(3.0, -2.0, 5.0),
                    drag: 0.7,
                    torque: 1.5,
                    brake: -0.6,
                }
            }
        })*
    };
}

links! {
    /// Two links on a sledge, pushed at a point, braked by the air at another, driven at the joints.
    #[derive(Lagrangian)]
    #[lagrangian(inertias)]
    #[power(vector(fixed, push), express(velocity(lower, tool), fixed))]
    #[power(-drag*velocity(lower, centre), velocity(lower, centre))]
    #[power([0, torque, 0], angular_velocity(upper))]
    #[power(brake*x, x_dot)]
    Pushed;
    #[derive(Lagrangian)]
    #[lagrangian(inertias + dot(vector(fixed, push), position(lower, tool)))]
    #[dissipation(drag/2*dot(velocity(lower, centre), velocity(lower, centre)))]
    #[force(a: torque)]
    #[force(x: brake*x)]
    Otherwise;
}

#[test]
fn virtual_power_gives_the_generalized_forces() {
    let (pushed, otherwise) = (Pushed::new(), Otherwise::new());
    let random = &mut Random(1);
    for _ in 0..10 {
        let state = random_state(random);
        let (ours, theirs) = (pushed.solve(&state).unwrap(), otherwise.solve(&state).unwrap());
        assert_relative_eq!(ours.accelerations, theirs.accelerations, max_relative = 1e-12);
    }
}
