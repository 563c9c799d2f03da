//! Poincaré sections of the potential of Hénon and Heiles: a star in a galaxy, and whether anything but its energy is
//! conserved. (M. Hénon and C. Heiles, *The Astronomical Journal* 69 (1964), 73–79.)
//!
//! Each orbit is looked at where it crosses x = 0 with ẋ > 0. Where there is another conserved quantity the points lie on
//! curves; at the energy 1/8 many orbits have none.

mod picture;

use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - (x^2 + y^2)/2 - x^2*y + y^3/3)]
struct HenonHeiles;

/// Starts on the section, (y, ẏ).
const STARTS: [(f64, f64); 12] = [
    (-0.3, 0.0),
    (-0.2, 0.0),
    (-0.1, 0.0),
    (0.0, 0.0),
    (0.1, 0.0),
    (0.2, 0.0),
    (0.3, 0.0),
    (0.35, 0.0),
    (0.0, 0.15),
    (0.0, 0.3),
    (0.0, -0.3),
    (-0.02, 0.25),
];
const COUNT: usize = 300;

fn main() -> Result<()> {
    let energies = [1.0 / 12.0, 1.0 / 8.0];
    println!("{} orbits of {COUNT} crossings at each of two energies\n", STARTS.len());
    println!(
        "{:>8} {:>8} {:>8} {:>12} {:>14} {:>12}",
        "energy", "y", "ẏ", "to t", "largest |x|", "energy off"
    );
    let mut sections = Vec::new();
    for energy in energies {
        let mut section = Vec::new();
        for &(y, y_dot) in &STARTS {
            if let Some(start) = start(energy, y, y_dot) {
                section.push(orbit(energy, start)?);
            }
        }
        sections.push(section);
    }
    let file = picture::path("henon_heiles")?;
    draw(&energies, &sections, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

/// With ẋ from the energy, where that is enough.
fn start(energy: f64, y: f64, y_dot: f64) -> Option<State<f64, 2>> {
    let rest = State::new([0.0, y], [0.0, y_dot]);
    let left = energy - HenonHeiles.energy(&rest);
    (left > 0.0).then(|| State::new([0.0, y], [(2.0 * left).sqrt(), y_dot]))
}

fn orbit(energy: f64, start: State<f64, 2>) -> Result<Points> {
    let mut upwards = HenonHeiles.event("section", |sample| sample.state().q[0]).rising();
    let mut motion = Motion::new(HenonHeiles, start, Dop853::with_tolerance(1e-12))?;
    let mut points = vec![(start.q[1], start.v[1])];
    let (mut x, mut off, mut end) = (0.0_f64, 0.0_f64, 0.0);
    for crossing in motion.crossings(1e6, &mut [&mut upwards]).take(COUNT) {
        let state = crossing?.state;
        points.push((state.q[1], state.v[1]));
        x = x.max(state.q[0].abs());
        off = off.max((HenonHeiles.energy(&state) / energy - 1.0).abs());
        end = state.t;
    }
    let (y, y_dot) = points[0];
    println!("{energy:8.4} {y:8.2} {y_dot:8.2} {end:12.3} {x:14.0e} {off:12.0e}");
    Ok(points)
}

fn draw(energies: &[f64; 2], sections: &[Vec<Points>], file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 560))?;
    let panels = root.split_evenly((1, 2));
    for ((area, energy), section) in panels.iter().zip(energies).zip(sections) {
        let title = format!("E = 1/{:.0}", 1.0 / energy);
        let (edge, starts) = (edge(*energy), section.iter().map(|points| points[0]).collect());
        let mut chart = Panel::new(&title, ["y", "ẏ"]).equal_axes();
        for points in section {
            chart.specks(1, BLUE, points.iter().copied());
        }
        chart.curve("ẋ = 0", GREY, &edge);
        chart.dots("starts", RED, &starts);
        chart.draw(area)?;
    }
    root.present()?;
    Ok(())
}

/// Where no energy is left for ẋ: ẏ² = 2E − y² + 2/3 y³.
fn edge(energy: f64) -> Points {
    let square = |y: f64| 2.0 * energy - y * y + 2.0 / 3.0 * y.powi(3);
    let ys = |k: i32| f64::from(k) * 1e-3;
    let inside = || (-600..900).filter(|&k| square(ys(k)) >= 0.0);
    let upper = inside().map(|k| (ys(k), square(ys(k)).sqrt()));
    let lower = inside().rev().map(|k| (ys(k), -square(ys(k)).sqrt()));
    upper.chain(lower).collect()
}
