//! A slender block that rocks from corner to corner on a rough floor, lower each time: Housner's restitution (*Bulletin of the
//! Seismological Society of America* 53, 1963).
//!
//! An impact keeps the angular momentum about the new corner. It takes the part 1 − (1 − 3/2 sin² α)² of the energy, where α is the
//! angle between a side and the diagonal.

mod picture;

use lagrange_core::contact::{Contact, Transition};
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[define(corner(s) = [x + s*b*cos(theta) + h*sin(theta), y + s*b*sin(theta) - h*cos(theta)])]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*(b^2 + h^2)/6 * theta_dot^2 - m*g*y)]
#[contact(floor[i in 0..2]: corner(2*i - 1)[1] >= 0, friction(mu): der(corner(2*i - 1))[0])]
struct Block {
    m: f64,
    /// Half width and half height.
    b: f64,
    h: f64,
    g: f64,
    mu: f64,
    floor: [Contact; 2],
}

const BLOCK: Block =
    Block { m: 3.0, b: 0.1, h: 0.5, g: 9.81, mu: 0.8, floor: [Contact::Closed, Contact::Open] };

type Path = Trajectory<Block>;

fn main() -> Result<()> {
    let alpha = (BLOCK.b / BLOCK.h).atan();
    // It leans on its left corner.
    let (tilt, (b, h)) = (0.8 * alpha, (BLOCK.b, BLOCK.h));
    let (sine, cosine) = tilt.sin_cos();
    let start = State::at_rest([b * cosine - h * sine, b * sine + h * cosine, tilt]);
    let path = BLOCK.motion(start).by(Dop853::with_tolerance(1e-12)).with_contacts().to(5.0)?;
    println!("{path}\n");
    let energies = energies(&path)?;
    let housner = (1.0 - 1.5 * alpha.sin().powi(2)).powi(2);
    println!("{:>6} {:>14} {:>14} {:>14}", "impact", "at t/s", "energy kept", "by Housner");
    for (k, pair) in energies.windows(2).enumerate().take(12) {
        println!("{:6} {:14.9} {:14.10} {housner:14.10}", k + 1, pair[1].0, pair[1].1 / pair[0].1);
    }
    let file = picture::path("rocking_block")?;
    draw(&path, &energies, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

/// The start and the impacts: their times, and the energy from then on, beyond that of the block that stands.
fn energies(path: &Path) -> Result<Vec<(f64, f64)>> {
    let impacts =
        path.transitions().iter().filter(|transition| matches!(transition, Transition::Impact { .. }));
    let times = std::iter::once(0.0).chain(impacts.map(Transition::time));
    times.map(|t| Ok((t, path.at(t)?.energy() - BLOCK.m * BLOCK.g * BLOCK.h))).collect()
}

fn draw(path: &Path, energies: &[(f64, f64)], file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 900))?;
    let panels = root.split_evenly((2, 2));
    let [mut angle, mut phase, mut hold, mut limit] = [const { Points::new() }; 4];
    for sample in path.samples(4000) {
        let (t, theta) = (sample.time(), sample.coordinate("theta")?);
        angle.push((t, theta));
        phase.push((theta, sample.velocity("theta")?));
        let sum = |names: [&str; 2]| -> Result<f64> {
            Ok(sample.multiplier(names[0])? + sample.multiplier(names[1])?)
        };
        hold.push((t, sum(["floor_friction[0]", "floor_friction[1]"])?));
        limit.push((t, BLOCK.mu * sum(["floor[0]", "floor[1]"])?));
    }
    let mut chart = Panel::new("It rocks faster and faster", ["t in s", "θ in rad"]);
    chart.curve("angle", BLUE, &angle);
    chart.draw(&panels[0])?;
    let mut chart = Panel::new("Each impact takes a part of its rate", ["θ in rad", "dθ/dt in 1/s"]);
    chart.curve("block", BLUE, &phase);
    chart.draw(&panels[1])?;
    let parts: Points = (0..).map(f64::from).zip(energies).map(|(k, (_, e))| (k, e.ln())).take(40).collect();
    let mut chart = Panel::new("Its energy falls by one factor", ["impact", "ln (E/J)"]);
    let slope = 2.0 * (1.0 - 1.5 * (BLOCK.b / BLOCK.b.hypot(BLOCK.h)).powi(2)).ln();
    chart.line(parts.iter().map(|&(k, _)| (k, parts[0].1 + slope * k)), GREY.stroke_width(2));
    chart.dots("block", RED, &parts);
    chart.draw(&panels[2])?;
    let mut chart = Panel::new("Friction holds it, within its limit", ["t in s", "force in N"]);
    chart.curve("limit", GREY, &limit);
    chart.curve("friction", RED, &hold);
    chart.draw(&panels[3])?;
    root.present()?;
    Ok(())
}
