use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[define(a = b)]
#[lagrangian(m/2 * x_dot^2 - k*x + log(x))]
#[constraint(c: x = w)]
#[force(y: 1)]
#[observable(solve = 1)]
struct System {
    m: f64,
}

fn main() {
    let system = System { m: 1.0 };
    system.accelerations_unchecked(&State::at_rest([0.0]));
}
