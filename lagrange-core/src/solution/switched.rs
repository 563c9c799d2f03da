//! Accelerations and multipliers of systems with constraints that can be switched off: contacts, friction, and `when: field`.
//!
//! The equations are M q̈ − Bᵀλ = h and F q̈ + γ + c λ = 0. A row of F has the coefficients of the accelerations in one constraint. B is F,
//! but in the row of a contact it has the friction that slides, too, since that is a multiple of the force of the contact. c is 1 on
//! the diagonal for a constraint that does not hold, so that its multiplier is −γ; beside the diagonal, it has the ratio of the friction that
//! slides to the force of its contact.
//!
//! The derive macro emits the elimination of M, and the rows of the constraints, group by group. The rows that hold are put together at
//! run time: the code grows with the number of constraints, and the time with the number of those that hold. F M⁻¹ Bᵀ is factorized as
//! L D U. (Golub and Van Loan, *Matrix Computations*, 4.1.2, and the range-space method of Nocedal and Wright, *Numerical Optimization*,
//! 16.2.)

use core::fmt::Debug;

use nalgebra::Const;

use super::eliminate::nan_if_ill_conditioned;
use crate::number::{Broadcast, Scalar};
use crate::numerics::ldl::poison;
use crate::system::{Lagrangian, Solution, SolutionOf, StateOf, System};
use crate::vector::{Array, Element, StaticLength, Vector, array, vector, zeros};

/// Place of a constraint's numbers in the array of all rows. Its row of F comes first, then its row of B if that differs, then the diagonal
/// entry of c, the entry of c beside the diagonal, the weight σ with which the constraint completes M, and γ.
#[derive(Clone, Copy, Debug)]
pub struct ConstraintRow {
    /// Index of the constraint.
    pub constraint: usize,
    /// Coordinates with entries in F or B.
    pub columns: &'static [usize],
    /// True if the row of B differs from that of F.
    pub pushes: bool,
    /// Index of its first number.
    pub start: usize,
}

/// Numbers that follow the entries of F and B in a row.
#[derive(Clone, Copy)]
enum RowNumber {
    /// Diagonal entry of c: 0 where the constraint holds, else 1.
    Compliance,
    /// Entry of c in the column of the first row of the group.
    Coupling,
    Weight,
    Bias,
}

impl ConstraintRow {
    pub(crate) fn jacobian<'n, T>(&self, numbers: &'n [T]) -> &'n [T] {
        &numbers[self.start..][..self.columns.len()]
    }

    /// The row of B.
    fn push<'n, T>(&self, numbers: &'n [T]) -> &'n [T] {
        let skipped = if self.pushes { self.columns.len() } else { 0 };
        &numbers[self.start + skipped..][..self.columns.len()]
    }

    fn number<T: Copy>(&self, which: RowNumber, numbers: &[T]) -> T {
        numbers[self.start + self.columns.len() * (1 + usize::from(self.pushes)) + which as usize]
    }

    /// Product of entries in the columns with a vector.
    #[inline(always)]
    fn dot<T: Scalar, S: Broadcast<T>, N: StaticLength>(&self, entries: &[T], x: &Array<S, N>) -> S {
        let mut sum = S::constant(0.0);
        if entries.len() == N::COUNT {
            for i in 0..N::COUNT {
                sum = sum + S::of(entries[i]) * x[i];
            }
        } else {
            for (&entry, &i) in entries.iter().zip(self.columns) {
                sum = sum + S::of(entry) * x[i];
            }
        }
        sum
    }

    /// Adds a multiple of entries in the columns to a vector.
    #[inline(always)]
    fn add<T: Scalar, S: Broadcast<T>, N: StaticLength>(
        &self,
        entries: &[T],
        factor: S,
        x: &mut Array<S, N>,
    ) {
        if entries.len() == N::COUNT {
            for i in 0..N::COUNT {
                x[i] = x[i] + S::of(entries[i]) * factor;
            }
        } else {
            for (&entry, &i) in entries.iter().zip(self.columns) {
                x[i] = x[i] + S::of(entry) * factor;
            }
        }
    }
}

/// What the derive macro emits for a system with constraints that can be switched off.
pub trait Switched: Lagrangian {
    /// Factorization of the mass matrix, completed by constraints that always hold.
    type Inertia: Copy + Debug + Send + Sync;
    /// Length of the array with the numbers of all rows.
    type Numbers: StaticLength;
    /// Largest number of rows that can hold at once.
    type Held: StaticLength;
    /// All constraints, group by group. Those of a group are computed together: all that always hold, a contact with its friction,
    /// other friction, or what one field switches.
    const GROUPS: &'static [&'static [ConstraintRow]];

    /// Returns false if the field of a group switches all its constraints off, so that their multipliers are zero.
    fn may_hold(&self, group: usize) -> bool;

    /// Stores the numbers of a group.
    fn rows(&self, group: usize, state: &StateOf<Self>, numbers: &mut Array<Self::Scalar, Self::Numbers>);

    /// Number of entries of the mass matrix that are not zero at every state.
    type Masses: StaticLength;
    /// Row and column of each of these entries, row by row.
    const MASSES: &'static [[usize; 2]];

    /// Returns these entries.
    fn masses(&self, state: &StateOf<Self>) -> Array<Self::Scalar, Self::Masses>;

    /// Factorizes the mass matrix. Also returns h.
    fn inertia(&self, state: &StateOf<Self>) -> (Self::Inertia, Vector<Self::Scalar, Self::N>);

    /// Solves M x = `forcing`.
    fn solve_inertia<S: Broadcast<Self::Scalar>>(
        &self,
        inertia: &Self::Inertia,
        forcing: &Vector<S, Self::N>,
    ) -> Solution<S, Self::N, Const<0>>;
}

/// Factorization of the equations of motion of a system with constraints that can be switched off.
#[derive(Clone, Copy, Debug)]
pub struct SwitchedFactor<I, T: Element, N: StaticLength, H: StaticLength> {
    inertia: I,
    numbers: Array<T, N>,
    /// Group and index of the rows that hold.
    held: Array<[usize; 2], H>,
    count: usize,
    /// F M⁻¹ Bᵀ: L below the diagonal, D⁻¹ on it, D U above.
    schur: Array<Array<T, H>, H>,
    pivot: T,
}

/// The factorization of a system.
pub type SwitchedFactorOf<L> = SwitchedFactor<
    <L as Switched>::Inertia,
    <L as System>::Scalar,
    <L as Switched>::Numbers,
    <L as Switched>::Held,
>;

/// Solves the equations of motion.
#[inline]
pub fn accelerations<L: Switched>(system: &L, state: &StateOf<L>) -> SolutionOf<L> {
    let (factor, forcing) = SwitchedFactorOf::<L>::with_forcing(system, state);
    let mut bias = zeros();
    for row in L::GROUPS.iter().copied().flatten() {
        bias[row.constraint] = row.number(RowNumber::Bias, &factor.numbers);
    }
    factor.solve(system, &forcing, &bias)
}

impl<I, T: Scalar, N: StaticLength, H: StaticLength> SwitchedFactor<I, T, N, H> {
    /// Factorizes the equations of motion of a system.
    #[inline]
    pub fn of<L>(system: &L, state: &StateOf<L>) -> Self
    where
        L: Switched<Inertia = I, Numbers = N, Held = H, Scalar = T>,
    {
        Self::with_forcing(system, state).0
    }

    /// Factorizes the equations of motion. Also returns h.
    #[inline]
    fn with_forcing<L>(system: &L, state: &StateOf<L>) -> (Self, Vector<T, L::N>)
    where
        L: Switched<Inertia = I, Numbers = N, Held = H, Scalar = T>,
    {
        let zero = T::constant(0.0);
        let mut numbers = Array::filled(zero);
        let (mut held, mut count) = (Array::filled([0; 2]), 0);
        for (group, rows) in L::GROUPS.iter().enumerate().filter(|&(group, _)| system.may_hold(group)) {
            system.rows(group, state, &mut numbers);
            for (index, row) in rows.iter().enumerate() {
                if row.number(RowNumber::Compliance, &numbers) == zero {
                    if count < H::COUNT {
                        held[count] = [group, index];
                    }
                    count += 1;
                }
            }
        }
        // More rows than coordinates depend on one another.
        let pivot = T::constant(if count > H::COUNT { f64::NAN } else { 1.0 });
        let schur = Array::filled(Array::filled(zero));
        let (inertia, forcing) = system.inertia(state);
        let mut factor = Self { inertia, numbers, held, count: count.min(H::COUNT), schur, pivot };
        let scale = factor.put_together(system);
        factor.factorize(&scale);
        (factor, forcing)
    }

    fn row<L: Switched>(&self, k: usize) -> &'static ConstraintRow {
        let [group, index] = self.held[k];
        &L::GROUPS[group][index]
    }

    /// Computes F M⁻¹ Bᵀ. Returns its diagonal or that of F M⁻¹ Fᵀ, whichever is larger.
    #[inline]
    fn put_together<L>(&mut self, system: &L) -> Array<T, H>
    where
        L: Switched<Inertia = I, Numbers = N, Held = H, Scalar = T>,
    {
        let mut scale = Array::filled(T::constant(0.0));
        let is_symmetric = (0..self.count).all(|k| !self.row::<L>(k).pushes);
        for b in 0..self.count {
            let row = self.row::<L>(b);
            let [along, across] = [row.push(&self.numbers), row.jacobian(&self.numbers)];
            let moved = self.moved(system, row, along);
            for a in 0..if is_symmetric { b + 1 } else { self.count } {
                let other = self.row::<L>(a);
                self.schur[a][b] = other.dot(other.jacobian(&self.numbers), &moved);
                if is_symmetric {
                    self.schur[b][a] = self.schur[a][b];
                }
            }
            scale[b] = match row.pushes {
                true => row.dot(across, &self.moved(system, row, across)).max(self.schur[b][b].abs()),
                false => self.schur[b][b],
            };
        }
        scale
    }

    /// M⁻¹ times a row.
    #[inline]
    fn moved<L>(&self, system: &L, row: &ConstraintRow, entries: &[T]) -> Array<T, L::N>
    where
        L: Switched<Inertia = I, Scalar = T>,
    {
        let mut along = Array::filled(T::constant(0.0));
        row.add(entries, T::constant(1.0), &mut along);
        array(system.solve_inertia(&self.inertia, &vector(along)).accelerations)
    }

    /// Factorizes F M⁻¹ Bᵀ as L D U, and compares pivots to `scale`.
    #[inline]
    fn factorize(&mut self, scale: &Array<T, H>) {
        let one = T::constant(1.0);
        let [mut least, mut most, mut all] = [self.pivot; 3];
        for k in 0..self.count {
            let upper = self.schur[k];
            let reciprocal = one / upper[k];
            let growth = scale[k] * reciprocal;
            // The growth is at least 1 for a definite matrix.
            (least, most) = (least.min(growth), most.max(growth));
            // An infinite square of 1/D tells of entries of F whose squares have no digits.
            all = all + growth + reciprocal * reciprocal;
            for i in k + 1..self.count {
                let row = &mut self.schur[i];
                row[k] = row[k] * reciprocal;
                for j in k + 1..self.count {
                    row[j] = row[j] - row[k] * upper[j];
                }
            }
            self.schur[k][k] = reciprocal;
        }
        self.pivot = poison(least.min(one / most), all);
    }

    /// Solves M x − Bᵀλ = `forcing`, F x + c λ = −`bias`.
    #[inline]
    pub fn solve<L, S>(
        &self,
        system: &L,
        forcing: &Vector<S, L::N>,
        bias: &Vector<S, L::M>,
    ) -> Solution<S, L::N, L::M>
    where
        L: Switched<Inertia = I, Numbers = N, Held = H, Scalar = T>,
        S: Broadcast<T>,
    {
        let (gamma, mut h) = (array(*bias), array(*forcing));
        for row in (0..self.count).map(|k| self.row::<L>(k)) {
            let weight = row.number(RowNumber::Weight, &self.numbers);
            if weight != T::constant(0.0) {
                row.add(row.jacobian(&self.numbers), -S::of(weight) * gamma[row.constraint], &mut h);
            }
        }
        let free = system.solve_inertia(&self.inertia, &vector(h));
        let (mut x, mut lambda) = (array(free.accelerations), gamma.map(|gamma| -gamma));
        if self.count > 0 {
            let push = self.hold::<L, S>(&x, &mut lambda);
            let pushed = array(system.solve_inertia(&self.inertia, &vector(push)).accelerations);
            x = Array::from_fn(|i| x[i] + pushed[i]);
        }
        let doubt = S::of(nan_if_ill_conditioned(self.pivot, T::constant(1.0)));
        Solution {
            accelerations: vector(x.map(|x| x + doubt)),
            multipliers: vector(lambda.map(|x| x + doubt)),
            pivot: poison(S::of(self.pivot).min(free.pivot), S::of(self.pivot) * free.pivot),
            rank: L::M::COUNT,
        }
    }

    /// Solves for the multipliers that change the accelerations `x` so that the rows hold. `lambda` holds −γ, and then the multipliers.
    /// Returns Bᵀλ.
    #[inline]
    fn hold<L, S>(&self, x: &Array<S, L::N>, lambda: &mut Array<S, L::M>) -> Array<S, L::N>
    where
        L: Switched<Numbers = N, Held = H, Scalar = T>,
        S: Broadcast<T>,
    {
        let mut y = Array::<S, H>::filled(S::constant(0.0));
        for k in 0..self.count {
            let row = self.row::<L>(k);
            y[k] = lambda[row.constraint] - row.dot(row.jacobian(&self.numbers), x);
            for i in 0..k {
                y[k] = y[k] - S::of(self.schur[k][i]) * y[i];
            }
        }
        let mut push = Array::filled(S::constant(0.0));
        for k in (0..self.count).rev() {
            for i in k + 1..self.count {
                y[k] = y[k] - S::of(self.schur[k][i]) * y[i];
            }
            y[k] = y[k] * S::of(self.schur[k][k]);
            let row = self.row::<L>(k);
            lambda[row.constraint] = y[k];
            row.add(row.push(&self.numbers), y[k], &mut push);
        }
        for rows in L::GROUPS {
            let first = lambda[rows[0].constraint];
            for row in rows.iter() {
                let coupling = S::of(row.number(RowNumber::Coupling, &self.numbers));
                lambda[row.constraint] = lambda[row.constraint] - coupling * first;
            }
        }
        push
    }
}
