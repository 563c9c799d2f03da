//! Fields that switch constraints on and off.

use crate::contact::Contact;
use crate::number::Scalar;

/// A field that says whether a constraint holds.
pub trait Switch {
    /// Returns whether the constraint holds.
    fn is_on(&self) -> bool;
}

impl Switch for Contact {
    #[inline(always)]
    fn is_on(&self) -> bool {
        *self == Self::Closed
    }
}

impl Switch for bool {
    #[inline(always)]
    fn is_on(&self) -> bool {
        *self
    }
}

/// 1 while the constraint of the field holds, else 0.
#[inline(always)]
pub fn switch<T: Scalar>(field: &impl Switch) -> T {
    T::constant(if field.is_on() { 1.0 } else { 0.0 })
}
