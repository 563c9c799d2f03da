use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k*x)]
#[constraint(stop: x = 0)]
#[observable(push = lambda(stop))]
#[observable(speed = x_dot)]
struct System {
    m: f64,
}

fn main() {
    let system = System { m: 1.0 };
    let state = State::at_rest([0.0]);
    let solution = system.accelerations_unchecked(&state);
    let path = system.integrate(state, 1.0, Dop853::default());
    let near = system.linearize(&state, &["m"]);
    let jacobian = system.jacobian(&state);
    println!("{near:?} {jacobian:?}");
    println!("{:?} {} {}", path, system.speed(&state), system.push(&state, &solution));
}
