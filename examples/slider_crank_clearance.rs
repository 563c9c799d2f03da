//! A slider crank whose slider has clearance in its guide: four corners, each above or below, that bounce and slide along (Flores,
//! Leine and Glocker, *Multibody System Dynamics* 23, 2010, whose numbers these are).

mod picture;

use std::f64::consts::TAU;

use lagrange_core::contact::{Contact, Transition};
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

/// Crank, rod and slider, whose centres of mass are in their middles.
#[derive(Clone, Lagrangian)]
#[coordinates(theta: [3])]
#[define(pin = [l[0]*cos(theta[0]), l[0]*sin(theta[0])])]
#[define(middle = pin + l[1]/2*[cos(theta[1]), sin(theta[1])])]
#[define(slider = pin + l[1]*[cos(theta[1]), sin(theta[1])])]
#[define(corner(s, w) = slider + [s*a*cos(theta[2]) - w*b*sin(theta[2]), s*a*sin(theta[2]) + w*b*cos(theta[2])])]
#[lagrangian(
    m[0]/8 * dot(der(pin), der(pin)) + m[1]/2 * dot(der(middle), der(middle)) + m[2]/2 * dot(der(slider), der(slider))
    + sum(i in 0..3, inertia[i]/2 * theta_dot[i]^2) - g*(m[0]*pin[1]/2 + m[1]*middle[1] + m[2]*slider[1])
)]
#[contact(upper[k in 0..2]: b + c - corner(2*k - 1, 1)[1] >= 0, restitution: e, friction(mu): der(corner(2*k - 1, 1))[0])]
#[contact(lower[k in 0..2]: b + c + corner(2*k - 1, -1)[1] >= 0, restitution: e, friction(mu): der(corner(2*k - 1, -1))[0])]
#[observable(place = slider)]
struct SliderCrank {
    l: [f64; 2],
    m: [f64; 3],
    inertia: [f64; 3],
    /// Half length and half height of the slider, and its clearance.
    a: f64,
    b: f64,
    c: f64,
    g: f64,
    e: f64,
    mu: f64,
    upper: [Contact; 2],
    lower: [Contact; 2],
}

const CRANK: SliderCrank = SliderCrank {
    l: [0.153, 0.306],
    m: [0.038, 0.038, 0.076],
    inertia: [7.4e-5, 5.9e-4, 2.7e-6],
    a: 0.05,
    b: 0.025,
    c: 0.001,
    g: 9.81,
    e: 0.4,
    mu: 0.01,
    upper: [Contact::Open; 2],
    lower: [Contact::Open; 2],
};

type Path = Trajectory<SliderCrank>;

fn main() -> Result<()> {
    let start = State::new([0.0; 3], [150.0, -75.0, 0.0]);
    let path = CRANK.motion(start).by(Dop853::with_tolerance(1e-10)).with_contacts().to(0.2)?;
    println!("{path}\n\nthe first impacts, and what opens:");
    let impulse = |transition: &Transition<f64>| match transition {
        Transition::Impact { impulses, .. } => impulses[0].1,
        _ => f64::INFINITY,
    };
    let told = path.transitions().iter().filter(|one| impulse(one) > 1e-2 && one.time() < 0.05);
    told.for_each(|transition| println!("  {transition}"));
    let energies: Vec<f64> = path.samples(5).map(|sample| sample.energy()).collect();
    println!("\nenergy every 0.05 s: {energies:.4?} J");
    let file = picture::path("slider_crank_clearance")?;
    draw(&path, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

fn draw(path: &Path, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 900))?;
    let panels = root.split_evenly((2, 2));
    let [mut slider, mut crank, mut rod, mut portrait] = [const { Points::new() }; 4];
    for sample in path.samples(4000) {
        let (turns, state) = (sample.coordinate("theta[0]")? / TAU, sample.state());
        let height = CRANK.place(state)[1] / CRANK.c;
        slider.push((turns, height));
        crank.push((turns, state.v[0]));
        rod.push((turns, state.v[1]));
        portrait.push((CRANK.place(state)[0], height));
    }
    let mut chart = Panel::new("The slider in its guide", ["turns of the crank", "y/c"]);
    chart.line([(0.0, 1.0), (3.0, 1.0)], GREY.stroke_width(2));
    chart.line([(0.0, -1.0), (3.0, -1.0)], GREY.stroke_width(2));
    chart.curve("middle of the slider", BLUE, &slider);
    chart.draw(&panels[0])?;
    let mut chart = Panel::new("Its path, the height in clearances", ["x in m", "y/c"]);
    chart.curve("middle of the slider", RED, &portrait);
    chart.draw(&panels[1])?;
    let mut chart = Panel::new("The crank", ["turns of the crank", "angular velocity in 1/s"]);
    chart.curve("crank", BLUE, &crank);
    chart.draw(&panels[2])?;
    let mut chart = Panel::new("The rod", ["turns of the crank", "angular velocity in 1/s"]);
    chart.curve("rod", RED, &rod);
    chart.draw(&panels[3])?;
    root.present()?;
    Ok(())
}
