//! A free body that is spun about its middle axis turns over, and over again: Dzhanibekov's effect, of a wing nut in orbit
//! or a book that is thrown.
//!
//! The body is a frame that moves by a vector and turns by a unit quaternion; no force acts. Its angular momentum stands
//! still in space. Seen from the body it goes round on a sphere, along lines of constant energy; two of these cross
//! where the middle axis is, and close to them it goes from one end of that axis almost to the other. How, is known
//! (L. D. Landau and E. M. Lifshitz, *Mechanics*, §37): with I₁ < I₂ < I₃ and M² > 2 E I₂ the components of ω go as
//! cn τ, sn τ and dn τ, and it turns over every 2K/ν, which grows with the logarithm of how well the axis was aimed at.

mod picture;

use std::f64::consts::{FRAC_PI_2, TAU};

use lagrange_core::nalgebra::{Matrix3, Vector3};
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(r: [3], q: [4])]
#[frame(body: translate(r), rotate(q))]
#[lagrangian(kinetic(body, m, [0, 0, 0], inertia))]
#[observable(omega = angular_velocity(body))]
#[observable(momentum_in_space = express(inertia*angular_velocity(body), fixed))]
#[observable(middle_axis = express(vector(body, [0, 1, 0]), fixed))]
struct Body {
    m: f64,
    inertia: Matrix3<f64>,
}

type Path<'a> = Trajectory<&'a Body>;

/// How fast it is spun, and by what angle past the middle axis, towards the third.
const SPIN: f64 = 2.0 * TAU;
const AIMS: [f64; 5] = [0.3, 0.1, 0.03, 0.01, 0.003];
const SHOWN: f64 = 0.01;
const DURATION: f64 = 6.0;

/// The rates of the body about its axes, in closed form, for a start with ω₁ = 0.
struct Landau {
    amplitudes: [f64; 3],
    /// τ = K + ν t
    rate: f64,
    modulus: Elliptic,
}

/// Jacobi's functions of the modulus k, by the arithmetic-geometric mean (Abramowitz and Stegun, 16.4 and 17.6).
struct Elliptic {
    /// aₙ and cₙ from 1 and k on, until cₙ is nothing.
    means: Vec<[f64; 2]>,
    k: [f64; 2],
}

fn main() -> Result<()> {
    println!("{}", Body::equations());
    let body = Body::book(0.6, [0.24, 0.15, 0.03]);
    println!("a book of 24 × 15 × 3 cm and 0.6 kg, I = {:.6?} kg m²", body.inertia.diagonal().as_slice());
    println!("spun twice a second close to its middle axis\n");
    println!("{:>9} {:>16} {:>16} {:>9}", "off by", "turns over in", "2K/ν", "apart");
    let mut found = Points::new();
    for aim in AIMS {
        let (flip, law) = (body.flip(aim)?, body.landau(aim).flip());
        println!("{aim:5} rad {flip:14.10} s {law:14.10} s {:9.0e}", (flip - law).abs());
        found.push((aim.log10(), flip));
    }
    let path = body.integrate(body.start(SHOWN), DURATION, Dop853::with_tolerance(1e-13))?;
    checks(&body, &path);
    let file = picture::path("flipping_body")?;
    draw(&body, &path, &found, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

impl Body {
    /// Of uniform density; the longest edge is along the axis with the least moment.
    fn book(m: f64, edges: [f64; 3]) -> Self {
        let [a, b, c] = edges.map(|edge| edge * edge * m / 12.0);
        Self { m, inertia: Matrix3::from_diagonal(&Vector3::new(b + c, a + c, a + b)) }
    }

    fn spun(aim: f64) -> Vector3<f64> {
        SPIN * Vector3::new(0.0, aim.cos(), aim.sin())
    }

    /// In a line along x, its axes those of space: q = 1, q̇ = ½ ω.
    fn start(&self, aim: f64) -> State<f64, 7> {
        let half = Self::spun(aim) / 2.0;
        State::new([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], [0.1, 0.0, 0.0, 0.0, half[0], half[1], half[2]])
    }

    fn landau(&self, aim: f64) -> Landau {
        Landau::of(self.inertia.diagonal(), Self::spun(aim))
    }

    /// The time between the first two moments at which it does not turn about its middle axis.
    fn flip(&self, aim: f64) -> Result<f64> {
        let mut across = self.event("across", |sample| sample.system().omega(sample.state())[1]);
        let mut motion = Motion::new(self.clone(), self.start(aim), Dop853::with_tolerance(1e-13))?;
        let mut times = Vec::new();
        for crossing in motion.crossings(100.0, &mut [&mut across]).take(2) {
            times.push(crossing?.state.t);
        }
        Ok(times[1] - times[0])
    }
}

impl Landau {
    /// Differences of energies and momenta are written out, so that nothing cancels close to the middle axis.
    fn of(i: Vector3<f64>, w: Vector3<f64>) -> Self {
        let [two, three] = [i[1] * w[1] * w[1], i[2] * w[2] * w[2]];
        // 2 E I₃ − M², M² − 2 E I₁, M² − 2 E I₂
        let below = two * (i[2] - i[1]);
        let above = two * (i[1] - i[0]) + three * (i[2] - i[0]);
        let middle = three * (i[2] - i[1]);
        let amplitudes =
            [below / (i[0] * (i[2] - i[0])), below / (i[1] * (i[2] - i[1])), above / (i[2] * (i[2] - i[0]))];
        let k = [(i[1] - i[0]) * below, (i[2] - i[0]) * middle].map(|x| (x / ((i[2] - i[1]) * above)).sqrt());
        Self {
            amplitudes: amplitudes.map(f64::sqrt),
            rate: ((i[2] - i[1]) * above / i.product()).sqrt(),
            modulus: Elliptic::of(k),
        }
    }

    fn flip(&self) -> f64 {
        2.0 * self.modulus.quarter() / self.rate
    }

    fn omega(&self, t: f64) -> Vector3<f64> {
        let [sn, cn, dn] = self.modulus.at(self.modulus.quarter() + self.rate * t);
        let [first, second, third] = self.amplitudes;
        Vector3::new(first * cn, second * sn, third * dn)
    }
}

impl Elliptic {
    /// Of k and k′ = √(1 − k²), both given for their accuracy.
    fn of([k, complement]: [f64; 2]) -> Self {
        let (mut a, mut b, mut means) = (1.0_f64, complement, vec![[1.0, k]]);
        while (a - b).abs() > f64::EPSILON * a {
            let c = (a - b) / 2.0;
            (a, b) = (f64::midpoint(a, b), (a * b).sqrt());
            means.push([a, c]);
        }
        Self { means, k: [k, complement] }
    }

    /// K
    fn quarter(&self) -> f64 {
        FRAC_PI_2 / self.means[self.means.len() - 1][0]
    }

    /// sn u, cn u and dn u.
    fn at(&self, u: f64) -> [f64; 3] {
        let last = self.means.len() - 1;
        let start = 2.0_f64.powi(last as i32) * self.means[last][0] * u;
        let halve = |angle: f64, [a, c]: &[f64; 2]| f64::midpoint(angle, (c / a * angle.sin()).asin());
        let (sn, cn) = self.means[1..].iter().rev().fold(start, halve).sin_cos();
        [sn, cn, (self.k[1] * self.k[1] + self.k[0] * self.k[0] * cn * cn).sqrt()]
    }
}

fn checks(body: &Body, path: &Path<'_>) {
    let (start, law) = (&body.start(SHOWN), body.landau(SHOWN));
    let momentum = body.momentum_in_space(start);
    let mut worst = [0.0_f64; 5];
    for sample in path.samples(600) {
        let s = sample.state();
        let deviations = [
            (body.omega(s) - law.omega(s.t)).norm() / SPIN,
            (body.momentum_in_space(s) - momentum).norm() / momentum.norm(),
            body.energy(s) / body.energy(start) - 1.0,
            s.q[0] - 0.1 * s.t,
            s.q.fixed_rows::<4>(3).norm() - 1.0,
        ];
        for (worst, deviation) in worst.iter_mut().zip(deviations) {
            *worst = worst.max(deviation.abs());
        }
    }
    println!("\n{SHOWN} rad off, largest deviation in {DURATION} s, at {} steps", path.steps().count());
    let laws = [
        "ω as cn τ, sn τ, dn τ (Landau and Lifshitz 37.10), of |ω|",
        "the angular momentum stands still in space, of itself",
        "the energy is conserved, of itself",
        "the centre goes in a line, in m",
        "|q| = 1",
    ];
    for (law, worst) in laws.into_iter().zip(worst) {
        println!("  {law:<57} {worst:8.1e}");
    }
}

fn draw(body: &Body, path: &Path<'_>, found: &Points, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 950))?;
    let panels = root.split_evenly((2, 2));
    draw_rates(body, path, &panels[0])?;
    draw_momentum(body, path, &panels[1])?;
    draw_sphere(body, &panels[2])?;
    draw_flips(body, found, &panels[3])?;
    root.present()?;
    Ok(())
}

fn draw_rates(body: &Body, path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let law = body.landau(SHOWN);
    let title = format!("Spun {SHOWN} rad off its middle axis: about its own axes");
    let mut chart = Panel::new(&title, ["t in s", "ω in 1/s"]);
    for i in 0..3 {
        let curve = (0..=1200).map(|k| DURATION * f64::from(k) / 1200.0).map(|t| (t, law.omega(t)[i]));
        chart.line(curve, GREY.stroke_width(2));
    }
    for (i, name, color) in
        [(0, "ω₁, about the long edge", BLACK), (1, "ω₂, about the middle one", RED), (2, "ω₃", BLUE)]
    {
        let points = path.samples(91).map(|s| (s.time(), body.omega(s.state())[i])).collect();
        chart.dots(name, color, &points);
    }
    chart.draw(area)
}

/// What stands still, and what turns over with respect to it.
fn draw_momentum(body: &Body, path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let size = body.momentum_in_space(path.start().state()).norm();
    let mut chart = Panel::new("Along the axes of space", ["t in s", "component"]);
    let over = |s: &State<f64, 7>| body.middle_axis(s).dot(&body.momentum_in_space(s)) / size;
    let turning: Points = path.samples(600).map(|s| (s.time(), over(s.state()))).collect();
    chart.curve("middle axis of the body, along the angular momentum", RED, &turning);
    for (i, name, color) in [(0, "x", BLACK), (1, "y", BLUE), (2, "z", GREY)] {
        let component = |s: &State<f64, 7>| body.momentum_in_space(s)[i] / size;
        let points = path.samples(41).map(|s| (s.time(), component(s.state()))).collect();
        chart.dots(&format!("angular momentum M_{name}/M"), color, &points);
    }
    chart.draw(area)
}

/// The angular momentum as the body sees it, from the side of the third axis.
fn draw_sphere(body: &Body, area: &picture::Area) -> Result<()> {
    let title = "The angular momentum, seen from the body";
    let mut chart = Panel::new(title, ["M₁/M", "M₂/M"]).equal_axes();
    let rim = (0..=360).map(|degree| f64::from(degree).to_radians().sin_cos()).collect();
    chart.curve("sphere of |M|", GREY, &rim);
    for (aim, name, color) in [
        (1.2, "", BLUE),
        (0.7, "", BLUE),
        (0.3, "spun further off", BLUE),
        (SHOWN, "spun close to the middle axis", RED),
    ] {
        let path = body.integrate(body.start(aim), 4.0 * body.flip(aim)?, Dop853::with_tolerance(1e-11))?;
        let seen = |s: &State<f64, 7>| (body.inertia * body.omega(s)).normalize();
        let points: Points = path.samples(400).map(|s| seen(s.state())).map(|m| (m[0], m[1])).collect();
        if name.is_empty() {
            chart.line(points, color.stroke_width(2));
        } else {
            chart.curve(name, color, &points);
        }
    }
    chart.draw(area)
}

fn draw_flips(body: &Body, found: &Points, area: &picture::Area) -> Result<()> {
    let law: Points = (0..=220)
        .map(|k| -2.6 + f64::from(k) / 100.0)
        .map(|power| (power, body.landau(10.0_f64.powf(power)).flip()))
        .collect();
    let names = ["log₁₀ of the angle off the middle axis", "s"];
    let mut chart = Panel::new("How long it takes to turn over", names);
    chart.curve("2K/ν", GREY, &law);
    chart.dots("between two zeros of ω₂", RED, found);
    chart.draw(area)
}
