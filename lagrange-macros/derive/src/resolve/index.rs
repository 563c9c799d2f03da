//! Elements and slices of arrays, fields and families.

use super::access::AccessPart;
use super::lowering::{Definition, Lowering};
use super::parameters::text;
use super::scope::Entity;
use super::value::Value;
use crate::diagnostics::Place;
use crate::symbolic::Rational;
use crate::syntax::{Expression, Kind, Name, Slice};

/// Indexed expression, and the index.
type Indexed<'e> = (&'e Expression, &'e Expression);

impl Lowering<'_> {
    /// `base[index]`
    pub(super) fn index(&mut self, base: &Expression, index: &Expression) -> Option<Value> {
        if let Some(mut access) = self.access(base) {
            access.parts.push(AccessPart::Index(index));
            return self.field_value(&access);
        }
        let indices = chain(base, index);
        if let Kind::Name(name) = &indices[0].0.kind
            && !self.locals.iter().any(|(local, _)| *local == name.text)
            && let Some(Entity::Definition(first)) = self.scope.get(&name.text)
            && self.defines[first].target.is_family()
        {
            return self.family_element(first, name, &indices);
        }
        let value = self.lower(base)?;
        self.item(&value, (base, index))
    }

    fn item(&mut self, value: &Value, (base, index): Indexed<'_>) -> Option<Value> {
        let i = self.integer(index)?;
        let Some(length) = value.length() else {
            let name = if let Kind::Name(name) = &base.kind { Some(name.text.as_str()) } else { None };
            return self.no_elements(base.place, name);
        };
        let i = self.checked(i, length, index.place)?;
        value.item(i)
    }

    /// Reports an index into a number, and says at the declaration of a name how it would have elements.
    pub(super) fn no_elements<T>(&mut self, place: Place, name: Option<&str>) -> Option<T> {
        self.report::<T>(place, "this is a scalar: it has no elements");
        let name = name.filter(|name| self.locals.iter().all(|(local, _)| local != name))?;
        let (entity, declared) = self.scope.entities.get(name)?;
        let (what, written, declared) = match *entity {
            Entity::Coordinate(index) | Entity::Velocity(index) | Entity::Acceleration(index) => {
                let mut entities = self.scope.entities.iter();
                let (of, _) = entities.find(|(_, (entity, _))| *entity == Entity::Coordinate(index))?;
                (of.as_str(), format!("`{of}: [n]`"), *declared)
            }
            Entity::Field(index) => {
                let field = &self.parameters.fields[index];
                (name, format!("its type as `[{}; n]`", text(&field.ty)), field.place)
            }
            Entity::Definition(_) => (name, format!("a family, `{name}[i in 0..n] = …`"), *declared),
            Entity::Function(_) | Entity::Frame => return None,
        };
        self.report(declared, format!("`{what}` is one number here: for n of them write {written}"))
    }

    /// Lowers `base[from..to]` element by element, so that unused elements of a large field cost nothing.
    pub(super) fn slice(&mut self, Slice { base, from, to }: &Slice) -> Option<Value> {
        let range = self.range(from, to)?;
        let element = |i: usize| {
            let number = Kind::Number(Rational::from_integer(i as i128).into());
            self.index(base, &Expression { kind: number, place: from.place.to(to.place) })
        };
        let elements = range.map(element).collect::<Option<Vec<Value>>>()?;
        self.even(Value::Vector(elements), from.place.to(to.place))
    }

    /// Converts `i` to an index from 0 to `length` − 1, or reports it.
    pub(super) fn checked(&mut self, i: i128, length: usize, place: Place) -> Option<usize> {
        let found = usize::try_from(i).ok().filter(|&i| i < length);
        let last = length.saturating_sub(1);
        let wrong = || format!("the index {i} is out of range: the elements are 0 to {last}");
        found.or_else(|| self.report(place, wrong()))
    }

    /// Lowers an indexed family: the first indices select an element of the family, the rest index into its value.
    fn family_element(&mut self, first: usize, name: &Name, indices: &[Indexed<'_>]) -> Option<Value> {
        let rank = self.defines[first].target.indices.len().min(indices.len());
        if matches!(self.definitions[first], Definition::Wrong) {
            return None;
        }
        if self.is_open_definition(first) {
            return self.open_family_item(first, name, indices);
        }
        let mut path = Vec::new();
        for (_, index) in &indices[..rank] {
            path.push(self.integer(index)?);
        }
        let mut value = self.element(first, &name.text, &path, indices[rank - 1].1.place)?;
        for &indexed in &indices[rank..] {
            value = self.item(&value, indexed)?;
        }
        Some(value)
    }

    /// Lowers an indexed family whose range is known when the program runs.
    fn open_family_item(&mut self, first: usize, name: &Name, indices: &[Indexed<'_>]) -> Option<Value> {
        let rank = self.defines[first].target.indices.len();
        let Some((own, rest)) = indices.split_at_checked(rank) else {
            return self.report(name.place, format!("`{}` takes {rank} indices", name.text));
        };
        let place = name.place.to(own[rank - 1].1.place);
        let mut value = match self.definitions[first] {
            Definition::Recursion(array) => {
                let index = self.position(own[0].1)?;
                self.recursion_element(array, index, place)?
            }
            _ => {
                let path: Vec<_> = own.iter().map(|(_, index)| self.affine(index)).collect();
                let path: Option<Vec<_>> = path.into_iter().collect();
                self.open_family_element(first, name, &path?, place)?
            }
        };
        for &indexed in rest {
            value = self.item(&value, indexed)?;
        }
        Some(value)
    }

    /// Returns the array if all items have one shape, as later operations assume; reports it otherwise.
    pub(super) fn even(&mut self, value: Value, place: Place) -> Option<Value> {
        match value.uneven() {
            Some([first, other]) => {
                self.report(place, format!("this is no array: {first} stands in it beside {other}"))
            }
            None => Some(value),
        }
    }
}

/// Splits nested `base[index]` into its indices, leftmost first. Iterates, so that no number of indices overflows the
/// stack.
fn chain<'e>(base: &'e Expression, index: &'e Expression) -> Vec<Indexed<'e>> {
    let mut chain = vec![(base, index)];
    while let Kind::Index(base, index) = &chain[chain.len() - 1].0.kind {
        chain.push((base, index));
    }
    chain.reverse();
    chain
}
