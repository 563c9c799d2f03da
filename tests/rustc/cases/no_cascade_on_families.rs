use lagrange_core::nalgebra::Const;
use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x: [3], r: [2])]
#[define(n = 3)]
#[lagrangian(m/2 * (dot(x_dot, x_dot) + dot(r_dot, r_dot)) - k*x[0])]
#[constraint(rod[0]: x[0] = 0)]
#[constraint(rod[i in 1..n]: x[i] - x[i - 1] = 1)]
#[constraint(fixed: r = [0, 0])]
struct Chain {
    m: f64,
}

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[constraint(rail: nothing*y = 0)]
struct OneRow {
    m: f64,
}

#[derive(Lagrangian)]
#[coordinates(r: [2])]
#[lagrangian(m/2 * dot(r_dot, r_dot))]
#[constraint(corner: nothing*r = 0)]
struct TwoRows {
    m: f64,
}

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[constraint(y = 0)]
struct WithoutName {
    m: f64,
}

fn rows<L: Lagrangian<N = Const<2>, M = Const<M>>, const M: usize>(_: &L) -> usize {
    M
}

fn main() {
    let chain = Chain { m: 1.0 };
    let path: Result<Trajectory<&Chain>, Error> =
        chain.integrate(State::at_rest([0.0; 5]), 1.0, Dop853::default());
    println!("{path:?} {:?}", <Chain as Lagrangian>::CONSTRAINTS);
    println!("{}", rows::<_, 1>(&OneRow { m: 1.0 }) + rows::<_, 2>(&TwoRows { m: 1.0 }));
    println!("{}", rows::<_, 1>(&WithoutName { m: 1.0 }));
}
