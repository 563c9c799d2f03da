//! Stick and slip: a block on a belt, held by a spring. It rides along until the spring pulls harder than friction can hold,
//! slips back, and is caught again, a bowed string or a squeaking door.
//!
//! Sticking is a constraint, and its multiplier the friction; slipping is without it. With d = (F_s − F_k)/k, V the speed of
//! the belt and ω² = k/m, it sticks for 2d/V and slips for (2π − 2 atan(ω d/V))/ω.

mod picture;

use std::f64::consts::TAU;

use lagrange_core::{HybridTrajectory, prelude::*};
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

/// It rides on the belt.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
#[constraint(friction: x_dot - belt = 0)]
struct Sticking {
    m: f64,
    k: f64,
    belt: f64,
}

/// The belt pulls it with a force that does not depend on its speed.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
#[force(x: friction)]
struct Slipping {
    m: f64,
    k: f64,
    friction: f64,
}

const M: f64 = 1.0;
const K: f64 = 4.0;
const BELT: f64 = 0.3;
/// What friction can hold, and what it pulls with.
const HOLD: f64 = 2.0;
const PULL: f64 = 1.2;
const DURATION: f64 = 60.0;

fn main() -> Result<()> {
    println!("m = {M} kg, k = {K} N/m, the belt at {BELT} m/s, friction {HOLD} N held, {PULL} N slipping\n");
    let trajectory = ride()?;
    let times: Vec<f64> = trajectory.legs().map(|leg| leg.end_time()).collect();
    let (d, omega) = ((HOLD - PULL) / K, (K / M).sqrt());
    let expected = [2.0 * d / BELT, (TAU - 2.0 * (omega * d / BELT).atan()) / omega];
    println!("{:>14} {:>14} {:>14} {:>14} {:>10}", "begins/s", "", "lasts/s", "exactly/s", "error");
    for (k, pair) in times.windows(2).enumerate().filter(|(k, _)| *k < 8) {
        let (lasts, expected) = (pair[1] - pair[0], expected[(k + 1) % 2]);
        let what = if k % 2 == 0 { "slips" } else { "sticks" };
        println!("{:14.9} {what:>14} {lasts:14.10} {expected:14.10} {:10.0e}", pair[0], lasts - expected);
    }
    println!("\n{} legs; {}", trajectory.legs().len(), trajectory.ending().ok_or("no leg")?);
    let file = picture::path("stick_slip")?;
    draw(&trajectory, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

/// By turns.
fn ride() -> Result<HybridTrajectory<f64>> {
    let sticking = Sticking { m: M, k: K, belt: BELT };
    let slipping = Slipping { m: M, k: K, friction: PULL };
    let method = Dop853::with_tolerance(1e-12);
    let mut gives = sticking.event("gives", |s| Ok(s.multiplier("friction")? - HOLD)).rising().terminal();
    let mut catches = slipping.event("catches", |s| Ok(s.velocity("x")? - BELT)).rising().terminal();
    let (mut trajectory, mut state) = (HybridTrajectory::new(), State::new([0.0], [BELT]));
    while state.t < DURATION {
        let ride = sticking.motion(state).by(method).event(&mut gives).to(DURATION)?;
        state = *ride.end().state();
        trajectory.push(ride.into_owned())?;
        let slip = slipping.motion(state).by(method).event(&mut catches).to(DURATION)?;
        // To round-off it is as fast as the belt.
        state = State { v: [BELT].into(), ..*slip.end().state() };
        trajectory.push(slip.into_owned())?;
    }
    Ok(trajectory)
}

fn draw(trajectory: &HybridTrajectory<f64>, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 900))?;
    let panels = root.split_evenly((2, 2));
    let [mut x, mut speed, mut friction, mut phase] = [const { Points::new() }; 4];
    for k in 0..=2000 {
        let sample = trajectory.at(12.0 * f64::from(k) / 2000.0)?;
        let (t, place, v) = (sample.time(), sample.coordinate("x")?, sample.velocity("x")?);
        x.push((t, place));
        speed.push((t, v));
        friction.push((t, sample.multiplier("friction").unwrap_or(PULL)));
        phase.push((place, v / (K / M).sqrt()));
    }
    draw_one(&panels[0], "Place of the block", ["t in s", "x in m"], ("x", BLUE, &x))?;
    let belt: Points = vec![(0.0, BELT), (12.0, BELT)];
    let mut chart = Panel::new("Its velocity", ["t in s", "ẋ in m/s"]);
    chart.curve("belt", GREY, &belt);
    chart.curve("block", BLUE, &speed);
    chart.draw(&panels[1])?;
    draw_one(&panels[2], "Friction: it gives at 2 N", ["t in s", "F in N"], ("friction", RED, &friction))?;
    let mut events = Points::new();
    for leg in trajectory.legs().take(10) {
        let end = leg.named_at(leg.end_time())?;
        events.push((end.coordinate("x")?, end.velocity("x")? / (K / M).sqrt()));
    }
    let title = "The limit cycle: slipping is an arc of a circle";
    let mut chart = Panel::new(title, ["x in m", "ẋ/ω in m"]).equal_axes();
    chart.curve("block", BLUE, &phase);
    chart.dots("it gives, it is caught", RED, &events);
    chart.draw(&panels[3])?;
    root.present()?;
    Ok(())
}

fn draw_one(
    area: &picture::Area,
    title: &str,
    names: [&str; 2],
    (name, color, points): (&str, RGBColor, &Points),
) -> Result<()> {
    let mut chart = Panel::new(title, names);
    chart.curve(name, color, points);
    chart.draw(area)
}
