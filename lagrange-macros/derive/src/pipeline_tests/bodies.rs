//! Frames and rigid bodies: compares the recursions with differentiation of L, and counts operations.

use expect_test::expect;

use super::{derived, equations};
use crate::codegen::{Count, solutions, solving};
use crate::mechanics::Equations;
use crate::symbolic::{Approximate, Id, Sample};
use crate::variables::{Variable, nodes, total_time_derivative};

/// Operation counts of the accelerations and multipliers, one per form of the equations. `None` for a form that is
/// solved in loops.
fn counts(source: &str) -> Vec<Option<usize>> {
    let (graph, _, equations) = equations(source);
    let last = |counts: Vec<(_, Count)>| counts.last().map(|(_, count)| count.arithmetic);
    solving(&graph, &equations).into_iter().map(|counts| counts.and_then(last)).collect()
}

pub(super) const ARM: &str = "#[coordinates(q: [6])]
    #[parameter(inertia: symmetric)]
    #[frame(link[0]: rotate(place[0]), rotate_z(q[0]))]
    #[frame(link[i in 1..6] in link[i-1]: translate(arm[i]), rotate(place[i]), rotate_z(q[i]))]
    #[lagrangian(sum(i in 0..6, kinetic(link[i], m[i], centre[i], inertia[i]) - m[i]*g*position(link[i], centre[i])[2]))]
    #[force(q: tau)]
    struct Arm { place: [Rotation3<f64>; 6], arm: [Vector3<f64>; 6], centre: [Vector3<f64>; 6], inertia: [Matrix3<f64>; 6], m: [f64; 6], g: f64, tau: [f64; 6] }";

const DENAVIT: &str = "#[coordinates(q: [6])]
    #[parameter(inertia: symmetric)]
    #[frame(link[0]: rotate_z(q[0]))]
    #[frame(link[i in 1..6] in link[i-1]: rotate_x(alpha[i]), translate([a[i], 0, d[i]]), rotate_z(q[i]))]
    #[lagrangian(sum(i in 0..6, kinetic(link[i], m[i], centre[i], inertia[i]) - m[i]*g*position(link[i], centre[i])[2]))]
    #[force(q: tau)]
    struct Arm { alpha: [f64; 6], a: [f64; 6], d: [f64; 6], centre: [Vector3<f64>; 6], inertia: [Matrix3<f64>; 6], m: [f64; 6], g: f64, tau: [f64; 6] }";

const QUADRUPED: &str = "#[coordinates(r: [3], q: [4], hip: [4], thigh: [4], shank: [4])]
    #[parameter(inertia: symmetric)] #[parameter(i1: symmetric)] #[parameter(i2: symmetric)] #[parameter(i3: symmetric)]
    #[frame(body: translate(r), rotate(q))]
    #[frame(a[k in 0..4] in body: translate(p1[k]), rotate_x(hip[k]))]
    #[frame(b[k in 0..4] in a[k]: translate(p2[k]), rotate_y(thigh[k]))]
    #[frame(c[k in 0..4] in b[k]: translate(p3[k]), rotate_y(shank[k]))]
    #[define(T = kinetic(body, m, centre, inertia) + sum(k in 0..4, kinetic(a[k], m1[k], c1[k], i1[k]) + kinetic(b[k], m2[k], c2[k], i2[k]) + kinetic(c[k], m3[k], c3[k], i3[k])))]
    #[define(U = g*(m*position(body, centre)[2] + sum(k in 0..4, m1[k]*position(a[k], c1[k])[2] + m2[k]*position(b[k], c2[k])[2] + m3[k]*position(c[k], c3[k])[2])))]
    #[lagrangian(T - U)]
    #[force(hip: tau1)] #[force(thigh: tau2)] #[force(shank: tau3)]
    struct Quadruped { m: f64, centre: Vector3<f64>, inertia: Matrix3<f64>, p1: [Vector3<f64>; 4], p2: [Vector3<f64>; 4], p3: [Vector3<f64>; 4],
      m1: [f64; 4], c1: [Vector3<f64>; 4], i1: [Matrix3<f64>; 4], m2: [f64; 4], c2: [Vector3<f64>; 4], i2: [Matrix3<f64>; 4], m3: [f64; 4], c3: [Vector3<f64>; 4], i3: [Matrix3<f64>; 4], g: f64, tau1: [f64; 4], tau2: [f64; 4], tau3: [f64; 4] }";

const STEWART: &str = "#[coordinates(r: [3], q: [4], yaw: [6], pitch: [6], s: [6])]
    #[parameter(inertia: symmetric)] #[parameter(i1: symmetric)] #[parameter(i2: symmetric)]
    #[frame(plate: translate(r), rotate(q))]
    #[frame(cylinder[k in 0..6]: translate(base[k]), rotate_x(yaw[k]), rotate_y(pitch[k]))]
    #[frame(piston[k in 0..6] in cylinder[k]: translate([0, 0, s[k]]))]
    #[lagrangian(kinetic(plate, m, centre, inertia) - m*g*r[2]
      + sum(k in 0..6, kinetic(cylinder[k], m1, c1, i1) + kinetic(piston[k], m2, c2, i2) - g*(m1*position(cylinder[k], c1)[2] + m2*position(piston[k], c2)[2])))]
    #[constraint(ball[k in 0..6]: position(piston[k]) = position(plate, anchor[k]))]
    #[force(s: push)]
    struct Stewart { m: f64, centre: Vector3<f64>, inertia: Matrix3<f64>, base: [Vector3<f64>; 6], anchor: [Vector3<f64>; 6], m1: f64, c1: Vector3<f64>, i1: Matrix3<f64>, m2: f64, c2: Vector3<f64>, i2: Matrix3<f64>, g: f64, push: [f64; 6] }";

const FOUR_BAR: &str = "#[coordinates(a, b: [3], c)]
    #[parameter(i1: symmetric)] #[parameter(i2: symmetric)] #[parameter(i3: symmetric)]
    #[frame(crank: rotate(p1), rotate_z(a))]
    #[frame(coupler in crank: translate(l1), rotate_z(b[0]), rotate_y(b[1]), rotate_x(b[2]))]
    #[frame(rocker: translate(l3), rotate(p3), rotate_z(c))]
    #[lagrangian(kinetic(crank, m1, c1, i1) + kinetic(coupler, m2, c2, i2) + kinetic(rocker, m3, c3, i3)
      - g*(m1*position(crank, c1)[2] + m2*position(coupler, c2)[2] + m3*position(rocker, c3)[2]))]
    #[constraint(ball: position(coupler, l2) = position(rocker, l4))]
    #[force(a: torque)]
    struct FourBar { p1: Rotation3<f64>, p3: Rotation3<f64>, l1: Vector3<f64>, l2: Vector3<f64>, l3: Vector3<f64>, l4: Vector3<f64>, m1: f64, c1: Vector3<f64>, i1: Matrix3<f64>, m2: f64, c2: Vector3<f64>, i2: Matrix3<f64>, m3: f64, c3: Vector3<f64>, i3: Matrix3<f64>, g: f64, torque: f64 }";

pub(super) fn least(source: &str) -> usize {
    counts(source).into_iter().flatten().min().expect("short enough")
}

/// A hand-written articulated-body algorithm with symbolic parameters takes 3,555 operations for the arm. For the
/// quadruped it takes 6,511, without those of the quaternion (CasADi 3.8).
#[test]
fn machines_cost_less_than_by_hand() {
    let in_angles = QUADRUPED
        .replace("q: [4], hip", "q: [3], hip")
        .replace("rotate(q)", "rotate_z(q[0]), rotate_y(q[1]), rotate_x(q[2])");
    let counts = [
        ("arm", ARM),
        ("by Denavit and Hartenberg", DENAVIT),
        ("quadruped", QUADRUPED),
        ("in angles", &in_angles),
        ("four-bar", FOUR_BAR),
        ("Stewart platform", STEWART),
    ]
    .map(|(name, source)| format!("{name}: {}\n", least(source)));
    expect![[r#"
        arm: 2308
        by Denavit and Hartenberg: 1883
        quadruped: 5442
        in angles: 5172
        four-bar: 850
        Stewart platform: 4907
    "#]]
    .assert_eq(&counts.concat());
}

/// Indexed coordinates such as `r[0]` cost as much as separate ones such as `r0`.
#[test]
fn bodies_in_arrays_cost_as_much_as_each_by_its_name() {
    let system = |head: &str, r: [&str; 3], q: [&str; 3]| {
        let frames: String =
            (0..3).map(|i| format!("#[frame(b{i}: translate({}), rotate({}))]", r[i], q[i])).collect();
        let energies: Vec<_> = (0..3)
            .map(|i| {
                format!("kinetic(b{i}, m, c, inertia) - m*g*position(b{i}, c)[2] - k*dot({0}, {0})", r[i])
            })
            .collect();
        format!(
            "#[coordinates({head})] #[parameter(inertia: symmetric)] {frames} #[lagrangian({})]
            struct S {{ m: f64, c: [f64; 3], inertia: Matrix3<f64>, g: f64, k: f64 }}",
            energies.join(" + ")
        )
    };
    let apart = system(
        "r0: [3], r1: [3], r2: [3], q0: [4], q1: [4], q2: [4]",
        ["r0", "r1", "r2"],
        ["q0", "q1", "q2"],
    );
    let together = system("r: [3, 3], q: [3, 4]", ["r[0]", "r[1]", "r[2]"], ["q[0]", "q[1]", "q[2]"]);
    assert_eq!(counts(&together), counts(&apart));
}

/// The form whose unknowns include the rates of all velocities takes linearly many operations. For a long chain it
/// is the cheapest form.
#[test]
fn a_long_arm_costs_as_much_as_its_length() {
    let arm = |n: usize| {
        let more = ["[6]", "1..6", "0..6", "; 6]"].into_iter();
        more.fold(ARM.to_owned(), |source, part| source.replace(part, &part.replace('6', &n.to_string())))
    };
    let lengths = [14, 16, 18, 20].map(|n| counts(&arm(n))[1].expect("short enough"));
    let steps: Vec<usize> = lengths.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(steps.windows(2).all(|pair| pair[0].abs_diff(pair[1]) <= 2), "{lengths:?}");
    assert_eq!(least(&arm(20)), lengths[3]);
}

/// A rotation by a product costs as much as its factors as separate steps and gives the same accelerations, however
/// the product is written.
#[test]
fn a_product_of_rotations_is_its_turns() {
    let source = |definitions: &str, steps: &str| {
        format!(
            "#[coordinates(a, b, c)] #[define(in_one_order = [axis, r, [l, m, g]])] {definitions}
             #[frame(one: translate([0, a, l]), {steps})] #[frame(two in one: translate([l, 0, 0]), rotate_y(c))]
             #[lagrangian(kinetic(one, m, r, I) + kinetic(two, m, r, I) - m*g*position(two, r)[2])]
             struct Turned {{ m: f64, g: f64, l: f64, r: Vector3<f64>, I: Matrix3<f64>, axis: Vector3<f64>, place: Rotation3<f64> }}"
        )
    };
    let spellings = [
        ("", "rotate(rot_z(a)*place*rot(axis, a*b))"),
        ("", "rotate(rot_z(a)), rotate(place*rot(axis, a*b))"),
        ("#[define(R = rot_z(a)*place*rot(axis, a*b))]", "rotate(R)"),
        ("#[define(P = place)] #[define(R(x) = P*rot(axis, x))]", "rotate(rot_z(a)*R(a*b))"),
        (
            "#[define(E[0] = rot_z(a))] #[define(E[1] = E[0]*place)] #[define(E[2] = E[1]*rot(axis, a*b))]",
            "rotate(E[2])",
        ),
        ("#[define(B = rot(axis, -a*b)*transpose(place)*rot_z(-a))]", "rotate(transpose(B))"),
        ("#[define(E = [place, rot(axis, a*b)])]", "rotate(rot_z(a)*E[0]*E[1])"),
    ];
    let accelerations = |source: &str| {
        let (graph, problem, equations) = equations(source);
        let values = solutions(&graph, &equations, |symbol| problem.drawn(symbol, 1).value);
        values[0].clone().expect("short enough")
    };
    let steps = source("", "rotate_z(a), rotate(place), rotate(axis, a*b)");
    let (expected, cost) = (accelerations(&steps), counts(&steps));
    for (definitions, product) in spellings {
        let product = source(definitions, product);
        assert_eq!(counts(&product), cost, "{product}");
        for (ours, expected) in accelerations(&product).iter().zip(&expected) {
            assert!((ours - expected).abs() < 1e-12 * expected.abs(), "{product}: {ours} and {expected}");
        }
    }
}

/// Each definition is twice as long as the one before: the last one, a product of 2³⁹ rotations, is not split into
/// steps.
#[test]
fn rotations_that_double_come_to_an_end() {
    let definitions = "#[define(R[0] = rot_x(a))] #[define(R[i in 1..40] = R[i-1]*R[i-1])]";
    let (graph, _, equations) = equations(&format!(
        "#[coordinates(a)] {definitions} #[frame(body: rotate(R[39]))] #[lagrangian(kinetic(body, m, [0, 0, 0], identity(3)))]
         struct Doubled {{ m: f64 }}"
    ));
    assert!(!solving(&graph, &equations).is_empty());
}

/// Systems with every kind of frame step, and with every kind of term that L may contain beside bodies.
const SYSTEMS: [&str; 19] = [
    ARM,
    DENAVIT,
    QUADRUPED,
    STEWART,
    FOUR_BAR,
    // Frames moved by time, by functions and by each other.
    "#[coordinates(x, y, z)] #[function(Omega(t))] #[function(s(t): [3])]
     #[frame(earth: translate(s(t)), rotate_y(latitude), rotate_x(Omega(t)))]
     #[frame(cart in earth: translate([x, 2*y, x*y]), rotate([1, 2, 2], z*t), translate([0, x^2, 0]))]
     #[lagrangian(kinetic(earth, m, [x, y, z]) + kinetic(cart, m, c, I) - m*g*position(cart, [1, 0, z])[0])]
     struct Driven<F, G> { m: f64, g: f64, latitude: f64, Omega: F, s: G, c: Vector3<f64>, I: Matrix3<f64> }",
    // A coordinate in the steps of two frames, and three times in those of the second.
    "#[coordinates(a, b)]
     #[frame(one: rotate_z(a), translate([l, 0, 0]))]
     #[frame(two in one: rotate_x(2*a + b), translate([0, a, b]), rotate_z(a))]
     #[lagrangian(kinetic(one, m, c, I) + kinetic(two, m, c, I))]
     struct Geared { m: f64, l: f64, c: Vector3<f64>, I: Matrix3<f64> }",
    // Prismatic joints, which leave the angular velocity unchanged; a kinetic energy with a factor 2.
    "#[coordinates(phi, x, y)]
     #[frame(turning: rotate_z(phi))] #[frame(sledge in turning: translate([x, 0, h]))] #[frame(lift in sledge: translate([0, d, y]))]
     #[lagrangian(kinetic(sledge, m, c, I) + 2*kinetic(lift, m, c, I) - m*g*position(lift)[2] - k/2*(x - l)^2)]
     #[dissipation(k*dot(velocity(lift), velocity(lift))/2)] #[force(x: k*phi_dot)]
     struct Crane { m: f64, h: f64, d: f64, l: f64, g: f64, k: f64, c: Vector3<f64>, I: Matrix3<f64> }",
    // Two frames with the same rotation, whose common terms are computed once.
    "#[coordinates(p, q)]
     #[frame(a: rotate_x(p), rotate_y(q))] #[frame(b: translate([1, 2, 3]), rotate_x(p), rotate_y(q))]
     #[frame(c in b: rotate_x(p))]
     #[lagrangian(kinetic(a, m, c0, I) + kinetic(b, m, c0, I) + kinetic(c, m, c0, I) + dot(angular_velocity(b), c0)*p)]
     struct Twins { m: f64, c0: Vector3<f64>, I: Matrix3<f64> }",
    // A rotation matrix given by entries that depend on coordinates, not as a product of elementary rotations.
    "#[coordinates(p, q)]
     #[frame(a: rotate([[cos(p*q), -sin(p*q), 0], [sin(p*q), cos(p*q), 0], [0, 0, 1]]), translate([p, 0, 0]), rotate_x(q))]
     #[lagrangian(kinetic(a, m, c, I) - m*g*position(a, c)[1])]
     struct Entries { m: f64, g: f64, c: Vector3<f64>, I: Matrix3<f64> }",
    // A product of a rotation and two reflections, which alone are no rotations.
    "#[coordinates(p, q)] #[define(M = [[0, 1, 0], [1, 0, 0], [0, 0, 1]])]
     #[frame(a: rotate(M*rot_x(p)*M), translate([p, 0, 0]), rotate_x(q))]
     #[lagrangian(kinetic(a, m, c, I) - m*g*position(a, c)[1])]
     struct Mirrored { m: f64, g: f64, c: Vector3<f64>, I: Matrix3<f64> }",
    // A product of elementary rotations.
    "#[coordinates(p, q)] #[define(R = rot_x(p)*rot_z(q))]
     #[frame(a: rotate(R), translate([p, 0, 0]))]
     #[lagrangian(kinetic(a, m, c, I) - m*g*position(a, c)[1])]
     struct Matrices { m: f64, g: f64, c: Vector3<f64>, I: Matrix3<f64> }",
    // Parameters that rotate a frame: a unit quaternion, an axis, a rotation matrix.
    "#[coordinates(p, q)]
     #[frame(a: rotate(tilt), rotate(axis, p), rotate(mount), rotate_y(q))]
     #[lagrangian(kinetic(a, m, c, I) - m*g*position(a, c)[1])]
     struct Mounted { m: f64, g: f64, c: Vector3<f64>, I: Matrix3<f64>, axis: Vector3<f64>, tilt: UnitQuaternion<f64>, mount: Rotation3<f64> }",
    // L of any kind: no rigid body, terms not quadratic or linear in the velocities, a magnetic field, springs
    // between points.
    "#[coordinates(r: [3], p, q)]
     #[frame(a: translate(r), rotate_z(p))] #[frame(b in a: rotate_x(q), translate([0, 0, l]))]
     #[lagrangian(-m*sqrt(9 - dot(velocity(b), velocity(b))) + m*dot(velocity(a), velocity(a)) + dot(angular_velocity(b), vector(b, [1, 2, p]))^2
        + k*dot(velocity(b), cross([0, 1, 2], vector(b, [3, 1, l]))) - k/2*norm(position(b, [1, 0, 0]) - position(a, [0, 1, 0]) - vector(fixed, [3, 2, 1]))^2)]
     struct Odd { m: f64, l: f64, k: f64 }",
    // Velocities named by definitions; kinetic energies inside definitions and with factors that depend on
    // coordinates.
    "#[coordinates(x, p)]
     #[define(v = x_dot*cos(p))]
     #[frame(a: translate([x, 0, 0]), rotate_z(p))]
     #[define(T = kinetic(a, m, c, I) + m*v^2)]
     #[lagrangian(T + kinetic(a, 2*m, c, I)*x^2 - m*g*position(a, c)[1])]
     struct Named { m: f64, g: f64, c: Vector3<f64>, I: Matrix3<f64> }",
    // Vectors expressed in the axes of other frames; time derivatives as seen from a given frame.
    "#[coordinates(x, p, q)]
     #[frame(a: translate([x, 0, 0]), rotate_z(p))] #[frame(b in a: rotate_x(q))] #[frame(c: rotate_y(x))]
     #[define(r = vector(b, [p, 1, q]))]
     #[lagrangian(kinetic(b, m, c0, I) + dot(der(r), der(r)) + dot(der(r, c), express(der(r, fixed), b))/3 + dot(express(der(r, a), c), velocity(c, [1, 1, x])))]
     struct Seen { m: f64, c0: Vector3<f64>, I: Matrix3<f64> }",
    // Masses, centres and inertias that vary with coordinates, time, velocities and positions, by functions and
    // definitions.
    "#[coordinates(x, p, q)] #[function(burnt(t, x))]
     #[frame(a: rotate_y(p), translate([0, x, l]))] #[frame(b in a: rotate_x(q))]
     #[define(fuel = m*(2 + sin(x*t)))] #[define(J(s) = (1 + s^2)*I)]
     #[lagrangian(kinetic(a, fuel, c, J(x)) + kinetic(b, m*exp(-t) + position(a, c)[2]^2, c, I)
        + kinetic(b, burnt(t, x), [x, t, 1], J(p)) + kinetic(a, m, c, J(q_dot)) - fuel*g*position(a, c)[2])]
     struct Burning<F> { m: f64, g: f64, l: f64, c: Vector3<f64>, I: Matrix3<f64>, burnt: F }",
    // Two quaternions, the second relative to the frame of the first.
    "#[coordinates(r: [3], p: [4], q: [4])]
     #[frame(a: translate(r), rotate(p))] #[frame(b in a: translate([l, 0, 0]), rotate(q))]
     #[lagrangian(kinetic(a, m, c, I) + kinetic(b, m, c, I) - m*g*position(b, c)[2])]
     struct Balls { m: f64, g: f64, l: f64, c: Vector3<f64>, I: Matrix3<f64> }",
    // A body with a constraint on the position of a point and a rolling constraint.
    "#[coordinates(r: [3], q: [4], s)]
     #[frame(a: translate(r), rotate(q))] #[frame(b in a: rotate_x(s))]
     #[lagrangian(kinetic(a, m, c, I) + kinetic(b, m, c, I))]
     #[constraint(held: position(b, [l, 0, 0])[2] = r[0])] #[constraint(rolling: velocity(a, [0, 0, l])[0] = 0)]
     struct Tied { m: f64, l: f64, c: Vector3<f64>, I: Matrix3<f64> }",
];

/// The recursions of the frames give M q̈ − h and the inverse dynamics. Both must equal dp/dt − ∂L/∂q − Q, found by
/// differentiating L, at random states on the constraints or off them.
#[test]
fn recursions_give_what_differentiation_gives() {
    for source in SYSTEMS {
        let (mut graph, problem, derived) = derived(source);
        let Equations { mass, forcing, momentum, momentum_rate, balance, constraint_force, .. } =
            &derived.equations;
        let accelerations = nodes(&mut graph, mass.len(), Variable::Acceleration);
        let inertia: Vec<Id> = mass.iter().map(|row| graph.dot(row, &accelerations)).collect();
        let mut along_motion = total_time_derivative(&mut graph, mass.len());
        let rows = (0..mass.len()).flat_map(|i| {
            let rate = along_motion.of(&mut graph, momentum[i]);
            let expected = graph.sub(rate, momentum_rate[i]);
            let by_forms = graph.sub(inertia[i], forcing[i]);
            let constraint_force = constraint_force.get(i).copied().unwrap_or(Id::ZERO);
            let inverse = graph.add(balance[i], constraint_force);
            [by_forms, inverse].map(|ours| graph.sub(ours, expected))
        });
        let rows: Vec<Id> = rows.collect();
        let roots = [&rows[..], &inertia, forcing].concat();
        let symbols: Vec<_> = graph.symbols(&roots).collect();
        for draw in 0..5 {
            let mut sample =
                Sample::new(symbols.iter().copied(), draw, |symbol, draw| problem.drawn(symbol, draw));
            let values = sample.values(&graph, &roots);
            let (differences, parts) = values.split_at(rows.len());
            let scale = parts.iter().fold(0.0_f64, |scale, part| scale.max(part.value.abs()));
            for (i, difference) in differences.iter().enumerate() {
                let Approximate { value, .. } = difference;
                assert!(
                    value.abs() < 1e-11 * scale,
                    "{source}: row {}, {}: {value:e} of {scale:e}",
                    i / 2,
                    i % 2
                );
            }
            assert!(scale > 0.1, "{source}: {scale}");
        }
    }
}

/// Joints about two axes in turn: two families of frames, each with its parents in the other. They may be declared
/// in either order, or frame by frame.
#[test]
fn families_of_frames_may_lie_in_one_another() {
    let system = |frames: [&str; 4]| {
        let source = format!(
            "#[coordinates(yaw: [3], pitch: [3])] #[parameter(inertia: symmetric)] #[frame(a[0]: rotate_z(yaw[0]))] {}
             #[lagrangian(sum(i in 0..3, kinetic(a[i], m, c, inertia) + kinetic(b[i], m, c, inertia) - m*g*position(b[i], c)[2]))]
             struct Snake {{ m: f64, g: f64, l: f64, c: Vector3<f64>, inertia: Matrix3<f64> }}",
            frames.concat()
        );
        let (graph, _, equations) = equations(&source);
        solutions(&graph, &equations, |symbol| {
            0.3 + 0.1 * (7.0 * f64::from(symbol.family) + f64::from(symbol.index)).sin()
        })
    };
    let a = "#[frame(a[i in 1..3] in b[i-1]: translate([l, 0, 0]), rotate_z(yaw[i]))]";
    let b = "#[frame(b[i in 0..3] in a[i]: translate([l, 0, 0]), rotate_y(pitch[i]))]";
    let one = |name: &str, i: usize| {
        let family = if name == "a" { a } else { b };
        let (of_three, from_one) = (format!("{name}[i in 0..3]"), format!("{name}[i in 1..3]"));
        let family =
            family.replace(&of_three, &format!("{name}[{i}]")).replace(&from_one, &format!("{name}[{i}]"));
        family.replace("[i-1]", &format!("[{}]", i.wrapping_sub(1))).replace("[i]", &format!("[{i}]"))
    };
    let by_one = [one("b", 0), one("a", 1), one("b", 1) + &one("a", 2), one("b", 2)];
    let expected = system(by_one.each_ref().map(String::as_str));
    assert_eq!(system([a, b, "", ""]), expected);
    assert_eq!(system([b, a, "", ""]), expected);
}
