//! Systems that can be broken.

use lagrange_core::prelude::*;

use crate::Rod;
use crate::faults::case::SetParameter;

/// A particle on a spring.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*x_dot^2 + n/2*y_dot^2 - k/2*(x^2 + y^2))]
pub(crate) struct Spring {
    pub(crate) m: f64,
    pub(crate) n: f64,
    pub(crate) k: f64,
}

pub(crate) const SPRING: Spring = Spring { m: 1.0, n: 1.0, k: 1.0 };

/// A potential with a pole at the origin, with a root that ends at x = 2, and with a force that drives the particle to
/// infinity in finite time.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 + star/sqrt(x^2 + y^2) - cliff*sqrt(2 - x) + escape*x^4/2)]
pub(crate) struct Field {
    pub(crate) star: f64,
    pub(crate) cliff: f64,
    pub(crate) escape: f64,
}

/// A bob on two rods, which are one for a = 1.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - y)]
#[constraint(rod: x^2 + y^2 = 1)]
#[constraint(again: a*x^2 + y^2 = 1)]
pub(crate) struct TwoRods {
    pub(crate) a: f64,
}

/// Sets the first parameter of each.
macro_rules! set_first {
    ($($system:ty: $field:ident),*) => {$(
        impl SetParameter for $system {
            fn set_first(&mut self, value: f64) {
                self.$field = value;
            }
        }
    )*};
}

set_first!(Spring: k, Field: star, Rod: square, TwoRods: a);
