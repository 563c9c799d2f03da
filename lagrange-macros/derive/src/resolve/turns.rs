//! Rotation matrices with the elementary turns that they are products of. A frame rotated by such a product is then
//! rotated turn by turn: no matrix is differentiated, and components that one turn leaves unchanged cost nothing.

use rustc_hash::FxHashMap;

use super::value::Value;
use crate::symbolic::{Graph, Id, Node};
use crate::variables::Variable;

/// Rows of a 3 × 3 rotation matrix.
pub(super) type Rotation = [[Id; 3]; 3];

/// Factor of a rotation.
#[derive(Clone, Debug)]
pub(super) enum Turn {
    /// Rotation about a unit axis by an angle.
    About([Id; 3], Id),
    /// Rotation by a matrix that is constant in time.
    Placed(Rotation),
}

/// Elementary turns of rotation matrices, keyed by the entries of the matrix.
#[derive(Default)]
pub(super) struct Turns(FxHashMap<Rotation, Vec<Turn>>);

/// Maximum number of turns kept for a product. Repeated squares in definitions double the number each time.
const TURN_LIMIT: usize = 100;

impl Turns {
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Elementary turns whose product is the matrix, leftmost first; `None` if they are not known. Constant matrices
    /// are returned as placements without a check that they are rotations.
    pub(super) fn of(&self, graph: &Graph, matrix: Rotation) -> Option<Vec<Turn>> {
        let known = self.0.get(&bare(graph, matrix)).cloned();
        known.or_else(|| (!move_in_time(graph, &matrix.concat())).then(|| vec![Turn::Placed(matrix)]))
    }

    /// Records the turns of a product, if those of both factors are known.
    pub(super) fn remember_product(&mut self, graph: &Graph, x: &Value, y: &Value, product: &Value) {
        let [Some(x), Some(y), Some(product)] = [x, y, product].map(Value::as_map_of_space) else { return };
        let (Some(x), Some(y)) = (self.of(graph, x), self.of(graph, y)) else { return };
        self.remember(graph, product, [x, y].concat());
    }

    /// Records the turns of a transpose, if those of the matrix are known.
    pub(super) fn remember_transpose(&mut self, graph: &mut Graph, matrix: &Value, transpose: &Value) {
        let [Some(matrix), Some(transpose)] = [matrix, transpose].map(Value::as_map_of_space) else { return };
        let Some(turns) = self.of(graph, matrix) else { return };
        let back = turns.into_iter().rev().map(|turn| match turn {
            Turn::About(axis, angle) => Turn::About(axis, graph.neg(angle)),
            Turn::Placed(rows) => Turn::Placed([0, 1, 2].map(|j| rows.map(|row| row[j]))),
        });
        let back = back.collect();
        self.remember(graph, transpose, back);
    }

    /// Records the turns of a matrix that changes in time. A constant matrix is a single placement, however it is
    /// written.
    pub(super) fn remember(&mut self, graph: &Graph, matrix: Rotation, turns: Vec<Turn>) {
        if turns.len() <= TURN_LIMIT && move_in_time(graph, &matrix.concat()) {
            self.0.insert(bare(graph, matrix), turns);
        }
    }
}

/// True if any of these expressions depends on time, coordinates or velocities.
pub(super) fn move_in_time(graph: &Graph, numbers: &[Id]) -> bool {
    graph.symbols(numbers).any(|symbol| !matches!(Variable::of(symbol), Variable::Parameter(_)))
}

/// Strips the definition nodes around each entry.
fn bare(graph: &Graph, matrix: Rotation) -> Rotation {
    let bare = |mut id: Id| {
        while let &Node::Defined(inner) = graph.node(id) {
            id = inner;
        }
        id
    };
    matrix.map(|row| row.map(bare))
}
