//! Parameters in vectors and matrices, and families of vectors.

use lagrange_core::nalgebra::{Matrix3, SMatrix, Vector2};
use lagrange_core::prelude::*;

use crate::by_hand::{Number, WithDerivatives, check};
use lagrange_random::Random;
use lagrange_systems::random_state;

/// Coupled oscillators: the stiffness by rows, the inertia as a matrix of nalgebra, and a constraint of two rows.
#[derive(Lagrangian)]
#[coordinates(x: [3])]
#[lagrangian(dot(x_dot, inertia*x_dot)/2 - dot(x, stiffness*x)/2)]
#[constraint(rows: a*x = d)]
pub(crate) struct Coupled {
    inertia: Matrix3<f64>,
    stiffness: [[f64; 3]; 3],
    a: SMatrix<f64, 2, 3>,
    d: Vector2<f64>,
}

impl WithDerivatives<3, 2> for Coupled {
    /// The inertia is not symmetric: only its symmetric part acts.
    fn random(random: &mut Random) -> Self {
        let inertia = Matrix3::from_fn(|i, j| if i == j { 4.0 } else { 0.5 * random.signed() });
        let a = SMatrix::from_fn(|_, _| random.signed());
        let stiffness = std::array::from_fn(|_| random.array(Random::signed));
        Self { inertia, stiffness, a, d: random.array(Random::signed).into() }
    }

    fn l<D: Number>(&self, _: D, x: &[D; 3], v: &[D; 3]) -> D {
        let mut total = D::zero();
        for i in 0..3 {
            for j in 0..3 {
                total += v[i] * v[j] * (self.inertia[(i, j)] / 2.0);
                total -= x[i] * x[j] * (self.stiffness[i][j] / 2.0);
            }
        }
        total
    }

    fn constraints<D: Number>(&self, _: D, x: &[D; 3], _: &[D; 3]) -> [D; 2] {
        std::array::from_fn(|i| (0..3).map(|j| x[j] * self.a[(i, j)]).sum::<D>() - self.d[i])
    }
}

#[test]
fn matrices_as_parameters() {
    check::<Coupled, _, _, _>();
}

/// A family of vectors: three masses on a string in space, each seen from the one before.
#[derive(Lagrangian)]
#[coordinates(u: [3], w: [3])]
#[define(p[0] = [l[0]*sin(u[0])*cos(w[0]), l[0]*sin(u[0])*sin(w[0]), -l[0]*cos(u[0])])]
#[define(p[i in 1..3] = p[i-1] + l[i]*[sin(u[i])*cos(w[i]), sin(u[i])*sin(w[i]), -cos(u[i])])]
#[lagrangian(sum(i in 0..3, dot(der(p[i]), der(p[i]))/2 - g*p[i][2]))]
pub(crate) struct StringOfMasses {
    l: [f64; 3],
    g: f64,
}

impl WithDerivatives<6, 0> for StringOfMasses {
    fn random(random: &mut Random) -> Self {
        Self { l: random.array(Random::positive), g: random.positive() }
    }

    fn state(&self, random: &mut Random) -> State<f64, 6> {
        // Away from the poles, where the azimuth has no inertia.
        let mut state = random_state(random);
        (0..3).for_each(|i| state.q[i] = random.between(0.5, 2.5));
        state
    }

    fn l<D: Number>(&self, _: D, q: &[D; 6], v: &[D; 6]) -> D {
        let (mut velocity, mut height, mut total) = ([D::zero(); 3], D::zero(), D::zero());
        for i in 0..3 {
            let ((su, cu), (sw, cw)) = (q[i].sin_cos(), q[i + 3].sin_cos());
            velocity[0] += (cu * cw * v[i] - su * sw * v[i + 3]) * self.l[i];
            velocity[1] += (cu * sw * v[i] + su * cw * v[i + 3]) * self.l[i];
            velocity[2] += su * v[i] * self.l[i];
            height -= cu * self.l[i];
            total += velocity.iter().map(|v| v.powi(2)).sum::<D>() * 0.5 - height * self.g;
        }
        total
    }
}

#[test]
fn family_of_vectors() {
    check::<StringOfMasses, _, _, _>();
}
