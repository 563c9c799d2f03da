use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[define(d[i in 0..3, j in 0..2] = i*x^j)]
#[define(triangle[i in 0..3, j in 0..i] = i - j)]
#[define(gap[i in 0..2, 1] = x)]
#[define(long[i in 0..200, j in 0..200] = x)]
#[define(twice[i in 0..2, i in 0..2] = x)]
#[define(low[i in 0..2, -1] = x)]
#[define(uneven[0] = x)]
#[define(uneven[1] = [x, x])]
#[define(again[i in 0..2, j in 0..2] = x)]
#[define(again[1, 1] = x)]
#[lagrangian(x_dot^2/2 + d[0][2] + d[3][0] + dot(d[3], [1, 2]) + dot(gap[1], [1, 2]) + d[0] + d[0][0][0] + triangle[1][1] + norm(uneven))]
#[observable(all = triangle)]
struct Elements;

#[derive(Lagrangian)]
#[coordinates(x)]
#[define(bare[i, j] = x)]
#[lagrangian(x_dot^2/2)]
struct Bare;

#[derive(Lagrangian)]
#[coordinates(x)]
#[define(d[i in 0..3, j in 0..2] = i*x^j)]
#[define(d[3] = x)]
#[lagrangian(x_dot^2/2 + d[3])]
struct Ranks;

#[derive(Lagrangian)]
#[coordinates(x)]
#[define(a[0] = x)]
#[define(a[i in 1..4] = b[i] + a[i-1])]
#[define(b[i in 0..4] = 2*a[i])]
#[define(c[i in 0..4] = c[i+1])]
#[define(v = later[0])]
#[define(later[0] = x)]
#[lagrangian(x_dot^2/2)]
struct Circles;

#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[lagrangian(dot(r_dot, r_dot)/2)]
#[constraint(c[0]: r[0] = 1)]
#[constraint(c[1, 2]: r[1] = 1)]
#[observable(none = lambda(c[0][1]))]
struct Constraints;

#[derive(Lagrangian)]
#[coordinates(q: [2, 2])]
#[frame(leg[i in 0..2, 0]: rotate_z(q[i][0]))]
#[frame(leg[i in 0..2, 1] in leg[i]: rotate_z(q[i][1]))]
#[lagrangian(kinetic(leg, 1) + kinetic(leg[0][2], 1))]
struct Frames;

fn main() {}
