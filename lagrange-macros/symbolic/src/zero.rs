//! Tests whether an expression is zero everywhere.

use super::evaluate::Approximate;
use super::graph::{Graph, Id, Symbol};
use super::sample::Sample;

/// Result of the test, with its certainty.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Verdict {
    /// Zero by its canonical form.
    Zero,
    /// Zero within rounding at this many random points.
    Held(u32),
    /// Nonzero: the error bound of a value excludes zero.
    NonZero,
    /// No point was found at which the expression has a value that does not underflow, or it has kinks.
    Undecided,
}

const POINTS: usize = 8;
const DRAWS: u64 = 64;
/// Largest error bound of a zero that may be an underflow. Terms that cancel leave ε times their size.
const UNDERFLOW: f64 = f64::MIN_POSITIVE / f64::EPSILON;

impl Graph {
    /// Tests whether `root` vanishes identically. `drawn` gives each symbol a value in each draw.
    pub fn is_zero(&mut self, root: Id, drawn: impl Fn(Symbol, u64) -> Approximate) -> Verdict {
        if root == Id::ZERO {
            return Verdict::Zero;
        }
        // Cheap test first: most nonzero expressions are nonzero at the first point, and their definitions need not be
        // inlined.
        if self.samples(root, &drawn).take(1).any(Approximate::excludes_zero) {
            return Verdict::NonZero;
        }
        let root = self.looked_through(root);
        if root == Id::ZERO {
            return Verdict::Zero;
        }
        // Outside its domain an expression has no finite value, and a product may underflow: use another draw.
        let is_known = |value: &Approximate| {
            value.value.is_finite() && value.error.is_finite() && value.error > UNDERFLOW
        };
        let mut held = 0;
        for value in self.samples(root, drawn).filter(is_known).take(POINTS) {
            if value.excludes_zero() {
                return Verdict::NonZero;
            }
            held += 1;
        }
        if held > 0 && !self.is_piecewise(&[root]) { Verdict::Held(held) } else { Verdict::Undecided }
    }

    /// Values at random points, one per draw.
    fn samples(
        &self,
        root: Id,
        drawn: impl Fn(Symbol, u64) -> Approximate,
    ) -> impl Iterator<Item = Approximate> {
        let symbols: Vec<Symbol> = self.symbols(&[root]).collect();
        (0..DRAWS)
            .map(move |draw| Sample::new(symbols.iter().copied(), draw, &drawn).values(self, &[root])[0])
    }
}
