//! A sphere rolling down an incline without slipping: Milton (8.8)–(8.10).
//!
//! The multiplier λ of ẋ − a φ̇ = 0 is the component of friction down the slope. It is negative: friction
//! points up the slope, and what it takes from the motion of the centre it gives to the rotation.

mod picture;

use std::f64::consts::TAU;

use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

/// A sphere of mass `m` and radius `a` rolling down an incline without slipping.
#[derive(Lagrangian)]
#[coordinates(x, phi)]
#[define(inertia = 2/5 * m * a^2)]
#[lagrangian(m/2 * x_dot^2 + inertia/2 * phi_dot^2 + m*g*x*sin(alpha))]
#[constraint(no_slip: x_dot - a*phi_dot = 0)]
struct RollingSphere {
    m: f64,
    a: f64,
    g: f64,
    alpha: f64,
}

type Path<'a> = Trajectory<&'a RollingSphere>;

fn main() -> Result<()> {
    let sphere = RollingSphere { m: 1.0, a: 0.1, g: 9.81, alpha: 0.3 };
    let path = sphere.integrate(State::at_rest([0.0, 0.0]), 3.0, Dop853::default())?;

    println!("Sphere on an incline: m ẍ = m g sin α + λ,  I φ̈ = −a λ,  ẋ − a φ̇ = 0   (Milton 8.8, 8.9)");
    println!("m = {} kg, a = {} m, g = {} m/s², α = {} rad\n", sphere.m, sphere.a, sphere.g, sphere.alpha);
    table(&sphere, &path)?;
    println!("\n{}\n", path.ending());
    checks(&sphere, &path)?;
    let file = picture::path("rolling_sphere")?;
    draw(&sphere, &path, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

impl RollingSphere {
    /// 5/7 g sin α, Milton (8.10).
    fn exact_acceleration(&self) -> f64 {
        5.0 / 7.0 * self.g * self.alpha.sin()
    }

    /// −2/7 m g sin α.
    fn exact_friction(&self) -> f64 {
        -2.0 / 7.0 * self.m * self.g * self.alpha.sin()
    }
}

fn table(sphere: &RollingSphere, path: &Path<'_>) -> Result<()> {
    println!("{:>5} {:>12} {:>12} {:>12} {:>12}", "t/s", "x/m", "exact x/m", "phi/turns", "friction/N");
    for sample in path.samples(7) {
        let (t, x) = (sample.time(), sample.coordinate("x")?);
        let (turns, friction) = (sample.coordinate("phi")? / TAU, sample.multiplier("no_slip")?);
        let exact = sphere.exact_acceleration() * t * t / 2.0;
        println!("{t:5.1} {x:12.8} {exact:12.8} {turns:12.6} {friction:12.8}");
    }
    Ok(())
}

fn checks(sphere: &RollingSphere, path: &Path<'_>) -> Result<()> {
    let mut worst = [0.0_f64; 4];
    for sample in path.samples(1000) {
        let (s, solution) = (sample.state(), sample.solution()?);
        let deviations = [
            solution.accelerations[0] / sphere.exact_acceleration() - 1.0,
            solution.multipliers[0] / sphere.exact_friction() - 1.0,
            s.q[0] - sphere.exact_acceleration() * s.t * s.t / 2.0,
            s.v[0] - sphere.a * s.v[1],
        ];
        for (worst, deviation) in worst.iter_mut().zip(deviations) {
            *worst = worst.max(deviation.abs());
        }
    }
    let laws = [
        "ẍ = 5/7 g sin α (8.10), relative",
        "λ = −2/7 m g sin α, relative",
        "x = ½ ẍ t², in m",
        "ẋ = a φ̇, in m/s",
    ];
    println!("largest deviation over 3 s, from the exact law");
    for (law, worst) in laws.into_iter().zip(worst) {
        println!("  {law:<40} {worst:8.1e}");
    }
    Ok(())
}

fn draw(sphere: &RollingSphere, path: &Path<'_>, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 900))?;
    let (upper, lower) = root.split_vertically(picture::px(470));
    draw_incline(sphere, path, &upper)?;
    let panels = lower.split_evenly((1, 2));
    draw_motion(sphere, path, &panels[0])?;
    draw_friction(sphere, path, &panels[1])?;
    root.present()?;
    Ok(())
}

/// The sphere at equal intervals of the first 0.9 s, with a mark that turns, and the forces along the slope.
fn draw_incline(sphere: &RollingSphere, path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let (sine, cosine) = sphere.alpha.sin_cos();
    let slope = |x: f64, height: f64| (x * cosine + height * sine, -x * sine + height * cosine);
    let title = "The sphere every 0.15 s: gravity along the slope, and friction against it";
    let mut chart = Panel::new(title, ["horizontal, in m", "vertical, in m"]).equal_axes();
    chart.curve("incline", GREY, &vec![slope(-0.15, 0.0), slope(1.1, 0.0)]);
    for k in 0..=6 {
        let sample = path.at(0.15 * f64::from(k))?;
        let (x, phi) = (sample.coordinate("x")?, sample.coordinate("phi")?);
        let rim = |angle: f64| slope(x + sphere.a * angle.sin(), sphere.a * (1.0 + angle.cos()));
        let outline: Points = (0..=90).map(|i| rim(f64::from(i) * TAU / 90.0)).collect();
        chart.line(outline, BLUE.stroke_width(2));
        chart.line([slope(x, sphere.a), rim(phi)], BLUE.stroke_width(2));
        chart.specks(4, BLUE, [rim(phi)]);
    }
    // One newton is drawn 6 cm long, at the last position.
    let last = path.at(0.9)?;
    let x = last.coordinate("x")?;
    let weight = sphere.m * sphere.g * sine;
    let friction = last.multiplier("no_slip")?;
    let along = |height: f64, force: f64| [slope(x, height), slope(x + 0.06 * force, height)];
    arrow(&mut chart, "m g sin α", GREY, along(sphere.a, weight))?;
    arrow(&mut chart, "friction λ", RED, along(0.0, friction))?;
    chart.draw(area)
}

/// An arrow with its name in the legend; its head is 2 cm long.
fn arrow(chart: &mut Panel, name: &str, color: RGBColor, [from, to]: [(f64, f64); 2]) -> Result<()> {
    chart.curve(name, color, &vec![from, to]);
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let head = 0.02 / dx.hypot(dy).max(1e-9);
    let back = (to.0 - head * dx, to.1 - head * dy);
    let side = |sign: f64| (back.0 - sign * head * dy / 2.0, back.1 + sign * head * dx / 2.0);
    chart.face([to, side(1.0), side(-1.0)], color);
    Ok(())
}

fn draw_motion(sphere: &RollingSphere, path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let exact: Points =
        path.samples(200).map(|s| s.time()).map(|t| (t, sphere.exact_acceleration() * t * t / 2.0)).collect();
    let integrated: Points = path.samples(16).map(|s| (s.time(), s.state().q[0])).collect();
    let mut chart = Panel::new("Path down the slope", ["t in s", "x in m"]);
    chart.curve("5/14 g sin α t²", GREY, &exact);
    chart.dots("integrated", BLUE, &integrated);
    chart.draw(area)
}

/// Along the slope m ẍ = m g sin α + λ: five sevenths of the weight's component accelerate the centre.
fn draw_friction(sphere: &RollingSphere, path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let weight = sphere.m * sphere.g * sphere.alpha.sin();
    let constant = |force: f64| -> Points { vec![(0.0, force), (3.0, force)] };
    let mut forces = [Points::new(), Points::new()];
    for sample in path.samples(16) {
        forces[0].push((sample.time(), sphere.m * sample.acceleration("x")?));
        forces[1].push((sample.time(), sample.multiplier("no_slip")?));
    }
    let mut chart = Panel::new("Forces along the slope", ["t in s", "force in N"]);
    chart.curve("gravity m g sin α", GREY, &constant(weight));
    chart.dots("m ẍ: 5/7 of it", BLUE, &forces[0]);
    chart.dots("friction λ: −2/7 of it", RED, &forces[1]);
    chart.draw(area)
}
