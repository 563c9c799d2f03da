//! Frames that are led through isometries, against nalgebra's.

use lagrange_core::nalgebra::{
    Isometry3, IsometryMatrix3, Matrix3, Point3, Translation3, UnitQuaternion, Vector3,
};
use lagrange_core::prelude::*;
use lagrange_core::{Lanes, Pack};

/// A base, three joints in places of all kinds, and a tool in a mount.
#[derive(Lagrangian, Clone)]
#[coordinates(q: [3])]
#[parameter(mount: {m, place: pose})]
#[frame(ground: pose(base))]
#[frame(link[0] in ground: rotate_z(q[0]), pose(place[0]))]
#[frame(link[i in 1..3] in link[i-1]: rotate_z(q[i]), pose(place[i]))]
#[frame(hand in link[2]: pose(mount.place), pose(grip))]
#[lagrangian(sum(i in 0..3, kinetic(link[i], mount.m, at, inertia)) + kinetic(hand, mount.m, at) - g*position(hand, at)[2])]
#[observable(tool = position(hand, at))]
#[observable(speed = velocity(hand, at))]
#[observable(across = express(vector(hand, at), fixed))]
#[observable(by_parts = base.translation + quat_rotate(base.rotation, at))]
#[observable(turned = grip.rotation*at)]
struct Machine<T> {
    base: Isometry3<T>,
    place: [Isometry3<T>; 3],
    mount: Mount<T>,
    grip: IsometryMatrix3<T>,
    at: Vector3<T>,
    inertia: Matrix3<T>,
    g: T,
}

#[derive(Clone)]
struct Mount<T> {
    m: T,
    place: Isometry3<T>,
}

fn pose(k: usize) -> Isometry3<f64> {
    let vector = |from: usize| Vector3::from_fn(|i, _| ((k * 5 + from + i) as f64 * 0.618).fract() - 0.4);
    Isometry3::new(vector(1), 4.0 * vector(7))
}

fn machine() -> Machine<f64> {
    let grip = pose(9);
    Machine {
        base: pose(1),
        place: [2, 3, 4].map(pose),
        mount: Mount { m: 2.0, place: pose(5) },
        grip: IsometryMatrix3::from_parts(grip.translation, grip.rotation.to_rotation_matrix()),
        at: Vector3::new(0.3, -0.2, 0.5),
        inertia: Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.5)),
        g: 9.81,
    }
}

/// What leads from the hand to the fixed frame, multiplied by nalgebra.
fn hand(machine: &Machine<f64>, q: [f64; 3]) -> Isometry3<f64> {
    let turn = |angle: f64| {
        Isometry3::from_parts(
            Translation3::identity(),
            UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle),
        )
    };
    let joints = (0..3).fold(machine.base, |pose, i| pose * turn(q[i]) * machine.place[i]);
    let IsometryMatrix3 { translation, rotation } = machine.grip;
    joints
        * machine.mount.place
        * Isometry3::from_parts(translation, UnitQuaternion::from_rotation_matrix(&rotation))
}

const Q: [f64; 3] = [0.4, -1.1, 2.3];
const V: [f64; 3] = [0.7, 1.3, -0.6];

#[test]
fn a_point_goes_where_the_isometry_takes_it() {
    let (machine, state) = (machine(), State::new(Q, V));
    let point = Point3::from(machine.at);
    assert!((machine.tool(&state) - (hand(&machine, Q) * point).coords).norm() < 1e-14);
    assert!((machine.across(&state) - hand(&machine, Q) * machine.at).norm() < 1e-14);
    assert!((machine.by_parts(&state) - (machine.base * point).coords).norm() < 1e-15);
    assert!((machine.turned(&state) - machine.grip.rotation * machine.at).norm() < 1e-15);
}

/// Along the axes of the hand, against differences of the products.
#[test]
fn its_velocity_is_the_rate_of_its_place() {
    let (machine, h) = (machine(), 1e-3);
    let at = |t: f64| (hand(&machine, [0, 1, 2].map(|i| Q[i] + V[i] * t)) * Point3::from(machine.at)).coords;
    let rate = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
    let speed = machine.speed(&State::new(Q, V));
    assert!((hand(&machine, Q) * speed - rate).norm() < 1e-10, "{speed} instead of {rate}");
}

/// Of a pose the translation can be changed, the rotation only as a whole.
#[test]
fn poses_are_parameters() {
    let mut machine = machine();
    let names = Machine::<f64>::PARAMETERS;
    let place = |name: &str| names.iter().position(|known| *known == name).unwrap();
    let translation = place("place[1].translation[2]");
    let jacobian = machine.jacobian(&State::new(Q, V)).unwrap().accelerations.parameters;
    let accelerations = |machine: &Machine<f64>| machine.solve(&State::new(Q, V)).unwrap().accelerations;
    let moved = |by: f64| {
        let mut machine = machine.clone();
        machine.place[1].translation.z += by;
        accelerations(&machine)
    };
    let difference = (moved(1e-4) - moved(-1e-4)) / 2e-4;
    let by = jacobian.column(translation);
    assert!((by - difference).norm() < 1e-6 && difference.norm() > 1e-3, "{by} instead of {difference}");
    assert!(machine.set_parameter(translation, 7.0) && machine.place[1].translation.z == 7.0);
    let fixed =
        ["base.rotation[0]", "grip.rotation[1][1]", "mount.place.translation[0]", "mount.place.rotation[3]"];
    assert!(fixed.iter().all(|name| !machine.set_parameter(place(name), 7.0)));
}

#[test]
fn poses_lie_on_lanes() {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[frame(hand: pose(place[0]), pose(place[1]), translate([x, 0, 0]))]
    #[lagrangian(x_dot^2/2 - position(hand)[2])]
    struct Rail<T> {
        place: [Isometry3<T>; 2],
    }
    let rails = [1, 2].map(|k| Rail { place: [pose(k), pose(k + 1)] });
    let mut packed: Rail<Lanes> = rails[0].pack();
    assert!(rails[1].place(&mut packed, 3));
    let found =
        packed.accelerations_unchecked(&State::at_rest([Lanes::constant(0.3)])).accelerations[0].to_array();
    for (lane, found) in found.into_iter().enumerate() {
        let Rail { place: [a, b] } = &rails[usize::from(lane == 3)];
        // The slope of the rail.
        let expected = -(a * b * Vector3::x()).z;
        assert!((found - expected).abs() < 1e-14, "lane {lane}: {found} instead of {expected}");
    }
}

/// Its rotation is one by its type, and random checks draw it so.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[define(x = place.translation + quat_rotate(place.rotation, r))]
#[define(y = mirror.rotation*r)]
#[lagrangian(dot(der(x), der(x))/2 + dot(der(y), der(y))/2 - k/dot(r, r))]
#[conserved(spin = cross(r, r_dot))]
struct Turned {
    place: Isometry3<f64>,
    mirror: IsometryMatrix3<f64>,
    k: f64,
}

#[test]
fn random_checks_draw_poses() {
    let names: Vec<&str> = Turned::FACTS.conserved.iter().map(|found| found.name).collect();
    assert!(["spin[0]", "spin[1]", "spin[2]"].iter().all(|name| names.contains(name)), "{names:?}");
}
