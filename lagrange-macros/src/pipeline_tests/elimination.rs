//! The elimination knows what is zero: a chain of rods costs as much as its length.

use super::{equations, systems};
use crate::codegen::solving;

#[test]
fn a_chain_of_rods_is_solved_in_linearly_many_operations() {
    let counts: Vec<usize> = [5, 10, 15, 20, 25]
        .into_iter()
        .map(|n| {
            let (problem, equations) = equations(&systems::rods(n));
            solving(&problem, &equations).expect("short enough").arithmetic
        })
        .collect();
    println!("operations of the accelerations and all multipliers, 5 to 25 rods: {counts:?}");
    assert!(counts.windows(3).all(|c| c[2] + c[0] == 2 * c[1]), "{counts:?}");
    assert!(counts[3] < 60 * 20, "{counts:?}");
}

#[test]
fn a_dense_mass_matrix_is_unrolled_while_that_is_short() {
    let count = |n| {
        let (problem, equations) = equations(&systems::chain(n));
        solving(&problem, &equations).map(|count| count.arithmetic)
    };
    assert!(count(10).is_some_and(|count| count < 1300), "{:?}", count(10));
    assert_eq!(count(60), None);
}
