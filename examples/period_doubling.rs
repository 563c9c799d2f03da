//! A driven pendulum on its way to chaos: five doublings of the period, each the start of the next family.
//!
//! φ″ + 2β φ′ + ω₀² sin φ = γ ω₀² cos ωt with ω = 2π, ω₀ = 3π, β = ω₀/4. (J. R. Taylor, *Classical Mechanics*, 12.4: doublings at γ =
//! 1.0663, 1.0793, 1.0821 and 1.0827.) The intervals shrink by Feigenbaum's 4.669.

mod picture;

use std::f64::consts::{PI, TAU};

use lagrange_core::linearized::Stability;
use lagrange_core::orbits::{BifurcationKind, Family};
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};

#[derive(Clone, Lagrangian)]
#[coordinates(phi)]
#[define(omega_0 = 3*pi)]
#[lagrangian(phi_dot^2/2 + omega_0^2*cos(phi))]
#[dissipation(omega_0/4 * phi_dot^2)]
#[force(phi: gamma*omega_0^2*cos(omega*t))]
struct Pendulum {
    gamma: f64,
    omega: f64,
}

/// Number of doublings.
const COUNT: usize = 5;

fn main() -> Result<()> {
    let pendulum = Pendulum { gamma: 1.06, omega: TAU };
    // What is left after thirty turns of the drive.
    let settled = pendulum.motion(State::at_rest([-PI / 2.0])).to(30.0)?;
    let start = settled.end().state().at_time(0.0);
    let search = pendulum.periodic_orbit(&start).driven_by("omega", 1);
    let first = search.find()?;
    let (mut families, mut doublings) = (Vec::new(), Vec::new());
    let mut next = search.family(&first).in_parameter("gamma");
    for k in 0..COUNT as i32 {
        let step = 0.01 / 4.0_f64.powi(k);
        let family =
            next.step(step).longest_step(step).until_first(BifurcationKind::PeriodDoubling).follow()?;
        println!("{family}");
        let doubling = family.first(BifurcationKind::PeriodDoubling).ok_or("the family does not double")?;
        doublings.push(doubling.clone());
        families.push(family);
        next = search.branch(&doublings[doublings.len() - 1]);
    }
    print(&doublings.iter().map(|doubling| doubling.value).collect::<Vec<_>>());
    let file = picture::path("period_doubling")?;
    draw(&families, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

fn print(values: &[f64]) {
    println!("{:>8} {:>18} {:>12}", "doubling", "gamma", "ratio");
    for (k, value) in values.iter().enumerate() {
        print!("{:>8} {value:>18.12}", k + 1);
        match k {
            0 | 1 => println!(),
            k => println!(" {:>12.6}", (values[k - 1] - values[k - 2]) / (value - values[k - 1])),
        }
    }
}

/// φ at each turn of the drive, over the force.
fn draw(families: &[Family<Pendulum>], file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 560))?;
    let panels = root.split_evenly((1, 2));
    let views = [[1.06..1.085, -0.5..0.0], [1.079..1.0829, -0.16..-0.06]];
    for (area, view) in panels.iter().zip(views) {
        let mut chart = Panel::new("doublings of the period", ["γ", "φ at the turns"]).within(view.clone());
        let inside = |&(x, y): &(f64, f64)| view[0].contains(&x) && view[1].contains(&y);
        for family in families {
            let (mut stable, mut unstable) = (Points::new(), Points::new());
            for orbit in family.orbits() {
                let kind =
                    if orbit.stability()? == Stability::Unstable { &mut unstable } else { &mut stable };
                let path = orbit.system.motion(orbit.start).to(orbit.period)?;
                for turn in 0..orbit.period.round() as i32 {
                    kind.push((orbit.system.gamma, path.at(f64::from(turn))?.coordinate("phi")?));
                }
            }
            chart.specks(2, BLUE, stable.into_iter().filter(inside));
            chart.specks(2, GREY, unstable.into_iter().filter(inside));
            let doublings = family.bifurcations().iter().map(|found| (found.value, found.orbit.start.q[0]));
            chart.dots("", RED, &doublings.filter(inside).collect());
        }
        chart.draw(area)?;
    }
    root.present()?;
    Ok(())
}
