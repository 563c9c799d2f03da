//! Everything that an expression may contain, in coordinates and in velocities.

use lagrange_core::prelude::*;

use crate::by_hand::{ByHand, D, DualNum, checks, cross, dot};
use lagrange_random::Random;

#[derive(Default, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(
    m*(x_dot^2 + y_dot^2 + z_dot^2)*(3 + sin(x)*cos(y))
        + tan(x/3)*y_dot + sin(x_dot*y) - cos(z_dot - y_dot)/4 + tan(z_dot/4 + x/8)
        + asin(x_dot/4)*acos(y/4) + acos(z_dot/3)*asin(z*x/4)
        + atan(x*y_dot) + atan2(y, 2 + x^2)*z_dot + atan2(x_dot*y, z - 2*y_dot) - pi*x_dot*z
)]
struct Circular {
    m: f64,
}

impl ByHand<3, 0> for Circular {
    const AT_ORIGIN: bool = false;

    fn l(&self, _: D, [x, y, z]: &[D; 3], [vx, vy, vz]: &[D; 3]) -> D {
        let speed_squared = vx.powi(2) + vy.powi(2) + vz.powi(2);
        let kinetic = speed_squared * (x.sin() * y.cos() + 3.0) * self.m;
        let direct = (*x / 3.0).tan() * *vy + (*vx * *y).sin() - (*vz - *vy).cos() / 4.0
            + (*vz / 4.0 + *x / 8.0).tan();
        let inverse = (*vx / 4.0).asin() * (*y / 4.0).acos()
            + (*vz / 3.0).acos() * (*z * *x / 4.0).asin()
            + (*x * *vy).atan();
        let angles = y.atan2(x.powi(2) + 2.0) * *vz + (*vx * *y).atan2(*z - *vy * 2.0);
        kinetic + direct + inverse + angles - *vx * *z * std::f64::consts::PI
    }
}

#[derive(Default, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(
    m*(x_dot^2 + y_dot^2 + z_dot^2)*(2 + tanh(z))
        + sinh(x_dot/2)*cosh(y/2) + cosh(z_dot - x)/3 + sinh(y)*tanh(y_dot*x)
        + exp(-x_dot*y/2) + ln(5 + x*y_dot) - ln(x^2 + 1)*z_dot
        + abs(x - 1)*z_dot^2 + abs(y_dot - z)*x + abs(z)^2*abs(y_dot)^3
)]
struct Hyperbolic {
    m: f64,
}

impl ByHand<3, 0> for Hyperbolic {
    const AT_ORIGIN: bool = false;

    fn l(&self, _: D, [x, y, z]: &[D; 3], [vx, vy, vz]: &[D; 3]) -> D {
        let kinetic = (vx.powi(2) + vy.powi(2) + vz.powi(2)) * (z.tanh() + 2.0) * self.m;
        let hyperbolic =
            (*vx / 2.0).sinh() * (*y / 2.0).cosh() + (*vz - *x).cosh() / 3.0 + y.sinh() * (*vy * *x).tanh();
        let exponential = (-*vx * *y / 2.0).exp() + (*x * *vy + 5.0).ln() - (x.powi(2) + 1.0).ln() * *vz;
        let absolute = (*x - 1.0).abs() * vz.powi(2) + (*vy - *z).abs() * *x + z.powi(2) * vy.abs().powi(3);
        kinetic + hyperbolic + exponential + absolute
    }
}

#[derive(Default, Lagrangian)]
#[coordinates(x, y)]
#[define(u = 3 + x*x_dot)]
#[lagrangian(
    m*(x_dot^2 + y_dot^2)*(1 + x^2)^(3/2) + u^u/100
        + (2 + x)^y_dot + (3 + y_dot)^(x - y) + 2^(x_dot*x) + (2 + x_dot)^a
        + sqrt(5 + x_dot^2 + y^2) + (4 + x*y_dot)^(-1/2) + (2 + y)^(1/3)*x_dot
        + (3 + y_dot^2)^(-5/3) + (x + y_dot)^5 - (x - 2)^(-3)*y_dot + x_dot^7/100
        + (3 + x*x_dot)^0.25 + (x_dot/y_dot)^2*y/50
)]
struct Powers {
    m: f64,
    a: f64,
}

impl ByHand<2, 0> for Powers {
    const AT_ORIGIN: bool = false;

    fn random(random: &mut Random) -> Self {
        Self { m: random.between(3.0, 4.0), a: random.signed() }
    }

    fn state(&self, random: &mut Random) -> State<f64, 2> {
        let q = random.array(Random::signed);
        State::new(q, [random.signed(), random.positive()])
    }

    fn l(&self, _: D, [x, y]: &[D; 2], [vx, vy]: &[D; 2]) -> D {
        let kinetic = (vx.powi(2) + vy.powi(2)) * DualNum::powf(&(x.powi(2) + 1.0), 1.5) * self.m;
        let general = (*x + 2.0).powd(*vy)
            + (*vy + 3.0).powd(*x - *y)
            + D::from(2.0).powd(*vx * *x)
            + DualNum::powf(&(*vx + 2.0), self.a);
        let roots = (vx.powi(2) + y.powi(2) + 5.0).sqrt()
            + (*x * *vy + 4.0).sqrt().recip()
            + (*y + 2.0).cbrt() * *vx
            + DualNum::powf(&(vy.powi(2) + 3.0), -5.0 / 3.0)
            + (*x * *vx + 3.0).sqrt().sqrt();
        let whole = (*x + *vy).powi(5) - (*x - 2.0).powi(-3) * *vy + vx.powi(7) / 100.0;
        let of_itself = (*x * *vx + 3.0).powd(*x * *vx + 3.0) / 100.0;
        kinetic + general + roots + whole + of_itself + (*vx / *vy).powi(2) * *y / 50.0
    }
}

/// Functions of scalars and of vectors, each with its own formals, called with one another.
#[derive(Default, Lagrangian)]
#[coordinates(r: [3], s)]
#[define(square(x) = x^2)]
#[define(soften(r) = sqrt(square(r) + a^2))]
#[define(triple(u, v, w) = dot(u, cross(v, w)))]
#[define(speed(u) = norm(der(u)))]
#[define(e = [cos(s), sin(s), s])]
#[lagrangian(
    m/2*square(norm(r_dot)) + m/2*square(speed(e)) - k/soften(norm(r))
        + triple(b, r, r_dot) - k*triple(e, b, r) + k*norm(r - e)*s_dot/4 + dot(cross(e, r), r_dot)
)]
struct Functions {
    m: f64,
    a: f64,
    k: f64,
    b: [f64; 3],
}

impl ByHand<4, 0> for Functions {
    const AT_ORIGIN: bool = false;

    fn l(&self, _: D, &[x, y, z, s]: &[D; 4], &[vx, vy, vz, vs]: &[D; 4]) -> D {
        let (r, v, e, b) = ([x, y, z], [vx, vy, vz], [s.cos(), s.sin(), s], self.b.map(D::from));
        let along = [-s.sin() * vs, s.cos() * vs, vs];
        let kinetic = (dot(v, v) + dot(along, along)) * (self.m / 2.0);
        let distance = [x - e[0], y - e[1], z - e[2]];
        kinetic - (dot(r, r) + self.a.powi(2)).sqrt().recip() * self.k + dot(b, cross(r, v))
            - dot(e, cross(b, r)) * self.k
            + dot(distance, distance).sqrt() * vs * (self.k / 4.0)
            + dot(cross(e, r), v)
    }
}

checks! {
    circular_functions: Circular;
    hyperbolic_and_exponential_functions: Hyperbolic;
    powers: Powers;
    defined_functions_and_vectors: Functions;
}

/// A force law with the exponent as a parameter: F = −k n xⁿ⁻¹ is finite where the spring is relaxed.
#[derive(Default, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k * x^n)]
struct Spring {
    m: f64,
    k: f64,
    n: f64,
}

#[test]
fn a_power_with_a_parameter_as_exponent_has_a_derivative_at_zero() {
    let spring = Spring { m: 1.0, k: 3.0, n: 2.0 };
    assert_eq!(spring.forcing(&State::at_rest([0.0]))[0], 0.0);
    assert_eq!(spring.forcing(&State::at_rest([-0.5]))[0], 3.0);
}
