use lagrange_core::contact::Contact;
use lagrange_core::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(y)]
#[lagrangian(y_dot^2/2 - g*y)]
#[contact(floor: y >= 0)]
struct Ball {
    g: f64,
    floor: Contact,
}

fn main() {
    let ball = Ball { g: 9.81, floor: Contact::Open };
    let start = ball.phase_state(&State::at_rest([1.0]));
    // Contacts are decided by Lagrange's equations.
    let _ = ball.motion_in_momenta(start).with_contacts().to(1.0);
}
