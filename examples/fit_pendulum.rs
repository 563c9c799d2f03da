//! The mass, the length and the friction of a pendulum from what was seen of it: 200 angles, read with noise, while a
//! known torque drives it.
//!
//! The sum of squares of what is left is least where its derivatives vanish. With the derivatives of the motion at
//! hand, the method of Levenberg and Marquardt goes there in a few steps, δp = (JᵀJ + μD)⁻¹Jᵀr with D the diagonal of JᵀJ
//! and μ smaller the better it goes. JᵀJ also tells how well each parameter is known, σ²(JᵀJ)⁻¹.

mod picture;

use lagrange_core::nalgebra::{DVector, Matrix3, MatrixXx3, Vector3};
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};

#[derive(Clone, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(m*l^2/2 * theta_dot^2 + m*g*l*cos(theta))]
#[dissipation(c/2 * theta_dot^2)]
#[force(theta: torque*sin(2*t))]
struct Pendulum {
    m: f64,
    l: f64,
    c: f64,
    g: f64,
    torque: f64,
}

const SOUGHT: [&str; 3] = ["m", "l", "c"];
const TRUTH: [f64; 3] = [1.2, 0.8, 0.15];
const GUESS: [f64; 3] = [1.0, 0.9, 0.05];
/// The standard deviation of a reading, in radians.
const NOISE: f64 = 0.02;
const READINGS: usize = 200;
const END: f64 = 10.0;

fn main() -> Result<()> {
    let truth = readings(&pendulum(TRUTH))?;
    let mut noise = Noise(7);
    let seen = truth.0.map(|theta| theta + NOISE * noise.next());
    println!("{:>4} {:>10} {:>10} {:>10} {:>12}", "step", "m/kg", "l/m", "c/N m s", "rms left");
    let (mut sought, mut damping) = (Vector3::from(GUESS), 1e-2);
    let (mut angles, mut by) = readings(&pendulum(GUESS))?;
    for step in 0..50 {
        let left = &seen - &angles;
        println!("{step:4} {:10.6} {:10.6} {:10.6} {:12.7}", sought[0], sought[1], sought[2], rms(&left));
        let normal = by.tr_mul(&by);
        let damped = normal + Matrix3::from_diagonal(&normal.diagonal()) * damping;
        let factor = damped.cholesky().ok_or("the readings do not tell the parameters apart")?;
        let change = factor.solve(&by.tr_mul(&left));
        let next = sought + change;
        let found = readings(&pendulum(next.into()))?;
        if (&seen - &found.0).norm() <= left.norm() {
            (sought, (angles, by), damping) = (next, found, damping / 10.0);
        } else {
            damping *= 10.0;
        }
        if change.norm() < 1e-9 * sought.norm() {
            break;
        }
    }
    let (left, normal) = (&seen - angles, by.tr_mul(&by));
    let variance = left.norm_squared() / (READINGS as f64 - 3.0);
    let covariance: Matrix3<f64> = normal.try_inverse().ok_or("singular")? * variance;
    println!("\n{:>3} {:>10} {:>12} {:>10} {:>8}", "", "found", "± one σ", "true", "off by");
    for (i, name) in SOUGHT.iter().enumerate() {
        let (deviation, off) = (covariance[(i, i)].sqrt(), sought[i] - TRUTH[i]);
        println!("{name:>3} {:10.6} {deviation:12.6} {:10.6} {:6.1} σ", sought[i], TRUTH[i], off / deviation);
    }
    let file = picture::path("fit_pendulum")?;
    draw(&seen, &pendulum(sought.into()), &left, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

fn pendulum([m, l, c]: [f64; 3]) -> Pendulum {
    Pendulum { m, l, c, g: 9.81, torque: 2.0 }
}

fn time(k: usize) -> f64 {
    END * k as f64 / (READINGS - 1) as f64
}

/// The angles that would be read, and their derivatives by the parameters sought.
fn readings(pendulum: &Pendulum) -> Result<(DVector<f64>, MatrixXx3<f64>)> {
    let start = State::at_rest([1.0]);
    let motion = pendulum.integrate_sensitivities(start, END, Dop853::default(), &SOUGHT)?;
    let (mut angles, mut by) = (DVector::zeros(READINGS), MatrixXx3::zeros(READINGS));
    for k in 0..READINGS {
        let at = motion.derivatives_at(time(k))?;
        angles[k] = at.state.q[0];
        by.row_mut(k).copy_from(&at.q.row(0));
    }
    Ok((angles, by))
}

fn rms(left: &DVector<f64>) -> f64 {
    left.norm() / (left.len() as f64).sqrt()
}

/// Numbers of a normal distribution, the same in every run.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    /// By Box and Muller.
    fn next(&mut self) -> f64 {
        let (radius, angle) = ((-2.0 * self.uniform().ln()).sqrt(), std::f64::consts::TAU * self.uniform());
        radius * angle.cos()
    }
}

fn draw(seen: &DVector<f64>, found: &Pendulum, left: &DVector<f64>, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1000, 800))?;
    let (above, below) = root.split_vertically(picture::px(500));
    let dots: Points = (0..READINGS).map(|k| (time(k), seen[k])).collect();
    let motion = |pendulum: &Pendulum| -> Result<Points> {
        let path = pendulum.integrate(State::at_rest([1.0]), END, Dop853::default())?;
        Ok(path.samples(600).map(|sample| (sample.time(), sample.state().q[0])).collect())
    };
    let (guessed, fitted) = (motion(&pendulum(GUESS))?, motion(found)?);
    let mut chart = Panel::new("A driven pendulum, seen 200 times", ["t/s", "θ/rad"]);
    chart.curve("first guess", GREY, &guessed);
    chart.dots("seen", RED, &dots);
    chart.curve("fit", BLUE, &fitted);
    chart.draw(&above)?;
    let left: Points = (0..READINGS).map(|k| (time(k), left[k])).collect();
    let mut chart = Panel::new("What the fit leaves", ["t/s", "rad"]);
    chart.dots("seen − fit", RED, &left);
    chart.draw(&below)?;
    root.present()?;
    Ok(())
}
