//! Functions that the user supplies: potentials, fields, surfaces and prescribed motions, with all derivatives that
//! the equations ask of them.

use lagrange_core::{ConstraintKind, prelude::*};

use crate::by_hand::{Number, WithDerivatives, check};
use lagrange_random::Random;

fn dot<D: Number>(a: [D; 3], b: [D; 3]) -> D {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross<D: Number>(a: [D; 3], b: [D; 3]) -> [D; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn plus<D: Number>(a: [D; 3], b: [D; 3]) -> [D; 3] {
    std::array::from_fn(|i| a[i] + b[i])
}

/// −k/√(r² + 1), lopsided.
#[derive(Clone, Copy)]
pub(crate) struct Plummer {
    k: f64,
}

impl Function<3, 1> for Plummer {
    fn eval<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 1] {
        let c = S::constant;
        [c(-self.k) / (x * x + c(2.0) * y * y + z * z * x.cos() + c(10.0)).sqrt()]
    }
}

impl Plummer {
    fn by_hand<D: Number>(&self, [x, y, z]: [D; 3]) -> D {
        (x.powi(2) + y.powi(2) * 2.0 + z.powi(2) * x.cos() + 10.0).sqrt().recip() * -self.k
    }
}

/// A vector potential.
#[derive(Clone, Copy)]
pub(crate) struct Twisted {
    b: f64,
}

impl Function<3, 3> for Twisted {
    fn eval<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 3] {
        let b = S::constant(self.b);
        [b * y * z, b * x.sin(), x * y * z.exp()]
    }
}

impl Twisted {
    fn by_hand<D: Number>(&self, [x, y, z]: [D; 3]) -> [D; 3] {
        [y * z * self.b, x.sin() * self.b, x * y * z.exp()]
    }
}

/// A prescribed motion.
#[derive(Clone, Copy)]
pub(crate) struct Shaken {
    omega: f64,
}

impl Function<1, 3> for Shaken {
    fn eval<S: Scalar>(&self, [t]: [S; 1]) -> [S; 3] {
        let phase = S::constant(self.omega) * t;
        [phase.sin(), t * t * t, phase.cos() * t]
    }
}

impl Shaken {
    fn by_hand<D: Number>(&self, t: D) -> [D; 3] {
        let phase = t * self.omega;
        [phase.sin(), t.powi(3), phase.cos() * t]
    }

    /// The derivative, which the attributes write as `der(…)`.
    fn rate<D: Number>(&self, t: D) -> [D; 3] {
        let phase = t * self.omega;
        [phase.cos() * self.omega, t.powi(2) * 3.0, phase.cos() - phase.sin() * t * self.omega]
    }
}

/// A charge in given fields, generic in one of them, seen from a shaken place.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[function(U(r) = potential)]
#[function(A(r): [3] = field)]
#[function(V(t): [3] = motion)]
#[define(v = r_dot + V(t))]
#[lagrangian(m/2*dot(v, v) + e*dot(r_dot, A(r)) - e*U(r + 2*V(t)) - U(r) - m*dot(r, der(V(t))))]
pub(crate) struct Charge<F: Function<3, 1>> {
    m: f64,
    e: f64,
    potential: F,
    field: Twisted,
    motion: Shaken,
}

impl WithDerivatives<3, 0> for Charge<Plummer> {
    fn random(random: &mut Random) -> Self {
        let mut positive = || random.positive();
        Self {
            m: positive(),
            e: positive(),
            potential: Plummer { k: positive() },
            field: Twisted { b: positive() },
            motion: Shaken { omega: positive() },
        }
    }

    fn l<D: Number>(&self, t: D, r: &[D; 3], r_dot: &[D; 3]) -> D {
        let motion = self.motion.by_hand(t);
        let v = plus(*r_dot, motion);
        let elsewhere = plus(*r, motion.map(|x| x * 2.0));
        dot(v, v) * (self.m / 2.0) + dot(*r_dot, self.field.by_hand(*r)) * self.e
            - self.potential.by_hand(elsewhere) * self.e
            - self.potential.by_hand(*r)
            - dot(*r, self.motion.rate(t)) * self.m
    }
}

#[test]
fn potential_vector_potential_and_prescribed_motion() {
    check::<Charge<Plummer>, _, _, _>();
}

/// Milton (8.44), and a term with dΩ/dt that is not among it.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[function(Omega(t): [3] = spin)]
#[function(A(t): [3] = acceleration)]
#[function(U(r) = potential)]
#[define(v = r_dot)]
#[define(W = Omega(t))]
#[lagrangian(m/2*dot(v, v) + m/2*dot(cross(W, r), cross(W, r)) + m*dot(v, cross(W, r)) - U(r) - m*dot(r, A(t))
    + c*dot(der(W), cross(r, v)))]
#[force(r: -c*cross(der(Omega(t)), r))]
pub(crate) struct Frame {
    m: f64,
    c: f64,
    spin: Shaken,
    acceleration: Shaken,
    potential: Plummer,
}

impl WithDerivatives<3, 0> for Frame {
    fn random(random: &mut Random) -> Self {
        let mut positive = || random.positive();
        Self {
            m: positive(),
            c: positive(),
            spin: Shaken { omega: positive() },
            acceleration: Shaken { omega: positive() },
            potential: Plummer { k: positive() },
        }
    }

    fn l<D: Number>(&self, t: D, r: &[D; 3], v: &[D; 3]) -> D {
        let turn = cross(self.spin.by_hand(t), *r);
        (dot(*v, *v) + dot(turn, turn)) * (self.m / 2.0) + dot(*v, turn) * self.m
            - self.potential.by_hand(*r)
            - dot(*r, self.acceleration.by_hand(t)) * self.m
            + dot(self.spin.rate(t), cross(*r, *v)) * self.c
    }

    fn forces(&self, t: f64, r: &[f64; 3], _: &[f64; 3]) -> [f64; 3] {
        cross(self.spin.rate(t), *r).map(|x| -self.c * x)
    }
}

#[test]
fn rotating_accelerating_frame() {
    check::<Frame, _, _, _>();
}

/// A surface that moves.
#[derive(Clone, Copy)]
pub(crate) struct Drum {
    a: f64,
}

impl Function<3, 1> for Drum {
    fn eval<S: Scalar>(&self, [x, y, t]: [S; 3]) -> [S; 1] {
        [S::constant(self.a) * (x * y).sin() * t.cos() + x * x * x * y * t]
    }
}

impl Drum {
    fn by_hand<D: Number>(&self, x: D, y: D, t: D) -> D {
        (x * y).sin() * t.cos() * self.a + x.powi(3) * y * t
    }
}

/// A particle on a surface z = f(x, y, t): the constraint is differentiated twice. The surface resists too.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[function(f(x, y, t) = surface)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) - m*g*z + der(f(x, y, t))^2/7 - f(y, x_dot, x)/9)]
#[constraint(on: z = f(x, y, t))]
#[constraint(rolls: y_dot*f(x, x, t) = x_dot)]
pub(crate) struct Skater {
    m: f64,
    g: f64,
    surface: Drum,
}

impl WithDerivatives<3, 2> for Skater {
    const KINDS: [ConstraintKind; 2] = [ConstraintKind::Holonomic, ConstraintKind::Velocity];

    fn random(random: &mut Random) -> Self {
        Self { m: random.positive(), g: random.positive(), surface: Drum { a: random.positive() } }
    }

    fn l<D: Number>(&self, t: D, &[x, y, z]: &[D; 3], v: &[D; 3]) -> D {
        let [vx, vy, _] = *v;
        // d/dt of sin(xy) cos t a + x³ y t by hand.
        let ripple = (x * y).cos() * t.cos() * (vx * y + x * vy) - (x * y).sin() * t.sin();
        let rate =
            ripple * self.surface.a + x.powi(2) * y * t * vx * 3.0 + x.powi(3) * t * vy + x.powi(3) * y;
        dot(*v, *v) * (self.m / 2.0) - z * (self.m * self.g) + rate.powi(2) / 7.0
            - self.surface.by_hand(y, vx, x) / 9.0
    }

    fn constraints<D: Number>(&self, t: D, &[x, y, z]: &[D; 3], &[vx, vy, _]: &[D; 3]) -> [D; 2] {
        [z - self.surface.by_hand(x, y, t), vy * self.surface.by_hand(x, x, t) - vx]
    }
}

#[test]
fn a_surface_of_two_coordinates_and_time() {
    check::<Skater, _, _, _>();
}

/// Lennard and Jones's, softened.
#[derive(Clone, Copy)]
pub(crate) struct Pair {
    depth: f64,
}

impl Function<1, 1> for Pair {
    fn eval<S: Scalar>(&self, [s]: [S; 1]) -> [S; 1] {
        let c = S::constant;
        [c(self.depth) * (c(-1.0) * s).exp() - (c(1.0) + s).powf(c(-1.5))]
    }
}

/// Three particles with one law of interaction, and a rod between vectors.
#[derive(Lagrangian)]
#[coordinates(a: [3], b: [3], c: [3])]
#[function(pair(s) = interaction)]
#[lagrangian(m/2*(dot(a_dot, a_dot) + dot(b_dot, b_dot) + dot(c_dot, c_dot))
    - pair(norm(a - b)) - pair(norm(b - c)) - pair(norm(c - a)))]
#[constraint(centre: a + b + c = 0)]
#[constraint(rod: norm(a - b) = l)]
pub(crate) struct Cluster {
    m: f64,
    l: f64,
    interaction: Pair,
}

impl WithDerivatives<9, 4> for Cluster {
    fn random(random: &mut Random) -> Self {
        Self { m: random.positive(), l: random.positive(), interaction: Pair { depth: random.positive() } }
    }

    fn l<D: Number>(&self, _: D, q: &[D; 9], v: &[D; 9]) -> D {
        let pair = |i, j| {
            let s = distance(q, i, j);
            (-s).exp() * self.interaction.depth - (s + 1.0).powf(-1.5)
        };
        v.iter().map(|v| v.powi(2)).sum::<D>() * (self.m / 2.0) - pair(0, 1) - pair(1, 2) - pair(2, 0)
    }

    fn constraints<D: Number>(&self, _: D, q: &[D; 9], _: &[D; 9]) -> [D; 4] {
        let centre = |k: usize| q[k] + q[k + 3] + q[k + 6];
        [centre(0), centre(1), centre(2), distance(q, 0, 1) - self.l]
    }
}

fn distance<D: Number>(q: &[D; 9], i: usize, j: usize) -> D {
    (0..3).map(|k| (q[3 * i + k] - q[3 * j + k]).powi(2)).sum::<D>().sqrt()
}

#[test]
fn a_law_of_interaction_between_vectors() {
    check::<Cluster, _, _, _>();
}
