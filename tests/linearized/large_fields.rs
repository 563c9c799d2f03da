//! Of a large field, what the expressions name is a parameter, and nothing else costs anything.

use lagrange_core::nalgebra::{ArrayStorage, SMatrix};
use lagrange_core::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - eps[99_998]*table[29][1]*x^2/2 - eps[0]*x + rows[1][2]*x)]
struct Large<T> {
    eps: [T; 99_999],
    m: T,
    table: SMatrix<T, 30, 30>,
    rows: [[T; 30]; 30],
}

/// Not on the stack.
static LARGE: Large<f64> = {
    let table = SMatrix::from_array_storage(ArrayStorage([[0.0; 30]; 30]));
    let mut system = Large { eps: [0.0; 99_999], m: 5.0, table, rows: [[0.0; 30]; 30] };
    (system.eps[0], system.eps[99_998]) = (2.0, 3.0);
    system.table.data.0[1][29] = 7.0;
    system.rows[1][2] = 11.0;
    system
};

#[test]
fn what_is_named_is_a_parameter() {
    assert_eq!(
        Large::<f64>::PARAMETERS,
        ["eps[0]", "eps[99998]", "m", "table[29][1]", "rows[1][2]"],
        "in the order of the fields, and in each by its indices"
    );
    let mut system = LARGE.clone();
    assert_eq!(system.parameters().as_slice(), [2.0, 3.0, 5.0, 7.0, 11.0]);
    for index in 0..5 {
        assert!(system.set_parameter(index, 0.5 + index as f64));
    }
    assert_eq!(system.parameters().as_slice(), [0.5, 1.5, 2.5, 3.5, 4.5]);
    assert_eq!((system.eps[0], system.eps[1], system.eps[99_998], system.rows[1][2]), (0.5, 0.0, 1.5, 4.5));
}

/// m x'' = -eps_last table x - eps_0 + rows
#[test]
fn the_jacobian_has_a_column_for_each() {
    let x = 0.25;
    let jacobian = LARGE.jacobian(&State::at_rest([x])).unwrap();
    let acceleration = (-3.0 * 7.0 * x - 2.0 + 11.0) / 5.0;
    let columns = [-1.0 / 5.0, -7.0 * x / 5.0, -acceleration / 5.0, -3.0 * x / 5.0, 1.0 / 5.0];
    for (found, wanted) in jacobian.accelerations.parameters.iter().zip(columns) {
        // One rounding each in a handful of operations on numbers near 1.
        assert!((found - wanted).abs() < 8.0 * f64::EPSILON, "{found} {wanted}");
    }
}
