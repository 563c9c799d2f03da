//! Rods that are thrown at a floor and a wall: at every stored state no gap is negative, no multiplier pulls, no force acts
//! across a gap, and no energy is gained.

use lagrange_core::contact::{Contact, ContactTrajectory, Transition};
use lagrange_core::{Ending, prelude::*};
use lagrange_random::cases;

/// A rod whose two ends may touch a floor and a wall.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2 - m*g*y)]
#[define(end(s) = [x + s*a*cos(theta), y + s*a*sin(theta)])]
#[contact(floor[i in 0..2]: end(2*i - 1)[1] >= 0, restitution: e)]
#[contact(wall[i in 0..2]: end(2*i - 1)[0] >= 0, restitution: e)]
struct Rod {
    m: f64,
    a: f64,
    g: f64,
    e: f64,
    floor: [Contact; 2],
    wall: [Contact; 2],
}

impl Rod {
    /// Gaps of both ends to the floor and to the wall, by hand.
    fn gaps(&self, state: &State<f64, 3>) -> [f64; 4] {
        let [x, y, theta] = [0, 1, 2].map(|i| state.q[i]);
        let (s, c) = theta.sin_cos();
        [y - self.a * s, y + self.a * s, x - self.a * c, x + self.a * c]
    }
}

/// The rod on a rough floor, at a rough wall.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2 - m*g*y)]
#[define(end(s) = [x + s*a*cos(theta), y + s*a*sin(theta)])]
#[contact(floor[i in 0..2]: end(2*i - 1)[1] >= 0, restitution: e, friction(mu): der(end(2*i - 1))[0])]
#[contact(wall[i in 0..2]: end(2*i - 1)[0] >= 0, restitution: e, friction(mu): der(end(2*i - 1))[1])]
struct RoughRod {
    m: f64,
    a: f64,
    g: f64,
    e: f64,
    mu: f64,
    floor: [Contact; 2],
    wall: [Contact; 2],
}

impl RoughRod {
    /// Gaps of both ends to the floor and to the wall, and how fast they slide, by hand.
    fn ends(&self, state: &State<f64, 3>) -> [[f64; 2]; 4] {
        let [[x, y, theta], [vx, vy, omega]] = [&state.q, &state.v].map(|all| [all[0], all[1], all[2]]);
        let (s, c) = theta.sin_cos();
        let end = |side: f64| {
            let (rx, ry) = (side * self.a * c, side * self.a * s);
            [x + rx, y + ry, vx - ry * omega, vy + rx * omega]
        };
        let [[x0, y0, vx0, vy0], [x1, y1, vx1, vy1]] = [end(-1.0), end(1.0)];
        [[y0, vx0], [y1, vx1], [x0, vy0], [x1, vy1]]
    }
}

/// Gaps, forces, cones, the direction of friction and energy at every stored state.
fn keeps_the_laws(case: &str, rod: &RoughRod, path: &ContactTrajectory<RoughRod>) {
    let mut energy = f64::INFINITY;
    for leg in path.legs() {
        for step in leg.steps() {
            let (state, multipliers) = (step.state(), step.solution().unwrap().multipliers);
            let scale = 1.0 + state.q.amax();
            for (k, [gap, slides]) in rod.ends(state).into_iter().enumerate() {
                // The friction of each family follows its gaps.
                let row = k + 2 * (k / 2);
                let (press, drag) = (multipliers[row], multipliers[row + 2]);
                let at = format!(
                    "{case}, end {k}, t = {}: press {press}, drag {drag}, slides {slides:e}",
                    state.t
                );
                assert!(gap > -1e-11 * scale, "{at}: gap {gap:e}");
                assert!(press > -1e-6, "{at}: pulls");
                assert!(press * gap < 1e-9, "{at}: acts at {gap:e}");
                assert!(drag.abs() <= rod.mu * press + 1e-6 * (1.0 + press.abs()), "{at}: leaves the cone");
                // The most dissipation: what slides is dragged back with all that the cone allows.
                let most = rod.mu * press * slides.abs();
                assert!(-drag * slides > most - 1e-6 * (1.0 + most), "{at}: mu = {}", rod.mu);
            }
            let now = rod.energy(state);
            assert!(now < energy + 1e-8 * (1.0 + energy.abs()), "{case}: gains {:e}", now - energy);
            energy = energy.min(now);
        }
    }
}

/// Friction has a coefficient up to 0.4, at which a rod does not jam (Painlevé's rod needs 4/3).
#[test]
fn rods_on_a_rough_floor_and_a_rough_wall() {
    let (mut seed, mut endings) = (5, [0; 3]);
    for case in 0..cases([20, 60, 50_000]) {
        let mut next = |low, high| random(&mut seed, low, high);
        let (e, mu) = ([0.0, 0.3, 0.7][case % 3], next(0.0, 0.4));
        let contacts = [Contact::Open; 2];
        let rod = RoughRod {
            m: next(0.3, 3.0),
            a: next(0.2, 1.0),
            g: 9.81,
            e,
            mu,
            floor: contacts,
            wall: contacts,
        };
        let start = State::new(
            [next(1.0, 2.0), next(1.0, 2.0), next(-3.0, 3.0)],
            [next(-4.0, 1.0), next(-3.0, 3.0), next(-4.0, 4.0)],
        );
        let motion = rod.motion(start).by(Dop853::with_tolerance(1e-10)).with_contacts();
        let path = motion.max_transitions(2_000).towards(5.0).unwrap();
        match path.ending() {
            Ending::Complete { .. } => endings[0] += 1,
            Ending::TransitionLimit { .. } => endings[1] += 1,
            other => panic!("case {case}: {other}, e = {e}, mu = {mu}, from {start}"),
        }
        endings[2] += path.transitions().len();
        keeps_the_laws(&format!("case {case}"), &rod, &path);
    }
    println!("{} complete, {} at the limit, {} transitions", endings[0], endings[1], endings[2]);
    assert_eq!(endings[1], 0);
}

/// The impact takes all but the round-off of the velocity along the floor, far more than that of the small velocities before.
#[test]
fn a_rod_that_an_impact_stops_sticks() {
    let contacts = [Contact::Open; 2];
    let (m, a, mu) = (0.8033676990236711, 0.48161542339978375, 0.3750315976255122);
    let rod = RoughRod { m, a, g: 9.81, e: 0.0, mu, floor: contacts, wall: contacts };
    let start = State::new(
        [1.8862606815864909, 1.1265187188411545, -1.2702572586958327],
        [-0.038581067987816464, -1.7000566774649812, 0.6573374740977638],
    );
    let path = rod.motion(start).by(Dop853::with_tolerance(1e-10)).with_contacts().to(0.2645).unwrap();
    keeps_the_laws("one rod", &rod, &path);
    assert_eq!(path.system().floor[1], Contact::Closed, "{:?}", path.transitions());
    // It sticks at once, and slides at no time between.
    assert!(
        matches!(path.transitions(), [Transition::Impact { .. }, Transition::Closes { .. }]),
        "{:?}",
        path.transitions()
    );
}

/// Upright in the corner, with both ends at the wall: as the first one closes there, its gap is projected from the 8e-13 that
/// the leg before has left, and the other gap, which was zero, is then −4e-13.
#[test]
fn a_rod_upright_in_a_corner_does_not_pass_through_the_wall() {
    let contacts = [Contact::Open; 2];
    let (m, a, mu) = (1.9994835585924453, 0.2435611433036546, 0.11690273073113389);
    let rod = RoughRod { m, a, g: 9.81, e: 0.0, mu, floor: contacts, wall: contacts };
    let start = State::new(
        [1.370274425656676, 1.478986441912105, 2.7430389474556405],
        [-3.224253093171211, -0.9212026224993606, -3.8807292414622685],
    );
    let path = rod.motion(start).by(Dop853::with_tolerance(1e-10)).with_contacts().to(5.0).unwrap();
    keeps_the_laws("one rod", &rod, &path);
}

/// A number between two others, by a linear congruence.
fn random(seed: &mut u64, low: f64, high: f64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    low + (high - low) * (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

#[test]
fn rods_on_a_floor_and_a_wall() {
    let (mut seed, mut endings) = (1, [0; 3]);
    for case in 0..cases([20, 60, 50_000]) {
        let mut next = |low, high| random(&mut seed, low, high);
        let e = [0.0, 0.3, 0.7, 1.0][case % 4];
        let contacts = [Contact::Open; 2];
        let rod = Rod { m: next(0.3, 3.0), a: next(0.2, 1.0), g: 9.81, e, floor: contacts, wall: contacts };
        let start = State::new(
            [next(1.0, 2.0), next(1.0, 2.0), next(-3.0, 3.0)],
            [next(-4.0, 1.0), next(-3.0, 3.0), next(-4.0, 4.0)],
        );
        let path = rod
            .motion(start)
            .by(Dop853::with_tolerance(1e-10))
            .with_contacts()
            .max_transitions(1_000)
            .towards(5.0)
            .unwrap();
        match path.ending() {
            Ending::Complete { .. } => endings[0] += 1,
            Ending::TransitionLimit { .. } => endings[1] += 1,
            other => panic!("case {case}: {other}, e = {e}, from {start}"),
        }
        endings[2] += path.transitions().len();
        let mut energy = rod.energy(&start);
        for leg in path.legs() {
            for step in leg.steps() {
                let (state, multipliers) = (step.state(), step.solution().unwrap().multipliers);
                for (k, gap) in rod.gaps(state).into_iter().enumerate() {
                    let scale = 1.0 + state.q.amax();
                    assert!(gap > -1e-11 * scale, "case {case}: gap {k} is {gap:e} at {}", state.t);
                    assert!(multipliers[k] > -1e-6, "case {case}: {k} pulls by {}", multipliers[k]);
                    assert!(multipliers[k] * gap < 1e-9, "case {case}: {k} acts at {gap:e}");
                }
                let now = rod.energy(state);
                assert!(now < energy + 1e-8 * (1.0 + energy.abs()), "case {case}: gains {:e}", now - energy);
                energy = energy.min(now);
            }
        }
    }
    println!("{} complete, {} at the limit, {} transitions", endings[0], endings[1], endings[2]);
    assert_eq!(endings[1], 0);
}
