//! Bodies in space on rough floors: a ball against a closed solution, and boxes whose corners share forces of friction, by a check
//! of the laws at every stored state.

use lagrange_core::contact::{Contact, Transition};
use lagrange_core::nalgebra::{Quaternion, UnitQuaternion, Vector3};
use lagrange_core::{Ending, prelude::*};

use crate::{Congruence, Touch};

/// A billiard ball on a table: without side spin its friction keeps the direction in which the contact point slides, and it
/// rolls after 2 |u₀|/(7 μ g), with the velocity v₀ − 2/7 u₀ (Coriolis 1835; u₀ the velocity of the contact point).
#[derive(Clone, Lagrangian)]
#[coordinates(r: [3], q: [4])]
#[frame(ball: translate(r), rotate(q))]
#[define(omega = angular_velocity(ball))]
#[lagrangian(m/2 * dot(r_dot, r_dot) + m*a^2/5 * dot(omega, omega) - m*g*r[2])]
#[contact(table: r[2] - a >= 0, friction(mu): [r_dot[0] - a*omega[1], r_dot[1] + a*omega[0]])]
#[observable(spin = omega)]
struct Ball {
    m: f64,
    a: f64,
    g: f64,
    mu: f64,
    table: Contact,
}

#[test]
fn a_billiard_ball_slides_in_the_plane_and_then_rolls() {
    let ball = Ball { m: 0.17, a: 0.028, g: 9.8, mu: 0.2, table: Contact::Closed };
    for (velocity, spin) in
        [([1.0, 0.0], [0.0, 0.0]), ([1.0, 0.5], [20.0, 60.0]), ([0.0, 0.0], [-30.0, 10.0])]
    {
        // q̇ = ω q / 2 at q = 1.
        let start = State::new(
            [0.0, 0.0, 0.028, 1.0, 0.0, 0.0, 0.0],
            [velocity[0], velocity[1], 0.0, 0.0, spin[0] / 2.0, spin[1] / 2.0, 0.0],
        );
        let path = ball.motion(start).by(Dop853::with_tolerance(1e-12)).with_contacts().to(1.0).unwrap();
        let slip = [velocity[0] - 0.028 * spin[1], velocity[1] + 0.028 * spin[0]];
        let time = 2.0 / 7.0 * slip[0].hypot(slip[1]) / (0.2 * 9.8);
        let [Transition::Sticks { time: rolls, .. }] = path.transitions() else {
            panic!("{:?}", path.transitions())
        };
        assert!((rolls - time).abs() < 1e-11, "{rolls} for {time}");
        for (v, (v0, u0)) in path.end().state().v.iter().zip(velocity.iter().zip(slip)) {
            assert!((v - (v0 - 2.0 / 7.0 * u0)).abs() < 1e-11, "{:?}", path.end());
        }
    }
}

/// A box on a slope. The axis x points down along it, and z across it.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [3], q: [4])]
#[frame(body: translate(r), rotate(q))]
#[define(sx = [1, -1, 1, -1, 1, -1, 1, -1])]
#[define(sy = [1, 1, -1, -1, 1, 1, -1, -1])]
#[define(sz = [1, 1, 1, 1, -1, -1, -1, -1])]
#[define(corner(k) = [sx[k]*edges[0]/2, sy[k]*edges[1]/2, sz[k]*edges[2]/2])]
#[define(square = [edges[0]^2, edges[1]^2, edges[2]^2])]
#[define(about(i, j) = m/12*(square[i] + square[j]))]
#[define(inertia = [[about(1, 2), 0, 0], [0, about(2, 0), 0], [0, 0, about(0, 1)]])]
#[lagrangian(kinetic(body, m, [0, 0, 0], inertia) + m*g*(r[0]*sin(alpha) - r[2]*cos(alpha)))]
#[contact(floor[k in 0..8]: position(body, corner(k))[2] >= 0, restitution: e,
    friction(mu): express(velocity(body, corner(k)), fixed)[0..2])]
struct Brick {
    m: f64,
    g: f64,
    alpha: f64,
    e: f64,
    mu: f64,
    edges: [f64; 3],
    floor: [Contact; 8],
}

const BRICK: Brick =
    Brick { m: 2.0, g: 9.81, alpha: 0.0, e: 0.0, mu: 0.3, edges: [0.4, 0.3, 0.2], floor: [Contact::Open; 8] };

impl Brick {
    /// Height and velocity of each corner, by hand.
    fn corners(&self, state: &State<f64, 7>) -> [(f64, Vector3<f64>); 8] {
        let vector = |x: &[f64]| Vector3::new(x[0], x[1], x[2]);
        let quaternion = |x: &[f64]| Quaternion::new(x[0], x[1], x[2], x[3]);
        let (q, v) = (state.q.as_slice(), state.v.as_slice());
        let turned = UnitQuaternion::from_quaternion(quaternion(&q[3..]));
        // ω = 2 q̇ q⁻¹ in fixed axes.
        let omega = (quaternion(&v[3..]) * turned.conjugate().into_inner()).imag() * 2.0;
        std::array::from_fn(|k| {
            let side = |bit: usize| if k >> bit & 1 == 0 { 0.5 } else { -0.5 };
            let corner = turned
                * Vector3::new(side(0) * self.edges[0], side(1) * self.edges[1], side(2) * self.edges[2]);
            (q[2] + corner.z, vector(&v[..3]) + omega.cross(&corner))
        })
    }

    /// Gaps, forces, cones, the direction of friction and energy at every stored state.
    fn keeps_the_laws(&self, case: &str, path: &Trajectory<Self>) {
        let mut energy = f64::INFINITY;
        let steps = path.legs().iter().flat_map(|leg| {
            let last = leg.steps().count();
            leg.steps().enumerate().map(move |(number, step)| (number + 1 == last, leg.system(), step))
        });
        for (is_last, system, step) in steps {
            let (state, multipliers) = (step.state(), step.solution().unwrap().multipliers);
            let corners = self.corners(state);
            // At the end of a leg in which a corner stops, the direction of its velocity is the error of the method.
            let stops = |k: usize| {
                let speed = corners[k].1.x.hypot(corners[k].1.y);
                matches!(system.floor[k], Contact::Slides(_)) && speed < 1e-7
            };
            if is_last && (0..8).any(stops) {
                continue;
            }
            for (k, (gap, velocity)) in corners.into_iter().enumerate() {
                let drag = [multipliers[8 + 2 * k], multipliers[9 + 2 * k]];
                let touch = Touch { gap, press: multipliers[k], slip: [velocity.x, velocity.y], drag };
                touch.obeys_for_weight(
                    &format!("{case}, corner {k}, t = {}", state.t),
                    self.mu,
                    self.m * self.g,
                );
            }
            let now = self.energy(state);
            assert!(now < energy + 1e-8 * (1.0 + energy.abs()), "{case}: gains {:e}", now - energy);
            energy = energy.min(now);
        }
    }
}

/// Fails if one friction begins to stick or slide more than once at one instant.
fn changes_once(case: &str, path: &Trajectory<Brick>) {
    let mut last = std::collections::HashMap::new();
    for transition in path.transitions() {
        if let Transition::Sticks { friction, time } | Transition::Slips { friction, time } = transition {
            let before = last.insert(*friction, *time);
            let is_new = before.is_none_or(|before| time - before > 1e-12);
            assert!(is_new, "{case}: {friction} changes twice at {time}");
        }
    }
}

/// A box above a floor, at a random attitude and with random velocities.
fn dropped(case: usize, random: &mut Congruence) -> (Brick, State<f64, 7>) {
    let mut next = |low, high| random.between(low, high);
    let brick = Brick {
        e: [0.0, 0.3, 0.6][case % 3],
        mu: next(0.0, 0.6),
        edges: [next(0.1, 0.5), next(0.1, 0.5), next(0.1, 0.5)],
        ..BRICK
    };
    let q = Quaternion::new(next(-1.0, 1.0), next(-1.0, 1.0), next(-1.0, 1.0), next(-1.0, 1.0));
    let q = q.normalize();
    let spin = Vector3::new(next(-3.0, 3.0), next(-3.0, 3.0), next(-3.0, 3.0));
    let turns = Quaternion::from_imag(spin * 0.5) * q;
    let start = State::new(
        [0.0, 0.0, 0.6, q.w, q.i, q.j, q.k],
        [next(-1.0, 1.0), next(-1.0, 1.0), next(-1.0, 1.0), turns.w, turns.i, turns.j, turns.k],
    );
    (brick, start)
}

/// Friction that no forces are found for ends a motion by name.
#[test]
fn boxes_that_are_dropped() {
    let (mut random, mut complete) = (Congruence(9), 0);
    for case in 0..5 {
        let (brick, start) = dropped(case, &mut random);
        let motion = brick.motion(start).by(Radau::with_tolerance(1e-10)).with_contacts();
        let path = motion.max_transitions(2_000).towards(0.6).unwrap();
        match path.ending() {
            Ending::Complete { .. } => complete += 1,
            Ending::Unsolved { error: Error::FrictionUndecided { .. }, .. } => {}
            other => panic!("case {case}: {other}"),
        }
        brick.keeps_the_laws(&format!("case {case}"), &path);
        changes_once(&format!("case {case}"), &path);
    }
    assert!(complete >= 4, "{complete} of 5");
}

/// Boxes that lie on a slope, and are thrown along it, turned, or at rest.
#[test]
fn boxes_that_lie_on_a_slope() {
    let mut random = Congruence(4);
    for case in 0..40 {
        let mut next = |low, high| random.between(low, high);
        let (mu, alpha) = (next(0.1, 0.6), next(0.0, 0.5));
        let brick = Brick { mu, alpha, edges: [next(0.2, 0.5), next(0.2, 0.5), next(0.1, 0.2)], ..BRICK };
        let (s, c) = f64::sin_cos(next(0.0, 1.5) / 2.0);
        let spin = if case % 2 == 0 { 0.0 } else { next(-3.0, 3.0) };
        let speed = if case % 4 < 2 { 0.0 } else { next(0.0, 2.0) };
        let start = State::new(
            [0.0, 0.0, brick.edges[2] / 2.0, c, 0.0, 0.0, s],
            [speed, speed * next(-1.0, 1.0), 0.0, -spin / 2.0 * s, 0.0, 0.0, spin / 2.0 * c],
        );
        let path = brick.motion(start).by(Radau::with_tolerance(1e-10)).with_contacts().to(1.0).unwrap();
        brick.keeps_the_laws(&format!("case {case}"), &path);
        changes_once(&format!("case {case}"), &path);
        // Where this one begins to slide, a corner would pull by `Dop853`: the motion ends instead.
        if case == 8 {
            let motion = brick.motion(start).by(Dop853::with_tolerance(1e-10));
            brick.keeps_the_laws("by Dop853", &motion.with_contacts().towards(1.0).unwrap());
        }
        if case % 4 == 0 {
            let a = (9.81 * (alpha.sin() - mu * alpha.cos())).max(0.0);
            let v = path.end().state().v[0];
            assert!((v - a).abs() < 1e-9, "case {case}: {v} for {a}");
        }
    }
}
