//! Values of parameters by name.

use lagrange_derive::ParameterField;

use crate::error::ParameterError;

/// Values of parameters, each by the name of its field, `m`, or of one number in a field, `m[1]` or `body.m`.
///
/// A list of names and numbers converts to it; lists of numbers, and arrays by rows, are values of fields that are arrays:
///
/// ```
/// use lagrange_interpreter::{Model, Parameters, System};
///
/// let system = System::parse(
///     "#[coordinates(x: [2])]
///      #[lagrangian(sum(i in 0..2, m[i]/2*x_dot[i]^2) - k*(x[0] - x[1])^2/2)]
///      struct Springs { m: [f64; 2], k: f64 }",
/// )?;
/// let model = Model::new(&system, Parameters::default().with("m", [1.0, 2.0]).with("k", 3.0))?;
/// assert_eq!(model.parameters().collect::<Vec<_>>(), [("m[0]", 1.0), ("m[1]", 2.0), ("k", 3.0)]);
/// Model::new(&system, [("k", 3.0), ("m[1]", 2.0), ("m[0]", 1.0)])?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parameters(Vec<(String, Values)>);

/// A number, or the numbers of an array by rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Values(Vec<f64>);

impl Parameters {
    /// Adds the value of a parameter or of a field.
    #[must_use]
    pub fn with(mut self, name: impl Into<String>, values: impl Into<Values>) -> Self {
        self.0.push((name.into(), values.into()));
        self
    }
}

impl<N: Into<String>, V: Into<Values>> FromIterator<(N, V)> for Parameters {
    fn from_iter<I: IntoIterator<Item = (N, V)>>(pairs: I) -> Self {
        pairs.into_iter().fold(Self::default(), |all, (name, values)| all.with(name, values))
    }
}

impl<N: Into<String>, V: Into<Values>, const K: usize> From<[(N, V); K]> for Parameters {
    fn from(pairs: [(N, V); K]) -> Self {
        pairs.into_iter().collect()
    }
}

impl From<f64> for Values {
    fn from(number: f64) -> Self {
        Self(vec![number])
    }
}

impl From<Vec<f64>> for Values {
    fn from(numbers: Vec<f64>) -> Self {
        Self(numbers)
    }
}

impl<T: Into<Self>, const N: usize> From<[T; N]> for Values {
    fn from(rows: [T; N]) -> Self {
        Self(rows.into_iter().flat_map(|row| row.into().0).collect())
    }
}

/// Names of the parameters of a system, and the fields that they are in.
#[derive(Clone, Debug)]
pub(crate) struct ParameterNames {
    pub(crate) names: Vec<String>,
    pub(crate) fields: Vec<ParameterField>,
}

impl ParameterNames {
    /// Values of all parameters, in their order.
    pub(crate) fn all(&self, Parameters(given): Parameters) -> Result<Vec<f64>, Vec<ParameterError>> {
        let (mut found, mut errors) = (vec![None; self.names.len()], Vec::new());
        for (name, values) in given {
            let assigned = self.assigned(&name, &values).unwrap_or_else(|error| {
                errors.push(error);
                // The value is wrong, not missing.
                self.places(&name)
                    .unwrap_or_default()
                    .into_iter()
                    .flatten()
                    .map(|place| (place, 0.0))
                    .collect()
            });
            if assigned.iter().any(|(place, _)| found[*place].is_some()) {
                errors.push(ParameterError::Repeated { name });
            }
            assigned.into_iter().for_each(|(place, value)| found[place] = Some(value));
        }
        let missing = self.names.iter().zip(&found).filter(|(_, value)| value.is_none());
        errors.extend(missing.map(|(name, _)| ParameterError::Missing { name: name.clone() }));
        if errors.is_empty() { Ok(found.into_iter().flatten().collect()) } else { Err(errors) }
    }

    /// Indices of the parameters that a name stands for, with their values.
    pub(crate) fn assigned(
        &self,
        name: &str,
        Values(values): &Values,
    ) -> Result<Vec<(usize, f64)>, ParameterError> {
        let Some(places) = self.places(name) else {
            return Err(ParameterError::Unknown { name: name.to_owned(), similar: self.similar(name) });
        };
        if values.len() != places.len() {
            let (found, expected) = (values.len(), places.len());
            return Err(ParameterError::Count { name: name.to_owned(), found, expected });
        }
        if let Some(&value) = values.iter().find(|value| !value.is_finite()) {
            return Err(ParameterError::NotFinite { name: name.to_owned(), value });
        }
        let mut assigned: Vec<(usize, f64)> = Vec::new();
        for (place, &value) in
            places.into_iter().zip(values).filter_map(|(place, value)| Some((place?, value)))
        {
            match assigned.iter().find(|(known, _)| *known == place) {
                Some((_, mirrored)) if *mirrored != value => {
                    return Err(ParameterError::Asymmetric { name: name.to_owned() });
                }
                Some(_) => {}
                None => assigned.push((place, value)),
            }
        }
        Ok(assigned)
    }

    /// For each number that a name stands for, the index of its parameter; `None` where the equations contain none.
    fn places(&self, name: &str) -> Option<Vec<Option<usize>>> {
        let one = self.names.iter().position(|known| known == name).map(|place| vec![Some(place)]);
        one.or_else(|| Some(self.fields.iter().find(|field| field.name == name)?.entries.clone()))
    }

    fn similar(&self, name: &str) -> Option<String> {
        let known = self.names.iter().chain(self.fields.iter().map(|field| &field.name));
        let distance =
            |known: &String| strsim::damerau_levenshtein(&known.to_lowercase(), &name.to_lowercase());
        let nearest = known.map(|known| (distance(known), known)).min_by_key(|(distance, _)| *distance);
        nearest
            .filter(|(distance, _)| 3 * distance <= name.chars().count().max(3))
            .map(|(_, known)| known.clone())
    }
}
