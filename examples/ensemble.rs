//! When does a double pendulum flip? 14,400 of them, let go at rest from a grid of angles, on SIMD lanes.
//!
//! A rod has flipped when the lower angle has left (−π, π). Where 3 cos a + cos b > 2 (equal masses and lengths) the
//! energy does not suffice, and no motion of any length may flip; and the mirror image of a motion is one.

mod picture;

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::time::Instant;

use lagrange_core::ensemble::{Member, Outcome};
use lagrange_core::{Ending, nalgebra::Const, prelude::*};
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

#[derive(Lagrangian, Clone, Copy)]
#[coordinates(a, b)]
#[define(v2_upper = l^2*a_dot^2)]
#[define(v2_lower = l^2*(a_dot^2 + b_dot^2 + 2*a_dot*b_dot*cos(a - b)))]
#[lagrangian(m/2*(v2_upper + v2_lower) + m*g*l*(2*cos(a) + cos(b)))]
struct DoublePendulum<T> {
    m: T,
    l: T,
    g: T,
}

const PENDULUM: DoublePendulum<f64> = DoublePendulum { m: 1.0, l: 1.0, g: 9.81 };
/// Angles in each direction.
const SIDE: usize = 120;
/// In seconds.
const END: f64 = 10.0;

/// The angles of a member: the grid covers (−π, π)² and is its own mirror image.
fn angles(index: usize) -> [f64; 2] {
    [index % SIDE, index / SIDE].map(|k| ((2 * k + 1) as f64 - SIDE as f64) / SIDE as f64 * PI)
}

fn main() -> Result<()> {
    let started = Instant::now();
    let mut quarters = 0;
    let outcome = Ensemble::from_fn(SIDE * SIDE, |index| (PENDULUM, State::at_rest(angles(index))))
        .observe(|_, state| match state.q[1].abs() > PI {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        })
        .on_progress(|progress| {
            if 4 * progress.done / progress.of > quarters {
                quarters += 1;
                println!("{:6} of {} members", progress.done, progress.of);
            }
            ControlFlow::Continue(())
        })
        .integrate_on_lanes(END, Dop853::with_tolerance(1e-8))?;
    let seconds = started.elapsed().as_secs_f64();
    report(&outcome, seconds);
    let file = picture::path("ensemble")?;
    draw(&outcome, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

/// When the member flipped, to a step.
fn flip(member: &Member<f64, Const<2>>) -> Option<f64> {
    match member.arrival()?.ending {
        Ending::Cancelled { time } => Some(time),
        _ => None,
    }
}

/// Whether the energy suffices to raise the lower rod.
fn may_flip([a, b]: [f64; 2]) -> bool {
    3.0 * a.cos() + b.cos() <= 2.0
}

fn report(outcome: &Outcome<f64, Const<2>>, seconds: f64) {
    let members = outcome.members();
    let flipped = members.iter().filter(|member| flip(member).is_some());
    let forbidden = flipped.clone().filter(|member| !may_flip(angles(member.index))).count();
    let differ = |(member, mirrored): &(&Member<f64, Const<2>>, &Member<f64, Const<2>>)| {
        flip(member) != flip(mirrored)
    };
    let asymmetric = members.iter().zip(members.iter().rev()).filter(differ).count();
    let drift = members.iter().filter_map(|member| {
        let state = member.arrival()?.state;
        Some((PENDULUM.energy(&state) - PENDULUM.energy(&State::at_rest(angles(member.index)))).abs())
    });
    println!("\n{} members, {} failures, {seconds:.2} s", members.len(), outcome.failures().count());
    println!("flipped within {END} s: {}", flipped.count());
    println!("  of these where 3 cos a + cos b > 2:  {forbidden}");
    println!("  not when their mirror images do:     {asymmetric}");
    println!("largest change of the energy:          {:.1e} J", drift.fold(0.0, f64::max));
}

fn draw(outcome: &Outcome<f64, Const<2>>, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1500, 750))?;
    let (left, right) = root.split_horizontally(picture::px(750));
    draw_map(outcome, &left)?;
    draw_decay(outcome, &right)?;
    root.present()?;
    Ok(())
}

/// Each member as a square, the darker the later it flips.
fn draw_map(outcome: &Outcome<f64, Const<2>>, area: &picture::Area) -> Result<()> {
    let mut chart = Panel::new(
        "Let go at rest: when it flips; white not in 10 s",
        ["upper angle a in rad", "lower angle b in rad"],
    )
    .equal_axes();
    // A little larger, or there would be seams.
    let half = 1.04 * PI / SIDE as f64;
    for member in outcome.members() {
        if let ([a, b], Some(t)) = (angles(member.index), flip(member)) {
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            chart.face(corners.map(|(x, y)| (a + half * x, b + half * y)), late(t));
        }
    }
    chart.colour_bar("flips at, in s", 0.0..END, late);
    let (mut upper, mut lower) = (Points::new(), Points::new());
    for k in -500..=500 {
        let a = f64::from(k) / 500.0 * (1.0_f64 / 3.0).acos();
        let b = (2.0 - 3.0 * a.cos()).clamp(-1.0, 1.0).acos();
        upper.push((a, b));
        lower.push((a, -b));
    }
    chart.curve(
        "no flip inside: 3 cos a + cos b > 2",
        RED,
        &upper.into_iter().chain(lower.into_iter().rev()).collect(),
    );
    chart.draw(area)
}

/// The darker the later.
fn late(t: f64) -> RGBAColor {
    let part = t / END;
    HSLColor(0.62 - 0.5 * (1.0 - part), 0.7, 0.75 - 0.55 * part).to_rgba()
}

/// How many have not flipped yet.
fn draw_decay(outcome: &Outcome<f64, Const<2>>, area: &picture::Area) -> Result<()> {
    let able: Vec<_> = outcome.members().iter().filter(|member| may_flip(angles(member.index))).collect();
    let left = |t: f64| able.iter().filter(|member| flip(member).is_none_or(|flip| flip > t)).count();
    let share: Points = (0..=400)
        .map(|k| f64::from(k) / 400.0 * END)
        .map(|t| (t, left(t) as f64 / able.len() as f64))
        .collect();
    let none: Points = vec![(0.0, 0.0), (END, 0.0)];
    let mut chart = Panel::new("Those with the energy to flip", ["t in s", "share that has not flipped"]);
    chart.curve("not flipped", BLUE, &share);
    chart.curve("none left", GREY, &none);
    chart.dots("at the end", RED, &share[400..].to_vec());
    chart.draw(area)
}
