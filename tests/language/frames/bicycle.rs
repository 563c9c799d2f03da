//! A bicycle that rolls on two wheels, against the benchmark of J. P. Meijaard, J. M. Papadopoulos, A. Ruina and A. L. Schwab,
//! "Linearized dynamics equations for the balance and steer of a bicycle: a benchmark and review", *Proceedings of the Royal
//! Society A* 463 (2007): its parameters, their canonical matrices, and the eigenvalues.
//!
//! Here nothing is linear, and no contact point is a coordinate: the bodies are frames, the wheels touch the ground, and the
//! material points with which they do are at rest. The linear system about riding straight ahead is [`Linearized::linearize`]'s;
//! lean and steer are what is left of it where place, direction and speed are kept. The axes are those of the paper: x ahead,
//! y to the right, z down, all lengths from the rear contact of the upright bicycle.

use lagrange_core::nalgebra::{Complex, DMatrix, Matrix2, Matrix3, Vector3};
use lagrange_core::{Linearization, prelude::*};

#[derive(Clone, Lagrangian)]
#[coordinates(hub: [3], yaw, lean, pitch, steer, rear, front)]
#[define(down = vector(fixed, [0, 0, 1]))]
#[frame(body: translate(hub), rotate_z(yaw), rotate_x(lean), rotate_y(pitch), translate([0, 0, rear_radius]))]
#[frame(rear_wheel in body: translate([0, 0, -rear_radius]), rotate_y(rear))]
#[frame(fork in body: translate([base + trail, 0, 0]), rotate([sin(tilt), 0, cos(tilt)], steer), translate([-base - trail, 0, 0]))]
#[frame(front_wheel in fork: translate([base, 0, -front_radius]), rotate_y(front))]
#[define(rear_down = express(down, rear_wheel))]
#[define(front_down = express(down, front_wheel))]
// From the hub to the lowest point: down, less what of it is along the axle.
#[define(rear_contact = rear_radius/sqrt(1 - rear_down[1]^2)*vector(rear_wheel, [rear_down[0], 0, rear_down[2]]))]
#[define(front_contact = front_radius/sqrt(1 - front_down[1]^2)*vector(front_wheel, [front_down[0], 0, front_down[2]]))]
#[lagrangian(
    kinetic(rear_wheel, rear_mass, [0, 0, 0], rear_inertia) + kinetic(body, body_mass, body_centre, body_inertia)
    + kinetic(fork, fork_mass, fork_centre, fork_inertia) + kinetic(front_wheel, front_mass, [0, 0, 0], front_inertia)
    + g*(rear_mass*position(rear_wheel)[2] + body_mass*position(body, body_centre)[2]
        + fork_mass*position(fork, fork_centre)[2] + front_mass*position(front_wheel)[2]))]
#[constraint(rear_touches: position(rear_wheel)[2] + rear_radius*sqrt(1 - rear_down[1]^2) = 0)]
#[constraint(front_touches: position(front_wheel)[2] + front_radius*sqrt(1 - front_down[1]^2) = 0)]
// Of a point that stays where it is in the wheel; `velocity(rear_wheel, rear_contact)` is that of the contact, which wanders.
#[define(rear_slip = express(velocity(rear_wheel) + cross(angular_velocity(rear_wheel), rear_contact), fixed))]
#[define(front_slip = express(velocity(front_wheel) + cross(angular_velocity(front_wheel), front_contact), fixed))]
#[constraint(rear_rolls: [rear_slip[0], rear_slip[1]] = 0)]
#[constraint(front_rolls: [front_slip[0], front_slip[1]] = 0)]
struct Bicycle {
    base: f64,
    trail: f64,
    tilt: f64,
    g: f64,
    rear_radius: f64,
    rear_mass: f64,
    rear_inertia: Matrix3<f64>,
    body_mass: f64,
    body_centre: Vector3<f64>,
    body_inertia: Matrix3<f64>,
    fork_mass: f64,
    fork_centre: Vector3<f64>,
    fork_inertia: Matrix3<f64>,
    front_radius: f64,
    front_mass: f64,
    front_inertia: Matrix3<f64>,
}

/// The benchmark's parameters.
fn bicycle() -> Bicycle {
    let wheel = |xx: f64, yy: f64| Matrix3::from_diagonal(&Vector3::new(xx, yy, xx));
    let half = |xx: f64, yy: f64, zz: f64, xz: f64| Matrix3::new(xx, 0.0, xz, 0.0, yy, 0.0, xz, 0.0, zz);
    Bicycle {
        base: 1.02,
        trail: 0.08,
        tilt: core::f64::consts::PI / 10.0,
        g: 9.81,
        rear_radius: 0.3,
        rear_mass: 2.0,
        rear_inertia: wheel(0.0603, 0.12),
        body_mass: 85.0,
        body_centre: Vector3::new(0.3, 0.0, -0.9),
        body_inertia: half(9.2, 11.0, 2.8, 2.4),
        fork_mass: 4.0,
        fork_centre: Vector3::new(0.9, 0.0, -0.7),
        fork_inertia: half(0.05892, 0.06, 0.00708, -0.00756),
        front_radius: 0.35,
        front_mass: 3.0,
        front_inertia: wheel(0.1405, 0.28),
    }
}

/// Upright and straight ahead.
fn riding(speed: f64) -> State<f64, 9> {
    let [q, mut v] = [[0.0, 0.0, -0.3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0; 9]];
    (v[0], v[7], v[8]) = (speed, -speed / 0.3, -speed / 0.35);
    State::new(q, v)
}

const LEAN: usize = 4;
const STEER: usize = 6;
/// The entries of coordinates and velocities that are free: what the others are, the constraints say.
const FREE: [usize; 10] = [LEAN, STEER, 9 + LEAN, 9 + STEER, 0, 1, 3, 7, 8, 9 + 7];

/// Changes of coordinates and velocities that the constraints allow, one for each of lean, steer and their rates, while place,
/// direction and speed are what they are; and the rates at which all these change then.
fn changes(near: &Linearization<f64>) -> [DMatrix<f64>; 2] {
    let free = near.basis.select_rows(&FREE).try_inverse().unwrap();
    let change = &near.basis * free.columns(0, 4);
    [change, &near.basis * &near.a * free.columns(0, 4)]
}

/// M, and what stands with q and q̇ in M q̈ + C q̇ + K q = 0 for q = (lean, steer): M by the kinetic energy of the
/// velocities that the wheels allow, the others by the forces M q̈ along them.
fn canonical(speed: f64) -> [Matrix2<f64>; 3] {
    let (bicycle, state) = (bicycle(), riding(speed));
    let [change, rate] = changes(&bicycle.linearize(&state, &[]).unwrap());
    let velocities = change.view((9, 2), (9, 2));
    let mass: Matrix2<f64> =
        (velocities.transpose() * bicycle.mass_matrix(&state) * velocities).fixed_view::<2, 2>(0, 0).into();
    let accelerations = rate.select_rows(&[9 + LEAN, 9 + STEER]);
    let force = |column| -mass * accelerations.fixed_view::<2, 2>(0, column);
    [mass, force(2), force(0)]
}

fn assert_close(found: Matrix2<f64>, expected: Matrix2<f64>) {
    let error = (found - expected).amax() / expected.amax();
    assert!(error < 1e-12, "off by {error:e}: {found}, expected {expected}");
}

#[test]
fn lean_and_steer_have_the_equations_of_the_benchmark() {
    let mass = Matrix2::new(80.81722, 2.319_413_322_087_09, 2.319_413_322_087_09, 0.297_841_881_996_86);
    let c1 = Matrix2::new(0.0, 33.866_413_914_924_94, -0.850_356_414_569_78, 1.685_403_973_975_60);
    let k0 = Matrix2::new(-80.95, -2.599_516_852_498_72, -2.599_516_852_498_72, -0.803_294_884_586_18);
    let k2 = Matrix2::new(0.0, 76.597_345_895_732_22, 0.0, 2.654_315_237_946_04);
    let [found, damping, stiffness] = canonical(0.0);
    assert_close(found, mass);
    assert!(damping.amax() < 1e-12, "{damping}");
    assert_close(stiffness / 9.81, k0);
    for speed in [0.7, 4.6, 9.0] {
        let [found, damping, stiffness] = canonical(speed);
        assert_close(found, mass);
        assert_close(damping / speed, c1);
        assert_close((stiffness - 9.81 * k0) / (speed * speed), k2);
    }
}

/// The eigenvalues at 0, 4, 5 and 10 m/s, and where the weave becomes stable.
const SPECTRA: [(f64, [[f64; 2]; 4]); 5] = [
    (
        0.0,
        [
            [-5.530_943_717_653_93, 0.0],
            [-3.131_643_247_906_56, 0.0],
            [3.131_643_247_906_56, 0.0],
            [5.530_943_717_653_93, 0.0],
        ],
    ),
    (
        4.0,
        [
            [-12.158_614_265_764_47, 0.0],
            [-1.429_444_273_613_26, 0.0],
            [0.413_253_315_211_25, 3.079_108_186_032_06],
            [0.413_253_315_211_25, -3.079_108_186_032_06],
        ],
    ),
    (
        4.292_382_536_341_11,
        [
            [-12.709_441_052_374_7, 0.0],
            [-0.984_924_585_277_745, 0.0],
            [0.0, 3.435_033_848_661_44],
            [0.0, -3.435_033_848_661_44],
        ],
    ),
    (
        5.0,
        [
            [-14.078_389_692_798_22, 0.0],
            [-0.322_866_429_004_09, 0.0],
            [-0.775_341_882_195_85, 4.464_867_713_788_23],
            [-0.775_341_882_195_85, -4.464_867_713_788_23],
        ],
    ),
    (
        10.0,
        [
            [-24.624_596_350_174_04, 0.0],
            [0.161_053_386_531_72, 0.0],
            [-3.720_168_404_372_87, 10.906_811_394_762_87],
            [-3.720_168_404_372_87, -10.906_811_394_762_87],
        ],
    ),
];

/// Beside these, place, direction, speed and the angles of the wheels are free: six times zero, in blocks, so that round-off
/// moves them by its root.
#[test]
fn weave_capsize_and_caster_are_those_of_the_benchmark() {
    for (speed, expected) in SPECTRA {
        let mut found = bicycle().linearize(&riding(speed), &[]).unwrap().eigenvalues().unwrap();
        let size = expected[0][0].abs();
        for [re, im] in expected {
            let expected = Complex::new(re, im);
            let off = |i: usize| (found[i] - expected).norm();
            let nearest = (0..found.len()).min_by(|&i, &j| off(i).total_cmp(&off(j))).unwrap();
            assert!(off(nearest) < 1e-12 * size, "at {speed} m/s: {} in place of {expected}", found[nearest]);
            found.remove(nearest);
        }
        assert_eq!(found.len(), 6);
        assert!(found.iter().all(|s| s.norm() < 1e-4), "{found:?}");
    }
}
