//! Systems that can be broken.

use lagrange_core::prelude::*;

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

/// A bob on a rod of the length √`square`, which shrinks to nothing at the time `square`/`shrinks`.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(rod: x^2 + y^2 = square - shrinks*t)]
pub(crate) struct Rod {
    pub(crate) m: f64,
    pub(crate) g: f64,
    pub(crate) square: f64,
    pub(crate) shrinks: f64,
}

pub(crate) const ROD: Rod = Rod { m: 1.0, g: 9.81, square: 1.0, shrinks: 0.0 };

/// A bob on two rods, which are one for a = 1.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - y)]
#[constraint(rod: x^2 + y^2 = 1)]
#[constraint(again: a*x^2 + y^2 = 1)]
pub(crate) struct TwoRods {
    pub(crate) a: f64,
}

impl SetParameter for Spring {
    fn set_first(&mut self, value: f64) {
        self.k = value;
    }
}

impl SetParameter for Field {
    fn set_first(&mut self, value: f64) {
        self.star = value;
    }
}

impl SetParameter for Rod {
    fn set_first(&mut self, value: f64) {
        self.square = value;
    }
}

impl SetParameter for TwoRods {
    fn set_first(&mut self, value: f64) {
        self.a = value;
    }
}
