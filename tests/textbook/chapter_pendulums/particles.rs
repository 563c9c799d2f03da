//! Many particles in a rotating frame: Milton (8.52), (8.53).

use approx::{assert_abs_diff_eq, assert_relative_eq};
use lagrange_core::nalgebra::{Rotation3, Vector3};
use lagrange_core::prelude::*;

/// V(s) = k/2 s² + k/4 s⁴.
struct Spring {
    k: f64,
}

impl Function<3, 1> for Spring {
    fn eval<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 1] {
        let square = x * x + y * y + z * z;
        [S::constant(self.k / 2.0) * square + S::constant(self.k / 4.0) * square * square]
    }
}

/// Three particles that attract each other, in a field that turns with the frame, about an axis of any direction.
#[derive(Lagrangian)]
#[coordinates(a: [3], b: [3], c: [3])]
#[define(r[0] = a)]
#[define(r[1] = b)]
#[define(r[2] = c)]
#[define(U(s) = e/2*s[0]^2 - f*s[1]*s[2] + e*dot(s, s))]
#[function(V(s: [3]) = spring)]
#[define(pairs = V(r[0] - r[1]) + sum(j in 0..2, V(r[2] - r[j])))]
#[define(v[i in 0..3] = der(r[i]))]
#[define(one(i) = dot(v[i], v[i])/2 + dot(v[i], cross(w, r[i])) + dot(cross(w, r[i]), cross(w, r[i]))/2)]
#[lagrangian(sum(i in 0..3, m[i]*one(i) - U(r[i])) - pairs)]
struct Rotating {
    m: [f64; 3],
    w: [f64; 3],
    spring: Spring,
    e: f64,
    f: f64,
}

/// The same in the frame at rest, with the attraction written out. The field turns here: a point is turned back by
/// Rodrigues' formula before the field is taken there.
#[derive(Lagrangian)]
#[coordinates(a: [3], b: [3], c: [3])]
#[define(r[0] = a)]
#[define(r[1] = b)]
#[define(r[2] = c)]
#[define(rate = norm(w))]
#[define(axis = w/rate)]
#[define(back(s) = cos(rate*t)*s - sin(rate*t)*cross(axis, s) + (1 - cos(rate*t))*dot(axis, s)*axis)]
#[define(fixed(s) = e/2*s[0]^2 - f*s[1]*s[2] + e*dot(s, s))]
#[define(V(s) = k/2*dot(s, s) + k/4*dot(s, s)^2)]
#[define(pairs = V(r[0] - r[1]) + sum(j in 0..2, V(r[2] - r[j])))]
#[lagrangian(sum(i in 0..3, m[i]/2*dot(der(r[i]), der(r[i])) - fixed(back(r[i]))) - pairs)]
struct AtRest {
    m: [f64; 3],
    w: [f64; 3],
    k: f64,
    e: f64,
    f: f64,
}

const M: [f64; 3] = [1.0, 0.7, 2.0];
const OMEGA: [f64; 3] = [0.2, -0.5, 0.7];
const ROTATING: Rotating = Rotating { m: M, w: OMEGA, spring: Spring { k: 0.3 }, e: 1.1, f: 0.4 };
const AT_REST: AtRest = AtRest { m: M, w: OMEGA, k: 0.3, e: 1.1, f: 0.4 };

fn vector(of: &[f64], particle: usize) -> Vector3<f64> {
    Vector3::from_column_slice(&of[3 * particle..3 * particle + 3])
}

/// The state in the frame at rest: r₀ and v₀ = v + Ω×r, turned by Ω t.
fn at_rest(s: &State<f64, 9>) -> State<f64, 9> {
    let omega = Vector3::from(OMEGA);
    let turn = Rotation3::new(omega * s.t);
    let mut there = *s;
    for i in 0..3 {
        let (r, v) = (vector(s.q.as_slice(), i), vector(s.v.as_slice(), i));
        there.q.fixed_rows_mut::<3>(3 * i).copy_from(&(turn * r));
        there.v.fixed_rows_mut::<3>(3 * i).copy_from(&(turn * (v + omega.cross(&r))));
    }
    there
}

/// Σ L_a·Ω with L = r×p.
fn l_dot_omega(s: &State<f64, 9>) -> f64 {
    let p = ROTATING.momentum(s);
    let l = |i: usize| vector(s.q.as_slice(), i).cross(&vector(p.as_slice(), i));
    (0..3).map(l).sum::<Vector3<f64>>().dot(&Vector3::from(OMEGA))
}

fn random_states() -> impl Iterator<Item = State<f64, 9>> {
    let mut seed = 11_u64;
    let mut random = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..200).map(move |_| {
        let mut entries = || std::array::from_fn::<f64, 9, _>(|_| random());
        State::new(entries(), entries())
    })
}

/// p = m (v + Ω×r) is the momentum in the frame at rest, particle by particle.
#[test]
fn momenta_8_52() {
    for s in random_states() {
        let (p, there) = (ROTATING.momentum(&s), at_rest(&s));
        for (i, p) in p.iter().enumerate() {
            assert_abs_diff_eq!(*p, M[i / 3] * there.v[i], epsilon = 1e-14);
        }
    }
}

/// E = E₀ − Σ L_a·Ω, with E₀ the energy of the same system in the frame at rest, whose axes are the same at t = 0.
#[test]
fn energy_8_53() {
    for s in random_states() {
        let expected = AT_REST.energy(&at_rest(&s)) - l_dot_omega(&s);
        assert_abs_diff_eq!(ROTATING.energy(&s), expected, epsilon = 1e-13 * (1.0 + expected.abs()));
    }
}

const START: [[f64; 9]; 2] =
    [[1.0, 0.2, -0.1, -0.4, 0.9, 0.3, 0.1, -0.7, 0.5], [0.1, -0.2, 0.3, 0.2, 0.1, -0.3, 0.0, 0.2, 0.1]];

/// 50 s in the rotating frame and in the frame at rest, from the same state.
#[test]
fn motion_in_both_frames() {
    let start = State::new(START[0], START[1]);
    let method = Dop853::with_tolerance(1e-12);
    let rotating = ROTATING.integrate(start, 50.0, method).unwrap();
    let inertial = AT_REST.integrate(at_rest(&start), 50.0, method).unwrap();
    for sample in rotating.samples(501) {
        let (there, other) = (at_rest(sample.state()), inertial.at(sample.time()).unwrap());
        assert!((there.q - other.state().q).amax() < 1e-8);
        assert!((there.v - other.state().v).amax() < 1e-8);
    }
}

/// E is conserved; E₀ and Σ L_a·Ω are not, because the field turns.
#[test]
fn energy_is_conserved_in_the_rotating_frame() {
    let start = State::new(START[0], START[1]);
    let path = ROTATING.integrate(start, 50.0, Dop853::with_tolerance(1e-13)).unwrap();
    let mut exchanged = 0.0_f64;
    for sample in path.steps() {
        let s = sample.state();
        assert_relative_eq!(ROTATING.energy(s), ROTATING.energy(&start), max_relative = 1e-11);
        exchanged = exchanged.max((l_dot_omega(s) - l_dot_omega(&start)).abs());
    }
    assert!(exchanged > 0.1, "only {exchanged}");
}

/// The force of a user's function by its derivative, whose argument is a difference.
#[test]
fn equations_name_the_derivative_of_the_interaction() {
    let equations = Rotating::equations();
    let derivative = "(∂V/∂s[0])([a[0] − b[0], a[1] − b[1], a[2] − b[2]])";
    assert!(equations.text().contains(derivative), "{equations}");
}
