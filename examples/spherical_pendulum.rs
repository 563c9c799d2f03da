//! A bob on a string of length l, in Cartesian coordinates, the string as a constraint: Milton (8.11)–(8.22).
//!
//! The multiplier λ of Φ = ½(x² + y² + z² − l²) is the force of the string for each unit of length: the
//! force on the bob is λ r, so the tension is −λ l.

mod picture;

use std::f64::consts::TAU;

use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};

#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
#[constraint(string: (x^2 + y^2 + z^2 - l^2)/2 = 0)]
#[observable(tension = -lambda(string) * l)]
#[observable(energy_sum = m/2 * (x_dot^2 + y_dot^2 + z_dot^2) + m*g*z)]
#[observable(l_z = m * (x*y_dot - y*x_dot))]
struct SphericalPendulum {
    m: f64,
    g: f64,
    l: f64,
}

type Path<'a> = Trajectory<&'a SphericalPendulum>;

fn main() -> Result<()> {
    let pendulum = SphericalPendulum { m: 1.0, g: 9.81, l: 1.0 };
    // 60° from the vertical, pushed sideways.
    let start = pendulum.state_from(&[("x", 0.75_f64.sqrt()), ("z", -0.5), ("y_dot", 1.3)])?;
    let path = pendulum.integrate(start, 100.0, Dop853::with_tolerance(1e-12))?;

    println!("Spherical pendulum: m r̈ = −m g e_z + λ r,  ½(r² − l²) = 0   (Milton 8.14)");
    println!("m = {} kg, g = {} m/s², l = {} m\n", pendulum.m, pendulum.g, pendulum.l);
    table(&path)?;
    println!("\n{}, after {} steps\n", path.ending(), path.statistics().accepted);
    checks(&pendulum, &path)?;
    let file = picture::path("spherical_pendulum")?;
    draw(&pendulum, &path, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

fn table(path: &Path<'_>) -> Result<()> {
    println!("{:>6} {:>9} {:>9} {:>9} {:>11} {:>11}", "t/s", "x/m", "y/m", "z/m", "speed m/s", "tension/N");
    for sample in path.samples(11) {
        let s = sample.state();
        let tension = sample.observable("tension")?;
        println!(
            "{:6.1} {:9.5} {:9.5} {:9.5} {:11.5} {tension:11.5}",
            s.t,
            s.q[0],
            s.q[1],
            s.q[2],
            s.v.norm()
        );
    }
    Ok(())
}

/// The laws that the motion must obey, beside what the integrated motion does over all steps.
fn checks(pendulum: &SphericalPendulum, path: &Path<'_>) -> Result<()> {
    let start = *path.start().state();
    let (energy, l_z) = (pendulum.energy_sum(&start), pendulum.l_z(&start));
    let mut worst = [0.0_f64; 5];
    for sample in path.steps() {
        let s = sample.state();
        let exact = exact_tension(pendulum, energy, s.q[2]);
        let deviations = [
            pendulum.constraint_residual(s)[0],
            pendulum.constraint_rate(s)[0],
            pendulum.energy_sum(s) - energy,
            pendulum.l_z(s) - l_z,
            sample.observable("tension")? - exact,
        ];
        for (worst, deviation) in worst.iter_mut().zip(deviations) {
            *worst = worst.max(deviation.abs());
        }
    }
    let laws = [
        "the string keeps its length:  ½(r² − l²) = 0",
        "and the bob moves across it:  r·ṙ = 0",
        "energy is conserved (8.17):   E = T + m g z",
        "so is L_z (8.15):             L_z = m (x ẏ − y ẋ)",
        "tension (8.22):               −λ l = (2E − 3 m g z)/l",
    ];
    println!("largest deviation at the {} steps, from the exact law", path.statistics().accepted);
    for (law, worst) in laws.into_iter().zip(worst) {
        println!("  {law:<56} {worst:8.1e}");
    }
    Ok(())
}

fn exact_tension(pendulum: &SphericalPendulum, energy: f64, z: f64) -> f64 {
    (2.0 * energy - 3.0 * pendulum.m * pendulum.g * z) / pendulum.l
}

fn draw(pendulum: &SphericalPendulum, path: &Path<'_>, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 950))?;
    let panels = root.split_evenly((2, 2));
    draw_from_above(path, &panels[0])?;
    draw_from_the_side(path, &panels[1])?;
    draw_tension(pendulum, path, &panels[2])?;
    draw_drift(pendulum, path, &panels[3])?;
    root.present()?;
    Ok(())
}

/// The first 12 seconds, finely.
fn moments<'p>(path: &'p Path<'_>) -> impl Iterator<Item = State<f64, 3>> + 'p {
    (0..=2400).filter_map(|k| path.at(f64::from(k) * 0.005).ok()).map(|sample| *sample.state())
}

fn draw_from_above(path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let bob: Points = moments(path).map(|s| (s.q[0], s.q[1])).collect();
    let circle: Points = (0..=120).map(|k| f64::from(k) * TAU / 120.0).map(|a| (a.cos(), a.sin())).collect();
    let mut chart = Panel::new("From above: the ellipse precesses (12 s)", ["x in m", "y in m"]).equal_axes();
    chart.curve("reach of the string", GREY, &circle);
    chart.curve("bob", BLUE, &bob);
    chart.dots("start", RED, &vec![bob[0]]);
    chart.dots("below the suspension", GREY, &vec![(0.0, 0.0)]);
    chart.draw(area)
}

fn draw_from_the_side(path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let bob: Points = moments(path).map(|s| (s.q[0], s.q[2])).collect();
    let mut chart = Panel::new("From the side: between two heights", ["x in m", "z in m"]).equal_axes();
    chart.curve("bob", BLUE, &bob);
    chart.curve("string at the start", GREY, &vec![(0.0, 0.0), bob[0]]);
    chart.dots("start", RED, &vec![bob[0]]);
    chart.draw(area)
}

fn draw_tension(pendulum: &SphericalPendulum, path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let energy = pendulum.energy_sum(path.start().state());
    let states: Vec<_> = moments(path).take(1201).collect();
    let exact: Points = states.iter().map(|s| (s.t, exact_tension(pendulum, energy, s.q[2]))).collect();
    let mut multiplier = Points::new();
    for s in states.iter().step_by(40) {
        multiplier.push((s.t, path.at(s.t)?.observable("tension")?));
    }
    let mut chart =
        Panel::new("Tension: from the multiplier, and from the energy", ["t in s", "tension in N"]);
    chart.curve("(2E − 3 m g z)/l, Milton (8.22)", GREY, &exact);
    chart.dots("−λ l", RED, &multiplier);
    chart.draw(area)
}

fn draw_drift(pendulum: &SphericalPendulum, path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let start = *path.start().state();
    let drift = |quantity: fn(&SphericalPendulum, &State<f64, 3>) -> f64| -> Points {
        let initial = quantity(pendulum, &start);
        path.samples(2000)
            .map(|s| (s.time(), (quantity(pendulum, s.state()) / initial - 1.0) * 1e12))
            .collect()
    };
    let (energy, l_z) = (drift(SphericalPendulum::energy_sum), drift(SphericalPendulum::l_z));
    let mut chart = Panel::new("Conserved quantities over 100 s", ["t in s", "relative drift in 10⁻¹²"]);
    chart.curve("energy", BLUE, &energy);
    chart.curve("L_z", RED, &l_z);
    chart.draw(area)
}
