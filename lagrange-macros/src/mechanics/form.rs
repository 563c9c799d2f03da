//! Quadratic forms that accelerations make least.

use crate::symbolic::Id;

/// The most variables that a form has: each is differentiated by each.
pub(super) const LIMIT: usize = 500;

/// ½ xᵀHx − bᵀx, where x is the accelerations and then, in the order of their definitions, the rates of the named
/// velocities that they cause.
#[derive(Debug)]
pub(crate) struct Form {
    /// H, by rows.
    pub(crate) matrix: Vec<Vec<Id>>,
    /// b
    pub(crate) linear: Vec<Id>,
    /// For each named velocity its rate as a sum over the x before it: which, and its coefficient.
    pub(crate) definitions: Vec<Vec<(usize, Id)>>,
    /// F over x, if it is not that over the accelerations alone.
    pub(crate) rows: Option<Vec<Vec<Id>>>,
    /// b_i/H_ii of an acceleration that is tied to nothing else.
    pub(crate) alone: Vec<Option<Id>>,
    /// The constraints a with σ_a F_aᵀF_a in H and −σ_a γ_a F_a in b, each with its σ: a solve for other h and γ takes
    /// the same from its h.
    pub(crate) completing: Vec<(usize, Id)>,
}

impl Form {
    /// With each variable after the accelerations as a sum over those before it.
    pub(super) fn over(matrix: Vec<Vec<Id>>, linear: Vec<Id>, rows: &[Vec<Id>]) -> Self {
        let entries =
            |row: &Vec<Id>| row.iter().copied().enumerate().filter(|&(_, entry)| entry != Id::ZERO).collect();
        Self::new(matrix, linear, rows.iter().map(entries).collect())
    }

    pub(super) fn new(matrix: Vec<Vec<Id>>, linear: Vec<Id>, definitions: Vec<Vec<(usize, Id)>>) -> Self {
        let alone = vec![None; matrix.len()];
        Self { matrix, linear, definitions, rows: None, alone, completing: Vec::new() }
    }

    /// The same with constraints on all its variables.
    pub(super) fn with(self, rows: Vec<Vec<Id>>) -> Self {
        Self { rows: Some(rows), ..self }
    }
}
