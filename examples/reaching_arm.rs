//! An arm of seven joints hangs from the ceiling, swings up, and comes to rest in a pose above it.
//!
//! The torques come from iLQR (Y. Tassa, T. Erez and E. Todorov, "Synthesis and stabilization of complex behaviors through
//! online trajectory optimization", IROS 2012): the motion in steps of 10 ms, in which torques are held, is linearised
//! along the present plan, which Riccati's recursion improves. Then an arm whose links are heavier than the plan's is led along the
//! plan by computed-torque control at 1 kHz.

mod picture;

use lagrange_core::linearized::DiscreteTime;
use lagrange_core::nalgebra::{DMatrix, DVector, Matrix3, SVector, Vector3};
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

/// Shoulder, elbow and wrist of three joints, one and three; z points down.
#[derive(Clone, Lagrangian)]
#[coordinates(q: [7])]
#[define(d = [0.34, 0, 0.4, 0, 0.4, 0, 0.126])]
#[define(alpha = [-pi/2, pi/2, pi/2, -pi/2, -pi/2, pi/2, 0])]
#[frame(link[0]: rotate_z(q[0]), translate([0, 0, d[0]]), rotate_x(alpha[0]))]
#[frame(link[i in 1..7] in link[i-1]: rotate_z(q[i]), translate([0, 0, d[i]]), rotate_x(alpha[i]))]
#[parameter(body: [7] {m, centre: [3], inertia: symmetric})]
#[lagrangian(sum(i in 0..7,
    kinetic(link[i], body[i].m, body[i].centre, body[i].inertia) + rotor/2*q_dot[i]^2
        + body[i].m*g*position(link[i], body[i].centre)[2]
))]
#[dissipation(c/2 * sum(i in 0..7, q_dot[i]^2))]
#[force(q: torque)]
#[observable(shoulder = position(link[0]))]
#[observable(elbow = position(link[2]))]
#[observable(wrist = position(link[4]))]
#[observable(tip = position(link[6]))]
struct Arm {
    body: [Body; 7],
    g: f64,
    /// Inertia of a motor about its joint, behind its gears.
    rotor: f64,
    c: f64,
    torque: SVector<f64, 7>,
}

type Torques = SVector<f64, 7>;
type Plan = Vec<(State<f64, 7>, Torques)>;

/// Length of a step of the plan.
const STEP: f64 = 0.01;
const STEPS: usize = 200;
/// Steps of the controller in a step of the plan.
const TICKS: usize = 10;
/// Where the arm shall be at rest.
const POSE: [f64; 7] = [0.8, 2.3, 0.2, -1.2, 0.3, 0.9, 0.0];

fn main() -> Result<()> {
    let arm = Arm::new(1.0);
    let start = State::at_rest([0.0; 7]);
    let goal = State::at_rest(POSE);
    println!("from {:.3?} m to {:.3?} m", arm.tip(&start).as_slice(), arm.tip(&goal).as_slice());
    let mut planner = Planner::new(arm.clone(), start)?;
    let plan = planner.improve(60)?;
    let heavier = Arm::new(1.1);
    let driven = track(&arm, &heavier, &plan)?;
    let (last, end) = (plan[STEPS].0, driven[STEPS]);
    println!(
        "the plan ends {:.1e} rad from the pose, at {:.1e} rad/s",
        (last.q - goal.q).amax(),
        last.v.amax()
    );
    println!("links 10 % heavier, led along it at 1 kHz: {:.1e} rad from the pose", (end.q - goal.q).amax());
    let file = picture::path("reaching_arm")?;
    draw(&arm, &plan, &driven, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

impl Arm {
    fn new(weight: f64) -> Self {
        let body = |m: f64, along: f64, length: f64| {
            let across = m * (length * length / 12.0 + 0.002);
            let diagonal = [across, across, 0.003 * m];
            Body {
                m: weight * m,
                centre: Vector3::new(0.0, 0.0, along),
                inertia: weight * Matrix3::from_diagonal(&diagonal.into()),
            }
        };
        Self {
            body: [
                body(4.0, 0.0, 0.1),
                body(4.0, 0.15, 0.3),
                body(3.0, 0.0, 0.1),
                body(2.7, 0.15, 0.3),
                body(1.7, 0.0, 0.1),
                body(1.6, 0.05, 0.1),
                body(0.3, -0.02, 0.05),
            ],
            g: 9.81,
            rotor: 0.05,
            c: 0.5,
            torque: Torques::zeros(),
        }
    }
}

/// A plan, and what each step makes of a change of it.
struct Planner {
    arm: DiscreteTime<Arm, RungeKutta4>,
    plan: Plan,
    cost: f64,
}

/// Change of the torques of a step, and their feedback on a change of the state.
type Correction = (DVector<f64>, DMatrix<f64>);

fn vector(state: &State<f64, 7>) -> DVector<f64> {
    DVector::from_iterator(14, state.q.iter().chain(&state.v).copied())
}

/// Weight of (N m)² s.
const EFFORT: f64 = 2e-4;

/// Weights of the pose and of rest at the end.
fn at_end(state: &State<f64, 7>) -> (f64, DVector<f64>, DMatrix<f64>) {
    let off = vector(state) - vector(&State::at_rest(POSE));
    let weights = DVector::from_fn(14, |i, _| if i < 7 { 400.0 } else { 4.0 });
    let slope = weights.component_mul(&off);
    (off.dot(&slope) / 2.0, slope, DMatrix::from_diagonal(&weights))
}

impl Planner {
    /// At rest without torques.
    fn new(arm: Arm, start: State<f64, 7>) -> Result<Self> {
        let arm = DiscreteTime::new(arm, RungeKutta4::with_step(STEP), &["torque"])?;
        let mut planner = Self { arm, plan: vec![(start, Torques::zeros()); STEPS + 1], cost: f64::INFINITY };
        let none = vec![(DVector::zeros(7), DMatrix::zeros(7, 14)); STEPS];
        (planner.plan, planner.cost) = planner.moved(&none, 0.0)?;
        Ok(planner)
    }

    /// Improves the plan until its cost falls by less than a millionth, and returns it.
    fn improve(&mut self, most: usize) -> Result<Plan> {
        let mut damping = 1e-3;
        for round in 1..=most {
            let corrections = self.corrections(damping)?;
            let tried = (0..8).find_map(|k| {
                let moved = self.moved(&corrections, 0.5_f64.powi(k)).ok()?;
                (moved.1 < self.cost).then_some(moved)
            });
            let Some((plan, cost)) = tried else {
                damping *= 10.0;
                continue;
            };
            let gain = (self.cost - cost) / cost;
            (self.plan, self.cost, damping) = (plan, cost, damping * 0.5);
            if round % 10 == 0 || gain < 1e-6 {
                println!("  round {round}: cost {cost:.6}");
            }
            if gain < 1e-6 {
                break;
            }
        }
        Ok(self.plan.clone())
    }

    /// The plan with corrections, and its cost.
    fn moved(&self, corrections: &[Correction], part: f64) -> Result<(Plan, f64)> {
        let mut motion =
            Motion::new(self.arm.system().clone(), self.plan[0].0, RungeKutta4::with_step(STEP))?;
        let (mut plan, mut cost) = (Plan::new(), 0.0);
        for (k, ((planned, torques), (change, feedback))) in self.plan.iter().zip(corrections).enumerate() {
            let state = *motion.state();
            let back = feedback * (vector(&state) - vector(planned));
            let torques = Torques::from_fn(|i, _| torques[i] + part * change[i] + back[i]);
            cost += STEP * EFFORT / 2.0 * torques.norm_squared();
            plan.push((state, torques));
            motion.system_mut().torque = torques;
            motion.advance_to(STEP * (k + 1) as f64)?;
        }
        plan.push((*motion.state(), Torques::zeros()));
        Ok((plan, cost + at_end(motion.state()).0))
    }

    /// Corrections of all steps by Riccati's recursion from the end.
    fn corrections(&mut self, damping: f64) -> Result<Vec<Correction>> {
        let (_, mut slope, mut curvature) = at_end(&self.plan[STEPS].0);
        let mut corrections = Vec::new();
        for k in (0..STEPS).rev() {
            let (state, torques) = &self.plan[k];
            self.arm.system_mut().torque = *torques;
            self.arm.advance(state, STEP * (k + 1) as f64)?;
            let (a, b) = (self.arm.a(), self.arm.b());
            let by_torques =
                DVector::from_column_slice(torques.as_slice()) * (STEP * EFFORT) + b.tr_mul(&slope);
            let held = DMatrix::identity(7, 7) * (STEP * EFFORT);
            let twice = &held + b.tr_mul(&(&curvature * b));
            let damped = &twice + b.tr_mul(b) * damping;
            let mixed = b.tr_mul(&(&curvature * a));
            let solver = damped.cholesky().ok_or("the quadratic model is not convex")?;
            let (change, feedback) = (-solver.solve(&by_torques), -solver.solve(&mixed));
            slope =
                a.tr_mul(&slope) + feedback.tr_mul(&(&twice * &change + &by_torques)) + mixed.tr_mul(&change);
            curvature = a.tr_mul(&(&curvature * a))
                + feedback.tr_mul(&(&twice * &feedback))
                + feedback.tr_mul(&mixed)
                + mixed.tr_mul(&feedback);
            curvature = (&curvature + curvature.transpose()) * 0.5;
            corrections.push((change, feedback));
        }
        corrections.reverse();
        Ok(corrections)
    }
}

/// Leads an arm along the plan by the torques that `model` needs for the planned accelerations, corrected by what the arm is
/// off. Returns the states at the steps of the plan.
fn track(model: &Arm, arm: &Arm, plan: &Plan) -> Result<Vec<State<f64, 7>>> {
    let tick = STEP / TICKS as f64;
    let mut driven = Motion::new(arm.clone(), plan[0].0, RungeKutta4::with_step(tick))?;
    let mut states = vec![*driven.state()];
    for pair in plan.windows(2) {
        for j in 0..TICKS {
            let (q, v, acceleration) = between(&pair[0].0, &pair[1].0, j as f64 / TICKS as f64);
            let state = *driven.state();
            let acceleration = acceleration + 2500.0 * (q - state.q) + 100.0 * (v - state.v);
            driven.system_mut().torque = model.inverse_dynamics(&state, &acceleration, &SVector::zeros());
            driven.advance_to(pair[0].0.t + tick * (j + 1) as f64)?;
        }
        states.push(*driven.state());
    }
    Ok(states)
}

/// Angles, velocities and accelerations at a part of a step of the plan, by the cubic through its ends.
fn between(a: &State<f64, 7>, b: &State<f64, 7>, x: f64) -> (Torques, Torques, Torques) {
    let (rise, h) = ((b.q - a.q) / STEP, STEP);
    let (second, third) = ((3.0 * rise - 2.0 * a.v - b.v) / h, (a.v + b.v - 2.0 * rise) / (h * h));
    let t = x * h;
    let q = a.q + t * (a.v + t * (second + t * third));
    (q, a.v + t * (2.0 * second + 3.0 * t * third), 2.0 * second + 6.0 * t * third)
}

fn draw(arm: &Arm, plan: &Plan, driven: &[State<f64, 7>], file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 480))?;
    let panels = root.split_evenly((1, 2));
    // Seen obliquely; up is up.
    let project = |p: Vector3<f64>| (p[0] + 0.5 * p[1], -p[2] + 0.2 * p[1]);
    let mut chart = Panel::new("From hanging to the pose, every 0.2 s", ["", ""]).equal_axes();
    for k in (0..=STEPS).step_by(20) {
        let s = &driven[k];
        let joints = [Vector3::zeros(), arm.shoulder(s), arm.elbow(s), arm.wrist(s), arm.tip(s)];
        let style = GREY.mix(0.15 + 0.85 * k as f64 / STEPS as f64).stroke_width(3);
        chart.line(joints.map(project), style);
    }
    let tips: Points = driven.iter().map(|s| project(arm.tip(s))).collect();
    chart.curve("tip", RED, &tips);
    chart.draw(&panels[0])?;
    let of = |i: usize| -> Points { plan[..STEPS].iter().map(|(s, torque)| (s.t, torque[i])).collect() };
    let curves = [0, 1, 3].map(of);
    let mut chart = Panel::new("Torques of the plan", ["t in s", "torque in N m"]);
    for (curve, (name, color)) in
        curves.iter().zip([("turn of the shoulder", BLACK), ("shoulder", RED), ("elbow", BLUE)])
    {
        chart.curve(name, color, curve);
    }
    chart.draw(&panels[1])?;
    root.present()?;
    Ok(())
}
