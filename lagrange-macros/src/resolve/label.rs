//! Names for users to read.

use crate::diagnostics::Place;
use crate::syntax::{Declaration, Layout};

/// A name for users to read, and where it was given.
#[derive(Clone, Debug)]
pub(crate) struct Label {
    pub(crate) text: String,
    pub(crate) place: Place,
}

/// Flat names of the coordinates: `x`, `r[0]`, `r[1]`.
pub(crate) fn labels(declaration: &Declaration) -> Vec<Label> {
    let elements = declaration.coordinates.iter().flat_map(|coordinate| {
        let place = coordinate.name.place;
        let texts = entry_names(&coordinate.name.text, &coordinate.lengths);
        texts.into_iter().map(move |text| Label { text, place })
    });
    elements.collect()
}

/// `x`, `x[0]` or `x[0][1]`
pub(super) fn element_name(name: &str, indices: &[usize]) -> String {
    indices.iter().fold(name.to_owned(), |name, i| format!("{name}[{i}]"))
}

/// `x` of a number, `x[0]`, `x[1]` of a vector, `x[0][1]` of arrays in arrays of these lengths.
pub(crate) fn entry_names(name: &str, lengths: &[usize]) -> Vec<String> {
    let layout = Layout::array(lengths);
    (0..layout.numbers()).map(|number| element_name(name, &layout.indices(number))).collect()
}
