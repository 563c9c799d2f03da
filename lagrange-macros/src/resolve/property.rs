//! What matrices among the parameters are said to be.

use super::parameters::{Entry, Parameters};
use crate::diagnostics::Place;
use crate::syntax::{Field, FieldShape, Inside, Property};

impl Parameters {
    pub(super) fn set_property(&mut self, index: usize, property: Property, place: Place) -> syn::Result<()> {
        let Field { name, shape, .. } = &self.fields[index];
        // Of a field without a shape that is said where it is used.
        let Ok(FieldShape { layout, .. }) = shape else { return Ok(()) };
        if !matches!(layout.inside, Inside::Array | Inside::Matrix) {
            return Err(place.error(format!("the type of `{}` says what it is", name.text)));
        }
        if !matches!(layout.lengths[..], [.., rows, columns] if rows == columns) {
            let message =
                format!("`{}` is no square matrix, which alone is symmetric or a rotation", name.text);
            return Err(place.error(message));
        }
        self.properties[index] = Some(property);
        Ok(())
    }

    /// What the matrices of a field are said to be, by its type or beside it.
    pub(crate) fn property(&self, field: usize) -> Option<Property> {
        let is_rotation = |shape: &FieldShape| shape.layout.inside == Inside::Rotation;
        let by_type = self.fields[field].shape.as_ref().is_ok_and(is_rotation).then_some(Property::Rotation);
        by_type.or(self.said(field))
    }

    /// What is said of them beside their type.
    pub(crate) fn said(&self, field: usize) -> Option<Property> {
        self.properties[field]
    }

    /// Whether the numbers of a field are quaternions of length 1 by its type.
    pub(super) fn is_unit_quaternion(&self, field: usize) -> bool {
        self.fields[field].shape.as_ref().is_ok_and(|shape| shape.layout.inside == Inside::UnitQuaternion)
    }

    /// The length of the innermost arrays of a field.
    pub(crate) fn size(&self, field: usize) -> usize {
        self.fields[field].shape.as_ref().map_or(1, |shape| shape.layout.size())
    }

    /// The matrix that a number is in, as an expression names it.
    pub(crate) fn matrix_name(&self, entry: Entry) -> String {
        let indices = self.indices(entry);
        self.element(entry.field, &indices[..indices.len().saturating_sub(2)])
    }

    /// Entry of the transposed position in a matrix.
    pub(crate) fn mirrored(&self, Entry { field, number }: Entry) -> Entry {
        let size = self.size(field);
        let (matrix, row, column) = (number / (size * size), number / size % size, number % size);
        Entry { field, number: (matrix * size + column) * size + row }
    }

    /// The number that stands for it: of two across the diagonal of a symmetric matrix the upper one.
    pub(super) fn representative(&self, entry: Entry) -> Entry {
        match self.property(entry.field) {
            Some(Property::Symmetric) => entry.min(self.mirrored(entry)),
            _ => entry,
        }
    }
}
