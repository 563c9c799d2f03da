use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [3], x)]
#[define(a = transpose(r))]
#[define(b = trace([[1, 2, 3], [4, 5, 6]]))]
#[define(c = skew([1, 2]))]
#[define(d = identity(0))]
#[define(e = identity(x))]
#[define(f = rot_x(r))]
#[define(g = rot([0, 0], x))]
#[define(h = rot([0, 0, 0], x))]
#[define(i = rot(x))]
#[define(j = quat_mul(r, [1, 0, 0, 0]))]
#[define(k = quat_mul([1, 0, 0, 0], r))]
#[define(l = quat_conj(r))]
#[define(m = eye(3))]
#[define(n = inv(skew(r)))]
#[define(o = Rz(x))]
#[define(p = Matrix(1, 2))]
#[define(q = det(skew(r)))]
#[define(trace = 1)]
#[lagrangian(dot(r_dot, r_dot)/2 + x_dot^2/2 + pose)]
struct System {
    pose: lagrange_core::nalgebra::Isometry2<f64>,
}

fn main() {}
