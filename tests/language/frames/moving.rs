//! A path through all steps, and the poses on it as products of nalgebra's: nothing of it is known to the derive.

use lagrange_core::nalgebra::{
    Isometry3, Matrix3, Quaternion, Rotation3, SVector, Translation3, Unit, UnitQuaternion, Vector3,
};
use lagrange_core::prelude::*;

/// A platform that is driven, a body on it by a quaternion, an arm by every other step.
#[derive(Lagrangian)]
#[coordinates(x, a, q: [4], b, c)]
#[function(Omega(t) = drive)]
#[frame(platform: translate([x, speed*t, 0]), rotate_z(Omega(t)))]
#[frame(body in platform: translate(place), rotate(q))]
#[frame(arm[0] in body: rotate(mount), rotate_x(a), translate([b, 0, 2*b]))]
#[frame(arm[i in 1..3] in arm[i-1]: rotate(tilt), rotate(axis, i*c), translate([0, length, 0]), rotate_y(b - c))]
#[define(p = [0.3, -0.2, 0.7])]
#[define(v = velocity(arm[2], [b, 1, c]))]
#[lagrangian(kinetic(body, m, p, inertia) + kinetic(arm[0], m, p, inertia) + kinetic(arm[2], 2*m, p, inertia) + m*(x_dot^2 + b_dot^2)/2)]
#[observable(at = position(arm[2], [b, 1, c]))]
#[observable(origin = position(arm[1]))]
#[observable(tool = v)]
#[observable(spin = angular_velocity(arm[2]))]
#[observable(felt = der(v))]
#[observable(felt_on_platform = express(der(express(v, platform), platform), fixed))]
#[observable(from_body = express(der(vector(arm[2], [b, 1, c]), body), fixed))]
#[observable(turned = express(vector(arm[2], [1, 2, 3]), arm[0]))]
#[observable(sideways = express(vector(arm[2], [1, 2, 3]), platform))]
#[observable(work = kinetic(arm[2], m, p, inertia))]
#[observable(of_point = kinetic(arm[2], m, [b, 1, c]))]
#[observable(bare = kinetic(arm[2], m))]
pub(crate) struct Machine<F> {
    pub(crate) m: f64,
    pub(crate) inertia: Matrix3<f64>,
    pub(crate) speed: f64,
    pub(crate) place: Vector3<f64>,
    pub(crate) mount: Rotation3<f64>,
    pub(crate) tilt: UnitQuaternion<f64>,
    pub(crate) axis: Vector3<f64>,
    pub(crate) length: f64,
    pub(crate) drive: F,
}

/// t² − t/3
pub(crate) struct Parabola;

impl Function<1, 1> for Parabola {
    fn eval<S: Scalar>(&self, [t]: [S; 1]) -> [S; 1] {
        [t * t - t * S::constant(1.0 / 3.0)]
    }
}

pub(crate) fn machine() -> Machine<Parabola> {
    Machine {
        m: 1.3,
        inertia: Matrix3::new(2.0, 0.1, -0.2, 0.1, 1.5, 0.3, -0.2, 0.3, 1.0),
        speed: 0.6,
        place: Vector3::new(0.2, -0.5, 1.1),
        mount: Rotation3::from_euler_angles(0.4, -0.3, 1.2),
        tilt: UnitQuaternion::from_euler_angles(-0.7, 0.2, 0.5),
        axis: Vector3::new(1.0, -2.0, 2.0),
        length: 0.8,
        drive: Parabola,
    }
}

/// Coordinates along a path, the quaternion of length 1.
pub(crate) fn coordinates(t: f64) -> [f64; 8] {
    let q = Quaternion::new(1.0 + 0.2 * t, 0.5 * t - 0.3, t * t - 0.1, 0.4 - t).normalize();
    [t.sin(), 0.3 + 0.7 * t, q.w, q.i, q.j, q.k, 0.5 - t * t, (2.0 * t).cos()]
}

/// The pose of the last arm's frame, or of those that it comes from.
pub(crate) fn pose(t: f64, frame: &str) -> Isometry3<f64> {
    let system = machine();
    let [x, a, w, i, j, k, b, c] = coordinates(t);
    let moved = |x: f64, y: f64, z: f64| {
        Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::identity())
    };
    let turned = |rotation: UnitQuaternion<f64>| Isometry3::from_parts(Translation3::identity(), rotation);
    let about = |axis: Vector3<f64>, angle: f64| {
        turned(UnitQuaternion::from_axis_angle(&Unit::new_normalize(axis), angle))
    };
    let platform = moved(x, 0.6 * t, 0.0) * about(Vector3::z(), t * t - t / 3.0);
    let q = UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k));
    let body = platform * moved(system.place.x, system.place.y, system.place.z) * turned(q);
    let first = body * turned(system.mount.into()) * about(Vector3::x(), a) * moved(b, 0.0, 2.0 * b);
    let next = |before: Isometry3<f64>, i: f64| {
        before
            * turned(system.tilt)
            * about(system.axis, i * c)
            * moved(0.0, 0.8, 0.0)
            * about(Vector3::y(), b - c)
    };
    match frame {
        "platform" => platform,
        "body" => body,
        "arm[0]" => first,
        "arm[1]" => next(first, 1.0),
        _ => next(next(first, 1.0), 2.0),
    }
}

/// The point that the machine's observables look at, in the last frame.
pub(crate) fn point(t: f64) -> Vector3<f64> {
    let [.., b, c] = coordinates(t);
    Vector3::new(b, 1.0, c)
}

/// d/dt of anything, by differences of the eighth order: the error of the formula is below that of rounding.
pub(crate) fn rate<V>(of: impl Fn(f64) -> V, t: f64) -> V
where
    V: core::ops::Sub<Output = V> + core::ops::Add<Output = V> + core::ops::Mul<f64, Output = V>,
{
    const H: f64 = 5e-3;
    let difference = |k: f64| of(t + k * H) - of(t - k * H);
    let weights = [(2.0, -0.2), (3.0, 4.0 / 105.0), (4.0, -1.0 / 280.0)];
    let sum =
        weights.into_iter().fold(difference(1.0) * 0.8, |sum, (k, weight)| sum + difference(k) * weight);
    sum * (1.0 / H)
}

/// The state on the path, and what makes the accelerations those of the path.
pub(crate) fn state(t: f64) -> (State<f64, 8>, [f64; 8]) {
    let vector = |t: f64| SVector::<f64, 8>::from(coordinates(t));
    let velocity = |t: f64| rate(vector, t);
    let velocities: [f64; 8] = velocity(t).into();
    let mut state = State::new(coordinates(t), velocities);
    state.t = t;
    (state, rate(velocity, t).into())
}
