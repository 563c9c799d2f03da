//! A system's equations, to be read.

use core::fmt::{self, Display, Formatter};

/// The Lagrangian, the constraints and the equations of motion of a system, as text and as LaTeX.
///
/// `Type::equations()` gives them for every type with `#[derive(Lagrangian)]`; they also stand in its
/// documentation.
///
/// ```
/// use lagrange_core::prelude::*;
///
/// #[derive(Lagrangian)]
/// #[coordinates(theta)]
/// #[lagrangian(m/2 * l^2 * theta_dot^2 + m*g*l*cos(theta))]
/// struct Pendulum { m: f64, l: f64, g: f64 }
///
/// assert!(Pendulum::equations().text().contains("l θ̈ = −g sin θ"));
/// println!("{}", Pendulum::equations());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Equations {
    text: &'static str,
    latex: &'static str,
}

impl Equations {
    /// In Unicode, a line for each equation.
    pub const fn text(&self) -> &'static str {
        self.text
    }

    /// An `align*` environment.
    pub const fn latex(&self) -> &'static str {
        self.latex
    }
}

/// Of these forms.
pub const fn equations(text: &'static str, latex: &'static str) -> Equations {
    Equations { text, latex }
}

impl Display for Equations {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self.text)
    }
}
