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

impl SetParameter for Spring {
    fn set_first(&mut self, value: f64) {
        self.k = value;
    }
}

impl SetParameter for Rod {
    fn set_first(&mut self, value: f64) {
        self.square = value;
    }
}
