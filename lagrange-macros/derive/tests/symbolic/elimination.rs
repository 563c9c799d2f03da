//! Linear equations whose entries have bounds of their errors.

use lagrange_symbolic::{Approximate, rank, solve};

fn rows(numbers: &[&[f64]]) -> Vec<Vec<Approximate>> {
    numbers.iter().map(|row| row.iter().map(|&x| Approximate::exact(x)).collect()).collect()
}

#[test]
fn the_bounds_of_a_solution_contain_it() {
    // Hilbert matrix, with condition number 5e5, times (1, −1, 2, 3, −4).
    let exact = [1.0, -1.0, 2.0, 3.0, -4.0];
    let hilbert = |i: usize| -> Vec<f64> { (0..5).map(|j| 1.0 / (i + j + 1) as f64).collect() };
    let system: Vec<Vec<f64>> = (0..5)
        .map(|i| {
            let row = hilbert(i);
            let right = row.iter().zip(exact).map(|(a, x)| a * x).sum();
            [row, vec![right]].concat()
        })
        .collect();
    let system: Vec<&[f64]> = system.iter().map(Vec::as_slice).collect();
    let mut system = rows(&system);
    system.iter_mut().flatten().for_each(|entry| entry.error = 4.0 * f64::EPSILON);
    let solution = solve(system, 5).expect("a solution");
    for (x, exact) in solution.values.iter().zip(exact) {
        assert!((x.value - exact).abs() <= x.error && x.error < 1e-6, "{x:?} for {exact}");
    }
}

#[test]
fn dependent_equations_leave_an_unknown_open() {
    let solution = solve(rows(&[&[0.1, 0.2, 0.3], &[0.2, 0.4, 0.6]]), 2).expect("a solution");
    assert_eq!(solution.free, [true, false]);
    assert!((solution.values[1].value - 1.5).abs() < 1e-15);
    assert!(solve(rows(&[&[0.1, 0.2, 0.3], &[0.2, 0.4, 0.5]]), 2).is_none());
}

fn exact(rows: &[&[f64]]) -> usize {
    let entry = |&value: &f64| Approximate { value, error: 0.0 };
    rank(rows.iter().map(|row| row.iter().map(entry).collect()).collect())
}

#[test]
fn ranks_of_exact_matrices() {
    assert_eq!(exact(&[]), 0);
    assert_eq!(exact(&[&[0.0, 0.0]]), 0);
    assert_eq!(exact(&[&[0.0, 2.0], &[3.0, 0.0]]), 2);
    assert_eq!(exact(&[&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0], &[7.0, 8.0, 9.0]]), 2);
    assert_eq!(exact(&[&[0.1, 0.3], &[0.2, 0.6], &[0.3, 0.9]]), 1);
    // 1e-13 is well above rounding: hundreds of units in the last place.
    assert_eq!(exact(&[&[1.0, 1.0], &[1.0, 1.0 + 1e-13]]), 2);
}

#[test]
fn an_entry_within_its_error_does_not_count() {
    let entry = |value, error| Approximate { value, error };
    let one = entry(1.0, 0.0);
    assert_eq!(rank(vec![vec![one, one], vec![one, entry(1.1, 0.2)]]), 1);
    assert_eq!(rank(vec![vec![one, one], vec![one, entry(1.1, 0.05)]]), 2);
}

/// An unknown that is 0 ± 0.1 times another one, of value 1, has an error bound of 0.1 at least. This must hold
/// both if the uncertain entry is in the pivot row and if it is in the eliminated row.
#[test]
fn what_may_be_zero_is_not_taken_for_zero() {
    let blurred = Approximate { value: 0.0, error: 0.1 };
    let [one, two] = [1.0, 2.0].map(Approximate::exact);
    for rows in [[[one, blurred, two], [blurred, two, two]], [[two, blurred, two], [one, one, two]]] {
        let solution = solve(rows.map(Vec::from).into(), 2).expect("a solution");
        assert!(solution.values.iter().all(|x| x.error > 0.04), "{:?}", solution.values);
    }
}
