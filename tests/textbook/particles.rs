//! Many particles in a rotating frame: Milton (8.52), (8.53).

use lagrange_core::nalgebra::Vector3;
use lagrange_core::prelude::*;
use lagrange_random::{Random, cases};
use lagrange_systems::random_state;

/// V(s) = k/2 s² + k/4 s⁴.
struct Bond {
    k: f64,
}

impl Function<3, 1> for Bond {
    fn eval<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 1] {
        let square = x * x + y * y + z * z;
        [S::constant(self.k / 2.0) * square + S::constant(self.k / 4.0) * square * square]
    }
}

/// Three particles that attract each other.
#[derive(Lagrangian)]
#[coordinates(r: [3, 3])]
#[function(V(s: [3]) = bond)]
#[define(pairs = V(r[0] - r[1]) + V(r[1] - r[2]) + V(r[2] - r[0]))]
#[define(one(v, s) = dot(v, v)/2 + dot(v, cross(w, s)) + dot(cross(w, s), cross(w, s))/2)]
#[lagrangian(sum(i in 0..3, m[i]*one(r_dot[i], r[i])) - pairs)]
struct Particles {
    m: [f64; 3],
    w: [f64; 3],
    bond: Bond,
}

const PARTICLES: Particles = Particles { m: [1.0, 0.7, 2.0], w: [0.2, -0.5, 0.7], bond: Bond { k: 0.3 } };

/// p = m (v + Ω×r) is the momentum in the frame at rest, particle by particle, and E = E₀ − Σ L_a·Ω.
#[test]
fn momenta_8_52_and_energy_8_53() {
    let (system, omega) = (PARTICLES, Vector3::from(PARTICLES.w));
    let mut random = Random(14);
    for _ in 0..cases([100, 1_000, 100_000]) {
        let state: State<f64, 9> = random_state(&mut random);
        let p = system.momentum(&state);
        let of = |all: &[f64], k: usize| Vector3::from_column_slice(&all[3 * k..3 * k + 3]);
        let mut expected = 0.0;
        for k in 0..3 {
            let (m, r, next) = (system.m[k], of(state.q.as_slice(), k), of(state.q.as_slice(), (k + 1) % 3));
            let v = of(state.v.as_slice(), k) + omega.cross(&r);
            assert!((of(p.as_slice(), k) - m * v).amax() < 1e-13);
            let bond = Function::eval(&system.bond, (r - next).into())[0];
            expected += m / 2.0 * v.dot(&v) + bond - (r.cross(&v) * m).dot(&omega);
        }
        assert!((system.energy(&state) - expected).abs() < 1e-12 * (1.0 + expected.abs()));
        let hamiltonian = system.hamiltonian(&system.phase_state(&state)).unwrap();
        assert!((hamiltonian - expected).abs() < 1e-12 * (1.0 + expected.abs()));
    }
}

/// The force of a user's function by its derivative, whose argument is a difference.
#[test]
fn equations_name_the_derivative_of_the_interaction() {
    let equations = Particles::equations();
    let force = "− (∂V/∂s)([r[0][0] − r[1][0], r[0][1] − r[1][1], r[0][2] − r[1][2]])";
    assert!(equations.text().contains(force), "{equations}");
}
