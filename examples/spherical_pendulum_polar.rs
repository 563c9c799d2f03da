//! The spherical pendulum in polar coordinates, and its period and precession by quadrature: Milton (8.23)–(8.31).
//!
//! θ is counted from the upward vertical, z = l cos θ. L_z is the momentum of φ, which is cyclic. With u = cos θ the
//! energy becomes u̇² = U(u) (8.26): the bob swings between two roots of U, and what happens between them is two
//! integrals. Time goes as du/√U ((8.28) is printed without the root); from u₁ to u₂ and back it is twice the
//! integral, and one full ellipse is two such nutations, 4 ∫.

mod pendulum;
mod picture;

use std::f64::consts::{PI, TAU};

use lagrange_core::prelude::*;
use pendulum::{Orbit, crossings};
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

#[derive(Lagrangian)]
#[coordinates(theta, phi)]
#[lagrangian(m*l^2/2 * (theta_dot^2 + sin(theta)^2 * phi_dot^2) - m*g*l*cos(theta))]
struct PolarPendulum {
    m: f64,
    g: f64,
    l: f64,
}

type Path<'a> = Trajectory<&'a PolarPendulum>;

fn main() -> Result<()> {
    let pendulum = PolarPendulum { m: 1.0, g: 9.81, l: 1.0 };
    println!("{}", PolarPendulum::equations());
    println!("m = {} kg, g = {} m/s², l = {} m; 30 s\n", pendulum.m, pendulum.g, pendulum.l);
    println!(
        "start: angle from the downward vertical, and φ̇; all else by quadrature (motion: largest difference)"
    );
    println!(
        "{:>8} {:>7} {:>10} {:>10} {:>13} {:>8} {:>15} {:>8}",
        "angle", "φ̇ /s⁻¹", "u₁", "u₂", "nutation/s", "motion", "precession/rad", "motion"
    );
    for (degrees, phi_dot) in [(5.0, 1.0), (60.0, 1.3), (90.0, 1.0), (120.0, 2.5), (170.0, 5.0)] {
        let start = pendulum.turning(degrees, phi_dot);
        let path = pendulum.integrate(start, 30.0, Dop853::with_tolerance(1e-14))?;
        row(&format!("{degrees}°"), &pendulum, &path)?;
    }
    // A bob that goes round in a circle: the roots coincide. Two per cent faster it nutates about the circle.
    let cone = (pendulum.g / pendulum.l / 40.0_f64.to_radians().cos()).sqrt();
    let near = pendulum.turning(40.0, 1.02 * cone);
    row("40°", &pendulum, &pendulum.integrate(near, 30.0, Dop853::with_tolerance(1e-14))?)?;

    let path = pendulum.integrate(pendulum.turning(60.0, 1.3), 30.0, Dop853::with_tolerance(1e-14))?;
    checks(&pendulum, &path);
    let file = picture::path("spherical_pendulum_polar")?;
    draw(&pendulum, &path, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

impl PolarPendulum {
    /// A turning point, at this angle from the downward vertical.
    fn turning(&self, degrees: f64, phi_dot: f64) -> State<f64, 2> {
        State::new([PI - degrees.to_radians(), 0.0], [0.0, phi_dot])
    }

    /// The exact law of the motion through this state.
    fn orbit(&self, state: &State<f64, 2>) -> Orbit {
        let inertia = self.m * self.l * self.l;
        let above_bottom = self.energy(state) + self.m * self.g * self.l;
        Orbit::of(above_bottom / inertia, self.momentum(state)[1] / inertia, self.g / self.l)
    }

    /// U(u) of (8.26), with E (8.24) and L_z (8.25) of this state.
    fn squared_rate(&self, state: &State<f64, 2>, u: f64) -> f64 {
        let inertia = self.m * self.l * self.l;
        let kinetic = self.energy(state) - self.m * self.g * self.l * u;
        2.0 * kinetic / inertia * (1.0 - u * u) - (self.momentum(state)[1] / inertia).powi(2)
    }
}

/// Times and azimuths of the lower turning points of an integrated motion, where θ̇ changes from + to −.
fn lower_turning_points(path: &Path<'_>) -> Result<Points> {
    let rate = |t: f64| path.at(t).map_or(f64::NAN, |sample| sample.state().v[0]);
    let mut turns = Points::new();
    for t in crossings(path.steps().map(|s| s.time()), rate) {
        let sample = path.at(t)?;
        if sample.acceleration("theta")? < 0.0 {
            turns.push((t, sample.coordinate("phi")?));
        }
    }
    Ok(turns)
}

/// Nutation periods and precessions, one after another, less those by quadrature.
fn deviations(orbit: &Orbit, turns: &Points) -> Vec<[f64; 2]> {
    let ellipse = |three: &[(f64, f64)]| {
        let nutation = three[1].0 - three[0].0;
        [nutation - orbit.nutation(), (three[2].1 - three[0].1).abs() - TAU - orbit.precession()]
    };
    turns.windows(3).map(ellipse).collect()
}

fn row(name: &str, pendulum: &PolarPendulum, path: &Path<'_>) -> Result<()> {
    let start = path.start();
    let orbit = pendulum.orbit(start.state());
    let mut worst = [0.0_f64; 2];
    for deviation in deviations(&orbit, &lower_turning_points(path)?) {
        worst = std::array::from_fn(|i| worst[i].max(deviation[i].abs()));
    }
    println!(
        "{name:>8} {:7.3} {:10.6} {:10.6} {:13.9} {:8.0e} {:15.9} {:8.0e}",
        start.velocity("phi")?,
        orbit.heights[0] - 1.0,
        orbit.heights[1] - 1.0,
        orbit.nutation(),
        worst[0],
        orbit.precession(),
        worst[1],
    );
    Ok(())
}

fn checks(pendulum: &PolarPendulum, path: &Path<'_>) {
    let start = *path.start().state();
    let mut worst = [0.0_f64; 3];
    for sample in path.steps() {
        let s = sample.state();
        let u_dot = s.q[0].sin() * s.v[0];
        let deviations = [
            pendulum.energy(s) - pendulum.energy(&start),
            pendulum.momentum(s)[1] - pendulum.momentum(&start)[1],
            u_dot * u_dot - pendulum.squared_rate(&start, s.q[0].cos()),
        ];
        worst = std::array::from_fn(|i| worst[i].max(deviations[i].abs()));
    }
    let laws = [
        "E = p·q̇ − L is conserved (8.24), in J",
        "so is L_z = m l² sin² θ φ̇ (8.25), in J s",
        "u̇² = U(u) (8.26), in s⁻²",
    ];
    println!("\nlargest deviation from the exact law over 30 s, start at 60°");
    for (law, worst) in laws.into_iter().zip(worst) {
        println!("  {law:<42} {worst:8.1e}");
    }
}

fn draw(pendulum: &PolarPendulum, path: &Path<'_>, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 950))?;
    let panels = root.split_evenly((2, 2));
    let orbit = pendulum.orbit(path.start().state());
    draw_from_above(&orbit, path, &panels[0])?;
    draw_cubic(pendulum, path, &panels[1])?;
    draw_angle(&orbit, path, &panels[2])?;
    draw_precession(&orbit, path, &panels[3])?;
    root.present()?;
    Ok(())
}

/// The first six nutations, finely: azimuth and polar angle against the time.
fn moments<'p>(orbit: &Orbit, path: &'p Path<'_>) -> impl Iterator<Item = (f64, [f64; 2])> + 'p {
    let step = orbit.nutation() * 6.0 / 1500.0;
    let times = (0..=1500).map(move |k| f64::from(k) * step);
    times.filter_map(|t| path.at(t).ok()).map(|sample| (sample.time(), sample.state().q.data.0[0]))
}

fn draw_from_above(orbit: &Orbit, path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let place = |theta: f64, phi: f64| (theta.sin() * phi.cos(), theta.sin() * phi.sin());
    let bob: Points = moments(orbit, path).map(|(_, [theta, phi])| place(theta, phi)).collect();
    let circles = orbit.heights.map(|w| -> Points {
        let theta = (w - 1.0).acos();
        (0..=120).map(|k| place(theta, f64::from(k) * TAU / 120.0)).collect()
    });
    let title = "From above: three ellipses between the turning circles";
    let mut chart = Panel::new(title, ["x in l", "y in l"]).equal_axes();
    chart.curve("turning circles", GREY, &circles[0]);
    chart.line(circles[1].iter().copied(), GREY.stroke_width(2));
    chart.curve("bob", BLUE, &bob);
    chart.dots("start", RED, &vec![bob[0]]);
    chart.draw(area)
}

fn draw_cubic(pendulum: &PolarPendulum, path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let start = *path.start().state();
    let cubic: Points = (0..=206)
        .map(|k| -1.02 + f64::from(k) * 0.01)
        .map(|u| (u, pendulum.squared_rate(&start, u)))
        .collect();
    let motion = |s: State<f64, 2>| (s.q[0].cos(), (s.q[0].sin() * s.v[0]).powi(2));
    let integrated: Points = path.samples(60).map(|s| motion(*s.state())).collect();
    let heights = pendulum.orbit(&start).heights.map(|w| (w - 1.0, 0.0)).to_vec();
    let title = "u̇² = U(u): the bob moves where U is not negative";
    let mut chart = Panel::new(title, ["u = z/l", "U in s⁻²"]);
    chart.curve("zero", GREY, &vec![(-1.15, 0.0), (1.15, 0.0)]);
    chart.curve("U(u), Milton (8.26)", BLUE, &cubic);
    chart.dots("u̇² of the integrated motion", RED, &integrated);
    chart.dots("turning points u₁, u₂", GREY, &heights);
    chart.draw(area)
}

fn draw_angle(orbit: &Orbit, path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let angle: Points = moments(orbit, path).map(|(t, [theta, _])| (t, theta.to_degrees())).collect();
    let at_turns = |part: f64, w: f64| -> Points {
        let angle = (w - 1.0).acos().to_degrees();
        (0..6).map(|k| ((f64::from(k) + part) * orbit.nutation(), angle)).collect()
    };
    let [low, high] = orbit.heights;
    let mut chart =
        Panel::new("Polar angle: turning points where the quadrature puts them", ["t in s", "θ in degrees"]);
    chart.curve("integrated", BLUE, &angle);
    chart.dots("u₂, and each nutation later", RED, &at_turns(0.0, high));
    chart.dots("u₁, half a nutation after it", GREY, &at_turns(0.5, low));
    chart.draw(area)
}

fn draw_precession(orbit: &Orbit, path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let scaled = |which: usize, all: &[[f64; 2]]| -> Points {
        all.iter().enumerate().map(|(k, deviation)| ((k + 1) as f64, deviation[which] * 1e12)).collect()
    };
    let all = deviations(orbit, &lower_turning_points(path)?);
    let (period, precession) = (scaled(0, &all), scaled(1, &all));
    let mut chart =
        Panel::new("Integrated motion less quadrature (absolute)", ["nutation", "deviation × 10¹²"]);
    chart.dots("period of the nutation, in s", BLUE, &period);
    chart.dots("precession of an ellipse, in rad", RED, &precession);
    chart.draw(area)
}
