//! Long motions and costs: the energy errors of methods over a million turns of an ellipse, which takes some minutes, and
//! work–precision diagrams of all methods that apply on six systems.
//!
//! The ends of the motions are known: four from other programs, one in closed form, and the stiff one by two methods.
//! A point of a diagram is a run with one step length or one tolerance.

mod picture;

use std::f64::consts::{FRAC_PI_2, TAU};
use std::time::Instant;

use lagrange_core::motion::Composition::{KahanLi6, KahanLi8, Suzuki4};
use lagrange_core::nalgebra::{Const, SVector};
use lagrange_core::{Method, prelude::*};
use picture::{Area, Panel, Points, Result};
use plotters::prelude::RGBColor;

#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 + 1/sqrt(x^2 + y^2))]
struct Kepler;

#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - (x^2 + y^2)/2 - x^2*y + y^3/3)]
struct HenonHeiles;

/// Two equal pendulums, one below the other, in angles.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(a, b)]
#[lagrangian(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b) + 2*g*cos(a) + g*cos(b))]
struct DoublePendulum {
    g: f64,
}

/// A bob on a rod, in Cartesian coordinates.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 - g*z)]
#[constraint(rod: x^2 + y^2 + z^2 = 1)]
struct SphericalPendulum {
    g: f64,
}

/// A skate on a plane that falls towards x.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y, theta)]
#[lagrangian((x_dot^2 + y_dot^2 + theta_dot^2)/2 + x)]
#[constraint(blade: x_dot*sin(theta) - y_dot*cos(theta) = 0)]
struct Skate;

/// A pendulum in honey: the velocity decays at the rate c, the angle at the rate k/c.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(phi)]
#[lagrangian(phi_dot^2/2 + k*cos(phi))]
#[dissipation(c/2*phi_dot^2)]
struct Honey {
    k: f64,
    c: f64,
}

const G: f64 = 9.81;
/// Turns of the ellipse.
const TURNS: f64 = 1e6;
/// Longest run that is drawn, in µs.
const LONGEST: f64 = 3e4;

/// A curve: the name of the method, its colour, and the points.
#[derive(Clone)]
struct Curve {
    name: &'static str,
    color: RGBColor,
    points: Points,
}

/// Energy errors over many turns, and the means of evaluations and of µs a turn.
struct LongRun {
    curve: Curve,
    evaluations: f64,
    time: f64,
}

const ORDER_2: RGBColor = RGBColor(140, 196, 236);
const ORDER_4: RGBColor = RGBColor(74, 150, 214);
const ORDER_6: RGBColor = RGBColor(31, 98, 168);
const ORDER_8: RGBColor = RGBColor(12, 44, 100);
const STAGES_2: RGBColor = RGBColor(240, 178, 60);
const STAGES_4: RGBColor = RGBColor(214, 122, 10);
const DOP853: RGBColor = RGBColor(196, 64, 48);
const DOPRI5: RGBColor = RGBColor(236, 150, 140);
const TAYLOR: RGBColor = RGBColor(40, 40, 40);
const RADAU: RGBColor = RGBColor(52, 140, 84);

fn main() -> Result<()> {
    let errors = energy_errors()?;
    println!("Kepler, e = 0.5: largest relative error of the energy during a turn\n");
    println!(
        "{:<28} {:>10} {:>12} {:>10} {:>12}",
        "",
        "first turn",
        format!("turn {TURNS:.0}"),
        "µs a turn",
        "evaluations"
    );
    for LongRun { curve: Curve { name, points, .. }, evaluations, time } in &errors {
        let [first, last] =
            [points.first(), points.last()].map(|point| point.map_or(f64::NAN, |p| 10_f64.powf(p.1)));
        println!("{name:<28} {first:>10.1e} {last:>12.1e} {time:>10.1} {evaluations:>12.0}");
    }
    let file = picture::path("long_time")?;
    let sheet = picture::sheet(&file, (900, 520))?;
    let axes = ["log₁₀ of the time in turns", "log₁₀ of the relative error of the energy"];
    let curves: Vec<_> = errors.into_iter().map(|run| run.curve).collect();
    draw("Energy over a million turns of an ellipse, e = 0.5", axes, &curves, &sheet)?;
    sheet.present()?;
    println!("picture: {}\n", file.display());

    println!("Time in µs of the cheapest run whose error is at most that:");
    let file = picture::path("work_precision")?;
    let sheet = picture::sheet(&file, (1200, 900))?;
    let axes = ["digits that are right", "log₁₀ of time in µs"];
    for ((title, curves), area) in diagrams()?.iter().zip(sheet.split_evenly((2, 3))) {
        println!("\n{title:<40} {:>8} {:>8} {:>8}", "1e-3", "1e-6", "1e-9");
        for Curve { name, points, .. } in curves {
            let cells = [3.0, 6.0, 9.0].map(|digits| cell(points, digits));
            println!("    {name:<36} {}", cells.join(" "));
        }
        draw(title, axes, curves, &area)?;
    }
    sheet.present()?;
    println!("\npicture: {}", file.display());
    Ok(())
}

fn draw(title: &str, axes: [&str; 2], curves: &[Curve], area: &Area) -> Result<()> {
    let mut panel = Panel::new(title, axes);
    for Curve { name, color, points } in curves {
        panel.curve(name, *color, points);
        panel.specks(2, *color, points.iter().copied());
    }
    panel.draw(area)
}

fn cell(points: &Points, digits: f64) -> String {
    let exact = points.iter().filter(|point| point.0 >= digits);
    let least = exact.map(|point| 10_f64.powf(point.1)).min_by(f64::total_cmp);
    least.map_or_else(|| format!("{:>8}", "–"), |time| format!("{time:8.0}"))
}

/// Energy errors of methods that take about 1000 evaluations of the forces in a turn, and of methods with step control.
///
/// No step is a fraction of a turn: such steps resonate with the motion, and the error of `Gauss::<4>` with 40 steps a turn
/// grows from 8·10⁻⁹ to 4·10⁻⁶.
fn energy_errors() -> Result<Vec<LongRun>> {
    let [many, of_order_4, of_order_6, of_order_8, of_gauss, of_classical] =
        [1000.38, 200.38, 110.38, 60.38, 40.38, 250.38].map(|count| TAU / count);
    let verlet = |step| Verlet::with_step(step).max_steps(usize::MAX);
    let gauss = Gauss::<4>::with_step(of_gauss).max_steps(usize::MAX);
    let lobatto = Lobatto::<4>::with_step(of_gauss).max_steps(usize::MAX);
    let classical = RungeKutta4::with_step(of_classical).max_steps(usize::MAX);
    let radau = Radau::with_tolerance(1e-9).max_steps(usize::MAX);
    let dop853 = Dop853::with_tolerance(1e-9).max_steps(usize::MAX);
    let taylor = Taylor::default().max_steps(usize::MAX);
    Ok(vec![
        energy_error("Verlet, 1000 steps a turn", ORDER_2, verlet(many), many)?,
        energy_error("order 4, 200 steps", ORDER_4, verlet(of_order_4).composed(Suzuki4), of_order_4)?,
        energy_error("order 6, 110 steps", ORDER_6, verlet(of_order_6).composed(KahanLi6), of_order_6)?,
        energy_error("order 8, 60 steps", ORDER_8, verlet(of_order_8).composed(KahanLi8), of_order_8)?,
        energy_error("Gauss::<4>, 40 steps", STAGES_4, gauss, of_gauss)?,
        energy_error("Lobatto::<4>, 40 steps", STAGES_2, lobatto, of_gauss)?,
        energy_error("RungeKutta4, 250 steps", DOPRI5, classical, of_classical)?,
        energy_error("Radau, tolerance 1e-9", RADAU, radau, TAU)?,
        energy_error("Dop853, tolerance 1e-9", DOP853, dop853, TAU)?,
        energy_error("Taylor, to round-off", TAYLOR, taylor, TAU)?,
    ])
}

/// Largest error of the energy at the steps of a turn, for turns that are equally spaced on a logarithmic scale. They
/// begin at multiples of `unit`, so that no step is cut short.
fn energy_error<P>(name: &'static str, color: RGBColor, method: P, unit: f64) -> Result<LongRun>
where
    P: Method<Kepler> + Copy,
{
    let start = State::new([0.5, 0.0], [0.0, 3.0_f64.sqrt()]);
    let energy = Kepler.energy(&start);
    let mut motion = Motion::new(Kepler, start, method)?;
    let (mut points, mut time) = (Points::new(), 0.0);
    let mut turns: Vec<f64> = (0..=48).map(|k| TURNS.powf(f64::from(k) / 48.0).round()).collect();
    turns.dedup();
    for turn in turns {
        let from = ((turn - 1.0) * TAU / unit).round() * unit;
        let begun = Instant::now();
        motion.advance_to(from)?;
        time += begun.elapsed().as_secs_f64();
        let path = Kepler.integrate(*motion.state(), from + TAU, method)?;
        let errors = path.steps().map(|step| (Kepler.energy(step.state()) / energy - 1.0).abs());
        points.push((turn.log10(), errors.fold(f64::EPSILON / 2.0, f64::max).log10()));
    }
    let evaluations = motion.statistics().evaluations as f64 / (TURNS - 1.0);
    Ok(LongRun { curve: Curve { name, color, points }, evaluations, time: 1e6 * time / (TURNS - 1.0) })
}

/// A motion whose end is known.
struct Known<L, const N: usize> {
    system: L,
    start: State<f64, N>,
    end: f64,
    q: [f64; N],
}

impl<L, const N: usize> Known<L, N>
where
    L: Lagrangian<N = Const<N>, Scalar = f64> + Copy,
{
    fn by_verlet(&self) -> Vec<Curve>
    where
        Verlet: Method<L>,
    {
        vec![
            self.by_steps("Verlet", ORDER_2, Verlet::with_step),
            self.by_steps("order 4", ORDER_4, |h| Verlet::with_step(h).composed(Suzuki4)),
            self.by_steps("order 6", ORDER_6, |h| Verlet::with_step(h).composed(KahanLi6)),
            self.by_steps("order 8", ORDER_8, |h| Verlet::with_step(h).composed(KahanLi8)),
        ]
    }

    fn by_dalembert(&self) -> Vec<Curve>
    where
        DAlembert: Method<L>,
    {
        vec![
            self.by_steps("DAlembert", ORDER_2, DAlembert::with_step),
            self.by_steps("order 4", ORDER_4, |h| DAlembert::with_step(h).composed(Suzuki4)),
            self.by_steps("order 6", ORDER_6, |h| DAlembert::with_step(h).composed(KahanLi6)),
            self.by_steps("order 8", ORDER_8, |h| DAlembert::with_step(h).composed(KahanLi8)),
        ]
    }

    fn by_gauss(&self) -> Vec<Curve>
    where
        Gauss<2>: Method<L>,
        Gauss<4>: Method<L>,
    {
        vec![
            self.by_steps("Gauss::<2>", STAGES_2, Gauss::<2>::with_step),
            self.by_steps("Gauss::<4>", STAGES_4, Gauss::<4>::with_step),
        ]
    }

    fn by_lobatto(&self) -> Vec<Curve>
    where
        Lobatto<2>: Method<L>,
        Lobatto<4>: Method<L>,
    {
        vec![
            self.by_steps("Lobatto::<2>", STAGES_2, Lobatto::<2>::with_step),
            self.by_steps("Lobatto::<4>", STAGES_4, Lobatto::<4>::with_step),
        ]
    }

    /// The methods that take any system.
    fn by_any(&self) -> Vec<Curve>
    where
        Taylor: Method<L>,
        Radau: Method<L>,
    {
        vec![
            self.by_tolerance("Taylor", TAYLOR, Taylor::with_tolerance),
            self.by_tolerance("Dop853", DOP853, Dop853::with_tolerance),
            self.by_tolerance("Dopri5", DOPRI5, Dopri5::with_tolerance),
            self.by_tolerance("Radau", RADAU, Radau::with_tolerance),
        ]
    }

    /// Runs with steps of one length, each half as long as the one before.
    fn by_steps<P>(&self, name: &'static str, color: RGBColor, method: impl Fn(f64) -> P) -> Curve
    where
        P: Method<L> + Copy,
    {
        let steps = (3..20).map(|k| self.end / f64::from(1 << k));
        self.curve(name, color, steps.map(method))
    }

    /// Runs with tolerances of 10⁻² to 10⁻¹⁵.
    fn by_tolerance<P>(&self, name: &'static str, color: RGBColor, method: impl Fn(f64) -> P) -> Curve
    where
        P: Method<L> + Copy,
    {
        self.curve(name, color, (2..=15).map(|k| method(10_f64.powi(-k))))
    }

    /// Leaves out runs that do not reach the end or take too long, and those that are no more exact than a cheaper one.
    fn curve<P>(&self, name: &'static str, color: RGBColor, methods: impl Iterator<Item = P>) -> Curve
    where
        P: Method<L> + Copy,
    {
        let runs = methods.filter_map(|method| self.run(method)).take_while(|(_, time)| *time < LONGEST);
        let mut runs: Vec<_> = runs.map(|(error, time)| (-error.max(1e-16).log10(), time.log10())).collect();
        runs.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut most = 0.0;
        runs.retain(|(digits, _)| {
            let is_better = *digits > most;
            most = digits.max(most);
            is_better
        });
        Curve { name, color, points: runs }
    }

    /// The error at the end, and the least time in µs of five runs, in which nothing is stored.
    fn run<P: Method<L> + Copy>(&self, method: P) -> Option<(f64, f64)> {
        let (mut error, mut best) = (f64::NAN, f64::INFINITY);
        for _ in 0..5 {
            let mut motion = Motion::new(self.system, self.start, method).ok()?;
            let begun = Instant::now();
            motion.advance_to(self.end).ok()?;
            best = best.min(1e6 * begun.elapsed().as_secs_f64());
            error = (motion.state().q - SVector::from(self.q)).amax();
        }
        Some((error, best))
    }
}

/// The values with 16 digits are those of Taylor runs with 113 and 170 bits, of which 20 and more agree.
fn diagrams() -> Result<Vec<(&'static str, Vec<Curve>)>> {
    let kepler = Known {
        system: Kepler,
        start: State::new([0.4, 0.0], [0.0, 2.0]),
        end: 10.0,
        q: [-1.535_023_591_909_813_7, -0.283_668_406_499_780_86],
    };
    let henon_heiles = Known {
        system: HenonHeiles,
        start: State::new([0.1, -0.05], [0.35, 0.12]),
        end: 100.0,
        q: [-0.323_724_224_978_209_76, -0.225_657_616_590_660_48],
    };
    let double = Known {
        system: DoublePendulum { g: G },
        start: State::at_rest([FRAC_PI_2; 2]),
        end: 10.0,
        q: [-0.568_474_664_015_950_2, -0.526_393_727_932_404_7],
    };
    let spherical = Known {
        system: SphericalPendulum { g: G },
        start: State::new([0.75_f64.sqrt(), 0.0, -0.5], [0.0, 1.5 * 0.75_f64.sqrt(), 0.0]),
        end: 10.0,
        q: [-0.278_812_335_078_511_2, 0.617_807_531_269_102_6, -0.735_239_781_374_243_1],
    };
    // It slides down, stops and goes on along a cycloid.
    let skate = Known {
        system: Skate,
        start: State::new([0.0; 3], [0.0, 0.0, 1.0]),
        end: 10.0,
        q: [10.0_f64.sin().powi(2) / 2.0, 5.0 - 20.0_f64.sin() / 4.0, 10.0],
    };
    // No other program is needed: two methods agree to 10⁻¹².
    let (system, start) = (Honey { k: 1000.0, c: 1000.0 }, State::at_rest([3.0]));
    let by_taylor = system.integrate(start, 3.0, Taylor::default().max_steps(1_000_000))?;
    let by_dop853 = system.integrate(start, 3.0, Dop853::with_tolerance(1e-14).max_steps(1_000_000))?;
    let q: [f64; 1] = by_taylor.end().state().q.into();
    assert!((q[0] - by_dop853.end().state().q[0]).abs() < 1e-12);
    let honey = Known { system, start, end: 3.0, q };
    Ok(vec![
        ("Kepler, e = 0.6, t = 10", [kepler.by_verlet(), kepler.by_gauss(), kepler.by_any()].concat()),
        (
            "Hénon and Heiles, t = 100",
            [henon_heiles.by_verlet(), henon_heiles.by_gauss(), henon_heiles.by_any()].concat(),
        ),
        ("Double pendulum in angles, t = 10", [double.by_gauss(), double.by_any()].concat()),
        (
            "Spherical pendulum on a rod, t = 10",
            [spherical.by_verlet(), spherical.by_lobatto(), spherical.by_any()].concat(),
        ),
        ("Skate on an inclined plane, t = 10", [skate.by_dalembert(), skate.by_any()].concat()),
        ("Pendulum in honey, t = 3", [honey.by_gauss(), honey.by_any()].concat()),
    ])
}
