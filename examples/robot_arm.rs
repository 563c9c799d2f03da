//! A robot arm of six joints that leads its tool around a circle, pointing down: what its motors have to do.
//!
//! The joints are frames by the convention of J. Denavit and R. S. Hartenberg (*Journal of Applied Mechanics* 22, 1955), in
//! size and weight about a PUMA 560. First the arm has no motors and is led by the hand: six constraints say where the tool
//! is, which gives the angles, and their multipliers are the forces and moments of the hand. Inverse dynamics says by what
//! torques the joints move so without it; by virtual work they are those that the hand's forces have about the joints.
//! Then the motors get these torques as functions of time, nobody looks where the arm goes, and it goes around the circle.

mod picture;

use std::f64::consts::PI;

use lagrange_core::nalgebra::{Matrix3, SVector, Vector3};
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

/// A link without the joint: in its frame, about its centre.
#[derive(Clone, Copy)]
struct Body {
    m: f64,
    centre: Vector3<f64>,
    inertia: Matrix3<f64>,
}

/// Around the circle from rest to rest, led by the hand.
#[derive(Lagrangian)]
#[coordinates(q: [6])]
#[define(a = [0, 0.43, 0.02, 0, 0, 0])]
#[define(d = [0.67, 0, 0.15, 0.43, 0, 0.2])]
#[define(alpha = [pi/2, 0, -pi/2, pi/2, -pi/2, 0])]
#[frame(link[0]: rotate_z(q[0]), translate([a[0], 0, d[0]]), rotate_x(alpha[0]))]
#[frame(link[i in 1..6] in link[i-1]: rotate_z(q[i]), translate([a[i], 0, d[i]]), rotate_x(alpha[i]))]
#[parameter(body: [6] {m, centre: [3], inertia: symmetric})]
#[lagrangian(sum(i in 0..6,
    kinetic(link[i], body[i].m, body[i].centre, body[i].inertia) - body[i].m*g*position(link[i], body[i].centre)[2]
))]
#[define(turn = 2*pi*t/round - sin(2*pi*t/round))]
#[constraint(tool: position(link[5]) = middle + radius*[0, sin(turn), cos(turn)])]
#[define(along = express(vector(link[5], [0, 0, 1]), fixed))]
#[define(across = express(vector(link[5], [0, 1, 0]), fixed))]
#[constraint(points_down: [along[0], along[1], across[0]] = 0)]
#[observable(shoulder = position(link[0]))]
#[observable(elbow = position(link[1]))]
#[observable(forearm = position(link[2]))]
#[observable(wrist = position(link[3]))]
#[observable(tip = position(link[5]))]
struct Led {
    body: [Body; 6],
    g: f64,
    middle: Vector3<f64>,
    radius: f64,
    /// How long it takes.
    round: f64,
}

/// The same arm, driven.
#[derive(Lagrangian)]
#[coordinates(q: [6])]
#[function(motor(t): [6] = motors)]
#[define(a = [0, 0.43, 0.02, 0, 0, 0])]
#[define(d = [0.67, 0, 0.15, 0.43, 0, 0.2])]
#[define(alpha = [pi/2, 0, -pi/2, pi/2, -pi/2, 0])]
#[frame(link[0]: rotate_z(q[0]), translate([a[0], 0, d[0]]), rotate_x(alpha[0]))]
#[frame(link[i in 1..6] in link[i-1]: rotate_z(q[i]), translate([a[i], 0, d[i]]), rotate_x(alpha[i]))]
#[parameter(body: [6] {m, centre: [3], inertia: symmetric})]
#[lagrangian(sum(i in 0..6,
    kinetic(link[i], body[i].m, body[i].centre, body[i].inertia) - body[i].m*g*position(link[i], body[i].centre)[2]
))]
#[force(q: motor(t))]
struct Arm {
    body: [Body; 6],
    g: f64,
    motors: Chebyshev,
}

/// Torques as a series of Chebyshev's polynomials from t = 0 to the end.
struct Chebyshev {
    end: f64,
    terms: Vec<SVector<f64, 6>>,
}

type Path<'a> = Trajectory<&'a Led>;

fn main() -> Result<()> {
    println!("{}", Led::equations());
    let led = Led::puma();
    println!("around a circle of {} m in {} s, from rest to rest", 2.0 * led.radius, led.round);
    let (start, moved) = led.make_consistent(&State::at_rest([0.0, 0.95, -3.47, 0.0, -0.62, 0.0]))?;
    println!("the angles at which the tool is on it: {moved}");
    let path = led.integrate(start, led.round, Dop853::with_tolerance(1e-13))?;
    table(&led, &path)?;
    let motors = Chebyshev::fit(led.round, 80, |t| led.torques(&path, t))?;
    let arm = led.driven(motors);
    let driven = arm.integrate(start, led.round, Dop853::with_tolerance(1e-13))?;
    checks(&led, &path, &arm, &driven)?;
    let file = picture::path("robot_arm")?;
    draw(&led, &path, &driven, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

impl Led {
    fn puma() -> Self {
        let body = |m: f64, centre: [f64; 3], inertia: [f64; 3]| Body {
            m,
            centre: centre.into(),
            inertia: Matrix3::from_diagonal(&inertia.into()),
        };
        Self {
            body: [
                body(13.0, [0.0, -0.3, 0.05], [0.8, 0.35, 0.8]),
                body(17.0, [-0.25, 0.0, 0.1], [0.13, 0.53, 0.54]),
                body(5.0, [-0.02, 0.0, 0.07], [0.07, 0.09, 0.013]),
                body(0.8, [0.0, -0.1, 0.0], [2e-3, 1.3e-3, 2e-3]),
                body(0.4, [0.0, 0.0, 0.0], [3e-4, 4e-4, 3e-4]),
                body(1.0, [0.0, 0.0, -0.08], [3e-3, 3e-3, 1e-3]),
            ],
            g: 9.81,
            middle: Vector3::new(0.5, 0.0, 0.45),
            radius: 0.15,
            round: 2.0,
        }
    }

    fn driven(&self, motors: Chebyshev) -> Arm {
        Arm { body: self.body, g: self.g, motors }
    }

    /// What the joints need without the hand, whose forces are given as zero.
    fn torques(&self, path: &Path<'_>, t: f64) -> Result<SVector<f64, 6>> {
        let sample = path.at(t)?;
        Ok(self.inverse_dynamics(sample.state(), &sample.solution()?.accelerations, &SVector::zeros()))
    }

    fn target(&self, t: f64) -> Vector3<f64> {
        let rate = 2.0 * PI / self.round;
        let (sine, cosine) = (rate * t - (rate * t).sin()).sin_cos();
        self.middle + self.radius * Vector3::new(0.0, sine, cosine)
    }
}

impl Chebyshev {
    /// Through the values at the zeros of the polynomial whose degree is the number of terms.
    fn fit(end: f64, count: usize, of: impl Fn(f64) -> Result<SVector<f64, 6>>) -> Result<Self> {
        let mut terms = vec![SVector::zeros(); count];
        for k in 0..count {
            let angle = PI * (k as f64 + 0.5) / count as f64;
            let value = of(end * f64::midpoint(1.0, angle.cos()))?;
            for (n, term) in terms.iter_mut().enumerate() {
                let weight = if n == 0 { 1.0 } else { 2.0 } / count as f64;
                *term += weight * (n as f64 * angle).cos() * value;
            }
        }
        Ok(Self { end, terms })
    }
}

impl Function<1, 6> for Chebyshev {
    /// By Clenshaw's recurrence.
    fn eval<S: Scalar>(&self, [t]: [S; 1]) -> [S; 6] {
        let x = t * S::constant(2.0 / self.end) - S::constant(1.0);
        core::array::from_fn(|i| {
            let [mut b, mut after] = [S::constant(0.0); 2];
            for term in self.terms[1..].iter().rev() {
                (b, after) = (S::constant(term[i]) + S::constant(2.0) * x * b - after, b);
            }
            S::constant(self.terms[0][i]) + x * b - after
        })
    }
}

fn row(x: &SVector<f64, 6>) -> String {
    x.iter().map(|x| format!("{:9.4}", (x * 1e4).round() / 1e4 + 0.0)).collect()
}

fn table(led: &Led, path: &Path<'_>) -> Result<()> {
    println!("\n{:>5} {:>52} {:>54}", "t/s", "joints in rad", "torques in N m");
    for sample in path.samples(9) {
        let torques = led.torques(path, sample.time())?;
        println!("{:5.2}{} {}", sample.time(), row(&sample.state().q), row(&torques));
    }
    Ok(())
}

fn checks(led: &Led, path: &Path<'_>, arm: &Arm, driven: &Trajectory<&Arm>) -> Result<()> {
    let (mut worst, mut work, count) = ([0.0_f64; 5], 0.0, 400);
    for sample in path.samples(count + 1) {
        let (s, torques) = (sample.state(), led.torques(path, sample.time())?);
        work += torques.dot(&s.v) * led.round / f64::from(count as u32);
        let other = *driven.at(s.t)?.state();
        let moved = State { q: other.q, ..*s };
        let series = SVector::from(arm.motors.eval([s.t]));
        let deviations = [
            (led.tip(s) - led.target(s.t)).norm(),
            (torques - led.constraint_force(s, &sample.solution()?.multipliers)).amax(),
            (torques - series).amax(),
            (other.q - s.q).amax(),
            (led.tip(&moved) - led.target(s.t)).norm(),
        ];
        for (worst, deviation) in worst.iter_mut().zip(deviations) {
            *worst = worst.max(deviation);
        }
    }
    let laws = [
        "led: the tool is on the circle, in m",
        "torques = those of the hand's forces about the joints, in N m",
        "they are the series that the motors get, in N m",
        "driven: the joints turn as when led, in rad",
        "driven: the tool is where it is meant to be, in m",
    ];
    println!("\nlargest deviation in {count} moments");
    for (law, worst) in laws.into_iter().zip(worst) {
        println!("  {law:<62} {worst:8.1e}");
    }
    println!("  {:<62} {:8.1e}", "back at rest, the motors have done no work, in J", work.abs());
    Ok(())
}

fn draw(led: &Led, path: &Path<'_>, driven: &Trajectory<&Arm>, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 950))?;
    let panels = root.split_evenly((2, 2));
    // From the right, a little from ahead and from above.
    let oblique = |p: Vector3<f64>| (0.8 * p[0] + 0.6 * p[1], 0.95 * p[2] + 0.3 * (0.8 * p[1] - 0.6 * p[0]));
    draw_poses(led, driven, &panels[0], ["The arm, driven by its motors", "", ""], &oblique)?;
    draw_poses(led, driven, &panels[1], ["From above", "x in m", "y in m"], &|p| (p[0], p[1]))?;
    draw_torques(led, path, &panels[2], ["Column, upper arm and forearm", "torque in N m"], [0, 1, 2])?;
    draw_torques(led, path, &panels[3], ["The wrist", "torque in N m"], [3, 4, 5])?;
    root.present()?;
    Ok(())
}

/// Darker the later.
fn draw_poses(
    led: &Led,
    driven: &Trajectory<&Arm>,
    area: &picture::Area,
    [title, x, y]: [&str; 3],
    project: &dyn Fn(Vector3<f64>) -> (f64, f64),
) -> Result<()> {
    let poses: Vec<Points> = driven
        .samples(9)
        .map(|sample| {
            let s = State { q: sample.state().q, ..*sample.state() };
            let joints = [led.shoulder(&s), led.elbow(&s), led.forearm(&s), led.wrist(&s), led.tip(&s)];
            std::iter::once(Vector3::zeros()).chain(joints).map(project).collect()
        })
        .collect();
    let circle: Points =
        (0..=200).map(|k| led.target(led.round * f64::from(k) / 200.0)).map(project).collect();
    let mut curves: Vec<&Points> = poses.iter().collect();
    curves.push(&circle);
    let mut chart = Panel::new(title, [x, y]).equal_axes();
    for (k, pose) in poses.iter().enumerate() {
        let style = GREY.mix(0.2 + 0.1 * k as f64).stroke_width(3);
        chart.line(pose.iter().copied(), style);
    }
    chart.curve("circle that it is to draw", BLUE, &circle);
    let tips = poses.iter().map(|pose| pose[pose.len() - 1]).collect();
    chart.dots("tool, every quarter of a second", RED, &tips);
    chart.draw(area)
}

fn draw_torques(
    led: &Led,
    path: &Path<'_>,
    area: &picture::Area,
    [title, name]: [&str; 2],
    joints: [usize; 3],
) -> Result<()> {
    let (mut motors, mut hand) = (Vec::new(), Vec::new());
    for sample in path.samples(201) {
        motors.push((sample.time(), led.torques(path, sample.time())?));
    }
    for sample in path.samples(41) {
        let multipliers = sample.solution()?.multipliers;
        hand.push((sample.time(), led.constraint_force(sample.state(), &multipliers)));
    }
    let of = |torques: &[(f64, SVector<f64, 6>)], i: usize| -> Points {
        torques.iter().map(|(t, torque)| (*t, torque[i])).collect()
    };
    let curves = joints.map(|i| of(&motors, i));
    let mut chart = Panel::new(title, ["t in s", name]);
    for ((i, curve), color) in joints.into_iter().zip(&curves).zip([BLACK, RED, BLUE]) {
        chart.curve(&format!("joint {}", i + 1), color, curve);
    }
    let dots = joints.into_iter().flat_map(|i| of(&hand, i)).collect();
    chart.dots("forces of the hand about the joint", GREY, &dots);
    chart.draw(area)
}
