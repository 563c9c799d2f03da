//! Names shown to users.

use crate::diagnostics::Place;
use crate::syntax::{Declaration, Layout};

/// Name shown to users, and its source position.
#[derive(Clone, Debug)]
pub(crate) struct Label {
    pub(crate) text: String,
    pub(crate) place: Place,
}

/// Names of the scalar coordinates: `x`, `r[0]`, `r[1]`.
pub(crate) fn labels(declaration: &Declaration) -> Vec<Label> {
    let elements = declaration.coordinates.iter().flat_map(|coordinate| {
        let place = coordinate.name.place;
        let texts = entry_names(&coordinate.name.text, &coordinate.lengths);
        texts.into_iter().map(move |text| Label { text, place })
    });
    elements.collect()
}

/// Name of an element: `x`, `x[0]` or `x[0][1]`.
pub(super) fn element_name(name: &str, indices: &[usize]) -> String {
    indices.iter().fold(name.to_owned(), |name, i| format!("{name}[{i}]"))
}

/// Names of all entries of an array of these lengths: `x` for a scalar, `x[0]`, `x[1]` for a vector, `x[0][1]` for a
/// matrix.
pub(crate) fn entry_names(name: &str, lengths: &[usize]) -> Vec<String> {
    let layout = Layout::array(lengths);
    (0..layout.numbers()).map(|number| element_name(name, &layout.indices(number))).collect()
}

/// Labels in groups: the components of each vector together, all others alone.
pub(crate) fn vectors(labels: &[Label]) -> impl Iterator<Item = &[Label]> {
    let are_together =
        |one: &Label, other: &Label| vector(&one.text).is_some() && vector(&one.text) == vector(&other.text);
    labels.chunk_by(are_together)
}

/// Name without its last index: `r` for `r[0]`, `r[1]` for `r[1][0]`.
pub(crate) fn vector(text: &str) -> Option<&str> {
    text.strip_suffix(']')?.rsplit_once('[').map(|(vector, _)| vector)
}
