use lagrange_core::contact::Contact;
use lagrange_core::prelude::*;

// Each contact has one mistake.
#[derive(Lagrangian)]
#[coordinates(x, y, r: [2])]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + dot(r_dot, r_dot)))]
#[contact(floor: y >= 0)]
#[contact(wall: x >= 0)]
#[contact(bump: r >= 0)]
#[contact(brake: x_dot >= 0)]
#[contact(legs[i in 0..3]: r[0] - i >= 0)]
#[contact(slab: y - 3 >= 0, restitution: f)]
#[constraint(grip: x = y, when: held)]
#[constraint(hook: x = 2*y, when: m)]
struct System {
    m: f64,
    wall: f64,
    bump: Contact,
    brake: Contact,
    slab: Contact,
    legs: [Contact; 2],
}

fn main() {}
