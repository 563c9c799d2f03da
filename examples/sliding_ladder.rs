//! A ladder that slides down a smooth wall leaves it before it is down: the push of the wall is a multiplier, and where it
//! falls through zero the motion goes on with the system that has no wall.
//!
//! From rest at the angle θ₀ to the floor it leaves where sin θ = 2/3 sin θ₀, whatever its length and mass.

mod picture;

use lagrange_core::{HybridTrajectory, prelude::*, trajectory::Named};
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

/// Between wall and floor; x and y are its middle, 2a its length.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[define(inertia = m*a^2/3)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + inertia/2 * theta_dot^2 - m*g*y)]
#[constraint(floor: y - a*sin(theta) = 0)]
#[constraint(wall: x - a*cos(theta) = 0)]
struct Leaning {
    m: f64,
    a: f64,
    g: f64,
}

/// On the floor alone.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[define(inertia = m*a^2/3)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + inertia/2 * theta_dot^2 - m*g*y)]
#[constraint(floor: y - a*sin(theta) = 0)]
struct Sliding {
    m: f64,
    a: f64,
    g: f64,
}

const LEANING: Leaning = Leaning { m: 12.0, a: 2.0, g: 9.81 };
const SLIDING: Sliding = Sliding { m: LEANING.m, a: LEANING.a, g: LEANING.g };

fn main() -> Result<()> {
    println!("A ladder of {} m and {} kg, from rest\n", 2.0 * LEANING.a, LEANING.m);
    println!("{:>8} {:>12} {:>16} {:>10} {:>10}", "θ₀/rad", "leaves at/s", "θ/rad", "error", "down at/s");
    for start in [0.4, 0.8, 1.2, 1.5] {
        let trajectory = fall(start)?;
        let leg = trajectory.leg::<Trajectory<Leaning>>(0).ok_or("the first leg")?;
        let angle = leg.end().coordinate("theta")?;
        let error = angle - (2.0 / 3.0 * start.sin()).asin();
        let (left, down) = (leg.end().time(), trajectory.end_time());
        println!("{start:8.1} {left:12.6} {angle:16.12} {error:10.0e} {down:10.6}");
    }
    let trajectory = fall(1.3)?;
    println!("\nfrom 1.3 rad: {}", trajectory.ending().ok_or("no leg")?);
    let energy = |sample: Box<dyn Named<f64> + '_>| sample.energy();
    let start = energy(trajectory.at(trajectory.start_time())?);
    let end = energy(trajectory.at(trajectory.end_time())?);
    println!("energy at the start and when it is down: {start:.10} J, {end:.10} J");
    let file = picture::path("sliding_ladder")?;
    draw(&trajectory, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

/// Down the wall, and away from it to the floor.
fn fall(theta: f64) -> Result<HybridTrajectory<f64>> {
    let method = Dop853::with_tolerance(1e-12);
    let start = State::at_rest([LEANING.a * theta.cos(), LEANING.a * theta.sin(), theta]);
    let mut leaves = LEANING.event("leaves", |sample| sample.multiplier("wall")).falling().terminal();
    let first = LEANING.motion(start).by(method).event(&mut leaves).to(100.0)?;
    let lies = SLIDING.event("lies", |sample| sample.coordinate("theta")).falling().terminal();
    let second = SLIDING.motion(*first.end().state()).by(method).event(lies).to(100.0)?;
    let mut trajectory = HybridTrajectory::new();
    trajectory.push(first.into_owned())?;
    trajectory.push(second.into_owned())?;
    Ok(trajectory)
}

fn draw(trajectory: &HybridTrajectory<f64>, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 900))?;
    let panels = root.split_evenly((2, 2));
    draw_poses(trajectory, &panels[0])?;
    let left = trajectory.legs().next().ok_or("no leg")?.end_time();
    let [mut theta, mut floor, mut wall, mut x] = [const { Points::new() }; 4];
    for sample in trajectory.samples(600) {
        let (sample, weight) = (sample?, LEANING.m * LEANING.g);
        let t = sample.time();
        theta.push((t, sample.coordinate("theta")?));
        floor.push((t, sample.multiplier("floor")? / weight));
        // Who has no wall cannot tell its push.
        wall.push((t, sample.multiplier("wall").unwrap_or(0.0) / weight));
        x.push((t, sample.velocity("x")?));
    }
    let title = "Pushes: the ladder leaves the wall where that is zero";
    let mut chart = Panel::new(title, ["t in s", "part of the weight"]);
    chart.curve("floor", BLUE, &floor);
    chart.curve("wall", RED, &wall);
    chart.dots("it leaves", GREY, &vec![(left, 0.0)]);
    chart.draw(&panels[1])?;
    let mut chart = Panel::new("Angle", ["t in s", "θ in rad"]);
    chart.curve("θ", BLUE, &theta);
    chart.draw(&panels[2])?;
    let title = "Speed of its middle: even, once it is free";
    let mut chart = Panel::new(title, ["t in s", "ẋ in m/s"]);
    chart.curve("ẋ", BLUE, &x);
    chart.draw(&panels[3])?;
    root.present()?;
    Ok(())
}

/// At times that are evenly spaced: leaning in blue, free in red.
fn draw_poses(trajectory: &HybridTrajectory<f64>, area: &picture::Area) -> Result<()> {
    let mut chart = Panel::new("On its way down", ["x in m", "y in m"]).equal_axes();
    let corner = vec![(0.0, 4.0), (0.0, 0.0), (6.4, 0.0)];
    chart.curve("wall and floor", GREY, &corner);
    for sample in trajectory.samples(25) {
        let sample = sample?;
        let (x, theta) = (sample.coordinate("x")?, sample.coordinate("theta")?);
        let color = if sample.multiplier("wall").is_ok() { BLUE } else { RED };
        let (sine, cosine) = theta.sin_cos();
        let [top, foot] =
            [-1.0, 1.0].map(|end| (x + end * LEANING.a * cosine, LEANING.a * (1.0 - end) * sine));
        chart.line([top, foot], color.stroke_width(2));
    }
    chart.draw(area)
}
