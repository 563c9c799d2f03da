//! Halo orbits between Earth and Moon: from Lyapunov's orbits, where they leave the plane, down to the Moon.
//!
//! Jacobi's constant is −2 E. Where the family starts it is 3.174 351 954 078 1 for this ratio of masses, found independently with 20
//! digits. (K. C. Howell, *Celestial Mechanics* 32, 1984, 53–71.)

mod picture;

use lagrange_core::orbits::{BifurcationKind, Family, PeriodicOrbit};
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};

/// A small body in the frame that turns with Earth and Moon.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[define(earth = sqrt((x + mu)^2 + y^2 + z^2))]
#[define(moon = sqrt((x - 1 + mu)^2 + y^2 + z^2))]
#[lagrangian(((x_dot - y)^2 + (y_dot + x)^2 + z_dot^2)/2 + (1 - mu)/earth + mu/moon)]
struct Satellite {
    mu: f64,
}

/// Mass of the Moon, of both together.
const MU: f64 = 0.012_150_585_609_624_04;
/// Radius of the Moon, in distances from the Earth.
const RADIUS: f64 = 1737.4 / 384_400.0;

fn main() -> Result<()> {
    let satellite = Satellite { mu: MU };
    let guess = State::new([0.8234, 0.0, 0.0], [0.0, 0.1263, 0.0]);
    // Orbits that cross the plane y = 0 at right angles are their own mirror image.
    let search = satellite.periodic_orbit(&guess).period_near(2.743).segments(4);
    let search = search.mirrored(&["y", "x_dot", "z_dot"]).tolerance(1e-11);
    let first = search.find()?;
    let planar = search.family(&first).orbits(60).longest_step(0.05).follow()?;
    println!("{planar}");
    let leaves = planar.first(BifurcationKind::BranchPoint).ok_or("no orbit leaves the plane")?;
    let halo = search.branch(leaves).orbits(1000).longest_step(0.007).until(is_down).follow()?;
    println!("{halo}");
    for point in planar.bifurcations().iter().chain(halo.bifurcations()) {
        let (jacobi, period) = (-2.0 * point.value, point.orbit.period);
        println!("C = {jacobi:.12}, T = {period:.12}: {}", point.kind);
    }
    let gap = halo.orbits().iter().map(|orbit| orbit.gap).fold(0.0, f64::max);
    println!("{} halo orbits, closed to {gap:.1e}", halo.orbits().len());
    let file = picture::path("halo_orbits")?;
    draw(&planar, &halo, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

/// True for an orbit that touches the Moon.
fn is_down(orbit: &PeriodicOrbit<Satellite>) -> bool {
    let distance = |q: [f64; 3]| ((q[0] - 1.0 + MU).powi(2) + q[1].powi(2) + q[2].powi(2)).sqrt();
    orbit.nodes.iter().any(|node| distance(node.q.into()) < RADIUS)
}

/// The orbit seen along one of the axes.
fn outline(orbit: &PeriodicOrbit<Satellite>, axes: [usize; 2]) -> Result<Points> {
    let path = orbit.system.integrate(orbit.start, orbit.period, Dop853::with_tolerance(1e-10))?;
    let at = |k: i32| {
        let q = path.at(orbit.period * (f64::from(k) / 300.0))?.state().q;
        Ok((q[axes[0]], q[axes[1]]))
    };
    (0..=300).map(at).collect()
}

fn draw(planar: &Family<Satellite>, halo: &Family<Satellite>, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1200, 560))?;
    let panels = root.split_evenly((1, 3));
    for (area, (axes, names)) in panels.iter().zip([([0, 1], ["x", "y"]), ([0, 2], ["x", "z"])]) {
        let mut chart = Panel::new("halo orbits", names).equal_axes();
        for orbit in planar.orbits().iter().step_by(6).take(5).filter(|_| axes[1] == 1) {
            chart.line(outline(orbit, axes)?, GREY);
        }
        for orbit in halo.orbits().iter().step_by(8) {
            chart.line(outline(orbit, axes)?, BLUE);
        }
        chart.dots("Moon", RED, &vec![(1.0 - MU, 0.0)]);
        chart.draw(area)?;
    }
    let mut chart =
        Panel::new("stability: inside ±1", ["period", "(λ + 1/λ)/2"]).within([1.7..2.85, -3.0..3.0]);
    for k in 0..2 {
        let mut points = Points::new();
        for orbit in halo.orbits() {
            points.extend(orbit.stability_indices()?.get(k).map(|index| (orbit.period, index.re)));
        }
        let points: Points = points.into_iter().filter(|(_, index)| index.abs() < 3.0).collect();
        chart.specks(2, if k == 0 { BLUE } else { RED }, points);
    }
    chart.draw(&panels[2])?;
    root.present()?;
    Ok(())
}
