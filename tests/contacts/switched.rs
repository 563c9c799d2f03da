//! Accelerations and multipliers of a system whose constraints are switched off, stick or slide in all combinations: Newton's equations
//! by inverse dynamics, the rows that hold, and the laws of friction, written by hand. Together they determine the solution.

use lagrange_core::contact::{Contact, Friction};
use lagrange_core::prelude::*;
use lagrange_random::{Random, rounds};

/// A body that turns freely, with two points on a floor, a third one at a rod, and a slider on it that a bolt holds.
#[derive(Clone, Debug, Lagrangian)]
#[coordinates(r: [3], q: [4], s)]
#[frame(body: translate(r), rotate(q))]
#[define(foot[i in 0..2] = position(body, [i, 0.3, -0.5 - 0.2*i]))]
#[define(end = position(body, [0.2, 0.4, 0.7]))]
#[lagrangian(kinetic(body, m, [0.1, 0, 0], [[a, 0, 0], [0, 2*a, 0.1*a], [0, 0.1*a, 3*a]])
    + m/3 * s_dot^2 + m/4 * s_dot*r_dot[0] - m*g*r[2])]
#[constraint(rod: norm(end)^2 = 4)]
#[constraint(bolt: s*r[0] = 0.1, when: bolted)]
#[contact(floor[i in 0..2]: foot[i][2] >= 0, friction(mu): der(foot[i])[0..2])]
#[contact(wall: 3 - s >= 0, friction(static: 2*mu, kinetic: mu): r_dot[1])]
#[friction(guide: s_dot - r_dot[0], sliding: pull)]
#[observable(slips = [der(foot[0])[0..2], der(foot[1])[0..2]])]
struct Model {
    m: f64,
    a: f64,
    g: f64,
    mu: f64,
    pull: f64,
    bolted: bool,
    floor: [Contact; 2],
    wall: Contact,
    guide: Friction,
}

fn random_model(random: &mut Random) -> (Model, State<f64, 8>) {
    let [mut q, v] = [(); 2].map(|()| random.vector::<8>());
    q[3..7].copy_from_slice(&random.quaternion());
    let [m, a, mu, pull] = [(); 4].map(|()| random.between(0.5, 2.0));
    let mut contact = || match random.below(4) {
        0 => Contact::Open,
        1 => Contact::Closed,
        2 => Contact::Slides(random.vector()),
        _ => Contact::Shares([Some(random.signed()), None]),
    };
    let (floor, wall) = ([contact(), contact()], contact());
    let guide = random.one_of(&[Friction::Sticks, Friction::Slides([1.0, 0.0])]);
    let bolted = random.once_in(2);
    (Model { m, a, g: 9.81, mu: 0.2 * mu, pull, bolted, floor, wall, guide }, State::new(q, v))
}

/// Along each velocity of a contact, what keeps it: `None` for its constraint, else the force as a multiple of the contact's.
fn parts(contact: Contact, velocities: &[f64], [limit, sliding]: [f64; 2]) -> Vec<Option<f64>> {
    let size = velocities.iter().map(|v| v * v).sum::<f64>().sqrt();
    let along = |direction: &[f64; 2]| velocities.iter().zip(direction).map(|(v, d)| v * d).sum::<f64>();
    let part = |k: usize| match contact {
        Contact::Open => Some(0.0),
        Contact::Closed => None,
        Contact::Slides(direction) if velocities.len() == 1 => Some(-sliding * direction[0]),
        Contact::Slides(direction) => Some(-sliding * velocities[k] / size * along(&direction).signum()),
        Contact::Shares(parts) => parts[k].map(|part| limit * part),
    };
    (0..velocities.len()).map(part).collect()
}

/// Each constraint with its name, and what keeps it: `None` for a row of F q̈ + γ = 0, else the constraint and the multiple of its
/// multiplier that its own one is, or a number that it is.
fn laws(model: &Model, state: &State<f64, 8>) -> Vec<(String, Option<(Option<String>, f64)>)> {
    let observed = model.slips(state);
    let mut laws = vec![("rod".to_owned(), None)];
    laws.push(("bolt".to_owned(), (!model.bolted).then_some((None, 0.0))));
    let contacts = [
        ("floor[0]".to_owned(), model.floor[0], vec![observed[(0, 0)], observed[(0, 1)]], [model.mu; 2]),
        ("floor[1]".to_owned(), model.floor[1], vec![observed[(1, 0)], observed[(1, 1)]], [model.mu; 2]),
        ("wall".to_owned(), model.wall, vec![state.v[1]], [2.0 * model.mu, model.mu]),
    ];
    for (name, contact, velocities, bounds) in contacts {
        laws.push((name.clone(), (contact == Contact::Open).then_some((None, 0.0))));
        for (k, part) in parts(contact, &velocities, bounds).into_iter().enumerate() {
            let component = if velocities.len() == 2 { format!("[{k}]") } else { String::new() };
            let friction =
                name.replace("floor", "floor_friction").replace("wall", "wall_friction") + &component;
            laws.push((friction, part.map(|part| (Some(name.clone()), part))));
        }
    }
    laws.push(("guide".to_owned(), (model.guide != Friction::Sticks).then_some((None, -model.pull))));
    laws
}

#[test]
fn accelerations_satisfy_newton_and_the_laws() {
    let (mut good, mut all) = (0, 0);
    rounds("combinations of constraints", [300, 3_000, 30_000], |random| {
        let (model, state) = random_model(random);
        let solution = model.accelerations_unchecked(&state);
        all += 1;
        if solution.pivot.is_nan() || solution.pivot < 1e-3 {
            return;
        }
        good += 1;
        let (a, lambda) = (solution.accelerations, solution.multipliers);
        // Where all hold, no force of friction is in h, and no row is off.
        let held = Model {
            bolted: true,
            floor: [Contact::Closed; 2],
            wall: Contact::Closed,
            guide: Friction::Sticks,
            ..model.clone()
        };
        let (f, gamma) = (held.constraint_jacobian(&state), held.constraint_bias(&state));
        let size = 1.0 + a.amax() + lambda.amax();
        let newton = held.mass_matrix(&state) * a - held.forcing(&state) - f.transpose() * lambda;
        assert!(newton.amax() < 1e-9 * size, "{newton} {model:?} {state:?}");
        let kept = f * a + gamma;
        let index = |name: &str| Model::CONSTRAINTS.iter().position(|found| *found == name).expect("a name");
        for (name, law) in laws(&model, &state) {
            let row = index(&name);
            let off = match law {
                None => kept[row],
                Some((of, part)) => lambda[row] - part * of.map_or(1.0, |of| lambda[index(&of)]),
            };
            assert!(off.abs() < 1e-9 * size, "{name}: {off} {model:?} {state:?}");
        }
    });
    assert!(2 * good > all, "{good} of {all}");
}

/// Three rows, of which two nearly depend on each other, and one that is switched off.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 + x - 2*y + z/3)]
#[constraint(a: s*(x + y + z) = 0)]
#[constraint(b: x - y + 2*z = 0)]
#[constraint(c: x - y + 2*z + k*x = 0)]
#[constraint(d: x = y, when: on)]
struct Near {
    s: f64,
    k: f64,
    on: bool,
}

/// The elimination leaves it to the general solver, where the row that is off has no part, whatever the scales of the others.
#[test]
fn a_row_that_is_off_leaves_the_forces_of_the_others_alone() {
    for s in [1.0, 1e-8, 1e-14, 1e-20] {
        let (near, state) = (Near { s, k: 1e-4, on: false }, State::at_rest([0.0; 3]));
        assert!(near.accelerations_unchecked(&state).pivot < 1e-5);
        let solution = near.solve(&state).unwrap();
        assert!(solution.multipliers_are_unique(), "{s}");
        let (a, lambda) = (solution.accelerations, solution.multipliers);
        let newton = near.inverse_dynamics(&state, &a, &lambda);
        assert!(newton.amax() < 1e-9 && a.amax() < 1e-9, "{s}: {newton} {a}");
        // x + y + z, x − y + 2 z and x carry (1, −2, 1/3).
        assert!((s * lambda[0] - 11.0 / 9.0).abs() < 1e-9, "{s}: {lambda}");
    }
}

/// Friction that slides on two walls at an angle.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 - x - 3/10*y + z/5)]
#[contact(one: x >= 0, friction(mu): z_dot)]
#[contact(two: 3/5*x + 4/5*y >= 0, friction(mu): a*x_dot + b*z_dot)]
struct Slides {
    a: f64,
    b: f64,
    mu: f64,
    one: Contact,
    two: Contact,
}

/// Terms of friction that all but cancel cost digits: where more than a third is lost, there is no solution.
#[test]
fn friction_that_cancels_is_found_unreliable() {
    let a = 0.37_f64;
    let slides = Contact::Slides([-1.0, 0.0]);
    for mu in [0.1, 1.0, 1e2, 1e4, 1e6, 1e8, 1e12] {
        let system = Slides { a, b: (1.0 - a * a).sqrt(), mu, one: slides, two: slides };
        let found = system.solve(&State::at_rest([0.0; 3]));
        let is_right = |found: &lagrange_core::SolutionOf<Slides>| {
            let two = Slides::CONSTRAINTS.iter().position(|name| *name == "two").unwrap();
            (found.multipliers[two] - 0.375).abs() < 1e-9
        };
        assert!(found.as_ref().map_or(mu > 1e5, is_right), "{mu}: {found:?}");
    }
}
