//! A05 of the IFToMM benchmark: a flyball governor, whose springs and dampers are stiff. Its two arms move alike.
//!
//! No values are known from elsewhere: methods and step lengths are compared with each other, and the energy with the work of the
//! dampers.

use lagrange_core::prelude::*;

use crate::reference::{IS_LONG, Known, Problem};

/// The angle of the shaft, that of the arms from the downward vertical, and the height of the slider. Shaft and arms are bars
/// 1 m × 1 cm × 1 cm of mass m, the slider is a cube of 10 cm, and point masses hang at the ends of the arms.
#[derive(Lagrangian)]
#[coordinates(psi, a, s)]
#[define(along = m*1e-4/6)]
#[define(across = m*(1 + 1e-4)/12)]
#[define(arm = m/2*((0.05 + sin(a)/2)^2*psi_dot^2 + a_dot^2/4) + across/2*(a_dot^2 + psi_dot^2*sin(a)^2)
    + along/2*psi_dot^2*cos(a)^2 + ball/2*((0.05 + sin(a))^2*psi_dot^2 + a_dot^2))]
#[define(height = m*(1 - cos(a)/2) + ball*(1 - cos(a)))]
#[define(length = norm([sin(a)/2, 1 - cos(a)/2 - s]))]
#[lagrangian((along + slider*0.01/6)*psi_dot^2/2 + slider*s_dot^2/2 + 2*arm
    - slider*g*s - 2*g*height - k*(length - 0.5)^2)]
#[dissipation(c*der(length)^2)]
#[observable(lost = 2*c*der(length)^2)]
struct Governor {
    m: f64,
    slider: f64,
    ball: f64,
    k: f64,
    c: f64,
    g: f64,
}

const GOVERNOR: Governor = Governor { m: 0.3, slider: 3.0, ball: 5.0, k: 8e5, c: 4e4, g: 9.81 };

fn start() -> State<f64, 3> {
    State::new([0.0, std::f64::consts::FRAC_PI_3, 0.5], [std::f64::consts::TAU, 0.0, 0.0])
}

/// Nodes and weights of Gauss's quadrature with three points on −1 … 1.
const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

/// The work of the dampers, summed over the steps.
fn lost(path: &Trajectory<&Governor>) -> f64 {
    let times: Vec<f64> = path.steps().map(|step| step.time()).collect();
    let step = |pair: &[f64]| -> f64 {
        let (middle, half) = (f64::midpoint(pair[0], pair[1]), (pair[1] - pair[0]) / 2.0);
        GAUSS
            .iter()
            .map(|(node, weight)| {
                let state = *path.at(middle + node * half).unwrap().state();
                weight * half * GOVERNOR.lost(&state)
            })
            .sum()
    };
    times.windows(2).map(step).sum()
}

#[test]
fn methods_and_step_lengths_agree_and_energy_balances() {
    let end = if IS_LONG { 10.0 } else { 1.0 };
    let fine =
        GOVERNOR.motion(start()).by(Dop853::with_tolerance(1e-13).max_steps(1_000_000)).to(end).unwrap();
    let known = (0..=4).map(|k| {
        let state = *fine.at(end * f64::from(k) / 4.0).unwrap().state();
        Known { t: state.t, q: state.q.into(), v: state.v.into(), lambda: Some([]) }
    });
    let problem = Problem { name: "A05 governor", system: GOVERNOR, known: known.collect() };
    let bar = [1e-7, 1e-7, 0.0];
    problem.row("Taylor 2⁻⁵²", Taylor::default()).reaches(bar);
    problem.row("Dop853 1e-10", Dop853::with_tolerance(1e-10).max_steps(1_000_000)).reaches(bar);
    problem.row("Radau 1e-10", Radau::with_tolerance(1e-10)).reaches(bar);
    problem.row("RungeKutta4 1e-4 s", RungeKutta4::with_step(1e-4).max_steps(1_000_000)).reaches(bar);
    problem.row("RungeKutta4 5e-5 s", RungeKutta4::with_step(5e-5).max_steps(1_000_000)).reaches(bar);
    if IS_LONG {
        problem.row("Dopri5 1e-10", Dopri5::with_tolerance(1e-10).max_steps(1_000_000)).reaches(bar);
    }
    let (energy, lost) = (GOVERNOR.energy(&start()), lost(&fine));
    let balance = fine.end().energy() + lost - energy;
    println!("energy {energy}, lost {lost}, balance {balance:e}");
    assert!(lost > 1e-3 && balance.abs() < 1e-7 * lost, "{energy} {lost} {balance}");
    // Nothing turns the shaft.
    let turn = |state: &State<f64, 3>| GOVERNOR.momentum(state)[0];
    assert!((turn(fine.end().state()) / turn(&start()) - 1.0).abs() < 1e-12);
}
