//! Functions that the user supplies: potentials, fields, surfaces and prescribed motions, with all derivatives that
//! the equations ask of them. By hand, the functions themselves run on dual numbers.

use lagrange_core::{ConstraintKind, prelude::*};

use crate::by_hand::{ByHand, D, DualNum, checks, dot, square};
use lagrange_random::Random;

fn plus(a: [D; 3], b: [D; 3]) -> [D; 3] {
    std::array::from_fn(|i| a[i] + b[i])
}

/// −k/√(r² + 1), lopsided.
#[derive(Clone, Copy, Default)]
struct Plummer {
    k: f64,
}

impl Function<3, 1> for Plummer {
    fn eval<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 1] {
        let c = S::constant;
        [c(-self.k) / (x * x + c(2.0) * y * y + z * z * x.cos() + c(10.0)).sqrt()]
    }
}

/// A vector potential.
#[derive(Clone, Copy, Default)]
struct Twisted {
    b: f64,
}

impl Function<3, 3> for Twisted {
    fn eval<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 3] {
        let b = S::constant(self.b);
        [b * y * z, b * x.sin(), x * y * z.exp()]
    }
}

/// A prescribed motion.
#[derive(Clone, Copy, Default)]
struct Shaken {
    omega: f64,
}

impl Function<1, 3> for Shaken {
    fn eval<S: Scalar>(&self, [t]: [S; 1]) -> [S; 3] {
        let phase = S::constant(self.omega) * t;
        [phase.sin(), t * t * t, phase.cos() * t]
    }
}

impl Shaken {
    /// The derivative, which the attributes write as `der(…)`.
    fn rate(&self, t: D) -> [D; 3] {
        let phase = t * self.omega;
        [phase.cos() * self.omega, t.powi(2) * 3.0, phase.cos() - phase.sin() * t * self.omega]
    }
}

/// A charge in given fields, generic in one of them, seen from a shaken place.
#[derive(Default, Lagrangian)]
#[coordinates(r: [3])]
#[function(U(r) = potential)]
#[function(A(r): [3] = field)]
#[function(V(t): [3] = motion)]
#[define(v = r_dot + V(t))]
#[lagrangian(m/2*dot(v, v) + e*dot(r_dot, A(r)) - e*U(r + 2*V(t)) - U(r) - m*dot(r, der(V(t))))]
struct Charge<F: Function<3, 1>> {
    m: f64,
    e: f64,
    potential: F,
    field: Twisted,
    motion: Shaken,
}

impl ByHand<3, 0> for Charge<Plummer> {
    const AT_ORIGIN: bool = false;

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

    fn l(&self, t: D, r: &[D; 3], r_dot: &[D; 3]) -> D {
        let motion = self.motion.eval([t]);
        let v = plus(*r_dot, motion);
        let elsewhere = plus(*r, motion.map(|x| x * 2.0));
        dot(v, v) * (self.m / 2.0) + dot(*r_dot, self.field.eval(*r)) * self.e
            - self.potential.eval(elsewhere)[0] * self.e
            - self.potential.eval(*r)[0]
            - dot(*r, self.motion.rate(t)) * self.m
    }
}

/// A surface that moves.
#[derive(Clone, Copy, Default)]
struct Drum {
    a: f64,
}

impl Function<3, 1> for Drum {
    fn eval<S: Scalar>(&self, [x, y, t]: [S; 3]) -> [S; 1] {
        [S::constant(self.a) * (x * y).sin() * t.cos() + x * x * x * y * t]
    }
}

/// A particle on a surface z = f(x, y, t): the constraint is differentiated twice. The surface resists too.
#[derive(Default, Lagrangian)]
#[coordinates(x, y, z)]
#[function(f(x, y, t) = surface)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) - m*g*z + der(f(x, y, t))^2/7 - f(y, x_dot, x)/9)]
#[constraint(on: z = f(x, y, t))]
#[constraint(rolls: y_dot*f(x, x, t) = x_dot)]
struct Skater {
    m: f64,
    g: f64,
    surface: Drum,
}

impl ByHand<3, 2> for Skater {
    const KINDS: [ConstraintKind; 2] = [ConstraintKind::Holonomic, ConstraintKind::Velocity];
    const AT_ORIGIN: bool = false;

    fn random(random: &mut Random) -> Self {
        Self { m: random.positive(), g: random.positive(), surface: Drum { a: random.positive() } }
    }

    fn l(&self, t: D, &[x, y, z]: &[D; 3], v: &[D; 3]) -> D {
        let [vx, vy, _] = *v;
        // d/dt of sin(xy) cos t a + x³ y t by hand.
        let ripple = (x * y).cos() * t.cos() * (vx * y + x * vy) - (x * y).sin() * t.sin();
        let rate =
            ripple * self.surface.a + x.powi(2) * y * t * vx * 3.0 + x.powi(3) * t * vy + x.powi(3) * y;
        dot(*v, *v) * (self.m / 2.0) - z * (self.m * self.g) + rate.powi(2) / 7.0
            - self.surface.eval([y, vx, x])[0] / 9.0
    }

    fn constraints(&self, t: D, &[x, y, z]: &[D; 3], &[vx, vy, _]: &[D; 3]) -> [D; 2] {
        [z - self.surface.eval([x, y, t])[0], vy * self.surface.eval([x, x, t])[0] - vx]
    }
}

/// Lennard and Jones's, softened.
#[derive(Clone, Copy, Default)]
struct Pair {
    depth: f64,
}

impl Function<1, 1> for Pair {
    fn eval<S: Scalar>(&self, [s]: [S; 1]) -> [S; 1] {
        let c = S::constant;
        [c(self.depth) * (c(-1.0) * s).exp() - (c(1.0) + s).powf(c(-1.5))]
    }
}

/// Three particles with one law of interaction, and a rod between vectors.
#[derive(Default, Lagrangian)]
#[coordinates(a: [3], b: [3], c: [3])]
#[function(pair(s) = interaction)]
#[lagrangian(m/2*(dot(a_dot, a_dot) + dot(b_dot, b_dot) + dot(c_dot, c_dot))
    - pair(norm(a - b)) - pair(norm(b - c)) - pair(norm(c - a)))]
#[constraint(centre: a + b + c = 0)]
#[constraint(rod: norm(a - b) = l)]
struct Cluster {
    m: f64,
    l: f64,
    interaction: Pair,
}

impl ByHand<9, 4> for Cluster {
    const AT_ORIGIN: bool = false;

    fn random(random: &mut Random) -> Self {
        Self { m: random.positive(), l: random.positive(), interaction: Pair { depth: random.positive() } }
    }

    fn l(&self, _: D, q: &[D; 9], v: &[D; 9]) -> D {
        let pair = |i, j| self.interaction.eval([distance(q, i, j)])[0];
        square(v) * (self.m / 2.0) - pair(0, 1) - pair(1, 2) - pair(2, 0)
    }

    fn constraints(&self, _: D, q: &[D; 9], _: &[D; 9]) -> [D; 4] {
        let centre = |k: usize| q[k] + q[k + 3] + q[k + 6];
        [centre(0), centre(1), centre(2), distance(q, 0, 1) - self.l]
    }
}

fn distance(q: &[D; 9], i: usize, j: usize) -> D {
    (0..3).map(|k| (q[3 * i + k] - q[3 * j + k]).powi(2)).sum::<D>().sqrt()
}

checks! {
    potential_vector_potential_and_prescribed_motion: Charge<Plummer>;
    a_surface_of_two_coordinates_and_time: Skater, with check_jacobian;
    a_law_of_interaction_between_vectors: Cluster;
}
