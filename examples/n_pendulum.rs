//! Chains of 2, 5, 10 and 20 links that fall from the horizontal, by Taylor's method and by Dop853.
//!
//! The Lagrangian names the velocities of the links one from the other, so that a step costs as much as the chain is long. The
//! matrix of the equations is factored once a step; each order of the series is one back-substitution.

mod picture;

use std::f64::consts::FRAC_PI_2;
use std::time::Instant;

use lagrange_core::nalgebra::SVector;
use lagrange_core::{Method, StateOf, TaylorSeries, generic::Array, prelude::*};
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

const G: f64 = 9.81;
/// In seconds.
const END: f64 = 5.0;

/// A chain of so many links in angles from the vertical, each with its mass at its lower end; 1 m and 1 kg in all.
macro_rules! chain {
    ($name:ident, $links:literal) => {
        #[derive(Lagrangian, Clone, Copy)]
        #[coordinates(theta: [$links])]
        #[define(vx[0] = l*cos(theta[0])*theta_dot[0])]
        #[define(vx[i in 1..$links] = vx[i-1] + l*cos(theta[i])*theta_dot[i])]
        #[define(y[0] = -l*cos(theta[0]))]
        #[define(y[i in 1..$links] = y[i-1] - l*cos(theta[i]))]
        #[lagrangian(sum(i in 0..$links, l/2*(vx[i]^2 + der(y[i])^2) - l*g*y[i]))]
        struct $name {
            l: f64,
            g: f64,
        }

        impl $name {
            const CHAIN: Self = Self { l: 1.0 / $links as f64, g: G };
        }
    };
}

chain!(Two, 2);
chain!(Five, 5);
chain!(Ten, 10);
chain!(Twenty, 20);

type Path<'a> = Trajectory<&'a Twenty>;

fn main() -> Result<()> {
    println!(
        "Chains of 1 m and 1 kg, let go from the horizontal, to t = {END} s. Hanging they have 5 to 7 J less.\n"
    );
    println!(
        "{:>5} {:<14} {:>6} {:>10} {:>8} {:>11}",
        "links", "method", "steps", "µs a step", "ms", "energy off"
    );
    compare(Two::CHAIN)?;
    compare(Five::CHAIN)?;
    compare(Ten::CHAIN)?;
    compare(Twenty::CHAIN)?;
    let path = Twenty::CHAIN;
    let path = path.integrate(State::at_rest([FRAC_PI_2; 20]), END, Taylor::default())?;
    let off = path.drift().iter().map(|deviation| deviation.largest).fold(0.0, f64::max);
    assert!(off < 1e-12, "{off:e}");
    let file = picture::path("n_pendulum")?;
    draw(&path, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

/// Taylor's method to round-off, and `Dop853` as exactly as it can and a little less so.
fn compare<L>(chain: L) -> Result<()>
where
    L: TaylorSeries<Scalar = f64> + Copy,
    Dop853: Method<L>,
{
    measure(chain, "Taylor", Taylor::default())?;
    measure(chain, "Dop853 1e-12", Dop853::with_tolerance(1e-12))?;
    measure(chain, "Dop853 1e-15", Dop853::with_tolerance(1e-15))
}

/// The least time of some runs, in which nothing is stored.
fn measure<L, P>(chain: L, name: &str, method: P) -> Result<()>
where
    L: Lagrangian<Scalar = f64> + Copy,
    P: Method<L> + Copy,
{
    let start = StateOf::<L>::at_rest(Array::filled(FRAC_PI_2));
    let (mut best, mut motion) = (f64::INFINITY, Motion::new(chain, start, method)?);
    for _ in 0..5 {
        motion = Motion::new(chain, start, method)?;
        let begun = Instant::now();
        motion.advance_to(END)?;
        best = best.min(1e6 * begun.elapsed().as_secs_f64());
    }
    let (n, steps) = (L::COORDINATES.len(), motion.statistics().accepted);
    let energy = (chain.energy(motion.state()) - chain.energy(&start)).abs();
    println!("{n:5} {name:<14} {steps:6} {:10.2} {:8.2} {energy:9.0e} J", best / steps as f64, best / 1e3);
    Ok(())
}

fn draw(path: &Path<'_>, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1150, 560))?;
    let (left, right) = root.split_horizontally(picture::px(560));
    draw_fall(path, &left)?;
    let right = right.split_evenly((2, 1));
    draw_tip(path, &right[0])?;
    draw_energy(path, &right[1])?;
    root.present()?;
    Ok(())
}

/// The chain, from where it hangs.
fn joints(angles: &SVector<f64, 20>) -> Points {
    let mut at = (0.0, 0.0);
    let next = angles.iter().map(|angle| {
        at = (at.0 + angle.sin() / 20.0, at.1 - angle.cos() / 20.0);
        at
    });
    std::iter::once((0.0, 0.0)).chain(next).collect()
}

fn draw_fall(path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let shape = |t: f64| -> Result<Points> { Ok(joints(&path.at(t)?.state().q)) };
    let times: Vec<f64> = (0..=14).map(|k| 0.08 * f64::from(k)).collect();
    let shapes: Vec<Points> = times.iter().map(|&t| shape(t)).collect::<Result<_>>()?;
    let title = "20 links every 0.08 s, to t = 1.12 s";
    let mut chart = Panel::new(title, ["x in m", "y in m"]).equal_axes();
    for (points, k) in shapes.iter().zip(0_u32..) {
        let color = BLUE.mix(0.25 + 0.05 * f64::from(k));
        chart.line(points.iter().copied(), color.stroke_width(2));
    }
    let tips = shapes.iter().filter_map(|points| points.last().copied()).collect();
    chart.dots("tip", RED, &tips);
    chart.draw(area)
}

fn draw_tip(path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let mut speeds = Points::new();
    for sample in path.samples(1500) {
        let State { q, v, t } = *sample.state();
        let along = |part: fn(f64) -> f64| q.iter().zip(&v).map(|(q, v)| part(*q) * v / 20.0).sum::<f64>();
        speeds.push((t, along(f64::cos).hypot(along(f64::sin))));
    }
    let mut chart = Panel::new("The tip", ["t in s", "speed in m/s"]);
    chart.curve("speed", GREY, &speeds);
    chart.draw(area)
}

fn draw_energy(path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let before = path.start().energy();
    let drift = path.steps().map(|sample| (sample.time(), 1e15 * (sample.energy() - before))).collect();
    let mut chart = Panel::new("Energy gained", ["t in s", "in 10⁻¹⁵ J"]);
    chart.curve("energy", BLUE, &drift);
    chart.draw(area)
}
