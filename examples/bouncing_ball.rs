//! A ball that bounces on a floor and comes to rest: one struct, whose contact opens and closes.
//!
//! From the height h the first fall takes T = √(2h/g), the bounce after impact n takes 2 eⁿ T: it is at rest after
//! (1 + e)/(1 − e) T.

mod picture;

use lagrange_core::contact::{Contact, Transition};
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
#[contact(floor: y >= 0, restitution: e)]
struct Ball {
    m: f64,
    g: f64,
    e: f64,
    floor: Contact,
}

const BALL: Ball = Ball { m: 0.2, g: 9.81, e: RESTITUTION, floor: Contact::Open };
const HEIGHT: f64 = 1.0;
const RESTITUTION: f64 = 0.8;

/// A bounce: when, the impulse of the floor, and how far from the geometric series the time is.
type Bounce = (f64, f64, f64);

fn main() -> Result<()> {
    let path = BALL.motion(start()).by(Taylor::default()).with_contacts().to(5.0)?;
    let bounces: Vec<Bounce> = bounces(&path).collect();
    println!("A ball dropped from {HEIGHT} m with 0.5 m/s to the side; e = {RESTITUTION}\n");
    println!("{:>6} {:>14} {:>14} {:>18}", "bounce", "t/s", "impulse/Ns", "off the series/s");
    for (k, (t, impulse, off)) in bounces.iter().enumerate().filter(|(k, _)| k % 8 == 0) {
        println!("{:6} {t:14.10} {impulse:14.10} {off:18.1e}", k + 1);
    }
    let last = path.transitions().last().ok_or("no transition")?;
    println!("\n{} bounces, then {last}", bounces.len());
    let rest = (2.0 * HEIGHT / BALL.g).sqrt() * (1.0 + RESTITUTION) / (1.0 - RESTITUTION);
    println!("by the series it is at rest at t = {rest}, {:.0e} s later", rest - last.time());
    identify()?;
    let file = picture::path("bouncing_ball")?;
    draw(&path, &bounces, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

fn bounces(path: &Trajectory<Ball>) -> impl Iterator<Item = Bounce> {
    let impacts = path.transitions().iter().filter_map(|transition| match transition {
        Transition::Impact { time, impulses } => Some((*time, impulses.first()?.1)),
        _ => None,
    });
    impacts.enumerate().map(|(n, (time, impulse))| (time, impulse, (time - series(n as i32)).abs()))
}

/// Which restitution lets it fly 0.2 m high after 2 s? Newton's method, with the derivative of the height across three
/// impacts.
fn identify() -> Result<()> {
    println!("\n0.2 m high after 2 s: e by Newton's method");
    let (mut e, height, end, method) = (RESTITUTION, 0.2, 2.0, Dop853::with_tolerance(1e-13));
    for _ in 0..5 {
        let path = Ball { e, ..BALL }.motion(start()).by(method).with_contacts().to(end)?;
        let at = path.sensitivity(&["e"], method)?;
        let (y, by_restitution) = (at.state.q[1], at.q[(1, 0)]);
        println!("e = {e:.12}: {y:.12} m, {by_restitution:.6} m more for 1 more");
        e += (height - y) / by_restitution;
    }
    let fall = (2.0 * HEIGHT / BALL.g).sqrt();
    let since = end - fall * (1.0 + 2.0 * e + 2.0 * e * e);
    assert!((e.powi(3) * BALL.g * fall * since - BALL.g / 2.0 * since * since - height).abs() < 1e-12);
    Ok(())
}

fn start() -> State<f64, 2> {
    State::new([0.0, HEIGHT], [0.5, 0.0])
}

/// The time of impact n, counted from 0.
fn series(n: i32) -> f64 {
    let fall = (2.0 * HEIGHT / BALL.g).sqrt();
    fall * (1.0 + 2.0 * RESTITUTION * (1.0 - RESTITUTION.powi(n)) / (1.0 - RESTITUTION))
}

fn draw(path: &Trajectory<Ball>, bounces: &[Bounce], file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 900))?;
    let panels = root.split_evenly((2, 2));
    let [mut flight, mut speed, mut energy] = [const { Points::new() }; 3];
    for sample in path.samples(3000) {
        flight.push((sample.coordinate("x")?, sample.coordinate("y")?));
        speed.push((sample.time(), sample.velocity("y")?));
        energy.push((sample.time(), sample.energy()));
    }
    let mut chart = Panel::new("The way of the ball", ["x in m", "y in m"]).equal_axes();
    chart.curve("ball", BLUE, &flight);
    chart.draw(&panels[0])?;
    draw_one(&panels[1], "Its velocity jumps", ["t in s", "ẏ in m/s"], ("ẏ", RED, &speed))?;
    draw_one(&panels[2], "Its energy", ["t in s", "E in J"], ("E", BLUE, &energy))?;
    let off: Points = (1..).zip(bounces).map(|(k, bounce)| (f64::from(k), bounce.2 * 1e15)).collect();
    let title = "Times off the geometric series";
    let mut chart = Panel::new(title, ["bounce", "|Δt| in 10⁻¹⁵ s"]);
    chart.dots("difference", GREY, &off);
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
