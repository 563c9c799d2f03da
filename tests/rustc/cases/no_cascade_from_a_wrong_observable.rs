use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2)]
#[observable(speed = 2x_dot)]
struct System {
    m: f64,
}

fn main() {
    let system = System { m: 1.0 };
    println!("{}", system.speed(&State::at_rest([0.0])));
}
