use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(q: [N])]
#[lagrangian(m/2 * q_dot[0]^2)]
#[observable(speed = q_dot[0])]
struct Unread<const N: usize, const M: usize> {
    m: f64,
    tags: [[u8; N]; M],
}

#[derive(Lagrangian)]
#[coordinates(q: [2])]
#[lagrangian(m/2 * dot(q_dot, q_dot) - k*q[0])]
#[observable(speed = q_dot)]
struct System<T, const N: usize, const M: usize> {
    m: T,
    tags: [[u8; N]; M],
}

fn main() {
    let unread = Unread { m: 1.0, tags: [[0; 3]; 4] };
    let state = unread.at_rest([0.0; 3]);
    println!("{} {}", unread.energy(&state), unread.speed(&state));
    let system = System { m: 1.0_f32, tags: [[0; 3]; 4] };
    let state = State::at_rest([0.0; 2]);
    println!("{:?} {}", system.accelerations_unchecked(&state), system.speed(&state)[1]);
}
