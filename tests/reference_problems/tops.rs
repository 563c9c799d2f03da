//! Rigid bodies with a fixed point: a heavy symmetric top and a free body, in Euler's angles and as frames.

use lagrange_core::nalgebra::{Matrix3, Vector3};
use lagrange_core::prelude::*;
use lagrange_systems::HeavyTop;

use crate::reference::{BAR, Known, Problem, table};

const TOP: HeavyTop<f64> = HeavyTop { i1: 0.4, i3: 0.25, mgl: 2.0 };

/// A free rigid body in Euler's angles, with the angular velocity along its axes.
#[derive(Lagrangian)]
#[coordinates(ph, th, ps)]
#[define(w = [
    ph_dot*sin(th)*sin(ps) + th_dot*cos(ps),
    ph_dot*sin(th)*cos(ps) - th_dot*sin(ps),
    ph_dot*cos(th) + ps_dot
])]
#[lagrangian((I[0]*w[0]^2 + I[1]*w[1]^2 + I[2]*w[2]^2)/2)]
#[observable(spin = w)]
#[allow(non_snake_case)]
struct FreeBody {
    I: [f64; 3],
}

/// A rigid body by a quaternion. Its inertia is about the fixed point, and its centre of mass 1 above that.
#[derive(Lagrangian)]
#[coordinates(q: [4])]
#[frame(body: rotate(q))]
#[lagrangian(kinetic(body, 0, [0, 0, 0], inertia) - w*position(body, [0, 0, 1])[2])]
struct BodyInSpace {
    inertia: Matrix3<f64>,
    w: f64,
}

impl BodyInSpace {
    fn with(inertia: [f64; 3], w: f64) -> Self {
        Self { inertia: Matrix3::from_diagonal(&Vector3::from(inertia)), w }
    }
}

/// Converts Euler's angles, about z, x and z, to a quaternion. The multiplier of its unit length is not known.
fn by_quaternion(known: Vec<Known<3, 0>>) -> Vec<Known<4, 1>> {
    let each = |Known { t, q: [phi, theta, psi], v: [phi_dot, theta_dot, psi_dot], .. }: Known<3, 0>| {
        let (s, c) = (theta / 2.0).sin_cos();
        let (ss, cs) = f64::midpoint(phi, psi).sin_cos();
        let (sa, ca) = ((phi - psi) / 2.0).sin_cos();
        let [sum_dot, apart_dot] = [f64::midpoint(phi_dot, psi_dot), (phi_dot - psi_dot) / 2.0];
        let (s_dot, c_dot) = (c * theta_dot / 2.0, -s * theta_dot / 2.0);
        let q = [c * cs, s * ca, s * sa, c * ss];
        let v = [
            c_dot * cs - c * ss * sum_dot,
            s_dot * ca - s * sa * apart_dot,
            s_dot * sa + s * ca * apart_dot,
            c_dot * ss + c * cs * sum_dot,
        ];
        Known { t, q, v, lambda: None }
    };
    known.into_iter().map(each).collect()
}

/// The axis comes to rest once in each nutation; the second known time is the end of the first nutation.
#[test]
fn heavy_top_with_cusps() {
    let problem = Problem { name: "heavy top with cusps", system: TOP, known: table!("heavy_top_cusp") };
    problem.check(&[[1e-14, 1e-13, 0.0], [1e-12, 1e-11, 0.0]]);
}

#[test]
fn heavy_top_with_cusps_by_quaternion() {
    let system = BodyInSpace::with([0.4, 0.4, 0.25], 2.0);
    let known = by_quaternion(table!("heavy_top_cusp"));
    let problem = Problem { name: "heavy top with cusps, quaternion", system, known };
    problem.check(&[[2e-12, 2e-12, 0.0], [1e-10, 1e-10, 0.0]]);
}

#[test]
fn heavy_top_on_a_wave() {
    let problem = Problem { name: "heavy top on a wave", system: TOP, known: table!("heavy_top_wave") };
    problem.check(&[[1e-13, 1e-12, 0.0], [1e-11, 1e-10, 0.0], BAR]);
}

#[test]
fn heavy_top_on_a_wave_by_quaternion() {
    let system = BodyInSpace::with([0.4, 0.4, 0.25], 2.0);
    let known = by_quaternion(table!("heavy_top_wave"));
    let problem = Problem { name: "heavy top on a wave, quaternion", system, known };
    problem.check(&[[2e-12, 2e-12, 0.0], [1e-10, 1e-10, 0.0]]);
    problem.row("Lobatto 4 2 ms", Lobatto::<4>::with_step(2e-3)).reaches(BAR);
}

/// The angular velocity along the body's axes has the period of Jacobi's elliptic functions, which is the third of the
/// known times.
#[test]
fn free_body() {
    let known: Vec<Known<3, 0>> = table!("free_body");
    let system = FreeBody { I: [1.0, 2.0, 3.0] };
    assert_eq!(known[2].t, 5.543_182_554_726_02);
    for k in [0, 2] {
        let spin = system.spin(&State::new(known[k].q, known[k].v));
        assert!((spin - Vector3::new(0.4, 0.8, 1.1)).norm() < 1e-15);
    }
    let problem = Problem { name: "free body", system, known };
    problem.check(&[[1e-13, 1e-13, 0.0], [1e-11, 1e-10, 0.0]]);
}

#[test]
fn free_body_by_quaternion() {
    let system = BodyInSpace::with([1.0, 2.0, 3.0], 0.0);
    let problem =
        Problem { name: "free body, quaternion", system, known: by_quaternion(table!("free_body")) };
    problem.check(&[[1e-13, 1e-13, 0.0], [1e-10, 1e-10, 0.0]]);
}
