//! Matrices: products, constructors and accessors.

use super::lowering::Lowering;
use super::turns::Turn;
use super::value::{Value, cross};
use crate::diagnostics::Place;
use crate::symbolic::{Function, Graph, Id};
use crate::syntax::{Expression, LENGTH_LIMIT, Name};

type MatrixRows = Vec<Vec<Id>>;

impl Lowering<'_> {
    /// Product of two arrays, at least one of them a matrix: a left vector is a row, a right vector a column.
    pub(super) fn times(&mut self, x: &Value, y: &Value, place: Place) -> Option<Value> {
        let (row, column) = (x.as_vector(), y.as_vector());
        if row.is_some() && column.is_some() {
            return self.report(place, "two vectors are multiplied with `dot(a, b)` or `cross(a, b)`");
        }
        let left = row.clone().map_or_else(|| x.as_matrix(), |row| Some(vec![row]));
        let right = column.clone().map_or_else(|| y.as_matrix().map(transposed), |column| Some(vec![column]));
        let (Some(left), Some(right)) = (left, right) else {
            let (x, y) = (x.shape(), y.shape());
            return self
                .report(place, format!("{x} cannot be multiplied by {y}: take one matrix of it, `A[i]`"));
        };
        if left[0].len() != right[0].len() {
            let (x, y, across, down) = (x.shape(), y.shape(), left[0].len(), right[0].len());
            return self.report(place, format!(
                "{x} cannot be multiplied by {y}: rows on the left have {across} entries, columns on the right {down}"
            ));
        }
        let product = left.iter().map(|row| right.iter().map(|column| self.graph.dot(row, column)).collect());
        let product: MatrixRows = product.collect();
        Some(match (row, column) {
            (None, None) => {
                let product = Value::matrix(product);
                self.turns.remember_product(&self.graph, x, y, &product);
                product
            }
            // A matrix times a vector has components along the axes of the vector.
            _ => Value::vector(product.into_iter().flatten()).along(x.axes().or(y.axes())),
        })
    }

    /// Lowers `transpose(A)`, `trace(A)`, `identity(3)` or `skew(v)`.
    pub(super) fn matrix(&mut self, name: &Name, argument: &Expression) -> Option<Value> {
        match name.text.as_str() {
            "identity" => self.identity(argument),
            "skew" => {
                let v = self.three(name, argument)?;
                Some(Value::matrix(skew(v, &mut self.graph)))
            }
            "trace" => {
                let rows = self.of_kind(argument, "matrix", Value::as_matrix)?;
                if rows.len() != rows[0].len() {
                    return self.report(argument.place, "only a square matrix has a trace");
                }
                let diagonal = rows.iter().enumerate().map(|(i, row)| row[i]);
                Some(Value::Scalar(self.graph.total(diagonal)))
            }
            _ => {
                let matrix = self.lower(argument)?;
                let rows = self.part(&matrix, argument.place, "matrix", Value::as_matrix)?;
                let transpose = Value::matrix(transposed(rows));
                self.turns.remember_transpose(&mut self.graph, &matrix, &transpose);
                Some(transpose)
            }
        }
    }

    fn identity(&mut self, argument: &Expression) -> Option<Value> {
        let size = self.integer(argument)?;
        let Some(size) =
            usize::try_from(size).ok().filter(|n| (1..=LENGTH_LIMIT).contains(&n.saturating_mul(*n)))
        else {
            return self.report(
                argument.place,
                format!("an identity matrix has at least one row, and at most {LENGTH_LIMIT} numbers"),
            );
        };
        Some(Value::matrix(
            (0..size).map(|i| (0..size).map(move |j| if i == j { Id::ONE } else { Id::ZERO })),
        ))
    }

    /// Lowers `rot_x(angle)`, `rot_y(angle)` or `rot_z(angle)`: rotates a vector about that axis by the right-hand
    /// rule.
    pub(super) fn rotation_about_axis(&mut self, name: &Name, angle: &Expression) -> Option<Value> {
        let angle = self.scalar(angle)?;
        let axis = match name.text.as_str() {
            "rot_x" => [Id::ONE, Id::ZERO, Id::ZERO],
            "rot_y" => [Id::ZERO, Id::ONE, Id::ZERO],
            _ => [Id::ZERO, Id::ZERO, Id::ONE],
        };
        Some(self.turn_about(axis, angle))
    }

    /// Lowers `rot(axis, angle)`, with an axis of any nonzero length.
    pub(super) fn rotation(&mut self, name: &Name, axis: &Expression, angle: &Expression) -> Option<Value> {
        let (unit, angle) = (self.unit(name, axis), self.scalar(angle));
        Some(self.turn_about(unit?, angle?))
    }

    fn turn_about(&mut self, axis: [Id; 3], angle: Id) -> Value {
        let matrix = rotation(axis, angle, &mut self.graph);
        self.turns.remember(&self.graph, matrix, vec![Turn::About(axis, angle)]);
        Value::matrix(matrix)
    }

    /// Lowers an axis of any nonzero length and normalizes it.
    pub(super) fn unit(&mut self, name: &Name, axis: &Expression) -> Option<[Id; 3]> {
        let vector = self.three(name, axis)?;
        let square = self.graph.dot(&vector, &vector);
        if square == Id::ZERO {
            return self.report(axis.place, "an axis of length zero has no direction");
        }
        let length = self.graph.sqrt(square);
        Some(vector.map(|x| self.graph.div(x, length)))
    }

    /// Lowers an expression that must be a vector of three entries.
    fn three(&mut self, name: &Name, argument: &Expression) -> Option<[Id; 3]> {
        let vector = self.vector_of(argument)?;
        let wrong = || format!("`{}` takes a vector of 3", name.text);
        vector.try_into().ok().or_else(|| self.report(argument.place, wrong()))
    }
}

fn transposed(rows: MatrixRows) -> MatrixRows {
    (0..rows[0].len()).map(|j| rows.iter().map(|row| row[j]).collect()).collect()
}

/// Skew-symmetric matrix S with S v = x × v for every v: its columns are x × eⱼ.
fn skew(x: [Id; 3], graph: &mut Graph) -> MatrixRows {
    let unit = |j: usize| std::array::from_fn(|i| if i == j { Id::ONE } else { Id::ZERO });
    transposed((0..3).map(|j| cross(x, unit(j), graph).to_vec()).collect())
}

/// Rotation matrix cos α 1 + sin α S + (1 − cos α) n nᵀ, with S v = n × v (Rodrigues' formula; Goldstein, Poole and
/// Safko, *Classical Mechanics*, 4.62).
pub(super) fn rotation(axis: [Id; 3], angle: Id, graph: &mut Graph) -> [[Id; 3]; 3] {
    let (sin, cos) = (graph.function(Function::Sin, angle), graph.function(Function::Cos, angle));
    let versine = graph.sub(Id::ONE, cos);
    let skew = skew(axis, graph);
    let mut entry = |i: usize, j: usize| {
        let along = graph.product([axis[i], axis[j], versine].map(|x| (x, 1.into())));
        let across = graph.mul(sin, skew[i][j]);
        graph.total([if i == j { cos } else { Id::ZERO }, across, along])
    };
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
}
