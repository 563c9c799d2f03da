//! A net that hangs by ropes at its corners falls, swings and comes to rest: a lattice of any number of masses with springs between neighbours.
//!
//! `cargo run --release --example net -- 50` takes 50 × 50 masses. A table says which knots hang by which posts. At rest the ropes carry the
//! weight of the net.

mod picture;

use lagrange_core::nalgebra::Dyn;
use lagrange_core::{generic, prelude::*};
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::style::Color;

type State = generic::State<f64, Dyn>;

/// Masses in a lattice, with springs to their neighbours, and ropes, springs too, from knots to posts.
#[derive(Lagrangian)]
#[coordinates(r: [rows, columns, 3])]
#[parameter(knot: [ropes, 2]; post: [ropes, 3])]
#[define(U(d) = k/2*(norm(d) - l)^2)]
#[define(pull(d) = k*(1 - l/norm(d))*d)]
#[define(rope[p in 0..ropes] = post[p] - r[knot[p][0]][knot[p][1]])]
#[lagrangian(sum(i in 0..rows, sum(j in 0..columns, m/2*dot(r_dot[i][j], r_dot[i][j]) - m*g*r[i][j][2]))
    - sum(i in 0..rows-1, sum(j in 0..columns, U(r[i+1][j] - r[i][j])))
    - sum(i in 0..rows, sum(j in 0..columns-1, U(r[i][j+1] - r[i][j])))
    - sum(p in 0..ropes, U(rope[p])))]
#[dissipation(c/2*sum(i in 0..rows, sum(j in 0..columns, dot(r_dot[i][j], r_dot[i][j]))))]
#[observable(carried = sum(p in 0..ropes, pull(rope[p]))[2]; weight = rows*columns*m*g)]
struct Net {
    rows: usize,
    columns: usize,
    knot: Vec<[usize; 2]>,
    post: Vec<[f64; 3]>,
    m: f64,
    k: f64,
    l: f64,
    c: f64,
    g: f64,
}

/// Square net of side 1 m and mass 1 kg between the tops of four posts.
fn net(n: usize) -> Net {
    let (l, mass) = (1.0 / (n + 1) as f64, 1.0 / (n * n) as f64);
    let corners = [[0, 0], [0, n - 1], [n - 1, 0], [n - 1, n - 1]];
    let top = |corner: [usize; 2]| {
        let [x, y] = corner.map(|index| if index == 0 { 0.0 } else { 1.0 });
        [x, y, 0.0]
    };
    Net {
        rows: n,
        columns: n,
        post: corners.map(top).to_vec(),
        knot: corners.to_vec(),
        m: mass,
        k: 300.0,
        l,
        c: 3.0 * mass,
        g: 9.81,
    }
}

/// Rows and columns of the net, seen from the side and above; posts are the corners of the unit square.
fn threads(net: &Net, state: &State) -> Vec<Points> {
    let seen = |i: usize, j: usize| {
        let at = 3 * (i * net.columns + j);
        let [x, y, z] = [0, 1, 2].map(|component| state.q[at + component]);
        (x + 0.45 * y, z + 0.3 * y)
    };
    let rows = (0..net.rows).map(|i| (0..net.columns).map(|j| seen(i, j)).collect());
    let columns = (0..net.columns).map(|j| (0..net.rows).map(|i| seen(i, j)).collect());
    rows.chain(columns).collect()
}

fn main() -> Result<()> {
    println!("{}", Net::equations());
    let n = std::env::args().nth(1).map_or(Ok(30), |n| n.parse::<usize>())?.max(2);
    let net = net(n);
    let place = |k: usize| (k + 1) as f64 * net.l;
    let flat = (0..n).flat_map(|i| (0..n).flat_map(move |j| [place(i), place(j), 0.0]));
    let end = 8.0;
    let path = net.motion(net.at_rest(flat)).every(0.02).to(end)?;
    let samples = path.samples();
    let (last, weight) = (&samples[samples.len() - 1], net.weight(&samples[0]));
    println!("{n} × {n} masses, {} steps", path.statistics().accepted);
    println!("at t = {end} s the ropes carry {:.6} of the weight", net.carried(last) / weight);
    draw(&net, samples)
}

fn draw(net: &Net, samples: &[State]) -> Result<()> {
    let file = picture::path("net")?;
    let root = picture::sheet(&file, (1100, 900))?;
    let panels = root.split_evenly((2, 2));
    for (area, state) in panels.iter().zip([&samples[10], &samples[20], &samples[samples.len() - 1]]) {
        let title = format!("t = {:.1} s", state.t);
        let mut chart = Panel::new(&title, ["", "m"]).within([-0.1..1.6, -0.9..0.5]).equal_axes();
        threads(net, state).into_iter().for_each(|thread| chart.line(thread, BLUE.stroke_width(1)));
        chart.draw(area)?;
    }
    let middle = 3 * (net.rows / 2 * net.columns + net.columns / 2) + 2;
    let along = |value: &dyn Fn(&State) -> f64| samples.iter().map(|state| (state.t, value(state))).collect();
    let mut chart = Panel::new("how it comes to rest", ["t / s", ""]);
    chart.curve("force of the ropes / weight", RED, &along(&|state| net.carried(state) / net.weight(state)));
    chart.curve("height of the middle / m", GREY, &along(&|state| state.q[middle]));
    chart.draw(&panels[3])?;
    root.present()?;
    println!("picture: {}", file.display());
    Ok(())
}
