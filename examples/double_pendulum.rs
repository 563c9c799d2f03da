//! A double pendulum that falls from the horizontal, to round-off: what Taylor's method takes for it, and where it ends.
//!
//! From this start every fourth coefficient of the series alone is not zero. Who chooses steps by the last two is fooled.

mod picture;

use std::f64::consts::FRAC_PI_2;
use std::time::Instant;

use lagrange_core::{Method, prelude::*};
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

/// Two bobs of mass m on rods of length l, by the rods' angles from the vertical.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(a, b)]
#[define(v2_upper = l^2*a_dot^2)]
#[define(v2_lower = l^2*(a_dot^2 + b_dot^2 + 2*a_dot*b_dot*cos(a - b)))]
#[lagrangian(m/2*(v2_upper + v2_lower) + m*g*l*(2*cos(a) + cos(b)))]
struct DoublePendulum {
    m: f64,
    l: f64,
    g: f64,
}

type Path<'a> = Trajectory<&'a DoublePendulum>;

const PENDULUM: DoublePendulum = DoublePendulum { m: 1.0, l: 1.0, g: 9.81 };
/// In seconds.
const END: f64 = 10.0;
/// The angles there, of which another Taylor method gives 28 digits with 113 bits, and the same ones with 170.
const KNOWN: [f64; 2] = [-0.568_474_664_015_950_2, -0.526_393_727_932_404_7];

fn start() -> State<f64, 2> {
    State::at_rest([FRAC_PI_2; 2])
}

fn main() -> Result<()> {
    println!(
        "Double pendulum, let go from the horizontal, to t = {END} s; an error of the start grows 143 times.
Of a series each order counts as an evaluation.\n"
    );
    println!(
        "{:<20} {:>6} {:>12} {:>10} {:>8} {:>10} {:>10}",
        "method", "steps", "evaluations", "µs a step", "µs", "angles off", "energy off"
    );
    for tolerance in [1e-6, 1e-9, 1e-12, f64::EPSILON] {
        measure(&format!("Taylor {tolerance:.0e}"), Taylor::with_tolerance(tolerance))?;
    }
    for tolerance in [1e-6, 1e-9, 1e-12, 1e-15] {
        measure(&format!("Dop853 {tolerance:.0e}"), Dop853::with_tolerance(tolerance))?;
    }
    let taylor = PENDULUM.integrate(start(), END, Taylor::default())?;
    let other = PENDULUM.integrate(start(), END, Dop853::with_tolerance(1e-15))?;
    let off = off(taylor.end().state());
    assert!(off < 1e-12, "{off:e}");
    let file = picture::path("double_pendulum")?;
    draw(&taylor, &other, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

/// How far the angles are from what is known.
fn off(state: &State<f64, 2>) -> f64 {
    (state.q - lagrange_core::nalgebra::SVector::from(KNOWN)).amax()
}

/// The least time of many runs, in which nothing is stored.
fn measure(name: &str, method: impl Method<DoublePendulum> + Copy) -> Result<()> {
    let mut best = f64::INFINITY;
    let mut motion = Motion::new(PENDULUM, start(), method)?;
    for _ in 0..20 {
        motion = Motion::new(PENDULUM, start(), method)?;
        let begun = Instant::now();
        motion.advance_to(END)?;
        best = best.min(1e6 * begun.elapsed().as_secs_f64());
    }
    let (state, statistics) = (motion.state(), motion.statistics());
    let energy = (PENDULUM.energy(state) - PENDULUM.energy(&start())).abs();
    println!(
        "{name:<20} {:6} {:12} {:10.2} {best:8.0} {:10.1e} {energy:8.1e} J",
        statistics.accepted,
        statistics.evaluations,
        best / statistics.accepted as f64,
        off(state),
    );
    Ok(())
}

fn draw(taylor: &Path<'_>, other: &Path<'_>, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1150, 560))?;
    let (left, right) = root.split_horizontally(picture::px(520));
    draw_motion(taylor, &left)?;
    let right = right.split_evenly((2, 1));
    draw_steps(taylor, other, &right[0])?;
    draw_energy(taylor, other, &right[1])?;
    root.present()?;
    Ok(())
}

/// The bobs, upper and lower.
fn bobs(state: &State<f64, 2>) -> [(f64, f64); 2] {
    let [a, b] = [state.q[0], state.q[1]].map(f64::sin_cos);
    [(a.0, -a.1), (a.0 + b.0, -a.1 - b.1)]
}

fn draw_motion(path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let moments: Vec<_> = path.samples(2001).map(|sample| bobs(sample.state())).collect();
    let of = |k: usize| -> Points { moments.iter().map(|bobs| bobs[k]).collect() };
    let (upper, lower) = (of(0), of(1));
    let mut chart = Panel::new("The bobs in 10 s", ["x in m", "y in m"]).equal_axes();
    chart.curve("upper bob", GREY, &upper);
    chart.curve("lower bob", BLUE, &lower);
    let rods = |k: usize| [(0.0, 0.0), moments[k][0], moments[k][1]];
    for k in [0, 2000] {
        chart.line(rods(k), BLACK.stroke_width(3));
    }
    chart.dots("at the start and at the end", RED, &[rods(0), rods(2000)].concat());
    chart.draw(area)
}

/// In ms.
fn steps(path: &Path<'_>) -> Points {
    let times: Vec<f64> = path.steps().map(|sample| sample.time()).collect();
    times.windows(2).map(|pair| (pair[0], 1e3 * (pair[1] - pair[0]))).collect()
}

fn draw_steps(taylor: &Path<'_>, other: &Path<'_>, area: &picture::Area) -> Result<()> {
    let (ours, theirs) = (steps(taylor), steps(other));
    let mut chart = Panel::new("Steps", ["t in s", "length in ms"]);
    chart.curve(&format!("Taylor: {}", ours.len()), BLUE, &ours);
    chart.curve(&format!("Dop853, tolerance 10⁻¹⁵: {}", theirs.len()), RED, &theirs);
    chart.draw(area)
}

/// In 10⁻¹³ J.
fn gained(path: &Path<'_>) -> Points {
    let before = path.start().energy();
    path.steps().map(|sample| (sample.time(), 1e13 * (sample.energy() - before))).collect()
}

fn draw_energy(taylor: &Path<'_>, other: &Path<'_>, area: &picture::Area) -> Result<()> {
    let (ours, theirs) = (gained(taylor), gained(other));
    let mut chart = Panel::new("Energy gained", ["t in s", "in 10⁻¹³ J"]);
    chart.curve("Dop853, tolerance 10⁻¹⁵", RED, &theirs);
    chart.curve("Taylor", BLUE, &ours);
    chart.draw(area)
}
