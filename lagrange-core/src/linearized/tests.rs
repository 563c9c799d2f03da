use crate::Direction;
use crate::generated::vector;

#[test]
fn a_direction_of_one_argument_changes_that_alone() {
    let zero = Direction::<f64, 2>::zero();
    assert_eq!((zero.t, zero.q, zero.v), (0.0, vector([0.0; 2]), vector([0.0; 2])));
    assert_eq!(Direction::of_time(), Direction { t: 1.0, ..zero });
    assert_eq!(Direction::of_coordinate(1), Direction { q: vector([0.0, 1.0]), ..zero });
    assert_eq!(Direction::of_velocity(0), Direction { v: vector([1.0, 0.0]), ..zero });
    assert_eq!(Direction::of_velocity(2), zero);
}
