//! Systems of each kind, with the start of a motion.

use lagrange_core::nalgebra::Const;
use lagrange_core::{Lagrangian, prelude::*};
pub(crate) use lagrange_systems::{
    ChaplyginSleigh, DoublePendulum, Planet, ShakenPendulum, SphericalPendulum, TwoBobs,
};

/// A system with the consistent state near this one.
pub(crate) fn on_constraints<L, const N: usize>(system: L, start: State<f64, N>) -> (L, State<f64, N>)
where
    L: Lagrangian<N = Const<N>, Scalar = f64>,
{
    let (start, _) = system.make_consistent(&start).unwrap();
    (system, start)
}

/// An ellipse of eccentricity 0.5, from its pericentre.
pub(crate) fn kepler() -> (Planet<f64>, State<f64, 2>) {
    (Planet { mu: 1.0 }, State::new([0.5, 0.0], [0.0, 3.0_f64.sqrt()]))
}

/// Hénon and Heiles's potential, with a number type that derivatives of motions need.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - (x^2 + y^2)/2 - c*(x^2*y - y^3/3))]
pub(crate) struct HenonHeiles<T> {
    c: T,
}

pub(crate) fn henon_heiles() -> (HenonHeiles<f64>, State<f64, 2>) {
    (HenonHeiles { c: 1.0 }, State::new([0.1, 0.1], [0.3, 0.2]))
}

/// From 60° above the lowest point, with the velocity 1.5 sin 60° along the horizontal.
pub(crate) fn spherical() -> (SphericalPendulum<f64>, State<f64, 3>) {
    let sine = 3.0_f64.sqrt() / 2.0;
    let system = SphericalPendulum { m: 1.0, g: 9.81, l: 1.0 };
    on_constraints(system, State::new([sine, 0.0, -0.5], [0.0, 1.5 * sine, 0.0]))
}

pub(crate) fn two_bobs() -> (TwoBobs<f64>, State<f64, 4>) {
    (TwoBobs { m: 1.0, g: 9.81 }, State::at_rest([0.6, -0.8, 1.6, -0.8]))
}

pub(crate) fn shaken() -> (ShakenPendulum<f64>, State<f64, 2>) {
    let system = ShakenPendulum { m: 1.0, g: 9.81, l: 1.0, a: 0.2, w: 2.0 };
    on_constraints(system, State::at_rest([0.6, -0.8]))
}

pub(crate) fn double_pendulum() -> (DoublePendulum<f64>, State<f64, 2>) {
    (DoublePendulum { m: [1.0; 2], l: [1.0; 2], g: 9.81 }, State::new([1.0, 0.5], [0.0, 0.3]))
}

/// A charge in a magnetic field that grows with x, and a spring.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 + b*(x + x^2/4)*y_dot - (x^2 + 2*y^2)/2)]
pub(crate) struct Charge<T> {
    b: T,
}

pub(crate) fn charge() -> (Charge<f64>, State<f64, 2>) {
    (Charge { b: 1.5 }, State::new([0.7, -0.2], [0.1, 0.6]))
}

/// A bead on a wire that turns at a changing rate, with a mass that depends on the place and friction.
#[derive(Clone, Lagrangian)]
#[coordinates(r)]
#[lagrangian((1 + 4*r^2)*r_dot^2/2 + (2 + sin(t))^2*r^2/2 - g*r^2)]
#[dissipation(c/2*r_dot^2)]
pub(crate) struct Bead<T> {
    g: T,
    c: T,
}

pub(crate) fn bead() -> (Bead<f64>, State<f64, 1>) {
    (Bead { g: 9.81, c: 0.3 }, State::new([0.5], [0.4]))
}

/// A bead on a parabola of revolution in a turning frame, in polar coordinates.
#[derive(Clone, Lagrangian)]
#[coordinates(r, phi, z)]
#[lagrangian((r_dot^2 + r^2*(phi_dot + omega)^2 + z_dot^2)/2 - g*z)]
#[constraint(bowl: z - r^2/2 = 0)]
pub(crate) struct Bowl<T> {
    omega: T,
    g: T,
}

pub(crate) fn bowl() -> (Bowl<f64>, State<f64, 3>) {
    (Bowl { omega: 0.7, g: 9.81 }, State::new([0.8, 0.0, 0.32], [0.5, 1.1, 0.4]))
}

/// The particle of Rosenberg: ż = y ẋ. With two springs: Cortés and Martínez, *Nonlinearity* 14, 2001.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 - k/2*(x^2 + y^2))]
#[constraint(turn: z_dot - y*x_dot = 0)]
pub(crate) struct Particle {
    pub(crate) k: f64,
}

pub(crate) fn particle() -> (Particle, State<f64, 3>) {
    (Particle { k: 0.0 }, State::new([0.0, 0.5, 0.0], [1.0, 0.7, 0.5]))
}

/// Its state at a time, without springs: ẋ √(1 + y²) is constant.
pub(crate) fn particle_at(t: f64) -> State<f64, 3> {
    let (_, start) = particle();
    let (from, rate) = (start.q[1], start.v[1]);
    let root = |y: f64| (1.0 + y * y).sqrt();
    let (y, ratio) = (from + rate * t, start.v[0] * root(from) / rate);
    let x_dot = ratio * rate / root(y);
    let q = [ratio * (y.asinh() - from.asinh()), y, ratio * (root(y) - root(from))];
    State::new(q, [x_dot, rate, y * x_dot]).at_time(t)
}

pub(crate) fn sleigh() -> (ChaplyginSleigh<f64>, State<f64, 3>) {
    (ChaplyginSleigh { m: 2.0, inertia: 0.3, a: 0.25 }, State::new([0.0, 0.0, 0.0], [1.0, 0.0, 1.5]))
}

/// A wheel that stands upright and rolls on an inclined plane, with a spring that steers it and a holonomic coupling.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta, phi, psi)]
#[lagrangian((x_dot^2 + y_dot^2)/2 + theta_dot^2/4 + phi_dot^2/4 + psi_dot^2/2 + g*x - theta^2 - psi^2)]
#[constraint(rolling_x: x_dot - phi_dot*cos(theta) = 0)]
#[constraint(rolling_y: y_dot - phi_dot*sin(theta) = 0)]
#[constraint(gear: psi - sin(theta)/2 = 0)]
pub(crate) struct Wheel<T> {
    g: T,
}

pub(crate) fn wheel() -> (Wheel<f64>, State<f64, 5>) {
    on_constraints(Wheel { g: 1.0 }, State::new([0.0, 0.0, 0.5, 0.0, 0.0], [0.0, 0.0, 0.3, 1.0, 0.0]))
}

/// A heavy top by a unit quaternion, whose length has no inertia.
#[derive(Clone, Lagrangian)]
#[coordinates(q: [4])]
#[frame(body: rotate(q))]
#[define(w = quat_rate_body(q, q_dot))]
#[lagrangian((a*(w[0]^2 + w[1]^2) + c*w[2]^2)/2 - mgl*position(body, [0, 0, 1])[2])]
pub(crate) struct Top<T> {
    a: T,
    c: T,
    mgl: T,
}

/// Leaning by 0.6, and turning about its axis.
pub(crate) fn top() -> (Top<f64>, State<f64, 4>) {
    let (sine, cosine) = 0.3_f64.sin_cos();
    let start = State::new([cosine, sine, 0.0, 0.0], [0.0, 0.2 * cosine, -2.0 * sine, 2.0 * cosine]);
    on_constraints(Top { a: 0.4, c: 0.25, mgl: 2.0 }, start)
}

/// A weight without inertia, at the place (x, y), on a wheel that a spring holds.
#[derive(Clone, Lagrangian)]
#[coordinates(phi, x, y)]
#[lagrangian(i/2*phi_dot^2 - k/2*phi^2 - w*y)]
#[constraint(across: x - sin(phi) = 0)]
#[constraint(along: y + cos(phi) = 0)]
pub(crate) struct Weight<T> {
    i: T,
    k: T,
    w: T,
}

pub(crate) fn weight() -> (Weight<f64>, State<f64, 3>) {
    on_constraints(Weight { i: 0.5, k: 1.0, w: 3.0 }, State::new([0.7, 0.0, 0.0], [0.4, 0.0, 0.0]))
}

/// A ball, by a quaternion, that rolls on a turntable, drawn to its centre by a spring.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [2], q: [4])]
#[define(w = quat_rate(q, q_dot))]
#[lagrangian(m/2*dot(r_dot, r_dot) + j/2*dot(w, w) - k/2*dot(r, r))]
#[constraint(rolling_x: r_dot[0] - a*w[1] = -spin*r[1])]
#[constraint(rolling_y: r_dot[1] + a*w[0] = spin*r[0])]
#[constraint(unit: dot(q, q) = 1)]
pub(crate) struct Ball<T> {
    m: T,
    j: T,
    a: T,
    k: T,
    spin: T,
}

pub(crate) fn ball() -> (Ball<f64>, State<f64, 6>) {
    let start = State::new([0.5, 0.0, 0.8, 0.0, 0.6, 0.0], [0.1, 0.7, 0.3, 0.5, -0.4, 0.2]);
    on_constraints(Ball { m: 1.0, j: 0.1, a: 0.5, k: 2.0, spin: 0.8 }, start)
}

/// The motion by an independent method, to about 10⁻¹³.
pub(crate) fn reference<L, const N: usize>((system, start): &(L, State<f64, N>), end: f64) -> State<f64, N>
where
    L: Lagrangian<N = Const<N>, Scalar = f64>,
{
    *system.integrate(*start, end, Dop853::with_tolerance(1e-14)).unwrap().end().state()
}

/// Largest error of an entry of the state.
pub(crate) fn error<const N: usize>(state: &State<f64, N>, exact: &State<f64, N>) -> f64 {
    (state.q - exact.q).amax().max((state.v - exact.v).amax())
}
