//! Inertial parameters of a robot.

use lagrange_core::linearized::{BaseParameters, Regressor};
use lagrange_core::nalgebra::{DMatrix, DVector, SVector};
use lagrange_core::prelude::*;
use lagrange_random::Random;

use crate::regressor::{Body, body, forces_are_those_of_the_regressor, somewhere};

/// A PUMA 560 by the convention of Denavit and Hartenberg, with the lengths of B. Armstrong, O. Khatib and J. Burdick, "The
/// explicit dynamic model and inertial parameters of the PUMA 560 arm", ICRA 1986. Its first axis is vertical.
#[derive(Clone, Lagrangian)]
#[coordinates(q: [6])]
#[define(a = [0, 0.4318, 0.0203, 0, 0, 0])]
#[define(d = [0, 0.2435, -0.0934, 0.4331, 0, 0])]
#[define(alpha = [pi/2, 0, -pi/2, pi/2, -pi/2, 0])]
#[frame(link[0]: rotate_z(q[0]), translate([a[0], 0, d[0]]), rotate_x(alpha[0]))]
#[frame(link[i in 1..6] in link[i-1]: rotate_z(q[i]), translate([a[i], 0, d[i]]), rotate_x(alpha[i]))]
#[parameter(body: [6] {m, centre: [3], inertia: symmetric})]
#[lagrangian(sum(i in 0..6,
    kinetic(link[i], body[i].m, body[i].centre, body[i].inertia) - body[i].m*g*position(link[i], body[i].centre)[2]
))]
#[dissipation(c/2*sum(i in 0..6, q_dot[i]^2))]
#[force(q: torque)]
struct Puma {
    body: [Body; 6],
    g: f64,
    c: f64,
    torque: SVector<f64, 6>,
}

const LINKS: [&str; 6] = ["body[0]", "body[1]", "body[2]", "body[3]", "body[4]", "body[5]"];

fn puma(random: &mut Random) -> Puma {
    let bodies = [0; 6].map(|_| body(random));
    Puma { body: bodies, g: 9.81, c: 0.3, torque: random.vector::<6>().into() }
}

#[test]
fn forces_of_a_puma_are_those_of_the_regressor() {
    let mut random = Random(1);
    for _ in 0..200 {
        let puma = puma(&mut random);
        forces_are_those_of_the_regressor(&puma, &LINKS, &mut random, |state| puma.c * state.v - puma.torque);
    }
}

/// The number of independent columns by singular values.
fn rank(regressors: &[Regressor<f64>]) -> usize {
    let rows: Vec<_> = regressors
        .iter()
        .flat_map(|regressor| {
            let matrix = regressor.along_free().0;
            (0..matrix.nrows()).map(move |i| matrix.row(i).into_owned()).collect::<Vec<_>>()
        })
        .collect();
    DMatrix::from_rows(&rows).svd(false, false).rank(1e-9)
}

/// The published number, 36: M. Gautier, "Numerical calculation of the base inertial parameters of robots", *Journal of Robotic
/// Systems* 8, 1991; H. Mayeda, K. Yoshida and K. Osuka, "Base parameters of manipulator dynamic models", *IEEE Transactions on Robotics
/// and Automation* 6, 1990.
#[test]
fn a_puma_has_36_base_parameters() {
    let mut random = Random(1);
    let arm = puma(&mut random);
    let regressors: Vec<_> = (0..40)
        .map(|_| {
            let (state, accelerations) = somewhere(&mut random);
            arm.regressor(&state, &accelerations, &LINKS).unwrap()
        })
        .collect();
    let base = BaseParameters::of(&regressors).unwrap();
    // Masses are regrouped by lengths.
    assert!(base.combinations.amax() < 2.1, "{base}");
    assert_eq!((base.count(), rank(&regressors)), (36, 36));
    // The combinations give the same forces, elsewhere too.
    for _ in 0..100 {
        let arm = puma(&mut random);
        let (state, accelerations) = somewhere(&mut random);
        let regressor = arm.regressor(&state, &accelerations, &LINKS).unwrap();
        let beta = &base.combinations * arm.inertial_parameters(&LINKS).unwrap();
        let found = base.columns(&regressor) * beta + &regressor.offset;
        let exact = arm.inverse_dynamics(&state, &accelerations, &SVector::zeros());
        assert!((found - DVector::from_column_slice(exact.as_slice())).amax() < 1e-12 * exact.amax());
    }
}

/// Base parameters are found from torques with noise. In 100 runs each is within three of its standard errors in 95 or more, and
/// within one in 50 to 85.
#[test]
fn parameters_are_identified_within_their_errors() {
    let mut random = Random(7);
    let arm = puma(&mut random);
    // Torques of the motors at 60 states, less those of damping, which is known.
    let (regressors, torques): (Vec<_>, Vec<_>) = (0..60)
        .map(|_| {
            let (state, accelerations) = somewhere::<6>(&mut random);
            let unloaded = Puma { torque: SVector::zeros(), c: 0.0, ..arm.clone() };
            let regressor = unloaded.regressor(&state, &accelerations, &LINKS).unwrap();
            (regressor, unloaded.inverse_dynamics(&state, &accelerations, &SVector::zeros()))
        })
        .unzip();
    let base = BaseParameters::of(&regressors).unwrap();
    let exact = &base.combinations * arm.inertial_parameters(&LINKS).unwrap();
    let rows: Vec<_> = regressors.iter().map(|regressor| base.columns(regressor)).collect();
    let stacked = DMatrix::from_fn(6 * rows.len(), base.count(), |i, j| rows[i / 6][(i % 6, j)]);
    let inverse = (stacked.transpose() * &stacked).try_inverse().unwrap();
    let (noise, mut within) = (0.5, vec![[0, 0]; base.count()]);
    for _ in 0..100 {
        let measured = DVector::from_fn(6 * rows.len(), |i, _| {
            let normal: f64 = (0..12).map(|_| random.between(-0.5, 0.5)).sum();
            torques[i / 6][i % 6] + noise * normal
        });
        let found = &inverse * stacked.tr_mul(&measured);
        for (j, within) in within.iter_mut().enumerate() {
            let off = (found[j] - exact[j]).abs() / (noise * inverse[(j, j)].sqrt());
            within[0] += usize::from(off < 3.0);
            within[1] += usize::from(off < 1.0);
        }
    }
    assert!(within.iter().all(|[three, one]| *three >= 95 && (50..=85).contains(one)), "{within:?}");
}

/// Joints that hardly move do not say whether some parameter matters.
#[test]
fn states_that_hardly_differ_do_not_decide() {
    let mut random = Random(1);
    let arm = puma(&mut random);
    let regressors: Vec<_> = (0..40)
        .map(|_| {
            let (state, _) = somewhere::<6>(&mut random);
            let resting = State { q: state.q * 1e-6, v: SVector::zeros(), ..state };
            arm.regressor(&resting, &SVector::zeros(), &LINKS).unwrap()
        })
        .collect();
    let error = BaseParameters::of(&regressors).map(|base| base.count()).unwrap_err().to_string();
    assert!(error.contains("it is not decided whether"), "{error}");
}
