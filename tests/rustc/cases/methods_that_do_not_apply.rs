//! Methods on systems that they do not integrate: each error names the reason and the method to take.

use lagrange_core::function::Table;
use lagrange_core::prelude::*;

/// Two pendulums in angles: the mass matrix depends on them.
#[derive(Clone, Lagrangian)]
#[coordinates(a, b)]
#[lagrangian(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b) + 2*cos(a) + cos(b))]
struct DoublePendulum;

/// The force depends on the velocity.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^2/2)]
#[dissipation(c/2 * x_dot^2)]
struct DampedSpring {
    c: f64,
}

/// A holonomic constraint.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - y)]
#[constraint(rod: x^2 + y^2 = 1)]
struct Pendulum;

/// A constraint on velocities.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian((x_dot^2 + y_dot^2 + theta_dot^2)/2)]
#[constraint(blade: x_dot*sin(theta) - y_dot*cos(theta) = 0)]
struct Skate;

/// A rigid body: its unit quaternion implies a constraint.
#[derive(Clone, Lagrangian)]
#[coordinates(q: [4])]
#[frame(body: rotate(q))]
#[lagrangian(kinetic(body, 0, [0, 0, 0], inertia))]
struct Top {
    inertia: lagrange_core::nalgebra::Matrix3<f64>,
}

/// A bead on a rail that is given by a table, of which third derivatives are not known.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[function(rail(x))]
#[lagrangian((x_dot^2 + y_dot^2)/2 - y)]
#[constraint(on: y = rail(x))]
struct Rail {
    rail: Table,
}

/// All methods integrate it.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - k*x^2/2)]
struct Spring<T> {
    k: T,
}

fn main() -> Result<(), Error> {
    DoublePendulum.integrate(State::at_rest([1.0, 0.0]), 1.0, Verlet::with_step(0.01))?;
    DampedSpring { c: 0.1 }.integrate(State::at_rest([1.0]), 1.0, Verlet::with_step(0.01))?;
    Skate.integrate(State::at_rest([0.0; 3]), 1.0, Verlet::with_step(0.01))?;
    Pendulum.integrate(State::at_rest([1.0, 0.0]), 1.0, Gauss::<2>::with_step(0.01))?;
    Skate.integrate(State::at_rest([0.0; 3]), 1.0, Gauss::<2>::with_step(0.01))?;
    let top = Top { inertia: lagrange_core::nalgebra::Matrix3::identity() };
    top.integrate(State::at_rest([1.0, 0.0, 0.0, 0.0]), 1.0, Gauss::<2>::with_step(0.01))?;
    Skate.integrate(State::at_rest([0.0; 3]), 1.0, Lobatto::<2>::with_step(0.01))?;
    // Numbers of stages without coefficients.
    let (spring, start) = (Spring { k: 1.0 }, State::at_rest([1.0]));
    spring.integrate(start, 1.0, Gauss::<7>::with_step(0.01))?;
    spring.integrate(start, 1.0, Lobatto::<1>::with_step(0.01))?;
    let rail = Rail { rail: Table::new(&[(0.0, 0.0), (0.5, 0.3), (1.0, 1.0), (1.5, 1.4)])? };
    rail.integrate(State::at_rest([0.0, 0.0]), 1.0, Radau::default())?;
    // Derivatives of motions.
    DampedSpring { c: 0.1 }.integrate_sensitivities(
        State::at_rest([1.0]),
        1.0,
        DAlembert::with_step(0.01),
        &["c"],
    )?;
    // Members of an ensemble on lanes.
    let ensemble = Ensemble::from_fn(10, |k| (Spring { k: 1.0 }, State::at_rest([k as f64])));
    let _ = ensemble.integrate_on_lanes(1.0, Verlet::with_step(0.01));
    // Motions in (q, p).
    spring.motion_in_momenta(PhaseState::new([1.0], [0.0])).by(Verlet::with_step(0.01)).to(1.0)?;
    Ok(())
}
