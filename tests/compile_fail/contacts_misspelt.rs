use lagrange_core::contact::Contact;
use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[contact(stop: x = 0)]
#[contact(lid: y <= 1)]
#[contact(plate: y - 2 >= 0, bounce: 1)]
#[contact(slab: y - 3 >= 0, restitution: e, restitution: e)]
#[contact(y - 4 >= 0)]
#[contact(shelf: y - 5 >= 0, restitution(stronge): e)]
#[constraint(pin: x = 3*y, when held)]
struct System {
    m: f64,
    e: f64,
    stop: Contact,
    lid: Contact,
    plate: Contact,
    slab: Contact,
    shelf: Contact,
}

fn main() {}
