//! Linearized equations at one stage.
//!
//! A stage is a state on the constraints, moved along the normals of the chart. With their directions as columns of G and
//! the constraint Jacobian F of the stage, a change x of the coordinates becomes x + G (−F G)⁻¹ (F x + δΦ).

use alloc::vec::Vec;

use nalgebra::DMatrix;

use super::super::chart::Chart;
use crate::derivatives::tangent::{Tangent, WideOf};
use crate::error::Error;
use crate::linearized::Linearized;
use crate::linearized::variation::Variations;
use crate::number::{Real, Wide};
use crate::solution::consistent::level::Level;
use crate::system::unit;
use crate::vector::{Entrywise, StaticLength};

/// Directions along which the chart moves states onto the constraints of a level, one for each that determines them.
pub(super) struct Normals<T> {
    constraints: Vec<usize>,
    directions: DMatrix<T>,
}

impl<T: Real> Normals<T> {
    pub(super) fn of<L: Linearized<Scalar = T>>(
        system: &L,
        chart: &Chart<L>,
        level: Level,
        time: T,
    ) -> Result<Self, Error> {
        let (mut constraints, mut directions) = (Vec::new(), Vec::new());
        for a in (0..<L::M>::COUNT).filter(|&a| level.is_active(L::CONSTRAINT_KINDS[a])) {
            let direction = chart.correction(system, level, &unit::<T, L::M>(a).into(), time)?;
            // The general solver leaves out constraints that depend on others.
            if direction.iter().any(|x| *x != T::constant(0.0)) {
                constraints.push(a);
                directions.push(direction);
            }
        }
        let directions = DMatrix::from_fn(<L::N>::COUNT, directions.len(), |i, j: usize| directions[j][i]);
        Ok(Self { constraints, directions })
    }
}

/// Changes of the coordinates or velocities of a stage that keep it on the constraints of a level.
struct Lift<T> {
    /// By a change in the tangent plane: 1 + R F.
    along: DMatrix<T>,
    /// By a change of the residuals: R = G (−F G)⁻¹, with a column for each constraint.
    across: DMatrix<T>,
}

impl<T: Real> Lift<T> {
    /// `None` if constraints depend on one another along the normals. `f` has the rows of all constraints.
    fn of(normals: &Normals<T>, f: &DMatrix<T>) -> Option<Self> {
        let Normals { constraints, directions } = normals;
        let f = f.select_rows(constraints);
        let across = directions * (-(&f * directions)).try_inverse()?;
        Some(Self { along: DMatrix::identity(f.ncols(), f.ncols()) + &across * f, across })
    }
}

/// Derivatives at a stage. Matrices of changes with parameters have a column for each variation.
pub(super) struct StageDerivatives<T> {
    /// ∂q̈/∂q and ∂q̈/∂q̇.
    pub(super) accelerations: [DMatrix<T>; 2],
    /// Change of the accelerations with the parameters.
    pub(super) forced: DMatrix<T>,
    /// `None` without constraints.
    pub(super) held: Option<Held<T>>,
}

/// Changes of the coordinates and of the velocities that the constraints demand.
pub(super) struct Held<T> {
    /// By their changes in the tangent plane.
    pub(super) along: [DMatrix<T>; 2],
    /// By the parameters.
    pub(super) shifts: [DMatrix<T>; 2],
    /// Change of the velocities by the coordinates.
    pub(super) turn: DMatrix<T>,
}

impl<T: Real> StageDerivatives<T> {
    /// `None` if constraints depend on one another along the normals.
    pub(super) fn at<L: Linearized<Scalar = T>>(
        tangent: &Tangent<'_, L>,
        variations: &Variations<L>,
        normals: &[Normals<T>; 2],
    ) -> Result<Option<Self>, Error> {
        let n = <L::N>::COUNT;
        let mut accelerations = [DMatrix::zeros(n, n), DMatrix::zeros(n, n)];
        tangent.by_arguments(1..1 + 2 * n, |k, change| {
            accelerations[(k - 1) / n].set_column((k - 1) % n, &change.accelerations);
        })?;
        let ParameterChanges { forced, residuals } = ParameterChanges::at(tangent, variations)?;
        if const { <L::M>::COUNT == 0 } {
            return Ok(Some(Self { accelerations, forced, held: None }));
        }
        let held = Held::at(tangent, normals, &residuals);
        Ok(held.map(|held| Self { accelerations, forced, held: Some(held) }))
    }
}

impl<T: Real> Held<T> {
    fn at<L: Linearized<Scalar = T>>(
        tangent: &Tangent<'_, L>,
        [positions, velocities]: &[Normals<T>; 2],
        residuals: &[DMatrix<T>; 2],
    ) -> Option<Self> {
        let jacobian = tangent.system.constraint_jacobian(tangent.state);
        let f = DMatrix::from_fn(<L::M>::COUNT, <L::N>::COUNT, |a, i| jacobian[(a, i)]);
        let [q, v] = [Lift::of(positions, &f)?, Lift::of(velocities, &f)?];
        let turn = &v.across * rates_by_coordinates(tangent).select_rows(&velocities.constraints);
        let shifts = [
            q.across * residuals[0].select_rows(&positions.constraints),
            v.across * residuals[1].select_rows(&velocities.constraints),
        ];
        Some(Self { along: [q.along, v.along], shifts, turn })
    }
}

/// Derivatives of F q̇ + b by the coordinates.
fn rates_by_coordinates<L: Linearized<Scalar: Real>>(tangent: &Tangent<'_, L>) -> DMatrix<L::Scalar> {
    let (n, lanes) = (<L::N>::COUNT, <WideOf<L> as Wide<L::Scalar>>::COUNT);
    let mut rates = DMatrix::zeros(<L::M>::COUNT, n);
    for first in (0..n).step_by(lanes) {
        let block = first..n.min(first + lanes);
        let changes = tangent.changes_by(block.clone().map(|k| 1 + k));
        block.for_each(|k| rates.set_column(k, &changes.rate.each(|x| x.lane(k - first))));
    }
    rates
}

/// Changes with the parameters, a column for each variation.
struct ParameterChanges<T> {
    forced: DMatrix<T>,
    /// Changes of Φ and of F q̇ + b.
    residuals: [DMatrix<T>; 2],
}

impl<T: Real> ParameterChanges<T> {
    fn at<L: Linearized<Scalar = T>>(
        tangent: &Tangent<'_, L>,
        variations: &Variations<L>,
    ) -> Result<Self, Error> {
        let arguments = variations.arguments();
        let zeros = |rows| DMatrix::zeros(rows, arguments.len());
        let [mut forced, mut position, mut rate] = [<L::N>::COUNT, <L::M>::COUNT, <L::M>::COUNT].map(zeros);
        for block in &variations.blocks {
            let Some(rates) = &block.rates else { continue };
            let changes = tangent.changes_by_parameters(&tangent.parameter_slopes(), rates);
            let found = tangent.responses(block.lanes, &changes, |lane| arguments[block.first + lane])?;
            for lane in 0..block.lanes {
                let column = block.first + lane;
                forced.set_column(column, &found.accelerations.each(|x| x.lane(lane)));
                position.set_column(column, &changes.position.each(|x| x.lane(lane)));
                rate.set_column(column, &changes.rate.each(|x| x.lane(lane)));
            }
        }
        Ok(Self { forced, residuals: [position, rate] })
    }
}
