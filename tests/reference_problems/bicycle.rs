//! The benchmark bicycle (J. P. Meijaard, J. M. Papadopoulos, A. Ruina and A. L. Schwab, "Linearized dynamics equations for the balance
//! and steer of a bicycle: a benchmark and review", *Proceedings of the Royal Society A* 463, 2007) from a nonlinear model: eight
//! coordinates, one holonomic and four rolling constraints.
//!
//! x points ahead, y to the right, z down; points are given by their places in the upright bicycle, from the rear contact. The model
//! is stated twice, by frames and by rotation matrices, which the macro differentiates in different ways. The linear equations of
//! lean and steer follow from the emitted derivatives. Reference values were recomputed with 25 digits; of those published, all agree
//! but the last digits of the weave and capsize speeds.

use lagrange_core::nalgebra::{Complex, Const, Matrix2, Matrix2x4, Matrix3, Matrix4, SMatrix, Vector3};
use lagrange_core::prelude::*;

use crate::reference::{Known, assert_relative, table};

/// Declares the parameters of the benchmark for a model of this name.
macro_rules! bicycle {
    ($(#[$attribute:meta])* $name:ident) => {
        $(#[$attribute])*
        struct $name {
            base: f64,
            trail: f64,
            tilt: f64,
            g: f64,
            rear_radius: f64,
            rear_mass: f64,
            rear_across: f64,
            rear_along: f64,
            body_mass: f64,
            body_centre: Vector3<f64>,
            body_inertia: Matrix3<f64>,
            fork_mass: f64,
            fork_centre: Vector3<f64>,
            fork_inertia: Matrix3<f64>,
            front_radius: f64,
            front_mass: f64,
            front_across: f64,
            front_along: f64,
        }

        impl $name {
            fn benchmark() -> Self {
                let half =
                    |xx: f64, yy: f64, zz: f64, xz: f64| Matrix3::new(xx, 0.0, xz, 0.0, yy, 0.0, xz, 0.0, zz);
                Self {
                    base: 1.02,
                    trail: 0.08,
                    tilt: std::f64::consts::PI / 10.0,
                    g: G,
                    rear_radius: REAR_RADIUS,
                    rear_mass: 2.0,
                    rear_across: 0.0603,
                    rear_along: 0.12,
                    body_mass: 85.0,
                    body_centre: Vector3::new(0.3, 0.0, -0.9),
                    body_inertia: half(9.2, 11.0, 2.8, 2.4),
                    fork_mass: 4.0,
                    fork_centre: Vector3::new(0.9, 0.0, -0.7),
                    fork_inertia: half(0.058_92, 0.06, 0.007_08, -0.007_56),
                    front_radius: FRONT_RADIUS,
                    front_mass: 3.0,
                    front_across: 0.1405,
                    front_along: 0.28,
                }
            }
        }
    };
}

const G: f64 = 9.81;
const REAR_RADIUS: f64 = 0.3;
const FRONT_RADIUS: f64 = 0.35;

bicycle! {
    /// By frames. `upright` yaws and rolls about the rear contact, and does not pitch; the rear wheel turns in it.
    #[derive(Lagrangian)]
    #[coordinates(x, y, yaw, roll, pitch, steer, rear, front)]
    #[parameter(body_inertia: symmetric)]
    #[parameter(fork_inertia: symmetric)]
    #[frame(upright: translate([x, y, 0]), rotate_z(yaw), rotate_x(roll), translate([0, 0, -rear_radius]))]
    #[frame(body in upright: rotate_y(pitch), translate([0, 0, rear_radius]))]
    #[frame(rear_wheel in upright: rotate_y(rear))]
    #[frame(fork in body: translate([base + trail, 0, 0]), rotate([sin(tilt), 0, cos(tilt)], steer), translate([-base - trail, 0, 0]))]
    #[frame(front_wheel in fork: translate([base, 0, -front_radius]), rotate_y(front))]
    #[define(wheel(across, along) = [[across, 0, 0], [0, along, 0], [0, 0, across]])]
    #[lagrangian(
        kinetic(rear_wheel, rear_mass, [0, 0, 0], wheel(rear_across, rear_along))
        + kinetic(body, body_mass, body_centre, body_inertia)
        + kinetic(fork, fork_mass, fork_centre, fork_inertia)
        + kinetic(front_wheel, front_mass, [0, 0, 0], wheel(front_across, front_along))
        + g*(rear_mass*position(rear_wheel)[2] + body_mass*position(body, body_centre)[2]
            + fork_mass*position(fork, fork_centre)[2] + front_mass*position(front_wheel)[2]))]
    // From the front hub to the lowest point of the wheel: down, less its part along the axle.
    #[define(down = express(vector(fixed, [0, 0, 1]), front_wheel))]
    #[define(front_contact = front_radius/sqrt(1 - down[1]^2)*vector(front_wheel, [down[0], 0, down[2]]))]
    #[define(rear_contact = express(vector(upright, [0, 0, rear_radius]), rear_wheel))]
    #[define(rear_slip = express(velocity(rear_wheel) + cross(angular_velocity(rear_wheel), rear_contact), fixed))]
    #[define(front_slip = express(velocity(front_wheel) + cross(angular_velocity(front_wheel), front_contact), fixed))]
    #[constraint(touches: position(front_wheel)[2] + front_radius*sqrt(1 - down[1]^2) = 0)]
    #[constraint(rear_rolls: [rear_slip[0], rear_slip[1]] = 0)]
    #[constraint(front_rolls: [front_slip[0], front_slip[1]] = 0)]
    ByFrames
}

bicycle! {
    /// By rotation matrices and angular velocities along the fixed axes. Wheels are symmetric about their axles.
    #[derive(Lagrangian)]
    #[coordinates(x, y, yaw, roll, pitch, steer, rear, front)]
    #[parameter(body_inertia: symmetric)]
    #[parameter(fork_inertia: symmetric)]
    #[define(upright = rot_z(yaw)*rot_x(roll))]
    #[define(body = upright*rot_y(pitch))]
    #[define(axis = [sin(tilt), 0, cos(tilt)])]
    #[define(fork = body*rot(axis, steer))]
    #[define(ahead = [base + trail, 0, 0])]
    #[define(rear_hub = [x, y, 0] - rear_radius*(upright*[0, 0, 1]))]
    #[define(in_body(p) = rear_hub + body*(p + [0, 0, rear_radius]))]
    #[define(in_fork(p) = in_body(ahead) + fork*(p - ahead))]
    #[define(front_hub = in_fork([base, 0, -front_radius]))]
    #[define(rear_axle = upright*[0, 1, 0])]
    #[define(front_axle = fork*[0, 1, 0])]
    #[define(turning = yaw_dot*[0, 0, 1] + roll_dot*[cos(yaw), sin(yaw), 0])]
    #[define(body_turning = turning + pitch_dot*rear_axle)]
    #[define(fork_turning = body_turning + steer_dot*(body*axis))]
    #[define(rear_turning = turning + rear_dot*rear_axle)]
    #[define(front_turning = fork_turning + front_dot*front_axle)]
    #[define(moving(m, place) = m/2*dot(der(place), der(place)) + m*g*place[2])]
    #[define(half(inertia, w) = dot(w, inertia*w)/2)]
    #[define(wheel(across, along, axle, w) = across/2*dot(w, w) + (along - across)/2*dot(axle, w)^2)]
    #[lagrangian(
        moving(rear_mass, rear_hub) + wheel(rear_across, rear_along, rear_axle, rear_turning)
        + moving(body_mass, in_body(body_centre)) + half(body_inertia, transpose(body)*body_turning)
        + moving(fork_mass, in_fork(fork_centre)) + half(fork_inertia, transpose(fork)*fork_turning)
        + moving(front_mass, front_hub) + wheel(front_across, front_along, front_axle, front_turning))]
    #[define(rear_slip = der(rear_hub) + rear_radius*cross(rear_turning, upright*[0, 0, 1]))]
    #[define(level = sqrt(1 - front_axle[2]^2))]
    #[define(front_slip = der(front_hub) + front_radius*cross(front_turning, ([0, 0, 1] - front_axle[2]*front_axle)/level))]
    #[constraint(touches: front_hub[2] + front_radius*level = 0)]
    #[constraint(rear_rolls: [rear_slip[0], rear_slip[1]] = 0)]
    #[constraint(front_rolls: [front_slip[0], front_slip[1]] = 0)]
    ByMatrices
}

/// Upright and straight ahead.
fn riding(speed: f64) -> State<f64, 8> {
    let mut v = [0.0; 8];
    (v[0], v[6], v[7]) = (speed, -speed / REAR_RADIUS, -speed / FRONT_RADIUS);
    State::new([0.0; 8], v)
}

const LEAN: usize = 3;
const STEER: usize = 5;
/// Entries of the state that are free on the constraints: lean, steer and their rates, then the place, the direction, the turns of the
/// wheels and the speed.
const FREE: [usize; 10] = [LEAN, STEER, 8 + LEAN, 8 + STEER, 0, 1, 2, 6, 7, 8 + 6];

/// Changes of the state that the constraints allow, one for each of lean, steer and their rates; the place, the direction and the
/// speed stay as they are.
fn changes<L>(bicycle: &L, speed: f64) -> SMatrix<f64, 16, 4>
where
    L: Linearized<N = Const<8>, M = Const<5>, Scalar = f64>,
{
    let basis = bicycle.linearize(&riding(speed), &[]).unwrap().basis;
    let free = basis.select_rows(&FREE).try_inverse().unwrap();
    (basis * free.columns(0, 4)).fixed_view::<16, 4>(0, 0).into()
}

/// The accelerations of lean and steer by lean, steer and their rates.
fn rows<L>(bicycle: &L, speed: f64) -> Matrix2x4<f64>
where
    L: Linearized<N = Const<8>, M = Const<5>, Scalar = f64>,
{
    let (jacobian, changes) = (bicycle.state_jacobian(&riding(speed)).unwrap(), changes(bicycle, speed));
    let by_state = jacobian.accelerations;
    let accelerations = by_state.q * changes.fixed_rows::<8>(0) + by_state.v * changes.fixed_rows::<8>(8);
    accelerations.select_rows(&[LEAN, STEER]).fixed_view::<2, 4>(0, 0).into()
}

/// The system matrix of (lean, steer, their rates).
fn system_matrix<L>(bicycle: &L, speed: f64) -> Matrix4<f64>
where
    L: Linearized<N = Const<8>, M = Const<5>, Scalar = f64>,
{
    let mut matrix = Matrix4::zeros();
    (matrix[(0, 2)], matrix[(1, 3)]) = (1.0, 1.0);
    matrix.fixed_rows_mut::<2>(2).copy_from(&rows(bicycle, speed));
    matrix
}

/// M q̈ + v C₁ q̇ + (g K₀ + v² K₂) q = 0 for q = (lean, steer).
const MASS: [[f64; 2]; 2] =
    [[80.817_22, 2.319_413_322_087_091], [2.319_413_322_087_091, 0.297_841_881_996_855_5]];
const C1: [[f64; 2]; 2] = [[0.0, 33.866_413_914_924_94], [-0.850_356_414_569_784_4, 1.685_403_973_975_596_8]];
const K0: [[f64; 2]; 2] =
    [[-80.95, -2.599_516_852_498_716_4], [-2.599_516_852_498_716_4, -0.803_294_884_586_176_9]];
const K2: [[f64; 2]; 2] = [[0.0, 76.597_345_895_732_22], [0.0, 2.654_315_237_946_04]];

fn matrix(rows: [[f64; 2]; 2]) -> Matrix2<f64> {
    Matrix2::from_fn(|i, j| rows[i][j])
}

fn has_the_rows_of_the_benchmark<L>(bicycle: &L)
where
    L: Linearized<N = Const<8>, M = Const<5>, Scalar = f64>,
{
    let table = Matrix2x4::new(
        9.489_774_446_773_56,
        -19.429_267_311_059_6,
        -0.485_403_269_106_178,
        -1.520_370_835_364_63,
        11.719_476_871_963_3,
        -10.812_737_805_353_4,
        16.913_304_073_279,
        -14.190_381_426_192_3,
    );
    let off = (rows(bicycle, 4.6) - table).amax() / table.amax();
    println!("{}: rows at 4.6 m/s off by {off:.1e}", L::NAME);
    assert!(off < 1e-9, "{}: {}", L::NAME, rows(bicycle, 4.6));
    let inverse = matrix(MASS).try_inverse().unwrap();
    for speed in [0.0, 0.7, 4.6, 9.0] {
        let by_angles = -inverse * (G * matrix(K0) + speed * speed * matrix(K2));
        let by_rates = -inverse * (speed * matrix(C1));
        let expected = Matrix2x4::from_columns(&[
            by_angles.column(0),
            by_angles.column(1),
            by_rates.column(0),
            by_rates.column(1),
        ]);
        let off = (rows(bicycle, speed) - expected).amax() / expected.amax();
        assert!(off < 1e-11, "{} at {speed} m/s: {off:e}", L::NAME);
    }
}

#[test]
fn lean_and_steer_accelerate_as_in_the_benchmark() {
    has_the_rows_of_the_benchmark(&ByFrames::benchmark());
    has_the_rows_of_the_benchmark(&ByMatrices::benchmark());
}

/// The mass matrix of lean and steer, which the rows do not contain.
#[test]
fn lean_and_steer_have_the_masses_of_the_benchmark() {
    let bicycle = ByFrames::benchmark();
    for speed in [0.0, 4.6] {
        let velocities: SMatrix<f64, 8, 2> = changes(&bicycle, speed).fixed_view::<8, 2>(8, 2).into();
        let found = velocities.transpose() * bicycle.mass_matrix(&riding(speed)) * velocities;
        assert!((found - matrix(MASS)).amax() < 1e-11, "{found}");
    }
}

fn eigenvalues(speed: f64) -> Vec<Complex<f64>> {
    system_matrix(&ByFrames::benchmark(), speed).complex_eigenvalues().iter().copied().collect()
}

#[test]
fn the_eigenvalues_from_0_to_10_metres_per_second() {
    let mut largest = 0.0_f64;
    let spectra: Vec<Known<4, 0>> = table!("bicycle");
    for Known { t: speed, q, v, .. } in spectra {
        let mut found = eigenvalues(speed);
        for (re, im) in q.into_iter().zip(v) {
            let expected = Complex::new(re, im);
            let off = |i: usize| (found[i] - expected).norm();
            let nearest = (0..found.len()).min_by(|&i, &j| off(i).total_cmp(&off(j))).unwrap();
            largest = largest.max(off(nearest));
            assert!(off(nearest) < 1e-9, "at {speed} m/s: {} in place of {expected}", found[nearest]);
            found.remove(nearest);
        }
    }
    println!("eigenvalues off by {largest:.1e}");
}

/// A state off the straight ride, on the constraints: leaning, steered and yawing.
const TURNING: [[f64; 8]; 2] = [
    [0.3, -0.2, 0.4, 0.2, -0.004_515_461_794_799_137, 0.3, 0.5, -0.7],
    [
        4.144_774_473_012_983,
        1.752_382_540_388_927_2,
        1.283_340_140_757_516_3,
        0.5,
        0.003_525_742_586_506_513_7,
        -0.8,
        -15.0,
        -13.475_008_065_280_226,
    ],
];

/// Accelerations, multipliers and energy there, computed by `recompute.py bicycle` from L and the constraints, by differences with 60
/// digits.
const ACCELERATIONS: [f64; 8] = [
    -1.407_192_171_918_603,
    5.675_025_024_992_209,
    -2.509_255_723_357_932,
    -2.523_344_945_593_721,
    -0.161_251_367_994_924_7,
    16.842_635_765_259_496,
    -3.046_163_390_573_822,
    0.026_944_109_275_675_238,
];
const MULTIPLIERS: [f64; 5] = [
    -332.430_418_664_392_3,
    -66.108_175_543_391_61,
    153.365_511_910_063_16,
    -43.887_868_116_853_08,
    53.140_677_736_693_05,
];
const ENERGY: f64 = 1_717.288_905_892_992;

fn accelerates_as_known<L>(bicycle: &L)
where
    L: Lagrangian<N = Const<8>, M = Const<5>, Scalar = f64>,
{
    let state = State::new(TURNING[0], TURNING[1]);
    bicycle.check_consistent(&state).unwrap();
    let solution = bicycle.solve(&state).unwrap();
    let found = solution.accelerations.iter().chain(&solution.multipliers);
    for (found, expected) in found.zip(ACCELERATIONS.into_iter().chain(MULTIPLIERS)) {
        let error = (found - expected).abs() / expected.abs();
        assert!(error < 1e-10, "{}: {found} in place of {expected}", L::NAME);
    }
    assert_relative("energy", bicycle.energy(&state), ENERGY, 1e-13);
}

#[test]
fn the_bicycle_accelerates_as_known_in_a_turn() {
    accelerates_as_known(&ByFrames::benchmark());
    accelerates_as_known(&ByMatrices::benchmark());
}
