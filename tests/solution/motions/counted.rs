//! Steps of motions solve by factors, and make neither M nor F.

use std::cell::Cell;

use lagrange_core::generic::{Matrix, Solution, Vector, ViewOf};
use lagrange_core::motion::LagrangianVectorField;
use lagrange_core::nalgebra::SVector;
use lagrange_core::{
    Broadcast, ConstraintKind, Hamiltonian, Lagrangian, SolutionOf, StateOf, System, facts::Facts, prelude::*,
};

use crate::factor::{Body, Skate, rods};

/// A system that counts how often its matrices are asked for as such.
struct Counted<L> {
    system: L,
    matrices: Cell<usize>,
}

impl<L> Counted<L> {
    fn counted<T>(&self, matrix: T) -> T {
        self.matrices.set(self.matrices.get() + 1);
        matrix
    }
}

macro_rules! handed_on {
    ($($name:ident($($argument:ident: $type:ty),*) -> $result:ty;)*) => {
        $(fn $name(&self, state: &StateOf<L>, $($argument: $type),*) -> $result {
            self.system.$name(state, $($argument),*)
        })*
    };
}

impl<L: Lagrangian<Scalar = f64>> System for Counted<L> {
    type Scalar = f64;
    type Length = L::N;
    type M = L::M;
    type Field = LagrangianVectorField;

    fn length(&self) -> L::N {
        self.system.length()
    }
    fn accelerations(&self, t: f64, q: &ViewOf<f64, L::N>, v: &ViewOf<f64, L::N>, a: &mut ViewOf<f64, L::N>) {
        self.system.accelerations(t, q, v, a);
    }
}

impl<L: Lagrangian<Scalar = f64>> Lagrangian for Counted<L> {
    type N = L::N;
    type Factor = L::Factor;
    const NAME: &'static str = L::NAME;
    const COORDINATES: &'static [&'static str] = L::COORDINATES;
    const CONSTRAINTS: &'static [&'static str] = L::CONSTRAINTS;
    const CONSTRAINT_KINDS: &'static [ConstraintKind] = L::CONSTRAINT_KINDS;
    const MOMENTA_ARE_LINEAR: bool = L::MOMENTA_ARE_LINEAR;
    const OBSERVABLES: &'static [&'static str] = &[];
    const FACTS: Facts = L::FACTS;

    fn mass_matrix(&self, state: &StateOf<L>) -> Matrix<f64, L::N, L::N> {
        self.counted(self.system.mass_matrix(state))
    }
    fn constraint_jacobian(&self, state: &StateOf<L>) -> Matrix<f64, L::M, L::N> {
        self.counted(self.system.constraint_jacobian(state))
    }
    fn solve_with<S: Broadcast<f64>>(
        &self,
        factor: &L::Factor,
        forcing: &Vector<S, L::N>,
        bias: &Vector<S, L::M>,
    ) -> Solution<S, L::N, L::M> {
        self.system.solve_with(factor, forcing, bias)
    }
    fn observable(&self, _: usize, _: &StateOf<L>, _: &SolutionOf<L>) -> Option<f64> {
        None
    }
    fn conserved(&self, _: usize, _: &StateOf<L>) -> Option<f64> {
        None
    }
    handed_on! {
        lagrangian() -> f64;
        energy_rate(multipliers: &Vector<f64, L::M>) -> f64;
        energy() -> f64;
        momentum() -> Vector<f64, L::N>;
        momentum_rate() -> Vector<f64, L::N>;
        forcing() -> Vector<f64, L::N>;
        constraint_residual() -> Vector<f64, L::M>;
        constraint_rate() -> Vector<f64, L::M>;
        residual_magnitude() -> Vector<f64, L::M>;
        rate_magnitude() -> Vector<f64, L::M>;
        constraint_bias() -> Vector<f64, L::M>;
        constraint_force(multipliers: &Vector<f64, L::M>) -> Vector<f64, L::N>;
        inverse_dynamics(a: &Vector<f64, L::N>, multipliers: &Vector<f64, L::M>) -> Vector<f64, L::N>;
        accelerations_unchecked() -> SolutionOf<L>;
        factor() -> L::Factor;
    }
}

/// How often the steps of a motion, and its states in between, make M or F: what the start takes is left out.
fn matrices_of_steps<L: Lagrangian<Scalar = f64>>(system: L, start: StateOf<L>) -> [usize; 2] {
    let counted = Counted { system, matrices: Cell::new(0) };
    let start = counted.make_consistent(&start).expect("a start").0;
    let of = |motion: &dyn Fn(f64) -> usize| {
        let [few, many] = [0.1, 2.0].map(|end| {
            counted.matrices.set(0);
            (motion(start.t + end), counted.matrices.get())
        });
        assert!(many.0 > 2 * few.0, "more steps");
        many.1 - few.1
    };
    let lagrangian = of(&|end| {
        let path = counted.integrate(start, end, Dop853::default()).expect("a motion");
        assert_eq!(path.samples(50).count(), 50);
        path.statistics().accepted
    });
    let hamiltonian = of(&|end| {
        let start = counted.phase_state(&start);
        let path = counted.motion_in_momenta(start).to(end).expect("a motion");
        assert_eq!(path.samples(50).count(), 50);
        path.statistics().accepted
    });
    [lagrangian, hamiltonian]
}

#[test]
fn motions_make_no_matrices() {
    let along = |i: usize| 0.7 * if i < 8 { 0.8 * (i + 1) as f64 } else { -0.6 * (i - 7) as f64 };
    let line = State::at_rest(SVector::from_fn(|i, _| along(i)));
    assert_eq!(matrices_of_steps(rods(), line), [0, 0]);
    let turning = State::new([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1.5, 0.1, 0.2, 1.0, 0.0, 0.0]);
    assert_eq!(matrices_of_steps(Body { j: [0.3, 1.0, 2.5], m: 1.7 }, turning), [0, 0]);
    let skate = Skate { m: 1.3, j: 0.4, g: 9.81, a: 0.2, w: 3.0 };
    assert_eq!(matrices_of_steps(skate, State::new([0.5, 0.2, 0.0, 0.1], [1.0, 0.3, 0.0, 0.5])), [0, 0]);
}
