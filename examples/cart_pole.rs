//! A pole balanced on a cart in a steady wind: trim, linearize, design a feedback, and let it run.
//!
//! The cart is pushed by a constant force less a feedback u = push − k·(x, θ − lean, ẋ, θ̇). Where the system rests, and
//! with which force, is an equilibrium sought; what it does nearby is the linear system ż = A z + B u; the gains are
//! those that minimize ∫ (zᵀQz + R u²) dt.

mod picture;

use lagrange_core::nalgebra::{Complex, DMatrix, DVector, Vector4};
use lagrange_core::{Linearization, prelude::*};
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

/// θ is measured from the upright.
#[derive(Clone, Lagrangian)]
#[coordinates(x, theta)]
#[define(bob = [x + l*sin(theta), l*cos(theta)])]
#[lagrangian(cart/2*x_dot^2 + m/2*dot(der(bob), der(bob)) - m*g*bob[1])]
#[define(control = push - dot(gain, [x, theta - lean, x_dot, theta_dot]))]
#[force(x: control + wind)]
#[force(theta: wind*l*cos(theta))]
#[observable(u = control)]
struct CartPole {
    cart: f64,
    m: f64,
    l: f64,
    g: f64,
    /// The force of the wind on the bob.
    wind: f64,
    push: f64,
    lean: f64,
    gain: Vector4<f64>,
}

type Path<'a> = Trajectory<&'a CartPole>;

fn main() -> Result<()> {
    let (cart, m, l, g, wind) = (1.0, 0.2, 0.6, 9.81, 0.5);
    let free = CartPole { cart, m, l, g, wind, push: 0.0, lean: 0.0, gain: Vector4::zeros() };
    println!(
        "A pole of {l} m with {m} kg at its end, on a cart of {cart} kg, in a wind of {wind} N on the bob\n"
    );
    let trim = free.equilibrium(&State::at_rest([0.0, 0.0]), &["theta", "push"])?;
    let lean = trim.state.q[1];
    println!("it balances at θ = {lean:+.9} rad with a push of {:+.9} N", trim.system.push);
    println!("exactly:       θ = {:+.9} rad                {:+.9} N\n", -(wind / (m * g)).atan(), -wind);

    let open = trim.system.linearize(&trim.state, &["push"])?;
    println!("ż = A z + B u for z = δ({})", open.states().join(", "));
    println!("A = {:.4}B = {:.4}", open.a, open.b);
    let weights = DMatrix::from_diagonal(&DVector::from_column_slice(&[10.0, 10.0, 1.0, 1.0]));
    let gain = Vector4::from_column_slice(regulator(&open.a, &open.b, &weights)?.as_slice());
    println!("gains k = {:.4?}\n", gain.as_slice());
    let balanced = CartPole { gain, lean, ..trim.system };
    let closed = balanced.linearize(&trim.state, &["push"])?;
    println!("eigenvalues without the feedback: {}: {:?}", list(&open)?, open.stability()?);
    println!("                        with it: {}: {:?}\n", list(&closed)?, closed.stability()?);

    let start = State::at_rest([0.5, lean + 30.0_f64.to_radians()]);
    let path = balanced.integrate(start, 8.0, Dop853::default())?;
    println!("from 30° off the balance and half a metre aside");
    table(&path, &closed, &trim.state)?;
    println!("\n{}", path.ending());
    let file = picture::path("cart_pole")?;
    draw(&path, &open, &closed, &trim.state, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

/// The gains K = Bᵀ X that minimize ∫ (zᵀQz + u²) dt, where AᵀX + X A − X B BᵀX + Q = 0: the graph of X is the null
/// space of sign(H) + 1, H Hamilton's matrix, and Newton's iteration gives its sign (Roberts 1980).
fn regulator(a: &DMatrix<f64>, b: &DMatrix<f64>, q: &DMatrix<f64>) -> Result<DMatrix<f64>> {
    let n = a.nrows();
    let mut sign = DMatrix::zeros(2 * n, 2 * n);
    sign.view_mut((0, 0), (n, n)).copy_from(a);
    sign.view_mut((0, n), (n, n)).copy_from(&(-b * b.transpose()));
    sign.view_mut((n, 0), (n, n)).copy_from(&-q);
    sign.view_mut((n, n), (n, n)).copy_from(&-a.transpose());
    for _ in 0..30 {
        let inverse = sign.clone().try_inverse().ok_or("an eigenvalue on the imaginary axis")?;
        sign = (&sign + inverse) / 2.0;
    }
    let plus = sign + DMatrix::identity(2 * n, 2 * n);
    let graph = plus.columns(n, n).into_owned().svd(true, true);
    let x = graph.solve(&-plus.columns(0, n), 1e-12)?;
    let residual = a.transpose() * &x + &x * a - &x * b * b.transpose() * &x + q;
    println!("Riccati's equation holds to {:.0e}", residual.amax() / x.amax());
    Ok(b.transpose() * x)
}

fn list(near: &Linearization<f64>) -> Result<String> {
    let text = |s: &Complex<f64>| match s.im {
        0.0 => format!("{:.3}", s.re),
        im => format!("{:.3}{im:+.3}i", s.re),
    };
    Ok(near.eigenvalues()?.iter().map(text).collect::<Vec<_>>().join(", "))
}

/// z(t) = exp(A t) z(0).
fn linear_motion(near: &Linearization<f64>, start: &State<f64, 2>, rest: &State<f64, 2>, t: f64) -> Vec<f64> {
    let [x, theta]: [f64; 2] = (start.q - rest.q).into();
    let z = DVector::from_column_slice(&[x, theta, start.v[0], start.v[1]]);
    ((&near.a * t).exp() * z).as_slice().to_vec()
}

fn table(path: &Path<'_>, closed: &Linearization<f64>, rest: &State<f64, 2>) -> Result<()> {
    println!(
        "{:>5} {:>10} {:>10} {:>10} {:>14} {:>14}",
        "t/s", "x/m", "δθ/rad", "u/N", "linear: x/m", "δθ/rad"
    );
    for sample in path.samples(9) {
        let (s, u) = (sample.state(), sample.observable("u")?);
        let linear = linear_motion(closed, path.start().state(), rest, s.t);
        let lean = s.q[1] - rest.q[1];
        println!("{:5.1} {:10.5} {lean:10.5} {u:10.5} {:14.5} {:14.5}", s.t, s.q[0], linear[0], linear[1]);
    }
    Ok(())
}

fn draw(
    path: &Path<'_>,
    open: &Linearization<f64>,
    closed: &Linearization<f64>,
    rest: &State<f64, 2>,
    file: &std::path::Path,
) -> Result<()> {
    let root = picture::sheet(file, (1100, 950))?;
    let panels = root.split_evenly((2, 2));
    draw_poses(path, &panels[0])?;
    draw_motion(path, closed, rest, &panels[1])?;
    draw_control(path, &panels[2])?;
    draw_eigenvalues(open, closed, &panels[3])?;
    root.present()?;
    Ok(())
}

/// Cart and pole at moments of the first two seconds.
fn draw_poses(path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let mut chart = Panel::new("Cart and pole, the first 2 s", ["x in m", "y in m"]).equal_axes();
    let mut bobs = Points::new();
    for step in 0..=200 {
        let s = *path.at(f64::from(step) * 0.01)?.state();
        let (cart, bob) = ((s.q[0], 0.0), (s.q[0] + 0.6 * s.q[1].sin(), 0.6 * s.q[1].cos()));
        bobs.push(bob);
        if step % 20 == 0 {
            let style = GREY.mix(0.3 + 0.7 * f64::from(step) / 200.0).stroke_width(2);
            chart.line([cart, bob], style);
        }
    }
    chart.curve("bob", BLUE, &bobs);
    chart.dots("start", RED, &vec![bobs[0]]);
    chart.draw(area)
}

fn draw_motion(
    path: &Path<'_>,
    closed: &Linearization<f64>,
    rest: &State<f64, 2>,
    area: &picture::Area,
) -> Result<()> {
    let start = *path.start().state();
    let mut curves = [const { Points::new() }; 4];
    for sample in path.samples(400) {
        let s = sample.state();
        let linear = linear_motion(closed, &start, rest, s.t);
        let values = [s.q[0], s.q[1] - rest.q[1], linear[0], linear[1]];
        curves.iter_mut().zip(values).for_each(|(curve, value)| curve.push((s.t, value)));
    }
    let [x, theta, linear_x, linear_theta] = &curves;
    let title = "Back to the balance: the motion, and the linear system";
    let mut chart = Panel::new(title, ["t in s", "x in m, δθ in rad"]);
    chart.curve("linear", GREY, linear_x);
    chart.line(linear_theta.iter().copied(), GREY.stroke_width(2));
    chart.curve("x", BLUE, x);
    chart.curve("δθ", RED, theta);
    chart.draw(area)
}

fn draw_control(path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let mut control = Points::new();
    for sample in path.samples(800) {
        control.push((sample.time(), sample.observable("u")?));
    }
    let title = "The force on the cart: it ends at −0.5 N against the wind";
    let mut chart = Panel::new(title, ["t in s", "u in N"]);
    chart.curve("u", BLUE, &control);
    chart.draw(area)
}

fn draw_eigenvalues(
    open: &Linearization<f64>,
    closed: &Linearization<f64>,
    area: &picture::Area,
) -> Result<()> {
    let points = |near: &Linearization<f64>| -> Result<Points> {
        Ok(near.eigenvalues()?.iter().map(|s| (s.re, s.im)).collect())
    };
    let (open, closed) = (points(open)?, points(closed)?);
    let axis: Points = vec![(0.0, -1.5), (0.0, 1.5)];
    let title = "Eigenvalues: left of the axis is stable";
    let mut chart = Panel::new(title, ["Re s in 1/s", "Im s in 1/s"]).equal_axes();
    chart.curve("Re s = 0", GREY, &axis);
    chart.dots("without feedback", RED, &open);
    chart.dots("with feedback", BLUE, &closed);
    chart.draw(area)
}
