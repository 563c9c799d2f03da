//! Whether positions are differentiated that frames are meant for.
//!
//! Where several angles turn a vector one after another, products of as many sines and cosines are in it. Each factor
//! of them is differentiated twice, and what comes of it cancels for the most part; frames differentiate none of it. From
//! three angles on they took an eighth to 0.6 of the operations wherever both were counted: arms, tops, springs between
//! points, planar chains of products. With two they may take more, as they do where every link turns from the fixed axes.

use rustc_hash::FxHashMap;

use super::lowering::{Lowering, Setting};
use super::value::Value;
use crate::symbolic::{Function, Graph, Id, Node};
use crate::variables::Variable;

/// From as many angles on.
const ANGLES: usize = 3;

/// What is known of a number.
#[derive(Clone, Default)]
struct AngleUse {
    moves: bool,
    /// The arguments that change in time of the sines and cosines that are multiplied with each other, as many as count.
    by: Vec<Id>,
}

impl Lowering<'_> {
    /// Keeps in mind that vectors in space, or matrices, are differentiated.
    pub(super) fn note_differentiated(&mut self, value: &Value) {
        let is_in_space = value.length() == Some(3);
        if self.setting == Setting::Equations && is_in_space {
            self.differentiated.extend(value.flat());
        }
    }

    /// Whether vectors that are turned by several angles in turn are differentiated, without a frame.
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
