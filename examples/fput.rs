//! Fermi, Pasta, Ulam and Tsingou's chain of any number of masses: the energy that begins in the lowest mode comes back to it.
//!
//! `cargo run --release --example fput -- 64` takes 64 masses between two walls, at rest in the lowest mode, with springs of the force d + α d².
//! The number is known when the program runs: sums in the Lagrangian become loops. (E. Fermi, J. Pasta, S. Ulam and M. Tsingou,
//! *Studies of nonlinear problems I*, Los Alamos report LA-1940, 1955; α = 1/4, 32 masses, as in their figure 1.)

mod picture;

use std::f64::consts::PI;

use lagrange_core::motion::Composition;
use lagrange_core::nalgebra::{DVector, Dyn};
use lagrange_core::{generic, prelude::*};
use picture::{BLUE, GREY, Panel, RED, Result};

type State = generic::State<f64, Dyn>;

/// Unit masses between two walls, n of them, and n + 1 springs.
#[derive(Lagrangian)]
#[coordinates(x: [n])]
#[define(U(d) = d^2/2 + alpha*d^3/3)]
#[lagrangian(sum(i in 0..n, x_dot[i]^2/2) - sum(i in 0..n-1, U(x[i+1] - x[i])) - U(x[0]) - U(-x[n-1]))]
struct Chain {
    n: usize,
    alpha: f64,
}

impl Chain {
    /// Entry i of mode k, normalized.
    fn mode(&self, k: usize, i: usize) -> f64 {
        let n = (self.n + 1) as f64;
        (2.0 / n).sqrt() * (PI * (k * (i + 1)) as f64 / n).sin()
    }

    /// Energy of mode k of the linear chain.
    fn energy_of_mode(&self, k: usize, state: &State) -> f64 {
        let on_mode = |x: &DVector<f64>| (0..self.n).map(|i| self.mode(k, i) * x[i]).sum::<f64>();
        let frequency = 2.0 * (PI * k as f64 / (2 * (self.n + 1)) as f64).sin();
        (on_mode(&state.v).powi(2) + (frequency * on_mode(&state.q)).powi(2)) / 2.0
    }
}

fn main() -> Result<()> {
    println!("{}", Chain::equations());
    let n = std::env::args().nth(1).map_or(Ok(32), |n| n.parse::<usize>())?.max(2);
    let chain = Chain { n, alpha: 0.25 };
    // Amplitude 1, in the normalization of the report.
    let size = ((n + 1) as f64 / 2.0).sqrt();
    let start = chain.at_rest((0..n).map(|i| size * chain.mode(1, i)));
    let period = PI / (PI / (2 * (n + 1)) as f64).sin();
    let end = 170.0 * period;
    let method = Verlet::with_step(0.2).composed(Composition::KahanLi8).max_steps(10_000_000);
    let path = chain.motion(start.clone()).by(method).every(end / 800.0).to(end)?;
    let samples = path.samples();

    let energy = chain.energy(&start);
    let drift = samples.iter().map(|state| (chain.energy(state) / energy - 1.0).abs()).fold(0.0, f64::max);
    let lowest = |state: &State| chain.energy_of_mode(1, state) / energy;
    let back = samples.iter().skip(400).max_by(|a, b| lowest(a).total_cmp(&lowest(b)));
    println!(
        "{n} masses, {:.0} periods of the lowest mode; the energy is constant to {drift:.1e}",
        end / period
    );
    if let Some(state) = back {
        println!(
            "after {:.1} periods {:.1} % of it are in the lowest mode",
            state.t / period,
            100.0 * lowest(state)
        );
    }

    let file = picture::path("fput")?;
    let root = picture::sheet(&file, (900, 520))?;
    let mut chart = Panel::new("energy of the lowest modes", ["t / T₁", "part of the energy"]);
    for (k, color) in [(1, BLUE), (2, RED), (3, GREY)] {
        let points = samples.iter().map(|state| (state.t / period, chain.energy_of_mode(k, state) / energy));
        chart.curve(&format!("mode {k}"), color, &points.collect());
    }
    chart.draw(&root)?;
    root.present()?;
    println!("picture: {}", file.display());
    Ok(())
}
