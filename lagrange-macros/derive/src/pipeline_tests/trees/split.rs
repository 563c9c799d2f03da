//! Derivatives of the residual by composite bodies, against those along every coordinate and velocity by the chain rule.

use lagrange_core::generated::{Joint, JointColumn, Tree, TreeNumbers};
use lagrange_core::linearized::MotionGradients;
use lagrange_core::nalgebra::{Const, SVector};

use super::super::derived;
use super::{forest, input};
use crate::codegen::values;
use crate::mechanics::{BodyTree, SplitResidual, TreeColumn, TreeJoint};
use crate::symbolic::{Id, Symbol};
use crate::variables::Variable;
use lagrange_random::{Random, cases};

/// Length of the arrays that hold the coordinates, the joints and the columns of any tree of these tests.
const ROOM: usize = 64;
/// Number of blocks of four columns in such an array.
const BLOCKS: usize = ROOM / 4;

/// Largest accepted error, relative to the largest entry.
const TOLERANCE: f64 = 1e-12;

#[test]
fn bodies_and_the_rest_have_the_derivatives_of_the_residual() {
    let (mut number, mut compared, mut worst) = (0, 0, 0.0_f64);
    while compared < cases([6, 12, 1_000]) {
        if let Some(error) = error(number) {
            compared += 1;
            worst = worst.max(error);
        }
        number += 1;
    }
    println!("{compared} of {number} trees, the worst {worst:.1e} of the largest entry off");
}

/// A link on a shaft that turns in a bracket, with these steps of the shaft and these terms and attributes.
fn linked(shaft: &str, body: &str, more: &str) -> String {
    format!(
        "#[coordinates(q: [3])] #[frame(bracket: translate([q[0], 0, 0]))]
        #[frame(shaft in bracket: translate([a, 0, 0]), {shaft})] #[frame(link in shaft: rotate_x(q[2]))]
        #[lagrangian(kinetic(bracket, m, [0, 0, 0]) + {body} - m*g*position(link, [a, 0, 0])[2])] {more}
        struct Linked {{ m: f64, a: f64, g: f64, f: F, floor: Contact, hinge: Friction }}"
    )
}

#[test]
fn what_a_tree_cannot_state_is_left_to_the_chain_rule() {
    let (shaft, body) = ("rotate_y(q[1])", "kinetic(link, m, [a, 0, 0], [[m, 0, 0], [0, m, 0], [0, 0, m]])");
    let bodies = |source: &str| {
        let (mut graph, problem, derived) = derived(source);
        SplitResidual::of(&mut graph, &problem, &derived.equations, 0).map(|split| split.tree.bodies.len())
    };
    let others = format!("{body} + sin(t)*q[1]*q_dot[2]");
    let alone = linked(shaft, body, "").replace("kinetic(bracket, m, [0, 0, 0]) + ", "");
    let falling = alone.replace("position(link, [a, 0, 0])[2]", "position(link, [a, 0, 0])[0]");
    let cases = [
        ("as it is", Some(2), linked(shaft, body, "")),
        ("other terms", Some(2), linked(shaft, &others, "#[force(q[1]: cos(t)*q_dot[2]^2)]")),
        ("a mass that burns", Some(1), linked(shaft, &body.replace("link, m", "link, m*exp(-t)"), "")),
        ("a centre that moves", Some(1), linked(shaft, &body.replace("[a, 0, 0],", "[q[1], 0, 0],"), "")),
        (
            "an inertia that changes",
            Some(1),
            linked(shaft, &body.replace("[[m,", "[[m*(2 + sin(q[0])),"), ""),
        ),
        ("time in a rotation", None, linked("rotate_y(q[1] + t)", body, "")),
        ("time in a displacement", None, linked("rotate_y(q[1]), translate([0, a*t, 0])", body, "")),
        ("time in the first", None, linked(shaft, body, "").replace("[q[0], 0, 0]", "[q[0], t, 0]")),
        ("a rotation by a function", None, linked("rotate_y(f(q[1]))", body, "#[function(f(x))]")),
        ("a displacement by one", None, linked("translate([0, f(q[1]), 0])", body, "#[function(f(x))]")),
        ("a weight that changes", Some(2), linked(shaft, body, "").replace("m*g*", "m*g*cos(t)*")),
        ("gravity that changes", None, falling.replace("m*g*", "m*g*cos(t)*")),
        ("friction", None, linked(shaft, body, "#[friction(hinge: q_dot[1], sliding: a)]")),
        ("a contact", None, linked(shaft, body, "#[contact(floor: q[0] >= 0)]")),
    ];
    for (what, expected, source) in cases {
        assert_eq!(bodies(&source), expected, "{what}");
    }
}

/// The derivatives of a tree are there from 19 columns on, and up to 64 coordinates.
#[test]
fn trees_are_differentiated_where_they_are_neither_small_nor_large() {
    let has_tree = |bodies: usize| {
        let source = format!(
            "#[coordinates(r: [{bodies}, 2], a: [{bodies}])]
            #[frame(body[i in 0..{bodies}]: translate([r[i][0], r[i][1], 0]), rotate_z(a[i]))]
            #[lagrangian(sum(i in 0..{bodies}, kinetic(body[i], m, [l, 0, 0], [[0, 0, 0], [0, 0, 0], [0, 0, m]])))]
            struct Bodies {{ m: f64, l: f64 }}"
        );
        derived(&source).2.linearization.expect("derivatives").split.is_some()
    };
    assert_eq!([6, 7, 21, 22].map(has_tree), [false, true, true, false]);
}

/// Largest error for a tree, relative to the largest entry; `None` if its bodies are not differentiated by the tree.
fn error(number: u64) -> Option<f64> {
    let draft = forest::tree(number);
    let (mut graph, problem, derived) = derived(&draft.source());
    let split = SplitResidual::of(&mut graph, &problem, &derived.equations, 0)?;
    let n = problem.coordinates.len();
    let mut random = Random(number);
    let solved: Vec<f64> = (0..n + problem.constraints.len()).map(|_| random.between(-1.0, 1.0)).collect();
    let at = |direction: usize, symbol: Symbol| match Variable::of(symbol) {
        Variable::Acceleration(i) => solved[i],
        Variable::Multiplier(a) => solved[n + a],
        Variable::Change(k) => f64::from(u8::from(k == direction)),
        _ => input(&draft, &problem, symbol),
    };
    let velocities = |i: usize| at(0, Variable::Velocity(i).symbol());
    let gradients =
        gradients(&split.tree, n, |roots| values(&graph, roots, |symbol| at(0, symbol)), velocities, &solved);
    let whole = derived.linearization.expect("derivatives").by_state.motion;
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for k in 0..=2 * n {
        let [rest, expected] =
            [&split.by_state.motion, &whole].map(|motion| values(&graph, motion, |symbol| at(k, symbol)));
        for i in 0..n {
            let of_bodies = match k {
                0 => 0.0,
                k if k <= n => gradients.q[k - 1][i],
                k => gradients.v[k - 1 - n][i],
            };
            worst = worst.max((rest[i] + of_bodies - expected[i]).abs());
            largest = largest.max(expected[i].abs());
        }
    }
    let error = worst / largest.max(1e-3);
    assert!(error < TOLERANCE, "tree {number}: {worst:e} of {largest:e}\n{}", draft.source());
    Some(error)
}

/// Derivatives of the forces of the bodies of a tree, from the values of its expressions.
fn gradients(
    tree: &BodyTree,
    n: usize,
    values: impl Fn(&[Id]) -> Vec<f64>,
    velocity: impl Fn(usize) -> f64,
    accelerations: &[f64],
) -> MotionGradients<f64, Const<ROOM>> {
    let [poses, axes, rates, bends, bodies] = tree.numbers().map(|(rows, _)| rows);
    assert!(n.max(poses.len()).max(axes.len()) <= ROOM, "no room");
    let structure = Tree {
        joints: tree.joints.iter().map(joint).collect::<Vec<_>>().leak(),
        columns: columns(tree).leak(),
        bodies: tree.bodies.iter().map(|body| body.joint).collect::<Vec<_>>().leak(),
        bends: tree.bends.iter().map(|(pair, _)| *pair).collect::<Vec<_>>().leak(),
    };
    let numbers = TreeNumbers {
        poses: &in_room(&rows(&poses, &values)),
        axes: &in_room(&rows(&axes, &values)),
        rates: &rows(&rates, &values),
        bends: &rows(&bends, &values),
        bodies: &rows(&bodies, &values),
        fixed: &values(&tree.fixed).try_into().expect("three"),
    };
    let padded =
        |of: &dyn Fn(usize) -> f64| SVector::<f64, ROOM>::from_fn(|i, _| if i < n { of(i) } else { 0.0 });
    let mut gradients = MotionGradients::zero();
    gradients.add_bodies::<ROOM, ROOM, BLOCKS>(
        &structure,
        &numbers,
        &padded(&velocity),
        &padded(&|i| accelerations[i]),
    );
    gradients
}

fn joint(&TreeJoint { before, turns, columns, depth, .. }: &TreeJoint) -> Joint {
    Joint { before, turns, columns, depth }
}

fn columns(tree: &BodyTree) -> Vec<JointColumn> {
    let mut changing = 0..;
    let column = |column: &TreeColumn| JointColumn {
        coordinate: column.coordinate,
        changing: column.rates.and_then(|_| changing.next()),
    };
    tree.columns.iter().map(column).collect()
}

fn rows<const K: usize>(rows: &[Vec<Id>], values: impl Fn(&[Id]) -> Vec<f64>) -> Vec<[f64; K]> {
    rows.iter().map(|row| values(row).try_into().expect("K numbers")).collect()
}

fn in_room<const K: usize>(rows: &[[f64; K]]) -> [[f64; K]; ROOM] {
    std::array::from_fn(|i| rows.get(i).copied().unwrap_or([0.0; K]))
}
