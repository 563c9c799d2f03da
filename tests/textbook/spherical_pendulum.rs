//! The spherical pendulum in Cartesian coordinates with its multiplier: Milton (8.11)–(8.22).
//!
//! L = m/2 (ẋ² + ẏ² + ż²) − m g z with Φ = ½(x² + y² + z² − l²) = 0. The force of the string is λ r, so its
//! outward component is λ l and the tension −λ l.

use approx::assert_abs_diff_eq;
use lagrange_core::{Method, prelude::*};

#[derive(Lagrangian, Clone)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
#[constraint(string: (x^2 + y^2 + z^2 - l^2)/2 = 0)]
#[observable(tension = -lambda(string) * l)]
#[observable(l_z = m * (x*y_dot - y*x_dot))]
#[observable(total_energy = m/2 * (x_dot^2 + y_dot^2 + z_dot^2) + m*g*z)]
struct Pendulum {
    m: f64,
    g: f64,
    l: f64,
}

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

const PENDULUM: Pendulum = Pendulum { m: 1.3, g: 9.81, l: 1.0 };

fn residual_and_rate(sample: &State<f64, 3>) -> [f64; 2] {
    [PENDULUM.constraint_residual(sample)[0].abs(), PENDULUM.constraint_rate(sample)[0].abs()]
}

/// m r̈ = −m g e_z + λ r and r·r̈ + ṙ² = 0, every row at random states.
#[test]
fn equations_8_14_at_random_states() {
    let mut seed = 7_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    for _ in 0..1000 {
        let pendulum = Pendulum { m: 1.5 + random(), g: 10.0 + random(), l: 1.5 + random() };
        let state = State::new([random(), random(), random()], [random(), random(), random()]);
        let solution = pendulum.solve(&state).unwrap();
        let (a, lambda) = (solution.accelerations, solution.multipliers[0]);
        let gravity = [0.0, 0.0, -pendulum.m * pendulum.g];
        for i in 0..3 {
            let [inertia, string] = [pendulum.m * a[i], lambda * state.q[i]];
            let largest = inertia.abs().max(string.abs()).max(gravity[i].abs());
            assert!((inertia - string - gravity[i]).abs() <= 1e-13 * largest, "row {i} at {state:?}");
        }
        let [centripetal, square] = [state.q.dot(&a), state.v.dot(&state.v)];
        assert!((centripetal + square).abs() <= 1e-13 * (state.q.norm() * a.norm()).max(square));
    }
}

/// Over 100 s: the constraints, the energy (8.17), L_z (8.15) and the string's force (8.20).
fn check_motion<P: Method<Pendulum> + Copy>(method: P, drift: f64) {
    for start in starts(PENDULUM.l) {
        let path = PENDULUM.integrate(start, 100.0, method).expect("a consistent start");
        assert!(path.ending().is_complete(), "{}", path.ending());
        let speed = (2.0 * PENDULUM.g * PENDULUM.l).sqrt();
        let scale = [PENDULUM.l * PENDULUM.l, PENDULUM.l * speed];
        for sample in path.steps() {
            let worst = residual_and_rate(sample.state());
            assert!(worst[0] < 1e-12 * scale[0] && worst[1] < 1e-12 * scale[1], "{worst:?}");
        }
        let kinetic = PENDULUM.m / 2.0 * start.v.norm_squared();
        let energy_scale = kinetic + PENDULUM.m * PENDULUM.g * PENDULUM.l;
        let initial = [PENDULUM.total_energy(&start), PENDULUM.l_z(&start)];
        for sample in path.samples(20_001) {
            let s = sample.state();
            let worst = residual_and_rate(s);
            assert!(worst[0] < 1e-9 * scale[0] && worst[1] < 1e-9 * scale[1], "between steps {worst:?}");
            assert_abs_diff_eq!(PENDULUM.total_energy(s), initial[0], epsilon = drift * energy_scale);
            let l_z_scale = PENDULUM.m * PENDULUM.l * speed;
            assert_abs_diff_eq!(PENDULUM.l_z(s), initial[1], epsilon = drift * l_z_scale);
            let outward = PENDULUM.m / PENDULUM.l * (PENDULUM.g * s.q[2] - s.v.norm_squared());
            let lambda = sample.multiplier("string").expect("one solution");
            assert_abs_diff_eq!(lambda * PENDULUM.l, outward, epsilon = 1e-10 * energy_scale / PENDULUM.l);
        }
    }
}

#[test]
fn motion_by_dop853_at_1e_10() {
    check_motion(Dop853::with_tolerance(1e-10), 2e-8);
}

#[test]
fn motion_by_dop853_at_1e_12() {
    check_motion(Dop853::with_tolerance(1e-12), 1e-10);
}

#[test]
fn motion_by_dopri5_at_1e_10() {
    check_motion(Dopri5::with_tolerance(1e-10), 1e-7);
}

/// λ l = (3 m g z − 2 E)/l, Milton (8.22), and the tension is positive where the string pulls.
#[test]
fn force_of_the_string_from_the_energy_8_22() {
    let start = starts(PENDULUM.l)[1];
    let path = PENDULUM.integrate(start, 10.0, Dop853::with_tolerance(1e-12)).unwrap();
    let energy = PENDULUM.total_energy(&start);
    for sample in path.samples(100) {
        let z = sample.coordinate("z").unwrap();
        let outward = (3.0 * PENDULUM.m * PENDULUM.g * z - 2.0 * energy) / PENDULUM.l;
        assert_abs_diff_eq!(sample.observable("tension").unwrap(), -outward, epsilon = 1e-9);
    }
}
