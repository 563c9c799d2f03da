//! The Jacobian of a point and of a rotation, against differences of places and against virtual power.

use approx::assert_relative_eq;
use lagrange_core::nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use lagrange_core::prelude::*;

/// A hand on two links that turn and one that slides, on a carriage.
#[derive(Lagrangian)]
#[coordinates(x, q: [3])]
#[frame(carriage: translate([x, 0, 0]))]
#[frame(arm in carriage: rotate_z(q[0]), translate(upper), rotate_y(q[1]))]
#[frame(hand in arm: translate([q[2], 0, 0]), rotate([1, 2, 2], t))]
#[lagrangian(x_dot^2/2 + dot(q_dot, q_dot)/2)]
#[power(push, velocity(hand, tool))]
#[observable(at = position(hand, tool))]
#[observable(axes[i in 0..3] = express(vector(fixed, identity(3)[i]), hand))]
#[observable(J = jacobian(velocity(hand, tool)))]
#[observable(J_fixed = jacobian(express(velocity(hand, tool), fixed)))]
#[observable(J_turning = jacobian(angular_velocity(hand)))]
#[observable(J_height = jacobian(der(position(hand, tool)[2])))]
#[observable(spin = angular_velocity(hand))]
#[observable(torques = transpose(jacobian(velocity(hand, tool)))*push)]
struct Hand {
    upper: Vector3<f64>,
    tool: Vector3<f64>,
    push: Vector3<f64>,
}

const Q: [f64; 4] = [0.3, 0.7, -1.1, 0.6];
const T: f64 = 0.4;

fn hand() -> Hand {
    Hand {
        upper: Vector3::new(0.8, 0.1, 0.3),
        tool: Vector3::new(0.2, -0.3, 0.1),
        push: Vector3::new(1.0, -2.0, 0.7),
    }
}

fn at(q: [f64; 4]) -> State<f64, 4> {
    State { t: T, ..State::at_rest(q) }
}

/// ∂position/∂q by differences of the fourth order.
fn slopes(hand: &Hand) -> SMatrix<f64, 3, 4> {
    let column = |a: usize| {
        let place = |step: f64| {
            let mut q = Q;
            q[a] += step;
            hand.at(&at(q))
        };
        let h = 1e-3;
        (8.0 * (place(h) - place(-h)) - place(2.0 * h) + place(-2.0 * h)) / (12.0 * h)
    };
    SMatrix::from_columns(&std::array::from_fn::<_, 4, _>(column))
}

#[test]
fn a_jacobian_is_the_slope_of_a_place() {
    let (hand, state) = (hand(), at(Q));
    let slopes = slopes(&hand);
    assert_relative_eq!(hand.J_fixed(&state), slopes, epsilon = 1e-11);
    // The rows of `axes` are the fixed axes along the hand's.
    let into_hand: Matrix3<f64> = hand.axes(&state).transpose();
    assert_relative_eq!(hand.J(&state), into_hand * slopes, epsilon = 1e-11);
    assert_relative_eq!(hand.J_height(&state), slopes.row(2).transpose(), epsilon = 1e-11);
}

#[test]
fn a_jacobian_takes_velocities_to_the_spin() {
    let hand = hand();
    let v = SVector::from([0.5, -0.2, 0.9, 1.3]);
    // Without velocities what is left is what turns in time.
    let moving = State { v, ..at(Q) };
    let change = hand.spin(&moving) - hand.spin(&at(Q));
    assert_relative_eq!(hand.J_turning(&moving) * v, change, epsilon = 1e-14);
}

#[test]
fn a_power_is_the_transpose_by_the_force() {
    let (hand, state) = (hand(), at(Q));
    let found = hand.solve(&state).unwrap().accelerations;
    assert_relative_eq!(found, hand.J(&state).transpose() * hand.push, epsilon = 1e-14);
    assert_relative_eq!(found, hand.torques(&state), epsilon = 1e-14);
    assert_eq!(Hand::OBSERVABLES.iter().filter(|name| name.starts_with("J[")).count(), 12);
}
