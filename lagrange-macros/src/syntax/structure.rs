//! Fields that are structs: which members they have, and of what shape.

use proc_macro2::Span;
use syn::{GenericArgument, Ident, Type};

use super::field::{Field, Inside, Layout, Property, arguments, arrays};
use super::name::Name;

/// Structs of one type, and those of their members that expressions may use: `[6] {m, c: [3]}`.
#[derive(Clone, Debug)]
pub(crate) struct Structure {
    /// As of arrays in arrays; none for a single one.
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

/// Numbers of which nothing is said.
pub(super) fn numbers(layout: Layout) -> MemberShape {
    MemberShape::Numbers(layout, None)
}

impl Structure {
    /// Of a field whose type is known to have members, an isometry of nalgebra, and the type of its numbers.
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

    /// The members of an isometry.
    pub(super) fn pose(span: Span, rotation: Layout) -> Self {
        let member = |name: &str, layout| {
            let ident = Ident::new(name, span);
            Member { name: Name::new(&ident), ident, shape: numbers(layout) }
        };
        let translation = member("translation", Layout::array([3]));
        Self { lengths: Vec::new(), members: vec![translation, member("rotation", rotation)] }
    }
}
