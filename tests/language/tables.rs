//! Tables of any points at all: refused, or a function with finite values; a smooth one is the natural quintic spline.

use lagrange_core::function::{First, Second, Third, Value};
use lagrange_core::{
    Error,
    function::{SmoothTable, Table},
};
use lagrange_random::{Random, rounds};

/// Anything that f64 holds: also no numbers, infinities, zeros of either sign, and what is next to another.
fn any(random: &mut Random, before: f64) -> f64 {
    match random.below(8) {
        0 => f64::from_bits(random.bits()),
        1 => before.next_up(),
        2 => before,
        3 => {
            const ODD: [f64; 7] =
                [-0.0, f64::MAX, f64::MIN, f64::MIN_POSITIVE, f64::INFINITY, f64::NAN, 5e-324];
            random.one_of(&ODD)
        }
        _ => 2.0_f64.powi(random.below(40) as i32 - 20) * random.between(-1.0, 1.0),
    }
}

fn anything(random: &mut Random) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = Vec::new();
    for _ in 0..random.below(8) {
        let (x, y) = points.last().copied().unwrap_or_default();
        points.push((any(random, x), any(random, y)));
    }
    if random.once_in(2) {
        points.sort_by(|(x, _), (y, _)| x.total_cmp(y));
    }
    points
}

/// Steps and heights of ordinary size, the longest step up to ten thousand times the shortest.
fn ordinary(random: &mut Random) -> Vec<(f64, f64)> {
    let mut x = random.between(-10.0, 10.0);
    let points = (0..2 + random.below(20)).map(|_| {
        x += 10.0_f64.powf(random.between(-2.0, 2.0));
        (x, random.between(-10.0, 10.0))
    });
    points.collect()
}

fn jet(table: &Table, x: f64) -> [f64; 3] {
    [table.value([x])[0], table.first([x], [0])[0], table.second([x], [0, 0])[0]]
}

fn smooth_jet(table: &SmoothTable, x: f64) -> [f64; 4] {
    [table.value([x])[0], table.first([x], [0])[0], table.second([x], [0; 2])[0], table.third([x], [0; 3])[0]]
}

/// What is said to be refused is, and nothing else is but for overflow.
#[test]
fn any_points_are_a_table_or_an_error() {
    fn check<T>(points: &[(f64, f64)], least: usize, table: Result<T, Error>, jet: impl Fn(&T, f64) -> bool) {
        let increases = points.windows(2).all(|pair| pair[0].0 < pair[1].0);
        let is_finite = points.iter().all(|(x, y)| x.is_finite() && y.is_finite());
        match table {
            Ok(table) => {
                assert!(points.len() >= least && increases && is_finite, "{points:?}");
                assert!(points.iter().all(|&(x, _)| jet(&table, x)), "not finite in {points:?}");
            }
            Err(error) => assert!(matches!(error, Error::Table), "{error:?}"),
        }
    }
    rounds("points", [2_000, 50_000, 5_000_000], |random| {
        let (points, anywhere) = (anything(random), f64::from_bits(random.bits()));
        check(&points, 2, Table::new(&points), |table, x| {
            jet(table, anywhere);
            jet(table, x).into_iter().all(f64::is_finite)
        });
        check(&points, 3, SmoothTable::new(&points), |table, x| {
            smooth_jet(table, anywhere);
            smooth_jet(table, x).into_iter().all(f64::is_finite)
        });
    });
}

/// What defines it: it takes the heights, third and fourth derivatives meet, both zero at the ends; between two points it is the
/// quintic of its values, slopes and bends there.
#[test]
fn ordinary_points_are_a_smooth_natural_spline() {
    rounds("smooth splines", [300, 5_000, 500_000], |random| {
        let points = ordinary(random);
        let Some(table) = (points.len() > 2).then(|| SmoothTable::new(&points).expect("a table")) else {
            return;
        };
        let ends: Vec<[[f64; 4]; 2]> = points.windows(2).map(|pair| quintic(&table, pair)).collect();
        for (i, (x, y)) in points.iter().enumerate() {
            assert_eq!(table.value([*x])[0], *y, "{points:?}");
            let zero = [0.0; 4];
            let left = if i > 0 { ends[i - 1][1] } else { zero };
            let right = if i < ends.len() { ends[i][0] } else { zero };
            // Round-off of the largest of the terms, times what the widths beside one another differ by.
            for order in 0..2 {
                let scale = left[2 + order].max(right[2 + order]);
                let off = (left[order] - right[order]).abs() / scale;
                assert!(off < 1e-9, "{off:e}, derivative {} at {x} of {points:?}", 3 + order);
            }
        }
    });
}

/// Third and fourth derivatives at both ends of a piece by values, slopes and bends there, and the sizes of their terms.
fn quintic(table: &SmoothTable, pair: &[(f64, f64)]) -> [[f64; 4]; 2] {
    let h = pair[1].0 - pair[0].0;
    let [[y, s, b, _], [z, t, c, _]] = [0, 1].map(|i| smooth_jet(table, pair[i].0));
    let third = [
        [60.0 * (z - y), -36.0 * s * h, -24.0 * t * h, -9.0 * b * h * h, 3.0 * c * h * h],
        [60.0 * (z - y), -24.0 * s * h, -36.0 * t * h, -3.0 * b * h * h, 9.0 * c * h * h],
    ];
    let fourth = [
        [-360.0 * (z - y), 192.0 * s * h, 168.0 * t * h, 36.0 * b * h * h, -24.0 * c * h * h],
        [360.0 * (z - y), -168.0 * s * h, -192.0 * t * h, -24.0 * b * h * h, 36.0 * c * h * h],
    ];
    [0, 1].map(|end| {
        let [third, fourth] = [(third[end], h.powi(3)), (fourth[end], h.powi(4))].map(|(terms, unit)| {
            [terms.iter().sum::<f64>() / unit, terms.iter().map(|x| x.abs()).sum::<f64>() / unit]
        });
        [third[0], fourth[0], third[1], fourth[1]]
    })
}
