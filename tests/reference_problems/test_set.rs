//! Car axis, slider crank and pendulum of the Test Set for Initial Value Problem Solvers (F. Mazzia and C. Magherini); the pendulum
//! is A01 of the IFToMM benchmark too.
//!
//! The reference values were recomputed by another Taylor method with 113 and 170 bits, which agree in all digits here; those of the
//! pendulum by elliptic functions as well.

use lagrange_core::motion::Composition::KahanLi8;
use lagrange_core::prelude::*;

use crate::noninertial::{KAPITZA, Kapitza};
use crate::reference::{BAR, IS_LONG, Problem, assert_relative, table};

/// Two wheels of a car axis on a bumpy road: the left one on a cylinder of given height, both at a given distance.
#[derive(Lagrangian)]
#[coordinates(xl, yl, xr, yr)]
#[define(yb = r*sin(w*t))]
#[define(xb = sqrt(L^2 - yb^2))]
#[define(left = norm([xl, yl]))]
#[define(right = norm([xr - xb, yr - yb]))]
#[define(k = M*eps^2/2)]
#[lagrangian(k/2*(xl_dot^2 + yl_dot^2 + xr_dot^2 + yr_dot^2) - (left - L0)^2/2 - (right - L0)^2/2 - k*g*(yl + yr))]
#[constraint(across: xl*xb + yl*yb = 0)]
#[constraint(axis: (xl - xr)^2 + (yl - yr)^2 = L^2)]
#[allow(non_snake_case)]
pub(crate) struct CarAxis {
    L: f64,
    L0: f64,
    M: f64,
    eps: f64,
    r: f64,
    w: f64,
    g: f64,
}

pub(crate) fn car_axis() -> Problem<CarAxis, 4, 2> {
    let system = CarAxis { L: 1.0, L0: 0.5, M: 10.0, eps: 0.01, r: 0.1, w: 10.0, g: 1.0 };
    Problem { name: "car axis", system, known: table!("car_axis") }
}

#[test]
fn the_car_axis_reaches_its_reference() {
    let axis = car_axis();
    axis.check(&[BAR, BAR, BAR]);
    if IS_LONG {
        axis.row("Verlet Kahan–Li 8 5e-3 s", Verlet::with_step(5e-3).composed(KahanLi8)).reaches(BAR);
        axis.row("Lobatto 4 1e-3 s", Lobatto::<4>::with_step(1e-3)).reaches(BAR);
        axis.row("Radau 1e-12", Radau::with_tolerance(1e-12)).reaches(BAR);
        axis.row("RungeKutta4 1e-5 s", RungeKutta4::with_step(1e-5).max_steps(1_000_000)).reaches(BAR);
    }
}

/// Crank, rod and slider, all rigid; the crank turns at a given rate, so that no degree of freedom is left.
#[derive(Lagrangian)]
#[coordinates(phi1, phi2, x3)]
#[lagrangian((J1 + M2*L1^2)/2*phi1_dot^2 + J2/2*phi2_dot^2 + L1*L2*M2/2*cos(phi1 - phi2)*phi1_dot*phi2_dot + M3/2*x3_dot^2)]
#[constraint(height: L1*sin(phi1) + L2*sin(phi2) = 0)]
#[constraint(slider: x3 - L1*cos(phi1) - L2*cos(phi2) = 0)]
#[constraint(drive: phi1 - Omega*t = 0)]
#[allow(non_snake_case)]
struct DrivenSliderCrank {
    L1: f64,
    L2: f64,
    M2: f64,
    M3: f64,
    J1: f64,
    J2: f64,
    Omega: f64,
}

/// Positions are kinematics, and the multipliers are the whole answer.
#[test]
fn the_driven_slider_crank_reaches_its_reference() {
    let system = DrivenSliderCrank {
        L1: 0.15,
        L2: 0.3,
        M2: 0.151_104,
        M3: 0.075_552,
        J1: 0.002_727,
        J2: 0.004_533_925_9,
        Omega: 150.0,
    };
    let crank = Problem { name: "driven slider crank", system, known: table!("slider_crank") };
    let start = State::new(crank.known[0].q, crank.known[0].v);
    let begins = crank.system.solve(&start).unwrap().multipliers;
    assert_relative("λ of the slider at the start", begins[1], -382.482, 1e-14);
    assert!(begins[0].abs() < 1e-12 && begins[2].abs() < 1e-12, "{begins}");
    crank.check(&[BAR, BAR, BAR]);
    crank.row("Lobatto 4 1e-4 s", Lobatto::<4>::with_step(1e-4)).reaches(BAR);
    if IS_LONG {
        crank.row("Radau 1e-12", Radau::with_tolerance(1e-12)).reaches(BAR);
        crank.row("RungeKutta4 1e-4 s", RungeKutta4::with_step(1e-4)).reaches(BAR);
    }
}

/// A pendulum in Cartesian coordinates, of length and mass 1: the pivot rests.
fn pendulum(name: &'static str) -> Problem<Kapitza, 2, 1> {
    Problem { name, system: Kapitza { a: 0.0, ..KAPITZA }, known: table!("pendulum") }
}

#[test]
fn the_pendulum_reaches_its_reference() {
    let pendulum = pendulum("A01 pendulum, 10 s").until(10.0);
    pendulum.check(&[BAR, BAR, BAR]);
    pendulum.row("Verlet Kahan–Li 8 0.02 s", Verlet::with_step(0.02).composed(KahanLi8)).reaches(BAR);
    if IS_LONG {
        pendulum.row("Lobatto 4 5e-3 s", Lobatto::<4>::with_step(5e-3)).reaches(BAR);
        pendulum.row("Radau 1e-12", Radau::with_tolerance(1e-12)).reaches(BAR);
        pendulum.row("RungeKutta4 1e-4 s", RungeKutta4::with_step(1e-4).max_steps(1_000_000)).reaches(BAR);
    }
}

/// A01 lasts 2000 s, 845 periods.
#[test]
fn the_pendulum_reaches_its_reference_after_many_periods() {
    let (name, end) = if IS_LONG { ("A01 pendulum, 2000 s", 2000.0) } else { ("A01 pendulum, 100 s", 100.0) };
    let pendulum = pendulum(name).until(end);
    pendulum.row("Taylor 2⁻⁵²", Taylor::default()).reaches(BAR);
    if IS_LONG {
        let _ = pendulum.row("Dop853 1e-14", Dop853::with_tolerance(1e-14).max_steps(10_000_000));
    }
}

/// Crank, flexible rod and slider (B. Simeon, "Modelling a flexible slider crank mechanism by a mixed system of DAEs and PDEs",
/// *Mathematical Modelling of Systems* 2, 1996): two modes of bending, two nodes along the rod. The stiffness is linear, and nothing is
/// damped. The test set has `p` for π, to eight digits.
#[derive(Lagrangian)]
#[coordinates(phi1, phi2, x3, q: [4])]
#[define(cosine = cos(phi1 - phi2))]
#[define(sine = sin(phi1 - phi2))]
// Integrals over the rod, times its density: of the displacements, of these times the place, and of their moments.
#[define(c1(u) = M2*(2/3*u[2] + u[3]/6))]
#[define(c2(u) = M2*2/p*u[0])]
#[define(c12(u) = M2*L2*(u[2]/3 + u[3]/6))]
#[define(c21(u) = M2*L2*(u[0] - u[1]/2)/p)]
#[define(turned = M2*(-16/p^3*(q[0]*q_dot[2] - q[2]*q_dot[0]) + (8/p^3 - 1/p)*(q[0]*q_dot[3] - q[3]*q_dot[0])
    + (q[1]*q_dot[3] - q[3]*q_dot[1])/(2*p)))]
#[define(mass(u) = M2*((u[0]^2 + u[1]^2)/2 + 8*u[2]^2 + 2*u[2]*u[3] + 2*u[3]^2))]
#[define(stiffness = E*b*h/L2*(p^4*(h/L2)^2*(q[0]^2/24 + 2/3*q[1]^2) + (16*q[2]^2 - 16*q[2]*q[3] + 7*q[3]^2)/3))]
#[lagrangian((J1 + M2*L1^2)/2*phi1_dot^2 + (J2 + mass(q) + 2*c12(q))/2*phi2_dot^2
    + (L1*L2*M2/2*cosine + L1*(sine*c2(q) + cosine*c1(q)))*phi1_dot*phi2_dot
    + L1*phi1_dot*(cosine*c2(q_dot) - sine*c1(q_dot)) + phi2_dot*(c21(q_dot) + turned)
    + M3/2*x3_dot^2 + mass(q_dot)/2 - stiffness/2)]
#[constraint(height: L1*sin(phi1) + (L2 + q[3])*sin(phi2) = 0)]
#[constraint(slider: x3 - L1*cos(phi1) - (L2 + q[3])*cos(phi2) = 0)]
#[constraint(drive: phi1 - Omega*t = 0)]
#[allow(non_snake_case)]
struct FlexibleSliderCrank {
    L1: f64,
    L2: f64,
    M2: f64,
    M3: f64,
    J1: f64,
    J2: f64,
    /// Young's modulus, and the sides of the rod's section.
    E: f64,
    b: f64,
    h: f64,
    Omega: f64,
    p: f64,
}

#[allow(clippy::approx_constant, reason = "the test set has π to eight digits")]
const FLEXIBLE: FlexibleSliderCrank = FlexibleSliderCrank {
    L1: 0.15,
    L2: 0.3,
    M2: 0.151_104,
    M3: 0.075_552,
    J1: 0.002_727,
    J2: 0.004_533_925_9,
    E: 2e11,
    b: 0.008,
    h: 0.008,
    Omega: 150.0,
    p: 3.141_592_7,
};

fn flexible(name: &'static str) -> Problem<FlexibleSliderCrank, 7, 3> {
    Problem { name, system: FLEXIBLE, known: table!("flexible_slider_crank") }
}

/// The published accelerations and multipliers at the start, to the digits that its nine digits of x₃ and φ̇₂ leave. The test set has
/// the other sign of λ.
#[test]
fn the_flexible_slider_crank_starts_as_published() {
    let start = flexible("flexible slider crank").known[0];
    let solution = FLEXIBLE.solve(&State::new(start.q, start.v)).unwrap();
    let known = [(2, -5_062.194_923_138_079), (5, -4.268_463_211_410_861), (6, 0.209_833_468_794_737_6)];
    for (index, published) in known {
        assert_relative("acceleration", solution.accelerations[index], published, 1e-6);
    }
    assert_relative("multiplier", solution.multipliers[1], -382.458_950_832_928_1, 1e-9);
}

/// The rod vibrates at some kilohertz, and x₃ holds its displacements of 10⁻⁵ m to an ulp of 0.3 m alone. A change of x₃ by half of that
/// at the start makes a difference of 10⁻⁹ in the velocities of the rod: no method can be asked for less.
#[test]
fn the_flexible_slider_crank_reaches_its_reference_to_the_rounding_of_its_start() {
    let crank = flexible("flexible slider crank");
    crank.row("Taylor 2⁻⁵²", Taylor::default()).reaches([BAR[0], 3e-9, BAR[2]]);
    let _ = crank.row("Dop853 1e-14", Dop853::with_tolerance(1e-14));
    if IS_LONG {
        let _ = crank.row("Dopri5 1e-13", Dopri5::with_tolerance(1e-13));
        let _ = crank.row("RungeKutta4 1e-7 s", RungeKutta4::with_step(1e-7).max_steps(1_100_000));
    }
    // The published values at t = 0.1 are right to 9 digits of φ₂ and x₃, and 5 of the multipliers.
    let known = table!("flexible_slider_crank_published");
    let published = Problem { known, ..flexible("the same, published") };
    let [q, v, lambda] = published.row("Taylor 2⁻⁵²", Taylor::default()).errors;
    assert!(
        1e-10 < q && q < 1e-5 && 1e-8 < v && v < 1e-2 && 1e-6 < lambda && lambda < 1e-4,
        "{q:e} {v:e} {lambda:e}"
    );
}
