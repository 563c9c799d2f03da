//! Fields that are structs: the same systems with fields of numbers, other routes to their derivatives, faults in them.

use std::sync::Arc;

use lagrange_core::nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use lagrange_core::prelude::*;
use lagrange_core::{Lanes, Pack, Packed};

#[derive(Clone, Debug)]
struct Link<T> {
    m: T,
    c: Vector3<T>,
    inertia: Matrix3<T>,
    place: Rotation3<T>,
    arm: [T; 3],
    tool: Tool<T>,
    #[expect(dead_code, reason = "no expression uses it")]
    label: &'static str,
}

#[derive(Clone, Debug)]
struct Tool<T> {
    m: T,
    at: [[T; 3]; 2],
    turn: UnitQuaternion<T>,
}

#[derive(Clone, Debug)]
struct Base<T> {
    g: T,
    r#type: T,
    push: [T; 3],
}

/// Three links, each with a tool that has two points.
#[derive(Lagrangian, Clone)]
#[coordinates(q: [3])]
#[parameter(link: [3] {
    m, c: [3], inertia: symmetric, place: rotation, arm: [3], tool: {m, at: [2, 3], turn: quaternion},
})]
#[parameter(base: {g, r#type, push: [3]})]
#[frame(part[0]: rotate(link[0].place), rotate_z(q[0]))]
#[frame(part[i in 1..3] in part[i-1]: translate(link[i].arm), rotate(link[i].place), rotate_z(q[i]))]
#[frame(tool[i in 0..3] in part[i]: translate(link[i].tool.at[0]), rotate(link[i].tool.turn))]
#[lagrangian(sum(i in 0..3,
    kinetic(part[i], link[i].m, link[i].c, link[i].inertia) + kinetic(tool[i], link[i].tool.m, link[i].tool.at[1])
    - base.g*(link[i].m*position(part[i], link[i].c)[2] + link[i].tool.m*position(tool[i], link[i].tool.at[1])[2])
))]
#[force(q: base.push[0..3]*base.type)]
#[observable(reach = position(tool[2], link[2].tool.at[1]))]
struct Arm<T> {
    link: [Link<T>; 3],
    base: Base<T>,
}

/// The same with fields of numbers.
#[derive(Lagrangian)]
#[coordinates(q: [3])]
#[parameter(inertia: symmetric)]
#[frame(part[0]: rotate(place[0]), rotate_z(q[0]))]
#[frame(part[i in 1..3] in part[i-1]: translate(arm[i]), rotate(place[i]), rotate_z(q[i]))]
#[frame(tool[i in 0..3] in part[i]: translate(at[i][0]), rotate(turn[i]))]
#[lagrangian(sum(i in 0..3,
    kinetic(part[i], m[i], c[i], inertia[i]) + kinetic(tool[i], load[i], at[i][1])
    - g*(m[i]*position(part[i], c[i])[2] + load[i]*position(tool[i], at[i][1])[2])
))]
#[force(q: push*share)]
#[observable(reach = position(tool[2], at[2][1]))]
struct Plain {
    m: [f64; 3],
    c: [Vector3<f64>; 3],
    inertia: [Matrix3<f64>; 3],
    place: [Rotation3<f64>; 3],
    arm: [[f64; 3]; 3],
    load: [f64; 3],
    at: [[[f64; 3]; 2]; 3],
    turn: [UnitQuaternion<f64>; 3],
    g: f64,
    share: f64,
    push: [f64; 3],
}

fn number(i: usize, k: usize) -> f64 {
    ((i * 7 + k * 3) as f64 * 0.618).fract() - 0.4
}

fn vector(i: usize, k: usize) -> [f64; 3] {
    core::array::from_fn(|j| number(i, k + j))
}

fn link(i: usize) -> Link<f64> {
    let root = Matrix3::from_fn(|r, c| number(i, 3 * r + c));
    Link {
        m: 1.0 + number(i, 0),
        c: vector(i, 12).into(),
        inertia: root * root.transpose() + Matrix3::identity(),
        place: Rotation3::from_scaled_axis(3.0 * Vector3::from(vector(i, 15))),
        arm: vector(i, 20),
        tool: Tool {
            m: 0.5 + number(i, 1),
            at: [vector(i, 30), vector(i, 40)],
            turn: UnitQuaternion::from_scaled_axis(2.0 * Vector3::from(vector(i, 50))),
        },
        label: "a link",
    }
}

fn arm() -> Arm<f64> {
    Arm { link: [0, 1, 2].map(link), base: Base { g: 9.81, r#type: 0.5, push: [1.0, -2.0, 3.0] } }
}

fn plain() -> Plain {
    let Arm { link, base } = arm();
    macro_rules! each {
        ($($member:tt)+) => { link.each_ref().map(|link| link.$($member)+) };
    }
    Plain {
        m: each!(m),
        c: each!(c),
        inertia: each!(inertia),
        place: each!(place),
        arm: each!(arm),
        load: each!(tool.m),
        at: each!(tool.at),
        turn: each!(tool.turn),
        g: base.g,
        share: base.r#type,
        push: base.push,
    }
}

fn state() -> State<f64, 3> {
    State::new([0.3, -1.2, 2.0], [1.5, -0.4, 0.7])
}

#[test]
fn members_are_the_numbers_that_fields_would_be() {
    let (arm, plain, state) = (arm(), plain(), state());
    assert_eq!(arm.lagrangian(&state), plain.lagrangian(&state));
    assert_eq!(arm.mass_matrix(&state), plain.mass_matrix(&state));
    assert_eq!(arm.reach(&state), plain.reach(&state));
    assert_eq!(arm.solve(&state).unwrap(), plain.solve(&state).unwrap());
}

/// In the order of the fields, one struct after the other.
#[test]
fn parameters_are_called_as_expressions_call_them() {
    let names = Arm::<f64>::PARAMETERS;
    assert_eq!(names.len(), Plain::PARAMETERS.len());
    assert_eq!(
        names[..5],
        ["link[0].m", "link[0].c[0]", "link[0].c[1]", "link[0].c[2]", "link[0].inertia[0][0]"]
    );
    let place = |name: &str| names.iter().position(|known| *known == name).unwrap();
    let in_order = [
        "link[0].tool.at[0][1]",
        "link[0].tool.turn[3]",
        "link[1].m",
        "link[2].place[2][1]",
        "link[2].tool.at[1][0]",
        "base.g",
        "base.type",
        "base.push[2]",
    ];
    assert!(in_order.windows(2).all(|pair| place(pair[0]) < place(pair[1])), "{names:?}");
    let (text, latex) =
        (Arm::<f64>::equations().text().to_owned(), Arm::<f64>::equations().latex().to_owned());
    assert!(text.contains("base.push[0 … 2]") && text.contains("link[i].tool.m"), "{text}");
    assert!(latex.contains(r"m_{\mathit{link}, i, \mathit{tool}}"), "{latex}");
    assert!(latex.contains(r"g_{\mathit{base}}"), "{latex}");
}

/// Against differences of accelerations, with the members changed in the struct itself.
#[test]
fn derivatives_by_members() {
    type Change = fn(&mut Arm<f64>, f64);
    let changes: [(&str, Change); 6] = [
        ("link[1].m", |arm, by| arm.link[1].m += by),
        ("link[2].c[1]", |arm, by| arm.link[2].c[1] += by),
        ("link[0].tool.m", |arm, by| arm.link[0].tool.m += by),
        ("link[2].tool.at[1][2]", |arm, by| arm.link[2].tool.at[1][2] += by),
        ("base.type", |arm, by| arm.base.r#type += by),
        ("link[1].inertia[0][2]", |arm, by| {
            arm.link[1].inertia[(0, 2)] += by;
            arm.link[1].inertia[(2, 0)] += by;
        }),
    ];
    let jacobian = arm().jacobian(&state()).unwrap();
    for (name, change) in changes {
        let k = Arm::<f64>::PARAMETERS.iter().position(|known| *known == name).unwrap();
        let moved = |by: f64| {
            let mut arm = arm();
            change(&mut arm, by);
            arm.solve(&state()).unwrap().accelerations
        };
        let difference = (8.0 * (moved(1e-3) - moved(-1e-3)) - (moved(2e-3) - moved(-2e-3))) / 12e-3;
        let by = jacobian.accelerations.parameters.column(k);
        assert!(difference.norm() > 1e-3, "{name} has no influence");
        assert!((by - difference).norm() < 1e-8 * difference.norm(), "{name}: {by} instead of {difference}");
    }
}

/// One number of a rotation cannot be changed alone, and what is in a member of a member may belong to others.
#[test]
fn members_are_set_by_name() {
    let mut arm = arm();
    let mut set = |name: &str, value: f64| {
        let k = Arm::<f64>::PARAMETERS.iter().position(|known| *known == name).unwrap();
        arm.set_parameter(k, value)
    };
    assert!(set("link[1].m", 7.0) && set("link[2].c[0]", 8.0) && set("link[0].inertia[0][1]", 9.0));
    assert!(set("base.push[1]", 10.0) && set("link[1].arm[2]", 11.0));
    assert!(
        !set("link[1].place[0][0]", 7.0) && !set("link[1].tool.turn[0]", 7.0) && !set("link[1].tool.m", 7.0)
    );
    let values = (arm.link[1].m, arm.link[2].c[0], arm.link[0].inertia[(0, 1)], arm.link[0].inertia[(1, 0)]);
    assert_eq!(values, (7.0, 8.0, 9.0, 9.0));
    assert_eq!((arm.base.push[1], arm.link[1].arm[2]), (10.0, 11.0));
}

#[test]
fn what_is_said_of_a_member_is_verified() {
    let fault = |arm: Arm<f64>| match arm.solve(&state()) {
        Err(Error::ParameterNotAsSaid { name, wanted, .. }) => (name, wanted),
        other => panic!("{other:?}"),
    };
    let mut skew = arm();
    skew.link[1].inertia[(2, 0)] += 1e-3;
    assert_eq!(fault(skew), ("link[1].inertia", "symmetric"));
    let mut bent = arm();
    bent.link[2].place = Rotation3::from_matrix_unchecked(bent.link[2].place.matrix() * 1.001);
    assert_eq!(fault(bent), ("link[2].place", "a rotation"));
}

/// Structs in a `Vec`, behind references and pointers, in arrays of arrays.
#[derive(Lagrangian, Clone)]
#[coordinates(x)]
#[parameter(borrowed: [2] {m})]
#[parameter(listed: [2] {m})]
#[parameter(slice: [2] {m})]
#[parameter(shared: {m, c: [3]})]
#[parameter(boxed: {m})]
#[parameter(rows: [2, 3] {m})]
#[parameter(one: {m})]
#[lagrangian((borrowed[1].m + listed[1].m)/2*x_dot^2 + (slice[0].m + shared.c[2] + boxed.m + rows[1][2].m + one.m)*x)]
struct Places<'a> {
    borrowed: &'a [Mass<f64>; 2],
    listed: Vec<Mass<f64>>,
    slice: &'a [Mass<f64>],
    shared: Arc<Link<f64>>,
    boxed: Box<Mass<f64>>,
    rows: [[Mass<f64>; 3]; 2],
    one: &'a Mass<f64>,
}

#[derive(Clone, Copy)]
struct Mass<T> {
    m: T,
}

#[test]
fn structs_may_be_elsewhere() {
    let [a, b] = [2.0, 3.0].map(|m| Mass { m });
    let mut places = Places {
        borrowed: &[a, b],
        listed: vec![a, b],
        slice: &[a, b],
        shared: Arc::new(link(0)),
        boxed: Box::new(a),
        rows: [[a; 3], [a, a, b]],
        one: &b,
    };
    let force = 2.0 + link(0).c[2] + 2.0 + 3.0 + 3.0;
    assert_eq!(places.solve(&State::at_rest([0.0])).unwrap().accelerations[0], force / 6.0);
    let is_set: Vec<&str> = (0..)
        .zip(Places::PARAMETERS)
        .filter_map(|(k, &name)| places.set_parameter(k, 1.0).then_some(name))
        .collect();
    assert_eq!(is_set, ["listed[1].m", "boxed.m", "rows[1][2].m"]);
}

/// The number type is that of the structs where nothing else says it.
#[derive(Lagrangian)]
#[coordinates(x)]
#[parameter(weights: [2] {m})]
#[lagrangian(weights[1].m*x_dot^2/2 + weights[0].m*x)]
struct Single {
    weights: Vec<Mass<f32>>,
}

#[test]
fn single_precision() {
    let single = Single { weights: vec![Mass { m: 3.0 }, Mass { m: 2.0 }] };
    assert_eq!(single.solve(&State::at_rest([0.0_f32])).unwrap().accelerations[0], 1.5_f32);
}

/// Conserved because of what is said of the members: where the random numbers of the check were none of these, this would
/// not compile.
#[derive(Lagrangian)]
#[coordinates(r: [3], q: [4])]
#[parameter(body: {inertia: symmetric, place: rotation, tool: {turn: quaternion}})]
#[define(x = body.place*quat_rotate(body.tool.turn, r))]
#[define(w = body.place*quat_rate_body(q, q_dot))]
#[lagrangian(dot(der(x), der(x))/2 - 1/dot(r, r) + dot(w, body.inertia*w)/2)]
#[constraint(unit: dot(q, q) = 1)]
#[conserved(spin = cross(r, r_dot))]
#[conserved(other_spin = quat_rotate(q, transpose(body.place)*(w*body.inertia)))]
struct Turned {
    body: Link<f64>,
}

#[test]
fn random_checks_keep_to_what_is_said() {
    let names: Vec<&str> = Turned::FACTS.conserved.iter().map(|found| found.name).collect();
    assert!(names.contains(&"spin[2]") && names.contains(&"other_spin[2]"), "{names:?}");
}

/// On lanes what the struct says itself: how its members lie there.
#[derive(Lagrangian)]
#[coordinates(x)]
#[parameter(bob: [2] {m})]
#[lagrangian(bob[1].m*x_dot^2/2 + bob[0].m*x)]
struct Bobs<T> {
    bob: [Mass<T>; 2],
}

impl<P: Packed<X>, X> Packed<Mass<X>> for Mass<P> {
    fn splat(field: &Mass<X>) -> Self {
        Self { m: P::splat(&field.m) }
    }

    fn place(&mut self, lane: usize, field: &Mass<X>) {
        self.m.place(lane, &field.m);
    }
}

#[test]
fn structs_lie_on_lanes() {
    let bobs = |a: f64, b: f64| Bobs { bob: [a, b].map(|m| Mass { m }) };
    let mut packed: Bobs<Lanes> = bobs(1.0, 2.0).pack();
    assert!(bobs(3.0, 4.0).place(&mut packed, 2));
    let solution = packed.accelerations_unchecked(&State::at_rest([Lanes::constant(0.0)]));
    assert_eq!(solution.accelerations[0].to_array()[..4], [0.5, 0.5, 0.75, 0.5]);
}
