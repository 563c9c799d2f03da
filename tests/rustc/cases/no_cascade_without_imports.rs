#[derive(lagrange_core::Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - k*x)]
#[constraint(rail: y = 0)]
#[observable(place = [x, y])]
#[observable(push = lambda(rail))]
struct System {
    m: f64,
}

/// Names that the program gives to other things.
pub struct State;
pub struct Solution;
pub struct SVector;

fn main() {
    let system = System { m: 1.0 };
    let state = lagrange_core::State::at_rest([0.0, 0.0]);
    let solution = lagrange_core::Lagrangian::accelerations_unchecked(&system, &state);
    println!("{} {}", system.place(&state)[1], system.push(&state, &solution));
    let _ = (State, Solution, SVector);
}
