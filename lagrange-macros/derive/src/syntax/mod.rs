//! Parser: turns tokens into a [`Declaration`] without resolving names.

mod attribute;
mod constraint;
mod cursor;
mod declaration;
mod digest;
mod expression;
mod field;
mod forms;
mod frame;
mod greek;
mod name;
mod number;
mod parameter;
mod slips;
mod structure;
mod target;
mod unread;

pub(crate) use attribute::{declaration, refuse_unknown};
pub(crate) use cursor::{NESTING_LIMIT, shallow, too_deep};
pub(crate) use declaration::{
    Constraint, Coordinate, Declaration, Define, Fact, Force, FrameDeclaration, FunctionDeclaration,
    ImpactLaw, Law, Named, Parameter, Power,
};
pub(crate) use expression::{Expression, Kind, Operator, Sign, Slice, SumOver};
pub(crate) use field::{
    Field, FieldShape, Inside, LENGTH_LIMIT, Layout, Lengths, Property, Segment, arguments, arrays,
    element_type, numbers, shape, short_enough,
};
pub(crate) use greek::GREEK;
pub(crate) use name::{Name, normal_form};
pub(crate) use structure::{Member, MemberShape, Structure};
pub(crate) use target::{Target, TargetIndex};
