//! Rows of the constraint Jacobian that parameters may cancel, and the rounding errors of their entries.
//!
//! Where the plane of a linkage is turned by the angle a + b at one base and by c at the other, a + b = c leaves nothing
//! of the constraint across the plane but round-off, at every pose. The runtime compares such a row with its rounding
//! errors. A row that vanishes at isolated poses only is no such row.

use rustc_hash::FxHashMap;

use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Node, RoundOff, Symbol};
use crate::variables::Variable;

/// For each row that parameters may cancel, the bounds of the rounding errors of its entries, in units of the round-off
/// unit; zeros for the other rows. Friction has none: as its force is bounded, a row that is round-off changes nothing else.
pub(super) fn round_off(graph: &mut Graph, problem: &Problem, jacobian: &[Vec<Id>]) -> Vec<Vec<Id>> {
    let variations = Variations::of(graph, &jacobian.concat());
    let mut bounds = RoundOff::default();
    let is_friction = |row: usize| problem.frictions.iter().any(|friction| friction.rows().contains(&row));
    let lasts = |row: &[Id]| row.iter().any(|entry| variations.lasts(entry));
    let rows = jacobian.iter().enumerate().map(|(a, row)| match is_friction(a) || lasts(row) {
        false => row.iter().map(|&entry| bounds.of(graph, entry)).collect(),
        true => vec![Id::ZERO; row.len()],
    });
    rows.collect()
}

/// What remains of an expression, whatever the parameters that are not zero. Coordinates and time are one bit each.
#[derive(Clone, Default)]
struct Variation {
    /// Coordinates in the expression.
    contained: Bits,
    /// Coordinates with which the expression certainly varies.
    certain: Bits,
    /// True if the expression is certainly nonzero, except at isolated poses.
    lasts: bool,
}

type Bits = Vec<u64>;

struct Variations(FxHashMap<Id, Variation>);

impl Variations {
    fn of(graph: &Graph, roots: &[Id]) -> Self {
        let mut found = Self(FxHashMap::default());
        for id in graph.reachable(roots) {
            let variation = found.step(graph, id);
            found.0.insert(id, variation);
        }
        found
    }

    fn lasts(&self, id: &Id) -> bool {
        *id != Id::ZERO && self.0[id].lasts
    }

    /// Variation of a node, from those of its operands.
    ///
    /// A coordinate in one operand alone cannot be cancelled by the others: x in sin(x) + a cos(y). In x/|x| or in
    /// sin(y + b x) − sin(y) several operands contain one coordinate, and the expression may be constant.
    fn step(&self, graph: &Graph, id: Id) -> Variation {
        let (mut contained, mut repeated, mut certain) = (Bits::new(), Bits::new(), Bits::new());
        let mut all_last = true;
        graph.operands(id, |operand| {
            let operand = &self.0[&operand];
            unite(&mut repeated, &common(&contained, &operand.contained));
            unite(&mut contained, &operand.contained);
            unite(&mut certain, &operand.certain);
            all_last &= operand.lasts;
        });
        certain.iter_mut().zip(&repeated).for_each(|(bits, repeated)| *bits &= !repeated);
        let varies = certain.iter().any(|&bits| bits != 0);
        let lasts = match graph.node(id) {
            Node::Symbol(symbol) => {
                mark(*symbol, &mut contained);
                certain.clone_from(&contained);
                true
            }
            Node::Number(_) | Node::Pi | Node::External(_) => true,
            Node::Defined(_) | Node::Product(_) | Node::Atan2(..) | Node::Power(..) => all_last,
            Node::Sum(terms) => varies || terms.len() == 1 && all_last,
            // Parameters that cancel in an argument leave a constant, as in sin((a - b) q).
            Node::Function(..) => varies,
        };
        // A factor that is round-off leaves nothing of the others.
        if !lasts {
            certain.clear();
        }
        Variation { contained, certain, lasts }
    }
}

fn mark(symbol: Symbol, bits: &mut Bits) {
    let place = match Variable::of(symbol) {
        Variable::Time => 0,
        Variable::Coordinate(i) => i + 1,
        _ => return,
    };
    bits.resize(place / 64 + 1, 0);
    bits[place / 64] |= 1 << (place % 64);
}

fn unite(bits: &mut Bits, more: &[u64]) {
    bits.resize(bits.len().max(more.len()), 0);
    bits.iter_mut().zip(more).for_each(|(bits, more)| *bits |= more);
}

fn common(one: &[u64], other: &[u64]) -> Bits {
    one.iter().zip(other).map(|(one, other)| one & other).collect()
}
