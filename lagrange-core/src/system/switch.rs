//! Fields that keep the state of a constraint: whether it holds, and whether friction sticks or slides.

use crate::number::Scalar;

/// Whether a contact is open or closed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Contact {
    /// The bodies may part: no force acts.
    #[default]
    Open,
    /// The bodies touch and stay together: the gap is a constraint, and so is the velocity of its friction, if it has any.
    Closed,
    /// The bodies touch, and slide along one another. The friction of one velocity acts against the sign of the first number;
    /// that of two acts against the velocity, which has a positive part along this direction.
    Slides([f64; 2]),
    /// The bodies touch and stay together, along with others that share the force of friction. For each velocity, `None`
    /// stands for the force that keeps it zero, and a number for that part of the limit, while the others keep the velocity zero.
    Shares([Option<f64>; 2]),
}

/// Whether friction keeps bodies together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Friction {
    /// The velocity is zero, as a constraint.
    #[default]
    Sticks,
    /// The bodies slide, with a force as for [`Contact::Slides`].
    Slides([f64; 2]),
    /// The bodies stay together, with a force as for [`Contact::Shares`].
    Shares([Option<f64>; 2]),
}

impl Friction {
    /// Whether its force keeps this component of the velocity at zero.
    pub(crate) fn keeps(&self, component: usize) -> bool {
        match self {
            Self::Sticks => true,
            Self::Shares(parts) => parts[component].is_none(),
            Self::Slides(_) => false,
        }
    }

    /// Whether the bodies stay together.
    pub(crate) fn is_at_rest(&self) -> bool {
        !matches!(self, Self::Slides(_))
    }
}

/// A field that says whether a constraint holds.
pub trait Switch {
    /// Returns whether the constraint holds.
    fn is_on(&self) -> bool;
}

impl Switch for Contact {
    #[inline(always)]
    fn is_on(&self) -> bool {
        *self != Self::Open
    }
}

impl Switch for bool {
    #[inline(always)]
    fn is_on(&self) -> bool {
        *self
    }
}

/// A field that says whether friction sticks or slides.
pub trait FrictionState {
    /// Returns the state of the friction; `None` if nothing presses the bodies together.
    fn friction(&self) -> Option<Friction>;

    /// Sets the state of the friction.
    fn set_friction(&mut self, state: Friction);

    /// Returns whether its force, or a part of it, is a multiple of that of sliding.
    fn slides(&self) -> bool {
        match self.friction() {
            Some(Friction::Slides(direction)) => direction != [0.0; 2],
            Some(Friction::Shares(parts)) => parts.iter().any(|part| part.is_some_and(|part| part != 0.0)),
            Some(Friction::Sticks) | None => false,
        }
    }
}

impl FrictionState for Contact {
    #[inline(always)]
    fn friction(&self) -> Option<Friction> {
        match *self {
            Self::Open => None,
            Self::Closed => Some(Friction::Sticks),
            Self::Slides(direction) => Some(Friction::Slides(direction)),
            Self::Shares(parts) => Some(Friction::Shares(parts)),
        }
    }

    #[inline(always)]
    fn set_friction(&mut self, state: Friction) {
        *self = match state {
            Friction::Sticks => Self::Closed,
            Friction::Slides(direction) => Self::Slides(direction),
            Friction::Shares(parts) => Self::Shares(parts),
        };
    }
}

impl FrictionState for Friction {
    #[inline(always)]
    fn friction(&self) -> Option<Friction> {
        Some(*self)
    }

    #[inline(always)]
    fn set_friction(&mut self, state: Friction) {
        *self = state;
    }
}

/// 1 while the constraint of the field holds, else 0.
#[inline(always)]
pub fn holds<T: Scalar>(field: &impl Switch) -> T {
    one_if(field.is_on())
}

/// 1 while the friction of the field keeps a component of the velocity at zero, else 0.
#[inline(always)]
pub fn sticks<T: Scalar>(field: &impl FrictionState, component: usize) -> T {
    one_if(field.friction().is_some_and(|friction| friction.keeps(component)))
}

/// Returns whether the friction of the field keeps a component of the velocity at zero.
#[inline(always)]
pub fn keeps(field: &impl FrictionState) -> bool {
    field.friction().is_some_and(|friction| (0..2).any(|component| friction.keeps(component)))
}

/// 1 while the friction of the field slides, else 0.
#[inline(always)]
pub fn slides<T: Scalar>(field: &impl FrictionState) -> T {
    one_if(matches!(field.friction(), Some(Friction::Slides(direction)) if direction != [0.0; 2]))
}

/// A component of the direction in which the friction of the field slides, or of the part of its limit that is
/// stated; else 0.
#[inline(always)]
pub fn slip<T: Scalar>(field: &impl FrictionState, component: usize) -> T {
    match field.friction() {
        Some(Friction::Slides(direction)) => T::constant(direction[component]),
        Some(Friction::Shares(parts)) => T::constant(-parts[component].unwrap_or(0.0)),
        _ => T::constant(0.0),
    }
}

/// [`slip`] times a speed whose square is still a number, far below that of any motion.
#[inline(always)]
pub fn start<T: Scalar>(field: &impl FrictionState, component: usize) -> T {
    let least = T::constant(1e-100);
    // Single precision has no such number.
    let speed = if least == T::constant(0.0) { T::constant(1e-12) } else { least };
    slip::<T>(field, component) * speed
}

fn one_if<T: Scalar>(is_so: bool) -> T {
    T::constant(if is_so { 1.0 } else { 0.0 })
}
