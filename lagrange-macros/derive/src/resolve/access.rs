//! Access paths to entries of fields: `m`, `a[i][j]`, `link[i].c[0]`.

use super::lowering::Lowering;
use super::scope::Entity;
use super::value::Value;
use crate::diagnostics::Place;
use crate::syntax::{Expression, Kind, Name, arrays};

/// A field, and the indices and members after its name.
pub(super) struct Access<'e> {
    pub(super) field: usize,
    pub(super) name: &'e Name,
    pub(super) parts: Vec<AccessPart<'e>>,
}

pub(super) enum AccessPart<'e> {
    Index(&'e Expression),
    Member(&'e Name),
}

/// Prefix of an access path that is resolved so far.
pub(super) struct Reached<'e> {
    pub(super) root: usize,
    /// First field whose path begins with these members.
    pub(super) field: usize,
    pub(super) members: Vec<&'e Name>,
    pub(super) indices: Vec<usize>,
    pub(super) place: Place,
}

const NO_MEMBERS: &str =
    "only fields that are structs have members (a component of a vector is written `r[0]`)";

/// Names of the two members of a pose.
fn pose(place: Place) -> [Name; 2] {
    ["translation", "rotation"].map(|text| Name { text: text.to_owned(), place })
}

/// Splits an expression into its base and the indices and members after it.
fn apart(mut expression: &Expression) -> (&Expression, Vec<AccessPart<'_>>) {
    let mut parts = Vec::new();
    // A loop, not recursion: the number of indices and members is unlimited.
    loop {
        let (base, part) = match &expression.kind {
            Kind::Index(base, index) => (base, AccessPart::Index(index)),
            Kind::Member(base, member) => (base, AccessPart::Member(member)),
            _ => break,
        };
        parts.push(part);
        expression = base;
    }
    parts.reverse();
    (expression, parts)
}

impl<'e> Access<'e> {
    fn members(&self) -> Vec<&'e Name> {
        let member =
            |part: &AccessPart<'e>| if let AccessPart::Member(name) = part { Some(*name) } else { None };
        self.parts.iter().filter_map(member).collect()
    }
}

impl Lowering<'_> {
    /// Splits an expression that names a field, or a part of one, into the field and the parts.
    pub(super) fn access<'e>(&self, expression: &'e Expression) -> Option<Access<'e>> {
        let (base, parts) = apart(expression);
        let Kind::Name(name) = &base.kind else { return None };
        if self.locals.iter().any(|(local, _)| *local == name.text) {
            return None;
        }
        match self.scope.get(&name.text)? {
            Entity::Field(field) => Some(Access { field, name, parts }),
            _ => None,
        }
    }

    /// Field, or member of a struct, whose entries an expression names, whatever its indices.
    pub(super) fn field_in(&self, expression: &Expression) -> Option<usize> {
        let access = self.access(expression)?;
        self.parameters.behind(access.field, &access.members())
    }

    /// Translation and rotation of a field, or of a member, that is a pose.
    pub(super) fn parts_of_pose(&self, expression: &Expression) -> Option<[Expression; 2]> {
        let access = self.access(expression)?;
        let parts = pose(expression.place);
        let part = |name: Name| {
            let kind = Kind::Member(Box::new(expression.clone()), name);
            Expression { kind, place: expression.place }
        };
        self.parameters.has_members(access.field, &access.members(), &parts).then(|| parts.map(part))
    }

    /// Lowers `base.member`.
    pub(super) fn member(&mut self, expression: &Expression) -> Option<Value> {
        if let Some(access) = self.access(expression) {
            return self.field_value(&access);
        }
        let (base, _) = apart(expression);
        let Kind::Name(name) = &base.kind else { return self.report(base.place, NO_MEMBERS) };
        match self.scope.get(&name.text) {
            Some(entity) => {
                let message = format!("`{}` is {}: {NO_MEMBERS}", name.text, entity.describe());
                self.report(expression.place, message)
            }
            None => self.lower(base).and_then(|_| self.report(expression.place, NO_MEMBERS)),
        }
    }

    /// Lowers an access path. Only the elements of a large field that are used become parameters.
    pub(super) fn field_value(&mut self, access: &Access<'_>) -> Option<Value> {
        let Reached { field, indices, .. } = self.numbers_of(access)?;
        self.parameters.value(field, &indices, access.name.place, &mut self.graph, self.diagnostics)
    }

    fn numbers_of<'e>(&mut self, access: &Access<'e>) -> Option<Reached<'e>> {
        let field = self.parameters.behind(access.field, &[])?;
        let place = access.name.place;
        let mut reached =
            Reached { root: access.field, field, members: Vec::new(), indices: Vec::new(), place };
        for part in &access.parts {
            let end = match *part {
                AccessPart::Index(index) => {
                    let i = self.element_index(&reached, index, access.name.place)?;
                    reached.indices.push(i);
                    index.place
                }
                AccessPart::Member(member) => {
                    reached.members.push(member);
                    reached.field = self.behind(&reached)?;
                    member.place
                }
            };
            reached.place = access.name.place.to(end);
        }
        if self.is_struct(&reached) { self.struct_alone(&reached) } else { Some(reached) }
    }

    /// Returns whether the path ends at a struct, so that a member must follow.
    fn is_struct(&self, reached: &Reached<'_>) -> bool {
        self.parameters.fields[reached.field].members.len() > reached.members.len()
    }

    fn element_index(&mut self, reached: &Reached<'_>, index: &Expression, name: Place) -> Option<usize> {
        let layout = self.parameters.layout(reached.field, name, self.diagnostics)?;
        let is_struct = self.is_struct(reached);
        let members = &self.parameters.fields[reached.field].members;
        let end = members.get(reached.members.len()).map_or(layout.lengths.len(), |next| next.after);
        let i = self.integer(index)?;
        match layout.lengths[..end].get(reached.indices.len()) {
            Some(&length) => self.checked(i, length, index.place),
            None if is_struct => self.report(reached.place, "this is one struct: it has no elements"),
            None => {
                let is_bare = reached.indices.is_empty() && reached.members.is_empty();
                let bare = is_bare.then(|| self.parameters.fields[reached.root].name.text.clone());
                self.no_elements(reached.place, bare.as_deref())
            }
        }
    }

    /// First field below the last member of the path.
    fn behind(&mut self, reached: &Reached<'_>) -> Option<usize> {
        let Some(next) = self.parameters.behind(reached.root, &reached.members) else {
            return self.no_member(reached);
        };
        let (last, indices) = (reached.members.len() - 1, reached.indices.len());
        if self.parameters.fields[next].members[last].after == indices {
            return Some(next);
        }
        let owner = self.parameters.spelled(next, last, &reached.indices);
        let member = &reached.members[last].text;
        self.report(reached.place, format!("these are several structs: take one, `{owner}[0].{member}`"))
    }

    fn no_member<T>(&mut self, reached: &Reached<'_>) -> Option<T> {
        let Reached { root, field, members, indices, .. } = reached;
        let last = members.len() - 1;
        let owner = self.parameters.spelled(*field, last, indices);
        let (member, name) = (members[last], &self.parameters.fields[*root].name.text);
        let message = if self.parameters.fields[*field].members.len() > last {
            let meant = self.parameters.member_meant(*field, last, Some(&member.text));
            format!("`{owner}` has no member `{}`{meant}", member.text)
        } else if last > 0 || self.parameters.is_made_of_numbers(*root) {
            format!("`{owner}` is made of numbers: {NO_MEMBERS}")
        } else {
            let (lengths, _) = arrays(&self.parameters.fields[*root].ty);
            let lengths = if lengths.is_empty() { String::new() } else { format!("{lengths:?} ") };
            format!(
                "a derive cannot see what is in another type: say which members `{name}` has, `#[parameter({name}: {lengths}{{{}}})]`",
                member.text
            )
        };
        self.report(member.place, message)
    }

    fn struct_alone<T>(&mut self, reached: &Reached<'_>) -> Option<T> {
        let Reached { root, field, members, indices, place } = reached;
        let owner = self.parameters.spelled(*field, members.len(), indices);
        let meant = self.parameters.member_meant(*field, members.len(), None);
        let advice = match self.parameters.has_members(*root, members, &pose(*place)) {
            true => format!(
                "; a frame is led through it by the step `pose({owner})`, a point by `{owner}.translation + quat_rotate({owner}.rotation, r)`"
            ),
            false => String::new(),
        };
        self.report(*place, format!("`{owner}` is a struct and no value{meant}{advice}"))
    }
}
