//! Pendulums.

use lagrange_core::prelude::*;

use crate::by_hand::{ByHand, D, DualNum, checks};

/// Kapitza's: the pivot moves up and down.
#[derive(Default, Lagrangian)]
#[coordinates(theta)]
#[define(pivot = a*cos(w*t) + a*t^2/7)]
#[define(x = l*sin(theta))]
#[define(y = pivot - l*cos(theta))]
#[define(speed_squared = der(x)^2 + der(y)^2)]
#[lagrangian(m/2 * speed_squared - m*g*y)]
struct DrivenPendulum {
    m: f64,
    g: f64,
    l: f64,
    a: f64,
    w: f64,
}

impl ByHand<1, 0> for DrivenPendulum {
    fn l(&self, t: D, [theta]: &[D; 1], [theta_dot]: &[D; 1]) -> D {
        let phase = t * self.w;
        let x_dot = theta.cos() * *theta_dot * self.l;
        let pivot_dot = -phase.sin() * (self.a * self.w) + t * (self.a * 2.0 / 7.0);
        let y_dot = pivot_dot + theta.sin() * *theta_dot * self.l;
        let y = phase.cos() * self.a + t.powi(2) * (self.a / 7.0) - theta.cos() * self.l;
        (x_dot.powi(2) + y_dot.powi(2)) * (self.m / 2.0) - y * self.m * self.g
    }
}

#[derive(Default, Lagrangian)]
#[coordinates(theta: [5])]
#[define(vx[0] = l[0]*cos(theta[0])*theta_dot[0])]
#[define(vx[i in 1..5] = vx[i-1] + l[i]*cos(theta[i])*theta_dot[i])]
#[define(vy[0] = l[0]*sin(theta[0])*theta_dot[0])]
#[define(vy[i in 1..5] = vy[i-1] + l[i]*sin(theta[i])*theta_dot[i])]
#[define(y[i in 0..5] = -sum(j in 0..i+1, l[j]*cos(theta[j])))]
#[lagrangian(sum(i in 0..5, m[i]/2 * (vx[i]^2 + vy[i]^2) - m[i]*g*y[i]))]
struct Chain {
    m: [f64; 5],
    l: [f64; 5],
    g: f64,
}

impl ByHand<5, 0> for Chain {
    fn l(&self, _: D, theta: &[D; 5], theta_dot: &[D; 5]) -> D {
        let (mut vx, mut vy, mut y, mut total) =
            (D::from_re(0.0), D::from_re(0.0), D::from_re(0.0), D::from_re(0.0));
        for i in 0..5 {
            vx += theta[i].cos() * theta_dot[i] * self.l[i];
            vy += theta[i].sin() * theta_dot[i] * self.l[i];
            y -= theta[i].cos() * self.l[i];
            total += (vx * vx + vy * vy) * (self.m[i] / 2.0) - y * (self.m[i] * self.g);
        }
        total
    }
}

/// Rods whose centres are sums over the rods before, last first, with drag on each and a push on the last.
#[derive(Default, Lagrangian)]
#[coordinates(theta: [6])]
#[define(before[i in 0..6] = [sum(j in 0..i, l[j]*sin(theta[j])), -sum(j in 0..i, l[j]*cos(theta[j]))])]
#[define(r[k in 0..6] = before[5-k] + c[5-k]*[sin(theta[5-k]), -cos(theta[5-k])])]
#[lagrangian(sum(i in 0..6, m[i]/2 * (dot(der(r[5-i]), der(r[5-i])) + l[i]^2/12 * theta_dot[i]^2) - m[i]*g*r[5-i][1]))]
#[dissipation(sum(i in 0..6, drag/2 * dot(der(r[i]), der(r[i]))))]
#[power([push, 0], der(r[0]))]
struct Rods {
    m: [f64; 6],
    l: [f64; 6],
    c: [f64; 6],
    g: f64,
    drag: f64,
    push: f64,
}

impl Rods {
    /// The square of the speed of each centre, and its height.
    fn centres(&self, theta: &[D; 6], theta_dot: &[D; 6]) -> [(D, D); 6] {
        std::array::from_fn(|i| {
            let (mut vx, mut vy, mut y) = (D::from_re(0.0), D::from_re(0.0), D::from_re(0.0));
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

impl ByHand<6, 0> for Rods {
    fn l(&self, _: D, theta: &[D; 6], theta_dot: &[D; 6]) -> D {
        let centres = self.centres(theta, theta_dot).into_iter().enumerate();
        centres.fold(D::from_re(0.0), |total, (i, (square, y))| {
            let turning = theta_dot[i] * theta_dot[i] * (self.l[i].powi(2) / 12.0);
            total + (square + turning) * (self.m[i] / 2.0) - y * (self.m[i] * self.g)
        })
    }

    fn dissipation(&self, _: D, theta: &[D; 6], theta_dot: &[D; 6]) -> D {
        let squares = self.centres(theta, theta_dot).into_iter().map(|(square, _)| square);
        squares.fold(D::from_re(0.0), |total, square| total + square * (self.drag / 2.0))
    }

    fn forces(&self, _: f64, theta: &[f64; 6], _: &[f64; 6]) -> [f64; 6] {
        std::array::from_fn(|j| self.push * theta[j].cos() * if j == 5 { self.c[j] } else { self.l[j] })
    }
}

checks! {
    pendulum_with_a_driven_pivot: DrivenPendulum;
    chain_of_five_links: Chain;
    rods_whose_centres_are_sums: Rods;
}
