//! Marker traits: systems of known structure, each with the traits that the derive implements.

use super::bodies::ARM;
use super::{declaration, systems, tokens};
use crate::mechanics::Marker::{self, ConstantMassMatrix, VelocityFreeForces};
use crate::{expand, stub};

/// Marker traits that are implemented in emitted code.
fn emitted(source: &str) -> Vec<Marker> {
    let expansion = expand(tokens(source)).to_string();
    assert!(!expansion.contains("compile_error"), "{source}: {expansion:.400}");
    implemented(&expansion)
}

fn implemented(expansion: &str) -> Vec<Marker> {
    let is_implemented = |marker: &Marker| expansion.contains(&format!(":: structure :: {marker:?} for"));
    Marker::ALL.into_iter().filter(is_implemented).collect()
}

/// Checks whether M is known to be constant and h to be free of velocities.
#[track_caller]
fn check(source: &str, expected: [bool; 2]) {
    let emitted = emitted(source);
    let found = [ConstantMassMatrix, VelocityFreeForces].map(|marker| emitted.contains(&marker));
    assert_eq!(found, expected, "{source}");
}

/// Like [`check`], for a Lagrangian in the plane, with further attributes.
#[track_caller]
fn plane(lagrangian: &str, more: &str, expected: [bool; 2]) {
    let source = format!(
        "#[coordinates(x, y)]
         #[lagrangian({lagrangian})]
         {more}
         struct System<F> {{ m: f64, k: f64, l: f64, w: f64, f: F }}"
    );
    check(&source, expected);
}

/// A particle of mass m.
const PARTICLE: &str = "m/2*(x_dot^2 + y_dot^2)";

#[test]
fn mass_matrices_of_parameters_are_constant() {
    for kinetic in [
        PARTICLE,
        "m/2*(x_dot^2 + y_dot^2) + k*x_dot*y_dot",
        "f(l)/2*(x_dot^2 + y_dot^2)",
        "sqrt(m^2 + k^2)/2*(x_dot + y_dot*l)^2 + x_dot^2",
    ] {
        plane(&format!("{kinetic} - k/4*(x^4 + y^4)"), "#[function(f(l))]", [true, true]);
    }
}

/// cos² + sin² is 1, however the position of the pendulum is written.
#[test]
fn a_pendulum_by_its_position_has_a_constant_mass_matrix() {
    check(systems::PENDULUM, [true, true]);
    let pendulum = |position: &str, lagrangian: &str| {
        let source = format!(
            "#[coordinates(theta)]
             {position}
             #[lagrangian({lagrangian})]
             struct Pendulum {{ m: f64, l: f64, g: f64, a: f64 }}"
        );
        check(&source, [true, true]);
    };
    let position = "#[define(p = [l*sin(theta), -l*cos(theta)])]";
    pendulum(position, "m/2*dot(der(p), der(p)) - m*g*p[1]");
    let shaken = "#[define(p = [l*sin(theta), a*cos(t) - l*cos(theta)])]";
    pendulum(shaken, "m/2*dot(der(p), der(p)) - m*g*p[1]");
    let in_frames = "#[frame(rod: rotate_z(theta), translate([l, 0, 0]))]";
    pendulum(in_frames, "m/2*norm(velocity(rod))^2 + m*g*position(rod)[0]");
    pendulum(in_frames, "kinetic(rod, m, [a, 0, 0], m*identity(3)) + m*g*position(rod, [a, 0, 0])[0]");
}

#[test]
fn a_mass_matrix_of_the_coordinates_is_not_constant() {
    plane("m/2*(x_dot^2 + x^2*y_dot^2)", "", [false, false]);
    plane("f(x)/2*(x_dot^2 + y_dot^2)", "#[function(f(x))]", [false, false]);
    check(&systems::chain(3), [false, false]);
    check(ARM, [false, false]);
}

/// A mass that grows has a force −ṁ q̇, unless another one cancels it.
#[test]
fn a_mass_matrix_of_the_time_is_not_constant() {
    plane("m*(1 + t)/2*(x_dot^2 + y_dot^2)", "", [false, false]);
    plane("m*(1 + t)/2*(x_dot^2 + y_dot^2)", "#[force(x: m*x_dot)] #[force(y: m*y_dot)]", [false, true]);
}

#[test]
fn a_mass_matrix_of_the_velocities_is_not_constant() {
    plane(&format!("{PARTICLE} + k*x_dot^4"), "", [false, true]);
    plane("-m*k^2*sqrt(1 - (x_dot^2 + y_dot^2)/k^2)", "", [false, true]);
}

#[test]
fn damping_depends_on_the_velocities() {
    for damping in [
        "#[force(x: -k*x_dot)]",
        "#[dissipation(k/2*(x_dot^2 + y_dot^2))]",
        "#[dissipation(k*abs(x_dot))]",
        "#[force(y: -k*max(y_dot, 0))]",
        "#[power(-k*x*y_dot, x_dot)]",
        "#[function(f(s))] #[force(x: f(x_dot))]",
    ] {
        plane(PARTICLE, damping, [true, false]);
    }
}

#[test]
fn forces_by_position_and_time_are_free_of_velocities() {
    for force in [
        "#[force(x: -k*x + w*cos(w*t))]",
        "#[function(f(x, y))] #[force(x: f(x, y))]",
        "#[force(x: max(x, 0)^2)] #[force(y: abs(x)*atan2(y, x))]",
        "#[power(-k*x, x_dot + y_dot)]",
        "#[force(x: (x_dot + k)^2 - x_dot^2 - 2*k*x_dot)]",
    ] {
        plane(PARTICLE, force, [true, true]);
    }
}

/// A magnetic field is the curl of the coefficients of the velocities.
#[test]
fn a_magnetic_field_depends_on_the_velocities_unless_it_is_zero() {
    for (linear, is_free) in [
        ("k*(x*y_dot - y*x_dot)", false),
        ("k*(x*y_dot + y*x_dot)", true),
        ("k*x^2*y_dot", false),
        ("k*y*x_dot*cos(x*y) + k*x*y_dot*cos(x*y)", true),
        ("der(k*sin(x + y^2))", true),
        ("k*(x_dot + 2*y*y_dot)*exp(x + y^2)", true),
        ("der(f(x, y))", true),
        ("k*t*x_dot", true),
        ("k*cos(w*t)*(x*y_dot + y*x_dot)", true),
        ("f(x, y)*x_dot", false),
    ] {
        plane(&format!("{PARTICLE} + {linear}"), "#[function(f(x, y))]", [true, is_free]);
    }
}

/// In a rotating frame M is that of the frame at rest, and the Coriolis force depends on the velocities.
#[test]
fn a_rotating_frame_adds_forces_by_the_velocities() {
    plane("m/2*((x_dot - w*y)^2 + (y_dot + w*x)^2)", "", [true, false]);
    let turning = "#[frame(table: rotate_z(w*t))] #[frame(puck in table: translate([x, y, 0]))]";
    plane("m/2*norm(velocity(puck))^2", turning, [true, false]);
    plane("kinetic(puck, m, [0, 0, 0], l*identity(3))", turning, [true, false]);
}

/// Frames that only translate add nothing to M but masses.
#[test]
fn cartesian_coordinates_of_frames_have_a_constant_mass_matrix() {
    let translated = "#[frame(base: translate([x, 0, 0]))] #[frame(body in base: translate([l, k*t, y]))]";
    for lagrangian in [
        "m/2*norm(velocity(body))^2 - m*w*position(body)[2]",
        "kinetic(body, m, [l, 0, 0], identity(3)) - m*w*position(body)[2]",
        "kinetic(base, k, [0, 0, l], identity(3)) + kinetic(body, m, [l, 0, 0], identity(3)) - k*dot(position(body), position(body))",
    ] {
        plane(lagrangian, translated, [true, true]);
    }
    // A cylinder that turns about its own axis while it translates.
    let turned = "#[frame(body: translate([0, y, 0]), rotate_z(x))]";
    plane("kinetic(body, m, [0, 0, l], k*identity(3)) - m*w*position(body)[1]", turned, [true, true]);
    // Its centre is off the axis.
    plane("kinetic(body, m, [l, 0, 0], k*identity(3)) - m*w*position(body)[1]", turned, [false, false]);
}

#[test]
fn kinds_of_constraints_decide() {
    use Marker::{HolonomicConstraints, Unconstrained};
    let constraints = |source: &str| {
        let emitted = emitted(source);
        [HolonomicConstraints, Unconstrained].map(|marker| emitted.contains(&marker))
    };
    assert_eq!(constraints(systems::PENDULUM), [true, true]);
    assert_eq!(constraints(&systems::rods(2)), [true, false]);
    assert_eq!(constraints(systems::TOP), [true, false]);
    // This velocity constraint is integrable, but its integral is not what the simulation enforces.
    assert_eq!(constraints(systems::SPHERE), [false, false]);
    // The unit quaternion adds a constraint.
    let body = "#[coordinates(q: [4])]
        #[frame(body: rotate(q))]
        #[lagrangian(kinetic(body, m, [0, 0, 0], [[a, 0, 0], [0, a, 0], [0, 0, b]]))]
        struct Body { m: f64, a: f64, b: f64 }";
    assert_eq!(constraints(body), [true, false]);
    let both = systems::SPHERE.replace("struct", "#[constraint(stop: phi = 1 + x^2)] struct");
    assert_eq!(constraints(&both), [false, false]);
}

/// Constraints do not count in M and h.
#[test]
fn constrained_particles_have_a_constant_mass_matrix() {
    check(&systems::rods(3), [true, true]);
    check(systems::SPHERE, [true, true]);
    check(systems::TOP, [false, false]);
}

/// An error in one attribute must not cause another where a method asks for a marker.
#[test]
fn a_stub_has_all_markers() {
    for source in [systems::SPHERE, &systems::chain(3)] {
        let stub = stub(&declaration(source).0, Vec::new()).to_string();
        assert_eq!(implemented(&stub), Marker::ALL);
    }
}
