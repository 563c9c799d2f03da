//! Bifurcations of a family of periodic orbits: the functions whose signs tell them, and where branches leave.

use alloc::vec::Vec;
use core::fmt::{self, Debug, Display, Formatter};

use nalgebra::{DMatrix, DVector};

use super::conditions::Conditions;
use super::monodromy::Monodromy;
use super::multipliers::{modulus, product_of, reciprocal};
use super::orbit::PeriodicOrbit;
use super::shot::{Chain, Problem, Shot};
use crate::error::Error;
use crate::linearized::{DifferentiableMethod, Linearized, Singular};
use crate::number::{Real, Scalar, larger, smaller};
use crate::system::StateOf;

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

/// Size of a least singular value or of Π (1 − λ), in units of the error of an orbit, below which its sign is noise.
/// Derivatives of a motion are allowed ten times its error, and some tens of them make up the matrix; among the orbits of a
/// planet Π (1 − λ), which is zero, comes to 10⁻³.
const NOISE: f64 = 1e3;

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

/// Functions that change sign at bifurcations; `None` where one is not defined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tests<T> {
    /// Rate of the parameter, or of the energy, along the family.
    pub(super) turning: T,
    /// Least singular value of the derivatives of the conditions, bordered by the direction of the family, with the sign of
    /// their determinant.
    pub(super) determinant: Option<T>,
    /// Π (1 − λ).
    pub(super) unity: T,
    /// Π (1 + λ).
    pub(super) doubling: T,
    /// Π_{i<j} (1 − λ_i λ_j), or of symplectic motions the discriminant Π_{i<j} (s_i − s_j)² of the indices s = λ + 1/λ.
    pub(super) torus: T,
    /// Size below which a determinant and `unity` are noise.
    pub(super) noise: T,
}

/// A function of the [`Tests`], by the kind of bifurcation at which it changes sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Test {
    Turning,
    Determinant,
    Unity,
    Doubling,
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

impl<T: Real> Tests<T> {
    pub(super) fn value(&self, test: Test) -> Option<T> {
        match test {
            Test::Turning => Some(self.turning),
            Test::Determinant => self.determinant,
            Test::Unity => Some(self.unity),
            Test::Doubling => Some(self.doubling),
            Test::Torus => Some(self.torus),
        }
    }

    /// Change of each test from those of another orbit, times a factor.
    pub(super) fn change_from(&self, other: &Self, factor: T) -> Self {
        Self {
            turning: (self.turning - other.turning) * factor,
            determinant: self.determinant.zip(other.determinant).map(|(x, y)| (x - y) * factor),
            unity: (self.unity - other.unity) * factor,
            doubling: (self.doubling - other.doubling) * factor,
            torus: (self.torus - other.torus) * factor,
            noise: self.noise,
        }
    }

    /// Tests whose signs differ between two neighbours of a family. `Unity` changes with folds and branch points too, and
    /// counts alone only, as a broken symmetry.
    pub(super) fn changed(&self, next: &Self) -> Vec<Test> {
        let zero = T::constant(0.0);
        let noise = larger(self.noise, next.noise);
        let changes = |test: &Test| match (self.value(*test), next.value(*test)) {
            // Where orbits fill more than a curve these are zero, and their signs are those of errors.
            (Some(x), Some(y)) if matches!(test, Test::Determinant | Test::Unity) => {
                x * y <= zero && larger(Scalar::abs(x), Scalar::abs(y)) > noise && x != zero
            }
            (Some(x), Some(y)) => x * y < zero || (y == zero && x != zero),
            _ => false,
        };
        let mut found: Vec<Test> = Test::ALL.into_iter().filter(changes).collect();
        if found.contains(&Test::Turning) || found.contains(&Test::Determinant) {
            found.retain(|test| *test != Test::Unity);
        }
        found
    }
}

impl<T: Real> Problem<T> {
    /// Tests at a member of a family with this direction, from its monodromy and the error of the orbit.
    pub(super) fn tests<L: Linearized<Scalar = T> + Clone>(
        &self,
        shot: &Shot<L>,
        tangent: &DVector<T>,
        (monodromy, error): (&Monodromy<T>, T),
    ) -> Result<Tests<T>, Error> {
        let bordered = self.with_row(shot, tangent);
        let determinant = if bordered.is_square() { Some(signed_least(&bordered)?) } else { None };
        let multipliers = monodromy.nontrivial()?;
        let one = T::constant(1.0);
        let torus = match monodromy.is_symplectic() {
            true => discriminant(&multipliers),
            false => collisions(&multipliers),
        };
        Ok(Tests {
            turning: self.turning(shot, tangent),
            determinant,
            unity: product_of(&multipliers, -one),
            doubling: product_of(&multipliers, one),
            torus,
            noise: T::constant(NOISE) * (error + T::constant(T::EPSILON)),
        })
    }

    /// Rate of the parameter, or of the energy where there is none, along the family.
    fn turning<L: Linearized<Scalar = T> + Clone>(&self, shot: &Shot<L>, tangent: &DVector<T>) -> T {
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
        // The sign of the form is a convention; that of the energy is not needed.
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
    let factors = Singular::of(a).ok_or(Error::EigenvaluesNotFound)?;
    let values = &factors.values;
    let least = (1..values.len()).fold(0, |least, k| if values[k] < values[least] { k } else { least });
    Ok(DVector::from_fn(a.ncols(), |j, _| factors.direction(least, j)))
}

/// Least singular value of a square matrix, with the sign of its determinant.
fn signed_least<T: Real>(a: &DMatrix<T>) -> Result<T, Error> {
    let factors = Singular::of(a).ok_or(Error::EigenvaluesNotFound)?;
    let least = factors.values.iter().fold(factors.norm(), |least, x| smaller(least, *x));
    let is_negative = a.clone().lu().determinant() < T::constant(0.0);
    Ok(if is_negative { -least } else { least })
}

/// True if a complex pair of multipliers is on the unit circle, to a thousandth.
pub(super) fn touches_circle<T: Real>(multipliers: &[nalgebra::Complex<T>]) -> bool {
    let little = T::constant(1e-3);
    multipliers
        .iter()
        .any(|x| Scalar::abs(x.im) > little && Scalar::abs(modulus(*x) - T::constant(1.0)) < little)
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

/// Π_{i<j} (1 − λ_i λ_j), in which only complex pairs on the unit circle, and real ones with the product 1, are zeros.
fn collisions<T: Real>(multipliers: &[nalgebra::Complex<T>]) -> T {
    let mut products = Vec::new();
    for (i, x) in multipliers.iter().enumerate() {
        for y in &multipliers[i + 1..] {
            products.push(nalgebra::Complex::new(x.re * y.re - x.im * y.im, x.re * y.im + x.im * y.re));
        }
    }
    product_of(&products, T::constant(-1.0))
}

/// Π_{i<j} (s_i − s_j)² of the indices s = λ + 1/λ of the pairs: negative if one pair of indices is complex.
fn discriminant<T: Real>(multipliers: &[nalgebra::Complex<T>]) -> T {
    let indices: Vec<_> = multipliers
        .iter()
        .step_by(2)
        .map(|x| {
            let inverse = reciprocal(*x);
            nalgebra::Complex::new(x.re + inverse.re, x.im + inverse.im)
        })
        .collect();
    let scale = T::constant(1e-9);
    let complex = indices.iter().filter(|s| Scalar::abs(s.im) > scale * modulus(**s)).count() / 2;
    let mut product = T::constant(if complex % 2 == 0 { 1.0 } else { -1.0 });
    for (i, x) in indices.iter().enumerate() {
        for y in &indices[i + 1..] {
            let apart = modulus(nalgebra::Complex::new(x.re - y.re, x.im - y.im));
            product *= apart * apart;
        }
    }
    product
}
