//! A mass on a spring in a carriage with a prescribed velocity V(t): Milton (8.32)–(8.42).
//!
//! Three Lagrangians, which differ by total time derivatives, have one motion, m v̇ = −∂U/∂r − m A with A = dV/dt,
//! and three energies. With a harmonic U it is a driven oscillator, and the motion is known.

mod picture;

use lagrange_core::nalgebra::Vector3;
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

/// V(t): along x the carriage goes to and fro, along y it gains speed.
#[derive(Clone, Copy)]
struct Carriage {
    speed: f64,
    rate: f64,
    gain: f64,
}

impl Function<1, 3> for Carriage {
    fn eval<S: Scalar>(&self, [t]: [S; 1]) -> [S; 3] {
        let [speed, rate, gain, zero] = [self.speed, self.rate, self.gain, 0.0].map(S::constant);
        [speed * (rate * t).cos(), gain * t, zero]
    }
}

/// U = k/2 r².
#[derive(Clone, Copy)]
struct Spring {
    k: f64,
}

impl Function<3, 1> for Spring {
    fn eval<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 1] {
        [S::constant(self.k / 2.0) * (x * x + y * y + z * z)]
    }
}

/// m/2 v₀² − U with v₀ = v + V(t).
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[function(U(r) = spring)]
#[function(V(t): [3] = carriage)]
#[define(v = r_dot)]
#[define(v0 = v + V(t))]
#[lagrangian(m/2 * dot(v0, v0) - U(r))]
struct Substituted {
    m: f64,
    spring: Spring,
    carriage: Carriage,
}

/// Without m/2 V², which depends on time alone: Milton (8.36).
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[function(U(r) = spring)]
#[function(V(t): [3] = carriage)]
#[define(v = r_dot)]
#[lagrangian(m/2 * dot(v, v) + m*dot(v, V(t)) - U(r))]
struct WithVelocity {
    m: f64,
    spring: Spring,
    carriage: Carriage,
}

/// Less d/dt(m r·V): Milton (8.40).
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[function(U(r) = spring)]
#[function(V(t): [3] = carriage)]
#[define(v = r_dot)]
#[define(A = der(V(t)))]
#[lagrangian(m/2 * dot(v, v) - m*dot(r, A) - U(r))]
struct WithAcceleration {
    m: f64,
    spring: Spring,
    carriage: Carriage,
}

const M: f64 = 0.5;
const SPRING: Spring = Spring { k: 2.0 };
const CARRIAGE: Carriage = Carriage { speed: 0.6, rate: 1.5, gain: 0.4 };
const DURATION: f64 = 50.0;
const SUBSTITUTED: Substituted = Substituted { m: M, spring: SPRING, carriage: CARRIAGE };
const WITH_VELOCITY: WithVelocity = WithVelocity { m: M, spring: SPRING, carriage: CARRIAGE };
const WITH_ACCELERATION: WithAcceleration = WithAcceleration { m: M, spring: SPRING, carriage: CARRIAGE };

/// A time and the state that each of the three Lagrangians gives there.
type Moment = (f64, [State<f64, 3>; 3]);

fn main() -> Result<()> {
    println!("Mass on a spring in a carriage with the velocity V(t)   (Milton 8.32–8.42)\n");
    println!("{}", Substituted::equations());
    println!("{}", WithVelocity::equations());
    println!("{}", WithAcceleration::equations());
    let moments = moments(2001)?;
    table(&moments);
    checks(&moments)?;
    let file = picture::path("accelerating_frame")?;
    draw(&moments, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

fn moments(count: usize) -> Result<Vec<Moment>> {
    let start = State::at_rest([0.3, 0.0, 0.0]);
    let method = Dop853::with_tolerance(1e-12);
    let one = SUBSTITUTED.integrate(start, DURATION, method)?;
    let two = WITH_VELOCITY.integrate(start, DURATION, method)?;
    let three = WITH_ACCELERATION.integrate(start, DURATION, method)?;
    let states = one.samples(count).zip(two.samples(count)).zip(three.samples(count));
    Ok(states.map(|((a, b), c)| (a.time(), [*a.state(), *b.state(), *c.state()])).collect())
}

impl Carriage {
    fn velocity(&self, t: f64) -> Vector3<f64> {
        Vector3::new(self.speed * (self.rate * t).cos(), self.gain * t, 0.0)
    }

    fn acceleration(&self, t: f64) -> Vector3<f64> {
        Vector3::new(-self.speed * self.rate * (self.rate * t).sin(), self.gain, 0.0)
    }

    /// Where the carriage is, from the origin.
    fn place(&self, t: f64) -> Vector3<f64> {
        Vector3::new(self.speed / self.rate * (self.rate * t).sin(), self.gain / 2.0 * t * t, 0.0)
    }
}

/// r in the carriage: a driven oscillation along x, an oscillation about −gain/ω² along y.
fn exact(t: f64) -> Vector3<f64> {
    let omega = (SPRING.k / M).sqrt();
    let Carriage { speed, rate, gain } = CARRIAGE;
    let forced = speed * rate / (omega * omega - rate * rate);
    let x = 0.3 * (omega * t).cos() + forced * ((rate * t).sin() - rate / omega * (omega * t).sin());
    Vector3::new(x, gain / (omega * omega) * ((omega * t).cos() - 1.0), 0.0)
}

fn energies(states: &[State<f64, 3>; 3]) -> [f64; 3] {
    [SUBSTITUTED.energy(&states[0]), WITH_VELOCITY.energy(&states[1]), WITH_ACCELERATION.energy(&states[2])]
}

fn table(moments: &[Moment]) {
    println!("{:>5} {:>20} {:>20}   energy E = p·v − L in J", "t/s", "r/m", "exact r/m");
    println!("{:>50} {:>10} {:>10} {:>10}", "", "L₀", "(8.36)", "(8.40)");
    for (t, states) in moments.iter().step_by(200) {
        let (r, exact, e) = (states[0].q, exact(*t), energies(states));
        print!("{t:5.1} {:10.6}{:10.6} {:10.6}{:10.6}", r[0], r[1], exact[0], exact[1]);
        println!("    {:10.5} {:10.5} {:10.5}", e[0], e[1], e[2]);
    }
}

fn checks(moments: &[Moment]) -> Result<()> {
    let mut worst = [0.0_f64; 5];
    for (t, states) in moments {
        let [one, two, three] = states;
        let (v, a) = (CARRIAGE.velocity(*t), CARRIAGE.acceleration(*t));
        let force = -SPRING.k * two.q - M * a;
        let solution = WITH_VELOCITY.solve(two)?;
        let lagrangians = WITH_VELOCITY.lagrangian(two) - WITH_ACCELERATION.lagrangian(two);
        let deviations = [
            (one.q - two.q).norm().max((one.q - three.q).norm()),
            (one.q - exact(*t)).norm(),
            (M * solution.accelerations - force).norm(),
            (WITH_VELOCITY.momentum(two) - M * (two.v + v)).norm(),
            (lagrangians - M * (two.v.dot(&v) + two.q.dot(&a))).abs(),
        ];
        for (worst, deviation) in worst.iter_mut().zip(deviations) {
            *worst = worst.max(deviation);
        }
    }
    let laws = [
        "one motion from the three Lagrangians, in m",
        "it is the driven oscillation, in m",
        "m v̇ = −∂U/∂r − m A (8.42), in N",
        "p = m v₀, the inertial momentum (8.37)",
        "(8.36) − (8.40) = d/dt(m r·V)",
    ];
    println!("\nlargest deviation over {DURATION} s");
    for (law, worst) in laws.into_iter().zip(worst) {
        println!("  {law:<48} {worst:8.1e}");
    }
    Ok(())
}

fn draw(moments: &[Moment], file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 900))?;
    let panels = root.split_evenly((2, 2));
    draw_in_the_carriage(moments, &panels[0])?;
    draw_from_the_ground(moments, &panels[1])?;
    draw_time(moments, &panels[2])?;
    draw_energies(moments, &panels[3])?;
    root.present()?;
    Ok(())
}

fn draw_in_the_carriage(moments: &[Moment], area: &picture::Area) -> Result<()> {
    let path: Points = moments.iter().take(801).map(|(_, s)| (s[0].q[0], s[0].q[1])).collect();
    let title = "In the carriage, 20 s: it hangs back";
    let mut chart = Panel::new(title, ["x in m", "y in m"]).equal_axes();
    chart.curve("mass", BLUE, &path);
    chart.dots("start", RED, &vec![path[0]]);
    let still = -CARRIAGE.gain * M / SPRING.k;
    chart.dots("where k r = −m A_y", GREY, &vec![(0.0, still)]);
    chart.draw(area)
}

fn draw_from_the_ground(moments: &[Moment], area: &picture::Area) -> Result<()> {
    let first = || moments.iter().take(161);
    let carriage: Points = first().map(|(t, _)| CARRIAGE.place(*t)).map(|r| (r[0], r[1])).collect();
    let mass: Points = first().map(|(t, s)| CARRIAGE.place(*t) + s[0].q).map(|r| (r[0], r[1])).collect();
    let mut chart = Panel::new("From the ground, 4 s, with the spring", ["x in m", "y in m"]).equal_axes();
    chart.curve("carriage", GREY, &carriage);
    chart.curve("mass", BLUE, &mass);
    for i in (0..=160).step_by(10) {
        chart.line([carriage[i], mass[i]], RED.stroke_width(1));
    }
    chart.draw(area)
}

/// The three motions take turns, or one would hide the others.
fn draw_time(moments: &[Moment], area: &picture::Area) -> Result<()> {
    let curve: Points = (0..=800).map(|i| f64::from(i) / 40.0).map(|t| (t, exact(t)[0])).collect();
    let title = "x in the carriage, from three Lagrangians";
    let mut chart = Panel::new(title, ["t in s", "x in m"]);
    chart.curve("driven oscillation, exact", GREY, &curve);
    for (index, (name, color)) in [("L₀", BLUE), ("(8.36)", RED), ("(8.40)", BLACK)].into_iter().enumerate()
    {
        let every = moments.iter().take(801).skip(8 * index).step_by(24);
        let points: Points = every.map(|(t, s)| (*t, s[index].q[0])).collect();
        chart.dots(name, color, &points);
    }
    chart.draw(area)
}

fn draw_energies(moments: &[Moment], area: &picture::Area) -> Result<()> {
    let of = |index: usize| -> Points {
        moments.iter().take(401).map(|(t, states)| (*t, energies(states)[index])).collect()
    };
    let all = [of(0), of(1), of(2)];
    let title = "Three energies E = p·v − L";
    let mut chart = Panel::new(title, ["t in s", "E in J"]);
    for (points, (name, color)) in all.iter().zip([
        ("L₀: m/2 v² − m/2 V² + U", BLUE),
        ("(8.36): m/2 v² + U", RED),
        ("(8.40): m/2 v² + U + m r·A", BLACK),
    ]) {
        chart.curve(name, color, points);
    }
    chart.draw(area)
}
