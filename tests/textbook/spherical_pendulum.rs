//! The spherical pendulum in Cartesian coordinates with its multiplier: Milton (8.11)–(8.22).
//!
//! L = m/2 (ẋ² + ẏ² + ż²) − m g z with Φ = ½(x² + y² + z² − l²) = 0. The force of the string is λ r, so its outward component is λ l and the
//! tension −λ l.

use approx::assert_abs_diff_eq;
use lagrange_core::prelude::*;
use lagrange_random::{Random, cases};
use lagrange_systems::{SphericalPendulum, random_state};

const PENDULUM: SphericalPendulum<f64> = SphericalPendulum { m: 1.3, g: 9.81, l: 1.0 };

/// Nearly in a plane; generic; with the bob above the point of suspension.
fn starts(l: f64) -> [State<f64, 3>; 3] {
    let at = |theta: f64, v: [f64; 3]| State::new([l * theta.sin(), 0.0, -l * theta.cos()], v);
    let above = {
        let mut start = at(2.0, [0.0, 2.5, 0.0]);
        start.v[0] = 0.6 * start.q[2];
        start.v[2] = -0.6 * start.q[0];
        start
    };
    [at(1.2, [0.0, 1e-3, 0.0]), at(std::f64::consts::FRAC_PI_3, [0.0, 1.5 * 0.75_f64.sqrt(), 0.0]), above]
}

/// m r̈ = −m g e_z + λ r and r·r̈ + ṙ² = 0, every row at random states.
#[test]
fn equations_8_14_at_random_states() {
    let mut random = Random(7);
    for _ in 0..cases([200, 1000, 10_000]) {
        let [m, g, l] = random.array(Random::positive);
        let (pendulum, state) = (SphericalPendulum { m, g, l }, random_state::<3>(&mut random));
        let solution = pendulum.solve(&state).unwrap();
        let (a, lambda) = (solution.accelerations, solution.multipliers[0]);
        for (i, gravity) in [0.0, 0.0, -m * g].into_iter().enumerate() {
            let [inertia, string] = [m * a[i], lambda * state.q[i]];
            let largest = inertia.abs().max(string.abs()).max(f64::abs(gravity));
            assert!((inertia - string - gravity).abs() <= 1e-13 * largest, "row {i} at {state:?}");
        }
        let [centripetal, square] = [state.q.dot(&a), state.v.dot(&state.v)];
        assert!((centripetal + square).abs() <= 1e-13 * (state.q.norm() * a.norm()).max(square));
    }
}

/// Over 100 s: the constraints, the energy (8.17), L_z (8.15) and the string's force (8.20), λ l = (3 m g z − 2 E)/l (8.22).
#[test]
fn motion_8_15_to_8_22() {
    let SphericalPendulum { m, g, l } = PENDULUM;
    let speed = (2.0 * g * l).sqrt();
    let off = |s: &State<f64, 3>| [PENDULUM.constraint_residual(s)[0], PENDULUM.constraint_rate(s)[0]];
    let energy = |s: &State<f64, 3>| m / 2.0 * s.v.norm_squared() + m * g * s.q[2];
    let l_z = |s: &State<f64, 3>| m * (s.q[0] * s.v[1] - s.q[1] * s.v[0]);
    let bounds = &[(1e-12, 1e-10), (1e-10, 2e-8)][..cases([1, 2, 2])];
    for (start, &(tolerance, drift)) in
        starts(l).iter().flat_map(|start| bounds.iter().map(move |bound| (start, bound)))
    {
        let path = PENDULUM.integrate(*start, 100.0, Dop853::with_tolerance(tolerance)).unwrap();
        let within = |state: &State<f64, 3>, bound: f64| {
            let [residual, rate] = off(state).map(f64::abs);
            assert!(residual < bound * l * l && rate < bound * l * speed, "{residual:e} {rate:e}");
        };
        path.steps().for_each(|sample| within(sample.state(), 1e-12));
        let energy_scale = m / 2.0 * start.v.norm_squared() + m * g * l;
        for sample in path.samples(cases([1_001, 20_001, 20_001])) {
            let s = sample.state();
            within(s, 1e-9);
            assert_abs_diff_eq!(PENDULUM.energy(s), energy(s), epsilon = 1e-13 * energy_scale);
            assert_abs_diff_eq!(energy(s), energy(start), epsilon = drift * energy_scale);
            assert_abs_diff_eq!(l_z(s), l_z(start), epsilon = drift * m * l * speed);
            let lambda = sample.multiplier("string").unwrap();
            let outward = m / l * (g * s.q[2] - s.v.norm_squared());
            assert_abs_diff_eq!(lambda * l, outward, epsilon = 1e-10 * energy_scale / l);
            let by_energy = (3.0 * m * g * s.q[2] - 2.0 * energy(start)) / l;
            assert_abs_diff_eq!(lambda * l, by_energy, epsilon = 3.0 * drift * energy_scale / l);
        }
    }
}
