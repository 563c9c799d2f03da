//! Small oscillations of the spherical pendulum: the first problem of Milton's chapter 8.
//!
//! Near the lowest point the bob goes round an ellipse with semi-axes a and b in the time 2π √(l/g), a little longer
//! the larger it is, and the ellipse turns slowly in the sense of the motion:
//!
//! T = 2π √(l/g) (1 + (a² + b²)/16 l²),   Δφ = 3π a b / 4 l² an orbit.
//!
//! Both are the first terms of a series; the next is smaller by the order of a²/l². The table shows each law
//! approached, by quadrature and by the integrated motion, as the ellipse shrinks by three decades. Quadrature keeps
//! its digits all the way. In the motion Δφ is the difference of two azimuths, and T − T₀ that of two times, and the
//! round-off of 5000 steps leaves about 10⁻¹⁴ of either. Over 40 orbits of the smallest ellipse that is 10⁻⁸ of Δφ,
//! but 10⁻⁶ of T − T₀, more than what is left of that law's error: the lowest entries of the last column are noise.

mod pendulum;
mod picture;

use std::f64::consts::{PI, TAU};

use lagrange_core::prelude::*;
use pendulum::{Orbit, crossings};
use picture::{BLUE, GREY, Panel, Points, RED, Result};

#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
#[constraint(string: (x^2 + y^2 + z^2 - l^2)/2 = 0)]
struct SphericalPendulum {
    m: f64,
    g: f64,
    l: f64,
}

type Path<'a> = Trajectory<&'a SphericalPendulum>;

const PENDULUM: SphericalPendulum = SphericalPendulum { m: 1.0, g: 9.81, l: 1.0 };
/// Orbits that the integrated motion makes.
const ORBITS: usize = 40;
/// What double precision leaves of the precession an orbit and of the period, about.
const ROUND_OFF: [f64; 2] = [1e-14 / ORBITS as f64, 1e-14];

fn main() -> Result<()> {
    println!("{}", SphericalPendulum::equations());
    println!("m = {} kg, g = {} m/s², l = {} m, b = a/2", PENDULUM.m, PENDULUM.g, PENDULUM.l);
    println!("law: Δφ = 3π a b / 4 l² an orbit, T = 2π √(l/g) (1 + (a² + b²)/16 l²)\n");
    println!("{:>9} {:>13} {:^24} {:^24}", "", "", "Δφ / law − 1", "(T − T₀) / law − 1");
    println!(
        "{:>9} {:>13} {:>12} {:>11} {:>12} {:>11}",
        "a/l", "Δφ law/rad", "quadrature", "motion", "quadrature", "motion"
    );
    let ellipses = (0..=10).map(|k| Ellipse::new(0.2 * 2.0_f64.powi(-k))).collect::<Result<Vec<_>>>()?;
    for ellipse in &ellipses {
        ellipse.print();
    }
    planar()?;
    let file = picture::path("small_oscillations")?;
    draw(&ellipses, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

/// An ellipse with b = a/2: precession and excess of the period over 2π √(l/g) in three ways.
struct Ellipse {
    a: f64,
    law: [f64; 2],
    quadrature: [f64; 2],
    motion: [f64; 2],
}

impl Ellipse {
    fn new(a: f64) -> Result<Self> {
        let b = a / 2.0;
        let orbit = orbit([b, a]);
        let path = motion(&orbit, ORBITS)?;
        Ok(Self {
            a,
            law: [0.75 * PI * a * b, (a * a + b * b) / 16.0],
            quadrature: [orbit.precession(), orbit.period_excess()],
            motion: measured(&orbit, &path)?,
        })
    }

    /// By how much precession (0) or period (1) differ from the law, as parts of it.
    fn error(&self, which: usize, values: [f64; 2]) -> f64 {
        values[which] / self.law[which] - 1.0
    }

    fn print(&self) {
        let [by_quadrature, by_motion] =
            [self.quadrature, self.motion].map(|values| [0, 1].map(|which| self.error(which, values)));
        println!(
            "{:9.3e} {:13.6e} {:12.4e} {:11.3e} {:12.4e} {:11.3e}",
            self.a, self.law[0], by_quadrature[0], by_motion[0], by_quadrature[1], by_motion[1]
        );
    }
}

/// The exact motion between these distances from the axis, in units of l.
fn orbit(radii: [f64; 2]) -> Orbit {
    let height = |r: f64| r * r / (1.0 + (1.0 - r * r).sqrt());
    Orbit::between(radii.map(height), PENDULUM.g / PENDULUM.l)
}

/// From the higher turning point, across.
fn motion(orbit: &Orbit, orbits: usize) -> Result<Path<'static>> {
    let [low, high] = orbit.heights;
    let a = (high * (2.0 - high)).sqrt();
    let l_z = (2.0 * PENDULUM.g / PENDULUM.l * low * high * orbit.third).sqrt();
    let start = PENDULUM.state_from(&[("x", a), ("z", high - 1.0), ("y_dot", l_z / a)])?;
    let period = TAU * (PENDULUM.l / PENDULUM.g).sqrt();
    // Steps so short that the error is round-off: for no tolerance would x ~ a, ż ~ a² and z ~ l be equally exact.
    let method = Dop853::default().fixed_step(period / 128.0);
    Ok(PENDULUM.integrate(start, (orbits as f64 + 1.0) * period, method)?)
}

/// Precession an orbit and excess of the period, from the first and the last passage through the far end of the
/// ellipse, where the distance from the axis is stationary and large. Every second passage is at the same end.
fn measured(orbit: &Orbit, path: &Path<'_>) -> Result<[f64; 2]> {
    let growth = |t: f64| path.at(t).map_or(f64::NAN, |s| s.state().q.xy().dot(&s.state().v.xy()));
    let middle = f64::midpoint(orbit.heights[0], orbit.heights[1]) - 1.0;
    let mut far = Points::new();
    for t in crossings(path.steps().map(|s| s.time()), growth) {
        let q = path.at(t)?.state().q;
        if q.z > middle {
            far.push((t, q.y.atan2(q.x)));
        }
    }
    let same_end: Points = far.into_iter().step_by(2).collect();
    let turn = |pair: &[(f64, f64)]| (pair[1].1 - pair[0].1 + PI).rem_euclid(TAU) - PI;
    let orbits = (same_end.len() - 1) as f64;
    let period = (same_end[same_end.len() - 1].0 - same_end[0].0) / orbits;
    Ok([
        same_end.windows(2).map(turn).sum::<f64>() / orbits,
        period / TAU * (PENDULUM.g / PENDULUM.l).sqrt() - 1.0,
    ])
}

/// The swing in a plane has a closed form: T = T₀/M(1, cos ½α) with the arithmetic-geometric mean M.
fn planar() -> Result<()> {
    let smallest = TAU * (PENDULUM.l / PENDULUM.g).sqrt();
    println!("\nin a plane, from rest at the angle α: T₀ = 2π √(l/g) = {smallest:.12} s");
    println!("{:>6} {:>16} {:>17} {:>17}", "α", "T/T₀ by M(1, cos)", "quadrature less it", "motion less it");
    for degrees in [1.0, 10.0, 45.0, 90.0, 135.0, 175.0_f64] {
        let angle = degrees.to_radians();
        let exact = 1.0 / arithmetic_geometric_mean(1.0, (angle / 2.0).cos());
        let (rate, height) = (PENDULUM.g / PENDULUM.l, 2.0 * (angle / 2.0).sin().powi(2));
        let quadrature = 1.0 + Orbit::of(rate * height, 0.0, rate).period_excess();
        let start = PENDULUM.state_from(&[("x", angle.sin()), ("z", -angle.cos())])?;
        let path = PENDULUM.integrate(start, 10.0 * exact * smallest, Dop853::with_tolerance(1e-14))?;
        let x = |t: f64| path.at(t).map_or(f64::NAN, |s| s.state().q.x);
        let passages = crossings(path.steps().map(|s| s.time()), x);
        let period = (passages[18] - passages[0]) / 9.0;
        println!(
            "{degrees:5}° {exact:16.12} {:17.1e} {:17.1e}",
            quadrature - exact,
            period / smallest - exact
        );
    }
    Ok(())
}

fn arithmetic_geometric_mean(mut a: f64, mut b: f64) -> f64 {
    while (a - b).abs() > 4.0 * f64::EPSILON * a {
        (a, b) = (f64::midpoint(a, b), (a * b).sqrt());
    }
    a
}

fn draw(ellipses: &[Ellipse], file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 950))?;
    let panels = root.split_evenly((2, 2));
    draw_ellipse(&panels[0])?;
    draw_precession(ellipses, &panels[1])?;
    let titles = [
        ["Precession: relative error of 3π a b / 4 l²", "10⁻¹⁴ rad in 40 orbits"],
        ["Period: relative error of (a² + b²)/16 l²", "10⁻¹⁴ of the period"],
    ];
    for which in 0..2 {
        draw_error(ellipses, which, titles[which], &panels[2 + which])?;
    }
    root.present()?;
    Ok(())
}

/// The largest ellipse of the table, now and five orbits later.
fn draw_ellipse(area: &picture::Area) -> Result<()> {
    let exact = orbit([0.1, 0.2]);
    let path = motion(&exact, ORBITS)?;
    let turn = |first: f64| -> Result<Points> {
        let times = (0..=200).map(|k| (first + f64::from(k) / 200.0) * 2.0 * exact.nutation());
        times.map(|t| Ok(path.at(t)?.state().q.xy())).map(|q| q.map(|q| (q.x, q.y))).collect()
    };
    let title = "From above, a = 0.2 l: the ellipse turns as the bob does";
    let mut chart = Panel::new(title, ["x in l", "y in l"]).equal_axes();
    chart.curve("first orbit", GREY, &turn(0.0)?);
    chart.curve("11th orbit", BLUE, &turn(10.0)?);
    let angle = 10.0 * exact.precession();
    chart.dots("start", GREY, &vec![(0.2, 0.0)]);
    chart.dots("10 Δφ farther", RED, &vec![(0.2 * angle.cos(), 0.2 * angle.sin())]);
    chart.draw(area)
}

fn draw_precession(ellipses: &[Ellipse], area: &picture::Area) -> Result<()> {
    let points = |value: fn(&Ellipse) -> f64| -> Points {
        ellipses.iter().map(|e| (e.a.log10(), value(e).log10())).collect()
    };
    let law = points(|e| e.law[0]);
    let axes = ["log₁₀ a/l", "log₁₀ Δφ/rad"];
    let mut chart = Panel::new("Precession an orbit, b = a/2", axes);
    chart.curve("law 3π a b / 4 l²", GREY, &law);
    chart.dots("integrated motion", RED, &points(|e| e.motion[0]));
    chart.draw(area)
}

/// How the law is approached: by the square of the amplitude.
fn draw_error(
    ellipses: &[Ellipse],
    which: usize,
    [title, floor_name]: [&str; 2],
    area: &picture::Area,
) -> Result<()> {
    let points = |value: &dyn Fn(&Ellipse) -> f64| -> Points {
        ellipses.iter().map(|e| (e.a.log10(), value(e).abs().log10())).collect()
    };
    let mut chart = Panel::new(title, ["log₁₀ a/l", "log₁₀ |value/law − 1|"]);
    chart.curve(floor_name, GREY, &points(&|e| ROUND_OFF[which] / e.law[which]));
    chart.curve("quadrature: slope 2", BLUE, &points(&|e| e.error(which, e.quadrature)));
    chart.dots("integrated motion", RED, &points(&|e| e.error(which, e.motion)));
    chart.draw(area)
}
