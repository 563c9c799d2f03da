//! Is an expression zero everywhere?

use super::graph::{Graph, Id, Symbol};

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
        let order = self.reachable(&[root]);
        let mut held = 0;
        for draw in 0..DRAWS {
            let symbol = |symbol: Symbol| drawn(symbol, range(symbol), draw);
            let sample = self.evaluate_in(&order, symbol, |id, values| self.wave(id, values, draw));
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

/// A value of `symbol` in the range given, the same in every use of one draw.
pub(crate) fn drawn(symbol: Symbol, (low, high): (f64, f64), draw: u64) -> f64 {
    low + (high - low) * random(u64::from(symbol.family), u64::from(symbol.index), draw)
}

/// A number in [0, 1) that depends on nothing but its arguments (Steele, Lea and Flood's SplitMix64).
pub(super) fn random(family: u64, index: u64, draw: u64) -> f64 {
    let mut z = (family << 56) ^ (index << 16) ^ draw;
    for _ in 0..2 {
        z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
    }
    (z >> 11) as f64 / (1_u64 << 53) as f64
}
