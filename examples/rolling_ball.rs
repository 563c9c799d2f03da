//! A ball rolling on a floor, on a tilted plane and on a turntable: Milton (8.4)–(8.7).
//!
//! The constraint is that of the book, V − a Ω×n = 0, with the velocity of a turning plane on the right. It is
//! not integrable. The ball is a frame that is turned by a quaternion, which brings the constraint |q|² = 1: its length has no
//! inertia, so that the mass matrix is singular. The multiplier of the rolling constraint is the contact force.
//!
//! Eliminating it gives V̇ = 2/7 w n×V + 5/7 g_∥, with w the rate of the turntable.

mod picture;

use std::f64::consts::TAU;

use lagrange_core::nalgebra::Vector3;
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [3], q: [4])]
#[frame(ball: translate(r), rotate(q))]
#[define(inertia = 2/5 * m * a^2 * identity(3))]
#[define(Omega = express(angular_velocity(ball), fixed))]
#[lagrangian(kinetic(ball, m, [0, 0, 0], inertia) + m*dot(g, r))]
#[constraint(rolling: express(velocity(ball), fixed) - a*cross(Omega, n) = vector(fixed, w*cross(n, r)))]
#[observable(spin = Omega)]
#[observable(contact = lambda(rolling))]
struct Ball {
    m: f64,
    a: f64,
    g: Vector3<f64>,
    /// The normal of the plane.
    n: Vector3<f64>,
    /// How fast the plane turns about it.
    w: f64,
}

type Path<'a> = Trajectory<&'a Ball>;

const DURATION: f64 = 12.0;

fn main() -> Result<()> {
    println!("Ball rolling on a plane with the normal n that turns at the rate w   (Milton 8.4)\n");
    println!("{}", Ball::equations());
    let down = Vector3::new(0.0, 0.0, -9.81);
    let tilted = |angle: f64| Vector3::new(angle.sin(), 0.0, angle.cos());
    let ball = |n: Vector3<f64>, w: f64| Ball { m: 0.5, a: 0.1, g: down, n, w };
    let balls =
        [ball(Vector3::z(), 0.0), ball(tilted(0.1), 0.0), ball(Vector3::z(), 3.0), ball(tilted(0.02), 3.0)];
    let names =
        ["floor", "plane tilted by 0.1 rad", "turntable, w = 3/s", "turntable tilted by 0.02 rad, w = 3/s"];
    let mut paths = Vec::new();
    for (ball, name) in balls.iter().zip(names) {
        let path = ball.integrate(ball.start(), DURATION, Dop853::with_tolerance(1e-12))?;
        println!("\n{name}: {}", path.ending());
        table(ball, &path)?;
        checks(ball, &path)?;
        paths.push(path);
    }
    let file = picture::path("rolling_ball")?;
    draw(&balls, &paths, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

fn place(state: &State<f64, 7>) -> [Vector3<f64>; 2] {
    [state.q.fixed_rows::<3>(0).into(), state.v.fixed_rows::<3>(0).into()]
}

impl Ball {
    /// Rolling along y, half a metre from the origin, with a spin of 2/s about the normal.
    fn start(&self) -> State<f64, 7> {
        let (r, v) = (self.n.cross(&Vector3::y()) * -0.5, Vector3::new(0.0, 0.3, 0.0));
        let omega = self.n.cross(&(v - self.w * self.n.cross(&r))) / self.a + 2.0 * self.n;
        // From q = 1, with q̇ = ½ Ω q.
        let rate = omega / 2.0;
        State::new([r[0], r[1], r[2], 1.0, 0.0, 0.0, 0.0], [v[0], v[1], v[2], 0.0, rate[0], rate[1], rate[2]])
    }

    /// 5/7 of gravity along the plane.
    fn slope(&self) -> Vector3<f64> {
        (self.g - self.n * self.n.dot(&self.g)) * (5.0 / 7.0)
    }

    /// V̇ = 2/7 w n×V + 5/7 g_∥.
    fn exact_acceleration(&self, v: Vector3<f64>) -> Vector3<f64> {
        2.0 / 7.0 * self.w * self.n.cross(&v) + self.slope()
    }

    /// The velocity at which a circle on the turntable drifts across the slope.
    fn drift(&self) -> Vector3<f64> {
        self.n.cross(&self.slope()) / (2.0 / 7.0 * self.w)
    }

    /// The centre at t: a straight line, a parabola, a circle, or a circle that drifts.
    fn exact(&self, t: f64) -> Vector3<f64> {
        let [r, v] = place(&self.start());
        if self.w == 0.0 {
            return r + v * t + self.slope() * (t * t / 2.0);
        }
        let rate = 2.0 / 7.0 * self.w;
        let (drift, (sine, cosine)) = (self.drift(), (rate * t).sin_cos());
        let u = v - drift;
        r + drift * t + (u * sine + self.n.cross(&u) * (1.0 - cosine)) / rate
    }
}

fn table(ball: &Ball, path: &Path<'_>) -> Result<()> {
    println!("{:>5} {:>27} {:>27} {:>27}", "t/s", "centre r/m", "spin Ω in 1/s", "contact force λ/N");
    let row = |x: Vector3<f64>| {
        x.iter().map(|x| format!("{:9.4}", (x * 1e4).round() / 1e4 + 0.0)).collect::<String>()
    };
    for sample in path.samples(5) {
        let (s, solution) = (sample.state(), sample.solution()?);
        let (spin, force) = (ball.spin(s), ball.contact(s, &solution));
        println!("{:5.1} {} {} {}", s.t, row(place(s)[0]), row(spin), row(force));
    }
    Ok(())
}

fn checks(ball: &Ball, path: &Path<'_>) -> Result<()> {
    let spin = ball.n.dot(&ball.spin(path.start().state()));
    let mut worst = [0.0_f64; 5];
    for sample in path.samples(500) {
        let (s, solution) = (sample.state(), sample.solution()?);
        let [r, v] = place(s);
        let acceleration = ball.exact_acceleration(v);
        let deviations = [
            (r - ball.exact(s.t)).norm(),
            (solution.accelerations.fixed_rows::<3>(0) - acceleration).norm(),
            (ball.contact(s, &solution) - ball.m * (acceleration - ball.g)).norm(),
            (ball.n.dot(&ball.spin(s)) - spin).abs(),
            ball.constraint_rate(s).norm().max(ball.constraint_residual(s).norm()),
        ];
        for (worst, deviation) in worst.iter_mut().zip(deviations) {
            *worst = worst.max(deviation);
        }
    }
    let laws = [
        "centre where the closed form has it, in m",
        "V̇ = 2/7 w n×V + 5/7 g_∥, in m/s²",
        "contact force = m (V̇ − g), in N",
        "Ω·n is constant, in 1/s",
        "V − a Ω×n = w n×r and |q| = 1",
    ];
    for (law, worst) in laws.into_iter().zip(worst) {
        println!("  {law:<45} {worst:8.1e}");
    }
    Ok(())
}

fn draw(balls: &[Ball], paths: &[Path<'_>], file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 950))?;
    let panels = root.split_evenly((2, 2));
    draw_straight(balls, paths, &panels[0])?;
    draw_turntable(&balls[2], &paths[2], &panels[1])?;
    draw_drift(&balls[3], &paths[3], &panels[2])?;
    draw_spin(balls, paths, &panels[3])?;
    root.present()?;
    Ok(())
}

/// The centre every 0.2 s until `end`, seen along the normal.
fn centre(path: &Path<'_>, end: f64) -> Points {
    let places = path.samples(61).filter(|s| s.time() <= end + 1e-9).map(|s| place(s.state())[0]);
    places.map(|r| (r[0], r[1])).collect()
}

fn exact_centre(ball: &Ball, end: f64) -> Points {
    let times = (0..=600).map(|k| end * f64::from(k) / 600.0);
    times.map(|t| ball.exact(t)).map(|r| (r[0], r[1])).collect()
}

fn draw_straight(balls: &[Ball], paths: &[Path<'_>], area: &picture::Area) -> Result<()> {
    let exact = [exact_centre(&balls[0], 3.0), exact_centre(&balls[1], 3.0)];
    let title = "Without a turntable: 3 s, every 0.2 s";
    let mut chart = Panel::new(title, ["x in m (down the slope)", "y in m"]).equal_axes();
    chart.curve("straight line, parabola 5/14 g_∥ t²", GREY, &exact[0]);
    chart.line(exact[1].iter().copied(), GREY.stroke_width(2));
    chart.dots("on the floor", BLUE, &centre(&paths[0], 3.0));
    chart.dots("on the tilted plane", RED, &centre(&paths[1], 3.0));
    chart.draw(area)
}

/// The ball goes round once while the table turns three and a half times.
fn draw_turntable(ball: &Ball, path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let period = 3.5 * TAU / ball.w;
    let exact = exact_centre(ball, period);
    let seen_from_table: Points = (0..=900)
        .filter_map(|k| path.at(period * f64::from(k) / 900.0).ok())
        .map(|sample| {
            let (r, (sine, cosine)) = (place(sample.state())[0], (ball.w * sample.time()).sin_cos());
            (r[0] * cosine + r[1] * sine, r[1] * cosine - r[0] * sine)
        })
        .collect();
    let title = "Turntable: one circle in 7/2 of its turns";
    let mut chart = Panel::new(title, ["x in m", "y in m"]).equal_axes();
    chart.curve("seen from the table", RED, &seen_from_table);
    chart.curve("circle at 2/7 of the table's rate", GREY, &exact);
    chart.dots("centre, every 0.2 s", BLUE, &centre(path, period));
    chart.dots("axis of the table", GREY, &vec![(0.0, 0.0)]);
    chart.draw(area)
}

/// Tilted, the turntable does not let the ball roll down: the circles drift across the slope.
fn draw_drift(ball: &Ball, path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let exact = exact_centre(ball, DURATION);
    let found = centre(path, DURATION);
    let (from, drift) = (exact[0], ball.drift() * DURATION);
    let straight = vec![from, (from.0 + drift[0], from.1 + drift[1])];
    let title = "Tilted turntable: it drifts across the slope (12 s)";
    let mut chart = Panel::new(title, ["x in m (down the slope)", "y in m"]).equal_axes();
    chart.curve("circle and drift", GREY, &exact);
    chart.curve("drift 5/2 n×g/w", RED, &straight);
    chart.dots("centre, every 0.2 s", BLUE, &found);
    chart.draw(area)
}

/// What the constraint asks of Ω: its component along x is that of n × (V − w n×r)/a.
fn draw_spin(balls: &[Ball], paths: &[Path<'_>], area: &picture::Area) -> Result<()> {
    let title = "The spin follows the velocity: Ω_x = −(V_y − w x)/a";
    let mut chart = Panel::new(title, ["t in s", "Ω_x in 1/s"]);
    for (index, name, color) in [(0, "floor", BLUE), (2, "turntable", RED)] {
        let (ball, path) = (&balls[index], &paths[index]);
        let wanted: Points = path
            .samples(400)
            .map(|s| (s.time(), place(s.state())))
            .map(|(t, [r, v])| (t, -(v[1] - ball.w * r[0]) / ball.a))
            .collect();
        let found: Points = path.samples(41).map(|s| (s.time(), ball.spin(s.state())[0])).collect();
        chart.line(wanted, GREY.stroke_width(2));
        chart.dots(&format!("Ω_x on the {name}"), color, &found);
    }
    chart.draw(area)
}
