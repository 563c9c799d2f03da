//! A rope of rigid links that is let go at one end falls and swings: a chain of any number of constraints, with a multiplier for each.
//!
//! `cargo run --release --example rope -- 200` takes 200 links. Each evaluation of the forces takes a time in proportion to their number.

mod picture;

use lagrange_core::nalgebra::Dyn;
use lagrange_core::{generic, prelude::*};
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::style::Color;

type State = generic::State<f64, Dyn>;

/// Masses on links of equal length, the first below a nail.
#[derive(Lagrangian)]
#[coordinates(r: [n, 2])]
#[lagrangian(sum(i in 0..n, m/2*dot(r_dot[i], r_dot[i]) - m*g*r[i][1]))]
#[constraint(link[0]: norm(r[0]) = l)]
#[constraint(link[i in 1..n]: norm(r[i] - r[i-1]) = l)]
struct Rope {
    n: usize,
    m: f64,
    g: f64,
    l: f64,
}

/// Masses from the nail to the end.
fn thread(rope: &Rope, state: &State) -> Points {
    let masses = (0..rope.n).map(|i| (state.q[2 * i], state.q[2 * i + 1]));
    core::iter::once((0.0, 0.0)).chain(masses).collect()
}

/// Largest deviation of a link from its length.
fn stretch(rope: &Rope, state: &State) -> f64 {
    let points = thread(rope, state);
    let length = |pair: &[(f64, f64)]| (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1);
    points.windows(2).map(|pair| (length(pair) / rope.l - 1.0).abs()).fold(0.0, f64::max)
}

fn main() -> Result<()> {
    println!("{}", Rope::equations());
    let n = std::env::args().nth(1).map_or(Ok(40), |n| n.parse::<usize>())?.max(2);
    // A rope of 1 m and 1 kg, held straight, just below the height of the nail.
    let rope = Rope { n, m: 1.0 / n as f64, g: 9.81, l: 1.0 / n as f64 };
    let (right, down) = (0.995, (1.0_f64 - 0.995 * 0.995).sqrt());
    let start = rope.at_rest((1..=n).flat_map(|i| [right, -down].map(|part| part * i as f64 * rope.l)));
    let energy = rope.energy(&start);

    let path = rope.motion(start).every(0.01).to(1.2)?;
    let samples = path.samples();
    let drift = samples.iter().map(|state| (rope.energy(state) - energy).abs()).fold(0.0, f64::max);
    let off = samples.iter().map(|state| stretch(&rope, state)).fold(0.0, f64::max);
    println!("{n} links, {} steps", path.statistics().accepted);
    println!("energy within {drift:.1e} J, lengths of the links within {off:.1e}");
    draw(&rope, samples)
}

fn draw(rope: &Rope, samples: &[State]) -> Result<()> {
    let file = picture::path("rope")?;
    let root = picture::sheet(&file, (1100, 550))?;
    let panels = root.split_evenly((1, 2));
    let mut chart = Panel::new("every 0.1 s", ["m", "m"]).within([-1.1..1.1, -1.1..0.2]).equal_axes();
    for state in samples.iter().step_by(10) {
        chart.line(thread(rope, state), BLUE.mix(0.4 + 0.5 * state.t).stroke_width(1));
    }
    chart.draw(&panels[0])?;
    // A link that pulls has a negative multiplier: its force shortens it.
    let mut pulls = Vec::new();
    for state in samples {
        pulls.push((state.t, -rope.multipliers(state)?[0] / rope.g));
    }
    let speed = |state: &State| state.v[2 * rope.n - 2].hypot(state.v[2 * rope.n - 1]);
    let mut chart = Panel::new("at its ends", ["t / s", ""]);
    chart.curve("pull on the nail / weight", RED, &pulls);
    let speeds: Points = samples.iter().map(|state| (state.t, speed(state))).collect();
    chart.curve("speed of the free end / (m/s)", GREY, &speeds);
    chart.draw(&panels[1])?;
    root.present()?;
    println!("picture: {}", file.display());
    Ok(())
}
