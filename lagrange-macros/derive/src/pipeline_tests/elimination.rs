//! The elimination skips zero entries: a chain takes linearly many operations.

use expect_test::expect;

use super::{equations, systems};
use crate::codegen::{Count, solutions, solving};
use crate::symbolic::Symbol;
use crate::variables::Variable;

/// Operation counts of the accelerations and multipliers, before the passes and after each. The first form solves with
/// M for the accelerations, the second also for the rates of named velocities. `None` for a form that is solved in
/// loops.
fn counts(source: &str) -> Vec<Option<Vec<usize>>> {
    let (graph, _, equations) = equations(source);
    let arithmetic = |counts: Vec<(_, Count)>| counts.iter().map(|(_, count)| count.arithmetic).collect();
    solving(&graph, &equations).into_iter().map(|counts| counts.map(arithmetic)).collect()
}

fn last(counts: &Option<Vec<usize>>) -> Option<usize> {
    counts.as_ref()?.last().copied()
}

#[test]
fn a_chain_of_rods_is_solved_in_linearly_many_operations() {
    let counts: Vec<usize> =
        [5, 10, 15, 20, 25].map(|n| last(&counts(&systems::rods(n))[0]).expect("short enough")).to_vec();
    println!("operations of the accelerations and all multipliers, 5 to 25 rods: {counts:?}");
    // Linear up to one sign, where results are added in pairs.
    assert!(counts.windows(3).all(|c| (c[2] + c[0]).abs_diff(2 * c[1]) <= 1), "{counts:?}");
    assert!(counts[3] <= 45 * 20, "{counts:?}");
}

/// Each multiplier follows the coordinates of its own constraint. After those of all constraints, every multiplier would
/// couple to every other.
#[test]
fn neighbouring_loops_are_solved_in_linearly_many_operations() {
    let counts: Vec<usize> =
        [10, 20, 30, 40].map(|n| last(&counts(&systems::windows(n))[0]).expect("short enough")).to_vec();
    println!("operations of the accelerations and all multipliers, 10 to 40 windows: {counts:?}");
    assert!(counts.windows(3).all(|c| c[2] + c[0] == 2 * c[1]), "{counts:?}");
    assert!(counts[3] <= 205 * 40, "{counts:?}");
}

/// The derive finds the articulated-body algorithm from the definitions of the links' velocities.
#[test]
fn a_chain_in_angles_is_solved_in_linearly_many_operations() {
    let mut table = String::from("links: M, over definitions; before the passes and after each\n");
    let mut over_definitions = Vec::new();
    for n in [2, 3, 5, 8, 10, 12, 14, 16, 18, 20] {
        let [plain, named] = &counts(&systems::chain(n))[..] else { panic!("two forms") };
        over_definitions.push((n, last(named).expect("short enough")));
        table += &format!("{n}: {plain:?}, {named:?}\n");
    }
    expect![[r#"
        links: M, over definitions; before the passes and after each
        2: Some([91, 89, 82, 82, 82]), Some([85, 78, 75, 73, 73])
        3: Some([161, 159, 150, 150, 150]), Some([153, 144, 135, 133, 133])
        5: Some([357, 355, 342, 342, 342]), Some([279, 266, 249, 247, 247])
        8: Some([821, 819, 800, 800, 800]), Some([468, 449, 420, 418, 418])
        10: Some([1267, 1265, 1242, 1242, 1242]), Some([594, 571, 534, 532, 532])
        12: Some([1841, 1839, 1812, 1812, 1812]), Some([720, 693, 648, 646, 646])
        14: Some([2559, 2557, 2526, 2526, 2526]), Some([846, 815, 762, 760, 760])
        16: Some([3437, 3435, 3400, 3400, 3400]), Some([972, 937, 876, 874, 874])
        18: Some([4491, 4489, 4450, 4450, 4450]), Some([1098, 1059, 990, 988, 988])
        20: None, Some([1224, 1181, 1104, 1102, 1102])
    "#]]
    .assert_eq(&table);
    let chains = &over_definitions[4..];
    assert!(chains.windows(3).all(|c| c[2].1 + c[0].1 == 2 * c[1].1), "{chains:?}");
}

#[test]
fn a_dense_mass_matrix_is_unrolled_while_that_is_short() {
    let count = |n, form: usize| last(&counts(&systems::chain(n))[form]);
    assert!(count(10, 0).is_some_and(|count| count <= 1250), "{:?}", count(10, 0));
    // Loops over 60 × 60 entries would take many times the operations of the sparse form.
    assert_eq!(count(60, 0), None);
    assert!(count(60, 1).is_some());
}

/// Systems whose definitions name velocities, with every kind of term that the second form contains.
const NAMED: [&str; 8] = [
    // A tree: two arms on a trunk.
    "#[coordinates(trunk, left, right)]
     #[define(x = l*sin(trunk))] #[define(y = -l*cos(trunk))]
     #[define(x1 = x + l*sin(left))] #[define(y1 = y - l*cos(left))]
     #[define(x2 = x + l/2*sin(right))] #[define(y2 = y - l/2*cos(right))]
     #[lagrangian(m/2*(der(x)^2 + der(y)^2 + der(x1)^2 + der(y1)^2 + 2*(der(x2)^2 + der(y2)^2)) - m*g*(y + y1 + 2*y2))]
     struct Tree { m: f64, l: f64, g: f64 }",
    // Angular velocities, which are no time derivatives of coordinates: the Boltzmann–Hamel equations.
    "#[coordinates(phi, theta, psi)]
     #[define(w1 = phi_dot*sin(theta)*sin(psi) + theta_dot*cos(psi))]
     #[define(w2 = phi_dot*sin(theta)*cos(psi) - theta_dot*sin(psi))]
     #[define(w3 = phi_dot*cos(theta) + psi_dot)]
     #[lagrangian(a/2*w1^2 + b/2*w2^2 + c/2*w3^2 - m*g*cos(theta))]
     struct Top { a: f64, b: f64, c: f64, m: f64, g: f64 }",
    // A driven pivot, a term linear in the velocities, forces, and dissipation by the named velocities.
    "#[coordinates(alpha, beta)]
     #[define(vx = a*w*cos(w*t) + l*cos(alpha)*alpha_dot)] #[define(vy = l*sin(alpha)*alpha_dot)]
     #[define(ux = vx + l*cos(beta)*beta_dot)] #[define(uy = vy + l*sin(beta)*beta_dot)]
     #[lagrangian(m/2*(vx^2 + vy^2) + m/2*(ux^2 + uy^2) + k*(ux*sin(alpha) - uy*beta) + m*g*l*cos(alpha)*cos(beta))]
     #[dissipation(c/2*(ux^2 + uy^2))] #[force(alpha: k*sin(t)*beta_dot)]
     struct Driven { m: f64, l: f64, g: f64, a: f64, w: f64, k: f64, c: f64 }",
    // A velocity that contains an earlier one, rotated.
    "#[coordinates(alpha, beta, gamma)]
     #[define(u1 = l*alpha_dot*sin(beta))] #[define(u2 = l*alpha_dot*cos(beta))]
     #[define(v1 = u1*cos(gamma) - u2*sin(gamma))] #[define(v2 = u1*sin(gamma) + u2*cos(gamma) + l*(beta_dot + gamma_dot))]
     #[lagrangian(m/2*(u1^2 + (u2 + l*beta_dot)^2) + m/2*(v1^2 + v2^2) + m*gamma_dot^2/5 - m*g*cos(alpha))]
     struct Turning { m: f64, l: f64, g: f64 }",
    // L is not quadratic in the velocities.
    "#[coordinates(x, y)]
     #[define(v = x_dot + y*y_dot)] #[define(u = v - x*y_dot)]
     #[lagrangian(-m*c^2*sqrt(1 - (v^2 + u^2)/c^2/9) + y_dot^2/2 - k*x^2)]
     struct Relativistic { m: f64, c: f64, k: f64 }",
    // Some velocities outside all definitions; some definitions not linear in the velocities.
    "#[coordinates(x, theta)]
     #[define(v = x_dot + l*cos(theta)*theta_dot)] #[define(T = m/2*(v^2 + l^2*sin(theta)^2*theta_dot^2))]
     #[lagrangian(T + m*x_dot^2 + x_dot*v/9 + m*g*l*cos(theta))]
     struct Cart { m: f64, l: f64, g: f64 }",
    // A chain with its end tied to a point.
    "#[coordinates(q: [4])]
     #[define(x[0] = l*sin(q[0]))] #[define(x[i in 1..4] = x[i-1] + l*sin(q[i]))]
     #[define(y[0] = -l*cos(q[0]))] #[define(y[i in 1..4] = y[i-1] - l*cos(q[i]))]
     #[lagrangian(sum(i in 0..4, m/2*(der(x[i])^2 + der(y[i])^2) - m*g*y[i]))]
     #[constraint(across: x[3] = l)] #[constraint(down: y[3] = -2*l)]
     struct Bridge { m: f64, l: f64, g: f64 }",
    // A family of vectors.
    "#[coordinates(q: [3])]
     #[define(v[0] = [cos(q[0]), sin(q[0])]*q_dot[0])]
     #[define(v[i in 1..3] = v[i-1] + [cos(q[i]), sin(q[i])]*q_dot[i])]
     #[lagrangian(sum(i in 0..3, m/2*dot(v[i], v[i]) + m*g*cos(q[i])))]
     struct Vectors { m: f64, g: f64 }",
];

/// All forms give the same accelerations and multipliers, at random states.
#[test]
fn every_form_has_the_same_solution() {
    for source in NAMED {
        let (graph, _, equations) = equations(source);
        assert_eq!(equations.linear.forms.len(), 2, "{source}");
        assert!(!equations.linear.forms[1].definitions.is_empty(), "{source}");
        for point in 0..20 {
            let input = |symbol: Symbol| {
                let mixed = (1 + u64::from(symbol.family)) * 7_919
                    + u64::from(symbol.index) * 104_729
                    + point * 1_299_709;
                let part = (mixed as f64 * 0.618_033_988_749_894_9).fract();
                if matches!(Variable::of(symbol), Variable::Parameter(_)) {
                    0.5 + part
                } else {
                    2.0 * part - 1.0
                }
            };
            let solutions = solutions(&graph, &equations, input);
            let [Some(plain), Some(named)] = &solutions[..] else { panic!("both are short: {source}") };
            let scale = plain.iter().fold(0.0_f64, |scale, x| scale.max(x.abs()));
            for (x, y) in plain.iter().zip(named).take(plain.len() - 1) {
                assert!((x - y).abs() < 1e-10 * x.abs() + 1e-13 * scale, "{source}: {plain:?} {named:?}");
            }
            let pivots = [plain, named].map(|solution| *solution.last().expect("a pivot"));
            assert!(pivots.iter().all(|pivot| *pivot > 0.0), "{source}: {pivots:?}");
        }
    }
}

/// A division by zero shows in the pivot or in a result, even if it affects few results or another one hides it.
#[test]
fn what_is_no_number_spoils_the_pivot_or_a_result() {
    let spoilt = [
        // A singular block, beside a multiplier that is zero.
        "#[coordinates(x, u, w)] #[lagrangian(x_dot^2/2 + u_dot*w_dot - u*w)] #[constraint(c: x = 0)] struct A {}",
        // An infinite force that shares a term with a multiplier.
        "#[coordinates(x, u)] #[lagrangian(x_dot^2/2 + u_dot^2/2)] #[force(u: exp(-t)/u)]
         #[constraint(c: t^3/6 = x)] struct B {}",
        // An infinite acceleration 1/x, which the other one hides in 1/(1 + 1/x) = 0.
        "#[coordinates(x, u)] #[lagrangian(x_dot^2/2 + u_dot^2/2)] #[force(x: 1/x)] #[force(u: 1/(1 + 1/x))]
         struct C {}",
        // A mass of zero, whose reciprocal makes the multiplier zero.
        "#[coordinates(x, y)] #[lagrangian(m*(x_dot^2 + y_dot^2)/2 - m*y)] #[constraint(c: x^2 + y^2 = 1)]
         struct D { m: f64 }",
        // A mass of zero that cancels.
        "#[coordinates(x)] #[lagrangian(m*x_dot^2/2 - m*x)] struct E { m: f64 }",
    ];
    for source in spoilt {
        let (graph, _, equations) = equations(source);
        for solution in solutions(&graph, &equations, |_| 0.0) {
            let solution = solution.expect("short");
            let passes = solution.iter().all(|x| x.is_finite());
            assert!(!(passes && solution.last().is_some_and(|pivot| *pivot > 0.0)), "{source}: {solution:?}");
        }
    }
}

/// A lattice of rods: its Schur complement is sparse, but still too long to unroll.
#[test]
fn what_would_be_too_long_is_left_to_loops() {
    let (n, mut rods) = (14, String::new());
    for i in 0..n * n {
        if i % n + 1 < n {
            rods += &format!("#[constraint(across{i}: (x[{i}] - x[{}])^2 + y[{i}]^2 = 1)]", i + 1);
        }
        if i + n < n * n {
            rods += &format!("#[constraint(down{i}: (x[{i}] - x[{}])^2 + y[{i}]^2 = 1)]", i + n);
        }
    }
    let m = n * n;
    let source = format!(
        "#[coordinates(x: [{m}], y: [{m}])] #[lagrangian(sum(i in 0..{m}, x_dot[i]^2 + y_dot[i]^2)/2)] {rods}
         struct Lattice {{}}"
    );
    let (graph, _, equations) = equations(&source);
    assert!(solving(&graph, &equations).iter().all(Option::is_none));
}

/// The acceleration h/M = −3⁴⁰⁰ x is beyond the exact arithmetic of the derive, so the equations contain a
/// quotient.
#[test]
fn a_quotient_that_exact_arithmetic_cannot_write_is_left_to_run_time() {
    let source = "#[coordinates(x)] #[lagrangian(3^-200*x_dot^2/2 - 3^200*x^2/2)] struct Stiff {}";
    let (graph, _, equations) = equations(source);
    assert_eq!(equations.linear.forms[0].alone, [None]);
    let solution = &solutions(&graph, &equations, |_| 0.5)[0];
    let acceleration = solution.as_ref().expect("short")[0];
    let expected = -0.5 * 3.0_f64.powi(400);
    // Each of the two powers is off by some 200 roundings at most.
    assert!((acceleration / expected - 1.0).abs() < 1e-13, "{acceleration:e}");
    assert!(!crate::expand(super::tokens(source)).to_string().contains("compile_error"));
}

/// Each named velocity is differentiated by each other one. With very many of them the second form is left out, and
/// the equations are solved for the accelerations alone.
#[test]
fn very_many_named_velocities_are_not_solved_over() {
    let named = |count: usize| {
        let source = format!(
            "#[coordinates(x, y)] #[define(v[i in 0..{count}] = cos(i*x)*x_dot + y_dot)]
             #[lagrangian(dot(v, v)/2 + x_dot^2)] struct Many {{}}"
        );
        equations(&source).2.linear.forms.len()
    };
    assert_eq!((named(40), named(600)), (2, 1));
}
