//! A ball that rolls on a plane, V − a Ω×n = 0 (Milton 8.4), its orientation a unit quaternion: on a floor, on a
//! tilted plane and on a turntable.
//!
//! With the contact force f: m V̇ = m g + f and I Ω̇ = −a n×f; where the plane turns at the rate w about n,
//! V − a Ω×n = w n×r. Eliminating f and Ω, V̇ = κ w n×V + (1 − κ) g_∥ with κ = I/(I + m a²), which is 2/7 for a
//! solid ball.

use lagrange_core::nalgebra::{Quaternion, UnitQuaternion, Vector3};
use lagrange_core::prelude::*;

use lagrange_random::{Random, cases};
use lagrange_systems::random_state;

use crate::largest;

#[derive(Lagrangian, Clone)]
#[coordinates(r: [3], q: [4])]
#[define(spin = quat_rate(q, q_dot))]
#[lagrangian(m/2*dot(r_dot, r_dot) + inertia/2*dot(spin, spin) + m*dot(g, r))]
#[constraint(no_slip: r_dot - a*cross(spin, n) = turn*cross(n, r))]
#[constraint(unit: (dot(q, q) - 1)/2 = 0)]
#[observable(angular_velocity = spin)]
pub(crate) struct Ball {
    pub(crate) m: f64,
    pub(crate) a: f64,
    pub(crate) inertia: f64,
    pub(crate) g: Vector3<f64>,
    pub(crate) n: Vector3<f64>,
    pub(crate) turn: f64,
}

impl Ball {
    /// At `r`, with the velocity `v`, the spin `about_normal` and the orientation `q`.
    pub(crate) fn rolling(
        &self,
        r: Vector3<f64>,
        v: Vector3<f64>,
        about_normal: f64,
        q: UnitQuaternion<f64>,
    ) -> State<f64, 7> {
        let across = v - self.turn * self.n.cross(&r);
        let omega = self.n.cross(&across) / self.a + about_normal * self.n;
        let rate = Quaternion::from_imag(omega) * q.into_inner() * 0.5;
        let [q, rate] = [q.into_inner(), rate].map(|q| [q.w, q.i, q.j, q.k]);
        let joined = |r: Vector3<f64>, q: [f64; 4]| [r[0], r[1], r[2], q[0], q[1], q[2], q[3]];
        State::new(joined(r, q), joined(v, rate))
    }

    /// κ = I/(I + m a²).
    fn kappa(&self) -> f64 {
        self.inertia / (self.inertia + self.m * self.a * self.a)
    }

    fn gravity_along(&self) -> Vector3<f64> {
        self.g - self.n * self.n.dot(&self.g)
    }

    /// V̇.
    fn acceleration(&self, v: Vector3<f64>) -> Vector3<f64> {
        let kappa = self.kappa();
        kappa * self.turn * self.n.cross(&v) + (1.0 - kappa) * self.gravity_along()
    }

    /// Position and velocity at `t`: uniform acceleration, or on a turntable a circle about a centre that drifts
    /// across the slope.
    fn exact(&self, r: Vector3<f64>, v: Vector3<f64>, t: f64) -> [Vector3<f64>; 2] {
        let slope = (1.0 - self.kappa()) * self.gravity_along();
        let rate = self.kappa() * self.turn;
        if rate == 0.0 {
            return [r + v * t + slope * t * t / 2.0, v + slope * t];
        }
        let drift = self.n.cross(&slope) / rate;
        let (u, (sine, cosine)) = (v - drift, (rate * t).sin_cos());
        let normal_u = self.n.cross(&u);
        let place = r + drift * t + (u * sine + normal_u * (1.0 - cosine)) / rate;
        [place, drift + u * cosine + normal_u * sine]
    }

    pub(crate) fn place(state: &State<f64, 7>) -> [Vector3<f64>; 2] {
        [state.q.fixed_rows::<3>(0).into(), state.v.fixed_rows::<3>(0).into()]
    }

    pub(crate) fn orientation(state: &State<f64, 7>) -> UnitQuaternion<f64> {
        UnitQuaternion::from_quaternion(Quaternion::new(state.q[3], state.q[4], state.q[5], state.q[6]))
    }
}

fn unit(random: &mut Random) -> Vector3<f64> {
    Vector3::from(random.array(Random::signed)).normalize()
}

fn orientation(random: &mut Random) -> UnitQuaternion<f64> {
    let [w, x, y, z] = random.array(Random::signed);
    UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
}

fn ball(random: &mut Random) -> Ball {
    let [m, a, inertia, turn] = random.array(Random::positive);
    Ball { m, a, inertia, g: random.array(Random::signed).into(), n: unit(random), turn }
}

fn start(ball: &Ball, random: &mut Random) -> State<f64, 7> {
    let across = |x: Vector3<f64>| x - ball.n * ball.n.dot(&x);
    let r = across(random.array(Random::signed).into());
    let v = across(random.array(Random::signed).into());
    ball.rolling(r, v, random.signed(), orientation(random))
}

/// The residual is V − a Ω×n, less the velocity of the turntable, whatever the state; Ω = 2 q̇ q̄.
#[test]
fn the_constraint_links_v_and_omega_8_4() {
    let mut random = Random(1);
    for _ in 0..cases([200, 1000, 10_000]) {
        let ball = ball(&mut random);
        let state = random_state::<7>(&mut random);
        let q = |x: &lagrange_core::nalgebra::SVector<f64, 7>| Quaternion::new(x[3], x[4], x[5], x[6]);
        let omega = (q(&state.v) * q(&state.q).conjugate() * 2.0).imag();
        let [r, v] = Ball::place(&state);
        let slip = v - ball.a * omega.cross(&ball.n) - ball.turn * ball.n.cross(&r);
        let rate = ball.constraint_rate(&state);
        let deviation = (rate.fixed_rows::<3>(0) - slip).norm();
        assert!(deviation < 1e-12 * (1.0 + ball.a * omega.norm()), "{deviation:e}");
        assert!((ball.angular_velocity(&state) - omega).norm() < 1e-12 * (1.0 + omega.norm()));
    }
}

/// The multiplier of the rolling constraint is the contact force f = m (V̇ − g), normal part included. That of
/// |q|² = 1 is −2 I Ω²: the kinetic energy, with Ω = 2 q̇ q̄, is of second degree in |q|.
#[test]
fn acceleration_and_contact_force_at_random_states() {
    let mut random = Random(3);
    for _ in 0..cases([200, 1000, 10_000]) {
        let ball = ball(&mut random);
        let state = start(&ball, &mut random);
        let solution = ball.solve(&state).unwrap();
        assert!(solution.multipliers_are_unique());
        let exact = ball.acceleration(Ball::place(&state)[1]);
        let contact = ball.m * (exact - ball.g);
        let omega = ball.angular_velocity(&state);
        let scale = 1.0 + exact.norm() + contact.norm();
        assert!((solution.accelerations.fixed_rows::<3>(0) - exact).norm() < 1e-12 * scale);
        assert!((solution.multipliers.fixed_rows::<3>(0) - contact).norm() < 1e-12 * scale);
        let stretch = -2.0 * ball.inertia * omega.norm_squared();
        assert!((solution.multipliers[3] - stretch).abs() < 1e-12 * (scale + stretch.abs()));
    }
}

/// The quaternion's length has no inertia.
#[test]
fn the_mass_matrix_is_singular_without_the_constraint() {
    let mut random = Random(4);
    let ball = ball(&mut random);
    let state = start(&ball, &mut random);
    let mut radial = state.q;
    radial.fixed_rows_mut::<3>(0).fill(0.0);
    assert!((ball.mass_matrix(&state) * radial).norm() < 1e-14);
}

type Path<'a> = Trajectory<&'a Ball>;

fn motion(ball: &Ball, start: State<f64, 7>) -> Path<'_> {
    ball.integrate(start, cases([10, 50, 50]) as f64, Dop853::with_tolerance(1e-12)).unwrap()
}

/// The centre is where the closed form has it, the spin about the normal stays, and the constraints hold.
fn check_motion(ball: &Ball, path: &Path<'_>) {
    let [r, v] = Ball::place(path.start().state());
    let reach = largest(path.samples(501).map(|s| Ball::place(s.state())[0].norm()));
    let apart = largest(path.samples(501).flat_map(|s| {
        let (exact, found) = (ball.exact(r, v, s.time()), Ball::place(s.state()));
        [(exact[0] - found[0]).norm(), (exact[1] - found[1]).norm()]
    }));
    assert!(apart < 1e-8 * reach.max(1.0), "{apart:e} of {reach}");
    let about_normal = |s: &State<f64, 7>| ball.angular_velocity(s).dot(&ball.n);
    let begins = about_normal(path.start().state());
    let change = largest(path.samples(501).map(|s| (about_normal(s.state()) - begins).abs()));
    assert!(change < 1e-9 * (1.0 + begins.abs()), "{change:e}");
    let residual = largest(
        path.steps()
            .map(|s| ball.constraint_rate(s.state()).norm() + ball.constraint_residual(s.state()).norm()),
    );
    assert!(residual < 1e-12 * reach.max(1.0), "{residual:e}");
}

/// On a floor V and Ω stay what they were, so that the orientation is a uniform rotation.
#[test]
fn free_rolling_keeps_v_and_omega_8_4() {
    let mut random = Random(5);
    let (n, g) = (Vector3::z(), Vector3::new(0.0, 0.0, -9.81));
    let floor = Ball { m: 0.5, a: 0.1, inertia: 0.002, g, n, turn: 0.0 };
    let start = start(&floor, &mut random);
    let omega = floor.angular_velocity(&start);
    let path = motion(&floor, start);
    check_motion(&floor, &path);
    let apart = largest(path.samples(501).flat_map(|s| {
        let turned = UnitQuaternion::from_scaled_axis(omega * s.time()) * Ball::orientation(&start);
        let change = (floor.angular_velocity(s.state()) - omega).norm();
        [change / omega.norm(), turned.angle_to(&Ball::orientation(s.state()))]
    }));
    assert!(apart < 1e-8, "{apart:e}");
}

/// Any normal and any moment of inertia.
#[test]
fn tilted_turntables() {
    let mut random = Random(8);
    for _ in 0..cases([2, 3, 20]) {
        let ball = ball(&mut random);
        check_motion(&ball, &motion(&ball, start(&ball, &mut random)));
    }
}

/// dE/dt = −Σ λ_α b_α: the table works on the ball with the contact force times its own velocity, w n×r·f.
#[test]
fn the_turntable_does_work() {
    let mut random = Random(9);
    let ball = Ball { g: Vector3::new(0.2, -0.1, -1.0), ..ball(&mut random) };
    let start = start(&ball, &mut random);
    let path = ball.integrate(start, 10.0, Dop853::with_tolerance(1e-12)).unwrap();
    let simpson: f64 = path
        .samples(2001)
        .enumerate()
        .map(|(i, s)| {
            let weight = if i == 0 || i == 2000 { 1.0 } else { [2.0, 4.0][i % 2] };
            let force = s.solution().unwrap().multipliers.fixed_rows::<3>(0).into_owned();
            weight * force.dot(&(ball.turn * ball.n.cross(&Ball::place(s.state())[0])))
        })
        .sum();
    let (work, gained) = (simpson * 0.005 / 3.0, ball.energy(path.end().state()) - ball.energy(&start));
    assert!(gained.abs() > 0.1, "{gained}");
    assert!((work - gained).abs() < 1e-8 * (1.0 + gained.abs()), "{work} {gained}");
}
