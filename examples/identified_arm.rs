//! An arm of three joints that swings under known torques: what its links weigh, from noisy measurements of how it moves.
//!
//! Thirty numbers describe three rigid links; fifteen combinations of them can be found from motions. They are fitted to a
//! motion whose accelerations are measured with noise, and predict the torques of another motion.

mod picture;

use lagrange_core::linearized::{BaseParameters, Regressor};
use lagrange_core::nalgebra::{DMatrix, DVector, Matrix3, SVector, Vector3};
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

/// A link without the joint: in its frame, about its centre.
#[derive(Clone, Copy)]
struct Body {
    m: f64,
    centre: Vector3<f64>,
    inertia: Matrix3<f64>,
}

/// A shoulder that turns about the vertical and lifts, and an elbow.
#[derive(Clone, Lagrangian)]
#[coordinates(q: [3])]
#[frame(link[0]: rotate_z(q[0]))]
#[frame(link[1] in link[0]: rotate_x(pi/2), rotate_z(q[1]))]
#[frame(link[2] in link[1]: translate([0.5, 0, 0]), rotate_z(q[2]))]
#[parameter(body: [3] {m, centre: [3], inertia: symmetric})]
#[lagrangian(sum(i in 0..3,
    kinetic(link[i], body[i].m, body[i].centre, body[i].inertia) - body[i].m*g*position(link[i], body[i].centre)[2]
))]
#[define(phase = [1.1*t, 1.7*t + 1, 2.3*t + 2])]
#[force(q[i in 0..3]: strength[i]*(sin(phase[i]) + cos(3*phase[i])/2) - stiffness*q[i])]
struct Arm {
    body: [Body; 3],
    g: f64,
    /// Of the torques that excite the arm.
    strength: [f64; 3],
    /// Of a controller that holds it near the middle.
    stiffness: f64,
}

const LINKS: [&str; 3] = ["body[0]", "body[1]", "body[2]"];
/// Standard error of a measured torque, in N m.
const NOISE: f64 = 0.5;

fn main() -> Result<()> {
    let arm = Arm::new([2.0, 12.0, 3.0]);
    let learnt = measured(&arm, 20.0, 400, 1)?;
    let regressors: Vec<Regressor<f64>> = learnt.iter().map(|(_, regressor, _)| regressor.clone()).collect();
    let base = BaseParameters::of(&regressors)?;
    let (found, errors) = fit(&base, &learnt);
    let exact = &base.combinations * arm.inertial_parameters(&LINKS)?;
    println!("{:>8} {:>9} {:>8}   what it is, in kg, kg m and kg m²", "found", "error", "exact");
    let lines = base.to_string();
    for (j, line) in lines.lines().enumerate() {
        println!("{:8.4} ±{:7.4} {:8.4}   {line}", found[j], errors[j], exact[j]);
    }
    let other = measured(&Arm::new([3.0, 9.0, 4.0]), 8.0, 200, 2)?;
    let file = picture::path("identified_arm")?;
    draw(&base, &other, &found, (&exact, &errors), &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

impl Arm {
    fn new(strength: [f64; 3]) -> Self {
        let body = |m: f64, centre: [f64; 3], inertia: [f64; 3]| Body {
            m,
            centre: centre.into(),
            inertia: Matrix3::from_diagonal(&inertia.into()),
        };
        Self {
            body: [
                body(4.0, [0.0, 0.02, -0.1], [0.03, 0.03, 0.02]),
                body(3.0, [0.22, 0.01, 0.03], [0.01, 0.08, 0.08]),
                body(1.5, [0.18, -0.02, 0.01], [0.004, 0.03, 0.03]),
            ],
            g: 9.81,
            strength,
            stiffness: 6.0,
        }
    }
}

/// Time, regressor, and the torques of the motors with noise.
type Measurement = (f64, Regressor<f64>, SVector<f64, 3>);

/// Measurements along a motion from rest.
fn measured(arm: &Arm, end: f64, count: usize, seed: u64) -> Result<Vec<Measurement>> {
    let path = arm.integrate(State::at_rest([0.0; 3]), end, Dop853::default())?;
    let unloaded = Arm { strength: [0.0; 3], stiffness: 0.0, ..arm.clone() };
    let mut noise = Noise(seed);
    let measure = |sample: lagrange_core::Sample<&Arm>| {
        let (state, moved) = (*sample.state(), sample.solution()?.accelerations);
        let torques = unloaded.inverse_dynamics(&state, &moved, &SVector::zeros());
        let regressor = unloaded.regressor(&state, &moved, &LINKS)?;
        Ok((state.t, regressor, torques + SVector::from_fn(|_, _| NOISE * noise.normal())))
    };
    path.samples(count).map(measure).collect()
}

/// Base parameters by least squares, and their standard errors.
fn fit(base: &BaseParameters<f64>, measured: &[Measurement]) -> (DVector<f64>, DVector<f64>) {
    let rows: Vec<_> = measured.iter().map(|(_, regressor, _)| base.columns(regressor)).collect();
    let stacked = DMatrix::from_fn(3 * rows.len(), base.count(), |i, j| rows[i / 3][(i % 3, j)]);
    let torques = DVector::from_fn(3 * rows.len(), |i, _| measured[i / 3].2[i % 3]);
    let inverse = (stacked.transpose() * &stacked).try_inverse().expect("independent columns");
    (&inverse * stacked.tr_mul(&torques), inverse.diagonal().map(|x| NOISE * x.sqrt()))
}

/// Sums of twelve numbers between −½ and ½.
struct Noise(u64);

impl Noise {
    fn normal(&mut self) -> f64 {
        let mut uniform = || {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        (0..12).map(|_| uniform()).sum()
    }
}

fn draw(
    base: &BaseParameters<f64>,
    other: &[Measurement],
    found: &DVector<f64>,
    (exact, errors): (&DVector<f64>, &DVector<f64>),
    file: &std::path::Path,
) -> Result<()> {
    let root = picture::sheet(file, (1100, 480))?;
    let panels = root.split_evenly((1, 2));
    let mut chart = Panel::new("Torques of another motion", ["t in s", "torque in N m"]);
    let dots: Points = other.iter().flat_map(|(t, _, torque)| (0..3).map(|i| (*t, torque[i]))).collect();
    let curves = [0, 1, 2].map(|i| -> Points {
        other.iter().map(|(t, regressor, _)| (*t, (base.columns(regressor) * found)[i])).collect()
    });
    for (curve, (name, color)) in
        curves.iter().zip([("turn, predicted", BLACK), ("lift, predicted", RED), ("elbow, predicted", BLUE)])
    {
        chart.curve(name, color, curve);
    }
    chart.dots("measured", GREY, &dots);
    chart.draw(&panels[0])?;
    let mut chart = Panel::new("Found less exact, in standard errors", ["base parameter", "standard errors"]);
    let off: Points =
        (0..base.count()).map(|j| (j as f64 + 1.0, (found[j] - exact[j]) / errors[j])).collect();
    for level in [-3.0, 3.0] {
        chart.line([(0.0, level), (base.count() as f64 + 1.0, level)], GREY.stroke_width(1));
    }
    chart.dots("one fit", RED, &off);
    chart.draw(&panels[1])?;
    root.present()?;
    Ok(())
}
