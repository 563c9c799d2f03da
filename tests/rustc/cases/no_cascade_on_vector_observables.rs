use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [3], q: [4], z)]
#[define(arm[i in 0..2] = r[i] + z)]
#[lagrangian(m/2 * (dot(r_dot, r_dot) + dot(q_dot, q_dot) + z_dot^2) - k*z)]
#[observable(place = r)]
#[observable(swept = cross(r, r_dot))]
#[observable(arms = 2*arm)]
#[observable(top = quat_rotate(q, r) + [0, 0, 1])]
#[observable(pair = [z, z_dot])]
#[observable(single = [z])]
#[observable(height = arms[1])]
#[observable(missing = nothing*cross(r, r_dot))]
#[observable(rates = der(nothing*r) - [1, 2, 3])]
struct System {
    m: f64,
}

fn main() {
    let system = System { m: 1.0 };
    let state = State::at_rest([0.0; 8]);
    let [swept, top] = [system.swept(&state), system.top(&state)];
    println!("{}", system.place(&state)[2] + swept[0] * top.norm() + swept.dot(&top));
    println!("{}", system.arms(&state)[1] + system.pair(&state)[1] + system.single(&state));
    println!("{}", 2.0 * system.height(&state));
    println!("{}", system.missing(&state)[2] + system.rates(&state)[1]);
}
