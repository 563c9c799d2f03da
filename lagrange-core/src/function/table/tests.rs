//! Tests of the natural spline: its definition, a published example, and its order of convergence.

use super::Table;
use crate::error::Error;
use crate::function::{First, Second, Value};

fn table(points: &[(f64, f64)]) -> Table {
    Table::new(points).expect("a table")
}

/// Returns the table of `f` at the ends of `n` equal steps from 0 to `end`.
fn sampled(f: fn(f64) -> f64, end: f64, n: u32) -> Table {
    let points: Vec<_> = (0..=n).map(|i| end * f64::from(i) / f64::from(n)).map(|x| (x, f(x))).collect();
    table(&points)
}

/// Returns the value and the first two derivatives.
fn jet(table: &Table, x: f64) -> [f64; 3] {
    [table.value([x])[0], table.first([x], [0])[0], table.second([x], [0, 0])[0]]
}

const UNEVEN: [(f64, f64); 6] =
    [(-1.0, 2.0), (-0.5, -1.0), (0.25, 0.5), (2.0, 3.0), (2.125, 2.5), (4.0, -2.0)];

#[test]
fn it_goes_through_its_points() {
    let table = table(&UNEVEN);
    for (x, y) in UNEVEN {
        assert!((table.value([x])[0] - y).abs() < 1e-14);
    }
}

#[test]
fn it_is_twice_continuously_differentiable_and_straight_at_the_ends() {
    let table = table(&UNEVEN);
    for (x, _) in UNEVEN {
        let (before, after) = (jet(&table, x.next_down()), jet(&table, x.next_up()));
        for order in 0..3 {
            // Neighbouring numbers at x differ by at most 1e-15, and the third derivative is below 1000.
            let jump = (before[order] - after[order]).abs();
            assert!(jump < 1e-11, "order {order} jumps by {jump} at {x}");
        }
    }
    for end in [-1.0, 4.0] {
        assert!(jet(&table, end)[2].abs() < 1e-13);
    }
}

#[test]
fn the_derivatives_are_those_of_the_values() {
    let table = table(&UNEVEN);
    for x in [-2.0, -0.9, -0.1, 0.3, 1.1, 2.05, 3.9, 5.0] {
        let h = 1e-4;
        let [left, middle, right] = [x - h, x, x + h].map(|x| jet(&table, x));
        // The value is a cubic: its central difference has the error y‴ h²/6.
        assert!(((right[0] - left[0]) / (2.0 * h) - middle[1]).abs() < 1e-5);
        // The slope is a parabola, for which the central difference is exact.
        assert!(((right[1] - left[1]) / (2.0 * h) - middle[2]).abs() < 1e-9);
    }
}

/// Burden and Faires, *Numerical Analysis*, 3.5: the natural splines of examples 1 and 2, as (y, y′, y″/2) at the
/// left end of each piece.
#[test]
#[expect(clippy::approx_constant, reason = "numbers as they are printed")]
fn it_is_the_natural_spline_of_the_textbook() {
    let three = table(&[(1.0, 2.0), (2.0, 3.0), (3.0, 5.0)]);
    for (x, expected) in [(1.0, [2.0, 0.75, 0.0]), (2.0, [3.0, 1.5, 1.5])] {
        assert_eq!(jet(&three, x), expected);
    }
    // On the left piece the spline is 2 + 3/4 (x − 1) + 1/4 (x − 1)³.
    assert_eq!(three.value([1.5]), [2.0 + 0.375 + 0.03125]);
    let exponential = sampled(f64::exp, 3.0, 3);
    let published =
        [(0.0, [1.0, 1.46600, 0.0]), (1.0, [2.71828, 2.22285, 0.75685]), (2.0, [7.38906, 8.80977, 5.83007])];
    for (x, [y, slope, half_bend]) in published {
        let ours = jet(&exponential, x);
        for (ours, printed) in ours.into_iter().zip([y, slope, 2.0 * half_bend]) {
            assert!((ours - printed).abs() <= 1.1e-5, "{ours}, printed {printed}");
        }
    }
}

/// Away from the ends, where the second derivative is forced to zero, the error is of order h⁴.
#[test]
fn it_converges_with_order_four_inside() {
    let error = |n: u32| {
        let table = sampled(f64::exp, 4.0, n);
        let places = (0..=200).map(|i| 1.5 + f64::from(i) / 200.0);
        places.map(|x| (table.value([x])[0] - x.exp()).abs()).fold(0.0, f64::max)
    };
    for n in [64, 128] {
        let order = (error(n) / error(2 * n)).log2();
        assert!((order - 4.0).abs() < 0.1, "order {order}");
    }
}

#[test]
fn beyond_the_ends_it_goes_on_straight() {
    let table = table(&UNEVEN);
    for (end, away) in [(-1.0, -2.5), (4.0, 3.5)] {
        let [y, slope, _] = jet(&table, end);
        let [far, steep, bend] = jet(&table, end + away);
        assert!((far - (y + slope * away)).abs() < 1e-12);
        assert_eq!((steep, bend), (slope, 0.0));
    }
}

#[test]
fn two_points_are_a_straight_line() {
    let line = table(&[(1.0, 2.0), (3.0, 8.0)]);
    for x in [-1.0, 1.0, 1.75, 3.0, 10.0] {
        assert_eq!(jet(&line, x), [3.0 * x - 1.0, 3.0, 0.0]);
    }
}

#[test]
fn bad_points_are_an_error() {
    let bad: [&[(f64, f64)]; 9] = [
        &[],
        &[(0.0, 1.0)],
        &[(0.0, 1.0), (0.0, 2.0)],
        &[(0.0, 1.0), (1.0, 2.0), (0.5, 3.0)],
        &[(0.0, 1.0), (f64::NAN, 2.0)],
        &[(0.0, f64::NAN), (1.0, 2.0)],
        &[(0.0, 1.0), (f64::INFINITY, 2.0)],
        // The difference of x, or the slope, overflows.
        &[(-f64::MAX, 1.0), (f64::MAX, 2.0)],
        &[(0.0, -f64::MAX), (1e-10, f64::MAX), (1.0, 0.0)],
    ];
    for points in bad {
        assert!(matches!(Table::new(points), Err(Error::Table)), "{points:?}");
    }
}

#[test]
fn at_no_number_it_is_no_number() {
    assert!(jet(&table(&UNEVEN), f64::NAN)[0].is_nan());
    assert!(!jet(&table(&UNEVEN), f64::INFINITY)[0].is_finite());
}
