//! A cluster of stars falls together, and settles as a smaller one: any number of bodies, each of which attracts all others.
//!
//! `cargo run --release --example cluster -- 500` takes 500 stars; their number is that of the masses. G, the mass of the cluster and its first
//! radius are 1. The attraction is softened within the distance ε, as is usual (S. J. Aarseth, *Gravitational N-Body Simulations*, 2003). The
//! derive finds that momentum, angular momentum and energy are conserved, whatever the number is.

mod picture;

use std::f64::consts::TAU;

use lagrange_core::nalgebra::Dyn;
use lagrange_core::{generic, prelude::*};
use picture::{BLUE, GREY, Panel, RED, Result};

type State = generic::State<f64, Dyn>;

/// Stars that attract one another.
#[derive(Lagrangian)]
#[coordinates(r: [n, 3])]
#[parameter(m: [n])]
#[define(T = sum(i in 0..n, m[i]/2*dot(r_dot[i], r_dot[i])))]
#[define(U = -sum(i in 0..n, sum(j in 0..i, m[i]*m[j]/sqrt(dot(r[i] - r[j], r[i] - r[j]) + epsilon^2))))]
#[lagrangian(T - U)]
#[observable(kinetic = T; half_of_attraction = -U/2)]
struct Cluster {
    m: Vec<f64>,
    epsilon: f64,
}

/// Evenly filled sphere, which turns about z at two thirds of the rate at which it would be in balance.
fn start(cluster: &Cluster) -> State {
    let place = |i: usize| {
        // M. Roberts's sequence R₃: fractions of multiples of powers of one irrational number.
        let [radius, height, angle] =
            [0.819_172_5, 0.671_043_6, 0.549_700_5].map(|a| (0.5 + a * i as f64).fract());
        let (radius, z) = (radius.cbrt(), 1.0 - 2.0 * height);
        let across = radius * (1.0 - z * z).sqrt();
        [across * (TAU * angle).cos(), across * (TAU * angle).sin(), radius * z]
    };
    let places: Vec<[f64; 3]> = (0..cluster.m.len()).map(place).collect();
    let turning = places.iter().flat_map(|[x, y, _]| [-2.0 / 3.0 * y, 2.0 / 3.0 * x, 0.0]);
    cluster.state(places.as_flattened().iter().copied(), turning)
}

fn main() -> Result<()> {
    println!("{}", Cluster::equations());
    let n = std::env::args().nth(1).map_or(Ok(200), |n| n.parse::<usize>())?.max(2);
    let cluster = Cluster { m: vec![1.0 / n as f64; n], epsilon: 0.05 };
    let end = 8.0;
    let path = cluster.motion(start(&cluster)).by(Dop853::with_tolerance(1e-9)).every(end / 300.0).to(end)?;
    println!("{n} stars, {} steps until t = {end}", path.statistics().accepted);
    print_changes(&cluster, path.samples());
    draw(&cluster, path.samples())
}

/// Prints the largest changes of what is conserved.
fn print_changes(cluster: &Cluster, samples: &[State]) {
    let first = &samples[0];
    let most = |change: &dyn Fn(&State) -> f64| samples.iter().map(change).fold(0.0, f64::max);
    let (p, j) = (cluster.total_momentum(first), cluster.total_angular_momentum(first));
    let energy = cluster.energy(first);
    println!("largest changes of");
    println!("    P = {:.3}: {:.1e}", p.norm(), most(&|state| (cluster.total_momentum(state) - p).norm()));
    println!(
        "    J = {:.3}: {:.1e}",
        j.norm(),
        most(&|state| (cluster.total_angular_momentum(state) - j).norm())
    );
    println!("    E = {energy:.3}: {:.1e}", most(&|state| (cluster.energy(state) - energy).abs()));
}

fn draw(cluster: &Cluster, samples: &[State]) -> Result<()> {
    let file = picture::path("cluster")?;
    let root = picture::sheet(&file, (1350, 480))?;
    let panels = root.split_evenly((1, 3));
    for (area, state) in panels.iter().zip([&samples[0], &samples[samples.len() - 1]]) {
        let title = format!("t = {}", state.t);
        let mut chart = Panel::new(&title, ["x", "z"]).within([-1.5..1.5, -1.5..1.5]).equal_axes();
        let places = state.q.as_slice().as_chunks::<3>().0.iter().map(|[x, _, z]| (*x, *z));
        chart.specks(2, BLUE, places.filter(|(x, z)| x.abs().max(z.abs()) < 1.5));
        chart.draw(area)?;
    }
    let mut chart = Panel::new("it settles where T is |U|/2 (virial theorem)", ["t", "energy"]);
    let along = |value: &dyn Fn(&State) -> f64| samples.iter().map(|state| (state.t, value(state))).collect();
    chart.curve("T", RED, &along(&|state| cluster.kinetic(state)));
    chart.curve("|U|/2", GREY, &along(&|state| cluster.half_of_attraction(state)));
    chart.draw(&panels[2])?;
    root.present()?;
    println!("picture: {}", file.display());
    Ok(())
}
