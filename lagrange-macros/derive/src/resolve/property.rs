//! Properties of matrix parameters: symmetric, or a rotation.

use super::parameters::{Entry, Parameters};
use crate::diagnostics::Place;
use crate::syntax::{Field, FieldShape, Inside, Property};

impl Parameters {
    pub(super) fn set_property(&mut self, index: usize, property: Property, place: Place) -> syn::Result<()> {
        let Field { name, shape, .. } = &self.fields[index];
        // A field without a known shape is reported where an expression uses it.
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

    /// Property of the matrices in a field, by the type of the field or by a `parameter` attribute.
    pub(crate) fn property(&self, field: usize) -> Option<Property> {
        let is_rotation = |shape: &FieldShape| shape.layout.inside == Inside::Rotation;
        let by_type = self.fields[field].shape.as_ref().is_ok_and(is_rotation).then_some(Property::Rotation);
        by_type.or(self.said(field))
    }

    /// Property of the matrices in a field by a `parameter` attribute.
    pub(crate) fn said(&self, field: usize) -> Option<Property> {
        self.properties[field]
    }

    /// Returns whether the type of a field says that its entries form unit quaternions.
    pub(crate) fn is_unit_quaternion(&self, field: usize) -> bool {
        self.fields[field].shape.as_ref().is_ok_and(|shape| shape.layout.inside == Inside::UnitQuaternion)
    }

    /// Length of the innermost arrays of a field.
    pub(crate) fn size(&self, field: usize) -> usize {
        self.fields[field].shape.as_ref().map_or(1, |shape| shape.layout.size())
    }

    /// Name, as written in an expression, of the matrix that contains an entry.
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

    /// Returns whether all matrices of the field of this entry are declared symmetric.
    pub(crate) fn is_symmetric(&self, entry: Entry) -> bool {
        matches!(self.property(entry.field), Some(Property::Symmetric))
    }

    /// Entry whose symbol stands for this one: in a symmetric matrix, the one in the upper triangle.
    pub(crate) fn representative(&self, entry: Entry) -> Entry {
        match self.property(entry.field) {
            Some(Property::Symmetric) => entry.min(self.mirrored(entry)),
            _ => entry,
        }
    }
}
