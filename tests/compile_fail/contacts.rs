use lagrange_core::contact::Contact;
use lagrange_core::prelude::*;

// Each contact has one mistake.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, r: [2])]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + dot(r_dot, r_dot)))]
#[contact(floor: y >= 0)]
#[contact(wall: x >= 0)]
#[contact(bump: r >= 0)]
#[contact(brake: x_dot >= 0)]
#[contact(legs[i in 0..3]: r[0] - i >= 0)]
#[contact(toes[i in 0..3]: r[1] - i >= 0)]
#[contact(rails[i in 0..2]: r[i] + 2 >= 0)]
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
    toes: Contact,
    rails: [Contact; 3],
}

// What is wrong above is not wrong here once more.
fn moves(system: &System) -> Result<State<f64, 4>, Error> {
    Ok(*system.motion(State::at_rest([1.0; 4])).with_contacts().to(1.0)?.end())
}

fn main() {
    let _ = moves;
}
