use lagrange_core::contact::{Contact, Friction};
use lagrange_core::prelude::*;

// What is read of each friction has one mistake.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, r: [3])]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + dot(r_dot, r_dot)))]
#[contact(floor: y >= 0, friction(mu): x)]
#[contact(wall: x >= 0, friction(mu): r_dot)]
#[contact(slope: x + y >= 0, friction(mu): x_dot^2)]
#[contact(roof: 1 - y >= 0, friction([mu, mu]): x_dot)]
#[friction(belt: x_dot - 1, sliding: mu)]
#[friction(joint: y_dot, sliding: mu)]
#[friction(pair[i in 0..2]: r_dot[i], sliding: mu)]
struct System {
    m: f64,
    mu: f64,
    floor: Contact,
    wall: Contact,
    slope: Contact,
    roof: Contact,
    joint: Contact,
    pair: [Friction; 2],
}

fn main() {}
