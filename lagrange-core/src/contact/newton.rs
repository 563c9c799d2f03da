//! Newton's method for the impulses of cones, where sweeps are slow (Alart and Curnier, *Computer Methods in Applied Mechanics and
//! Engineering* 92, 1991).

use super::cones::{Cone, ConeBlock, Cones, length};
use crate::number::{Real, Scalar};

/// Largest number of Newton steps at a time. A few find the impulses, once it is settled what sticks, slides, and parts.
const STEPS: usize = 10;

/// Change of the impulses, relative to all of them, below which those for one p₀ are found.
const STILL: f64 = 1e-9;

/// Weights α of the changes of impulses, relative to the responses, one after another.
const WEIGHTS: [f64; 6] = [1e-8, 1e-2, 1e-4, 1e-6, 1e-8, 1e-8];

impl<T: Real> Cones<T> {
    /// Solves p = proj(p − u/g − α (p − p₀)) by Newton steps from p₀, with smaller and smaller weights α, each from the solution of
    /// the one before (the proximal point method of Rockafellar 1976). Where other impulses can replace p, α determines it. Keeps
    /// the impulses with the smallest residual of the law itself.
    pub(super) fn newton(&mut self, tolerance: T) {
        let mut least = self.residual();
        self.best.clear();
        self.best.extend_from_slice(&self.impulses);
        for weight in WEIGHTS {
            self.center.clear();
            self.center.extend_from_slice(&self.impulses);
            for _ in 0..STEPS {
                self.linearize(T::constant(weight));
                if !eliminate(&mut self.jacobian, &mut self.right) {
                    break;
                }
                self.impulses.iter_mut().zip(&self.right).for_each(|(p, &change)| *p += change);
                let residual = self.residual();
                if residual < least {
                    least = residual;
                    self.best.copy_from_slice(&self.impulses);
                }
                if least <= tolerance {
                    self.impulses.copy_from_slice(&self.best);
                    return;
                }
                if self.is_still() || !residual.is_finite() {
                    break;
                }
            }
            self.impulses.copy_from_slice(&self.best);
        }
    }

    /// Whether the last Newton step changed next to nothing.
    fn is_still(&self) -> bool {
        let sum = |all: &[T]| all.iter().fold(T::constant(0.0), |sum, &x| sum + Scalar::abs(x));
        sum(&self.right) <= T::constant(STILL) * sum(&self.impulses)
    }

    /// u of a row with α g (p − p₀).
    fn weighted_rate(&self, row: usize, response: T, weight: T) -> T {
        self.rate(row) + weight * response * (self.impulses[row] - self.center[row])
    }

    /// Linear equations of a Newton step for the changes of the impulses.
    fn linearize(&mut self, weight: T) {
        let size = self.rates.len();
        self.right.clear();
        self.right.resize(size, T::constant(0.0));
        self.jacobian.clear();
        self.jacobian.resize(size * size, T::constant(0.0));
        for k in 0..self.blocks.len() {
            let block = self.blocks[k];
            let guess = self.guess(&block, weight);
            let limit = self.limit(&block.cone);
            match (block.cone, limit) {
                (Cone::Push, _) if guess[0] > T::constant(0.0) => self.keep_rate(&block, weight),
                (_, Some(limit)) if length(guess) <= limit => self.keep_rate(&block, weight),
                (Cone::Disc { radius, press }, Some(limit)) if limit > T::constant(0.0) => {
                    self.slide(&block, guess, limit, (radius, press));
                }
                _ => self.release(&block),
            }
        }
    }

    /// p − u/g of a block.
    fn guess(&self, &ConeBlock { place, count, response, .. }: &ConeBlock<T>, weight: T) -> [T; 2] {
        let at = |c: usize| {
            if c < count && response > T::constant(0.0) {
                self.impulses[place + c] - self.weighted_rate(place + c, response, weight) / response
            } else {
                T::constant(0.0)
            }
        };
        [at(0), at(1)]
    }

    /// The rates of a block become zero.
    fn keep_rate(&mut self, &ConeBlock { place, count, response, .. }: &ConeBlock<T>, weight: T) {
        let size = self.rates.len();
        for row in place..place + count {
            self.right[row] = -self.weighted_rate(row, response, weight) / response;
            for column in 0..size {
                self.jacobian[row * size + column] = self.entry(row, column) / response;
            }
            self.jacobian[row * size + row] += weight;
        }
    }

    /// The impulses of a block become zero.
    fn release(&mut self, &ConeBlock { place, count, .. }: &ConeBlock<T>) {
        let size = self.rates.len();
        for row in place..place + count {
            self.right[row] = -self.impulses[row];
            self.jacobian[row * size + row] = T::constant(1.0);
        }
    }

    /// The friction of a block is at its limit, along c = p − u/g: p − limit c/|c| = 0.
    fn slide(
        &mut self,
        &ConeBlock { place, count, response, .. }: &ConeBlock<T>,
        guess: [T; 2],
        limit: T,
        (radius, press): (T, Option<usize>),
    ) {
        let (size, far, one) = (self.rates.len(), length(guess), T::constant(1.0));
        let along = guess.map(|component| component / far);
        for i in 0..count {
            let row = place + i;
            self.right[row] = limit * along[i] - self.impulses[row];
            self.jacobian[row * size + row] += one;
            if let Some(press) = press {
                self.jacobian[row * size + press] -= radius * along[i];
            }
            // The direction turns with c, if there are two velocities.
            for j in 0..if count == 2 { 2 } else { 0 } {
                let across = if i == j { one } else { T::constant(0.0) } - along[i] * along[j];
                let turns = limit / far * across;
                self.jacobian[row * size + place + j] -= turns;
                for column in 0..size {
                    let change = turns * self.entry(place + j, column) / response;
                    self.jacobian[row * size + column] += change;
                }
            }
        }
    }
}

/// Solves linear equations by elimination with row pivoting: the right-hand side becomes the solution. Returns `false` if they
/// are singular.
pub(super) fn eliminate<T: Real>(matrix: &mut [T], right: &mut [T]) -> bool {
    let size = right.len();
    for k in 0..size {
        let (mut pivot, mut most) = (k, T::constant(0.0));
        for row in k..size {
            let entry = Scalar::abs(matrix[row * size + k]);
            if entry > most {
                (pivot, most) = (row, entry);
            }
        }
        if !(most > T::constant(0.0) && most.is_finite()) {
            return false;
        }
        if pivot != k {
            (k..size).for_each(|column| matrix.swap(k * size + column, pivot * size + column));
            right.swap(k, pivot);
        }
        let (above, below) = matrix.split_at_mut((k + 1) * size);
        let top = &above[k * size..];
        for (row, entries) in below.chunks_exact_mut(size).enumerate() {
            let factor = entries[k] / top[k];
            if factor == T::constant(0.0) {
                continue;
            }
            for column in k..size {
                entries[column] -= factor * top[column];
            }
            let change = factor * right[k];
            right[k + 1 + row] -= change;
        }
    }
    for k in (0..size).rev() {
        let rest =
            (k + 1..size).fold(right[k], |rest, column| rest - matrix[k * size + column] * right[column]);
        right[k] = rest / matrix[k * size + k];
    }
    true
}
