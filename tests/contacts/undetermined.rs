//! Bodies at rest whose contacts share forces that no equation determines.

use lagrange_core::contact::Contact;
use lagrange_core::prelude::*;

/// A table with a leg at each corner, which stands on any three of them.
#[derive(Clone, Lagrangian)]
#[coordinates(z, a, b)]
#[lagrangian(m/2 * z_dot^2 + j/2 * (a_dot^2 + b_dot^2) - m*g*z)]
#[define(leg = [z + a + b, z + a - b, z - a + b, z - a - b])]
#[contact(legs[i in 0..4]: leg[i] >= 0)]
struct Table {
    m: f64,
    j: f64,
    g: f64,
    legs: [Contact; 4],
}

#[test]
fn tables_stand_on_their_legs() {
    let table = Table { m: 2.0, j: 0.3, g: 9.81, legs: [Contact::Open; 4] };
    // The second one rocks: a leg lifts off, and is back on the floor half-way through a step.
    let starts = [State::at_rest([0.5, 0.0, 0.0]), State::new([0.5, 0.1, 0.05], [0.0, 0.3, -0.2])];
    for start in starts {
        let path = table.motion(start).with_contacts().max_transitions(1_000).to(10.0).unwrap();
        assert!(path.end().state().q.amax() < 1e-14 && path.end().state().v.amax() < 1e-14, "{}", path.end());
        let forces = path.system().solve(path.end().state()).unwrap().multipliers;
        assert!((forces.sum() - 2.0 * 9.81).abs() < 1e-12 && forces.min() >= 0.0, "{forces}");
    }
}

/// Where all entries are zero from the start on, no one of them gives round-off a size.
#[test]
fn tables_stand_at_the_origin() {
    for j in [0.3, 1e-3] {
        let table = Table { m: 2.0, j, g: 9.81, legs: [Contact::Open; 4] };
        let start = State::at_rest([0.0; 3]);
        let path = table.motion(start).with_contacts().max_transitions(100).to(10.0).unwrap();
        assert!(path.end().state().q.amax() < 1e-20 && path.end().state().v.amax() < 1e-20, "{}", path.end());
        let forces = path.system().solve(path.end().state()).unwrap().multipliers;
        // A leg that takes no load has round-off of the others'.
        assert!((forces.sum() - 2.0 * 9.81).abs() < 1e-12 && forces.min() > -1e-13, "{forces}");
    }
}

/// A mass between two walls with friction, pulled by a force.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 + f[0]*x + f[1]*y)]
#[contact(wall[i in 0..2]: n[i][0]*x + n[i][1]*y >= 0, friction(mu[i]): n[i][1]*x_dot - n[i][0]*y_dot)]
struct Groove {
    f: [f64; 2],
    n: [[f64; 2]; 2],
    mu: [f64; 2],
    wall: [Contact; 2],
}

impl Groove {
    /// Whether forces of the walls balance the one that pulls: those at two edges of their cones of friction do, one of each wall.
    fn is_held(&self) -> bool {
        let edge = |wall: usize, side: f64| {
            let ([x, y], mu) = (self.n[wall], self.mu[wall]);
            [x + side * mu * y, y - side * mu * x]
        };
        let area = |[a, b]: [f64; 2], [c, d]: [f64; 2]| a * d - b * c;
        let sides = [-1.0, 1.0];
        sides.iter().any(|&first| {
            sides.iter().any(|&second| {
                let (one, other) = (edge(0, first), edge(1, second));
                let parts = [area(other, self.f), area(self.f, one)].map(|part| part / area(one, other));
                parts.iter().all(|&part| part > 1e-3)
            })
        })
    }
}

/// A mass at rest in a groove stays, held by forces that are not unique, where the walls lean by little from one another too. Where none
/// of those found can go on, the motion ends as undecided: 4 in 100 may.
#[test]
fn a_mass_in_a_groove_stays() {
    let angles = [0.0_f64, 1.0, 5.0, 20.0];
    let coefficients = [0.2, 0.5, 1.0];
    let (mut held, mut undecided) = (0, 0);
    for number in 0..4 * 4 * 3 * 3 * 4 {
        let digit = |place: usize, base: usize| number / place % base;
        let (lean, opening) = (angles[digit(1, 4)], angles[digit(4, 4)].max(0.01));
        let mu = [coefficients[digit(16, 3)], coefficients[digit(48, 3)]];
        let along = |degrees: f64| [degrees.to_radians().cos(), degrees.to_radians().sin()];
        let n = [along(lean + opening / 2.0), along(180.0 + lean - opening / 2.0)];
        let groove = Groove { f: along(-30.0 * digit(144, 4) as f64), n, mu, wall: [Contact::Open; 2] };
        if !groove.is_held() {
            continue;
        }
        let motion = groove.motion(State::at_rest([0.0; 2])).with_contacts();
        match motion.max_transitions(100).to(0.1) {
            Ok(path) => assert!(path.end().state().v.norm() < 1e-9, "{lean}, {opening}, {mu:?}"),
            Err(Error::FrictionUndecided { .. }) => undecided += 1,
            Err(error) => panic!("{lean}, {opening}, {mu:?}: {error}"),
        }
        held += 1;
    }
    assert!(held > 500 && 100 * undecided <= 4 * held, "{undecided} of {held} undecided");
}
