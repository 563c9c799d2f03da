//! A mass on a spring in a frame that turns and accelerates: Milton (8.43)–(8.51).
//!
//! The Lagrangian is (8.44) as it stands; Ω and A are given along the turning axes. The forces of Euler, Coriolis
//! and the centrifugal force (8.47) come out one by one, and the motion is that of the inertial frame, where the
//! spring makes a driven oscillation. A second run turns uniformly, with an anisotropic spring that turns too:
//! E = E₀ − L·Ω is conserved (8.51), and neither E₀ nor L is. Its Hamiltonian is p²/2m − Ω·(r×p) + U (8.54), and
//! Hamilton's equations give the same motion.

mod picture;

use lagrange_core::nalgebra::{Rotation3, Vector3};
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[function(U(r) = spring)]
#[function(Omega(t): [3] = rotation)]
#[function(A(t): [3] = push)]
#[define(v = r_dot)]
#[define(W = Omega(t))]
#[lagrangian(
    m/2*dot(v, v) + m/2*dot(cross(W, r), cross(W, r)) + m*dot(v, cross(W, r)) - U(r) - m*dot(r, A(t))
)]
#[observable(euler = m*cross(r, der(W)))]
#[observable(coriolis = 2*m*cross(v, W))]
#[observable(centrifugal = m*cross(W, cross(r, W)))]
struct InFrame {
    m: f64,
    spring: Spring,
    rotation: Rotation,
    push: Push,
}

/// U = ½ (k_x x² + k_y y² + k_z z²).
#[derive(Clone, Copy)]
struct Spring {
    k: [f64; 3],
}

impl Function<3, 1> for Spring {
    fn eval<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 1] {
        let [a, b, c] = self.k.map(|k| S::constant(k / 2.0));
        [a * x * x + b * y * y + c * z * z]
    }
}

/// How the frame moves: it turns about z by θ = mean t + swing (1 − cos rate t), and its origin goes to and fro
/// along the inertial x axis, R = reach sin(rate t).
#[derive(Clone, Copy)]
struct Frame {
    mean: f64,
    swing: f64,
    reach: f64,
    rate: f64,
}

/// Ω(t) = θ̇ e_z.
struct Rotation(Frame);

impl Function<1, 3> for Rotation {
    fn eval<S: Scalar>(&self, [t]: [S; 1]) -> [S; 3] {
        let Frame { mean, swing, rate, .. } = self.0;
        let zero = S::constant(0.0);
        [zero, zero, S::constant(mean) + S::constant(swing * rate) * (S::constant(rate) * t).sin()]
    }
}

/// A(t) = R̈, along the turning axes.
struct Push(Frame);

impl Function<1, 3> for Push {
    fn eval<S: Scalar>(&self, [t]: [S; 1]) -> [S; 3] {
        let Frame { mean, swing, reach, rate } = self.0;
        let (sine, cosine) = (S::constant(rate) * t).sin_cos();
        let angle = S::constant(mean) * t + S::constant(swing) * (S::constant(1.0) - cosine);
        let along_x = S::constant(-reach * rate * rate) * sine;
        [along_x * angle.cos(), -along_x * angle.sin(), S::constant(0.0)]
    }
}

impl Frame {
    fn omega(&self, t: f64) -> Vector3<f64> {
        Vector3::z() * (self.mean + self.swing * self.rate * (self.rate * t).sin())
    }

    fn omega_dot(&self, t: f64) -> Vector3<f64> {
        Vector3::z() * (self.swing * self.rate * self.rate * (self.rate * t).cos())
    }

    fn axes(&self, t: f64) -> Rotation3<f64> {
        let angle = self.mean * t + self.swing * (1.0 - (self.rate * t).cos());
        Rotation3::from_axis_angle(&Vector3::z_axis(), angle)
    }

    fn origin(&self, t: f64) -> Vector3<f64> {
        Vector3::x() * (self.reach * (self.rate * t).sin())
    }

    /// Position and velocity in the inertial frame: R + Q r and Ṙ + Q (v + Ω×r).
    fn seen_from_outside(&self, s: &State<f64, 3>) -> [Vector3<f64>; 2] {
        let velocity = Vector3::x() * (self.reach * self.rate * (self.rate * s.t).cos());
        let (axes, omega) = (self.axes(s.t), self.omega(s.t));
        [self.origin(s.t) + axes * s.q, velocity + axes * (s.v + omega.cross(&s.q))]
    }
}

type Path<'a> = Trajectory<&'a InFrame>;

const DURATION: f64 = 50.0;
const M: f64 = 0.5;
const K: f64 = 3.0;
const MOVING: Frame = Frame { mean: 0.8, swing: 0.5, reach: 0.3, rate: 0.9 };
const UNIFORM: Frame = Frame { mean: 0.8, swing: 0.0, reach: 0.0, rate: 1.0 };

fn main() -> Result<()> {
    println!("Mass on a spring in a frame that turns at Ω(t) and accelerates with A(t)   (Milton 8.44)\n");
    println!("{}", InFrame::equations());
    let system = |frame: Frame, k: [f64; 3]| InFrame {
        m: M,
        spring: Spring { k },
        rotation: Rotation(frame),
        push: Push(frame),
    };
    let (moving, uniform) = (system(MOVING, [K; 3]), system(UNIFORM, [3.0, 2.0, 1.0]));
    let start = State::new([0.5, 0.0, 0.2], [0.0, 0.3, 0.0]);
    let method = Dop853::with_tolerance(1e-12);
    let path = moving.integrate(start, DURATION, method)?;
    let uniform_path = uniform.integrate(start, DURATION, method)?;
    table(&moving, &path);
    println!("\n{}\n", path.ending());
    checks(&moving, &path)?;
    check_energy(&uniform, &uniform_path);
    check_hamilton(&uniform, &uniform_path, method)?;
    let file = picture::path("rotating_frame")?;
    draw(&moving, &path, &uniform, &uniform_path, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

fn table(system: &InFrame, path: &Path<'_>) {
    let titles = ["r/m", "Euler/N", "Coriolis/N", "centrifugal/N"];
    println!(
        "the components x, y of each\n{:>5} {:>17} {:>17} {:>17} {:>17}",
        "t/s", titles[0], titles[1], titles[2], titles[3]
    );
    for sample in path.samples(11) {
        let s = sample.state();
        print!("{:5.1}", s.t);
        for x in [s.q, system.euler(s), system.coriolis(s), system.centrifugal(s)] {
            print!("  {:8.4}{:8.4}", x[0], x[1]);
        }
        println!();
    }
}

/// In the inertial frame: a driven oscillation along x, free ones along y and z.
fn exact(start: &State<f64, 3>, t: f64) -> Vector3<f64> {
    let [r, v] = MOVING.seen_from_outside(start);
    let (omega, Frame { reach, rate, .. }) = ((K / M).sqrt(), MOVING);
    let driven = reach * omega * omega / (omega * omega - rate * rate);
    let (sine, cosine) = (omega * t).sin_cos();
    r * cosine
        + (v - Vector3::x() * (driven * rate)) * (sine / omega)
        + Vector3::x() * (driven * (rate * t).sin())
}

/// What the formulas of the book give at a state, beside what the macro derived.
fn deviations(system: &InFrame, s: &State<f64, 3>, start: &State<f64, 3>) -> Result<[f64; 6]> {
    let (w, w_dot) = (MOVING.omega(s.t), MOVING.omega_dot(s.t));
    let push = MOVING.axes(s.t).inverse() * MOVING.origin(s.t) * (-MOVING.rate * MOVING.rate);
    let euler = M * s.q.cross(&w_dot);
    let coriolis = 2.0 * M * s.v.cross(&w);
    let centrifugal = M * w.cross(&s.q.cross(&w));
    let force = -K * s.q - M * push + euler + coriolis + centrifugal;
    Ok([
        (system.euler(s) - euler).norm(),
        (system.coriolis(s) - coriolis).norm(),
        (system.centrifugal(s) - centrifugal).norm(),
        (M * system.solve(s)?.accelerations - force).norm(),
        (system.momentum(s) - M * (s.v + w.cross(&s.q))).norm(),
        (MOVING.seen_from_outside(s)[0] - exact(start, s.t)).norm(),
    ])
}

fn checks(system: &InFrame, path: &Path<'_>) -> Result<()> {
    let mut worst = [0.0_f64; 6];
    for sample in path.samples(2000) {
        let row = deviations(system, sample.state(), path.start().state())?;
        for (worst, deviation) in worst.iter_mut().zip(row) {
            *worst = worst.max(deviation);
        }
    }
    let laws = [
        "Euler's force m r×Ω̇, in N",
        "Coriolis's force 2m v×Ω, in N",
        "centrifugal force m Ω×(r×Ω), in N",
        "m v̇ = −∂U/∂r − m A + these three (8.47), in N",
        "p = m v + m Ω×r (8.45)",
        "the motion of the inertial frame, in m",
    ];
    println!("largest deviation over {DURATION} s");
    for (law, worst) in laws.into_iter().zip(worst) {
        println!("  {law:<50} {worst:8.1e}");
    }
    Ok(())
}

/// E₀ = m/2 v₀² + U and L·Ω, from the inertial frame.
fn outside(system: &InFrame, s: &State<f64, 3>) -> [f64; 2] {
    let [r, v] = UNIFORM.seen_from_outside(s);
    let [potential] = system.spring.eval(s.q.into());
    [M / 2.0 * v.norm_squared() + potential, M * r.cross(&v).dot(&UNIFORM.omega(s.t))]
}

fn check_energy(system: &InFrame, path: &Path<'_>) {
    let start = system.energy(path.start().state());
    let (mut worst, mut drift) = (0.0_f64, 0.0_f64);
    for sample in path.samples(2000) {
        let (e, [e0, l]) = (system.energy(sample.state()), outside(system, sample.state()));
        worst = worst.max((e - (e0 - l)).abs());
        drift = drift.max((e - start).abs());
    }
    println!("uniform rotation");
    println!("  {:<50} {worst:8.1e}", "E = E₀ − L·Ω (8.51), in J");
    println!("  {:<50} {drift:8.1e}", "E is conserved, in J");
}

/// The same motion by Hamilton's equations, and H by hand.
fn check_hamilton(system: &InFrame, path: &Path<'_>, method: Dop853) -> Result<()> {
    let start = system.phase_state(path.start().state());
    let canonical = system.motion_in_momenta(start).by(method).to(DURATION)?;
    let (mut motion, mut hamiltonian) = (0.0_f64, 0.0_f64);
    for sample in path.samples(500) {
        let s = canonical.at(sample.time())?;
        let phase = system.phase_state(s.state());
        let [potential] = system.spring.eval(phase.q.into());
        let spin = UNIFORM.omega(phase.t).dot(&phase.q.cross(&phase.p));
        let by_hand = phase.p.norm_squared() / (2.0 * M) - spin + potential;
        hamiltonian = hamiltonian.max((system.hamiltonian(&phase)? - by_hand).abs());
        motion = motion.max((s.state().q - sample.state().q).amax());
    }
    println!("  {:<50} {hamiltonian:8.1e}", "H = p²/2m − Ω·(r×p) + U (8.54), in J");
    println!("  {:<50} {motion:8.1e}", "Hamilton's equations (8.57): same motion, in m");
    Ok(())
}

fn draw(
    system: &InFrame,
    path: &Path<'_>,
    uniform: &InFrame,
    uniform_path: &Path<'_>,
    file: &std::path::Path,
) -> Result<()> {
    let root = picture::sheet(file, (1100, 950))?;
    let panels = root.split_evenly((2, 2));
    draw_in_frame(path, &panels[0])?;
    draw_from_outside(path, &panels[1])?;
    draw_forces(system, path, &panels[2])?;
    draw_energy(uniform, uniform_path, &panels[3])?;
    root.present()?;
    Ok(())
}

/// The first 15 seconds, finely.
fn moments<'p>(path: &'p Path<'_>) -> impl Iterator<Item = State<f64, 3>> + 'p {
    path.samples(5001).take(1501).map(|sample| *sample.state())
}

fn draw_in_frame(path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let seen: Points = moments(path).map(|s| (s.q[0], s.q[1])).collect();
    let mut chart = Panel::new("In the turning frame, 15 s", ["x in m", "y in m"]).equal_axes();
    chart.curve("mass", BLUE, &seen);
    chart.dots("start", RED, &vec![seen[0]]);
    chart.dots("where the spring is fixed", GREY, &vec![(0.0, 0.0)]);
    chart.draw(area)
}

fn draw_from_outside(path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let start = *path.start().state();
    let law: Points = moments(path).map(|s| exact(&start, s.t)).map(|r| (r[0], r[1])).collect();
    let seen: Points =
        moments(path).step_by(20).map(|s| MOVING.seen_from_outside(&s)[0]).map(|r| (r[0], r[1])).collect();
    let reach = vec![(-MOVING.reach, 0.0), (MOVING.reach, 0.0)];
    let title = "The same from the inertial frame";
    let mut chart = Panel::new(title, ["x₀ in m", "y₀ in m"]).equal_axes();
    chart.curve("driven oscillation, exact", GREY, &law);
    chart.dots("transformed, every 0.2 s", BLUE, &seen);
    chart.curve("where the frame's origin goes", RED, &reach);
    chart.draw(area)
}

fn draw_forces(system: &InFrame, path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let along_x = |force: fn(&InFrame, &State<f64, 3>) -> Vector3<f64>| -> Points {
        moments(path).map(|s| (s.t, force(system, &s)[0])).collect()
    };
    let forces = [along_x(InFrame::euler), along_x(InFrame::coriolis), along_x(InFrame::centrifugal)];
    let title = "The forces of the frame, their x components";
    let mut chart = Panel::new(title, ["t in s", "force in N"]);
    chart.curve("Coriolis 2m v×Ω", BLUE, &forces[1]);
    chart.curve("centrifugal m Ω×(r×Ω)", RED, &forces[2]);
    chart.curve("Euler m r×dΩ/dt", BLACK, &forces[0]);
    chart.draw(area)
}

fn draw_energy(system: &InFrame, path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let [mut inertial, mut angular, mut difference] = [Points::new(), Points::new(), Points::new()];
    for s in moments(path) {
        let [e0, l] = outside(system, &s);
        inertial.push((s.t, e0));
        angular.push((s.t, l));
        difference.push((s.t, e0 - l));
    }
    let integrated: Points = moments(path).step_by(50).map(|s| (s.t, system.energy(&s))).collect();
    let title = "Uniform rotation, anisotropic spring";
    let mut chart = Panel::new(title, ["t in s", "energy in J"]);
    chart.curve("E₀, inertial frame", GREY, &inertial);
    chart.curve("L·Ω", RED, &angular);
    chart.curve("E₀ − L·Ω", BLUE, &difference);
    chart.dots("E, turning frame", BLUE, &integrated);
    chart.draw(area)
}
