//! Andrews' squeezing mechanism (W. Schiehlen, *Multibody Systems Handbook*, 1990): seven bodies in the plane, driven by a motor at the
//! crank against a spring, in the seven angles of the benchmark with the six constraints of its three loops.
//!
//! One degree of freedom is left. Bodies 4 and 5 mirror 6 and 7, and all happens in 50 ms: forces of 10² N, accelerations of
//! 10⁶ rad/s². At t = 0.03 s the angles are known to 20 digits, by quadrature.

mod picture;

use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

/// Bodies are numbered from 0. The constant torque of the motor is a term of the potential.
#[derive(Lagrangian)]
#[coordinates(beta, theta, gamma, phi, delta, omega, epsilon)]
#[define(centre = [
    [ra*cos(beta), ra*sin(beta)],
    [rr*cos(beta) - da*cos(beta + theta), rr*sin(beta) - da*sin(beta + theta)],
    [xb + sa*sin(gamma) + sb*cos(gamma), yb - sa*cos(gamma) + sb*sin(gamma)],
    [xa + zt*cos(delta) + (e - ea)*sin(phi + delta), ya + zt*sin(delta) - (e - ea)*cos(phi + delta)],
    [xa + ta*cos(delta) - tb*sin(delta), ya + ta*sin(delta) + tb*cos(delta)],
    [xa + u*sin(epsilon) + (zf - fa)*cos(omega + epsilon), ya - u*cos(epsilon) + (zf - fa)*sin(omega + epsilon)],
    [xa + ua*sin(epsilon) - ub*cos(epsilon), ya - ua*cos(epsilon) - ub*sin(epsilon)]])]
#[define(rate = [beta_dot, beta_dot + theta_dot, gamma_dot, phi_dot + delta_dot, delta_dot,
    omega_dot + epsilon_dot, epsilon_dot])]
#[define(hook = [sd*cos(gamma) + sc*sin(gamma) + xb, sd*sin(gamma) - sc*cos(gamma) + yb])]
#[define(stretched = norm(hook - [xc, yc]) - l0)]
#[lagrangian(sum(i in 0..7, m[i]/2*dot(der(centre[i]), der(centre[i])) + inertia[i]/2*rate[i]^2)
    - c0/2*stretched^2 + motor*beta)]
#[define(joint = [rr*cos(beta) - d*cos(beta + theta), rr*sin(beta) - d*sin(beta + theta)])]
#[constraint(third: joint = [ss*sin(gamma) + xb, yb - ss*cos(gamma)])]
#[constraint(fifth: joint = [e*sin(phi + delta) + zt*cos(delta) + xa, zt*sin(delta) - e*cos(phi + delta) + ya])]
#[constraint(seventh: joint = [zf*cos(omega + epsilon) + u*sin(epsilon) + xa,
    zf*sin(omega + epsilon) - u*cos(epsilon) + ya])]
// For the picture: where bodies meet.
#[observable(crank = [rr*cos(beta), rr*sin(beta)])]
#[observable(middle = joint)]
#[observable(lever = hook)]
#[observable(upper = [xa + zt*cos(delta), ya + zt*sin(delta)])]
#[observable(lower = [xa + u*sin(epsilon), ya - u*cos(epsilon)])]
#[observable(pull = c0*stretched)]
struct Squeezer {
    m: [f64; 7],
    inertia: [f64; 7],
    xa: f64,
    ya: f64,
    xb: f64,
    yb: f64,
    xc: f64,
    yc: f64,
    c0: f64,
    l0: f64,
    motor: f64,
    d: f64,
    da: f64,
    e: f64,
    ea: f64,
    rr: f64,
    ra: f64,
    ss: f64,
    sa: f64,
    sb: f64,
    sc: f64,
    sd: f64,
    ta: f64,
    tb: f64,
    u: f64,
    ua: f64,
    ub: f64,
    zf: f64,
    zt: f64,
    fa: f64,
}

const SQUEEZER: Squeezer = Squeezer {
    m: [0.043_25, 0.003_65, 0.023_73, 0.007_06, 0.070_5, 0.007_06, 0.054_98],
    inertia: [2.194e-6, 4.41e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5],
    xa: -0.069_34,
    ya: -0.002_27,
    xb: -0.036_35,
    yb: 0.032_73,
    xc: 0.014,
    yc: 0.072,
    c0: 4530.0,
    l0: 0.077_85,
    motor: 0.033,
    d: 0.028,
    da: 0.011_5,
    e: 0.02,
    ea: 0.014_21,
    rr: 0.007,
    ra: 0.000_92,
    ss: 0.035,
    sa: 0.018_74,
    sb: 0.010_43,
    sc: 0.018,
    sd: 0.02,
    ta: 0.023_08,
    tb: 0.009_16,
    u: 0.04,
    ua: 0.012_28,
    ub: 0.004_49,
    zf: 0.02,
    zt: 0.04,
    fa: 0.014_21,
};

const END: f64 = 0.05;
/// β and its rate at t = 0.03 s.
const KNOWN: [f64; 2] = [15.810_771_195_153_707, 1_139.920_302_259_106_2];

fn main() -> Result<()> {
    // θ = 0, at rest: the other angles are those that close the loops, near a guess.
    let rough = State::at_rest([-0.06, 0.0, 0.45, 0.22, 0.49, -0.22, 1.23]);
    let (start, _) = SQUEEZER.make_consistent_holding(&rough, &["theta"])?;
    let path = SQUEEZER.integrate(start, END, Taylor::default())?;

    println!(
        "{:>6} {:>12} {:>12} {:>12} {:>14} {:>12}",
        "t/ms", "β/rad", "γ/rad", "φ/rad", "crank in rad/s", "spring in N"
    );
    for sample in path.samples(11) {
        let State { t, q, v } = sample.state();
        let pull = sample.observable("pull")?;
        println!("{:6.1} {:12.6} {:12.6} {:12.6} {:14.2} {pull:12.4}", 1e3 * t, q[0], q[2], q[3], v[0]);
    }

    let known = path.at(0.03)?;
    let errors = [known.state().q[0] / KNOWN[0] - 1.0, known.state().v[0] / KNOWN[1] - 1.0];
    let energy = SQUEEZER.energy(&start);
    let worst = |off: &dyn Fn(&State<f64, 7>) -> f64| {
        path.samples(501).map(|sample| off(sample.state()).abs()).fold(0.0, f64::max)
    };
    let laws = [
        ("β at 0.03 s, of what is known by quadrature", errors[0].abs(), 1e-13),
        ("its rate", errors[1].abs(), 1e-12),
        ("energy with the work of the motor, in J", worst(&|state| SQUEEZER.energy(state) - energy), 1e-12),
        ("bodies 4 and 5 mirror 6 and 7: φ + ω, in rad", worst(&|state| state.q[3] + state.q[5]), 1e-13),
    ];
    println!("\nin {} steps of Taylor's method, off by", path.statistics().accepted);
    for (law, off, most) in laws {
        println!("  {law:<48} {off:8.1e}");
        assert!(off < most, "{law}: {off:e}");
    }
    let file = picture::path("andrews_squeezer")?;
    draw(&path, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

fn draw(path: &Trajectory<&Squeezer>, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1200, 1000))?;
    let (poses, curves) = root.split_vertically(picture::px(520));
    for (area, t) in poses.split_evenly((1, 3)).iter().zip([0.0, 0.0095, 0.0112]) {
        draw_pose(&path.at(t)?, area)?;
    }
    let panels = curves.split_evenly((1, 2));
    let curve = |of: &dyn Fn(&State<f64, 7>) -> f64| -> Points {
        path.samples(1000).map(|sample| (1e3 * sample.time(), of(sample.state()))).collect()
    };
    let mut chart = Panel::new("Angles: β turns on, the others swing", ["t in ms", "rad"]);
    chart.curve("β/20", BLACK, &curve(&|state| state.q[0] / 20.0));
    chart.curve("γ of the spring's lever", BLUE, &curve(&|state| state.q[2]));
    chart.curve("φ of body 4 on 5", RED, &curve(&|state| state.q[3]));
    chart.curve("δ of body 5", GREY, &curve(&|state| state.q[4]));
    chart.draw(&panels[0])?;
    let mut chart = Panel::new("Forces at the joint of all loops", ["t in ms", "N"]);
    for (constraint, color) in [("third", BLUE), ("fifth", RED), ("seventh", GREY)] {
        let mut force = Points::new();
        for sample in path.samples(1000) {
            let [x, y] = [0, 1].map(|k| sample.multiplier(&format!("{constraint}[{k}]")));
            force.push((1e3 * sample.time(), x?.hypot(y?)));
        }
        chart.curve(&format!("on the {constraint} body"), color, &force);
    }
    chart.draw(&panels[1])?;
    root.present()?;
    Ok(())
}

fn draw_pose(sample: &lagrange_core::Sample<&Squeezer>, area: &picture::Area) -> Result<()> {
    let state = sample.state();
    let point = |of: nalgebra::Vector2<f64>| (1e3 * of[0], 1e3 * of[1]);
    let [crank, middle, lever, upper, lower] = [
        SQUEEZER.crank(state),
        SQUEEZER.middle(state),
        SQUEEZER.lever(state),
        SQUEEZER.upper(state),
        SQUEEZER.lower(state),
    ]
    .map(point);
    let fixed = |x: f64, y: f64| (1e3 * x, 1e3 * y);
    let Squeezer { xa, ya, xb, yb, xc, yc, .. } = SQUEEZER;
    let [origin, a, b, c] = [fixed(0.0, 0.0), fixed(xa, ya), fixed(xb, yb), fixed(xc, yc)];
    let ranges = [-85.0..25.0, -50.0..80.0];
    let title = format!("t = {:.1} ms", 1e3 * state.t);
    let mut chart = Panel::new(&title, ["x in mm", "y in mm"]).within(ranges).equal_axes();
    chart.face([b, middle, lever], BLUE.mix(0.25));
    chart.line([b, middle, lever, b], BLUE.stroke_width(2));
    chart.line([lever, c], GREY.stroke_width(1));
    chart.line([a, upper, middle], RED.stroke_width(3));
    chart.line([a, lower, middle], RED.stroke_width(3));
    chart.line([crank, middle], BLACK.stroke_width(3));
    chart.line([origin, crank], BLACK.stroke_width(5));
    chart.dots("fixed", GREY, &vec![origin, a, b, c]);
    chart.specks(3, BLACK, [crank, middle, upper, lower, lever]);
    chart.draw(area)
}
