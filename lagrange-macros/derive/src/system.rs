//! A derived system, for use outside of a compiler.

use std::fmt::{self, Debug, Display, Formatter};
use std::rc::Rc;

use proc_macro2::TokenStream;

use crate::codegen::{Tapes, Unsupported};
use crate::facts::{Classification, ConstraintKind, Facts};
use crate::mechanics::Derived;
use crate::refusal::Refusal;
use crate::render::Forms;
use crate::resolve::{Label, Observed, Problem};
use crate::symbolic::{Graph, Id};
use crate::syntax::Declaration;

/// A mechanical system with its equations of motion.
///
/// `Display` writes the equations as text.
///
/// ```
/// use lagrange_derive::System;
/// use lagrange_derive::facts::ConstraintKind;
///
/// let yo_yo = System::parse(
///     "#[coordinates(x, phi)]
///      #[lagrangian(m/2 * x_dot^2 + j/2 * phi_dot^2 + m*g*x)]
///      #[constraint(no_slip: x_dot - a*phi_dot = 0)]
///      #[observable(height = -x)]
///      struct YoYo { m: f64, j: f64, a: f64, g: f64 }",
/// )?;
/// assert_eq!(yo_yo.name(), "YoYo");
/// assert_eq!(yo_yo.coordinates(), ["x", "phi"]);
/// assert_eq!(yo_yo.velocities(), ["x_dot", "phi_dot"]);
/// assert_eq!(yo_yo.parameters(), ["m", "j", "a", "g"]);
/// assert_eq!(yo_yo.observables(), ["height"]);
/// let no_slip = &yo_yo.constraints()[0];
/// assert_eq!((&*no_slip.name, no_slip.kind), ("no_slip", ConstraintKind::Velocity));
/// assert_eq!(no_slip.classification.to_string(), "integrable (proved)");
/// assert_eq!(yo_yo.facts().conserved[0].name, "energy");
/// assert!(yo_yo.equations().text().contains("φ: j φ̈ = −a λ_no_slip"));
/// assert!(yo_yo.tokens().to_string().contains("impl"));
/// # Ok::<(), lagrange_derive::Refusal>(())
/// ```
#[derive(Clone)]
pub struct System {
    name: String,
    coordinates: Vec<String>,
    constraints: Vec<Constraint>,
    parameters: Vec<String>,
    functions: Vec<String>,
    observables: Vec<String>,
    facts: Facts,
    forms: Forms,
    tokens: TokenStream,
    derivation: Rc<Derivation>,
}

/// Expressions of a system, and what was derived from them.
pub(crate) struct Derivation {
    pub(crate) graph: Graph,
    pub(crate) problem: Problem,
    /// `None` if lengths of arrays are fields.
    pub(crate) derived: Option<Derived>,
}

/// A scalar constraint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Constraint {
    /// Name: `rail`, or `closed[1]` for a component of a vector constraint or an element of a family.
    pub name: String,
    /// Form as written: holonomic, or in the velocities.
    pub kind: ConstraintKind,
    /// Verdict on the integrability.
    pub classification: Classification,
}

impl System {
    /// Derives a system from the text of a struct with its attributes. `#[derive(Lagrangian)]` and attributes that Rust or serde know
    /// may be among them; other ones are errors.
    ///
    /// # Errors
    ///
    /// A [`Refusal`] with all errors found if the text is no Rust struct, or the derivation fails.
    ///
    /// ```
    /// use lagrange_derive::System;
    ///
    /// let pendulum = System::parse(
    ///     "#[derive(Lagrangian)]
    ///      #[coordinates(theta)]
    ///      #[lagrangian(m/2 * l^2 * theta_dot^2 + m*g*l*cos(theta))]
    ///      struct Pendulum { m: f64, l: f64, g: f64 }",
    /// )?;
    /// assert!(pendulum.to_string().contains("l θ̈ = −g sin θ"));
    ///
    /// let refusal = System::parse("struct Pendulum {").unwrap_err();
    /// assert_eq!(refusal.to_string(), "1:17: this is never closed\nstruct Pendulum {\n                ^");
    /// # Ok::<(), lagrange_derive::Refusal>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, Refusal> {
        let tokens = text.parse().map_err(|error| Refusal::of_text(text, &error))?;
        crate::run(tokens, true).map_err(|failure| Refusal::new(failure.errors, Some(text)))
    }

    /// Derives a system from the tokens of a struct with its attributes.
    ///
    /// # Errors
    ///
    /// As for [`parse`](Self::parse).
    ///
    /// ```
    /// use lagrange_derive::System;
    /// use quote::quote;
    ///
    /// let potential = quote!(k/2 * x^2);
    /// let oscillator = System::derive(quote! {
    ///     #[coordinates(x)]
    ///     #[lagrangian(m/2 * x_dot^2 - #potential)]
    ///     struct Oscillator { m: f64, k: f64 }
    /// })?;
    /// assert!(oscillator.to_string().contains("m ẍ = −k x"));
    /// # Ok::<(), lagrange_derive::Refusal>(())
    /// ```
    pub fn derive(tokens: TokenStream) -> Result<Self, Refusal> {
        crate::run(tokens, true).map_err(|failure| Refusal::new(failure.errors, None))
    }

    pub(crate) fn new(
        declaration: &Declaration,
        derivation: Derivation,
        facts: Facts,
        forms: Forms,
        tokens: TokenStream,
    ) -> Self {
        let problem = &derivation.problem;
        let constraints =
            derivation.derived.as_ref().map_or_else(Vec::new, |derived| constraints(problem, derived));
        let parameters = problem.parameters.by_field().into_iter().map(|k| problem.parameters.name(k));
        Self {
            name: declaration.ident.to_string().trim_start_matches("r#").to_owned(),
            coordinates: problem.coordinates.iter().map(|label| label.text.clone()).collect(),
            constraints,
            parameters: parameters.collect(),
            functions: problem.functions.iter().map(|function| function.name.clone()).collect(),
            observables: problem.observables.iter().flat_map(Observed::names).collect(),
            facts,
            forms,
            tokens,
            derivation: Rc::new(derivation),
        }
    }

    /// Returns the name of the struct.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the names of the generalized coordinates: `x`, `r[0]`, `r[1]`.
    pub fn coordinates(&self) -> &[String] {
        &self.coordinates
    }

    /// Returns the names of the generalized velocities: `x_dot`, `r_dot[0]`, `r_dot[1]`.
    pub fn velocities(&self) -> Vec<String> {
        let velocity = |name: &String| {
            let (base, index) = name.split_at(name.find('[').unwrap_or(name.len()));
            format!("{base}_dot{index}")
        };
        self.coordinates.iter().map(velocity).collect()
    }

    /// Returns the constraints, those of contacts, friction and unit quaternions included.
    pub fn constraints(&self) -> &[Constraint] {
        &self.constraints
    }

    /// Returns the names of the parameters: the numbers in fields that the expressions use, in the order of the fields.
    pub fn parameters(&self) -> &[String] {
        &self.parameters
    }

    /// Returns the names of the functions that the user supplies by `#[function(…)]`.
    pub fn functions(&self) -> &[String] {
        &self.functions
    }

    /// Returns the names of the observables, one for each number: `energy`, `tip[0]`, `tip[1]`.
    pub fn observables(&self) -> &[String] {
        &self.observables
    }

    /// Returns what was found about the system: conserved quantities, the form of the energy, and more.
    pub fn facts(&self) -> &Facts {
        &self.facts
    }

    /// Returns the equations in readable form.
    pub fn equations(&self) -> Equations<'_> {
        Equations { forms: &self.forms, form: 0 }
    }

    /// Returns the Rust code that the derive macro emits: implementations of the traits of `lagrange_core`.
    pub fn tokens(&self) -> &TokenStream {
        &self.tokens
    }

    /// Compiles the functions of the system to [`Tapes`], which are evaluated without a compiler. The crate `lagrange-interpreter` moves
    /// systems by them.
    ///
    /// # Errors
    ///
    /// [`Unsupported`] for contacts, friction, switched constraints, lengths that are fields, supplied functions, rotations in fields, and
    /// other numbers than `f64`.
    pub fn tapes(&self) -> Result<Tapes, Unsupported> {
        let Derivation { graph, problem, derived } = &*self.derivation;
        match (Unsupported::of(problem), derived) {
            (None, Some(derived)) => Ok(Tapes::of(graph, problem, derived)),
            (unsupported, _) => Err(unsupported.unwrap_or(Unsupported::OpenLength(String::new()))),
        }
    }

    pub(crate) fn into_tokens(self) -> TokenStream {
        self.tokens
    }
}

/// The constraints of a system, with what was found about each.
fn constraints(problem: &Problem, derived: &Derived) -> Vec<Constraint> {
    let kinds = derived.equations.kinds.iter().zip(&derived.equations.integrability.classes);
    let constraint = |((label, _), (&kind, &classification)): ((&Label, &Id), _)| Constraint {
        name: label.text.clone(),
        kind,
        classification,
    };
    let rows = problem.constraints.iter().map(|(label, residual)| (label, residual));
    rows.zip(kinds).map(constraint).collect()
}

impl Display for System {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Display::fmt(&self.equations(), f)
    }
}

impl Debug for System {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("System").field("name", &self.name).finish_non_exhaustive()
    }
}

/// Readable equations of a system, as text, LaTeX and MathML.
///
/// The methods have the names and the results of those of `lagrange_core::facts::Equations`, which has parts of the text too: the
/// equations of motion, say, without the rest.
///
/// ```
/// use lagrange_derive::System;
///
/// let pendulum = System::parse(
///     "#[coordinates(theta)]
///      #[define(h = l*cos(theta))]
///      #[lagrangian(m/2 * l^2 * theta_dot^2 + m*g*h)]
///      struct Pendulum { m: f64, l: f64, g: f64 }",
/// )?;
/// let equations = pendulum.equations();
/// assert!(equations.latex().contains(r"l \ddot\theta &= -g \sin \theta"));
/// assert!(equations.mathml().starts_with("<div"));
/// assert!(equations.named().text().contains("L = ½ m l² θ̇² + m g h"));
/// assert!(equations.written_out().text().contains("L = ½ m l² θ̇² + m g l cos θ"));
/// # Ok::<(), lagrange_derive::Refusal>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Equations<'a> {
    forms: &'a [[String; 3]; 3],
    form: usize,
}

impl<'a> Equations<'a> {
    /// Returns the equations as Unicode text, one line per equation.
    pub fn text(&self) -> &'a str {
        &self.forms[self.form][0]
    }

    /// Returns headings, each followed by an `align` environment of the package `amsmath`.
    pub fn latex(&self) -> &'a str {
        &self.forms[self.form][1]
    }

    /// Returns an HTML fragment with the equations in MathML.
    pub fn mathml(&self) -> &'a str {
        &self.forms[self.form][2]
    }

    /// Returns the equations with every definition by its name.
    #[must_use]
    pub fn named(self) -> Self {
        Self { form: 1, ..self }
    }

    /// Returns the equations with every definition written out, also in the Lagrangian.
    #[must_use]
    pub fn written_out(self) -> Self {
        Self { form: 2, ..self }
    }
}

impl Display for Equations<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self.text())
    }
}
