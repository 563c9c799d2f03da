//! Rotation matrices are known by the turns that they are written as, so that a frame that is turned by a product is turned
//! step by step: nothing is then differentiated, and what a turn about one axis leaves as it is costs nothing.

use rustc_hash::FxHashMap;

use super::value::Value;
use crate::symbolic::{Graph, Id, Node};
use crate::variables::Variable;

/// Three rows of three.
pub(super) type Rotation = [[Id; 3]; 3];

/// A part of a rotation.
#[derive(Clone, Debug)]
pub(super) enum Turn {
    /// About an axis of length 1, by an angle.
    About([Id; 3], Id),
    /// By a matrix that does not change in time.
    Placed(Rotation),
}

/// Rotations behind matrices, keyed by the entries of the matrix.
#[derive(Default)]
pub(super) struct Turns(FxHashMap<Rotation, Vec<Turn>>);

/// Products of more turns take their squares: their lengths double from one definition to the next.
const TURN_LIMIT: usize = 100;

impl Turns {
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The turns that a matrix is a product of, from the left; none where it is not known to be one. Whether what is
    /// placed is a rotation is left open.
    pub(super) fn of(&self, graph: &Graph, matrix: Rotation) -> Option<Vec<Turn>> {
        let known = self.0.get(&bare(graph, matrix));
        known
            .cloned()
            .or_else(|| (!move_in_time(graph, &matrix.concat())).then(|| vec![Turn::Placed(matrix)]))
    }

    /// What is known of two matrices, of their product.
    pub(super) fn remember_product(&mut self, graph: &Graph, x: &Value, y: &Value, product: &Value) {
        let [Some(x), Some(y), Some(product)] = [x, y, product].map(Value::as_map_of_space) else { return };
        let (Some(x), Some(y)) = (self.of(graph, x), self.of(graph, y)) else { return };
        self.remember(graph, product, [x, y].concat());
    }

    /// What is known of a matrix, of its transpose.
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

    /// What rests is one placement, however it is written.
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

/// Without the boundaries that definitions are.
fn bare(graph: &Graph, matrix: Rotation) -> Rotation {
    let bare = |mut id: Id| {
        while let &Node::Defined(inner) = graph.node(id) {
            id = inner;
        }
        id
    };
    matrix.map(|row| row.map(bare))
}
