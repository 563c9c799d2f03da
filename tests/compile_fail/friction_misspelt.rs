use lagrange_core::contact::{Contact, Friction};
use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[contact(floor: y >= 0, friction: x_dot)]
#[contact(wall: x >= 0, friction(mu) = y_dot)]
#[contact(lid: 1 - y >= 0, friction(mu): x_dot, friction(mu): x_dot)]
#[contact(ledge: y - 2 >= 0, friction(mu, limit: 2*mu): x_dot)]
#[friction(belt: x_dot, limit: mu)]
#[friction(brake: x_dot, mu)]
#[friction(joint: y_dot, sliding: mu, sliding: 2*mu)]
struct Words {
    m: f64,
    mu: f64,
    floor: Contact,
    wall: Contact,
    lid: Contact,
    ledge: Contact,
    belt: Friction,
    brake: Friction,
    joint: Friction,
}

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[contact(floor: y >= 0, friction(mu): x_dot)]
#[constraint(floor_friction: x_dot = 1)]
struct Clash {
    m: f64,
    mu: f64,
    floor: Contact,
}

fn main() {}
