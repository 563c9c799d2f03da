use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y, q: [4], r: [3])]
#[frame(a: rotate_z(x))]
#[frame(b: rotate_z(y))]
#[frame(chain[k in 0..3]: rotate_z(x))]
#[define(s1 = a + 1)]
#[define(s2 = a(3))]
#[define(s3 = position(x, [1, 0, 0]))]
#[define(s4 = position(nobody))]
#[define(s5 = position(chain))]
#[define(s6 = position(chain[7]))]
#[define(s7 = position(a[0]))]
#[define(s8 = position(a, x))]
#[define(s9 = velocity(a, [1, 0]))]
#[define(s13 = kinetic(a, m, [1, 0, 0], 3))]
#[define(s14 = kinetic(a))]
#[define(s15 = kinetic(a, m, skew([1, 2, 3])))]
#[define(s16 = express(velocity(a), 3))]
#[define(s18 = der(x, a))]
#[define(s20 = velocity(fxied))]
#[define(s21 = angular_velocity(a, b))]
#[define(s22 = position())]
#[define(s23 = der(velocity(a), q))]
#[lagrangian(x_dot^2 + y_dot^2 + dot(q_dot, q_dot) + dot(r_dot, r_dot) + fixed)]
struct System {
    m: f64,
}

fn main() {}
