//! Quadratic forms whose minimum gives the accelerations.

use crate::symbolic::Id;

/// Largest number of variables of a form: the Hessian costs the square of it.
pub(super) const LIMIT: usize = 500;

/// ½ xᵀHx − bᵀx. The variables x are the accelerations, followed by the parts of the rates of named velocities that
/// are linear in the accelerations, in order of definition.
#[derive(Clone, Debug)]
pub(crate) struct Form {
    /// H, by rows.
    pub(crate) matrix: Vec<Vec<Id>>,
    /// b
    pub(crate) linear: Vec<Id>,
    /// For each named velocity, its rate as a sum over earlier variables: index and coefficient of each term.
    pub(crate) definitions: Vec<Vec<(usize, Id)>>,
    /// Constraint Jacobian F over x; `None` if F over the accelerations alone applies.
    pub(crate) rows: Option<Vec<Vec<Id>>>,
    /// b_i/H_ii of each acceleration that is coupled to no other variable.
    pub(crate) alone: Vec<Option<Id>>,
    /// Each constraint a, with its weight σ_a, that adds σ_a F_aᵀF_a to H and −σ_a γ_a F_a to b. A solve for another h
    /// and γ must likewise subtract σ_a γ_a F_a from that h.
    pub(crate) completing: Vec<(usize, Id)>,
}

impl Form {
    /// Form with one row per variable beyond the accelerations: its coefficients over the earlier variables.
    pub(super) fn over(matrix: Vec<Vec<Id>>, linear: Vec<Id>, rows: &[Vec<Id>]) -> Self {
        let entries =
            |row: &Vec<Id>| row.iter().copied().enumerate().filter(|&(_, entry)| entry != Id::ZERO).collect();
        Self::new(matrix, linear, rows.iter().map(entries).collect())
    }

    pub(super) fn new(matrix: Vec<Vec<Id>>, linear: Vec<Id>, definitions: Vec<Vec<(usize, Id)>>) -> Self {
        let alone = vec![None; matrix.len()];
        Self { matrix, linear, definitions, rows: None, alone, completing: Vec::new() }
    }

    /// The same with each node replaced.
    pub(super) fn map(&self, node: &mut impl FnMut(Id) -> Id) -> Self {
        let mut rows = |rows: &[Vec<Id>]| -> Vec<Vec<Id>> {
            rows.iter().map(|row| row.iter().map(|&id| node(id)).collect()).collect()
        };
        let (matrix, of_rows) = (rows(&self.matrix), self.rows.as_deref().map(&mut rows));
        let mut terms = |terms: &[(usize, Id)]| -> Vec<(usize, Id)> {
            terms.iter().map(|&(k, id)| (k, node(id))).collect()
        };
        Self {
            matrix,
            definitions: self.definitions.iter().map(|definition| terms(definition)).collect(),
            completing: terms(&self.completing),
            rows: of_rows,
            linear: self.linear.iter().map(|&id| node(id)).collect(),
            alone: self.alone.iter().map(|id| id.map(&mut *node)).collect(),
        }
    }

    /// Adds the constraint Jacobian over all variables of the form.
    pub(super) fn with(self, rows: Vec<Vec<Id>>) -> Self {
        Self { rows: Some(rows), ..self }
    }
}
