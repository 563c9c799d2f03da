//! Fields that are structs: each declared member becomes a field of its own among the parameters.

use syn::{GenericArgument, Type};

use super::parameters::{Entry, Parameters, is_float, is_scalar_name, text};
use super::unknown::{nearest, or_meant};
use crate::diagnostics::Place;
use crate::syntax::{
    Declaration, Field, FieldShape, Layout, Member, MemberShape, Name, Property, Segment, Structure,
    arguments, arrays, short_enough,
};

impl Parameters {
    /// Adds the members of fields whose type is a known struct, such as an isometry.
    pub(super) fn add_known_structures(&mut self) {
        for index in 0..self.fields.len() {
            if let Some((structure, scalar)) = Structure::known(&self.fields[index]) {
                self.add_members(index, &structure, Some(&scalar));
            }
        }
    }

    pub(super) fn set_structure(
        &mut self,
        index: usize,
        structure: &Structure,
        place: Place,
    ) -> syn::Result<()> {
        let Field { name, ty, .. } = &self.fields[index];
        let (name, lengths) = (&name.text, arrays(ty).0);
        if self.is_struct(index) {
            return Err(place.error(format!("the type of `{name}` says what its members are")));
        }
        if self.is_made_of_numbers(index) {
            let message = format!("`{name}` is made of numbers, without members: its type is `{}`", text(ty));
            return Err(place.error(message));
        }
        // A type with another name may be an alias of an array.
        if !structure.lengths.starts_with(&lengths) {
            let message = format!("the type of `{name}` says another shape: `{lengths:?} {{…}}`");
            return Err(place.error(message));
        }
        self.add_members(index, structure, None);
        Ok(())
    }

    fn add_members(&mut self, index: usize, structure: &Structure, scalar: Option<&Type>) {
        let whole = Field { shape: Err(String::new()), ..self.fields[index].clone() };
        for (member, layout, property) in flattened(structure, &whole, &[]) {
            let shape = short_enough(FieldShape { layout, scalar: scalar.cloned(), is_reference: false });
            self.fields.push(Field { shape, ..member });
            self.ranges.push(self.ranges[index]);
            self.properties.push(property);
        }
    }

    /// Rejects a shape or a matrix property on a struct: only its members accept it.
    pub(super) fn reject_struct(&self, index: usize, place: Place) -> syn::Result<()> {
        if !self.is_struct(index) {
            return Ok(());
        }
        let text = &self.fields[index].name.text;
        Err(place.error(format!(
            "`{text}` is a struct: this is said of its members, `#[parameter({text}: {{I: symmetric}})]`"
        )))
    }

    /// Indices of the members of a field; none if the field is no struct.
    pub(super) fn members_of(&self, index: usize) -> impl Iterator<Item = usize> {
        let name = &self.fields[index].name.text;
        let is_member = move |field: &Field| !field.members.is_empty() && field.name.text == *name;
        (0..self.fields.len()).filter(move |&k| is_member(&self.fields[k]))
    }

    pub(super) fn is_struct(&self, index: usize) -> bool {
        self.members_of(index).next().is_some()
    }

    /// First field whose path begins with these members; the field itself if it has no members and none are given.
    pub(super) fn behind(&self, index: usize, members: &[&Name]) -> Option<usize> {
        let is_behind = |&k: &usize| {
            let path = &self.fields[k].members;
            path.len() >= members.len()
                && path.iter().zip(members).all(|(one, other)| one.name.text == other.text)
        };
        let itself = (members.is_empty() && !self.is_struct(index)).then_some(index);
        itself.or_else(|| self.members_of(index).find(is_behind))
    }

    /// Returns whether each of the wanted members exists below this path.
    pub(super) fn has_members(&self, index: usize, members: &[&Name], wanted: &[Name]) -> bool {
        wanted.iter().all(|member| self.behind(index, &[members, &[member]].concat()).is_some())
    }

    /// Ends a message about an unknown member: suggests the nearest member of the struct, or lists all members.
    pub(super) fn member_meant(&self, field: usize, members: usize, name: Option<&str>) -> String {
        let path = &self.fields[field].members[..members];
        let is_same = |(one, other): (&Segment, &Segment)| one.name.text == other.name.text;
        let siblings = self.members_of(field).map(|k| &self.fields[k].members);
        let siblings = siblings.filter(|other| other.len() > members && other.iter().zip(path).all(is_same));
        let mut names: Vec<&str> = siblings.map(|other| other[members].name.text.as_str()).collect();
        names.dedup();
        let near = name.and_then(|name| nearest(name, names.iter().copied()));
        or_meant(name.unwrap_or_default(), near, "member", names.into_iter())
    }

    /// Spells a field and the first `members` names of its path, with the known indices.
    pub(super) fn spelled(&self, field: usize, members: usize, indices: &[usize]) -> String {
        let Field { name, members: path, .. } = &self.fields[field];
        let (mut text, mut from) = (name.text.clone(), 0);
        let index =
            |text: &mut String, indices: &[usize]| indices.iter().for_each(|i| *text += &format!("[{i}]"));
        for Segment { name, after, .. } in &path[..members] {
            index(&mut text, &indices[from..*after]);
            text = format!("{text}.{}", name.text);
            from = *after;
        }
        index(&mut text, &indices[from..]);
        text
    }

    /// Returns whether the type of a field shows that it consists of numbers.
    pub(super) fn is_made_of_numbers(&self, index: usize) -> bool {
        let Field { ty, shape, .. } = &self.fields[index];
        let (lengths, element) = arrays(ty);
        let is_nalgebra = shape.as_ref().is_ok_and(|shape| shape.layout.lengths.len() > lengths.len());
        is_nalgebra || is_float(&text(element))
    }

    /// Scalar argument of the type of a struct, such as `T` in `Link<T>`. It decides if no other field names a scalar
    /// type.
    pub(super) fn scalar_argument(&self, field: usize, declaration: &Declaration) -> Option<Type> {
        let Field { members, ty, .. } = &self.fields[field];
        let is_scalar = |ty: &&Type| is_scalar_name(&text(ty), declaration);
        if members.is_empty() { None } else { all_arguments(ty).into_iter().find(is_scalar).cloned() }
    }

    /// Sort key of an entry: fields as declared, then the elements of arrays of structs one after the other.
    pub(super) fn rank(&self, Entry { field, number }: Entry) -> (usize, Vec<usize>, usize, usize) {
        let Field { name, members, .. } = &self.fields[field];
        let declared = self.fields.iter().position(|other| other.name.text == name.text).unwrap_or(field);
        let mut outer = self.indices(Entry { field, number });
        outer.truncate(members.first().map_or(0, |member| member.after));
        (declared, outer, field, number)
    }

    /// Returns whether a setter can assign this entry through its field alone.
    pub(crate) fn is_settable(&self, Entry { field, .. }: Entry) -> bool {
        let Field { members, ty, shape, .. } = &self.fields[field];
        let Ok(shape) = shape else { return false };
        let is_owned = match members.len() {
            0 => !shape.is_reference && shape.scalar.is_some(),
            1 => owns(ty),
            _ => false,
        };
        is_owned && !self.is_unit_quaternion(field) && self.property(field) != Some(Property::Rotation)
    }
}

/// Returns whether a field of this type owns its contents, unlike `Rc`, `Arc` or `Cow`.
fn owns(ty: &Type) -> bool {
    match ty {
        Type::Paren(inner) => owns(&inner.elem),
        Type::Group(inner) => owns(&inner.elem),
        Type::Array(array) => owns(&array.elem),
        Type::Path(path) => {
            let shared = ["Rc", "Arc", "Cow"];
            path.path.segments.last().is_some_and(|last| shared.iter().all(|name| last.ident != name))
        }
        _ => false,
    }
}

/// Type arguments of a type, outermost first, including nested ones.
fn all_arguments(ty: &Type) -> Vec<&Type> {
    let Type::Path(path) = arrays(ty).1 else { return Vec::new() };
    let arguments = path.path.segments.last().map(arguments).unwrap_or_default();
    let types = arguments.into_iter().filter_map(|argument| match argument {
        GenericArgument::Type(ty) => Some(ty),
        _ => None,
    });
    types.flat_map(|ty| [vec![ty], all_arguments(ty)].concat()).collect()
}

/// Members that are numbers, with the layout and the matrix property of each.
fn flattened(
    structure: &Structure,
    whole: &Field,
    outer: &[usize],
) -> Vec<(Field, Layout, Option<Property>)> {
    let lengths = [outer, &structure.lengths].concat();
    let part = |member: &Member| {
        let (name, ident) = (member.name.clone(), member.ident.clone());
        let mut part = whole.clone();
        part.members.push(Segment { name, ident, after: lengths.len() });
        match &member.shape {
            MemberShape::Numbers(layout, property) => vec![(part, layout.within(&lengths), *property)],
            MemberShape::Struct(structure) => flattened(structure, &part, &lengths),
        }
    };
    structure.members.iter().flat_map(part).collect()
}
