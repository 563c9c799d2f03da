//! What only the compiler can tell: emitted code warns of nothing, whatever names a struct has and however strict its
//! crate is; wrong input that passes the derive, and errors of trait bounds.

#![deny(
    warnings,
    missing_docs,
    unreachable_pub,
    unused,
    nonstandard_style,
    future_incompatible,
    rust_2018_idioms
)]
#![deny(unused_lifetimes, unused_qualifications, trivial_casts, elided_lifetimes_in_paths, unnameable_types)]
#![deny(clippy::all, clippy::pedantic, clippy::nursery)]
#![allow(clippy::redundant_pub_crate)]

mod compile_fail;

use lagrange_core::prelude::*;

/// A bead on a ring, every letter of it a capital.
#[derive(Clone, Debug, Lagrangian)]
#[coordinates(X, Theta, R: [2])]
#[define(V = X_dot + R_dot[0])]
#[define(Square(A) = A^2)]
#[define(W[0] = X)]
#[define(W[i in 1..3] = W[i - 1] + L1*Theta)]
#[lagrangian(M/2 * Square(V) + M*R_dot[1]^2 + Theta_dot^2*k_B + X_dot^2 - Omega*X*K[0] - dot(G, R) - type*W[2]^2)]
#[constraint(Ring: X^2 + Theta^2 = L1^2 + 1)]
#[force(X: F_X*cos(Omega*t))]
#[observable(Energy2 = V^2)]
#[observable(Pull = lambda(Ring))]
#[observable(Vec = [X, X_ddot])]
#[allow(non_snake_case)]
pub struct Capitals<'a, Num> {
    /// A mass.
    pub M: Num,
    /// Another.
    pub k_B: Num,
    /// A frequency.
    pub Omega: Num,
    /// A length.
    pub L1: Num,
    /// Forces.
    pub K: [Num; 3],
    /// More of them.
    pub G: &'a [Num; 2],
    /// A stiffness.
    pub r#type: Num,
    /// An amplitude.
    pub F_X: Num,
    /// In no expression.
    pub Unused: &'static str,
}

mod inner {
    use lagrange_core::prelude::*;

    #[derive(Clone, Debug, Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(m/2 * x_dot^2 - k*x)]
    #[observable(momentum_of_it = m*x_dot)]
    pub(crate) struct Hidden {
        pub(crate) m: f64,
        pub(super) k: f64,
    }
}

#[test]
fn names_and_places_of_all_sorts_compute() {
    let hidden = inner::Hidden { m: 2.0, k: 3.0 };
    let state = State::new([1.0_f64], [5.0]);
    assert_eq!(
        hidden.solve(&state).map(|solution| solution.accelerations[0].to_bits()),
        Ok((-1.5_f64).to_bits())
    );
    assert_eq!(hidden.momentum_of_it(&state).to_bits(), 10.0_f64.to_bits());
    let capitals = Capitals {
        M: 1.0_f64,
        k_B: 1.0,
        Omega: 1.0,
        L1: 1.0,
        K: [1.0; 3],
        G: &[1.0, 1.0],
        r#type: 1.0,
        F_X: 1.0,
        Unused: "",
    };
    let state = State::at_rest([1.0_f64, 1.0, 0.0, 0.0]);
    let solution = capitals.solve(&state).expect("a solution");
    // Where it rests, X Ẍ + Θ Θ̈ = 0.
    assert!((solution.accelerations[0] + solution.accelerations[1]).abs() < 1e-14);
    assert_eq!(capitals.Pull(&state, &solution).to_bits(), solution.multipliers[0].to_bits());
    assert_eq!(capitals.Vec(&state, &solution)[1].to_bits(), solution.accelerations[0].to_bits());
    assert_eq!(capitals.Energy2(&state).to_bits(), 0.0_f64.to_bits());
}

/// The function of its accelerations is compiled in parts, whose modules stand within the function. L is the kinetic energy of
/// masses in a plane, whose accelerations have no component along any coordinate: Σ m r̈·∂r/∂θ = 0.
#[test]
#[allow(clippy::cast_precision_loss)]
fn a_long_system_within_a_function_computes() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(theta: [16])]
    #[lagrangian(sum(i in 0..16, m[i]/2 * (sum(j in 0..i+1, (i + j + 1)*l[j]*cos(theta[j])*theta_dot[j])^2
        + sum(j in 0..i+1, (i + j + 1)*l[j]*sin(theta[j])*theta_dot[j])^2)))]
    struct Flat<'a, T>
    where
        Self: Sized,
    {
        m: &'a [T; 16],
        l: [T; 16],
    }
    #[allow(dead_code, non_upper_case_globals, reason = "its name must not meet those of the emitted code")]
    const system: u8 = 0;
    let m = std::array::from_fn(|i| 1.0 + i as f64);
    let flat = Flat { m: &m, l: std::array::from_fn(|j| 0.1_f64.mul_add(j as f64, 1.0)) };
    let state = State::new(std::array::from_fn(|j| 2.0 * (j as f64).sin()), [1.0; 16]);
    let accelerations = flat.solve(&state).expect("a regular mass matrix").accelerations;
    let arm = |i: usize, j: usize| (i + j + 1) as f64 * flat.l[j];
    for k in 0..16 {
        let (mut sum, mut size) = (0.0, 0.0);
        for (i, j) in (k..16).flat_map(|i| (0..=i).map(move |j| (i, j))) {
            let (sin, cos) = (state.q[j] - state.q[k]).sin_cos();
            let weight = m[i] * arm(i, k) * arm(i, j);
            sum += weight * cos.mul_add(accelerations[j], -sin * state.v[j].powi(2));
            size += weight * state.v[j].mul_add(state.v[j], accelerations[j].abs());
        }
        assert!(sum.abs() < 1e-12 * size, "{k}: {sum:e} of {size:e}");
    }
}
