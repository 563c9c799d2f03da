//! Rods that are thrown at a floor and a wall: at every stored state no gap is negative, no multiplier pulls, no force acts
//! across a gap, and no energy is gained.

use lagrange_core::contact::{Contact, Contacts, Transition};
use lagrange_core::nalgebra::Const;
use lagrange_core::{Ending, prelude::*};
use lagrange_random::cases;
use lagrange_systems::Rod;

use crate::{Congruence, Touch};

fn rod(m: f64, a: f64, e: f64, mu: f64) -> Rod {
    Rod { m, j: m * a * a / 3.0, a, g: 9.81, e, mu: [mu; 2], ..Rod::default() }
}

/// Gaps of both ends of a rod of the length 2a to the floor and to the wall, and how fast they slide, by hand.
fn ends(a: f64, state: &State<f64, 3>) -> [[f64; 2]; 4] {
    let [[x, y, theta], [vx, vy, omega]] = [&state.q, &state.v].map(|all| [all[0], all[1], all[2]]);
    let (s, c) = theta.sin_cos();
    let end = |side: f64| {
        let (rx, ry) = (side * a * c, side * a * s);
        [x + rx, y + ry, vx - ry * omega, vy + rx * omega]
    };
    let [[x0, y0, vx0, vy0], [x1, y1, vx1, vy1]] = [end(-1.0), end(1.0)];
    [[y0, vx0], [y1, vx1], [x0, vy0], [x1, vy1]]
}

/// Gaps, forces, cones, the direction of friction and energy at every stored state.
fn keeps_the_laws<L>(case: &str, [a, mu]: [f64; 2], path: &Trajectory<L>)
where
    L: Contacts<N = Const<3>, Scalar = f64> + Clone,
{
    let mut energy = f64::INFINITY;
    for step in path.legs().iter().flat_map(|leg| leg.steps()) {
        let (state, multipliers) = (step.state(), step.solution().unwrap().multipliers);
        let is_rough = multipliers.len() == 8;
        for (k, [gap, slip]) in ends(a, state).into_iter().enumerate() {
            // The friction of each family follows its gaps.
            let row = if is_rough { k + 2 * (k / 2) } else { k };
            let (press, drag) = (multipliers[row], if is_rough { multipliers[row + 2] } else { 0.0 });
            let touch = Touch { gap, press, slip: [slip, 0.0], drag: [drag, 0.0] };
            let bounds = [
                1e-11 * (1.0 + state.q.amax()),
                1e-6 * (1.0 + press.max(0.0)),
                1e-9,
                1e-6 * (1.0 + mu * press * slip.abs()),
            ];
            touch.obeys(&format!("{case}, end {k}, t = {}", state.t), mu, bounds);
        }
        let now = step.energy();
        assert!(now < energy + 1e-8 * (1.0 + energy.abs()), "{case}: gains {:e}", now - energy);
        energy = energy.min(now);
    }
}

/// Throws rods with these lengths and coefficients of friction.
fn thrown<L>(seed: u64, rod: impl Fn(usize, &mut Congruence) -> (L, [f64; 2]))
where
    L: Contacts<N = Const<3>, Scalar = f64> + Clone,
{
    let mut random = Congruence(seed);
    for case in 0..cases([12, 60, 50_000]) {
        let (rod, numbers) = rod(case, &mut random);
        let mut next = |low, high| random.between(low, high);
        let start = State::new(
            [next(1.0, 2.0), next(1.0, 2.0), next(-3.0, 3.0)],
            [next(-4.0, 1.0), next(-3.0, 3.0), next(-4.0, 4.0)],
        );
        let motion = rod.motion(start).by(Dop853::with_tolerance(1e-10)).with_contacts();
        let path = motion.max_transitions(1_000).towards(5.0).unwrap();
        let is_complete = matches!(path.ending(), Ending::Complete { .. });
        assert!(is_complete, "case {case}: {}, {numbers:?}, from {start}", path.ending());
        keeps_the_laws(&format!("case {case}"), numbers, &path);
    }
}

/// Friction has a coefficient up to 0.4, at which a rod does not jam (Painlevé's rod needs 4/3).
#[test]
fn rods_on_a_rough_floor_and_a_rough_wall() {
    thrown(5, |case, random| {
        let mu = random.between(0.0, 0.4);
        let (m, a) = (random.between(0.3, 3.0), random.between(0.2, 1.0));
        (rod(m, a, [0.0, 0.3, 0.7][case % 3], mu), [a, mu])
    });
}

/// The impact takes all but the round-off of the velocity along the floor, far more than that of the small velocities before.
#[test]
fn a_rod_that_an_impact_stops_sticks() {
    let (a, mu) = (0.48161542339978375, 0.3750315976255122);
    let rod = rod(0.8033676990236711, a, 0.0, mu);
    let start = State::new(
        [1.8862606815864909, 1.1265187188411545, -1.2702572586958327],
        [-0.038581067987816464, -1.7000566774649812, 0.6573374740977638],
    );
    let path = rod.motion(start).by(Dop853::with_tolerance(1e-10)).with_contacts().to(0.2645).unwrap();
    keeps_the_laws("one rod", [a, mu], &path);
    assert_eq!(path.system().floor[1], Contact::Closed, "{:?}", path.transitions());
    // It sticks at once, and slides at no time between.
    let sticks_at_once = matches!(path.transitions(), [Transition::Impact { .. }, Transition::Closes { .. }]);
    assert!(sticks_at_once, "{:?}", path.transitions());
}

/// Upright in the corner, with both ends at the wall: as the first one closes there, its gap is projected from the 8e-13 that
/// the leg before has left, and the other gap, which was zero, is then −4e-13.
#[test]
fn a_rod_upright_in_a_corner_does_not_pass_through_the_wall() {
    let (a, mu) = (0.2435611433036546, 0.11690273073113389);
    let start = State::new(
        [1.370274425656676, 1.478986441912105, 2.7430389474556405],
        [-3.224253093171211, -0.9212026224993606, -3.8807292414622685],
    );
    let rod = rod(1.9994835585924453, a, 0.0, mu);
    let path = rod.motion(start).by(Dop853::with_tolerance(1e-10)).with_contacts().to(5.0).unwrap();
    keeps_the_laws("one rod", [a, mu], &path);
}

/// It comes to lie flat in the corner with velocities of exactly zero: forces along the floor are then 10⁻⁸⁸, and the rates that
/// these leave are round-off of the weight.
#[test]
fn a_rod_that_lies_flat_in_a_corner_stays_there() {
    let (a, mu) = (0.2215330993788233, 0.17870428336992394);
    let start = State::new(
        [1.8544771783021021, 1.0722803866826145, -0.9465776592162465],
        [-2.4112717863960103, -0.8256845124840115, 1.5647778112487964],
    );
    let rod = rod(2.0733299485488756, a, 0.0, mu);
    let path = rod.motion(start).by(Dop853::with_tolerance(1e-10)).with_contacts().to(5.0).unwrap();
    keeps_the_laws("one rod", [a, mu], &path);
    assert!(path.end().state().v.amax() < 1e-12, "{}", path.end().state());
}

#[cfg(feature = "thorough")]
#[test]
fn rods_on_a_smooth_floor_and_a_smooth_wall() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y, theta)]
    #[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2 - m*g*y)]
    #[define(end(s) = [x + s*a*cos(theta), y + s*a*sin(theta)])]
    #[contact(floor[i in 0..2]: end(2*i - 1)[1] >= 0, restitution: e)]
    #[contact(wall[i in 0..2]: end(2*i - 1)[0] >= 0, restitution: e)]
    struct Smooth {
        m: f64,
        a: f64,
        g: f64,
        e: f64,
        floor: [Contact; 2],
        wall: [Contact; 2],
    }
    thrown(1, |case, random| {
        let (m, a) = (random.between(0.3, 3.0), random.between(0.2, 1.0));
        let [floor, wall] = [[Contact::Open; 2]; 2];
        (Smooth { m, a, g: 9.81, e: [0.0, 0.3, 0.7, 1.0][case % 4], floor, wall }, [a, 0.0])
    });
}
