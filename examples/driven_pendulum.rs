//! The bifurcation diagram of a driven pendulum: θ̈ + θ̇/Q + sin θ = g cos ωt, looked at once a period of the drive, where
//! that pushes hardest.
//!
//! As the drive grows, one period becomes two, four, … and chaos, with windows of order within. (G. L. Baker and J. P. Gollub,
//! *Chaotic Dynamics*, Cambridge 1990; Q = 2, ω = 2/3.)

mod picture;

use std::f64::consts::TAU;

use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

#[derive(Lagrangian)]
#[coordinates(theta)]
#[lagrangian(theta_dot^2/2 + cos(theta))]
#[dissipation(theta_dot^2/(2*quality))]
#[force(theta: drive*cos(omega*t))]
struct Driven {
    quality: f64,
    omega: f64,
    drive: f64,
}

const OMEGA: f64 = 2.0 / 3.0;
/// Periods until the start is forgotten, and periods that are shown.
const FORGOTTEN: u32 = 120;
const SHOWN: u32 = 32;

fn main() -> Result<()> {
    println!("θ̈ + θ̇/2 + sin θ = g cos(2t/3), at t = 2πk/ω\n");
    println!("{:>8} {:>10} {:>24}", "g", "period", "velocities");
    for drive in [0.9, 1.07, 1.077, 1.15, 1.35, 1.45, 1.47] {
        let velocities = stroboscope(drive)?;
        let some: Vec<String> = velocities.iter().take(4).map(|v| format!("{v:9.6}")).collect();
        let period = period(&velocities).map_or("none".into(), |period| period.to_string());
        println!("{drive:8.3} {period:>10}   {}", some.join(" "));
    }
    let file = picture::path("driven_pendulum")?;
    draw(&file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

/// The velocities once a period, after the start is forgotten.
fn stroboscope(drive: f64) -> Result<Vec<f64>> {
    let pendulum = Driven { quality: 2.0, omega: OMEGA, drive };
    let mut motion = Motion::new(pendulum, State::at_rest([0.0]), Dopri5::with_tolerance(1e-8))?;
    let times = (FORGOTTEN..FORGOTTEN + SHOWN).map(|k| TAU / OMEGA * f64::from(k));
    motion.states_at(times).map(|state| Ok(state?.v[0])).collect()
}

/// After how many periods of the drive the motion repeats.
fn period(velocities: &[f64]) -> Option<usize> {
    (1..=8).find(|&period| {
        velocities.iter().zip(&velocities[period..]).all(|(v, later)| (v - later).abs() < 1e-4)
    })
}

fn draw(file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 900))?;
    let (upper, lower) = root.split_vertically(picture::px(450));
    draw_range(&upper, "All of it", 0.95..1.5, BLUE)?;
    let panels = lower.split_evenly((1, 2));
    draw_range(&panels[0], "The first doublings", 1.06..1.09, RED)?;
    draw_orbits(&panels[1])?;
    root.present()?;
    Ok(())
}

fn draw_range(area: &picture::Area, title: &str, range: std::ops::Range<f64>, color: RGBColor) -> Result<()> {
    let mut points = Points::new();
    for k in 0..=240 {
        let drive = range.start + (range.end - range.start) * f64::from(k) / 240.0;
        points.extend(stroboscope(drive)?.into_iter().map(|v| (drive, v)));
    }
    let mut chart = Panel::new(title, ["g", "θ̇ at t = 2πk/ω"]);
    chart.specks(1, color, points);
    chart.draw(area)
}

/// Before and after the first doubling, with where they are looked at.
fn draw_orbits(area: &picture::Area) -> Result<()> {
    let mut chart = Panel::new("Before and after one becomes two", ["θ", "θ̇"]).equal_axes();
    let mut seen = Points::new();
    for (drive, color) in [(1.06, GREY), (1.075, BLUE)] {
        let pendulum = Driven { quality: 2.0, omega: OMEGA, drive };
        let start = TAU / OMEGA * f64::from(FORGOTTEN);
        let path = pendulum.integrate(State::at_rest([0.0]), start + 2.0 * TAU / OMEGA, Dop853::default())?;
        // However often it has turned over.
        let turns = (path.at(start)?.state().q[0] / TAU).round();
        let at = |t: f64| path.at(t).map(|sample| (sample.state().q[0] - TAU * turns, sample.state().v[0]));
        let times = (0..=400).map(|k| start + 2.0 * TAU / OMEGA * f64::from(k) / 400.0);
        let orbit: std::result::Result<Points, Error> = times.map(at).collect();
        chart.curve(&format!("g = {drive}"), color, &orbit?);
        seen.extend([at(start)?, at(start + TAU / OMEGA)?]);
    }
    chart.dots("looked at", RED, &seen);
    chart.draw(area)
}
