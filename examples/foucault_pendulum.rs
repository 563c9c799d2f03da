//! Foucault's pendulum: a bob on a string, Milton (8.11), in the frame of the rotating Earth, Milton (8.44).
//!
//! x points east, y north, z up; g includes the centrifugal acceleration of the point of suspension, so A = 0. The
//! Earth is the real one, the pendulum that of the Panthéon, held 3 m to the east, let go from rest, and followed for
//! one sidereal day. Its plane turns by 2π sin(latitude), clockwise in the north, but for two small effects:
//!
//! * Let go from rest on a moving Earth, the bob passes the centre at a distance: it moves on an ellipse with
//!   L_z = Ω_z a² and precesses as one would on an Earth at rest, by about ⅜ (a/l)² of Foucault's angle.
//! * The centrifugal force, −½ (Ω cos(latitude) y)² in the Lagrangian, makes north and south the stiffer direction.
//!   Its torque changes the ellipse, L̇_z = −¼ (Ω cos(latitude))² a² sin 2α at the azimuth α, and so the precession.
//!
//! Both vanish with the square of the amplitude; what is left after them is of order Ω² (a/l)²/ω a second.

mod pendulum;
mod picture;

use std::f64::consts::{PI, TAU};

use lagrange_core::prelude::*;
use pendulum::{Orbit, crossings};
use picture::{BLUE, GREY, Panel, Points, RED, Result};

#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[frame(site: rotate_z(rate*t), rotate_x(pi/2), rotate_x(-latitude))]
#[lagrangian(kinetic(site, m, r) - m*g*r[2])]
#[constraint(string: (dot(r, r) - l^2)/2 = 0)]
struct FoucaultPendulum {
    m: f64,
    g: f64,
    l: f64,
    rate: f64,
    latitude: f64,
}

type Path<'a> = Trajectory<&'a FoucaultPendulum>;

const DAY: f64 = 86_164.1;
const PARIS: f64 = 48.846;

fn main() -> Result<()> {
    println!("{}", FoucaultPendulum::equations());
    let paris = FoucaultPendulum::at(PARIS);
    println!("m = {} kg, g = {} m/s², l = {} m, let go from rest 3 m east", paris.m, paris.g, paris.l);
    println!("\nthe plane of the swing in one sidereal day, {DAY} s, in degrees, clockwise from above");
    println!(
        "{:>8} {:>8} {:>14} {:>14} {:>13} {:>12} {:>9}",
        "latitude", "swings", "motion", "360° sin lat.", "as an ellipse", "centrifugal", "left"
    );
    let path = paris.day()?;
    let mut days = Vec::new();
    for degrees in [90.0, PARIS, 30.0, 10.0, -30.0] {
        let day =
            if degrees == PARIS { plane(&path)? } else { plane(&FoucaultPendulum::at(degrees).day()?)? };
        row(degrees, &day);
        days.push((degrees, day));
    }
    checks(&paris, &path);
    let file = picture::path("foucault_pendulum")?;
    draw(&paris, &days, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

impl FoucaultPendulum {
    /// The Panthéon's pendulum, at a latitude in degrees.
    fn at(degrees: f64) -> Self {
        Self { m: 28.0, g: 9.81, l: 67.0, rate: TAU / DAY, latitude: degrees.to_radians() }
    }

    /// Held this far to the east.
    fn held(&self, a: f64) -> State<f64, 3> {
        State::at_rest([a, 0.0, -(self.l * self.l - a * a).sqrt()])
    }

    fn day(&self) -> Result<Path<'_>> {
        let method = Dop853::with_tolerance(1e-11).max_steps(400_000);
        Ok(self.integrate(self.held(3.0), DAY, method)?)
    }

    /// The vertical component of Ω.
    fn vertical(&self) -> f64 {
        self.rate * self.latitude.sin()
    }

    /// By how much the ellipse precesses in the time t on its own, let go from rest at the distance a.
    fn as_an_ellipse(&self, a: f64, t: f64) -> f64 {
        let (l_z, height) = (self.vertical() * a * a, self.l + self.held(a).q.z);
        let energy = self.g * height + 0.5 * (l_z / a).powi(2);
        let square = self.l * self.l;
        let orbit = Orbit::of(energy / square, l_z / square, self.g / self.l);
        l_z.signum() * orbit.precession() / (2.0 * orbit.nutation()) * t
    }

    /// What the centrifugal force adds in the time t to a swing that started east: ⅜ ω (a/l²) ∫ b dt, with the
    /// half-axis b = L_z/ω a from L̇_z above, while α = −Ω_z t.
    fn centrifugal(&self, a: f64, t: f64) -> f64 {
        let horizontal = self.rate * self.latitude.cos();
        let twice = 2.0 * self.vertical();
        3.0 / 32.0 * (a / self.l * horizontal).powi(2) / twice * (t - (twice * t).sin() / twice)
    }
}

/// Times and azimuths of the swing's plane, each the mean of two neighbouring far ends, continued from east.
fn plane(path: &Path<'_>) -> Result<Points> {
    let growth = |t: f64| path.at(t).map_or(f64::NAN, |s| s.state().q.xy().dot(&s.state().v.xy()));
    let half = path.start().state().q.xy().norm() / 2.0;
    let (mut ends, mut azimuth) = (Points::new(), 0.0);
    for t in crossings(path.steps().map(|s| s.time()), growth) {
        let q = path.at(t)?.state().q;
        if q.xy().norm() > half {
            azimuth += (q.y.atan2(q.x) - azimuth + PI / 2.0).rem_euclid(PI) - PI / 2.0;
            ends.push((t, azimuth));
        }
    }
    let mean =
        |pair: &[(f64, f64)]| (f64::midpoint(pair[0].0, pair[1].0), f64::midpoint(pair[0].1, pair[1].1));
    Ok(ends.windows(2).map(mean).collect())
}

fn row(degrees: f64, plane: &Points) {
    let pendulum = FoucaultPendulum::at(degrees);
    let (t, azimuth) = plane[plane.len() - 1];
    // To the end of the day, by less than one swing.
    let turned = -azimuth * DAY / t;
    let foucault = pendulum.vertical() * DAY;
    let (ellipse, centrifugal) = (-pendulum.as_an_ellipse(3.0, DAY), -pendulum.centrifugal(3.0, DAY));
    let parts = [turned, foucault, ellipse, centrifugal, turned - foucault - ellipse - centrifugal];
    // Without negative zeros.
    let [turned, foucault, ellipse, centrifugal, left] =
        parts.map(|angle| (angle.to_degrees() * 1e12).round() / 1e12 + 0.0);
    println!(
        "{degrees:7.3}° {:8} {turned:14.7} {foucault:14.7} {ellipse:13.7} {centrifugal:12.7} {left:9.1e}",
        plane.len() / 2
    );
}

fn checks(pendulum: &FoucaultPendulum, path: &Path<'_>) {
    let energy = pendulum.energy(path.start().state());
    let mut worst = [0.0_f64; 2];
    for sample in path.steps() {
        let s = sample.state();
        let deviations = [pendulum.energy(s) - energy, pendulum.constraint_residual(s)[0]];
        worst = std::array::from_fn(|i| worst[i].max(deviations[i].abs()));
    }
    println!("\nlargest deviation over the day in Paris, at {} steps", path.statistics().accepted);
    println!("  E = m v²/2 − m (Ω×r)²/2 + m g z is conserved (8.48), in J {:8.1e}", worst[0]);
    println!("  the string keeps its length: ½ (r² − l²) = 0, in m²       {:8.1e}", worst[1]);
}

/// From the days at each latitude.
fn draw(paris: &FoucaultPendulum, days: &[(f64, Points)], file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 950))?;
    let panels = root.split_evenly((2, 2));
    draw_rosette(&panels[0])?;
    draw_hours(days, &panels[1])?;
    draw_latitudes(&panels[2])?;
    draw_corrections(paris, &days[1].1, &panels[3])?;
    root.present()?;
    Ok(())
}

/// On the real Earth a day has 5247 swings, too many to draw.
fn draw_rosette(area: &picture::Area) -> Result<()> {
    let fast = FoucaultPendulum { rate: 200.0 * TAU / DAY, ..FoucaultPendulum::at(PARIS) };
    let path = fast.integrate(fast.held(3.0), DAY / 200.0, Dop853::with_tolerance(1e-11))?;
    let bob: Points = path.samples(6000).map(|s| (s.state().q.x, s.state().q.y)).collect();
    let law = fast.vertical() * DAY / 200.0;
    let title = "From above: a day in Paris, on an Earth 200 times as fast";
    let mut chart = Panel::new(title, ["east, in m", "north, in m"]).equal_axes();
    chart.curve("bob", BLUE, &bob);
    chart.dots("let go", RED, &vec![(3.0, 0.0)]);
    let end = vec![(0.0, 0.0), (3.0 * law.cos(), -3.0 * law.sin())];
    chart.curve("2π sin(latitude)", RED, &end);
    chart.draw(area)
}

fn draw_hours(days: &[(f64, Points)], area: &picture::Area) -> Result<()> {
    let title = "The plane of the swing on the real Earth";
    let axes = ["sidereal hours", "azimuth in degrees"];
    let mut chart = Panel::new(title, axes);
    for (which, color) in [(0, RED), (1, BLUE), (4, GREY)] {
        let (degrees, plane) = &days[which];
        let pendulum = FoucaultPendulum::at(*degrees);
        let hour = |&(t, azimuth): &(f64, f64)| (t * 24.0 / DAY, azimuth.to_degrees());
        let law = [0.0, DAY].map(|t| hour(&(t, -pendulum.vertical() * t))).to_vec();
        let motion = plane.iter().step_by(400).map(hour).collect();
        chart.curve(&format!("−Ω t sin({degrees}°)").replace('-', "−"), color, &law);
        chart.dots("integrated motion", color, &motion);
    }
    chart.draw(area)
}

/// An hour is enough to measure the rate.
fn draw_latitudes(area: &picture::Area) -> Result<()> {
    let law: Points =
        (-90..=90).map(f64::from).map(|degrees| (degrees, 15.0 * degrees.to_radians().sin())).collect();
    let mut motion = Points::new();
    for degrees in (-90..=90).step_by(15).map(f64::from) {
        let pendulum = FoucaultPendulum::at(degrees);
        let path = pendulum.integrate(pendulum.held(3.0), DAY / 24.0, Dop853::with_tolerance(1e-11))?;
        let plane = plane(&path)?;
        let (t, azimuth) = plane[plane.len() - 1];
        motion.push((degrees, -azimuth.to_degrees() / t * DAY / 24.0));
    }
    let mut chart = Panel::new(
        "Clockwise in the north, not at all at the equator",
        ["latitude in degrees", "degrees in a sidereal hour"],
    );
    chart.curve("15° sin(latitude)", GREY, &law);
    chart.dots("integrated motion", RED, &motion);
    chart.draw(area)
}

fn draw_corrections(paris: &FoucaultPendulum, plane: &Points, area: &picture::Area) -> Result<()> {
    let hour = |t: f64| t * 24.0 / DAY;
    let motion: Points = plane
        .iter()
        .step_by(400)
        .map(|&(t, azimuth)| (hour(t), (azimuth + paris.vertical() * t).to_degrees()))
        .collect();
    let law = |value: &dyn Fn(f64) -> f64| -> Points {
        (0..=96).map(|k| f64::from(k) * DAY / 96.0).map(|t| (hour(t), value(t).to_degrees())).collect()
    };
    let ellipse = law(&|t| paris.as_an_ellipse(3.0, t));
    let both = law(&|t| paris.as_an_ellipse(3.0, t) + paris.centrifugal(3.0, t));
    let mut chart = Panel::new(
        "Paris: what the motion lacks of Foucault's law",
        ["sidereal hours", "azimuth + Ω t sin(latitude), in degrees"],
    );
    chart.curve("precession as an ellipse", GREY, &ellipse);
    chart.curve("and the centrifugal force", BLUE, &both);
    chart.dots("integrated motion", RED, &motion);
    chart.draw(area)
}
