//! An acrobot: two links, a motor at the elbow and none at the shoulder, swung up from hanging and balanced on its head.
//!
//! The motor is told a torque 100 times a second and holds it in between. On the way up the elbow is made to bend with the
//! swing, φ̈ = k₁(φ_d − φ) − k₂ φ̇ with φ_d = a atan(10 p_θ): of the momentum p_θ only gravity makes more or less, so it tells which
//! way the whole swings, whatever the elbow does. a is smaller the less energy is lacking, so that it comes to the top
//! stretched. The shoulder's equation, in which no motor stands, says what the shoulder then does, and inverse dynamics
//! what torque it takes (partial feedback linearization: M. W. Spong, "The swing up control problem for the acrobot", *IEEE
//! Control Systems* 15, 1995). Close to the top the linear system takes over, with the feedback u = −K z of least cost.

mod picture;

use std::f64::consts::{PI, TAU};

use lagrange_core::nalgebra::{DMatrix, Matrix4, RowVector4, Vector4};
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

/// Two uniform rods; `theta` is the first one's angle from hanging, `phi` that of the second to the first.
#[derive(Clone, Lagrangian)]
#[coordinates(theta, phi)]
#[define(first = [l[0]*sin(theta), -l[0]*cos(theta)])]
#[define(second = [l[1]*sin(theta + phi), -l[1]*cos(theta + phi)])]
#[lagrangian(m[0]*l[0]^2/6*theta_dot^2 - m[0]*g*first[1]/2
    + m[1]/2*dot(der(first + second/2), der(first + second/2)) + m[1]*l[1]^2/24*(theta_dot + phi_dot)^2
    - m[1]*g*(first[1] + second[1]/2))]
#[force(phi: torque)]
struct Acrobot {
    m: [f64; 2],
    l: [f64; 2],
    g: f64,
    torque: f64,
}

/// How often the motor is told what to do, and for how long.
const TICK: f64 = 0.01;
const END: f64 = 17.0;
/// k₁ and k₂, by which the elbow follows.
const FOLLOW: [f64; 2] = [20.0, 9.0];
/// The feedback takes over where the top costs less than that.
const NEAR: f64 = 1000.0;
/// Standing on its head.
const TOP: [f64; 2] = [PI, 0.0];

/// What the motor is told, by what is seen.
struct Controller {
    /// The energy at the top.
    energy: f64,
    gain: RowVector4<f64>,
    /// zᵀ P z is what it costs to come to the top from z.
    cost: Matrix4<f64>,
}

/// What is kept of the motion, at the ticks.
#[derive(Default)]
struct Record {
    states: Vec<State<f64, 2>>,
    torques: Points,
    energies: Points,
    /// When it was caught.
    caught: Option<f64>,
}

fn main() -> Result<()> {
    let acrobot = Acrobot { m: [1.0, 1.0], l: [1.0, 1.0], g: 9.81, torque: 0.0 };
    let controller = Controller::of(&acrobot)?;
    let record = run(acrobot.clone(), &controller)?;
    report(&record)?;
    let file = picture::path("acrobot")?;
    draw(&acrobot, &controller, &record, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

impl Controller {
    /// With the gains that minimize Σ (zᵀQz + u²/10) over the ticks, by Riccati's iteration for the linear system from
    /// one to the next.
    fn of(acrobot: &Acrobot) -> Result<Self> {
        let top = State::at_rest(TOP);
        let near = acrobot.linearize(&top, &["torque"])?;
        println!("near the top, {:?}: {near}", near.stability()?);
        // exp of [A B; 0 0] for a tick, over which the torque is held.
        let mut held = DMatrix::zeros(5, 5);
        held.view_mut((0, 0), (4, 4)).copy_from(&near.a);
        held.view_mut((0, 4), (4, 1)).copy_from(&near.b);
        let held = (held * TICK).exp();
        let (a, b) = (held.fixed_view::<4, 4>(0, 0), held.fixed_view::<4, 1>(0, 4));
        let (weights, mut gain) =
            (Matrix4::from_diagonal(&Vector4::new(10.0, 10.0, 1.0, 1.0)), RowVector4::zeros());
        let mut cost = weights;
        for _ in 0..5000 {
            gain = b.tr_mul(&cost) * a / (0.1 + (b.tr_mul(&cost) * b)[0]);
            cost = weights + a.tr_mul(&cost) * (a - b * gain);
        }
        println!("K = {gain:.3}");
        Ok(Self { energy: acrobot.energy(&top), gain, cost })
    }

    /// The torque, and whether it is that of the balance.
    fn torque(&self, acrobot: &Acrobot, state: &State<f64, 2>) -> Result<(f64, bool)> {
        let z = from_top(state);
        if (z.tr_mul(&self.cost) * z)[0] < NEAR {
            return Ok((-(self.gain * z)[0], true));
        }
        let lacking = self.energy - acrobot.energy(state);
        let target = (0.5 * lacking).clamp(-1.5, 1.5) * (10.0 * acrobot.momentum(state)[0]).atan();
        let elbow = FOLLOW[0] * (target - z[1]) - FOLLOW[1] * z[3];
        // The first row of M q̈ = h.
        let (mass, h) = (acrobot.mass_matrix(state), acrobot.forcing(state));
        let shoulder = (h[0] - mass[(0, 1)] * elbow) / mass[(0, 0)];
        Ok((acrobot.inputs_for(state, &[shoulder, elbow].into(), &["torque"])?.inputs[0], false))
    }
}

fn wrapped(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

/// How far a state is from the top, turns aside.
fn from_top(state: &State<f64, 2>) -> Vector4<f64> {
    let [theta, phi] = state.q.into();
    Vector4::new(wrapped(theta - TOP[0]), wrapped(phi - TOP[1]), state.v[0], state.v[1])
}

/// From hanging, a little aside.
fn run(acrobot: Acrobot, controller: &Controller) -> Result<Record> {
    let mut motion = Motion::new(acrobot, State::at_rest([0.01, 0.0]), Dop853::default())?;
    let mut record = Record::default();
    for tick in 1..=(END / TICK).round() as u32 {
        let state = *motion.state();
        let (torque, balances) = controller.torque(motion.system(), &state)?;
        motion.system_mut().torque = torque;
        record.states.push(state);
        record.torques.push((state.t, torque));
        record.energies.push((state.t, motion.system().energy(&state)));
        record.caught = balances.then(|| record.caught.unwrap_or(state.t));
        motion.advance_to(TICK * f64::from(tick))?;
    }
    Ok(record)
}

fn report(record: &Record) -> Result<()> {
    println!("{:>6} {:>10} {:>10} {:>10} {:>10}", "t/s", "θ/rad", "φ/rad", "E/J", "u/N m");
    for (k, state) in record.states.iter().enumerate().step_by(100) {
        let (energy, torque) = (record.energies[k].1, record.torques[k].1);
        println!("{:6.1} {:10.5} {:10.5} {energy:10.4} {torque:10.4}", state.t, state.q[0], state.q[1]);
    }
    println!("\nthe balance has it from t = {:.2} s on", record.caught.ok_or("it was not caught")?);
    let last = record.states.iter().filter(|state| state.t > END - 3.0);
    let off = last.map(|state| from_top(state).amax()).fold(0.0, f64::max);
    println!("in the last 3 s it is off the top by {off:.0e} at most");
    assert!(off < 1e-3, "it does not stand still: {off:e}");
    Ok(())
}

fn draw(acrobot: &Acrobot, controller: &Controller, record: &Record, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 950))?;
    let panels = root.split_evenly((2, 2));
    draw_poses(acrobot, record, &panels[0])?;
    let angle = |i: usize| record.states.iter().map(|state| (state.t, state.q[i])).collect::<Points>();
    draw_two(&panels[1], ["Swung up, and balanced", "angles in rad"], [("θ", &angle(0)), ("φ", &angle(1))])?;
    let top: Points = vec![(0.0, controller.energy), (END, controller.energy)];
    draw_two(&panels[2], ["Its energy", "E in J"], [("at the top", &top), ("E", &record.energies)])?;
    let mut chart = Panel::new("The torque at the elbow", ["t in s", "u in N m"]);
    chart.curve("u", BLUE, &record.torques);
    chart.draw(&panels[3])?;
    root.present()?;
    Ok(())
}

fn draw_two(
    area: &picture::Area,
    [title, name]: [&str; 2],
    [first, second]: [(&str, &Points); 2],
) -> Result<()> {
    let mut chart = Panel::new(title, ["t in s", name]);
    chart.curve(first.0, RED, first.1);
    chart.curve(second.0, BLUE, second.1);
    chart.draw(area)
}

/// The links at moments before it is caught, darker the later, and the way of the tip.
fn draw_poses(acrobot: &Acrobot, record: &Record, area: &picture::Area) -> Result<()> {
    let [l, k] = acrobot.l;
    let mut chart = Panel::new("The last second before the top", ["x in m", "y in m"]).equal_axes();
    let caught = record.caught.ok_or("it was not caught")?;
    let mut tips = Points::new();
    let shown = record.states.iter().filter(|state| (caught - 1.0..caught + 1.5).contains(&state.t));
    for (tick, state) in shown.enumerate() {
        let [theta, phi] = state.q.into();
        let elbow = (l * theta.sin(), -l * theta.cos());
        let tip = (elbow.0 + k * (theta + phi).sin(), elbow.1 - k * (theta + phi).cos());
        tips.push(tip);
        if tick % 10 == 0 {
            let style = GREY.mix(0.2 + 0.8 * tick as f64 / 250.0).stroke_width(2);
            chart.line([(0.0, 0.0), elbow, tip], style);
        }
    }
    chart.curve("tip", BLUE, &tips);
    chart.draw(area)
}
