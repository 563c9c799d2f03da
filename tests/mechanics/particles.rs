//! Particles in fields of force.

use lagrange_core::nalgebra::{Matrix3, SMatrix, Vector2};
use lagrange_core::prelude::*;

use crate::by_hand::{ByHand, D, DualNum, checks, square};
use lagrange_random::Random;

/// The Lagrangian is not quadratic in the velocities.
#[derive(Default, Lagrangian)]
#[coordinates(x, y)]
#[define(gamma = 1/sqrt(1 - (x_dot^2 + y_dot^2)/c^2))]
#[lagrangian(-m*c^2/gamma - k/2*(x^2 + y^2) - q*x*y^3)]
struct Relativistic {
    m: f64,
    c: f64,
    k: f64,
    q: f64,
}

impl ByHand<2, 0> for Relativistic {
    fn random(random: &mut Random) -> Self {
        let c = random.between(3.0, 5.0);
        Self { m: random.positive(), c, k: random.positive(), q: random.signed() }
    }

    fn l(&self, _: D, [x, y]: &[D; 2], [vx, vy]: &[D; 2]) -> D {
        let beta_squared = (*vx * *vx + *vy * *vy) / self.c.powi(2);
        let rest = -(-beta_squared + 1.0).sqrt() * (self.m * self.c * self.c);
        rest - (*x * *x + *y * *y) * (self.k / 2.0) - *x * y.powi(3) * self.q
    }
}

/// Forces by hand and by Rayleigh's function, on a scalar and on a vector coordinate.
#[derive(Default, Lagrangian)]
#[coordinates(x, r: [2])]
#[lagrangian(m/2*(x_dot^2 + dot(r_dot, r_dot)) - k/2*(x^2 + dot(r, r)) + k*x*r[0])]
#[force(x: -b*x_dot*abs(x_dot) + f*cos(w*t))]
#[force(x: f*t*r[0]*r_dot[1])]
#[force(r: [-b*r_dot[1]*x, f*sin(w*t)*r_dot[0]^2])]
#[force(r[1]: f*x_dot^3)]
#[dissipation(c/2*(1 + x^2)*x_dot^2 + c/4*(dot(r_dot, r_dot))^2*exp(-t) + c*x_dot*r_dot[0]*r[1])]
struct Driven {
    m: f64,
    k: f64,
    b: f64,
    c: f64,
    f: f64,
    w: f64,
}

impl ByHand<3, 0> for Driven {
    fn l(&self, _: D, [x, r0, r1]: &[D; 3], v: &[D; 3]) -> D {
        let kinetic = square(v) * (self.m / 2.0);
        kinetic - (x.powi(2) + r0.powi(2) + r1.powi(2)) * (self.k / 2.0) + *x * *r0 * self.k
    }

    fn forces(&self, t: f64, q: &[f64; 3], v: &[f64; 3]) -> [f64; 3] {
        let Self { b, f, w, .. } = self;
        [
            -b * v[0] * v[0].abs() + f * (w * t).cos() + f * t * q[1] * v[2],
            -b * v[2] * q[0],
            f * (w * t).sin() * v[1].powi(2) + f * v[0].powi(3),
        ]
    }

    fn dissipation(&self, t: D, q: &[D; 3], v: &[D; 3]) -> D {
        let linear = (q[0].powi(2) + 1.0) * v[0].powi(2) * (self.c / 2.0);
        let cubic = (v[1].powi(2) + v[2].powi(2)).powi(2) * (-t).exp() * (self.c / 4.0);
        linear + cubic + v[0] * v[1] * q[2] * self.c
    }
}

/// Coupled oscillators: the stiffness by rows, the inertia as a matrix of nalgebra, and a constraint of two rows.
#[derive(Default, Lagrangian)]
#[coordinates(x: [3])]
#[lagrangian(dot(x_dot, inertia*x_dot)/2 - dot(x, stiffness*x)/2)]
#[constraint(rows: a*x = d)]
struct Coupled {
    inertia: Matrix3<f64>,
    stiffness: [[f64; 3]; 3],
    a: SMatrix<f64, 2, 3>,
    d: Vector2<f64>,
}

impl ByHand<3, 2> for Coupled {
    /// The inertia is not symmetric: only its symmetric part acts.
    fn random(random: &mut Random) -> Self {
        let inertia = Matrix3::from_fn(|i, j| if i == j { 4.0 } else { 0.5 * random.signed() });
        let a = SMatrix::from_fn(|_, _| random.signed());
        let stiffness = std::array::from_fn(|_| random.array(Random::signed));
        Self { inertia, stiffness, a, d: random.array(Random::signed).into() }
    }

    fn l(&self, _: D, x: &[D; 3], v: &[D; 3]) -> D {
        let mut total = D::from_re(0.0);
        for i in 0..3 {
            for j in 0..3 {
                total += v[i] * v[j] * (self.inertia[(i, j)] / 2.0);
                total -= x[i] * x[j] * (self.stiffness[i][j] / 2.0);
            }
        }
        total
    }

    fn constraints(&self, _: D, x: &[D; 3], _: &[D; 3]) -> [D; 2] {
        std::array::from_fn(|i| (0..3).map(|j| x[j] * self.a[(i, j)]).sum::<D>() - self.d[i])
    }
}

checks! {
    relativistic_particle: Relativistic;
    forces_and_dissipation: Driven, with check_jacobian;
    matrices_as_parameters: Coupled;
}
