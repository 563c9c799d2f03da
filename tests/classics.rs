//! Textbook systems against closed forms, and against motions recomputed by a Taylor method in 113 and 170 bits.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

use std::f64::consts::{FRAC_PI_2, TAU};

use approx::{assert_abs_diff_eq, assert_relative_eq};
use lagrange_core::{nalgebra::Const, prelude::*};

/// The states of a motion at given times are these, to `epsilon`.
fn compare<L, const N: usize>(
    system: &L,
    start: State<f64, N>,
    reference: &[(f64, [f64; N], [f64; N])],
    epsilon: f64,
) where
    L: Lagrangian<N = Const<N>, Scalar = f64>,
{
    let end = reference[reference.len() - 1].0;
    let path = system.integrate(start, end, Dop853::with_tolerance(1e-14)).unwrap();
    for (t, q, v) in reference {
        let sample = path.at(*t).unwrap();
        for i in 0..N {
            assert_abs_diff_eq!(sample.state().q[i], q[i], epsilon = epsilon);
            assert_abs_diff_eq!(sample.state().v[i], v[i], epsilon = epsilon);
        }
    }
}

/// Two bobs on rods in a plane, the angles from the vertical.
#[derive(Lagrangian)]
#[coordinates(a, b)]
#[lagrangian((m[0] + m[1])/2*l[0]^2*a_dot^2 + m[1]/2*l[1]^2*b_dot^2 + m[1]*l[0]*l[1]*a_dot*b_dot*cos(a - b)
    + (m[0] + m[1])*g*l[0]*cos(a) + m[1]*g*l[1]*cos(b))]
struct DoublePendulum {
    m: [f64; 2],
    l: [f64; 2],
    g: f64,
}

const DOUBLE: DoublePendulum = DoublePendulum { m: [1.0, 1.0], l: [1.0, 1.0], g: 9.81 };

/// The same in Cartesian coordinates. λ is half of the tension over the length: Φ is not halved here.
#[derive(Lagrangian)]
#[coordinates(r: [2], s: [2])]
#[lagrangian(m[0]/2*dot(r_dot, r_dot) + m[1]/2*dot(s_dot, s_dot) - m[0]*g*r[1] - m[1]*g*s[1])]
#[constraint(upper: dot(r, r) = l[0]^2)]
#[constraint(lower: dot(s - r, s - r) = l[1]^2)]
struct TwoBobs {
    m: [f64; 2],
    l: [f64; 2],
    g: f64,
}

/// A perturbation of the start grows by 143 until t = 10.
#[test]
fn double_pendulum_from_the_horizontal() {
    let reference = [
        (
            1.0,
            [-0.625_087_699_806_390_6, -1.034_585_085_680_012_3],
            [-3.922_279_572_887_977, -1.303_099_248_696_331],
        ),
        (
            10.0,
            [-0.568_474_664_015_950_2, -0.526_393_727_932_404_7],
            [6.078_384_885_761_965, -9.681_360_681_708_88],
        ),
    ];
    compare(&DOUBLE, State::at_rest([FRAC_PI_2, FRAC_PI_2]), &reference, 1e-10);
}

#[test]
fn double_pendulum_swinging_mildly() {
    let reference = [
        (
            1.0,
            [-0.035_279_954_660_697_96, -0.254_824_827_543_254_6],
            [1.777_825_196_998_367_6, -3.043_351_243_762_965],
        ),
        (
            10.0,
            [-0.107_542_332_622_360_97, 0.387_937_148_385_276_4],
            [1.800_047_274_824_571_6, -1.734_236_997_102_352],
        ),
    ];
    compare(&DOUBLE, State::at_rest([0.5, -0.3]), &reference, 1e-11);
}

#[test]
fn double_pendulum_with_multipliers() {
    let bobs = TwoBobs { m: [1.0, 1.0], l: [1.0, 1.0], g: 9.81 };
    let start = State::at_rest([1.0, 0.0, 2.0, 0.0]);
    let path = bobs.integrate(start, 10.0, Dop853::with_tolerance(1e-14)).unwrap();
    let end = path.end();
    let expected = [
        -0.538_347_239_612_226_4,
        -0.842_723_115_620_959,
        -1.040_765_783_246_170_5,
        -1.707_347_662_469_327_6,
    ];
    for (q, expected) in end.state().q.iter().zip(expected) {
        assert_abs_diff_eq!(*q, expected, epsilon = 1e-10);
    }
    assert_abs_diff_eq!(end.multiplier("upper").unwrap(), -91.874_165_954_158_46, epsilon = 1e-8);
    assert_abs_diff_eq!(end.multiplier("lower").unwrap(), -69.328_602_328_745_26, epsilon = 1e-8);
}

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - (x^2 + y^2)/2 - x^2*y + y^3/3)]
struct HenonHeiles;

/// A regular orbit.
#[test]
fn henon_heiles() {
    let reference = [
        (
            10.0,
            [-0.193_267_618_716_460_4, -0.094_652_061_864_295_68],
            [-0.319_097_902_378_887_5, -0.082_789_545_732_032_39],
        ),
        (
            100.0,
            [-0.323_724_224_978_209_76, -0.225_657_616_590_660_48],
            [0.172_222_885_324_254_46, 0.052_345_010_029_249_28],
        ),
    ];
    compare(&HenonHeiles, State::new([0.1, -0.05], [0.35, 0.12]), &reference, 1e-11);
}

#[derive(Lagrangian)]
#[coordinates(r: [2])]
#[lagrangian(dot(r_dot, r_dot)/2 + k/norm(r))]
struct Kepler {
    k: f64,
}

/// With the eccentricity 0.6 and the period 2π.
#[test]
fn kepler_ellipse() {
    let reference = [
        (TAU, [0.4, 0.0], [0.0, 2.0]),
        (
            10.0,
            [-1.535_023_591_909_813_7, -0.283_668_406_499_780_86],
            [0.227_150_732_077_498_34, -0.479_187_758_203_219_5],
        ),
    ];
    compare(&Kepler { k: 1.0 }, State::new([0.4, 0.0], [0.0, 2.0]), &reference, 1e-11);
}

/// Two weights on a string over a pulley that turns with it; both coordinates count downward.
#[derive(Lagrangian)]
#[coordinates(x, y, phi)]
#[lagrangian(m[0]/2*x_dot^2 + m[1]/2*y_dot^2 + inertia/2*phi_dot^2 + m[0]*g*x + m[1]*g*y)]
#[constraint(string: x + y = 0)]
#[constraint(pulley: x_dot = radius*phi_dot)]
struct Atwood {
    m: [f64; 2],
    inertia: f64,
    radius: f64,
    g: f64,
}

/// ẍ = (m₁ − m₂) g/(m₁ + m₂ + I/R²). λ of the string is minus the tension on the side of m₂, and λ of the pulley
/// minus the difference of the tensions.
#[test]
fn atwood_machine() {
    for (m, inertia, radius) in [([2.0, 1.0], 0.3, 0.5), ([0.4, 3.0], 1e-3, 0.1), ([1.0, 1.0], 0.2, 0.7)] {
        let machine = Atwood { m, inertia, radius, g: 9.81 };
        let solution = machine.solve(&State::at_rest([0.0; 3])).unwrap();
        let acceleration = (m[0] - m[1]) * 9.81 / (m[0] + m[1] + inertia / radius.powi(2));
        let tensions = [m[0] * (9.81 - acceleration), m[1] * (9.81 + acceleration)];
        assert_abs_diff_eq!(solution.accelerations[0], acceleration, epsilon = 1e-14);
        assert_abs_diff_eq!(solution.accelerations[1], -acceleration, epsilon = 1e-14);
        assert_abs_diff_eq!(solution.accelerations[2], acceleration / radius, epsilon = 1e-13);
        assert_abs_diff_eq!(solution.multipliers[0], -tensions[1], epsilon = 1e-13);
        assert_abs_diff_eq!(solution.multipliers[1], tensions[1] - tensions[0], epsilon = 1e-13);
    }
}

/// Without inertia of the pulley the tension is 2 m₁ m₂ g/(m₁ + m₂).
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m[0]/2*x_dot^2 + m[1]/2*y_dot^2 + m[0]*g*x + m[1]*g*y)]
#[constraint(string: x + y = 0)]
struct LightPulley {
    m: [f64; 2],
    g: f64,
}

#[test]
fn atwood_machine_with_a_light_pulley() {
    for m in [[2.0, 1.0], [0.3, 5.0]] {
        let machine = LightPulley { m, g: 9.81 };
        let path = machine.integrate(State::at_rest([0.0; 2]), 2.0, Dop853::default()).unwrap();
        let total = m[0] + m[1];
        let fallen = (m[0] - m[1]) / total * 9.81 * 2.0;
        assert_relative_eq!(path.end().coordinate("x").unwrap(), fallen, max_relative = 1e-13);
        let tension = -path.end().multiplier("string").unwrap();
        assert_relative_eq!(tension, 2.0 * m[0] * m[1] * 9.81 / total, max_relative = 1e-14);
    }
}

/// A bead on a straight wire that turns about the vertical.
#[derive(Lagrangian)]
#[coordinates(r, phi)]
#[lagrangian(m/2*(r_dot^2 + r^2*phi_dot^2))]
#[constraint(drive: phi = omega*t)]
struct BeadOnWire {
    m: f64,
    omega: f64,
}

/// r = r₀ cosh ωt, and the torque of the drive is 2 m ω r ṙ.
#[test]
fn bead_on_a_rotating_wire() {
    let bead = BeadOnWire { m: 0.3, omega: 1.7 };
    let path =
        bead.integrate(State::new([0.2, 0.0], [0.0, 1.7]), 3.0, Dop853::with_tolerance(1e-13)).unwrap();
    for sample in path.samples(31) {
        let [cosh, sinh] = [f64::cosh(1.7 * sample.time()), f64::sinh(1.7 * sample.time())];
        assert_relative_eq!(sample.coordinate("r").unwrap(), 0.2 * cosh, max_relative = 1e-11);
        let torque = 2.0 * 0.3 * 1.7 * (0.2 * cosh) * (0.2 * 1.7 * sinh);
        assert_abs_diff_eq!(sample.multiplier("drive").unwrap(), torque, epsilon = 1e-10 * (1.0 + torque));
    }
}

/// A cylinder of radius a inside a fixed one of radius R: θ is the angle of the line of centres, φ that by which the
/// cylinder has turned.
#[derive(Lagrangian)]
#[coordinates(theta, phi)]
#[define(inertia = m*a^2/2)]
#[lagrangian(m/2*(R - a)^2*theta_dot^2 + inertia/2*phi_dot^2 + m*g*(R - a)*cos(theta))]
#[constraint(no_slip: (R - a)*theta_dot = a*phi_dot)]
#[allow(non_snake_case)]
struct CylinderInCylinder {
    m: f64,
    a: f64,
    R: f64,
    g: f64,
}

/// θ̈ = −(2g/3(R − a)) sin θ exactly, so that small oscillations have ω² = 2g/3(R − a); friction is (m g/3) sin θ.
#[test]
fn cylinder_rolling_in_a_cylinder() {
    let cylinder = CylinderInCylinder { m: 0.8, a: 0.3, R: 1.1, g: 9.81 };
    let rate = 2.0 * 9.81 / (3.0 * (1.1 - 0.3));
    for theta in [-2.0, 0.4, 1.3_f64] {
        let phi_dot = (1.1 - 0.3) / 0.3 * 0.7;
        let solution = cylinder.solve(&State::new([theta, 0.0], [0.7, phi_dot])).unwrap();
        assert_relative_eq!(solution.accelerations[0], -rate * theta.sin(), max_relative = 1e-14);
        let friction = 0.8 * 9.81 / 3.0 * theta.sin();
        assert_relative_eq!(solution.multipliers[0], friction, max_relative = 1e-13);
    }
    let path = cylinder.integrate(State::at_rest([1e-4, 0.0]), 5.0, Dop853::with_tolerance(1e-13)).unwrap();
    for sample in path.samples(51) {
        let exact = 1e-4 * (rate.sqrt() * sample.time()).cos();
        // The period grows by θ²/16, which is 6·10⁻¹⁰ of it.
        assert_abs_diff_eq!(sample.coordinate("theta").unwrap(), exact, epsilon = 2e-12);
    }
}
