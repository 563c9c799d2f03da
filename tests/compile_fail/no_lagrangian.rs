use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
struct System {
    m: f64,
}

fn main() {
    let system = System { m: 1.0 };
    system.accelerations_unchecked(&State::at_rest([0.0]));
}
