//! Other number types, and functions that the user supplies.

use lagrange_core::function::{FunctionWithDerivatives, WithDerivatives};
use lagrange_core::{linearized::Stability, prelude::*};
use lagrange_systems::SphericalPendulum;

use crate::numbers::{ARGUMENTS, PARAMETERS, bob};

#[test]
fn single_precision_has_jacobians_equilibria_and_eigenvalues_too() {
    let [t, x, y, vx, vy] = ARGUMENTS;
    let wide = bob(PARAMETERS).jacobian(&State::new([x, y], [vx, vy]).at_time(t)).unwrap();
    let [t, x, y, vx, vy] = ARGUMENTS.map(|x| x as f32);
    let state = State::new([x, y], [vx, vy]).at_time(t);
    let narrow = bob(PARAMETERS.map(|x| x as f32)).jacobian(&state).unwrap();
    let difference = narrow.accelerations.q.map(f64::from) - wide.accelerations.q;
    assert!(difference.amax() < 1e-5 * wide.accelerations.q.amax(), "{difference}");

    let pendulum = SphericalPendulum { m: 2.0, g: 9.81_f32, l: 0.5 };
    let found = pendulum.equilibrium(&State::at_rest([0.3, 0.2, -0.2]), &[]).unwrap().state;
    assert!(found.q.xy().amax() < 1e-7 && (found.q[2] + 0.5).abs() < 1e-7, "{found}");
    let near = pendulum.linearize(&State::at_rest([0.0, 0.0, -0.5]), &[]).unwrap();
    assert_eq!(near.a.shape(), (4, 4));
    let frequencies = near.natural_frequencies().unwrap();
    assert!(frequencies.len() == 2 && frequencies.iter().all(|w| (w - 19.62_f32.sqrt()).abs() < 1e-5));
    assert_eq!(near.stability(), Ok(Stability::Undecided));
}

/// Morse's potential D (1 − e^{−a s})².
#[derive(Clone)]
struct Morse {
    depth: f64,
    a: f64,
}

impl Function<1, 1> for Morse {
    fn eval<S: Scalar>(&self, [s]: [S; 1]) -> [S; 1] {
        let e = S::constant(1.0) - (S::constant(-self.a) * s).exp();
        [S::constant(self.depth) * e * e]
    }
}

impl FunctionWithDerivatives<1, 1> for Morse {
    fn value(&self, x: [f64; 1]) -> [f64; 1] {
        self.eval(x)
    }

    fn gradient(&self, [s]: [f64; 1]) -> [[f64; 1]; 1] {
        let e = (-self.a * s).exp();
        [[2.0 * self.depth * self.a * (1.0 - e) * e]]
    }

    fn hessian(&self, [s]: [f64; 1]) -> [[[f64; 1]; 1]; 1] {
        let e = (-self.a * s).exp();
        [[[2.0 * self.depth * self.a.powi(2) * (2.0 * e * e - e)]]]
    }
}

/// A molecule of two atoms that turns.
#[derive(Clone, Lagrangian)]
#[coordinates(r, phi)]
#[function(U(s) = bond)]
#[lagrangian(mass/2*(r_dot^2 + r^2*phi_dot^2) - U(r - length))]
struct Molecule<F> {
    mass: f64,
    length: f64,
    bond: F,
}

/// ω² = U″/m at rest. Second derivatives by hand are as good as any: the potential needs no more.
#[test]
fn a_supplied_potential_is_differentiated_once_more() {
    let bond = Morse { depth: 3.0, a: 1.2 };
    let frequency = (2.0 * 3.0 * 1.44 / 0.5_f64).sqrt();
    let general = Molecule { mass: 0.5, length: 2.0, bond: bond.clone() };
    let by_hand = Molecule { mass: 0.5, length: 2.0, bond: WithDerivatives(bond) };
    let found = general.equilibrium(&State::at_rest([2.3, 0.0]), &[]).unwrap();
    assert!((found.state.q[0] - 2.0).abs() < 1e-15);
    for near in [general.linearize(&found.state, &[]), by_hand.linearize(&found.state, &[])] {
        assert!((near.unwrap().natural_frequencies().unwrap()[0] - frequency).abs() < 1e-13);
    }
    // Turning at a rate Ω it is longer: m r Ω² = U′.
    let turning = State::new([2.1, 0.0], [0.0, 0.8]);
    let longer = by_hand.equilibrium(&turning, &["r"]).unwrap().state;
    let stretch = by_hand.bond.0.gradient([longer.q[0] - 2.0])[0][0];
    assert!((stretch - 0.5 * longer.q[0] * 0.64).abs() < 1e-15);
}
