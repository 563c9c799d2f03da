use nalgebra::Const;

use super::{Corrections, project};
use crate::prelude::*;
use crate::solution::consistent::BOTH;
use crate::vector::Array;
use lagrange_random::{Random, cases};

/// A mass on a growing circle about a centre, in a magnetic field and with anisotropic damping.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + b/2*(x*y_dot - y*x_dot) - k*(x^2 + y^2)^2)]
#[constraint(circle: x^2 + y^2 = (l + u*t)^2)]
#[force(x: -c*(x_dot + y_dot/2))]
#[force(y: -c*(3*y_dot + x_dot/2))]
struct Cartesian {
    m: f64,
    b: f64,
    c: f64,
    k: f64,
    l: f64,
    u: f64,
}

/// The same motion in polar coordinates, with a varying mass matrix and without field and damping.
#[derive(Lagrangian)]
#[coordinates(r, phi)]
#[lagrangian(m/2*(r_dot^2 + r^2*phi_dot^2) - k*r^4)]
#[constraint(circle: r = l + u*t)]
struct Polar {
    m: f64,
    k: f64,
    l: f64,
    u: f64,
}

/// Two masses coupled by a spring, one on a spheroid; the system is symmetric about one axis.
#[derive(Lagrangian)]
#[coordinates(x, y, z, s, w)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) + s_dot^2/2 + s^2*w_dot^2/2 - g*z - k/2*(z - s)^2)]
#[constraint(spheroid: x^2 + y^2 + e*z^2 = 1)]
#[constraint(pulley: s + z/4 = 2)]
struct Coupled {
    m: f64,
    g: f64,
    k: f64,
    e: f64,
}

/// Mean change of a momentum by the projection of random states a few hundred units of round-off off the
/// constraints: with velocities that follow the coordinates, and with velocities that do not.
fn changes<L: Lagrangian<N = Const<N>, Scalar = f64>, const N: usize>(
    system: impl Fn(&mut Random) -> L,
    momentum: impl Fn(&L, &State<f64, N>) -> f64,
) -> [f64; 2] {
    let mut sums = [0.0; 2];
    let cases = cases([500, 4_000, 100_000]) as u64;
    for case in 0..cases {
        let random = &mut Random(case << 32);
        let system = system(random);
        let from = State::new(
            [(); N].map(|()| 1.0 + 0.7 * random.number()),
            [(); N].map(|()| 2.0 * random.number()),
        );
        let (on, _) = system
            .make_consistent(&State { t: 0.3 * random.number(), ..from })
            .expect("near the constraints");
        let off = State {
            q: on.q.map(|q| q + 1e-13 * random.number()),
            v: on.v.map(|v| v + 1e-15 * random.number()),
            ..on
        };
        let step = 0.6 + 0.3 * random.number();
        let corrections = [Corrections::OnceAfter(step), Corrections::ToRoundOff];
        for (sum, corrections) in sums.iter_mut().zip(corrections) {
            let (near, doubt) =
                project::<_, f64>(&system, &BOTH, corrections, off, &mut [Array::filled(0.0); 2]);
            assert_eq!(doubt, 0.0, "case {case}");
            *sum += (momentum(&system, &near) - momentum(&system, &off)).abs();
        }
    }
    sums.map(|sum| sum / cases as f64)
}

/// A random system; `strength` scales the magnetic field and the damping.
fn cartesian(random: &mut Random, strength: f64) -> Cartesian {
    let [b, c] = [strength * random.number(), strength * random.number().abs()];
    let [m, k, l, u] = [1.5 + random.number(), random.number(), 1.5 + 0.5 * random.number(), random.number()];
    Cartesian { m, b, c, k, l, u }
}

/// A correction along Hamiltonian vector fields preserves a momentum that symmetry conserves.
#[test]
fn momenta_are_kept_where_velocities_follow_the_coordinates() {
    let cartesian = changes(
        |r| cartesian(r, 0.0),
        |system, state| {
            let p = system.momentum(state);
            state.q[0] * p[1] - state.q[1] * p[0]
        },
    );
    let polar = changes(
        |r| Polar { m: 1.5 + r.number(), k: r.number(), l: 1.5 + 0.5 * r.number(), u: r.number() },
        |system, state| system.momentum(state)[1],
    );
    let coupled = changes(
        |r| Coupled { m: 1.5 + r.number(), g: 2.0 * r.number(), k: r.number(), e: 1.0 + 0.5 * r.number() },
        |system, state| {
            let p = system.momentum(state);
            state.q[0] * p[1] - state.q[1] * p[0] + p[4]
        },
    );
    for [follows, stays] in [cartesian, polar, coupled] {
        std::println!("{follows:.1e} {stays:.1e}");
        assert!(follows < stays / 100.0 && stays > 2e-14, "{follows:e}, {stays:e}");
    }
}

/// A field that would amplify the round-off of coordinates to 10⁹ units of that of velocities has no effect.
#[test]
fn velocities_follow_no_forces() {
    let speed = |_: &Cartesian, state: &State<f64, 2>| state.v.norm();
    let [follows, stays] = changes(|r| cartesian(r, 1e9), speed);
    assert!(follows < 4e-13 && stays < 4e-13, "{follows:e}, {stays:e}");
}
