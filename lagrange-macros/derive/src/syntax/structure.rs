//! Fields that are structs: their members and the shape of each.

use proc_macro2::Span;
use syn::{GenericArgument, Ident, Type};

use super::field::{Field, Inside, Layout, Property, arguments, arrays};
use super::name::Name;

/// Struct or array of structs, with the members that expressions may use: `[6] {m, c: [3]}`.
#[derive(Clone, Debug)]
pub(crate) struct Structure {
    /// Array lengths, outermost first; empty for a single struct.
    pub(crate) lengths: Vec<usize>,
    pub(crate) members: Vec<Member>,
}

#[derive(Clone, Debug)]
pub(crate) struct Member {
    pub(crate) name: Name,
    pub(crate) ident: Ident,
    pub(crate) shape: MemberShape,
}

#[derive(Clone, Debug)]
pub(crate) enum MemberShape {
    Numbers(Layout, Option<Property>),
    Struct(Structure),
}

/// Creates the shape of a member that consists of numbers, without a property such as `symmetric`.
pub(super) fn numbers(layout: Layout) -> MemberShape {
    MemberShape::Numbers(layout, None)
}

impl Structure {
    /// Recognizes a field whose type is an isometry of nalgebra. Returns its members and the scalar type.
    pub(crate) fn known(field: &Field) -> Option<(Self, Type)> {
        let (lengths, element) = arrays(&field.ty);
        let Type::Path(path) = element else { return None };
        let segment = path.path.segments.last()?;
        let rotation = match segment.ident.to_string().as_str() {
            "Isometry3" => Layout::quaternion(Inside::UnitQuaternion),
            "IsometryMatrix3" => Layout::rotation(3),
            _ => return None,
        };
        let [GenericArgument::Type(scalar)] = arguments(segment)[..] else { return None };
        Some((Self { lengths, ..Self::pose(segment.ident.span(), rotation) }, scalar.clone()))
    }

    /// Returns the members of an isometry: translation and rotation.
    pub(super) fn pose(span: Span, rotation: Layout) -> Self {
        let member = |name: &str, layout| {
            let ident = Ident::new(name, span);
            Member { name: Name::new(&ident), ident, shape: numbers(layout) }
        };
        let translation = member("translation", Layout::array([3]));
        Self { lengths: Vec::new(), members: vec![translation, member("rotation", rotation)] }
    }
}
