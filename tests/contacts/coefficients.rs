//! Friction whose coefficient at rest is larger than that of sliding, against closed solutions.

use core::f64::consts::PI;

use lagrange_core::contact::{Contact, MoreauJean, Transition};
use lagrange_core::prelude::*;
use lagrange_random::{Random, cases};

/// A block on a belt that moves with the speed `belt`, and pulls it along against a spring.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - k/2 * x^2 - m*g*y)]
#[contact(floor: y >= 0, friction(static: mu, kinetic: nu): x_dot - belt)]
struct Carried {
    m: f64,
    k: f64,
    g: f64,
    mu: f64,
    nu: f64,
    belt: f64,
    floor: Contact,
}

impl Carried {
    /// Time of sliding of each period. It slides from x = μ m g/k with the velocity of the belt, as an oscillator about ν m g/k, until it
    /// has that velocity again.
    fn slides(&self) -> f64 {
        let rate = (self.k / self.m).sqrt();
        2.0 / rate * (PI - ((self.mu - self.nu) * self.g / (rate * self.belt)).atan())
    }

    /// Time of sticking: the belt takes it from 2 ν − μ to μ, in units of m g/k.
    fn sticks(&self) -> f64 {
        2.0 * (self.mu - self.nu) * self.m * self.g / (self.k * self.belt)
    }
}

fn random_block(random: &mut Random) -> Carried {
    let [m, k, belt] = [(); 3].map(|()| random.between(0.5, 2.0));
    let nu = random.between(0.1, 0.4);
    let mu = nu + random.between(0.02, 0.3);
    Carried { m, k, g: 9.81, mu, nu, belt, floor: Contact::Closed }
}

#[test]
fn a_block_on_a_belt_sticks_and_slips_with_its_period() {
    for seed in 0..cases([5, 20, 1000]) as u64 {
        let block = random_block(&mut Random(seed));
        let start = State::new([block.mu * block.m * block.g / block.k * 0.5, 0.0], [block.belt, 0.0]);
        let period = block.slides() + block.sticks();
        let motion = block.motion(start).by(Dop853::with_tolerance(1e-12)).with_contacts();
        let path = motion.to(4.0 * period).unwrap();
        let times = |wanted: fn(&Transition<f64>) -> bool| -> Vec<f64> {
            path.transitions().iter().filter(|of| wanted(of)).map(Transition::time).collect()
        };
        let slips = times(|of| matches!(of, Transition::Slips { .. }));
        let sticks = times(|of| matches!(of, Transition::Sticks { .. }));
        assert!(slips.len() >= 3, "seed {seed}: {:?}", path.transitions());
        for (slip, stick) in slips.iter().zip(&sticks) {
            assert!((stick - slip - block.slides()).abs() < 1e-9, "seed {seed}");
        }
        for (stick, slip) in sticks.iter().zip(&slips[1..]) {
            assert!((slip - stick - block.sticks()).abs() < 1e-9, "seed {seed}");
        }
    }
}

/// The extension after three periods, with an error of first order in the step.
#[test]
fn time_steps_stick_and_slip_with_both_coefficients() {
    let block = random_block(&mut Random(3));
    let end = block.slides() + block.sticks() / 2.0;
    let start = State::new([block.mu * block.m * block.g / block.k, 0.0], [block.belt, 0.0]);
    let expected = block.nu * block.m * block.g / block.k;
    let errors = [4e-3, 1e-3].map(|h| {
        let path = block.motion(start).by_time_stepping(MoreauJean::with_step(h)).to(end).unwrap();
        (path.end().state().q[0] - expected).abs()
    });
    assert!(errors[0] < 2e-2 && errors[1] < 5e-3, "{errors:?}");
}

/// A plate on four feet, pulled along the floor in a direction by a force that grows.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z, turn: [2])]
#[define(foot(i, j) = z + (2*i - 1)*a*turn[0] + (2*j - 1)*a*turn[1])]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2 + a^2*dot(turn_dot, turn_dot)) - m*g*z + pull*t*(c*x + s*y))]
#[contact(feet[i in 0..2, j in 0..2]: foot(i, j) >= 0, friction(kinetic: nu, static: mu): [x_dot, y_dot])]
struct Plate {
    m: f64,
    g: f64,
    a: f64,
    mu: f64,
    nu: f64,
    pull: f64,
    c: f64,
    s: f64,
    feet: [[Contact; 2]; 2],
}

/// All feet slip when the force is μ m g, and slide with ν m g.
#[test]
fn all_feet_of_a_plate_slip_together() {
    for seed in 0..cases([1, 3, 500]) as u64 {
        let mut random = Random(seed);
        let angle = random.between(0.0, 2.0 * PI);
        let (nu, m, pull) = (random.between(0.1, 0.5), random.between(0.5, 2.0), random.between(1.0, 5.0));
        let mu = nu + random.between(0.01, 0.3);
        let feet = [[Contact::Closed; 2]; 2];
        let plate = Plate { m, g: 9.81, a: 0.3, mu, nu, pull, c: angle.cos(), s: angle.sin(), feet };
        let slips = mu * m * 9.81 / pull;
        let motion = plate.motion(State::at_rest([0.0; 5])).by(Radau::default()).with_contacts();
        let path = motion.to(slips + 1.0).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        let mut of = path.transitions().iter();
        let first = of.find(|of| matches!(of, Transition::Slips { .. })).map(Transition::time);
        assert!((first.expect("it slips") - slips).abs() < 1e-9, "seed {seed}: {:?}", path.transitions());
        let speed = (mu - nu) * 9.81 + 0.5 * pull / m;
        let [x, y] = [path.end().state().v[0], path.end().state().v[1]];
        assert!(
            (x - speed * plate.c).abs() < 1e-7 && (y - speed * plate.s).abs() < 1e-7,
            "seed {seed}: {x} {y}"
        );
    }
}

/// A block that falls on the floor while it slides loses ν times what the floor stops.
#[test]
fn a_block_that_slides_has_the_coefficient_of_sliding_in_impacts() {
    let block = Carried { m: 1.0, k: 0.0, g: 0.0, mu: 0.5, nu: 0.2, belt: 0.0, floor: Contact::Open };
    let path = block.motion(State::new([0.0, 1.0], [3.0, -1.0])).with_contacts().to(1.5).unwrap();
    assert!((path.end().state().v[0] - (3.0 - 0.2)).abs() < 1e-14, "{:?}", path.end());
}

#[test]
fn a_coefficient_of_sliding_above_that_at_rest_is_named() {
    let block = Carried { m: 1.0, k: 1.0, g: 1.0, mu: 0.2, nu: 0.5, belt: 1.0, floor: Contact::Closed };
    let path = block.motion(State::new([0.0; 2], [1.0, 0.0])).with_contacts().to(1.0);
    let Err(error) = path else { panic!("a motion") };
    assert!(error.to_string().contains("floor_friction"), "{error}");
}

/// Two feet share what friction holds, and slide without any.
#[test]
fn friction_may_hold_where_none_slows() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y, theta)]
    #[define(foot[i in 0..2] = [x + (2*i - 1)*b*cos(theta), y + (2*i - 1)*b*sin(theta)])]
    #[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*b^2/6 * theta_dot^2 - m*g*y)]
    #[force(x: pull*t)]
    #[contact(feet[i in 0..2]: foot[i][1] >= 0, friction(static: mu, kinetic: 0*mu): der(foot[i])[0])]
    struct Sledge {
        m: f64,
        b: f64,
        g: f64,
        mu: f64,
        pull: f64,
        feet: [Contact; 2],
    }
    let sledge = Sledge { m: 1.0, b: 0.2, g: 10.0, mu: 0.3, pull: 1.5, feet: [Contact::Closed; 2] };
    let path = sledge.motion(State::at_rest([0.0; 3])).with_contacts().to(3.0).unwrap();
    let first = path.transitions().iter().find(|of| matches!(of, Transition::Slips { .. })).unwrap();
    assert!((first.time() - 2.0).abs() < 1e-9, "{:?}", path.transitions());
    assert!((path.end().state().v[0] - 0.75 * (9.0 - 4.0)).abs() < 1e-9, "{:?}", path.end());
}
