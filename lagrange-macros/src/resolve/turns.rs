//! Rotation matrices are known by the turns that they are written as, so that a frame that is turned by a product is turned
//! step by step: nothing is then differentiated, and what a turn about one axis leaves as it is costs nothing.

use rustc_hash::FxHashMap;

use super::lower::Lowering;
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
pub(super) type Turns = FxHashMap<Rotation, Vec<Turn>>;

/// Products of more turns take their squares: their lengths double from one definition to the next.
const TURN_LIMIT: usize = 100;

impl Value {
    /// The rows of a matrix that maps vectors in space.
    pub(super) fn as_map_of_space(&self) -> Option<Rotation> {
        let rows: Option<Vec<[Id; 3]>> =
            self.as_matrix()?.into_iter().map(|row| row.try_into().ok()).collect();
        rows?.try_into().ok()
    }
}

impl Lowering<'_> {
    /// The turns that a matrix is a product of, from the left; none where it is not known to be one. Whether what is
    /// placed is a rotation is left open.
    pub(super) fn turns_of(&self, matrix: Rotation) -> Option<Vec<Turn>> {
        let known = self.turns.get(&bare(&self.graph, matrix));
        known.cloned().or_else(|| (!self.move_in_time(&matrix.concat())).then(|| vec![Turn::Placed(matrix)]))
    }

    pub(super) fn remember_turn(&mut self, matrix: Rotation, axis: [Id; 3], angle: Id) {
        self.remember(matrix, vec![Turn::About(axis, angle)]);
    }

    /// What is known of two matrices, of their product.
    pub(super) fn remember_product(&mut self, x: &Value, y: &Value, product: &Value) {
        let [Some(x), Some(y), Some(product)] = [x, y, product].map(Value::as_map_of_space) else { return };
        let (Some(x), Some(y)) = (self.turns_of(x), self.turns_of(y)) else { return };
        self.remember(product, [x, y].concat());
    }

    /// What is known of a matrix, of its transpose.
    pub(super) fn remember_transpose(&mut self, matrix: &Value, transpose: &Value) {
        let [Some(matrix), Some(transpose)] = [matrix, transpose].map(Value::as_map_of_space) else { return };
        let Some(turns) = self.turns_of(matrix) else { return };
        let back = turns.into_iter().rev().map(|turn| match turn {
            Turn::About(axis, angle) => Turn::About(axis, self.graph.neg(angle)),
            Turn::Placed(rows) => Turn::Placed([0, 1, 2].map(|j| rows.map(|row| row[j]))),
        });
        let back = back.collect();
        self.remember(transpose, back);
    }

    /// What rests is one placement, however it is written.
    fn remember(&mut self, matrix: Rotation, turns: Vec<Turn>) {
        if turns.len() <= TURN_LIMIT && self.move_in_time(&matrix.concat()) {
            self.turns.insert(bare(&self.graph, matrix), turns);
        }
    }

    /// True if any of these expressions depends on time, coordinates or velocities.
    pub(super) fn move_in_time(&self, numbers: &[Id]) -> bool {
        self.graph.symbols(numbers).any(|symbol| !matches!(Variable::of(symbol), Variable::Parameter(_)))
    }
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
