//! Stick and slip: a block on a belt, held by a spring. It rides along until the spring pulls harder than friction can hold,
//! slips back, and is caught again, a bowed string or a squeaking door.
//!
//! Sticking is a constraint, and slipping a force; the multiplier is the friction in both. With d = (F_s − F_k)/k, V the speed
//! of the belt and ω² = k/m, it sticks for 2d/V and slips for (2π − 2 atan(ω d/V))/ω.

mod picture;

use std::f64::consts::TAU;

use lagrange_core::contact::Friction;
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
#[friction(friction: x_dot - belt, limit: hold, sliding: pull)]
struct Bow {
    m: f64,
    k: f64,
    belt: f64,
    hold: f64,
    pull: f64,
    friction: Friction,
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
    let bow = Bow { m: M, k: K, belt: BELT, hold: HOLD, pull: PULL, friction: Friction::Sticks };
    let method = Dop853::with_tolerance(1e-12);
    let path = bow.motion(State::new([0.0], [BELT])).by(method).with_contacts().to(DURATION)?;
    let times: Vec<f64> = path.transitions().iter().map(|transition| transition.time()).collect();
    let (d, omega) = ((HOLD - PULL) / K, (K / M).sqrt());
    let expected = [2.0 * d / BELT, (TAU - 2.0 * (omega * d / BELT).atan()) / omega];
    println!("{:>14} {:>14} {:>14} {:>14} {:>10}", "begins/s", "", "lasts/s", "exactly/s", "error");
    for (k, pair) in times.windows(2).enumerate().filter(|(k, _)| *k < 8) {
        let (lasts, expected) = (pair[1] - pair[0], expected[(k + 1) % 2]);
        let what = if k % 2 == 0 { "slips" } else { "sticks" };
        println!("{:14.9} {what:>14} {lasts:14.10} {expected:14.10} {:10.0e}", pair[0], lasts - expected);
    }
    println!("\n{path}");
    let file = picture::path("stick_slip")?;
    draw(&path, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

fn draw(path: &Trajectory<Bow>, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 900))?;
    let panels = root.split_evenly((2, 2));
    let [mut x, mut speed, mut friction, mut phase] = [const { Points::new() }; 4];
    for k in 0..=2000 {
        let sample = path.at(12.0 * f64::from(k) / 2000.0)?;
        let (t, place, v) = (sample.time(), sample.coordinate("x")?, sample.velocity("x")?);
        x.push((t, place));
        speed.push((t, v));
        friction.push((t, sample.multiplier("friction")?));
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
    for transition in path.transitions().iter().take(10) {
        let sample = path.at(transition.time())?;
        events.push((sample.coordinate("x")?, sample.velocity("x")? / (K / M).sqrt()));
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
