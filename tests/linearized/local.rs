//! Local coordinates: rotations in the place of quaternions.

use lagrange_core::nalgebra::{DMatrix, DVector, Quaternion, UnitQuaternion, Vector3, Vector4};
use lagrange_core::prelude::*;
use lagrange_systems::DrivenSpring;

/// A body that floats, with a motor, two links, and another body on a ball joint.
#[derive(Clone, Lagrangian)]
#[coordinates(place: [3], turn: [4], q: [2], ball: [4])]
#[frame(base: translate(place), rotate(turn))]
#[frame(upper in base: translate([0.3, 0.1, 0]), rotate_x(q[0]))]
#[frame(lower in upper: translate([0, 0, -0.5]), rotate_y(q[1]))]
#[frame(head in base: translate([0, -0.2, 0.4]), rotate(ball))]
#[lagrangian(
    kinetic(base, m, [0.02, 0, 0.01], [[0.5, 0.02, 0], [0.02, 0.7, 0], [0, 0, 0.9]]) - m*g*place[2]
    + kinetic(upper, 1, [0, 0, -0.2], [[0.03, 0, 0], [0, 0.04, 0], [0, 0, 0.01]]) - g*position(upper, [0, 0, -0.2])[2]
    + kinetic(lower, 0.7, [0, 0, -0.3], [[0.02, 0, 0], [0, 0.02, 0], [0, 0, 0.01]]) - 0.7*g*position(lower, [0, 0, -0.3])[2]
    + kinetic(head, 0.4, [0.05, 0, 0.1], [[0.01, 0, 0], [0, 0.02, 0], [0, 0, 0.03]]) - 0.4*g*position(head, [0.05, 0, 0.1])[2]
)]
#[dissipation(c/2*(q_dot[0]^2 + q_dot[1]^2))]
#[force(q: torque)]
pub(crate) struct Walker {
    m: f64,
    g: f64,
    c: f64,
    torque: [f64; 2],
}

pub(crate) const WALKER: Walker = Walker { m: 3.0, g: 9.81, c: 0.2, torque: [0.5, -1.0] };

/// Places in local coordinates, with the orientations themselves.
#[derive(Clone, Copy)]
pub(crate) struct Pose {
    place: Vector3<f64>,
    turn: UnitQuaternion<f64>,
    q: [f64; 2],
    ball: UnitQuaternion<f64>,
    /// Rates of the local coordinates: ω in the place of rates of orientations.
    rates: [f64; 11],
}

fn wxyz(q: &Quaternion<f64>) -> [f64; 4] {
    [q.w, q.i, q.j, q.k]
}

impl Pose {
    pub(crate) fn state(&self) -> State<f64, 13> {
        let of = |first: usize| Vector3::from_column_slice(&self.rates[first..first + 3]);
        let rate = |turn: &UnitQuaternion<f64>, omega: Vector3<f64>| {
            wxyz(&(turn.into_inner() * Quaternion::from_imag(omega * 0.5)))
        };
        let mut q = self.place.as_slice().to_vec();
        q.extend(wxyz(&self.turn));
        q.extend(self.q);
        q.extend(wxyz(&self.ball));
        let mut v = self.rates[..3].to_vec();
        v.extend(rate(&self.turn, of(3)));
        v.extend(&self.rates[6..8]);
        v.extend(rate(&self.ball, of(8)));
        State::new(core::array::from_fn(|i| q[i]), core::array::from_fn(|i| v[i]))
    }

    /// Moved along local coordinate `j`.
    fn moved(&self, j: usize, by: f64) -> Self {
        let mut moved = *self;
        let turned = |first: usize| {
            let mut axis = Vector3::zeros();
            axis[j - first] = by;
            UnitQuaternion::from_scaled_axis(axis)
        };
        match j {
            0..3 => moved.place[j] += by,
            3..6 => moved.turn *= turned(3),
            6..8 => moved.q[j - 6] += by,
            8..11 => moved.ball *= turned(8),
            _ => moved.rates[j - 11] += by,
        }
        moved
    }

    /// Accelerations: v̇, ω̇ = vector part of 2 Q̄ ⊗ Q̈, q̈, ω̇.
    fn accelerations(&self, walker: &Walker) -> DVector<f64> {
        let all = walker.solve(&self.state()).unwrap().accelerations;
        let omega_dot = |turn: &UnitQuaternion<f64>, first: usize| {
            let second = Quaternion::new(all[first], all[first + 1], all[first + 2], all[first + 3]);
            let product = turn.into_inner().conjugate() * second;
            (product.imag() * 2.0).as_slice().to_vec()
        };
        let mut found = all.as_slice()[..3].to_vec();
        found.extend(omega_dot(&self.turn, 3));
        found.extend(&all.as_slice()[7..9]);
        found.extend(omega_dot(&self.ball, 9));
        DVector::from_vec(found)
    }
}

pub(crate) fn pose() -> Pose {
    let turn =
        |x: f64, y: f64, z: f64, w: f64| UnitQuaternion::from_quaternion(Vector4::new(x, y, z, w).into());
    Pose {
        place: Vector3::new(0.3, -0.2, 1.0),
        turn: turn(0.3, -0.5, 0.7, 0.2),
        q: [0.4, -0.9],
        ball: turn(-0.1, 0.6, 0.2, 0.9),
        rates: [0.5, -0.3, 0.8, 1.1, -0.7, 0.4, 0.9, -1.3, 0.6, 1.7, -0.5],
    }
}

/// The central difference of sixth order.
fn difference(of: impl Fn(f64) -> DVector<f64>) -> DVector<f64> {
    let step = 1e-2;
    let pairs = [(1.0, 0.75), (2.0, -0.15), (3.0, 1.0 / 60.0)];
    pairs.into_iter().map(|(k, c)| (of(k * step) - of(-k * step)) * (c / step)).reduce(|a, b| a + b).unwrap()
}

#[test]
fn names_are_those_of_rotations_and_coordinates() {
    let near = WALKER.linearize_locally(&pose().state(), &["torque"]).unwrap();
    let names =
        ["place[0]", "place[1]", "place[2]", "rotation(turn)[0]", "rotation(turn)[1]", "rotation(turn)[2]"];
    assert_eq!(near.states()[..6], names);
    let names = ["q[0]", "q[1]", "rotation(ball)[0]", "rotation(ball)[1]", "rotation(ball)[2]"];
    assert_eq!(near.states()[6..11], names);
    assert_eq!(near.states()[11..15], ["place_dot[0]", "place_dot[1]", "place_dot[2]", "omega(turn)[0]"]);
    assert_eq!(
        near.states()[17..],
        ["q_dot[0]", "q_dot[1]", "omega(ball)[0]", "omega(ball)[1]", "omega(ball)[2]"]
    );
    assert_eq!(near.inputs(), ["torque[0]", "torque[1]"]);
    assert_eq!((near.a.shape(), near.b.shape(), near.basis.shape()), ((22, 22), (22, 2), (26, 22)));
}

/// The accelerations along turning axes, where orientations are multiplied by small rotations.
#[test]
fn accelerations_change_as_those_of_states_that_are_turned() {
    let pose = pose();
    let near = WALKER.linearize_locally(&pose.state(), &["torque"]).unwrap();
    for j in 0..22 {
        let exact = difference(|by| pose.moved(j, by).accelerations(&WALKER));
        let off = (near.a.view((11, j), (11, 1)) - &exact).amax();
        assert!(
            off < 1e-8 * exact.amax().max(1.0),
            "{}: off by {off:e} of {:e}",
            near.states()[j],
            exact.amax()
        );
    }
    for j in 0..2 {
        let exact = difference(|by| {
            let mut walker = WALKER;
            walker.torque[j] += by;
            pose.accelerations(&walker)
        });
        assert!((near.b.view((11, j), (11, 1)) - &exact).amax() < 1e-10 * exact.amax());
        assert_eq!(near.b.view((0, j), (11, 1)).amax(), 0.0);
    }
}

#[test]
fn basis_and_inverse_belong_together() {
    let local = WALKER.local_coordinates(&pose().state()).unwrap();
    assert!((local.inverse() * local.basis() - DMatrix::identity(22, 22)).amax() < 1e-15);
    assert_eq!(local.names().len(), 22);
    let mut long = pose().state();
    long.q[3] += 1e-3;
    let error = WALKER.local_coordinates(&long).unwrap_err().to_string();
    assert!(error.contains("`turn`"), "{error}");
    assert!(WALKER.linearize_locally(&long, &[]).is_err());
    let error = WALKER.linearize_locally(&pose().state(), &["pull"]).unwrap_err().to_string();
    assert!(error.contains("`pull`"), "{error}");
    // Without quaternions it is the linear system as before.
    let springs = DrivenSpring { m: 1.0, k: 2.0, c: 0.0, a: 0.0, w: 0.0 };
    let state = State::new([0.3], [0.1]);
    let (local, plain) =
        (springs.linearize_locally(&state, &["k"]).unwrap(), springs.linearize(&state, &["k"]).unwrap());
    assert_eq!(local, plain);
}

/// Rotations of any size, against the exponential of nalgebra.
#[test]
fn changes_are_rotations_of_any_size() {
    let half_turn = std::f64::consts::PI;
    for size in [0.0, 1e-200, 1e-160, 1e-12, 1e-3, 1.0, 3.0, half_turn - 1e-9] {
        let mut there = pose();
        let change = Vector3::new(0.6, -0.64, 0.48) * size;
        there.turn *= UnitQuaternion::from_scaled_axis(change);
        there.rates[3] += size;
        there.q[1] -= 2.0 * size;
        let (from, mut to) = (pose().state(), there.state());
        for sign in [1.0, -1.0] {
            // Q and −Q are one orientation.
            for k in 3..7 {
                (to.q[k], to.v[k]) = (sign * to.q[k], sign * to.v[k]);
            }
            let z = WALKER.local_change(&from, &to).unwrap();
            let mut expected = DVector::zeros(22);
            expected.rows_mut(3, 3).copy_from(&change);
            (expected[7], expected[14]) = (-2.0 * size, size);
            assert!((&z - expected).amax() < 3e-15, "{size:e}: {z}");
            let back = WALKER.locally_changed(&from, z.as_slice()).unwrap();
            assert!((back.q - there.state().q).amax() < 3e-15 && (back.v - there.state().v).amax() < 3e-15);
        }
    }
    // Rotations down to the smallest are found to their last digits.
    let state = pose().state();
    let mut tiny = [0.0; 22];
    tiny[3] = 1e-9;
    let near = WALKER.locally_changed(&state, &tiny).unwrap();
    let basis = WALKER.local_coordinates(&state).unwrap().basis().clone();
    let change = near.q - state.q;
    assert!((0..13).all(|i| (change[i] - 1e-9 * basis[(i, 3)]).abs() < 2e-16));
    let error = WALKER.locally_changed(&state, &[0.0; 26]).unwrap_err().to_string();
    assert!(error.contains("26") && error.contains("22"), "{error}");
    tiny[5] = f64::NAN;
    let error = WALKER.locally_changed(&state, &tiny).unwrap_err().to_string();
    assert!(error.contains("rotation(turn)[2]"), "{error}");
    // Many turns are a turn.
    tiny[5] = 1e300;
    let far = WALKER.locally_changed(&state, &tiny).unwrap();
    assert!((far.q.rows(3, 4).norm() - 1.0).abs() < 1e-15);
    let mut long = state;
    long.q[3] += 1e-3;
    assert!(WALKER.local_change(&state, &long).is_err() && WALKER.local_change(&long, &state).is_err());
}
