use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[constraint(rail: y = 0)]
#[observable(pair = [2x, y])]
#[observable(push = 2lambda(rail))]
#[observable(thrusts = [2x_ddot, push, y])]
#[observable(speed = 2*x_dot, y_dot)]
struct System {
    m: f64,
}

fn main() {
    let system = System { m: 1.0 };
    let state = State::at_rest([0.0, 0.0]);
    let solution = system.accelerations_unchecked(&state);
    println!("{} {}", system.pair(&state)[1], system.push(&state, &solution));
    println!("{} {}", system.thrusts(&state, &solution)[2], system.speed(&state));
}
