//! Is an expression zero everywhere?

use super::graph::{Graph, Id, Symbol};
use super::sample::Sample;

/// How sure the answer is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Verdict {
    /// Zero by its canonical form.
    Zero,
    /// Zero within rounding at this many random points.
    Held(u32),
    /// Some value's error bound excludes zero.
    NonZero,
    /// No point was found at which the expression has a value.
    Undecided,
}

const POINTS: u32 = 8;
const DRAWS: u64 = 64;

impl Graph {
    /// Whether `root` vanishes identically. Each symbol is drawn from the range that `range` gives it.
    pub(crate) fn is_zero(&mut self, root: Id, range: impl Fn(Symbol) -> (f64, f64)) -> Verdict {
        let root = self.looked_through(root);
        if root == Id::ZERO {
            return Verdict::Zero;
        }
        let symbols: Vec<Symbol> = self.symbols(&[root]).collect();
        let mut held = 0;
        for draw in 0..DRAWS {
            let sample = Sample::new(symbols.iter().copied(), draw, &range).values(self, &[root])[0];
            // Outside its domain an expression has no value: draw again.
            if !sample.value.is_finite() || !sample.error.is_finite() {
                continue;
            }
            if sample.value.abs() > sample.error {
                return Verdict::NonZero;
            }
            held += 1;
            if held == POINTS {
                return Verdict::Held(held);
            }
        }
        if held > 0 { Verdict::Held(held) } else { Verdict::Undecided }
    }
}
