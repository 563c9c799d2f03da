//! A leg that hops: a body on a spring, whose foot leaves the ground. The rest length of the spring is driven by a clock, and the hops
//! settle to its period.
//!
//! The foot lands without a bounce, which takes the part m_foot/(m + m_foot) of the energy of the fall; the clock gives it back.

mod picture;

use std::f64::consts::TAU;

use lagrange_core::contact::{Contact, Transition};
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};

#[derive(Clone, Lagrangian)]
#[coordinates(y, foot)]
#[define(length = l + d*sin(omega*t))]
#[lagrangian(m/2 * y_dot^2 + m_foot/2 * foot_dot^2 - k/2 * (y - foot - length)^2 - m*g*y - m_foot*g*foot)]
#[dissipation(c/2 * (y_dot - foot_dot)^2)]
#[contact(ground: foot >= 0)]
struct Leg {
    m: f64,
    m_foot: f64,
    /// Stiffness and damping of the leg, its mean length, and by how much the clock changes that.
    k: f64,
    c: f64,
    l: f64,
    d: f64,
    omega: f64,
    g: f64,
    ground: Contact,
}

const LEG: Leg = Leg {
    m: 1.0,
    m_foot: 0.1,
    k: 600.0,
    c: 4.0,
    l: 0.5,
    d: 0.03,
    omega: TAU / 0.4,
    g: 9.81,
    ground: Contact::Closed,
};

type Path = Trajectory<Leg>;

fn main() -> Result<()> {
    let start = State::at_rest([LEG.l, 0.0]);
    let path = LEG.motion(start).by(Dop853::with_tolerance(1e-12)).with_contacts().to(20.0)?;
    println!("{path}\n\n{:>4} {:>14} {:>14} {:>14}", "hop", "lands at t/s", "since last/s", "in the air/s");
    let lands = times(&path, |transition| matches!(transition, Transition::Impact { .. }));
    let leaves = times(&path, |transition| matches!(transition, Transition::Opens { .. }));
    for k in (1..lands.len()).step_by(6) {
        let (since, air) = (lands[k] - lands[k - 1], lands[k] - leaves[k]);
        println!("{:4} {:14.9} {since:14.10} {air:14.10}", k + 1, lands[k]);
    }
    println!("the clock goes round in {:.10} s", TAU / LEG.omega);
    let file = picture::path("hopping_leg")?;
    draw(&path, &lands, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

/// Times of the transitions of a kind.
fn times(path: &Path, is_it: impl Fn(&Transition<f64>) -> bool) -> Vec<f64> {
    path.transitions().iter().filter(|transition| is_it(transition)).map(Transition::time).collect()
}

fn draw(path: &Path, lands: &[f64], file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 900))?;
    let panels = root.split_evenly((2, 2));
    let [mut body, mut foot, mut push, mut cycle] = [const { Points::new() }; 4];
    for k in 0..=4000 {
        let sample = path.at(3.0 * f64::from(k) / 4000.0)?;
        body.push((sample.time(), sample.coordinate("y")?));
        foot.push((sample.time(), sample.coordinate("foot")?));
        let sample = path.at(20.0 - 4.0 * TAU / LEG.omega * f64::from(k) / 4000.0)?;
        push.push((sample.time(), sample.multiplier("ground")?));
        cycle.push((sample.coordinate("y")?, sample.velocity("y")?));
    }
    let mut chart = Panel::new("It begins to hop", ["t in s", "height in m"]);
    chart.curve("body", BLUE, &body);
    chart.curve("foot", RED, &foot);
    chart.draw(&panels[0])?;
    let since = lands.windows(2).enumerate().map(|(k, pair)| (k as f64, pair[1] - pair[0]));
    let mut chart = Panel::new("The hops take the period of the clock", ["hop", "time in s"]);
    chart.dots("from landing to landing", RED, &since.collect());
    chart.draw(&panels[1])?;
    let mut chart = Panel::new("The push of the ground, in the end", ["t in s", "force in N"]);
    chart.curve("ground", GREY, &push);
    chart.draw(&panels[2])?;
    let mut chart = Panel::new("The cycle of the body", ["y in m", "dy/dt in m/s"]);
    chart.curve("four periods", BLUE, &cycle);
    chart.draw(&panels[3])?;
    root.present()?;
    Ok(())
}
