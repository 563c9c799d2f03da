//! Nonholonomic systems whose motion is known in closed form. The variational ("vakonomic") equations move
//! otherwise in every one of them, so that these tests tell d'Alembert's principle (Milton 8.7) from Hamilton's.

use lagrange_core::prelude::*;

use crate::chapter_rolling::largest;

fn method() -> Dop853 {
    Dop853::with_tolerance(1e-12)
}

/// Chaplygin's sleigh: (x, y) is the blade, the centre of mass lies `a` before it.
#[derive(Lagrangian)]
#[coordinates(x, y, th)]
#[lagrangian(m/2*((x_dot - a*th_dot*sin(th))^2 + (y_dot + a*th_dot*cos(th))^2) + inertia/2*th_dot^2)]
#[constraint(blade: x_dot*sin(th) - y_dot*cos(th) = 0)]
struct Sleigh {
    m: f64,
    inertia: f64,
    a: f64,
}

const SLEIGH: Sleigh = Sleigh { m: 2.0, inertia: 0.3, a: 0.25 };

/// v = V tanh τ, θ̇ = (V/b) sech τ, θ = (b/a) gd τ + const with b² = (I + m a²)/m, V² = v² + b²θ̇²,
/// τ = a V (t − t₀)/b²; λ follows from the row of y at θ = 0 turned by θ: λ = −m (v θ̇ + a θ̈).
#[test]
fn sleigh() {
    let (v0, turn) = (1.0, 1.5_f64);
    let path = SLEIGH.integrate(State::new([0.0; 3], [v0, 0.0, turn]), 50.0, method()).unwrap();
    let b = f64::sqrt((0.3 + 2.0 * 0.0625) / 2.0);
    let speed = v0.hypot(b * turn);
    let tau0 = (v0 / speed).atanh();
    let gd = |x: f64| 2.0 * (x / 2.0).tanh().atan();
    let deviation = largest(path.samples(1001).flat_map(|sample| {
        let tau = tau0 + 0.25 * speed * sample.time() / (b * b);
        let (v, rate) = (speed * tau.tanh(), speed / b / tau.cosh());
        let angle = b / 0.25 * (gd(tau) - gd(tau0));
        let rate_of_rate = -rate * tau.tanh() * 0.25 * speed / (b * b);
        let s = sample.state();
        let lambda = sample.multiplier("blade").unwrap();
        let forward = s.v[0] * s.q[2].cos() + s.v[1] * s.q[2].sin();
        [forward - v, s.v[2] - rate, s.q[2] - angle, lambda + 2.0 * (v * rate + 0.25 * rate_of_rate)]
            .map(f64::abs)
    }));
    assert!(deviation < 1e-8, "{deviation:e}");
}

/// The path of the blade has no closed form; values integrated in 113- and in 170-bit arithmetic.
#[test]
fn path_of_the_sleigh_against_reference_values() {
    let path = SLEIGH.integrate(State::new([0.0; 3], [1.0, 0.0, 1.5]), 5.0, method()).unwrap();
    let references = [
        (1.0, [0.960_795_783_596_556_2, 0.555_799_953_188_112_9], -0.664_703_541_509_871_4),
        (2.0, [1.644_968_817_674_402, 1.552_831_848_816_468], -0.161_540_789_887_965),
        (5.0, [3.297_790_674_112_69, 4.803_317_372_673_794], -0.002_213_821_760_192_539_5),
    ];
    for (t, [x, y], lambda) in references {
        let sample = path.at(t).unwrap();
        let s = sample.state();
        let off = [s.q[0] - x, s.q[1] - y, sample.multiplier("blade").unwrap() - lambda];
        assert!(largest(off.map(f64::abs)) < 1e-10, "{off:?} at t = {t}");
    }
}

/// A knife edge on an incline: it drifts sideways and comes back up the slope.
#[derive(Lagrangian)]
#[coordinates(x, y, th)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + inertia/2*th_dot^2 + m*g*sin(alpha)*x)]
#[constraint(edge: x_dot*sin(th) - y_dot*cos(th) = 0)]
struct KnifeEdge {
    m: f64,
    inertia: f64,
    g: f64,
    alpha: f64,
}

/// x = G/(2w²) sin² wt, y = G/(2w²) (wt − ½ sin 2wt), G = g sin α; and λ = −2 m G sin wt, from
/// m ÿ = −λ cos θ.
#[test]
fn knife_edge() {
    let edge = KnifeEdge { m: 1.5, inertia: 0.2, g: 9.81, alpha: std::f64::consts::FRAC_PI_6 };
    let w = 2.0;
    let path = edge.integrate(State::new([0.0; 3], [0.0, 0.0, w]), 50.0, method()).unwrap();
    let slope = 9.81 * edge.alpha.sin();
    let deviation = largest(path.samples(1001).flat_map(|sample| {
        let (s, angle) = (sample.state(), w * sample.time());
        let half = slope / (2.0 * w * w);
        let lambda = sample.multiplier("edge").unwrap() + 2.0 * 1.5 * slope * angle.sin();
        let y = half * (angle - (2.0 * angle).sin() / 2.0);
        [s.q[0] - half * angle.sin().powi(2), s.q[1] - y, s.q[2] - angle, lambda].map(f64::abs)
    }));
    assert!(deviation < 1e-8, "{deviation:e}");
}

/// The nonholonomic free particle ż = y ẋ.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2)]
#[constraint(tied: z_dot - y*x_dot = 0)]
struct Particle;

/// y = y₀ + c t; ẋ √(1 + y²) = k; x = (k/c) asinh y and z = (k/c) √(1 + y²) up to constants; λ = z̈.
#[test]
fn nonholonomic_particle() {
    let (y0, c) = (0.5_f64, 0.7);
    let path = Particle.integrate(State::new([0.0, y0, 0.0], [1.0, c, y0]), 50.0, method()).unwrap();
    let k = 1.25_f64.sqrt();
    let root = |y: f64| (1.0 + y * y).sqrt();
    let deviation = largest(path.samples(1001).flat_map(|sample| {
        let (s, y) = (sample.state(), y0 + c * sample.time());
        let x = k / c * (y.asinh() - y0.asinh());
        let z = k / c * (root(y) - root(y0));
        let lambda = sample.multiplier("tied").unwrap() - k * c / root(y).powi(3);
        [s.q[0] - x, s.q[1] - y, s.q[2] - z, s.v[0] * root(y) - k, lambda].map(f64::abs)
    }));
    assert!(deviation < 1e-8, "{deviation:e}");
}
