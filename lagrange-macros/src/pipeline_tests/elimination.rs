//! The elimination knows what is zero: a chain costs as much as its length.

use expect_test::expect;

use super::{equations, systems};
use crate::codegen::solving;

/// Operations of the accelerations and multipliers before the passes and after each, by the form of M and by that over
/// definitions.
fn counts(source: &str) -> [Option<Vec<usize>>; 2] {
    let (problem, equations) = equations(source);
    solving(&problem, &equations)
        .map(|counts| counts.map(|counts| counts.iter().map(|(_, count)| count.arithmetic).collect()))
}

fn last(counts: &Option<Vec<usize>>) -> Option<usize> {
    counts.as_ref()?.last().copied()
}

#[test]
fn a_chain_of_rods_is_solved_in_linearly_many_operations() {
    let counts: Vec<usize> =
        [5, 10, 15, 20, 25].map(|n| last(&counts(&systems::rods(n))[0]).expect("short enough")).to_vec();
    println!("operations of the accelerations and all multipliers, 5 to 25 rods: {counts:?}");
    assert!(counts.windows(3).all(|c| c[2] + c[0] == 2 * c[1]), "{counts:?}");
    assert!(counts[3] < 60 * 20, "{counts:?}");
}

/// The articulated-body algorithm, found from the definitions of the links' velocities.
#[test]
fn a_chain_in_angles_is_solved_in_linearly_many_operations() {
    let mut table = String::from("links: M, over definitions; before the passes and after each\n");
    let mut over_definitions = Vec::new();
    for n in [2, 3, 5, 8, 10, 12, 14, 16, 18, 20] {
        let [plain, named] = counts(&systems::chain(n));
        over_definitions.push((n, last(&named).expect("short enough")));
        table += &format!("{n}: {plain:?}, {named:?}\n");
    }
    expect![[r#"
        links: M, over definitions; before the passes and after each
        2: Some([88, 86, 79, 79, 79]), Some([82, 75, 73, 72, 72])
        3: Some([158, 156, 147, 147, 147]), Some([150, 141, 133, 132, 132])
        5: Some([354, 352, 339, 339, 339]), Some([276, 263, 247, 246, 246])
        8: Some([818, 816, 797, 797, 797]), Some([465, 446, 418, 417, 417])
        10: Some([1264, 1262, 1239, 1239, 1239]), Some([591, 568, 532, 531, 531])
        12: Some([1838, 1836, 1809, 1809, 1809]), Some([717, 690, 646, 645, 645])
        14: Some([2556, 2554, 2523, 2523, 2523]), Some([843, 812, 760, 759, 759])
        16: Some([3434, 3432, 3397, 3397, 3397]), Some([969, 934, 874, 873, 873])
        18: Some([4488, 4486, 4447, 4447, 4447]), Some([1095, 1056, 988, 987, 987])
        20: None, Some([1221, 1178, 1102, 1101, 1101])
    "#]]
    .assert_eq(&table);
    let chains = &over_definitions[4..];
    assert!(chains.windows(3).all(|c| c[2].1 + c[0].1 == 2 * c[1].1), "{chains:?}");
}

#[test]
fn a_dense_mass_matrix_is_unrolled_while_that_is_short() {
    let count = |n| last(&counts(&systems::chain(n))[0]);
    assert!(count(10).is_some_and(|count| count <= 1250), "{:?}", count(10));
    assert_eq!(count(60), None);
}
