//! Pendulums.

use lagrange_core::prelude::*;

use crate::by_hand::{Number, WithDerivatives, check};
use lagrange_random::Random;

#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[lagrangian(m/2 * dot(r_dot, r_dot) - m*g*r[2])]
#[constraint(string: (dot(r, r) - l^2)/2 = 0)]
pub(crate) struct SphericalPendulum {
    m: f64,
    g: f64,
    l: f64,
}

impl WithDerivatives<3, 1> for SphericalPendulum {
    fn random(random: &mut Random) -> Self {
        Self { m: random.positive(), g: random.positive(), l: random.positive() }
    }

    fn l<D: Number>(&self, _: D, [_, _, z]: &[D; 3], [vx, vy, vz]: &[D; 3]) -> D {
        (vx.powi(2) + vy.powi(2) + vz.powi(2)) * (self.m / 2.0) - *z * self.m * self.g
    }

    fn constraints<D: Number>(&self, _: D, [x, y, z]: &[D; 3], _: &[D; 3]) -> [D; 1] {
        [(x.powi(2) + y.powi(2) + z.powi(2) - self.l.powi(2)) * 0.5]
    }
}

#[test]
fn spherical_pendulum_in_cartesian_coordinates() {
    check::<SphericalPendulum, _, _, _>();
}

#[derive(Lagrangian)]
#[coordinates(theta, phi)]
#[lagrangian(m*l^2/2 * (theta_dot^2 + sin(theta)^2 * phi_dot^2) - m*g*l*cos(theta))]
pub(crate) struct PolarPendulum {
    pub(crate) m: f64,
    pub(crate) g: f64,
    pub(crate) l: f64,
}

impl WithDerivatives<2, 0> for PolarPendulum {
    fn random(random: &mut Random) -> Self {
        Self { m: random.positive(), g: random.positive(), l: random.positive() }
    }

    fn l<D: Number>(&self, _: D, [theta, _]: &[D; 2], [theta_dot, phi_dot]: &[D; 2]) -> D {
        let speed_squared = (theta_dot.powi(2) + (theta.sin() * *phi_dot).powi(2)) * self.l.powi(2);
        speed_squared * (self.m / 2.0) - theta.cos() * (self.m * self.g * self.l)
    }
}

#[test]
fn spherical_pendulum_in_polar_coordinates() {
    check::<PolarPendulum, _, _, _>();
}

#[derive(Lagrangian)]
#[coordinates(a, b)]
#[lagrangian(
    (m1 + m2)/2 * l1^2 * a_dot^2 + m2/2 * l2^2 * b_dot^2 + m2*l1*l2*a_dot*b_dot*cos(a - b)
        + (m1 + m2)*g*l1*cos(a) + m2*g*l2*cos(b)
)]
pub(crate) struct DoublePendulum {
    m1: f64,
    m2: f64,
    l1: f64,
    l2: f64,
    g: f64,
}

impl WithDerivatives<2, 0> for DoublePendulum {
    fn random(random: &mut Random) -> Self {
        let [m1, m2, l1, l2, g] = random.array(Random::positive);
        Self { m1, m2, l1, l2, g }
    }

    /// From the positions of the two bobs, not from the expanded kinetic energy.
    fn l<D: Number>(&self, _: D, [a, b]: &[D; 2], [a_dot, b_dot]: &[D; 2]) -> D {
        let v1 = [a.cos() * *a_dot * self.l1, a.sin() * *a_dot * self.l1];
        let v2 = [v1[0] + b.cos() * *b_dot * self.l2, v1[1] + b.sin() * *b_dot * self.l2];
        let y1 = -a.cos() * self.l1;
        let y2 = y1 - b.cos() * self.l2;
        (v1[0].powi(2) + v1[1].powi(2)) * (self.m1 / 2.0) + (v2[0].powi(2) + v2[1].powi(2)) * (self.m2 / 2.0)
            - y1 * self.m1 * self.g
            - y2 * self.m2 * self.g
    }
}

#[test]
fn double_pendulum() {
    check::<DoublePendulum, _, _, _>();
}

#[derive(Lagrangian)]
#[coordinates(r, theta)]
#[lagrangian(m/2 * (r_dot^2 + r^2 * theta_dot^2) + m*g*r*cos(theta) - k/2 * (r - l)^2)]
pub(crate) struct ElasticPendulum {
    m: f64,
    g: f64,
    k: f64,
    l: f64,
}

impl WithDerivatives<2, 0> for ElasticPendulum {
    fn random(random: &mut Random) -> Self {
        let [m, g, k, l] = random.array(Random::positive);
        Self { m, g, k, l }
    }

    fn l<D: Number>(&self, _: D, [r, theta]: &[D; 2], [r_dot, theta_dot]: &[D; 2]) -> D {
        let kinetic = (r_dot.powi(2) + (*r * *theta_dot).powi(2)) * (self.m / 2.0);
        let height = -*r * theta.cos();
        kinetic - height * self.m * self.g - (*r - self.l).powi(2) * (self.k / 2.0)
    }
}

#[test]
fn elastic_pendulum() {
    check::<ElasticPendulum, _, _, _>();
}

/// A pendulum on one side of the pulley, a weight on the other.
#[derive(Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian(
    m/2 * (x_dot^2 + x^2 * theta_dot^2) + mass/2 * y_dot^2 + m*g*x*cos(theta) + mass*g*y
)]
#[constraint(rope: x + y = length)]
pub(crate) struct SwingingAtwood {
    m: f64,
    mass: f64,
    g: f64,
    length: f64,
}

impl WithDerivatives<3, 1> for SwingingAtwood {
    fn random(random: &mut Random) -> Self {
        let [m, mass, g, length] = random.array(Random::positive);
        Self { m, mass, g, length }
    }

    fn l<D: Number>(&self, _: D, [x, y, theta]: &[D; 3], [x_dot, y_dot, theta_dot]: &[D; 3]) -> D {
        let pendulum = (x_dot.powi(2) + (*x * *theta_dot).powi(2)) * (self.m / 2.0);
        let weight = y_dot.powi(2) * (self.mass / 2.0);
        pendulum + weight + *x * theta.cos() * (self.m * self.g) + *y * (self.mass * self.g)
    }

    fn constraints<D: Number>(&self, _: D, [x, y, _]: &[D; 3], _: &[D; 3]) -> [D; 1] {
        [*x + *y - self.length]
    }
}

#[test]
fn swinging_atwood_machine() {
    check::<SwingingAtwood, _, _, _>();
}

/// Kapitza's: the pivot moves up and down.
#[derive(Lagrangian)]
#[coordinates(theta)]
#[define(pivot = a*cos(w*t) + a*t^2/7)]
#[define(x = l*sin(theta))]
#[define(y = pivot - l*cos(theta))]
#[define(speed_squared = der(x)^2 + der(y)^2)]
#[lagrangian(m/2 * speed_squared - m*g*y)]
pub(crate) struct DrivenPendulum {
    m: f64,
    g: f64,
    l: f64,
    a: f64,
    w: f64,
}

impl WithDerivatives<1, 0> for DrivenPendulum {
    fn random(random: &mut Random) -> Self {
        let [m, g, l, a, w] = random.array(Random::positive);
        Self { m, g, l, a, w }
    }

    fn l<D: Number>(&self, t: D, [theta]: &[D; 1], [theta_dot]: &[D; 1]) -> D {
        let phase = t * self.w;
        let x_dot = theta.cos() * *theta_dot * self.l;
        let pivot_dot = -phase.sin() * (self.a * self.w) + t * (self.a * 2.0 / 7.0);
        let y_dot = pivot_dot + theta.sin() * *theta_dot * self.l;
        let y = phase.cos() * self.a + t.powi(2) * (self.a / 7.0) - theta.cos() * self.l;
        (x_dot.powi(2) + y_dot.powi(2)) * (self.m / 2.0) - y * self.m * self.g
    }
}

#[test]
fn pendulum_with_a_driven_pivot() {
    check::<DrivenPendulum, _, _, _>();
}

#[derive(Lagrangian)]
#[coordinates(theta: [5])]
#[define(vx[0] = l[0]*cos(theta[0])*theta_dot[0])]
#[define(vx[i in 1..5] = vx[i-1] + l[i]*cos(theta[i])*theta_dot[i])]
#[define(vy[0] = l[0]*sin(theta[0])*theta_dot[0])]
#[define(vy[i in 1..5] = vy[i-1] + l[i]*sin(theta[i])*theta_dot[i])]
#[define(y[i in 0..5] = -sum(j in 0..i+1, l[j]*cos(theta[j])))]
#[lagrangian(sum(i in 0..5, m[i]/2 * (vx[i]^2 + vy[i]^2) - m[i]*g*y[i]))]
pub(crate) struct Chain {
    m: [f64; 5],
    l: [f64; 5],
    g: f64,
}

impl WithDerivatives<5, 0> for Chain {
    fn random(random: &mut Random) -> Self {
        let (m, l) = (random.array(Random::positive), random.array(Random::positive));
        Self { m, l, g: random.positive() }
    }

    fn l<D: Number>(&self, _: D, theta: &[D; 5], theta_dot: &[D; 5]) -> D {
        let (mut vx, mut vy, mut y, mut total) = (D::zero(), D::zero(), D::zero(), D::zero());
        for i in 0..5 {
            vx += theta[i].cos() * theta_dot[i] * self.l[i];
            vy += theta[i].sin() * theta_dot[i] * self.l[i];
            y -= theta[i].cos() * self.l[i];
            total += (vx * vx + vy * vy) * (self.m[i] / 2.0) - y * (self.m[i] * self.g);
        }
        total
    }
}

#[test]
fn chain_of_five_links() {
    check::<Chain, _, _, _>();
}

/// Rods whose centres are sums over the rods before, last first, with drag on each and a push on the last.
#[derive(Lagrangian)]
#[coordinates(theta: [6])]
#[define(before[i in 0..6] = [sum(j in 0..i, l[j]*sin(theta[j])), -sum(j in 0..i, l[j]*cos(theta[j]))])]
#[define(r[k in 0..6] = before[5-k] + c[5-k]*[sin(theta[5-k]), -cos(theta[5-k])])]
#[lagrangian(sum(i in 0..6, m[i]/2 * (dot(der(r[5-i]), der(r[5-i])) + l[i]^2/12 * theta_dot[i]^2) - m[i]*g*r[5-i][1]))]
#[dissipation(sum(i in 0..6, drag/2 * dot(der(r[i]), der(r[i]))))]
#[power([push, 0], der(r[0]))]
pub(crate) struct Rods {
    m: [f64; 6],
    l: [f64; 6],
    c: [f64; 6],
    g: f64,
    drag: f64,
    push: f64,
}

impl Rods {
    /// The square of the speed of each centre, and its height.
    fn centres<D: Number>(&self, theta: &[D; 6], theta_dot: &[D; 6]) -> [(D, D); 6] {
        std::array::from_fn(|i| {
            let (mut vx, mut vy, mut y) = (D::zero(), D::zero(), D::zero());
            for j in 0..=i {
                let arm = if j == i { self.c[j] } else { self.l[j] };
                vx += theta[j].cos() * theta_dot[j] * arm;
                vy += theta[j].sin() * theta_dot[j] * arm;
                y -= theta[j].cos() * arm;
            }
            (vx * vx + vy * vy, y)
        })
    }
}

impl WithDerivatives<6, 0> for Rods {
    fn random(random: &mut Random) -> Self {
        let [m, l, c] = [(); 3].map(|()| random.array(Random::positive));
        Self { m, l, c, g: random.positive(), drag: random.positive(), push: random.positive() }
    }

    fn l<D: Number>(&self, _: D, theta: &[D; 6], theta_dot: &[D; 6]) -> D {
        let centres = self.centres(theta, theta_dot).into_iter().enumerate();
        centres.fold(D::zero(), |total, (i, (square, y))| {
            let turning = theta_dot[i] * theta_dot[i] * (self.l[i].powi(2) / 12.0);
            total + (square + turning) * (self.m[i] / 2.0) - y * (self.m[i] * self.g)
        })
    }

    fn dissipation<D: Number>(&self, _: D, theta: &[D; 6], theta_dot: &[D; 6]) -> D {
        let squares = self.centres(theta, theta_dot).into_iter().map(|(square, _)| square);
        squares.fold(D::zero(), |total, square| total + square * (self.drag / 2.0))
    }

    fn forces(&self, _: f64, theta: &[f64; 6], _: &[f64; 6]) -> [f64; 6] {
        std::array::from_fn(|j| self.push * theta[j].cos() * if j == 5 { self.c[j] } else { self.l[j] })
    }
}

#[test]
fn rods_whose_centres_are_sums() {
    check::<Rods, _, _, _>();
}
