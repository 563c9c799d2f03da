//! A ball thrown forwards with backspin: it slides in its first impact, turns back, bounces and rolls.
//!
//! All forces act at the point of contact, so that the angular momentum about the floor, m r ẋ + 2/5 m r² φ̇, stays through all
//! bounces. In the end it rolls with 5/7 (ẋ + 2/5 r φ̇).

mod picture;

use lagrange_core::contact::{Contact, Transition};
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, phi)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*r^2/5 * phi_dot^2 - m*g*y)]
#[contact(floor: y - r >= 0, restitution: e, friction(mu): x_dot - r*phi_dot)]
#[conserved(about_the_floor = m*r*x_dot + 2/5*m*r^2*phi_dot)]
struct Ball {
    m: f64,
    r: f64,
    g: f64,
    e: f64,
    mu: f64,
    floor: Contact,
}

const BALL: Ball = Ball { m: 0.057, r: 0.033, g: 9.81, e: 0.75, mu: 0.25, floor: Contact::Open };
/// Velocities forwards and up, in m/s, and the backspin, in 1/s.
const START: [f64; 3] = [1.2, 0.0, -220.0];

fn main() -> Result<()> {
    let path =
        BALL.motion(State::new([0.0, 0.8, 0.0], START)).by(Taylor::default()).with_contacts().to(3.2)?;
    println!("{path}\n");
    for (k, transition) in path.transitions().iter().enumerate() {
        if k < 4 || !matches!(transition, Transition::Impact { .. }) {
            println!("{transition}");
        }
    }
    let rolls = 5.0 / 7.0 * (START[0] + 0.4 * BALL.r * START[2]);
    println!("\nit rolls with {} m/s, {rolls} m/s by its angular momentum", path.end().state().v[0]);
    println!("\n{}", path.drift());
    let file = picture::path("spinning_ball")?;
    draw(&path, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

fn draw(path: &Trajectory<Ball>, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 900))?;
    let panels = root.split_evenly((2, 2));
    let [mut way, mut speed, mut rim, mut energy] = [const { Points::new() }; 4];
    for sample in path.samples(4000) {
        let t = sample.time();
        way.push((sample.coordinate("x")?, sample.coordinate("y")?));
        speed.push((t, sample.velocity("x")?));
        rim.push((t, BALL.r * sample.velocity("phi")?));
        energy.push((t, sample.energy()));
    }
    let mut chart = Panel::new("The way of its centre", ["x in m", "y in m"]).equal_axes();
    chart.line([(-3.0, 0.0), (0.6, 0.0)], GREY.stroke_width(2));
    chart.curve("ball", BLUE, &way);
    chart.draw(&panels[0])?;
    let mut chart = Panel::new("Friction makes both velocities one", ["t in s", "velocity in m/s"]);
    chart.curve("ẋ", BLUE, &speed);
    chart.curve("r dφ/dt", RED, &rim);
    chart.draw(&panels[1])?;
    let mut chart = Panel::new("Its energy", ["t in s", "E in J"]);
    chart.curve("E", BLUE, &energy);
    chart.draw(&panels[2])?;
    draw_spin(path, &panels[3])?;
    root.present()?;
    Ok(())
}

/// The ball with a spoke, every 0.03 s of its first bounces.
fn draw_spin(path: &Trajectory<Ball>, area: &picture::Area) -> Result<()> {
    let mut chart = Panel::new("Its spin, every 0.03 s", ["x in m", "y in m"]).equal_axes();
    chart.line([(-0.1, 0.0), (0.65, 0.0)], GREY.stroke_width(2));
    for k in 0..40 {
        let sample = path.at(0.03 * f64::from(k))?;
        let [x, y, phi] = [sample.coordinate("x")?, sample.coordinate("y")?, sample.coordinate("phi")?];
        let rim = |angle: f64| (x + BALL.r * angle.sin(), y + BALL.r * angle.cos());
        chart.line((0..=36).map(|k| rim(f64::from(k).to_radians() * 10.0)), BLUE.stroke_width(1));
        chart.line([(x, y), rim(phi)], RED.stroke_width(2));
    }
    chart.draw(area)
}
