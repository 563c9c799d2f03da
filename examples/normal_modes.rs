//! Nonlinear normal modes of two masses: periodic motions that grow out of the two normal modes of the linear system.
//!
//! Each mass is held by a spring to its wall and to the other mass; the first spring hardens. The frequency grows with the energy, and
//! where the ratio of frequencies is whole the modes meet. (G. Kerschen, M. Peeters, J.-C. Golinval and A. F. Vakakis, *Mechanical Systems
//! and Signal Processing* 23, 2009, 170–194, the example of their section 2.)

mod picture;

use std::f64::consts::TAU;

use lagrange_core::orbits::Family;
use lagrange_core::prelude::*;
use picture::{BLUE, Panel, Points, RED, Result};

#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - (x^2 + y^2 + (x - y)^2)/2 - x^4/8)]
struct Masses;

/// Amplitude at which the modes are those of the linear system to 10⁻³.
const SMALL: f64 = 0.05;

fn main() -> Result<()> {
    let linear = Masses.linearize(&State::at_rest([0.0, 0.0]), &[])?.natural_frequencies()?;
    println!("linear frequencies: {linear:.9?}\n");
    let shapes = [[SMALL, SMALL], [SMALL, -SMALL]];
    let mut modes = Vec::new();
    for (shape, frequency) in shapes.into_iter().zip(linear) {
        let rest = State::at_rest(shape);
        // Both masses rest together at the turning points.
        let search = Masses.periodic_orbit(&rest).period_near(TAU / frequency).mirrored(&["x_dot", "y_dot"]);
        let first = search.find()?;
        let mode = search.family(&first).longest_step(0.2).until(|orbit| orbit.energy() > 100.0).follow()?;
        println!("{mode}");
        modes.push(mode);
    }
    let file = picture::path("normal_modes")?;
    draw(&modes, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

fn draw(modes: &[Family<Masses>], file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 560))?;
    let panels = root.split_evenly((1, 2));
    let mut chart = Panel::new("frequency", ["log₁₀ E", "ω"]);
    for (mode, (name, color)) in modes.iter().zip([("in phase", BLUE), ("out of phase", RED)]) {
        let points = mode.orbits().iter().map(|orbit| (orbit.energy().log10(), TAU / orbit.period));
        chart.curve(name, color, &points.collect());
        let points = mode.bifurcations().iter().map(|found| (found.value.log10(), TAU / found.orbit.period));
        chart.dots("bifurcation", color, &points.collect());
    }
    chart.draw(&panels[0])?;
    let mut chart = Panel::new("motions in the plane of both", ["x", "y"]).equal_axes();
    for (mode, color) in modes.iter().zip([BLUE, RED]) {
        for orbit in mode.orbits().iter().filter(|orbit| orbit.energy() < 30.0).step_by(8) {
            let path = orbit.system.motion(orbit.start).to(orbit.period)?;
            let at = |k: i32| path.at(orbit.period * (f64::from(k) / 200.0));
            let points: Points = (0..=200)
                .filter_map(|k| at(k).ok())
                .map(|sample| (sample.state().q[0], sample.state().q[1]))
                .collect();
            chart.line(points, color);
        }
    }
    chart.draw(&panels[1])?;
    root.present()?;
    Ok(())
}
