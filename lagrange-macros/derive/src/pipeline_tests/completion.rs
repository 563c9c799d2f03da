//! Constraints that complete a singular M: which ones, with what weight σ, and at what cost. The solution stays the
//! same.

use super::{equations, systems};
use crate::codegen::{operations, solutions, solving};
use crate::mechanics::Equations;
use crate::resolve::Problem;
use crate::symbolic::{Approximate, Graph, Id, Rational, Sample, Symbol, solve};
use crate::variables::{Variable, symbols};

/// A rigid body of any inertia, rotating about its centre of mass. `HAND` marks where a test may add a vanishing
/// term to L.
const FREE: &str = "#[coordinates(q: [4])] #[define(w = quat_rate_body(q, q_dot))]
    #[lagrangian(dot(w, J*w)/2 HAND)] #[constraint(unit: (dot(q, q) - 1)/2 = 0)] struct Free { J: [[f64; 3]; 3] }";

const BALL: &str = "#[coordinates(r: [3], q: [4])] #[define(J = 2/5*m*a^2)] #[define(Omega = quat_rate(q, q_dot))]
    #[lagrangian(m/2*dot(r_dot, r_dot) + J/2*dot(Omega, Omega) + m*dot(g, r) HAND)]
    #[constraint(rolling: r_dot - a*cross(Omega, n) = w*cross(n, r))]
    #[constraint(unit: (dot(q, q) - 1)/2 = 0)] struct Ball { m: f64, a: f64, g: [f64; 3], n: [f64; 3], w: f64 }";

/// `count` bodies in a row, each joined to the one before by a spherical joint. If `closed`, the last is joined to
/// a wall as well.
fn joints(count: usize, closed: bool) -> String {
    let last = count - 1;
    let mut bodies = String::new();
    for i in 0..count {
        bodies += &format!(
            "#[define(w{i} = quat_rate_body(q{i}, q{i}_dot))]
             #[define(T{i} = m/2*dot(r{i}_dot, r{i}_dot) + (J[0]*w{i}[0]^2 + J[1]*w{i}[1]^2 + J[2]*w{i}[2]^2)/2 - m*g*r{i}[2])]
             #[define(s{i} = 2*(J[0] + J[1] + J[2])*dot(q{i}, q{i}_dot)^2)]
             #[constraint(unit{i}: (dot(q{i}, q{i}) - 1)/2 = 0)]
             #[define(top{i} = r{i} + quat_rotate(q{i}, arm))] #[define(end{i} = r{i} - quat_rotate(q{i}, arm))]"
        );
        bodies += &match i {
            0 => "#[constraint(joint0: top0 = 0)]".to_owned(),
            _ => format!("#[constraint(joint{i}: top{i} = end{})]", i - 1),
        };
    }
    if closed {
        bodies += &format!("#[constraint(wall: end{last} = hook)]");
    }
    let names = |name: &str| (0..count).map(|i| format!("{name}{i}")).collect::<Vec<_>>();
    let coordinates: Vec<String> = (0..count).map(|i| format!("r{i}: [3], q{i}: [4]")).collect();
    let (energies, squares) = (names("T").join(" + "), names("s").join(" + "));
    format!(
        "#[coordinates({})] {bodies} #[define(S = {squares})] #[lagrangian({energies} HAND)]
         struct Bodies {{ m: f64, J: [f64; 3], g: f64, arm: [f64; 3], hook: [f64; 3] }}",
        coordinates.join(", ")
    )
}

/// A body with four legs of three hinges each, feet free. Velocities are along the axes of the body.
fn quadruped() -> String {
    let mut legs = String::new();
    for k in 0..4 {
        legs += &format!(
            "#[define(hip{k} = place[{k}] + l*[sin(a{k}[0]), cos(a{k}[0])*sin(a{k}[1]), -cos(a{k}[0])*cos(a{k}[1])])]
             #[define(leg{k} = hip{k} + l*[sin(a{k}[0]), cos(a{k}[0])*sin(a{k}[1] + a{k}[2]), -cos(a{k}[0])*cos(a{k}[1] + a{k}[2])])]
             #[define(knee{k} = v + cross(w, hip{k}) + der(hip{k}))] #[define(foot{k} = v + cross(w, leg{k}) + der(leg{k}))]
             #[define(T{k} = m/2*(dot(knee{k}, knee{k}) + dot(foot{k}, foot{k})) - m*g*dot(up, hip{k} + leg{k}))]"
        );
    }
    format!(
        "#[coordinates(r: [3], q: [4], a0: [3], a1: [3], a2: [3], a3: [3])]
         #[define(w = quat_rate_body(q, q_dot))] #[define(back = [q[0], -q[1], -q[2], -q[3]])]
         #[define(v = quat_rotate(back, r_dot))] #[define(up = quat_rotate(back, [0, 0, 1]))] {legs}
         #[lagrangian(M/2*dot(v, v) + (J[0]*w[0]^2 + J[1]*w[1]^2 + J[2]*w[2]^2)/2 - (M + 8*m)*g*r[2] + T0 + T1 + T2 + T3 HAND)]
         #[constraint(unit: (dot(q, q) - 1)/2 = 0)]
         struct Quadruped {{ M: f64, J: [f64; 3], m: f64, g: f64, l: f64, place: [[f64; 3]; 4] }}"
    )
}

fn without(source: &str) -> String {
    source.replace("HAND", "")
}

/// Operation count of the cheapest form.
fn least(source: &str) -> usize {
    let (graph, _, equations) = equations(source);
    let counts = solving(&graph, &equations).into_iter().flatten();
    counts.map(|counts| counts[counts.len() - 1].1.arithmetic).min().expect("short enough")
}

#[test]
fn a_quaternion_costs_what_it_does_with_a_term_that_vanishes_added_by_hand() {
    let term = |inertia: &str| format!("+ 2*{inertia}*dot(q, q_dot)^2");
    let systems = [
        ("top", systems::TOP.replace(" - m", " HAND - m"), term("J[0]")),
        ("free", FREE.to_owned(), term("J[0][0]")),
        ("ball", BALL.to_owned(), term("J")),
        ("joints", joints(3, false), "+ S".to_owned()),
        ("quadruped", quadruped(), term("J[0]")),
    ];
    for (name, source, hand) in systems {
        let [completed, by_hand] =
            [without(&source), source.replace("HAND", &hand)].map(|source| least(&source));
        assert!(completed as f64 <= 1.05 * by_hand as f64, "{name}: {completed}, {by_hand} by hand");
    }
}

/// Returns the names of the constraints that complete M.
fn completing(source: &str) -> Vec<String> {
    let (_, problem, equations) = equations(&without(source));
    let [first, rest @ ..] = &equations.linear.forms[..] else { panic!("a form") };
    assert!(rest.iter().all(|form| form.completing == first.completing), "every form or none");
    first.completing.iter().map(|&(a, _)| problem.constraints[a].0.text.clone()).collect()
}

#[test]
fn only_the_rows_that_m_needs_complete_it() {
    assert_eq!(completing(systems::TOP), ["unit"]);
    assert_eq!(completing(FREE), ["unit"]);
    assert_eq!(completing(BALL), ["unit"]);
    assert_eq!(completing(&quadruped()), ["unit"]);
    let mut units = completing(&joints(3, true));
    units.sort();
    assert_eq!(units, ["unit0", "unit1", "unit2"]);
}

#[test]
fn where_m_needs_no_constraint_it_is_left_alone() {
    let sources = [
        systems::rods(4),
        systems::SPHERE.to_owned(),
        // General inertia in Euler angles: random parameters do not make M positive definite.
        "#[coordinates(phi, theta, psi)]
         #[define(w = [phi_dot*sin(theta)*sin(psi) + theta_dot*cos(psi), phi_dot*sin(theta)*cos(psi) - theta_dot*sin(psi),
                       phi_dot*cos(theta) + psi_dot])]
         #[lagrangian(dot(w, J*w)/2)] #[constraint(level: phi_dot*cos(theta) + psi_dot = 0)]
         struct Euler { J: [[f64; 3]; 3] }"
            .to_owned(),
        // M is singular, and the constraint does not complete it.
        "#[coordinates(x, y, z)] #[lagrangian((x_dot + y_dot)^2/2 + z_dot^2/2)] #[constraint(c: x + y + z = 1)]
         struct Hopeless {}"
            .to_owned(),
    ];
    for source in sources {
        assert_eq!(completing(&source), [""; 0], "{source}");
    }
}

/// Systems with a singular or indefinite M, each with the constraints that complete it.
const SINGULAR: [(&str, &[&str]); 9] = [
    // Two massless coordinates: y is tied to x, which has a mass; z is a function of time.
    (
        "#[coordinates(x, y, z)] #[lagrangian(m*x_dot^2/2 - k*(x^2 + y^2) - z)] #[constraint(curve: y = x^2)]
         #[constraint(held: z^3 = t)] struct Massless { m: f64, k: f64 }",
        &["curve", "held"],
    ),
    // Two massless coordinates: z is tied to y, and y to x.
    (
        "#[coordinates(x, y, z)] #[lagrangian(m*x_dot^2/2 - k*z)] #[constraint(first: 1000*(y - z) = 0)]
         #[constraint(second: y = sin(x)*l)] struct Chained { m: f64, k: f64, l: f64 }",
        &["first", "second"],
    ),
    // M is indefinite for all parameters, but positive definite along the constraint.
    (
        "#[coordinates(x, y)] #[lagrangian(m*(x_dot^2/2 + 2*x_dot*y_dot + y_dot^2/2) - k*x*y)]
         #[constraint(c: x = l)] struct Indefinite { m: f64, k: f64, l: f64 }",
        &["c"],
    ),
    // Indefinite M with zeros on the diagonal.
    (
        "#[coordinates(x, y)] #[lagrangian(m*x_dot*y_dot - k*x^2)] #[constraint(c: x = y + l*y^3)]
         struct Light { m: f64, k: f64, l: f64 }",
        &["c"],
    ),
    // A velocity constraint, and a mass that depends on the velocity.
    (
        "#[coordinates(x, y)] #[lagrangian(m*x_dot^4/12 - k*x*y)] #[constraint(c: y_dot = x_dot*cos(y) + t)]
         struct Quartic { m: f64, k: f64 }",
        &["c"],
    ),
    // The norm constraint of a quaternion: in other units, and as a velocity constraint.
    (
        "#[coordinates(q: [4])] #[define(w = quat_rate(q, q_dot))] #[lagrangian(J*dot(w, w)/2 - k*q[1])]
         #[constraint(unit: s*(dot(q, q) - 1) = 0)] struct Scaled { J: f64, k: f64, s: f64 }",
        &["unit"],
    ),
    (
        "#[coordinates(q: [4])] #[define(w = quat_rate(q, q_dot))] #[lagrangian(J*dot(w, w)/2 - k*q[1])]
         #[constraint(unit: 10^6*dot(q, q_dot) = 0)] struct Rate { J: f64, k: f64 }",
        &["unit"],
    ),
    // A rotation matrix as coordinates, with the six constraints that make it orthogonal.
    (
        "#[coordinates(a: [3], b: [3], c: [3])] #[define(w = [dot(c, b_dot), dot(a, c_dot), dot(b, a_dot)])]
         #[lagrangian((A*w[0]^2 + B*w[1]^2 + C*w[2]^2)/2 - k*c[2])]
         #[constraint(aa: dot(a, a) = 1)] #[constraint(ab: dot(a, b) = 0)] #[constraint(ac: dot(a, c) = 0)]
         #[constraint(bb: dot(b, b) = 1)] #[constraint(bc: dot(b, c) = 0)] #[constraint(cc: dot(c, c) = 1)]
         struct Turn { A: f64, B: f64, C: f64, k: f64 }",
        &["aa", "ab", "ac", "bb", "bc", "cc"],
    ),
    // A quaternion whose norm is another coordinate.
    (
        "#[coordinates(q: [4], s)] #[define(w = quat_rate_body(q, q_dot))]
         #[lagrangian((A*w[0]^2 + B*w[1]^2 + C*w[2]^2)/2 + m*s_dot^2/2 - k*q[1])]
         #[constraint(length: dot(q, q) = s^2)] struct Growing { A: f64, B: f64, C: f64, m: f64, k: f64 }",
        &["length"],
    ),
];

#[test]
fn massless_coordinates_and_indefinite_masses_are_completed() {
    for (source, rows) in SINGULAR {
        let mut found = completing(source);
        found.sort();
        assert_eq!(found, rows, "{source}");
    }
}

/// A random state that satisfies the constraints.
fn state(graph: &Graph, problem: &Problem, equations: &Equations, draw: u64) -> Sample {
    let n = problem.coordinates.len();
    let roots = [&equations.roots()[..], &equations.linear.forms[0].linear].concat();
    let all = [symbols(n, Variable::Coordinate), symbols(n, Variable::Velocity)];
    let known = graph.symbols(&roots).chain(all.iter().flatten().copied());
    let mut sample = Sample::new(known, draw, |symbol, draw| problem.drawn(symbol, draw));
    let is_holonomic = |a: &usize| equations.residual[*a] != Id::ZERO;
    let (residual, slopes): (Vec<Id>, Vec<&[Id]>) = (0..equations.residual.len())
        .filter(is_holonomic)
        .map(|a| (equations.residual[a], &equations.linear.jacobian[a][..]))
        .unzip();
    sample.project(graph, &residual, &slopes, &all[0]).expect("a place");
    let rows: Vec<&[Id]> = equations.linear.jacobian.iter().map(Vec::as_slice).collect();
    sample.project(graph, &equations.rate, &rows, &all[1]).expect("a velocity");
    sample
}

/// Solves M q̈ − Fᵀλ = h, F q̈ = −γ for accelerations and multipliers, by Gaussian elimination with complete
/// pivoting.
fn pivoted(graph: &Graph, equations: &Equations, state: &mut Sample) -> Vec<f64> {
    let (n, m) = (equations.mass.len(), equations.linear.bias.len());
    let mut values = |roots: &[Id]| state.values(graph, roots);
    let jacobian: Vec<Vec<Approximate>> = equations.linear.jacobian.iter().map(|row| values(row)).collect();
    let mut rows: Vec<Vec<Approximate>> = equations.mass.iter().map(|row| values(row)).collect();
    for (i, row) in rows.iter_mut().enumerate() {
        row.extend(jacobian.iter().map(|constraint| constraint[i].negated()));
        row.push(values(&equations.forcing)[i]);
    }
    for (a, mut row) in jacobian.into_iter().enumerate() {
        row.resize(n + m, Approximate::exact(0.0));
        row.push(values(&equations.linear.bias)[a].negated());
        rows.push(row);
    }
    let solution = solve(rows, n + m).expect("a solution");
    assert!(solution.free.iter().all(|free| !free));
    solution.values.iter().map(|x| x.value).collect()
}

/// The completed equations have the same accelerations and multipliers, hence the same constraint forces, as the
/// original ones. Their pivot is large enough to trust the solution.
#[test]
fn what_is_completed_has_the_same_solution() {
    let systems = [systems::TOP, BALL].map(str::to_owned).into_iter().chain([joints(2, true)]);
    for source in systems.chain(SINGULAR.map(|(source, _)| source.to_owned())) {
        let (graph, problem, equations) = equations(&without(&source));
        for draw in 100..110 {
            let mut state = state(&graph, &problem, &equations, draw);
            let expected = pivoted(&graph, &equations, &mut state);
            let scale = expected.iter().fold(0.0_f64, |scale, x| scale.max(x.abs()));
            let input = |symbol: Symbol| state.get(symbol).value;
            for solution in solutions(&graph, &equations, input).into_iter().flatten() {
                let (pivot, solution) = solution.split_last().expect("a pivot");
                assert!(*pivot > 1e-4, "{source}: {pivot}");
                for (x, y) in solution.iter().zip(&expected) {
                    assert!((x - y).abs() < 1e-10 * (scale + 1.0), "{source}: {solution:?} {expected:?}");
                }
            }
        }
    }
}

/// The inertia of a body does not depend on its orientation, so σ depends on parameters only.
#[test]
fn the_weight_of_a_unit_quaternion_is_an_expression_of_the_parameters() {
    let scaled = SINGULAR[5].0;
    for (source, cost) in [(systems::TOP, 3), (FREE, 3), (BALL, 3), (scaled, 3), (SINGULAR[6].0, 1)] {
        let (graph, _, equations) = equations(&without(source));
        let (_, weight) = equations.linear.forms[0].completing[0];
        let is_fixed = |symbol: Symbol| matches!(Variable::of(symbol), Variable::Parameter(_));
        assert!(graph.symbols(&[weight]).all(is_fixed), "{source}");
        assert!(operations(&graph, &[weight]).arithmetic <= cost, "{source}");
    }
}

/// A sphere has the same inertia about all axes. With the right σ its completed M is diagonal.
#[test]
fn a_sphere_is_completed_to_a_diagonal() {
    let (_, _, equations) = equations(&without(BALL));
    for (i, row) in equations.linear.forms[0].matrix.iter().enumerate() {
        assert!(row.iter().enumerate().all(|(j, &entry)| (i == j) == (entry != Id::ZERO)), "{row:?}");
    }
}

/// Random parameters are positive; those of a machine may be negative. σ must not contain a part of an attached
/// arm's inertia that changes sign with the arm.
#[test]
fn a_weight_is_positive_whichever_way_arms_point() {
    let source =
        "#[coordinates(q: [4], s)] #[frame(f: rotate(q))] #[frame(a in f: translate([l, l, l]), rotate_x(s))]
        #[lagrangian(kinetic(f, m, [0, 0, 0], identity(3)*i) + kinetic(a, M, [c, c, c], identity(3)*i))]
        struct Arm { m: f64, M: f64, l: f64, c: f64, i: f64 }";
    let (graph, problem, equations) = equations(source);
    for [l, c] in [[1.0, 1.0], [-1.0, 0.9], [1.0, -0.9], [-1.0, 1.1], [1.0, -1.1]] {
        let input = |symbol: Symbol| match Variable::of(symbol) {
            Variable::Parameter(k) => match problem.parameters.name(k).as_str() {
                "l" => l,
                "c" => c,
                "i" => 0.1,
                _ => 1.0,
            },
            Variable::Coordinate(_) => 0.5,
            _ => 0.0,
        };
        for solution in solutions(&graph, &equations, input) {
            let pivot = solution.and_then(|solution| solution.last().copied());
            assert!(pivot.is_some_and(|pivot| pivot > 1e-3), "arm {l}, centre {c}: {pivot:?}");
        }
    }
}

/// Derivatives of `roots` at a state by each of `symbols`, by differences: a row for each symbol.
fn differences(graph: &Graph, state: &mut Sample, symbols: &[Symbol], roots: &[Id]) -> Vec<Vec<f64>> {
    let slopes = symbols.iter().map(|&symbol| {
        let x = state.get(symbol).value;
        let mut at = |by: f64| -> Vec<f64> {
            state.set([(symbol, Approximate::exact(x + by))]);
            state.values(graph, roots).iter().map(|value| value.value).collect()
        };
        let [near, far] = [1e-3, 2e-3].map(|h| [at(h), at(-h)]);
        at(0.0);
        let slope = |k: usize| (8.0 * (near[0][k] - near[1][k]) - (far[0][k] - far[1][k])) / 12e-3;
        (0..roots.len()).map(slope).collect()
    });
    slopes.collect()
}

/// Momenta and rates of the completed Lagrangian against differences of L + Σ σ c²/2 off the constraints, and M against
/// those of the momenta on them.
#[test]
fn the_completed_lagrangian_is_differentiated() {
    let sources = [systems::TOP, BALL, SINGULAR[0].0, SINGULAR[4].0, SINGULAR[8].0].map(without);
    for source in sources.into_iter().chain([joints(2, true)].map(|source| without(&source))) {
        let (mut graph, problem, equations) = equations(&source);
        let completed = equations.completed.as_ref().expect("a singular M");
        let squares = equations.linear.forms[0].completing.iter().map(|&(a, weight)| {
            let square = graph.square(equations.rate[a]);
            (graph.mul(weight, square), Rational::new(1, 2))
        });
        let terms: Vec<_> = squares.chain([(problem.lagrangian, Rational::new(1, 1))]).collect();
        let lagrangian = graph.sum(terms);
        let n = problem.coordinates.len();
        let [q, v] = [Variable::Coordinate, Variable::Velocity].map(|variable| symbols(n, variable));
        let known: Vec<Symbol> = graph.symbols(&[lagrangian]).chain([&q[..], &v].concat()).collect();
        let mut off = Sample::new(known, 7, |symbol, draw| problem.drawn(symbol, draw));
        let mut on = state(&graph, &problem, &equations, 7);
        let check = |name: &str, state: &mut Sample, roots: &[Id], of: &[Id], symbols: &[Symbol]| {
            let expected = differences(&graph, state, symbols, of).concat();
            for (found, expected) in state.values(&graph, roots).iter().zip(expected) {
                let off = (found.value - expected).abs();
                assert!(off < 1e-8 * (1.0 + expected.abs()), "{source}: {name} {found:?}, not {expected}");
            }
        };
        check("∂L/∂q", &mut off, &completed.rate, &[lagrangian], &q);
        check("∂L/∂q̇", &mut off, &completed.momentum, &[lagrangian], &v);
        check("∂p/∂q̇", &mut on, &completed.mass.concat(), &completed.momentum, &v);
    }
}
