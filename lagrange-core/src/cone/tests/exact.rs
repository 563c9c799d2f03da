//! Decisions repeated with rational numbers, on the faces that were found.

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{Signed, ToPrimitive, Zero};

use super::cases::{Case, Rows};
use crate::cone::{ConeDecision, Face, Limit, Set};

/// A rational number, with a positive denominator.
#[derive(Clone, Debug)]
struct Rational {
    over: BigInt,
    under: BigInt,
}

impl Rational {
    fn new(over: BigInt, under: BigInt) -> Self {
        let divisor = over.gcd(&under) * if under.is_negative() { -1 } else { 1 };
        Self { over: over / &divisor, under: under / divisor }
    }

    fn of(x: f64) -> Self {
        // 2⁵² of the least power of two below x is a whole number.
        let exponent = x.abs().max(f64::MIN_POSITIVE).log2().floor() as i32 - 53;
        let whole = BigInt::from((x / 2.0_f64.powi(exponent)) as i64);
        let power = BigInt::from(1) << exponent.unsigned_abs();
        if exponent < 0 { Self::new(whole, power) } else { Self::new(whole * power, BigInt::from(1)) }
    }

    fn to_f64(&self) -> f64 {
        let shift = 64 + self.under.bits() as i64 - self.over.bits() as i64;
        let shifted = |x: &BigInt, by: i64| if by > 0 { x.clone() << by as usize } else { x.clone() };
        let quotient = shifted(&self.over, shift) / shifted(&self.under, -shift);
        quotient.to_f64().expect("64 bits") * 2.0_f64.powi(-shift as i32)
    }

    fn plus(&self, other: &Self) -> Self {
        Self::new(&self.over * &other.under + &other.over * &self.under, &self.under * &other.under)
    }

    fn times(&self, other: &Self) -> Self {
        Self::new(&self.over * &other.over, &self.under * &other.under)
    }

    fn over(&self, other: &Self) -> Self {
        Self::new(&self.over * &other.under, &self.under * &other.over)
    }

    fn negated(&self) -> Self {
        Self { over: -&self.over, under: self.under.clone() }
    }
}

fn dot(x: &[Rational], y: &[Rational]) -> Rational {
    x.iter().zip(y).fold(Rational::of(0.0), |sum, (x, y)| sum.plus(&x.times(y)))
}

/// Solves A z = b by Gauss's elimination; `None` if the matrix is singular.
fn solve(mut a: Vec<Vec<Rational>>, mut b: Vec<Rational>) -> Option<Vec<Rational>> {
    let size = b.len();
    for k in 0..size {
        let pivot = (k..size).find(|&row| !a[row][k].over.is_zero())?;
        a.swap(k, pivot);
        b.swap(k, pivot);
        for row in (0..size).filter(|&row| row != k) {
            let factor = a[row][k].over(&a[k][k]).negated();
            a[row] = (0..size).map(|c| a[row][c].plus(&a[k][c].times(&factor))).collect();
            b[row] = b[row].plus(&b[k].times(&factor));
        }
    }
    Some((0..size).map(|k| b[k].over(&a[k][k])).collect())
}

/// The reactions and the change of velocities on the faces of a decision, with friction along one velocity; `None` if more than one solve
/// the equations.
fn exactly(case: &Case, found: &ConeDecision) -> Option<[Vec<f64>; 2]> {
    let rows: Vec<Vec<Rational>> =
        case.rows.iter().map(|row| row.iter().map(|x| Rational::of(*x)).collect()).collect();
    // What each unknown reaction comes with: rows, each with a factor.
    let mut unknowns: Vec<Vec<(usize, f64)>> = vec![];
    for (faces, blocks) in found.faces.chunks(2).zip(case.blocks.chunks(2)) {
        let (i, Set::Disc(Limit { mu, .. })) = (blocks[0].first, blocks[1].set) else {
            panic!("contacts alone")
        };
        match faces {
            [Face::Open, _] => {}
            [_, Face::Open] => unknowns.push(vec![(i, 1.0)]),
            [_, Face::Stick] => unknowns.extend([vec![(i, 1.0)], vec![(i + 1, 1.0)]]),
            [_, Face::Slide([along, _])] => unknowns.push(vec![(i, 1.0), (i + 1, along.signum() * mu)]),
            _ => unreachable!(),
        }
    }
    let column = |unknown: &Vec<(usize, f64)>| -> Vec<Rational> {
        let entry = |c: usize| {
            let parts = unknown.iter().map(|&(i, factor)| rows[i][c].times(&Rational::of(factor)));
            parts.fold(Rational::of(0.0), |sum, part| sum.plus(&part))
        };
        (0..case.n).map(entry).collect()
    };
    let columns: Vec<Vec<Rational>> = unknowns.iter().map(column).collect();
    let still = || unknowns.iter().map(|unknown| unknown[0].0);
    let matrix = still().map(|i| columns.iter().map(|column| dot(&rows[i], column)).collect()).collect();
    let z = solve(matrix, still().map(|i| Rational::of(-case.q[i])).collect())?;
    let mut r = vec![0.0; case.q.len()];
    for (unknown, z) in unknowns.iter().zip(&z) {
        unknown.iter().for_each(|&(i, factor)| r[i] = factor * z.to_f64());
    }
    let of = |c: usize| {
        z.iter().zip(&columns).fold(Rational::of(0.0), |sum, (z, column)| sum.plus(&z.times(&column[c])))
    };
    Some([r, (0..case.n).map(|c| of(c).to_f64()).collect()])
}

/// The largest error of velocities: 10⁻¹² of them, and what changes of the rates by 4·10⁻¹² of their terms, which the
/// certificate leaves, change them by on the same faces.
fn allowed(case: &Case, found: &ConeDecision, x: &[f64]) -> f64 {
    let mut moved = case.clone();
    for (i, row) in case.rows.iter().enumerate() {
        let terms = row.iter().zip(&case.motion).map(|(j, v)| (j * v).abs()).sum::<f64>();
        moved.q[i] += if i % 2 == 0 { 4e-12 } else { -4e-12 } * terms;
    }
    let by = exactly(&moved, found).map_or(f64::INFINITY, |[_, other]| distance(x, &other));
    1e-12 * x.iter().fold(0.0, |most, x| f64::max(most, x.abs())) + by
}

fn distance(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).fold(0.0, |most, (x, y)| f64::max(most, (x - y).abs()))
}

#[test]
fn rational_numbers_agree() {
    let mut compared = [0; 4];
    // Rows that depend on one another do so but for rounding, which rational numbers do not overlook.
    let kinds = [Rows::Independent, Rows::NearlyDependent, Rows::OfUnlikeMasses, Rows::Opposed];
    for (at, kind) in kinds.into_iter().enumerate() {
        let mut worst = 0.0_f64;
        for seed in 0..lagrange_random::cases([60, 200, 4_000]) as u64 {
            let case = Case::contacts(seed, kind);
            let found = case.decision();
            if !found.is_found || case.blocks[1].count != 1 {
                continue;
            }
            let Some([r, x]) = exactly(&case, &found) else { continue };
            let size = |x: &[f64]| x.iter().fold(0.0, |most, x| f64::max(most, x.abs()));
            let off = distance(&x, &found.change);
            worst = worst.max(off / size(&x).max(f64::MIN_POSITIVE));
            assert!(
                off <= allowed(&case, &found, &x),
                "{kind:?}, seed {seed}: velocities are off by {off:e}"
            );
            let unit = size(&r).max(f64::MIN_POSITIVE);
            for block in &case.blocks {
                let Set::Disc(Limit { mu, .. }) = block.set else { continue };
                let [push, drag] = [r[block.first - 1], r[block.first]];
                let over = (drag.abs() - mu * push).max(-push);
                assert!(
                    over <= 1e-12 * unit,
                    "{kind:?}, seed {seed}: a reaction leaves its set by {over:e} of {unit:e}"
                );
            }
            compared[at] += 1;
        }
        println!("{kind:?}: {} of one solution, velocities off by {worst:.1e} of them at most", compared[at]);
    }
    assert!(compared.iter().all(|count| *count >= 10), "{compared:?}");
}
