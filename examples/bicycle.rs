//! A bicycle without a rider's hands (J. P. Meijaard, J. M. Papadopoulos, A. Ruina and A. L. Schwab, "Linearized dynamics equations for
//! the balance and steer of a bicycle: a benchmark and review", *Proceedings of the Royal Society A* 463, 2007): between the weave
//! speed and the capsize speed it rights itself.
//!
//! Four rigid bodies are frames, both wheels roll without slipping, and nothing is linearized by hand. Pushed aside, the bicycle
//! steers into the fall and goes on in another direction. Far slower it weaves and falls; faster it leans ever more, slowly, and
//! runs in a spiral.

mod picture;

use lagrange_core::nalgebra::{Complex, Matrix3, Vector3};
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

/// x points ahead, y to the right, z down; points are given by their places in the upright bicycle, from the rear contact (x, y).
/// `upright` yaws and rolls, and does not pitch; the rear wheel turns in it.
#[derive(Lagrangian)]
#[coordinates(x, y, yaw, roll, pitch, steer, rear, front)]
#[parameter(body_inertia: symmetric)]
#[parameter(fork_inertia: symmetric)]
#[frame(upright: translate([x, y, 0]), rotate_z(yaw), rotate_x(roll), translate([0, 0, -rear_radius]))]
#[frame(body in upright: rotate_y(pitch), translate([0, 0, rear_radius]))]
#[frame(rear_wheel in upright: rotate_y(rear))]
#[frame(fork in body: translate([base + trail, 0, 0]), rotate([sin(tilt), 0, cos(tilt)], steer), translate([-base - trail, 0, 0]))]
#[frame(front_wheel in fork: translate([base, 0, -front_radius]), rotate_y(front))]
#[define(wheel(across, along) = [[across, 0, 0], [0, along, 0], [0, 0, across]])]
#[lagrangian(
    kinetic(rear_wheel, rear_mass, [0, 0, 0], wheel(rear_across, rear_along))
    + kinetic(body, body_mass, body_centre, body_inertia)
    + kinetic(fork, fork_mass, fork_centre, fork_inertia)
    + kinetic(front_wheel, front_mass, [0, 0, 0], wheel(front_across, front_along))
    + g*(rear_mass*position(rear_wheel)[2] + body_mass*position(body, body_centre)[2]
        + fork_mass*position(fork, fork_centre)[2] + front_mass*position(front_wheel)[2]))]
// From the front hub to the lowest point of the wheel: down, less its part along the axle.
#[define(down = express(vector(fixed, [0, 0, 1]), front_wheel))]
#[define(front_contact = front_radius/sqrt(1 - down[1]^2)*vector(front_wheel, [down[0], 0, down[2]]))]
#[define(rear_contact = express(vector(upright, [0, 0, rear_radius]), rear_wheel))]
#[define(rear_slip = express(velocity(rear_wheel) + cross(angular_velocity(rear_wheel), rear_contact), fixed))]
#[define(front_slip = express(velocity(front_wheel) + cross(angular_velocity(front_wheel), front_contact), fixed))]
#[constraint(touches: position(front_wheel)[2] + front_radius*sqrt(1 - down[1]^2) = 0)]
#[constraint(rear_rolls: [rear_slip[0], rear_slip[1]] = 0)]
#[constraint(front_rolls: [front_slip[0], front_slip[1]] = 0)]
#[observable(front_track = position(front_wheel) + express(front_contact, fixed))]
struct Bicycle {
    base: f64,
    trail: f64,
    tilt: f64,
    g: f64,
    rear_radius: f64,
    rear_mass: f64,
    rear_across: f64,
    rear_along: f64,
    body_mass: f64,
    body_centre: Vector3<f64>,
    body_inertia: Matrix3<f64>,
    fork_mass: f64,
    fork_centre: Vector3<f64>,
    fork_inertia: Matrix3<f64>,
    front_radius: f64,
    front_mass: f64,
    front_across: f64,
    front_along: f64,
}

/// Weave and capsize speed of the benchmark, in m/s.
const STABLE: [f64; 2] = [4.292_382_536_341_104, 6.024_262_015_388_359];
/// What the push does: the lean begins to change at this rate, in rad/s.
const PUSH: f64 = 0.5;
/// A lean from which there is no way back, in rad.
const FALLEN: f64 = 1.0;

fn main() -> Result<()> {
    let bicycle = Bicycle::benchmark();
    println!("{:>6} {:>50}", "m/s", "eigenvalues of lean and steer in 1/s");
    for speed in 0..=10 {
        let mut modes = bicycle.modes(f64::from(speed))?;
        modes.sort_by(|s, t| s.re.total_cmp(&t.re));
        let texts = modes
            .map(|s| if s.im == 0.0 { format!("{:.5}", s.re) } else { format!("{:.5}{:+.5}i", s.re, s.im) });
        println!("{speed:6} {}", texts.map(|text| format!("{text:>20}")).join(" "));
    }
    check_speeds(&bicycle)?;

    println!("\npushed so that it begins to lean at {PUSH} rad/s:");
    let mut rides = Vec::new();
    for speed in [2.5, 4.6, 8.0] {
        let ride = bicycle.ride(speed)?;
        let (start, end) = (ride.start(), ride.end());
        let (lean, heading) = (end.coordinate("roll")?.abs(), end.coordinate("yaw")?);
        println!(
            "  at {speed} m/s: after {:.2} s it leans by {lean:.6} rad, turned by {heading:.3} rad",
            end.time()
        );
        let energy = (end.energy() / start.energy() - 1.0).abs();
        assert!(energy < 1e-8, "{energy:e}");
        // Weaving it is down before the end; it rights itself; it goes on falling.
        let expected = match speed {
            slow if slow < STABLE[0] => end.time() < LONG,
            fast if fast > STABLE[1] => lean > ride.at(LONG - 1.0)?.coordinate("roll")?.abs(),
            _ => lean < 5e-3,
        };
        assert!(expected, "{lean} rad at {speed} m/s");
        rides.push((speed, ride));
    }
    let file = picture::path("bicycle")?;
    draw(&bicycle, &rides, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

/// How long a ride is, in s.
const LONG: f64 = 10.0;

impl Bicycle {
    fn benchmark() -> Self {
        let half = |xx: f64, yy: f64, zz: f64, xz: f64| Matrix3::new(xx, 0.0, xz, 0.0, yy, 0.0, xz, 0.0, zz);
        Self {
            base: 1.02,
            trail: 0.08,
            tilt: std::f64::consts::PI / 10.0,
            g: 9.81,
            rear_radius: 0.3,
            rear_mass: 2.0,
            rear_across: 0.0603,
            rear_along: 0.12,
            body_mass: 85.0,
            body_centre: Vector3::new(0.3, 0.0, -0.9),
            body_inertia: half(9.2, 11.0, 2.8, 2.4),
            fork_mass: 4.0,
            fork_centre: Vector3::new(0.9, 0.0, -0.7),
            fork_inertia: half(0.058_92, 0.06, 0.007_08, -0.007_56),
            front_radius: 0.35,
            front_mass: 3.0,
            front_across: 0.1405,
            front_along: 0.28,
        }
    }

    /// Upright and straight ahead, leaning at a rate.
    fn riding(&self, speed: f64, rate: f64) -> Result<State<f64, 8>> {
        let mut rough = State::at_rest([0.0; 8]);
        (rough.v[0], rough.v[3], rough.v[6], rough.v[7]) =
            (speed, rate, -speed / self.rear_radius, -speed / self.front_radius);
        Ok(self.make_consistent_holding(&rough, &["roll_dot", "steer_dot", "rear_dot"])?.0)
    }

    /// The four eigenvalues of lean and steer near the straight ride. The others are zero: place, direction and speed are free.
    fn modes(&self, speed: f64) -> Result<[Complex<f64>; 4]> {
        let mut all = self.linearize(&self.riding(speed, 0.0)?, &[])?.eigenvalues()?;
        all.sort_by(|s, t| t.norm().total_cmp(&s.norm()));
        all[..4].try_into().map_err(|_| "less than four modes".into())
    }

    /// The ride after a push, to its end or until the bicycle has fallen.
    fn ride(&self, speed: f64) -> Result<Trajectory<&Self>> {
        let falls = self.event("has fallen", |sample| sample.state().q[3].abs() - FALLEN).rising().terminal();
        let start = self.riding(speed, PUSH)?;
        Ok(self.motion(start).by(Dop853::with_tolerance(1e-10)).event(falls).to(LONG)?)
    }
}

/// Between weave and capsize speed all modes decay, beside them one grows.
fn check_speeds(bicycle: &Bicycle) -> Result<()> {
    for (speed, slower) in [(STABLE[0], true), (STABLE[1], false)] {
        let growth = |speed: f64| -> Result<f64> {
            Ok(bicycle.modes(speed)?.iter().map(|s| s.re).fold(f64::MIN, f64::max))
        };
        let [below, above] = [growth(speed * (1.0 - 1e-6))?, growth(speed * (1.0 + 1e-6))?];
        println!("largest growth just below and above {speed:.6} m/s: {below:.1e}/s, {above:.1e}/s");
        assert_eq!((below > 0.0, above > 0.0), (slower, !slower));
    }
    Ok(())
}

fn draw(bicycle: &Bicycle, rides: &[(f64, Trajectory<&Bicycle>)], file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1200, 950))?;
    let panels = root.split_evenly((2, 2));
    let (mut real, mut imaginary) = (Points::new(), Points::new());
    for k in 0..=200 {
        let speed = f64::from(k) / 20.0;
        for s in bicycle.modes(speed)? {
            real.push((speed, s.re));
            if s.im > 0.0 {
                imaginary.push((speed, s.im));
            }
        }
    }
    let mut chart =
        Panel::new("Eigenvalues of lean and steer", ["speed in m/s", "1/s"]).within([0.0..10.0, -10.0..10.0]);
    chart
        .face([(STABLE[0], -10.0), (STABLE[1], -10.0), (STABLE[1], 10.0), (STABLE[0], 10.0)], BLUE.mix(0.12));
    chart.line([(0.0, 0.0), (10.0, 0.0)], GREY.stroke_width(1));
    chart.specks(1, BLACK, real.iter().copied().filter(|(_, s)| s.abs() < 10.0));
    chart.specks(1, RED, imaginary.iter().copied().filter(|(_, s)| s.abs() < 10.0));
    chart.curve("real parts", BLACK, &Points::new());
    chart.curve("imaginary part", RED, &Points::new());
    chart.curve("stable", BLUE, &Points::new());
    chart.draw(&panels[0])?;

    let colors = [RED, BLUE, BLACK];
    let mut chart = Panel::new("Lean after a push", ["t in s", "roll in rad"]);
    for ((speed, ride), color) in rides.iter().zip(colors) {
        let lean = ride.samples(600).map(|sample| (sample.time(), sample.state().q[3])).collect();
        chart.curve(&format!("at {speed} m/s"), color, &lean);
    }
    chart.draw(&panels[1])?;

    let (speed, ride) = &rides[1];
    let mut chart = Panel::new(&format!("It steers into the fall, at {speed} m/s"), ["t in s", "rad"]);
    for (name, index, color) in [("lean", 3, BLUE), ("steer", 5, RED), ("direction", 2, GREY)] {
        let curve = ride.samples(600).map(|sample| (sample.time(), sample.state().q[index])).collect();
        chart.curve(name, color, &curve);
    }
    chart.draw(&panels[2])?;

    let rear = ride.samples(600).map(|sample| (sample.state().q[0], -sample.state().q[1])).collect();
    let front = ride
        .samples(600)
        .map(|sample| {
            let track = bicycle.front_track(sample.state());
            (track[0], -track[1])
        })
        .collect();
    let mut chart = Panel::new("Its tracks, from above", ["x in m", "to the left, in m"]);
    chart.curve("rear wheel", BLUE, &rear);
    chart.curve("front wheel", RED, &front);
    chart.draw(&panels[3])?;
    root.present()?;
    Ok(())
}
