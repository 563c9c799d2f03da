//! Bifurcations of a family of periodic orbits: the functions whose signs tell them, and where branches leave.

use alloc::vec::Vec;
use core::fmt::{self, Debug, Display, Formatter};

use nalgebra::{Complex, DMatrix, DVector};

use super::conditions::Conditions;

use super::monodromy::Monodromy;
use super::multipliers::{modulus, product, product_of, reciprocal};
use super::orbit::PeriodicOrbit;
use super::shot::{Chain, Problem, Shot};
use crate::StateOf;
use crate::error::Error;
use crate::linearized::{DifferentiableMethod, Linearized, Singular};
use crate::motion::limits::SLACK;
use crate::number::{Real, Scalar, order, smaller};

/// Kind of a bifurcation of periodic orbits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BifurcationKind {
    /// The parameter, or the energy, turns: a multiplier is 1.
    Fold,
    /// Another family crosses, or leaves by breaking the mirror symmetry: a multiplier is 1.
    BranchPoint,
    /// A family of twice the period leaves: a multiplier is −1.
    PeriodDoubling,
    /// Two multipliers pass through the unit circle away from ±1 (Neimark and Sacker), or, in a conservative system, two
    /// pairs meet on the circle and leave it (Krein's collision): tori may leave.
    Torus,
}

impl Display for BifurcationKind {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Fold => "fold",
            Self::BranchPoint => "branch point",
            Self::PeriodDoubling => "period doubling",
            Self::Torus => "torus",
        })
    }
}

/// A bifurcation of a family.
#[derive(Clone)]
pub struct Bifurcation<L: Linearized> {
    /// Its kind.
    pub kind: BifurcationKind,
    /// The orbit there.
    pub orbit: PeriodicOrbit<L>,
    /// Value of the parameter there, or of the energy.
    pub value: L::Scalar,
    /// Index of the member of the family before it.
    pub after: usize,
    pub(super) branch: Option<Branch<L>>,
}

/// Leaves out the system, which need not implement `Debug`.
impl<L: Linearized<Scalar: Real>> Debug for Bifurcation<L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("Bifurcation");
        text.field("kind", &self.kind).field("value", &self.value).field("after", &self.after);
        text.field("orbit", &self.orbit).finish_non_exhaustive()
    }
}

/// Start of another family: the orbit of the bifurcation as one of that family, and the direction in which it leaves.
#[derive(Clone)]
pub(super) struct Branch<L: Linearized> {
    pub(super) problem: Problem<L::Scalar>,
    pub(super) chain: Chain<L>,
    pub(super) direction: DVector<L::Scalar>,
}

/// A function that changes sign at bifurcations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Test {
    /// Rate of the parameter, or of the energy, along the family.
    Turning,
    /// Determinant of the derivatives of the conditions, bordered by the direction of the family.
    Determinant,
    /// Π (1 − λ).
    Unity,
    /// Π (1 + λ).
    Doubling,
    /// Π_{i<j} (1 − λ_i λ_j), or of symplectic motions the discriminant Π_{i<j} (s_i − s_j)² of the indices s = λ + 1/λ.
    Torus,
}

impl Test {
    pub(super) const ALL: [Self; 5] =
        [Self::Turning, Self::Determinant, Self::Unity, Self::Doubling, Self::Torus];

    pub(super) fn kind(self) -> BifurcationKind {
        match self {
            Self::Turning => BifurcationKind::Fold,
            Self::Determinant | Self::Unity => BifurcationKind::BranchPoint,
            Self::Doubling => BifurcationKind::PeriodDoubling,
            Self::Torus => BifurcationKind::Torus,
        }
    }
}

/// Values of the tests at an orbit, in the order of [`Test::ALL`]; `None` where one is not defined.
pub(super) type TestValues<T> = [Option<T>; 5];

/// Tests at a member of a family.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tests<T> {
    pub(super) values: TestValues<T>,
    /// Bounds of the errors of the values.
    errors: [T; 5],
}

impl<T: Real> Tests<T> {
    pub(super) fn value(&self, test: Test) -> T {
        self.values[test as usize].unwrap_or(T::constant(0.0))
    }

    /// Adds the changes of the values along the family over the error of the orbit.
    pub(super) fn displace(&mut self, slopes: &TestValues<T>, error: T) {
        for (bound, slope) in self.errors.iter_mut().zip(slopes) {
            *bound += Scalar::abs(slope.unwrap_or(T::constant(0.0))) * error;
        }
    }

    /// True if the value is larger than its error, so that its sign is known.
    pub(super) fn is_certain(&self, test: Test) -> bool {
        self.errors[test as usize] < Scalar::abs(self.value(test))
    }

    /// Gives values of unknown sign, now as large as their error, the sign of the member before.
    pub(super) fn remember(&mut self, before: &Self) {
        let zero = T::constant(0.0);
        for test in Test::ALL.into_iter().filter(|test| before.is_certain(*test)) {
            let k = test as usize;
            if !self.is_certain(test) {
                let error = core::mem::replace(&mut self.errors[k], zero);
                self.values[k] = Some(if before.value(test) < zero { -error } else { error });
            }
        }
    }

    /// Product of the signs at two members: 0 if one is not known.
    pub(super) fn signs(&self, next: &Self, test: Test) -> i8 {
        let is_known = self.is_certain(test) && next.is_certain(test);
        let is_same = (self.value(test) < T::constant(0.0)) == (next.value(test) < T::constant(0.0));
        i8::from(is_known) * if is_same { 1 } else { -1 }
    }

    /// Tests whose signs are known and differ between two neighbours of a family. `Unity` changes with folds and branch points too,
    /// and counts alone only, as a broken symmetry.
    pub(super) fn changed(&self, next: &Self) -> Vec<Test> {
        let mut found: Vec<Test> = Test::ALL.into_iter().filter(|test| self.signs(next, *test) < 0).collect();
        if found.contains(&Test::Turning) || found.contains(&Test::Determinant) {
            found.retain(|test| *test != Test::Unity);
        }
        found
    }
}

impl<T: Real> Problem<T> {
    /// Tests at a member of a family with this direction, from its monodromy and the error of the orbit.
    ///
    /// Derivatives of the motion err by E with ‖E‖ ≤ δ ‖Φ‖, where δ is their relative error and Φ the monodromy, and so do the
    /// matrices made up of them. A singular value then errs by ‖E‖ (Weyl), the null vector that is the direction by ‖E‖/σ for the
    /// least singular value σ, and a determinant by Π(σ_i + ‖E‖) − Πσ_i (Ipsen and Rehman, *SIAM Journal on Matrix Analysis and
    /// Applications* 30, 2008).
    pub(super) fn tests<L: Linearized<Scalar = T> + Clone>(
        &self,
        shot: &Shot<L>,
        tangent: &DVector<T>,
        (monodromy, error): (&Monodromy<T>, T),
    ) -> Result<Tests<T>, Error> {
        let one = T::constant(1.0);
        let part = T::constant(SLACK) * (error + T::constant(T::EPSILON));
        let bordered = self.with_row(shot, tangent);
        let (off, around) = (part * bordered.norm(), part * monodromy.norm);
        let bordered_sizes = singular_values(&bordered)?;
        let least = bordered_sizes.iter().copied().reduce(smaller).unwrap_or(one);
        let (multipliers, once) = (monodromy.nontrivial()?, monodromy.nontrivial_product());
        let collisions = monodromy.collisions(&multipliers);
        let factors: Vec<_> = collisions.iter().map(|collision| collision.factor).collect();
        let shifted = |by: T| singular_values(&(&once + DMatrix::identity(once.nrows(), once.ncols()) * by));
        let sizes: Vec<T> = factors.iter().map(|x| modulus(*x)).collect();
        let errors = [
            off / least,
            determinant_error(&bordered_sizes, off),
            determinant_error(&shifted(-one)?, around),
            determinant_error(&shifted(one)?, around),
            // A factor is a function of second minors.
            determinant_error(&sizes, around * (once.norm() + one)),
        ];
        let values = [
            Some(self.turning(shot, tangent)),
            bordered.is_square().then(|| bordered.lu().determinant()),
            Some(product_of(&multipliers, -one)),
            Some(product_of(&multipliers, one)),
            Some(product(&factors)),
        ];
        Ok(Tests { values, errors })
    }

    /// Rate of the parameter, or of the energy where there is none, along the family.
    pub(super) fn turning<L: Linearized<Scalar = T> + Clone>(
        &self,
        shot: &Shot<L>,
        tangent: &DVector<T>,
    ) -> T {
        let count = shot.frames[0].count();
        if let Some(column) = self.parameter_column(count) {
            return tangent[column];
        }
        // A fixed energy has no folds.
        if self.conditions.energy.is_some() {
            return T::constant(1.0);
        }
        let energy = shot.frames[0].energy(&shot.chain.system, &shot.chain.nodes[0]);
        let gradient = energy.map(|(gradient, _)| gradient);
        gradient.map_or(T::constant(0.0), |gradient| gradient.dot(&tangent.rows(0, count)))
    }

    /// Where the branch of a bifurcation leaves; `None` for folds and tori.
    pub(super) fn branch<L, D>(
        &self,
        test: Test,
        shot: &Shot<L>,
        tangent: &DVector<T>,
        method: &D,
    ) -> Result<Option<Branch<L>>, Error>
    where
        L: Linearized<Scalar = T> + Clone,
        D: DifferentiableMethod<L> + Clone,
    {
        Ok(match test {
            Test::Turning | Test::Torus => None,
            Test::Determinant => Some(Branch {
                problem: self.clone(),
                chain: shot.chain.clone(),
                direction: least_direction(&self.with_row(shot, tangent))?,
            }),
            Test::Unity => {
                let energy = self.conditions.energy;
                let problem = self.with(Conditions { energy, ..self.conditions.whole() });
                let around = self.whole_of(&problem, shot, method)?;
                let along = tangent.clone().resize_vertically(around.jacobian.ncols(), T::constant(0.0));
                let direction = least_direction(&problem.with_row(&around, &along))?;
                Some(Branch { problem, chain: around.chain, direction })
            }
            Test::Doubling => {
                let whole = self.with(self.conditions.whole());
                let around = self.whole_of(&whole, shot, method)?;
                let problem = self.with(self.conditions.doubled());
                let direction = doubling(&around, problem.unknowns(around.frames[0].count()))?;
                Some(Branch { problem, chain: twice(around.chain), direction })
            }
        })
    }

    fn with(&self, conditions: Conditions<T>) -> Self {
        Self { conditions, ..self.clone() }
    }
}

/// Direction in which a matrix changes least: its last right singular vector.
pub(super) fn least_direction<T: Real>(a: &DMatrix<T>) -> Result<DVector<T>, Error> {
    least_directions(a, 1).map(|found| found.column(0).into_owned())
}

/// Right singular vectors of the least singular values, as columns, the least first.
pub(super) fn least_directions<T: Real>(a: &DMatrix<T>, count: usize) -> Result<DMatrix<T>, Error> {
    let factors = Singular::of(a).ok_or(Error::EigenvaluesNotFound)?;
    let mut by_size: Vec<usize> = (0..a.ncols()).collect();
    by_size.sort_by(|j, k| order(factors.values[*j], factors.values[*k]));
    Ok(DMatrix::from_fn(a.ncols(), count, |j, k| factors.direction(by_size[k], j)))
}

fn singular_values<T: Real>(a: &DMatrix<T>) -> Result<Vec<T>, Error> {
    Ok(Singular::of(a).ok_or(Error::EigenvaluesNotFound)?.values)
}

/// Largest change of a product of singular values by a change of each by `error`.
fn determinant_error<T: Real>(sizes: &[T], error: T) -> T {
    let product = |by: T| sizes.iter().fold(T::constant(1.0), |product, size| product * (*size + by));
    product(error) - product(T::constant(0.0))
}

/// Change of the start that the motion once around turns into its opposite.
fn doubling<L: Linearized<Scalar: Real>>(
    shot: &Shot<L>,
    unknowns: usize,
) -> Result<DVector<L::Scalar>, Error> {
    let count = shot.frames[0].count();
    let unit = DMatrix::identity(count, count);
    let once = (0..shot.segments.len()).fold(unit.clone(), |product, k| shot.factor(k) * product);
    Ok(least_direction(&(once + unit))?.resize_vertically(unknowns, L::Scalar::constant(0.0)))
}

/// The orbit run through twice.
fn twice<L: Linearized<Scalar: Real>>(mut chain: Chain<L>) -> Chain<L> {
    let again: Vec<_> =
        chain.nodes.iter().map(|node| StateOf::<L> { t: node.t + chain.period, ..*node }).collect();
    chain.nodes.extend(again);
    chain.period += chain.period;
    chain
}

/// True if the multipliers that collide do so on the unit circle: those with the least factor of the test.
pub(super) fn collide_on_circle<T: Real>(monodromy: &Monodromy<T>) -> bool {
    let collisions = monodromy.nontrivial().map_or_else(|_| Vec::new(), |all| monodromy.collisions(&all));
    let nearest = collisions.into_iter().min_by(|x, y| order(modulus(x.factor), modulus(y.factor)));
    nearest.is_some_and(|collision| collision.is_on_circle)
}

/// A factor of the test of tori, which vanishes where two multipliers collide.
struct Collision<T> {
    factor: Complex<T>,
    /// True if they collide on the unit circle, not on the real axis.
    is_on_circle: bool,
}

impl<T: Real> Monodromy<T> {
    fn collisions(&self, multipliers: &[Complex<T>]) -> Vec<Collision<T>> {
        match self.is_symplectic() {
            true => of_pairs(multipliers),
            false => pairs(multipliers).map(|(x, y)| of_two(x, y)).collect(),
        }
    }
}

/// Factor 1 − λ_i λ_j, of which only complex pairs on the unit circle, and real ones with the product 1, are zeros.
fn of_two<T: Real>(x: Complex<T>, y: Complex<T>) -> Collision<T> {
    let factor = Complex::new(T::constant(1.0) - (x.re * y.re - x.im * y.im), -(x.re * y.im + x.im * y.re));
    Collision { factor, is_on_circle: x.im != T::constant(0.0) }
}

/// Factors (s_i − s_j)² of the discriminant of the indices s = λ + 1/λ of the pairs. On the unit circle −2 < s < 2.
fn of_pairs<T: Real>(multipliers: &[Complex<T>]) -> Vec<Collision<T>> {
    let index = |x: &Complex<T>| {
        let inverse = reciprocal(*x);
        Complex::new(x.re + inverse.re, x.im + inverse.im)
    };
    let indices: Vec<_> = multipliers.iter().step_by(2).map(index).collect();
    let collision = |(x, y): (Complex<T>, Complex<T>)| {
        let (re, im) = (x.re - y.re, x.im - y.im);
        let factor = Complex::new(re * re - im * im, (re + re) * im);
        Collision { factor, is_on_circle: Scalar::abs(x.re + y.re) < T::constant(4.0) }
    };
    pairs(&indices).map(collision).collect()
}

fn pairs<T: Real>(all: &[Complex<T>]) -> impl Iterator<Item = (Complex<T>, Complex<T>)> {
    all.iter().enumerate().flat_map(|(i, x)| all[i + 1..].iter().map(|y| (*x, *y)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Signs count where values exceed their errors, and are those of the member before elsewhere.
    #[test]
    fn signs_that_are_known() {
        let at = |value: f64| Tests { values: [None, Some(value), None, None, None], errors: [0.1; 5] };
        assert_eq!(at(0.2).changed(&at(-0.2)), [Test::Determinant]);
        assert!(at(0.2).changed(&at(-0.05)).is_empty() && at(0.05).changed(&at(-0.2)).is_empty());
        let mut between = at(-0.05);
        between.remember(&at(0.2));
        assert!(at(0.2).changed(&between).is_empty());
        assert_eq!(between.changed(&at(-0.2)), [Test::Determinant]);
        let mut between = at(-0.05);
        between.remember(&at(0.01));
        assert_eq!(between, at(-0.05));
    }

    /// Against the determinant of a diagonal matrix, all of whose entries change by as much.
    #[test]
    fn determinants_err_by_their_singular_values() {
        let error = determinant_error(&[2.0, 0.0, 3.0_f64], 0.1);
        assert!((error - 2.1 * 0.1 * 3.1).abs() < 1e-15, "{error}");
        assert!(determinant_error(&[], 0.1_f64).abs() < 1e-300);
    }
}
