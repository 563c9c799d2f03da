//! Andrews' squeezing mechanism: seven bodies, seven angles, six constraints of three closed loops (W. Schiehlen, *Multibody
//! Systems Handbook*, 1990; problem "andrews" of the Test Set for Initial Value Problem Solvers; A03 of the IFToMM benchmark).
//!
//! The reference values were recomputed by quadrature with 40 digits: one degree of freedom is left, β is monotone, and the loops
//! close in closed form. The values published with the test set agree with them to 10 digits in the angles, 7 in the velocities and
//! 6 in the multipliers.

use lagrange_core::prelude::*;

use crate::reference::{BAR, IS_LONG, Problem, assert_relative, table};

/// Bodies are numbered from 0. The constant torque of the motor on β is a term of the potential.
#[derive(Lagrangian)]
#[coordinates(beta, theta, gamma, phi, delta, omega, epsilon)]
#[define(centre = [
    [ra*cos(beta), ra*sin(beta)],
    [rr*cos(beta) - da*cos(beta + theta), rr*sin(beta) - da*sin(beta + theta)],
    [xb + sa*sin(gamma) + sb*cos(gamma), yb - sa*cos(gamma) + sb*sin(gamma)],
    [xa + zt*cos(delta) + (e - ea)*sin(phi + delta), ya + zt*sin(delta) - (e - ea)*cos(phi + delta)],
    [xa + ta*cos(delta) - tb*sin(delta), ya + ta*sin(delta) + tb*cos(delta)],
    [xa + u*sin(epsilon) + (zf - fa)*cos(omega + epsilon), ya - u*cos(epsilon) + (zf - fa)*sin(omega + epsilon)],
    [xa + ua*sin(epsilon) - ub*cos(epsilon), ya - ua*cos(epsilon) - ub*sin(epsilon)]])]
#[define(rate = [beta_dot, beta_dot + theta_dot, gamma_dot, phi_dot + delta_dot, delta_dot,
    omega_dot + epsilon_dot, epsilon_dot])]
#[define(hook = [sd*cos(gamma) + sc*sin(gamma) + xb, sd*sin(gamma) - sc*cos(gamma) + yb])]
#[define(spring = norm(hook - [xc, yc]))]
#[lagrangian(sum(i in 0..7, m[i]/2*dot(der(centre[i]), der(centre[i])) + inertia[i]/2*rate[i]^2)
    - c0/2*(spring - l0)^2 + motor*beta)]
#[define(crank = [rr*cos(beta) - d*cos(beta + theta), rr*sin(beta) - d*sin(beta + theta)])]
#[constraint(third: crank = [ss*sin(gamma) + xb, yb - ss*cos(gamma)])]
#[constraint(fifth: crank = [e*sin(phi + delta) + zt*cos(delta) + xa, zt*sin(delta) - e*cos(phi + delta) + ya])]
#[constraint(seventh: crank = [zf*cos(omega + epsilon) + u*sin(epsilon) + xa,
    zf*sin(omega + epsilon) - u*cos(epsilon) + ya])]
pub(crate) struct Squeezer {
    m: [f64; 7],
    inertia: [f64; 7],
    xa: f64,
    ya: f64,
    xb: f64,
    yb: f64,
    xc: f64,
    yc: f64,
    c0: f64,
    l0: f64,
    motor: f64,
    d: f64,
    da: f64,
    e: f64,
    ea: f64,
    rr: f64,
    ra: f64,
    ss: f64,
    sa: f64,
    sb: f64,
    sc: f64,
    sd: f64,
    ta: f64,
    tb: f64,
    u: f64,
    ua: f64,
    ub: f64,
    zf: f64,
    zt: f64,
    fa: f64,
}

const SQUEEZER: Squeezer = Squeezer {
    m: [0.043_25, 0.003_65, 0.023_73, 0.007_06, 0.070_5, 0.007_06, 0.054_98],
    inertia: [2.194e-6, 4.41e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5],
    xa: -0.069_34,
    ya: -0.002_27,
    xb: -0.036_35,
    yb: 0.032_73,
    xc: 0.014,
    yc: 0.072,
    c0: 4530.0,
    l0: 0.077_85,
    motor: 0.033,
    d: 0.028,
    da: 0.011_5,
    e: 0.02,
    ea: 0.014_21,
    rr: 0.007,
    ra: 0.000_92,
    ss: 0.035,
    sa: 0.018_74,
    sb: 0.010_43,
    sc: 0.018,
    sd: 0.02,
    ta: 0.023_08,
    tb: 0.009_16,
    u: 0.04,
    ua: 0.012_28,
    ub: 0.004_49,
    zf: 0.02,
    zt: 0.04,
    fa: 0.014_21,
};

/// T + V without the motor's share −motor·β at β = 0.
const ENERGY: f64 = 1.437_832_957_532_139_8;

pub(crate) fn squeezer() -> Problem<Squeezer, 7, 6> {
    Problem { name: "Andrews' squeezer", system: SQUEEZER, known: table!("andrews") }
}

/// At rest, where the constraints hold to 10⁻³¹.
fn start() -> State<f64, 7> {
    State::at_rest(squeezer().known[0].q)
}

#[test]
fn the_squeezer_starts_with_the_published_accelerations_and_forces() {
    let start = start();
    let solution = SQUEEZER.solve(&start).unwrap();
    let expected = [14_222.443_919_954_114, -10_666.832_939_965_585];
    assert_relative("β̈", solution.accelerations[0], expected[0], 1e-12);
    assert_relative("θ̈", solution.accelerations[1], expected[1], 1e-12);
    // The other bodies stand still for a moment.
    assert!(solution.accelerations.fixed_rows::<5>(2).amax() < 1e-9);
    assert_relative("λ₁", solution.multipliers[0], -98.566_870_396_241_09, 1e-12);
    assert_relative("λ₂", solution.multipliers[1], 6.122_688_344_255_662, 1e-12);
    assert!(solution.multipliers.fixed_rows::<4>(2).amax() < 1e-11);
    assert_relative("energy", SQUEEZER.energy(&start), ENERGY, 1e-14);
}

#[test]
fn the_squeezer_reaches_its_reference() {
    let squeezer = squeezer();
    squeezer.check(&[BAR, BAR, BAR]);
    if IS_LONG {
        squeezer.row("Radau 1e-12", Radau::with_tolerance(1e-12)).reaches(BAR);
        squeezer.row("Lobatto 4 1e-5 s", Lobatto::<4>::with_step(1e-5)).reaches(BAR);
        squeezer.row("RungeKutta4 1e-7 s", RungeKutta4::with_step(1e-7).max_steps(1_000_000)).reaches(BAR);
    }
}

/// The published values are wrong beyond the 10th, 7th and 6th digit: a run that agreed with them would be less accurate.
#[test]
fn the_published_values_have_fewer_digits_than_are_printed() {
    let published = Problem { name: "the same, published", known: table!("andrews_published"), ..squeezer() };
    let errors = published.row("Taylor 2⁻⁵²", Taylor::default()).errors;
    for (error, (least, most)) in errors.into_iter().zip([(1e-11, 1e-9), (1e-11, 1e-7), (1e-8, 1e-5)]) {
        assert!(least < error && error < most, "{error:e}");
    }
}

/// To t = 0.05, as the IFToMM benchmark has it; and the two pairs of bodies between the spring's lever and the fixed point mirror
/// each other: ω = −φ at all times.
#[test]
fn the_squeezer_keeps_its_energy_and_symmetry() {
    let path = SQUEEZER.integrate(start(), 0.05, Taylor::default()).unwrap();
    let largest = |quantity: fn(&State<f64, 7>) -> f64| {
        path.samples(501).map(|sample| quantity(sample.state()).abs()).fold(0.0, f64::max)
    };
    let energy = largest(|state| SQUEEZER.energy(state) - ENERGY);
    let [angles, rates] =
        [largest(|state| state.q[5] + state.q[3]), largest(|state| state.v[5] + state.v[3])];
    println!("energy {energy:e}, ω + φ {angles:e}, its rate {rates:e}");
    assert!(energy < 1e-12 && angles < 1e-12 && rates < 1e-9, "{energy:e} {angles:e} {rates:e}");
}
