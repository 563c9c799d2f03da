//! Impulses in their cones, by projected Gauss–Seidel sweeps (Jourdan, Alart and Jean, *Computer Methods in Applied Mechanics
//! and Engineering* 155, 1998; Acary and Brogliato, *Numerical Methods for Nonsmooth Dynamical Systems*, 2008, 13.7.4).

use alloc::vec::Vec;

use crate::number::{Real, Scalar, larger};

/// Number of sweeps after which Newton's method is tried first.
const NEWTON: usize = 8;

/// Impulses of the last step are forgotten where they exceed the rates of this one by this factor. Those that carry a stack of a
/// hundred bodies exceed the rates by a hundred.
const FORGOTTEN: f64 = 1e4;

/// Allowed impulses of a gap or of a friction.
#[derive(Clone, Copy, Debug)]
pub(super) enum Cone<T> {
    /// A gap pushes: p ≥ 0.
    Push,
    /// Friction of one or two velocities: |p| ≤ radius · p of the row that presses, or |p| ≤ radius if there is none.
    Disc { radius: T, press: Option<usize> },
}

/// A gap or a friction among the rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct ConeBlock<T> {
    pub(super) place: usize,
    pub(super) count: usize,
    pub(super) cone: Cone<T>,
    /// Largest eigenvalue of its block of G, the inverse of its mass.
    pub(super) response: T,
}

/// The problem u = G p + c with −u in the normal cone of the allowed impulses at p: for a gap u ≥ 0, p ≥ 0 and u p = 0, and for
/// friction Coulomb's law. Its memory is kept from step to step.
pub(super) struct Cones<T> {
    /// G, with rows of this length.
    stride: usize,
    matrix: Vec<T>,
    pub(super) rates: Vec<T>,
    pub(super) impulses: Vec<T>,
    pub(super) blocks: Vec<ConeBlock<T>>,
    /// The equations of a Newton step, by rows, and their right-hand side, which becomes the solution.
    pub(super) jacobian: Vec<T>,
    pub(super) right: Vec<T>,
    /// The impulses with the smallest residual of several Newton steps, and those near which they stay.
    pub(super) best: Vec<T>,
    pub(super) center: Vec<T>,
}

/// How the sweeps end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Swept<T> {
    pub(super) iterations: usize,
    pub(super) residual: T,
}

impl<T: Real> Cones<T> {
    /// Memory for so many rows.
    pub(super) fn with_room(rows: usize) -> Self {
        Self {
            stride: rows,
            matrix: alloc::vec![T::constant(0.0); rows * rows],
            rates: Vec::with_capacity(rows),
            impulses: Vec::with_capacity(rows),
            blocks: Vec::with_capacity(rows),
            jacobian: Vec::with_capacity(rows * rows),
            right: Vec::with_capacity(rows),
            best: Vec::with_capacity(rows),
            center: Vec::with_capacity(rows),
        }
    }

    pub(super) fn clear(&mut self) {
        self.rates.clear();
        self.impulses.clear();
        self.blocks.clear();
    }

    /// Appends a row with its c and a first guess of its impulse. `entry` gives G between it and each row up to itself.
    pub(super) fn push_row(&mut self, rate: T, guess: T, entry: impl Fn(usize) -> T) {
        let new = self.rates.len();
        for other in 0..=new {
            let value = entry(other);
            (self.matrix[new * self.stride + other], self.matrix[other * self.stride + new]) = (value, value);
        }
        self.rates.push(rate);
        self.impulses.push(guess);
    }

    /// Makes the last rows a gap or a friction.
    pub(super) fn push_block(&mut self, count: usize, cone: Cone<T>) {
        let place = self.rates.len() - count;
        let first = self.entry(place, place);
        let response = match count {
            1 => first,
            _ => {
                let (second, beside) = (self.entry(place + 1, place + 1), self.entry(place, place + 1));
                let [half, apart] = [first + second, first - second].map(|x| x * T::constant(0.5));
                half + Scalar::sqrt(apart * apart + beside * beside)
            }
        };
        self.blocks.push(ConeBlock { place, count, cone, response });
    }

    pub(super) fn entry(&self, row: usize, column: usize) -> T {
        self.matrix[row * self.stride + column]
    }

    pub(super) fn impulses(&self) -> &[T] {
        &self.impulses
    }

    /// Allowed size of the impulse of the friction whose first row has this place.
    pub(super) fn radius(&self, place: usize) -> Option<T> {
        let block = self.blocks.iter().find(|block| block.place == place)?;
        self.limit(&block.cone)
    }

    pub(super) fn limit(&self, cone: &Cone<T>) -> Option<T> {
        let press = |row: usize| larger(self.impulses[row], T::constant(0.0));
        match *cone {
            Cone::Push => None,
            Cone::Disc { radius, press: row } => Some(row.map_or(radius, |row| radius * press(row))),
        }
    }

    /// u of a row.
    pub(super) fn rate(&self, row: usize) -> T {
        let pushes = self.impulses.iter().zip(&self.matrix[row * self.stride..]);
        pushes.fold(self.rates[row], |sum, (&p, &g)| sum + g * p)
    }

    /// Sweeps forwards and backwards until the residual is within the tolerance, at least once. Newton's method is tried when
    /// the number of sweeps doubles.
    pub(super) fn solve(&mut self, tolerance: T, max_iterations: usize) -> Swept<T> {
        self.forget();
        self.relieve();
        let (mut iterations, mut newton, scale) = (0, NEWTON, self.scale());
        loop {
            let change = self.sweep(iterations % 2 == 1);
            iterations += 1;
            // The change says when it is worthwhile to compute the residual, in the last sweep it must be.
            if change <= tolerance * scale || iterations >= max_iterations || !change.is_finite() {
                self.clip();
                let residual = self.residual();
                if residual <= tolerance || iterations >= max_iterations || !residual.is_finite() {
                    return Swept { iterations, residual };
                }
            }
            if iterations == newton {
                self.newton(tolerance);
                newton *= 2;
                self.clip();
                let residual = self.residual();
                if residual <= tolerance {
                    return Swept { iterations, residual };
                }
            }
        }
    }

    /// Shortens the impulses of friction to the limits of the last impulses that press.
    fn clip(&mut self) {
        for k in 0..self.blocks.len() {
            let block = self.blocks[k];
            let clipped = self.projected(&block.cone, self.of_block(&block, |row| self.impulses[row]));
            let ConeBlock { place, count, .. } = block;
            self.impulses[place..place + count].copy_from_slice(&clipped[..count]);
        }
    }

    /// Moves the impulse of each block to where its own law holds. Returns the largest change, in units of the square root of
    /// energy.
    fn sweep(&mut self, backwards: bool) -> T {
        let mut change = T::constant(0.0);
        for turn in 0..self.blocks.len() {
            let block = self.blocks[if backwards { self.blocks.len() - 1 - turn } else { turn }];
            let (defect, next) = self.natural(&block);
            change = worse(change, defect);
            self.impulses[block.place..block.place + block.count].copy_from_slice(&next[..block.count]);
        }
        change
    }

    /// Largest defect |p − proj(p − u/g)| √g of all blocks, divided by the scale. Impulses that grow without end, as between walls
    /// that close in, do not make it smaller.
    pub(super) fn residual(&self) -> T {
        let defects = self.blocks.iter().map(|block| self.natural(block).0);
        let most = defects.fold(T::constant(0.0), worse);
        if most == T::constant(0.0) { most } else { most / self.scale() }
    }

    /// The largest |c|/√g.
    pub(super) fn scale(&self) -> T {
        self.blocks.iter().filter(|block| block.response > T::constant(0.0)).fold(
            T::constant(0.0),
            |scale, block| {
                let constant = self.of_block(block, |row| self.rates[row]);
                larger(scale, length(constant) / Scalar::sqrt(block.response))
            },
        )
    }

    /// Begins without impulses where those given are much larger than the rates demand, as after an impact: their round-off would
    /// be all that is left.
    fn forget(&mut self) {
        let largest = self.blocks.iter().fold(T::constant(0.0), |largest, block| {
            let impulse = self.of_block(block, |row| self.impulses[row]);
            larger(largest, length(impulse) * Scalar::sqrt(larger(block.response, T::constant(0.0))))
        });
        if largest > T::constant(FORGOTTEN) * self.scale() {
            self.impulses.fill(T::constant(0.0));
        }
    }

    /// Lets contacts that push too hard push less, before others push against them: of a body between two walls, the guess for one
    /// would else be balanced by the other, and both keep the largest load that there was.
    fn relieve(&mut self) {
        for k in 0..self.blocks.len() {
            let block = self.blocks[k];
            let (Cone::Push, place) = (block.cone, block.place) else { continue };
            let [next, _] = self.natural(&block).1;
            if next < self.impulses[place] {
                self.impulses[place] = next;
            }
        }
    }

    /// Numbers of the rows of a block.
    fn of_block(&self, block: &ConeBlock<T>, of: impl Fn(usize) -> T) -> [T; 2] {
        [0, 1].map(|c| if c < block.count { of(block.place + c) } else { T::constant(0.0) })
    }

    /// Defect of the natural map of a block, and proj(p − u/g).
    fn natural(&self, block: &ConeBlock<T>) -> (T, [T; 2]) {
        let (rate, before) =
            (self.of_block(block, |row| self.rate(row)), self.of_block(block, |row| self.impulses[row]));
        let (zero, response) = (T::constant(0.0), block.response);
        if response <= zero {
            // No impulse moves it.
            let closes = matches!(block.cone, Cone::Push) && rate[0] < zero;
            return (if closes { T::constant(f64::INFINITY) } else { zero }, [zero; 2]);
        }
        let next = self.projected(&block.cone, [0, 1].map(|c| before[c] - rate[c] / response));
        (length([next[0] - before[0], next[1] - before[1]]) * Scalar::sqrt(response), next)
    }

    fn projected(&self, cone: &Cone<T>, impulse: [T; 2]) -> [T; 2] {
        let zero = T::constant(0.0);
        let Some(limit) = self.limit(cone) else { return [larger(impulse[0], zero), zero] };
        let size = length(impulse);
        if size <= limit { impulse } else { impulse.map(|component| component * (limit / size)) }
    }
}

/// The larger of two defects; NaN if one is.
fn worse<T: Real>(most: T, defect: T) -> T {
    if defect <= most || most.partial_cmp(&most).is_none() { most } else { defect }
}

pub(super) fn length<T: Real>([x, y]: [T; 2]) -> T {
    Scalar::sqrt(x * x + y * y)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A block on a floor, of unit mass, with one or two velocities along it.
    fn block(rates: [f64; 3], count: usize) -> (Vec<f64>, Swept<f64>) {
        let mut cones = Cones::with_room(3);
        cones.push_row(rates[0], 0.0, |_| 1.0);
        cones.push_block(1, Cone::Push);
        for c in 1..=count {
            cones.push_row(rates[c], 0.0, |other| if other == c { 1.0 } else { 0.0 });
        }
        cones.push_block(count, Cone::Disc { radius: 0.5, press: Some(0) });
        let swept = cones.solve(1e-14, 100);
        (cones.impulses, swept)
    }

    #[test]
    fn a_block_sticks_slides_and_parts() {
        assert_eq!(block([-1.0, 0.25, 0.0], 1).0, [1.0, -0.25]);
        assert_eq!(block([-1.0, -2.0, 0.0], 1).0, [1.0, 0.5]);
        assert_eq!(block([1.0, -2.0, 0.0], 1).0, [0.0, 0.0]);
        assert_eq!(block([0.0; 3], 2).1.residual, 0.0);
        let slides = block([-1.0, 3.0, 4.0], 2).0;
        assert!(
            [1.0, -0.3, -0.4].iter().zip(&slides).all(|(x, y): (&f64, &f64)| (x - y).abs() < 1e-15),
            "{slides:?}"
        );
    }

    #[test]
    fn walls_that_close_in_and_numbers_that_are_none_are_no_solution() {
        let mut cones = Cones::with_room(2);
        cones.push_row(-1.0, 0.0, |_| 1.0);
        cones.push_block(1, Cone::Push);
        cones.push_row(-1.0, 0.0, |other| if other == 1 { 1.0 } else { -1.0 });
        cones.push_block(1, Cone::Push);
        assert!(cones.solve(1e-10, 1000).residual > 0.1);
        assert!(block([f64::NAN, 0.0, 0.0], 1).1.residual.is_nan());
    }
}
