//! A tower of ten blocks by time stepping: it stands, and a push brings it down.
//!
//! Each block touches the one below with two corners, so that there are twenty contacts with friction.

mod picture;

use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, RED, Result};
use plotters::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(x: [10], y: [10], theta: [10])]
#[define(corner_x(i, s) = x[i] + s*b*cos(theta[i]) + h*sin(theta[i]))]
#[define(corner_y(i, s) = y[i] + s*b*sin(theta[i]) - h*cos(theta[i]))]
#[define(along(i, s) = cos(theta[i])*(corner_x(i + 1, s) - x[i]) + sin(theta[i])*(corner_y(i + 1, s) - y[i]))]
#[define(above(i, s) = cos(theta[i])*(corner_y(i + 1, s) - y[i]) - sin(theta[i])*(corner_x(i + 1, s) - x[i]) - h)]
#[lagrangian(
    m/2 * (dot(x_dot, x_dot) + dot(y_dot, y_dot)) + m*(b^2 + h^2)/6 * dot(theta_dot, theta_dot)
    - m*g*sum(i in 0..10, y[i])
)]
#[contact(floor[k in 0..2]: corner_y(0, 2*k - 1) >= 0, friction(mu): der(corner_x(0, 2*k - 1)))]
#[contact(left[i in 0..9]: above(i, -1) >= 0, friction(mu): der(along(i, -1)))]
#[contact(right[i in 0..9]: above(i, 1) >= 0, friction(mu): der(along(i, 1)))]
struct Tower {
    m: f64,
    /// Half width and half height of a block.
    b: f64,
    h: f64,
    g: f64,
    mu: f64,
    floor: [Contact; 2],
    left: [Contact; 9],
    right: [Contact; 9],
}

const NINE: [Contact; 9] = [Contact::Open; 9];
const TOWER: Tower =
    Tower { m: 1.0, b: 0.5, h: 0.25, g: 9.81, mu: 0.5, floor: [Contact::Open; 2], left: NINE, right: NINE };

type Path = Trajectory<Tower>;

fn main() -> Result<()> {
    let mut start = State::at_rest([0.0; 30]);
    (0..10).for_each(|i| start.q[10 + i] = TOWER.h * (2 * i + 1) as f64);
    let stands = TOWER.motion(start).by_time_stepping(MoreauJean::with_step(0.05)).to(20.0)?;
    let moved = stands.steps().map(|step| (step.state().q - start.q).amax()).fold(0.0, f64::max);
    println!("{stands}\nit has moved by {moved:.0e} m");
    let carried = stands.end().multiplier("floor[0]")? + stands.end().multiplier("floor[1]")?;
    println!("the floor carries {carried:.6} N, ten blocks weigh {:.6} N\n", 10.0 * TOWER.m * TOWER.g);
    // Pushed, it turns about its lower right edge.
    for i in 0..10 {
        (start.v[i], start.v[10 + i], start.v[20 + i]) = (PUSH * start.q[10 + i], PUSH * TOWER.b, -PUSH);
    }
    let falls = TOWER.motion(start).by_time_stepping(MoreauJean::with_step(4e-3)).to(FALL)?;
    println!("{falls}");
    for step in falls.steps().step_by(50) {
        let (angle, energy) = (-step.state().q[29].to_degrees(), step.energy());
        println!("t = {:.1} s: its top has turned by {angle:5.1}°, energy {energy:.3} J", step.time());
    }
    let file = picture::path("block_tower")?;
    draw(&stands, &falls, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

/// How fast it is pushed, in 1/s, and when it is drawn.
const PUSH: f64 = 0.7;
const FALL: f64 = 1.2;

fn draw(stands: &Path, falls: &Path, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 520))?;
    let panels = root.split_evenly((1, 2));
    draw_tower("It stands for 20 s", stands.end().state(), &panels[0])?;
    draw_tower(&format!("Pushed, after {FALL} s"), falls.end().state(), &panels[1])?;
    root.present()?;
    Ok(())
}

fn draw_tower(title: &str, state: &State<f64, 30>, area: &picture::Area) -> Result<()> {
    let mut chart = Panel::new(title, ["x in m", "y in m"]).within([-1.0..5.0, -0.3..5.3]).equal_axes();
    chart.line([(-5.0, 0.0), (9.0, 0.0)], GREY.stroke_width(2));
    for i in 0..10 {
        let (x, y, (sine, cosine)) = (state.q[i], state.q[10 + i], state.q[20 + i].sin_cos());
        let corner = |(s, w): (f64, f64)| {
            (x + s * TOWER.b * cosine - w * TOWER.h * sine, y + s * TOWER.b * sine + w * TOWER.h * cosine)
        };
        let around = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)].map(corner);
        let color = if i % 2 == 0 { BLUE } else { RED };
        chart.face(around, color.mix(0.3));
        chart.line(around, color.stroke_width(2));
    }
    chart.draw(area)
}
