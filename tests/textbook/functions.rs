//! The potential and the motion of the frames.

use lagrange_core::nalgebra::{Matrix3, Rotation3, Vector3};
use lagrange_core::prelude::*;
use lagrange_random::Random;

/// U = k √(1 + x² + 2y² + 3z²): anisotropic, and no polynomial.
#[derive(Clone, Copy)]
pub(crate) struct Well {
    pub(crate) k: f64,
}

impl Function<3, 1> for Well {
    fn eval<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 1] {
        let [one, two, three, k] = [1.0, 2.0, 3.0, self.k].map(S::constant);
        [k * (one + x * x + two * y * y + three * z * z).sqrt()]
    }
}

impl Well {
    /// ∂U/∂r, by hand.
    pub(crate) fn gradient(&self, r: Vector3<f64>) -> Vector3<f64> {
        let root = (1.0 + r.dot(&r.component_mul(&Vector3::new(1.0, 2.0, 3.0)))).sqrt();
        Vector3::new(r[0], 2.0 * r[1], 3.0 * r[2]) * (self.k / root)
    }
}

/// A frame whose origin is at R(t), R_i = s_i (1 − cos ν_i t), and whose axes are turned by Q(t): about z by
/// α = a t + b sin t, then about the new x axis by β = c sin t.
#[derive(Clone, Copy)]
pub(crate) struct Frame {
    pub(crate) swing: [f64; 3],
    pub(crate) rate: [f64; 3],
    pub(crate) turn: [f64; 3],
}

impl Frame {
    pub(crate) fn random(random: &mut Random) -> Self {
        let turn = random.array(Random::signed);
        Self { swing: random.array(Random::signed), rate: random.array(Random::positive), turn }
    }

    pub(crate) fn origin<S: Scalar>(&self, t: S) -> [S; 3] {
        let one = S::constant(1.0);
        self.each(|swing, rate| S::constant(swing) * (one - (S::constant(rate) * t).cos()))
    }

    /// Ṙ.
    pub(crate) fn velocity<S: Scalar>(&self, t: S) -> [S; 3] {
        self.each(|swing, rate| S::constant(swing * rate) * (S::constant(rate) * t).sin())
    }

    /// R̈.
    pub(crate) fn acceleration<S: Scalar>(&self, t: S) -> [S; 3] {
        self.each(|swing, rate| S::constant(swing * rate * rate) * (S::constant(rate) * t).cos())
    }

    /// The state as seen from the inertial frame: R + Q r and Ṙ + Q (v + Ω×r).
    pub(crate) fn seen_from_outside(&self, state: &State<f64, 3>) -> State<f64, 3> {
        let t = state.t;
        let [origin, velocity, spin] =
            [self.origin(t), self.velocity(t), self.angular_velocity(t)].map(Vector3::from);
        let carried = state.v + spin.cross(&state.q);
        State::new(origin + self.axes(t) * state.q, velocity + self.axes(t) * carried).at_time(t)
    }

    fn each<S>(&self, component: impl Fn(f64, f64) -> S) -> [S; 3] {
        std::array::from_fn(|i| component(self.swing[i], self.rate[i]))
    }

    fn angles<S: Scalar>(&self, t: S) -> [S; 2] {
        let [a, b, c] = self.turn.map(S::constant);
        [a * t + b * t.sin(), c * t.sin()]
    }

    /// The angular velocity along the turning axes: β̇ e_x + α̇ (sin β e_y + cos β e_z).
    pub(crate) fn angular_velocity<S: Scalar>(&self, t: S) -> [S; 3] {
        let ([a, b, c], [_, beta]) = (self.turn.map(S::constant), self.angles(t));
        let alpha_dot = a + b * t.cos();
        [c * t.cos(), alpha_dot * beta.sin(), alpha_dot * beta.cos()]
    }

    /// Qᵀ x: the components of `x` along the turning axes.
    pub(crate) fn along_axes<S: Scalar>(&self, t: S, [x, y, z]: [S; 3]) -> [S; 3] {
        let [alpha, beta] = self.angles(t);
        let ((sa, ca), (sb, cb)) = (alpha.sin_cos(), beta.sin_cos());
        let (u, v) = (ca * x + sa * y, ca * y - sa * x);
        [u, cb * v + sb * z, cb * z - sb * v]
    }

    /// Q, from nalgebra.
    pub(crate) fn axes(&self, t: f64) -> Matrix3<f64> {
        let [alpha, beta] = self.angles(t);
        let about = |axis: Vector3<f64>, angle: f64| Rotation3::from_scaled_axis(axis * angle);
        (about(Vector3::z(), alpha) * about(Vector3::x(), beta)).into_inner()
    }
}

/// The same, as functions for a system's fields.
macro_rules! function_of_time {
    ($(#[$doc:meta])* $name:ident: $n:literal, |$frame:ident, $t:ident| $value:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        pub(crate) struct $name(pub(crate) Frame);

        impl Function<1, $n> for $name {
            fn eval<S: Scalar>(&self, [$t]: [S; 1]) -> [S; $n] {
                let $frame = self.0;
                $value
            }
        }
    };
}

function_of_time!(
    /// R(t).
    Origin: 3, |frame, t| frame.origin(t)
);
function_of_time!(
    /// V(t) = Ṙ.
    Velocity: 3, |frame, t| frame.velocity(t)
);
function_of_time!(
    /// The angles by which the axes are turned.
    Angles: 2, |frame, t| frame.angles(t)
);
function_of_time!(
    /// Ω(t), along the turning axes.
    AngularVelocity: 3, |frame, t| frame.angular_velocity(t)
);
function_of_time!(
    /// A(t) = R̈, along the turning axes.
    Acceleration: 3, |frame, t| frame.along_axes(t, frame.acceleration(t))
);

/// The potential U, which goes along with a frame, as a function of the inertial coordinates and of time.
#[derive(Clone, Copy)]
pub(crate) struct Carried(pub(crate) Well, pub(crate) Frame);

impl Function<4, 1> for Carried {
    fn eval<S: Scalar>(&self, [x, y, z, t]: [S; 4]) -> [S; 1] {
        let [a, b, c] = self.1.origin(t);
        self.0.eval(self.1.along_axes(t, [x - a, y - b, z - c]))
    }
}

/// A particle seen from the inertial frame.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[function(U(r, t) = potential)]
#[lagrangian(m/2*dot(r_dot, r_dot) - U(r, t))]
pub(crate) struct Inertial {
    pub(crate) m: f64,
    pub(crate) potential: Carried,
}
