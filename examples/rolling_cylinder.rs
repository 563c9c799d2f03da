//! A cylinder rolling on an incline, held by a spring: a velocity constraint that is a position constraint,
//! Milton (8.4)–(8.7).
//!
//! Ẋ − a φ̇ = 0 is the rate of X − a φ. Both forms are given to the macro here; the motion and the friction are the
//! same, and exact: X oscillates about m g sin α / k with ω² = k/(m + I/a²) = 2k/3m.

mod picture;

use std::f64::consts::TAU;

use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

/// The constraint written with velocities.
#[derive(Lagrangian)]
#[coordinates(X, phi)]
#[define(inertia = m/2 * a^2)]
#[lagrangian(m/2 * X_dot^2 + inertia/2 * phi_dot^2 + m*g*X*sin(alpha) - k/2 * X^2)]
#[constraint(no_slip: X_dot - a*phi_dot = 0)]
struct ByVelocities {
    m: f64,
    a: f64,
    g: f64,
    alpha: f64,
    k: f64,
}

/// Its integral.
#[derive(Lagrangian)]
#[coordinates(X, phi)]
#[define(inertia = m/2 * a^2)]
#[lagrangian(m/2 * X_dot^2 + inertia/2 * phi_dot^2 + m*g*X*sin(alpha) - k/2 * X^2)]
#[constraint(no_slip: X - a*phi = 0)]
struct ByPosition {
    m: f64,
    a: f64,
    g: f64,
    alpha: f64,
    k: f64,
}

type Path<'a> = Trajectory<&'a ByVelocities>;
type OtherPath<'a> = Trajectory<&'a ByPosition>;

const CYLINDER: ByVelocities = ByVelocities { m: 1.0, a: 0.1, g: 9.81, alpha: 0.3, k: 8.0 };
const DURATION: f64 = 50.0;

fn main() -> Result<()> {
    let ByVelocities { m, a, g, alpha, k } = CYLINDER;
    let other = ByPosition { m, a, g, alpha, k };
    let (start, method) = (State::at_rest([0.0; 2]), Dop853::with_tolerance(1e-12));
    let path = CYLINDER.integrate(start, DURATION, method)?;
    let other_path = other.integrate(start, DURATION, method)?;

    println!("Cylinder on an incline, on a spring, with the constraint in two forms   (Milton 8.4–8.7)\n");
    println!("{}\n{}", ByVelocities::equations(), ByPosition::equations());
    println!("m = {m} kg, a = {a} m, g = {g} m/s², α = {alpha} rad, k = {k} N/m\n");
    table(&path, &other_path)?;
    println!("\n{}\n", path.ending());
    checks(&path, &other_path)?;
    let file = picture::path("rolling_cylinder")?;
    draw(&path, &other_path, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

impl ByVelocities {
    /// ω.
    fn angular_frequency(&self) -> f64 {
        (2.0 * self.k / (3.0 * self.m)).sqrt()
    }

    /// X and the friction −m Ẍ/2, from rest at X = 0.
    fn exact(&self, t: f64) -> [f64; 2] {
        let middle = self.m * self.g * self.alpha.sin() / self.k;
        let omega = self.angular_frequency();
        let cosine = (omega * t).cos();
        [middle * (1.0 - cosine), -self.m / 2.0 * omega * omega * middle * cosine]
    }
}

fn table(path: &Path<'_>, other: &OtherPath<'_>) -> Result<()> {
    println!("{:>5} {:>14} {:>14} {:>14} {:>14}", "", "Ẋ − aφ̇ = 0", "", "X − aφ = 0", "");
    println!("{:>5} {:>14} {:>14} {:>14} {:>14}", "t/s", "X/m", "friction/N", "X/m", "friction/N");
    for (one, two) in path.samples(11).zip(other.samples(11)) {
        let (x, friction) = (one.coordinate("X")?, one.multiplier("no_slip")?);
        let (other_x, other_friction) = (two.coordinate("X")?, two.multiplier("no_slip")?);
        println!("{:5.1} {x:14.10} {friction:14.10} {other_x:14.10} {other_friction:14.10}", one.time());
    }
    Ok(())
}

/// What the two motions differ by, and how far the first is from the exact law.
fn deviations(path: &Path<'_>, other: &OtherPath<'_>, count: usize) -> Result<Vec<(f64, [f64; 5])>> {
    let mut rows = Vec::new();
    for (one, two) in path.samples(count).zip(other.samples(count)) {
        let [x, friction] = CYLINDER.exact(one.time());
        let (s, lambda) = (one.state(), one.multiplier("no_slip")?);
        let row = [
            s.q[0] - two.coordinate("X")?,
            lambda - two.multiplier("no_slip")?,
            s.q[0] - CYLINDER.a * s.q[1],
            s.q[0] - x,
            lambda - friction,
        ];
        rows.push((one.time(), row.map(f64::abs)));
    }
    Ok(rows)
}

fn checks(path: &Path<'_>, other: &OtherPath<'_>) -> Result<()> {
    let laws = [
        "X: velocity form = position form, in m",
        "friction: velocity form = position form, in N",
        "velocity form keeps X − a φ = 0, in m",
        "X = m g sin α/k (1 − cos ωt), ω² = 2k/3m, in m",
        "friction λ = −I φ̈/a = −m Ẍ/2, in N",
    ];
    println!("largest deviation over {DURATION} s");
    let rows = deviations(path, other, 2000)?;
    for (i, law) in laws.into_iter().enumerate() {
        let worst = rows.iter().map(|(_, row)| row[i]).fold(0.0, f64::max);
        println!("  {law:<50} {worst:8.1e}");
    }
    Ok(())
}

fn draw(path: &Path<'_>, other: &OtherPath<'_>, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 900))?;
    let panels = root.split_evenly((2, 2));
    draw_incline(path, &panels[0])?;
    draw_difference(path, other, &panels[1])?;
    let [mut x, mut friction] = [[Points::new(), Points::new()], [Points::new(), Points::new()]];
    // The two forms take turns, or one would hide the other.
    for i in 0..=60_usize {
        let t = i as f64 / 6.0;
        let (one, two) = (path.at(t)?, other.at(t)?);
        let x_and_friction = match i % 2 {
            0 => [one.coordinate("X")?, one.multiplier("no_slip")?],
            _ => [two.coordinate("X")?, two.multiplier("no_slip")?],
        };
        x[i % 2].push((t, x_and_friction[0]));
        friction[i % 2].push((t, x_and_friction[1]));
    }
    let exact = |index: usize| -> Points {
        (0..=400).map(|i| f64::from(i) / 40.0).map(|t| (t, CYLINDER.exact(t)[index])).collect()
    };
    draw_both(&panels[2], "Distance along the incline", "X in m", &exact(0), &x)?;
    draw_both(&panels[3], "Friction: the multiplier, along +X", "λ in N", &exact(1), &friction)?;
    root.present()?;
    Ok(())
}

/// The cylinder on its way down, with a mark that turns.
fn draw_incline(path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let (sine, cosine) = CYLINDER.alpha.sin_cos();
    let slope = |x: f64, height: f64| (x * cosine + height * sine, -x * sine + height * cosine);
    let title = "Half a swing: the mark turns as the axle moves";
    let mut chart = Panel::new(title, ["horizontal, in m", "vertical, in m"]).equal_axes();
    chart.curve("incline", GREY, &vec![slope(-0.6, 0.0), slope(1.0, 0.0)]);
    for part in [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0] {
        let sample = path.at(f64::acos(1.0 - 2.0 * part) / CYLINDER.angular_frequency())?;
        let (x, phi) = (sample.coordinate("X")?, sample.coordinate("phi")?);
        let rim = |angle: f64| slope(x + CYLINDER.a * angle.sin(), CYLINDER.a * (1.0 + angle.cos()));
        let outline: Points = (0..=90).map(|i| rim(f64::from(i) * TAU / 90.0)).collect();
        chart.line(outline, BLUE.stroke_width(2));
        chart.line([slope(x, CYLINDER.a), rim(phi)], BLUE.stroke_width(2));
        chart.specks(4, BLUE, [rim(phi)]);
    }
    chart.curve("spring, slack at the start", RED, &spring(slope));
    chart.draw(area)
}

/// A zigzag from the wall to the axle.
fn spring(slope: impl Fn(f64, f64) -> (f64, f64)) -> Points {
    let zigzag = |i: u32| match i {
        0 | 20 => 0.0,
        _ if i.is_multiple_of(2) => 0.03,
        _ => -0.03,
    };
    (0..=20).map(|i| slope(-0.55 + f64::from(i) * 0.0275, CYLINDER.a + zigzag(i))).collect()
}

fn draw_difference(path: &Path<'_>, other: &OtherPath<'_>, area: &picture::Area) -> Result<()> {
    let rows = deviations(path, other, 1000)?;
    let picked = |index: usize| -> Points { rows.iter().map(|(t, row)| (*t, row[index] * 1e12)).collect() };
    let (forms, exact) = (picked(0), picked(3));
    let mut chart = Panel::new("Deviations of X over 50 s", ["t in s", "|difference| in 10⁻¹² m"]);
    chart.curve("from the exact law", GREY, &exact);
    chart.curve("between the two forms", BLUE, &forms);
    chart.draw(area)
}

/// What both forms give for a quantity, beside the exact law.
fn draw_both(
    area: &picture::Area,
    title: &str,
    name: &str,
    exact: &Points,
    [by_velocities, by_position]: &[Points; 2],
) -> Result<()> {
    let mut chart = Panel::new(title, ["t in s", name]);
    chart.curve("exact", GREY, exact);
    chart.dots("with Ẋ − aφ̇ = 0", BLUE, by_velocities);
    chart.dots("with X − aφ = 0", RED, by_position);
    chart.draw(area)
}
