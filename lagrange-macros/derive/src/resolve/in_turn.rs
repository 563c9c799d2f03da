//! Detects whether a formulation in frames would be cheaper than the differentiation of positions.
//!
//! If several angles turn a vector one after another, its components contain products of that many sines and cosines.
//! Lagrange's equations differentiate each factor twice, and most of the resulting terms cancel. Frames differentiate
//! none of these products. From three angles on, frames took between an eighth and 0.6 of the operations wherever both
//! were counted: arms, tops, springs between points, planar chains of products. With two angles they may take more, as
//! they do if every link turns from the fixed axes.

use rustc_hash::FxHashMap;

use super::lowering::{Lowering, Setting};
use super::value::Value;
use crate::symbolic::{Function, Graph, Id, Node};
use crate::variables::Variable;

/// Minimum number of successive angles for which frames are recommended.
const ANGLES: usize = 3;

/// Time dependence of a scalar, and the angles in its products.
#[derive(Clone, Default)]
struct AngleUse {
    moves: bool,
    /// Distinct time-dependent angles whose sines and cosines are multiplied with each other; at most [`ANGLES`].
    by: Vec<Id>,
}

impl Lowering<'_> {
    /// Records the entries of vectors in space, or of matrices with three rows, whose time derivative is asked for.
    pub(super) fn note_differentiated(&mut self, value: &Value) {
        let is_in_space = value.length() == Some(3);
        if self.setting == Setting::Equations && is_in_space {
            self.differentiated.extend(value.flat());
        }
    }

    /// Returns whether a system without frames differentiates vectors that several successive angles turn.
    pub(super) fn frames_are_cheaper(&self) -> bool {
        let is_by_turns = !self.turns.is_empty() && self.declared_frames.is_empty();
        is_by_turns && turned_in_turn(&self.graph, &self.differentiated)
    }
}

fn turned_in_turn(graph: &Graph, roots: &[Id]) -> bool {
    let mut all: FxHashMap<Id, AngleUse> = FxHashMap::default();
    for id in graph.reachable(roots) {
        let mut turned = AngleUse::default();
        let is_product = matches!(graph.node(id), Node::Product(_));
        graph.operands(id, |operand| {
            let AngleUse { moves, by } = &all[&operand];
            turned.moves |= moves;
            if is_product {
                turned.join(by);
            } else if by.len() > turned.by.len() {
                turned.by.clone_from(by);
            }
        });
        match *graph.node(id) {
            Node::Symbol(symbol) => turned.moves = !matches!(Variable::of(symbol), Variable::Parameter(_)),
            Node::Function(Function::Sin | Function::Cos, angle) if turned.moves => turned.by = vec![angle],
            _ => {}
        }
        all.insert(id, turned);
    }
    roots.iter().any(|root| all[root].by.len() >= ANGLES)
}

impl AngleUse {
    fn join(&mut self, more: &[Id]) {
        for angle in more {
            if self.by.len() < ANGLES && !self.by.contains(angle) {
                self.by.push(*angle);
            }
        }
    }
}
