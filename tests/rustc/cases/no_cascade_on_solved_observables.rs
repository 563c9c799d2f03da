use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[define(speed = 2*x_dot)]
#[define(rate(f) = der(f))]
#[define(place(f) = der(f))]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - k*x)]
#[constraint(rail: [x, y] = [0, 0])]
#[observable(push = lambda(rail))]
#[observable(first = push[0])]
#[observable(thrust = der(speed))]
#[observable(change = rate(speed))]
#[observable(moving = place(x))]
#[observable(fast = ẍ)]
#[observable(wrong = nothing*thrust)]
#[observable(worse = nothing + der(speed))]
#[observable(worst = nothing*der(x))]
struct System {
    m: f64,
}

fn main() {
    let system = System { m: 1.0 };
    let state = State::at_rest([0.0, 0.0]);
    let solution = system.accelerations_unchecked(&state);
    println!("{}", system.push(&state, &solution)[1] + system.first(&state, &solution));
    println!("{}", system.thrust(&state, &solution) + system.change(&state, &solution));
    println!("{}", system.moving(&state) + system.fast(&state, &solution));
    println!("{}", system.wrong(&state, &solution) + system.worse(&state, &solution) + system.worst(&state));
}
