use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[contact(floor: y >= 0)]
#[contact(slab: y - 3 >= 0, restitution: f)]
struct System {
    m: f64,
    slab: Contact,
}

fn moves(system: &System) -> Result<State<f64, 2>, Error> {
    Ok(*system.motion(State::at_rest([1.0; 2])).with_contacts().to(1.0)?.end().state())
}

fn steps(system: &System) -> Result<State<f64, 2>, Error> {
    let motion = system.motion(State::at_rest([1.0; 2])).by_time_stepping(MoreauJean::with_step(1e-3));
    Ok(*motion.to(1.0)?.end().state())
}

fn main() {
    let _ = (moves, steps);
}
