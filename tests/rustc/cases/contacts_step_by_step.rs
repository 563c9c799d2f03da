//! What motions that their caller takes step by step do not take.

use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(y)]
#[lagrangian(y_dot^2/2 - g*y)]
#[contact(floor: y >= 0)]
struct Stone {
    g: f64,
    floor: Contact,
}

fn main() -> Result<(), Error> {
    let (stone, start) = (Stone { g: 9.81, floor: Contact::Open }, State::at_rest([1.0]));
    let event = || stone.event("half", |sample| sample.state().q[0] - 0.5);
    let scheme = MoreauJean::with_step(1e-3);
    stone.motion(start).by_time_stepping(scheme).event(event()).stepper()?;
    stone.motion(start).every(0.1).by_time_stepping(scheme).stepper()?;
    stone.motion(start).event(event()).with_contacts().begin()?;
    Ok(())
}
