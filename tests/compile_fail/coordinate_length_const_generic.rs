use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(q: [N])]
#[lagrangian(dot(q_dot, q_dot)/2 - k*dot(q, q)/2)]
#[observable(speed = norm(q_dot))]
struct Springs<const N: usize> {
    k: f64,
    lengths: [f64; N],
}

fn main() {
    let springs = Springs { k: 1.0, lengths: [1.0; 3] };
    let state = State::at_rest([0.0; 3]);
    let _ = springs.solve(&state);
    let _: f64 = springs.speed(&state);
}
