use lagrange_core::{Solution, prelude::*};

#[derive(Lagrangian)]
#[coordinates(r: [3], x = 1)]
#[lagrangian(m/2 * (dot(r_dot, r_dot) + x_dot^2))]
#[constraint(fixed: r = [0, 0, 0])]
#[observable(place = r)]
struct System {
    m: f64,
}

fn main() {
    let system = System { m: 1.0 };
    let state = State::at_rest([0.0; 4]);
    let solution: Solution<f64, 4, 3> = system.accelerations_unchecked(&state);
    println!("{} {}", solution.multipliers, system.place(&state)[1]);
}
