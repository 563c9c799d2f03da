//! Classification of constraints as integrable or nonholonomic: cases with known answers, each with the reason.

use super::equations;
use crate::mechanics::Integrability::{self, Exact, Holonomic, IntegratingFactor, Nonholonomic, Together};
use crate::mechanics::{Classification, Evidence, Kinds};

/// Classifies constraints on coordinates of mass 1, with parameters `a`, `b`, `w`.
fn kinds(coordinates: &str, constraints: &str) -> Kinds {
    let squares: Vec<String> = coordinates.split(", ").map(|name| format!("{name}_dot^2")).collect();
    let constraints: Vec<String> = constraints
        .split("; ")
        .enumerate()
        .map(|(i, constraint)| format!("#[constraint(c{i}: {constraint})]"))
        .collect();
    equations(&format!(
        "#[coordinates({coordinates})]
         #[lagrangian({})]
         #[function(f(t))]
         {}
         struct System {{ a: f64, b: f64, w: f64, f: F }}",
        squares.join(" + "),
        constraints.join("\n")
    ))
    .2
    .integrability
}

/// Checks the kind of each constraint, and the number of integrals: `count` for `of` independent velocity
/// constraints.
#[track_caller]
fn check(
    coordinates: &str,
    constraints: &str,
    expected: &[Integrability],
    (count, of): (usize, usize),
) -> Kinds {
    let kinds = kinds(coordinates, constraints);
    let found: Vec<_> = kinds.classes.iter().map(|class| class.integrability).collect();
    assert_eq!(found, expected, "{kinds:?}");
    let integrals = kinds.integrals.expect("a decision");
    assert_eq!((integrals.count, integrals.of), (count, of), "{kinds:?}");
    kinds
}

#[track_caller]
fn all_proved(kinds: &Kinds) {
    let proved = |class: &Classification| class.evidence == Evidence::Proved;
    assert!(kinds.classes.iter().all(proved), "{kinds:?}");
    assert_eq!(kinds.integrals.map(|integrals| integrals.evidence), Some(Evidence::Proved), "{kinds:?}");
}

/// Milton (8.4): Ẋ − aφ̇ is the rate of X − aφ.
#[test]
fn a_rolling_cylinder_is_integrable() {
    all_proved(&check("x, phi", "x_dot - a*phi_dot = 0", &[Exact], (1, 1)));
}

/// The cylinder rolls along x; y is unconstrained.
#[test]
fn a_cylinder_in_two_dimensions_is_integrable() {
    all_proved(&check("x, y, phi", "x_dot - a*phi_dot = 0", &[Exact], (1, 1)));
}

/// A cylinder whose axis may turn about the vertical is an upright disc: rolled around a closed path, it comes back
/// rotated. The Lie brackets [∂θ, X] and [∂θ, [∂θ, X]] reach both x and y.
#[test]
fn an_upright_rolling_disc_is_nonholonomic() {
    let rolling = "x_dot - a*phi_dot*cos(th) = 0; y_dot - a*phi_dot*sin(th) = 0";
    all_proved(&check("x, y, th, phi", rolling, &[Nonholonomic; 2], (0, 2)));
}

/// A sphere can roll from any position and orientation to any other (Milton (8.4)). The coordinates are Euler
/// angles z-x-z.
#[test]
fn a_rolling_sphere_in_angles_is_nonholonomic() {
    let rolling = "x_dot - a*(th_dot*sin(phi) - psi_dot*sin(th)*cos(phi)) = 0; \
                   y_dot + a*(th_dot*cos(phi) + psi_dot*sin(th)*sin(phi)) = 0";
    all_proved(&check("x, y, phi, th, psi", rolling, &[Nonholonomic; 2], (0, 2)));
}

/// The rolling sphere with a unit quaternion. The classification uses computed points with |q| = 1, so it is not
/// proved.
#[test]
fn a_rolling_sphere_with_a_quaternion_is_nonholonomic() {
    let omega_x = "2*(p_dot*-i + i_dot*p - j_dot*k + k_dot*j)";
    let omega_y = "2*(p_dot*-j + i_dot*k + j_dot*p - k_dot*i)";
    let constraints = format!("p^2 + i^2 + j^2 + k^2 = 1; x_dot - a*{omega_y} = 0; y_dot + a*{omega_x} = 0");
    let kinds = check("x, y, p, i, j, k", &constraints, &[Holonomic, Nonholonomic, Nonholonomic], (0, 2));
    assert_eq!(kinds.classes[1].evidence, Evidence::Held(8));
}

/// A sphere on a turntable, V = a Ω × n + w n × R: the constraint is affine, and nonholonomic as on the floor.
#[test]
fn a_sphere_on_a_turntable_is_nonholonomic() {
    let rolling = "x_dot - a*(th_dot*sin(phi) - psi_dot*sin(th)*cos(phi)) + w*y = 0; \
                   y_dot + a*(th_dot*cos(phi) + psi_dot*sin(th)*sin(phi)) - w*x = 0";
    all_proved(&check("x, y, phi, th, psi", rolling, &[Nonholonomic; 2], (0, 2)));
}

/// x ẏ − y ẋ = x² d(y/x)/dt, although the mixed partial derivatives differ.
#[test]
fn a_ray_through_the_origin_has_an_integrating_factor() {
    all_proved(&check("x, y", "x*y_dot - y*x_dot = 0", &[IntegratingFactor], (1, 1)));
}

/// In three variables few forms have an integrating factor. This one has: y z ẋ + x z ẏ + 2 x y ż = (1/z) d(x y
/// z²)/dt.
#[test]
fn a_form_in_three_variables_with_a_factor() {
    let kinds = check("x, y, z", "y*z*x_dot + x*z*y_dot + 2*x*y*z_dot = 0", &[IntegratingFactor], (1, 1));
    assert!(kinds.functions[0].is_some());
}

/// The standard contact form, ω ∧ dω = dx ∧ dy ∧ dz.
#[test]
fn a_contact_form_is_nonholonomic() {
    all_proved(&check("x, y, z", "z_dot - y*x_dot = 0", &[Nonholonomic], (0, 1)));
}

/// ω ∧ dω = −dx ∧ dy ∧ dθ.
#[test]
fn a_knife_edge_is_nonholonomic() {
    all_proved(&check("x, y, th", "x_dot*sin(th) - y_dot*cos(th) = 0", &[Nonholonomic], (0, 1)));
}

/// A knife edge at a distance from the centre of mass: the additional multiple of θ̇ makes no difference.
#[test]
fn a_chaplygin_sleigh_is_nonholonomic() {
    let edge = "y_dot*cos(th) - x_dot*sin(th) - a*th_dot = 0";
    all_proved(&check("x, y, th", edge, &[Nonholonomic], (0, 1)));
}

/// Two contact forms in three variables leave one direction at each point. A field of directions is always
/// integrable.
#[test]
fn a_pair_is_integrable_only_together() {
    all_proved(&check("x, y, z", "y_dot - z*x_dot = 0; z_dot - y*x_dot = 0", &[Together; 2], (2, 2)));
}

/// Velocity field of a rotating disc. Alone, ẋ + w y = 0 leaves y an arbitrary function of time. Both constraints
/// together are solved by rotating (x, y) back by w t.
#[test]
fn turning_with_a_disc_is_integrable_only_together() {
    check("x, y", "x_dot + w*y = 0", &[Nonholonomic], (0, 1));
    let turning = "x_dot + w*y = 0; y_dot - w*x = 0";
    all_proved(&check("x, y", turning, &[Together; 2], (2, 2)));
}

/// Two contact forms of opposite curl: their sum is d(z + u − x y), and no other combination is integrable.
#[test]
fn a_pair_with_one_integral() {
    let pair = "z_dot - y*x_dot = 0; u_dot - x*y_dot = 0";
    all_proved(&check("x, y, z, u", pair, &[Nonholonomic; 2], (1, 2)));
}

/// Two wheels on one axle (Goldstein, Poole and Safko, chapter 1, exercise 5): one integral, θ + a (φ₁ − φ₂)/b =
/// constant, and two nonholonomic equations.
#[test]
fn two_wheels_on_an_axle_have_one_integral() {
    let wheels = "x_dot*cos(th) + y_dot*sin(th) = 0; \
                  x_dot*sin(th) - y_dot*cos(th) - b/2*th_dot - a*u_dot = 0; \
                  x_dot*sin(th) - y_dot*cos(th) + b/2*th_dot - a*v_dot = 0";
    let kinds = check("x, y, th, u, v", wheels, &[Nonholonomic; 3], (1, 3));
    assert_eq!(kinds.classes[0].evidence, Evidence::Proved);
}

/// A knife edge beside a rolling cylinder: the constraint that is integrable alone stays integrable.
#[test]
fn an_exact_constraint_beside_a_nonholonomic_one() {
    let both = "x_dot*sin(th) - y_dot*cos(th) = 0; z_dot - a*phi_dot = 0";
    all_proved(&check("x, y, th, z, phi", both, &[Nonholonomic, Exact], (1, 2)));
}

/// The form dx − t y dt: its curl −t dy ∧ dt does not have the form as a factor, so a choice of y reaches any x at
/// any later time.
#[test]
fn a_rheonomic_constraint_is_nonholonomic() {
    all_proved(&check("x, y", "x_dot = t*y", &[Nonholonomic], (0, 1)));
}

/// dx − t x dt = x d(ln x − t²/2).
#[test]
fn a_rheonomic_constraint_with_a_factor() {
    let kinds = check("x, y", "x_dot = t*x", &[IntegratingFactor], (1, 1));
    all_proved(&kinds);
    assert!(kinds.functions[0].is_some());
}

/// t ẋ + x is the rate of t x; t ẋ − x is t² times the rate of x/t.
#[test]
fn rheonomic_constraints_that_differ_by_a_sign() {
    all_proved(&check("x, y", "t*x_dot + x = 0", &[Exact], (1, 1)));
    all_proved(&check("x, y", "t*x_dot - x = 0", &[IntegratingFactor], (1, 1)));
}

/// A slope that depends on time: the form is exact at each fixed t, but not with t as a variable: d(y − x sin t) =
/// dy − sin t dx − x cos t dt.
#[test]
fn integrable_at_each_time_is_not_integrable() {
    all_proved(&check("x, y", "y_dot - x_dot*sin(t) = 0", &[Nonholonomic], (0, 1)));
    check("x, y", "y_dot - x_dot*sin(t) - x*cos(t) = 0", &[Exact], (1, 1));
}

/// A prescribed speed is exact, though the integral ∫f dt has no closed form. A speed f(t) y is not.
#[test]
fn a_function_of_time() {
    let kinds = check("x, y", "x_dot = f(t)", &[Exact], (1, 1));
    all_proved(&kinds);
    assert_eq!(kinds.functions[0], None);
    let kinds = check("x, y", "x_dot = der(f(t))", &[Exact], (1, 1));
    assert!(kinds.functions[0].is_some(), "x − f(t)");
    all_proved(&check("x, y", "x_dot = f(t)*y", &[Nonholonomic], (0, 1)));
    all_proved(&check("x, y", "x_dot = f(t)*x", &[IntegratingFactor], (1, 1)));
}

/// The time derivative of any function is exact.
#[test]
fn the_rate_of_a_function_is_exact() {
    for function in ["x^2*y - a*z", "sqrt(x^2 + y^2 + z^2)", "sin(x)*exp(y)*z", "x*y*t", "(x + y)^3*z"] {
        let kinds = check("x, y, z", &format!("der({function}) = 0"), &[Exact], (1, 1));
        assert!(kinds.functions[0].is_some(), "{function}");
    }
}

/// The contact form on a surface: every form in the two variables that are left is integrable.
#[test]
fn a_form_is_integrable_only_where_the_others_hold() {
    let kinds = check("x, y, z", "z = b; x_dot - z*y_dot = 0", &[Holonomic, Exact], (1, 1));
    assert_eq!(kinds.functions[1], None, "x − b y is not the integral off the surface");
    let sphere = "x^2 + y^2 + z^2 = a^2; z_dot - y*x_dot = 0";
    check("x, y, z", sphere, &[Holonomic, IntegratingFactor], (1, 1));
    let supplied = "z = f(x); y_dot - z*x_dot = 0";
    check("x, y, z", supplied, &[Holonomic, Exact], (1, 1));
}

/// The form is closed on the sphere of radius a and on no other. Points off that sphere would give another verdict.
#[test]
fn a_form_is_integrable_on_one_surface_of_many() {
    let sphere = "x^2 + y^2 + z^2 = a^2; u_dot - (x^2 + y^2 + z^2 - a^2)*y*x_dot = 0";
    let kinds = check("x, y, z, u", sphere, &[Holonomic, Exact], (1, 1));
    assert_eq!(kinds.classes[1].evidence, Evidence::Held(8));
}

/// Two equations of one circle, dependent on it and independent elsewhere. On the circle, x and y are one variable,
/// in which y dx is closed.
#[test]
fn a_surface_given_twice_counts_once() {
    let twice = "x^2 + y^2 = a^2; (2 + x)*(x^2 + y^2 - a^2) = 0; z_dot - y*x_dot = 0";
    check("x, y, z", twice, &[Holonomic, Holonomic, Exact], (1, 1));
}

/// A moving surface makes no form integrable: the Lie brackets with ∂/∂t remain.
#[test]
fn a_moving_surface_makes_nothing_integrable() {
    check("x, y, z", "z = b*t; x_dot - z*y_dot = 0", &[Holonomic, Nonholonomic], (0, 1));
}

/// A velocity constraint that the holonomic one implies, and one that is the sum of the others. Each constraint has
/// a parameter as a factor: if that is 0, the others are needed.
#[test]
fn dependent_constraints_are_not_counted() {
    let implied = "w*(x^2 + y^2 - a^2) = 0; b*(x*x_dot + y*y_dot) = 0";
    check("x, y", implied, &[Holonomic, Exact], (0, 0));
    let sum = "a*(z_dot - y*x_dot) = 0; b*(u_dot - a*w*x_dot) = 0; \
               w*(z_dot + u_dot - (y + a*w)*x_dot) = 0";
    check("x, y, z, u", sum, &[Nonholonomic, Exact, Nonholonomic], (1, 2));
}

/// No motion satisfies all three constraints, unless a factor is 0, so the set gets no verdict.
#[test]
fn contradictory_constraints_are_not_decided() {
    let kinds = kinds("x, y", "b*(x_dot - y_dot) = 0; w*y_dot = 0; a*x_dot = 1");
    assert_eq!(kinds.integrals, None);
}

/// A constraint on a surface without real points.
#[test]
fn without_points_there_is_no_verdict() {
    let kinds = kinds("x, y, z", "x^2 + y^2 + a = 0; z_dot - y*x_dot = 0");
    assert_eq!(kinds.classes[1].integrability, Integrability::Undecided);
    assert_eq!(kinds.integrals, None);
}

/// A car with two trailers, headings r, s and u: each Lie bracket reaches one more direction (Laumond,
/// "Controllability of a multibody mobile robot", 1993), so three nested ones are needed.
#[test]
fn a_car_with_trailers_needs_deep_brackets() {
    let trailers = "x_dot*sin(r) - y_dot*cos(r) = 0; \
                    x_dot*sin(s) - y_dot*cos(s) + a*s_dot = 0; \
                    x_dot*sin(u) - y_dot*cos(u) + a*s_dot*cos(s - u) + b*u_dot = 0";
    check("x, y, r, s, u", trailers, &[Nonholonomic; 3], (0, 3));
}

/// Holonomic constraints contain no velocities, so there is nothing to integrate.
#[test]
fn holonomic_constraints_are_holonomic() {
    all_proved(&check("x, y", "x^2 + y^2 = a^2; x = f(t)", &[Holonomic; 2], (0, 0)));
}
