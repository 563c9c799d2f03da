//! Readable form of the equations of a system.

mod excerpt;
mod slides;

use core::fmt::{self, Display, Formatter};

pub use excerpt::Excerpt;
use slides::Slides;

/// Readable equations of a system, as text, LaTeX and MathML.
///
/// Contents: the Lagrangian as written, the constraints with their kinds, the equations of motion, constraint
/// forces, conserved quantities and the energy. If short enough, also the momenta, the Hamiltonian and
/// Hamilton's equations; if the Hamiltonian is not printed, the page states the reason.
///
/// Expressions are expanded and collected, and sines and cosines are combined (sin² + cos², sums of angles).
/// Each row is divided by the common factor of its terms, and components of vector equations are combined into
/// vectors. Terms over one divisor share its fraction bar, and terms over a sum a common denominator. In products,
/// parameters stand in the order in which the Lagrangian multiplies them. Definitions appear by name or written out,
/// whichever is shorter; [`named`](Self::named) and [`written_out`](Self::written_out) use one form throughout. A row divided by a coordinate is equivalent to
/// the equation except where that coordinate vanishes. This form is for reading only: computations do not use
/// it.
///
/// Some roots get a name, on a line of its own below the Lagrangian, unless a definition names them: distances √(x² + y²)
/// are r, several of them r₁, r₂, … (r₁₂ between bodies with the coordinates x1 and x2, r₁ of one alone), and
/// 1/√(1 − v²/c²) is γ. If the names are taken, other letters replace them. Forces of different degrees in the velocities,
/// such as Coriolis and centrifugal forces, stay apart. The Hamiltonian is printed in closed form if the velocities of each block of
/// coordinates enter L by a quadratic form, by the root of one, or by one power of one; the signs of factors are those at
/// random points, where parameters are in their [ranges](crate::language), positive by default:
/// √(m²c⁴ + p²c²) takes m as positive.
///
/// A frame turned by a quaternion q moves by its angular velocity ω, along the turned axes: q̇ = ½ q ω, a product of
/// quaternions, and the equations of q are projected onto the three rotations. A rigid body alone turns by Euler's
/// I ω̇ + ω×(I ω) = N (Goldstein, Poole and Safko, *Classical Mechanics*, (5.39)). What is printed then holds where the
/// constraint of q does: |q| = 1 and q·q̇ = 0.
/// The matrix of the rotation is A_q, with a line of its own where it occurs: A_q c is a vector c of the body along the fixed axes, and
/// A_qᵀ F a force F along the turned axes, so that N is c×(A_qᵀ F) if F acts at the point c. A constraint force on q is 2 q N + 2 λ q. If `A` is taken, `C` or `S` replaces it.
///
/// If an equation of a system of up to eight rigid bodies is longer than that, the equations are stated by vectors: A is the matrix of the
/// axes of a frame, ω its angular velocity along these axes, r the position of a centre of mass along the fixed axes, F = m (r̈ − g) and
/// N = I ω̇ + ω×(I ω) the force and the torque on a body, and Σ F·(∂ṙ/∂q̇) + N·(∂ω/∂q̇) is the generalized force beside inertia and uniform
/// gravity g (Kane and Levinson, *Dynamics: Theory and Applications*, pages 106 and 124). With a quaternion, a component of its ω takes the place of
/// q̇. Long generalized forces are products with derivatives of definitions and constraints: λ_c·(∂c/∂q), where the constraint c
/// is left − right. Equations of at most 60 symbols stay in coordinates.
///
/// The page's own letters give way to names of the system: with a field `E` the energy is ℰ, with `H` the Hamiltonian is ℋ, with `p_x`
/// the momenta are P. Labels and [`Excerpt::row`] keep `E`, `H` and `p_x`.
///
/// Indices count from 0, as in the program: `r[2]` is the third component of r. LaTeX and MathML print it as a subscript, and a note below the
/// Lagrangian says so.
///
/// An expression longer than 250 characters is replaced by its length. Expressions of more than 100 expanded
/// terms are printed in the form that is computed.
///
/// Every type with `#[derive(Lagrangian)]` has an associated function `equations()` that returns them. The
/// documentation of the type shows them typeset, and that of `equations` as plain text, where editors display
/// it. A method of yours needs another name: rustc rejects two functions `equations` as duplicate definitions
/// (E0592).
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
///
/// // Single parts, each as text, LaTeX and MathML.
/// assert_eq!(Pendulum::equations().hamiltonian().to_string(), "H = p_θ²/(2 m l²) − m g l cos θ");
/// let row = Pendulum::equations().motion().row("theta").expect("its equation");
/// assert_eq!(
///     row.latex().to_string(),
///     "\\begin{align}\n  l \\ddot\\theta &= -g \\sin \\theta \\label{eq:Pendulum-theta}\n\\end{align}\n"
/// );
/// // A whole LaTeX document.
/// assert!(Pendulum::equations().document().to_string().starts_with(r"\documentclass{article}"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Equations {
    forms: [[&'static str; 3]; 3],
    form: usize,
}

impl Equations {
    /// Returns the equations as Unicode text, one line per equation.
    pub const fn text(&self) -> &'static str {
        self.forms[self.form][0]
    }

    /// Returns headings, each followed by an `align` environment of the package `amsmath` with lines that fit
    /// `article`.
    ///
    /// Page breaks are allowed between any two equations. Each equation has a label:
    /// `\eqref{eq:Pendulum-theta}` refers to the equation of motion of `theta`, `eq:Pendulum-L` to the
    /// Lagrangian. [`document`](Self::document) returns a whole document; [`motion`](Self::motion) and others
    /// return parts of the page.
    pub const fn latex(&self) -> &'static str {
        self.forms[self.form][1]
    }

    /// Returns an HTML fragment with the equations in MathML, which browsers show without a script.
    ///
    /// The fragment is one `div` of the class `equations` that needs no style sheet: a heading and rows for
    /// each part. Long equations wrap to the width of the page. It is well-formed XML without empty lines, so
    /// Markdown may contain it too.
    pub const fn mathml(&self) -> &'static str {
        self.forms[self.form][2]
    }

    /// Returns the equations with every definition by its name.
    pub const fn named(self) -> Self {
        Self { form: 1, ..self }
    }

    /// Returns the equations with every definition written out, also in the Lagrangian.
    pub const fn written_out(self) -> Self {
        Self { form: 2, ..self }
    }
}

/// Creates equations from three forms (shortest, named, written out), each as text, LaTeX and HTML with MathML.
pub const fn equations(forms: [[&'static str; 3]; 3]) -> Equations {
    Equations { forms, form: 0 }
}

/// Parts of the page. A part is empty if the page lacks it.
impl Equations {
    /// Returns the Lagrangian, frames, definitions, the dissipation function and forces, as written.
    pub fn lagrangian(&self) -> Excerpt {
        self.below("Lagrangian")
    }

    /// Returns the constraints with their kinds.
    pub fn constraints(&self) -> Excerpt {
        self.below("Constraints")
    }

    /// Returns the equations of motion, one for each coordinate or vector of coordinates.
    pub fn motion(&self) -> Excerpt {
        self.below("Equations of motion")
    }

    /// Returns the generalized forces of constraint, R = Fᵀλ.
    pub fn constraint_forces(&self) -> Excerpt {
        self.below("Constraint forces")
    }

    /// Returns the conserved quantities: momenta, the energy, and those given in `#[conserved(…)]`.
    pub fn conserved(&self) -> Excerpt {
        self.below("Conserved")
    }

    /// Returns the energy function E = p·q̇ − L with its form in parentheses (see
    /// [`EnergyForm`](crate::facts::EnergyForm)). If E is not known to be conserved, its rate of change follows.
    pub fn energy(&self) -> Excerpt {
        let changing = || self.below("Energy");
        self.conserved().row("E").unwrap_or_else(changing)
    }

    /// Returns the momentum of a coordinate by the name of the coordinate, or of the vector if it is printed as
    /// one.
    ///
    /// `None` if it is not printed: the page has momenta only if they are short together, or if it has the
    /// Hamiltonian.
    pub fn momentum(&self, coordinate: &str) -> Option<Excerpt> {
        let mut rows = self.conserved().rows().chain(self.below("Momenta").rows());
        rows.find(|row| row.is_named("p_", coordinate))
    }

    /// Returns the Hamiltonian, or the reason why it is not printed.
    pub fn hamiltonian(&self) -> Excerpt {
        self.below("Hamiltonian")
    }

    /// Returns Hamilton's equations; empty if the Hamiltonian is not printed.
    pub fn canonical(&self) -> Excerpt {
        self.below("Hamilton's equations")
    }

    fn below(&self, heading: &str) -> Excerpt {
        Excerpt::below(heading, self.forms[self.form])
    }

    /// Returns a LaTeX document that contains the page, as a value to display or convert by `to_string`.
    ///
    /// The document needs the class `article` and the package `amsmath`. Large systems extend over several
    /// pages.
    pub const fn document(&self) -> impl Display + Copy + use<> {
        Document(*self)
    }

    /// Returns slides for a lecture: a LaTeX document of the class `beamer` in 16:9, as a value to display or convert by
    /// `to_string`.
    ///
    /// Each part of the page is a frame, or several if it is long; a frame ends between two equations. Notes in place of
    /// equations are left out. A single frame is `equations.motion().latex()` between `\begin{frame}` and `\end{frame}`.
    ///
    /// ```
    /// use lagrange_core::prelude::*;
    ///
    /// #[derive(Lagrangian)]
    /// #[coordinates(theta)]
    /// #[lagrangian(m/2 * l^2 * theta_dot^2 + m*g*l*cos(theta))]
    /// struct Pendulum { m: f64, l: f64, g: f64 }
    ///
    /// let slides = Pendulum::equations().slides().to_string();
    /// assert!(slides.contains(r"\begin{frame}{Equations of motion}"));
    /// assert!(slides.contains(r"l \ddot\theta &= -g \sin \theta"));
    /// ```
    pub const fn slides(&self) -> impl Display + Copy + use<> {
        Slides(*self)
    }
}

#[derive(Clone, Copy)]
struct Document(Equations);

impl Display for Document {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let name = self.0.text().lines().next().unwrap_or("");
        f.write_str("\\documentclass{article}\n\\usepackage[utf8]{inputenc}\n\\usepackage{amsmath}\n\\begin{document}\n")?;
        f.write_str("\\section*{")?;
        for (number, word) in name.split('_').enumerate() {
            f.write_str(if number == 0 { "" } else { "\\_" })?;
            f.write_str(word)?;
        }
        write!(f, "}}\n{}\\end{{document}}\n", self.0.latex())
    }
}

impl Display for Equations {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self.text())
    }
}
