//! Functions of many arguments: derivatives along directions are products with arrays, not written-out sums.

use approx::assert_relative_eq;
use lagrange_core::Linearized;
use lagrange_core::prelude::*;
use lagrange_random::Random;

/// Number of masses in a ring.
const N: usize = 40;

/// Springs between neighbours, and a quartic well whose depth oscillates.
struct Springs;

impl Function<42, 1> for Springs {
    fn eval<S: Scalar>(&self, x: [S; 42]) -> [S; 1] {
        let (t, k) = (x[40], x[41]);
        let mut sum = S::constant(0.0);
        for i in 0..N {
            let (stretch, square) = (x[(i + 1) % N] - x[i], x[i] * x[i]);
            sum =
                sum + k / S::constant(2.0) * stretch * stretch + t.cos() / S::constant(4.0) * square * square;
        }
        [sum]
    }
}

/// The damping of van der Pol, and a force by the velocity of the mass opposite.
struct Damping;

impl Function<80, 40> for Damping {
    fn eval<S: Scalar>(&self, x: [S; 80]) -> [S; 40] {
        std::array::from_fn(|i| {
            (S::constant(1.0) - x[i] * x[i]) * x[N + i] + x[N + (i + 20) % N] * S::constant(0.1)
        })
    }
}

#[derive(Lagrangian)]
#[coordinates(r: [40])]
#[function(U(s: [40], t, k) = springs)]
#[function(F(s: [40], w: [40]): [40] = damping)]
#[lagrangian(m/2*dot(r_dot, r_dot) - U(2*r, t, k))]
#[force(r: F(r, r_dot))]
struct Ring {
    m: f64,
    k: f64,
    springs: Springs,
    damping: Damping,
}

/// The same ring without functions.
#[derive(Lagrangian)]
#[coordinates(r: [40])]
#[lagrangian(m/2*dot(r_dot, r_dot) - sum(i in 0..39, 2*k*(r[i+1] - r[i])^2) - 2*k*(r[0] - r[39])^2 - sum(i in 0..40, 4*cos(t)*r[i]^4))]
#[force(r[i in 0..40]: (1 - r[i]^2)*r_dot[i])]
#[force(r[i in 0..20]: r_dot[i + 20]/10)]
#[force(r[i in 20..40]: r_dot[i - 20]/10)]
struct WrittenOut {
    m: f64,
    k: f64,
}

fn both() -> (Ring, WrittenOut) {
    let (m, k) = (1.3, 0.7);
    (Ring { m, k, springs: Springs, damping: Damping }, WrittenOut { m, k })
}

fn states() -> impl Iterator<Item = State<f64, N>> {
    (1..4).map(|seed| {
        let random = &mut Random(seed);
        State::new(random.vector(), random.vector()).at_time(random.number())
    })
}

#[test]
fn accelerations_and_jacobians_are_those_of_the_ring_written_out() -> Result<(), Error> {
    let (ring, written_out) = both();
    for state in states() {
        let (found, expected) = (ring.jacobian(&state)?, written_out.jacobian(&state)?);
        let (by, wanted) = (found.accelerations, expected.accelerations);
        assert_relative_eq!(found.solution.accelerations, expected.solution.accelerations, epsilon = 1e-12);
        assert_relative_eq!(by.t, wanted.t, epsilon = 1e-12);
        assert_relative_eq!(by.q, wanted.q, epsilon = 1e-11);
        assert_relative_eq!(by.v, wanted.v, epsilon = 1e-12);
        assert_relative_eq!(by.parameters, wanted.parameters, epsilon = 1e-11);
    }
    Ok(())
}

#[test]
fn taylor_series_and_implicit_steps_lead_to_the_same_states() -> Result<(), Error> {
    let (ring, written_out) = both();
    let state = states().next().expect("three states");
    let expected = *written_out.integrate(state, 0.02, Dop853::default())?.end().state();
    let by_series = *ring.integrate(state, 0.02, Taylor::with_tolerance(1e-8))?.end().state();
    let implicit = *ring.integrate(state, 0.02, Radau::with_tolerance(1e-8))?.end().state();
    for found in [by_series, implicit] {
        assert_relative_eq!(found.q, expected.q, epsilon = 1e-7);
        assert_relative_eq!(found.v, expected.v, epsilon = 1e-7);
    }
    Ok(())
}
