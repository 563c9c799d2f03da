//! Quaternions (w, x, y, z) for orientations (Goldstein, Poole and Safko, *Classical Mechanics*, 4.5).

use crate::symbolic::{Graph, Id, Rational};

/// Vector part of q v q̄: rotates v by a unit quaternion.
pub(super) fn rotate(q: [Id; 4], [x, y, z]: [Id; 3], graph: &mut Graph) -> [Id; 3] {
    let turned = product(q, [Id::ZERO, x, y, z], graph);
    let conjugate = conjugate(q, graph);
    vector_part(product(turned, conjugate, graph))
}

/// Vector part of 2 q̇ q̄: the angular velocity along the fixed axes.
pub(super) fn rate(q: [Id; 4], q_dot: [Id; 4], graph: &mut Graph) -> [Id; 3] {
    let conjugate = conjugate(q, graph);
    twice(vector_part(product(q_dot, conjugate, graph)), graph)
}

/// Vector part of 2 q̄ q̇: the angular velocity along the axes of the body.
pub(super) fn rate_in_body(q: [Id; 4], q_dot: [Id; 4], graph: &mut Graph) -> [Id; 3] {
    twice(half_rate_in_body(q, q_dot, graph), graph)
}

/// Vector part of q̄ q̇.
pub(super) fn half_rate_in_body(q: [Id; 4], q_dot: [Id; 4], graph: &mut Graph) -> [Id; 3] {
    let conjugate = conjugate(q, graph);
    vector_part(product(conjugate, q_dot, graph))
}

/// Rows of the rotation matrix of q/|q|, where `scale` is 2/|q|²: 1 + s w S + s S², with S v = (x, y, z) × v.
pub(super) fn matrix(q: [Id; 4], scale: Id, graph: &mut Graph) -> [[Id; 3]; 3] {
    let [w, v @ ..] = q;
    let one = Rational::from_integer(1);
    let mut times = |x: Id, y: Id| graph.product([scale, x, y].map(|factor| (factor, one)));
    let turn = v.map(|component| times(w, component));
    let square = v.map(|x| v.map(|y| times(x, y)));
    let minus = -one;
    let mut sum = |terms: &[(Id, Rational)]| graph.sum(terms.iter().copied());
    let diagonal = |i: usize, j: usize| [(Id::ONE, one), (square[i][i], minus), (square[j][j], minus)];
    let [a, b, c] = turn;
    [
        [
            sum(&diagonal(1, 2)),
            sum(&[(square[0][1], one), (c, minus)]),
            sum(&[(square[0][2], one), (b, one)]),
        ],
        [
            sum(&[(square[0][1], one), (c, one)]),
            sum(&diagonal(0, 2)),
            sum(&[(square[1][2], one), (a, minus)]),
        ],
        [
            sum(&[(square[0][2], one), (b, minus)]),
            sum(&[(square[1][2], one), (a, one)]),
            sum(&diagonal(0, 1)),
        ],
    ]
}

pub(super) fn conjugate([w, x, y, z]: [Id; 4], graph: &mut Graph) -> [Id; 4] {
    [w, graph.neg(x), graph.neg(y), graph.neg(z)]
}

fn vector_part([_, x, y, z]: [Id; 4]) -> [Id; 3] {
    [x, y, z]
}

fn twice(v: [Id; 3], graph: &mut Graph) -> [Id; 3] {
    v.map(|x| graph.sum([(x, Rational::from_integer(2))]))
}

/// Hamilton's product of two quaternions.
pub(super) fn product(p: [Id; 4], q: [Id; 4], graph: &mut Graph) -> [Id; 4] {
    // Terms of each component of the product: index into p, index into q, sign.
    const ROWS: [[(usize, usize, i128); 4]; 4] = [
        [(0, 0, 1), (1, 1, -1), (2, 2, -1), (3, 3, -1)],
        [(0, 1, 1), (1, 0, 1), (2, 3, 1), (3, 2, -1)],
        [(0, 2, 1), (2, 0, 1), (3, 1, 1), (1, 3, -1)],
        [(0, 3, 1), (3, 0, 1), (1, 2, 1), (2, 1, -1)],
    ];
    ROWS.map(|row| {
        let terms = row.map(|(i, j, sign)| (graph.mul(p[i], q[j]), Rational::from_integer(sign)));
        graph.sum(terms)
    })
}
