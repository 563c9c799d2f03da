//! What becomes a model, what does not, and what its motions keep.

use lagrange_core::prelude::*;
use lagrange_core::{Error, RungeKutta4};
use lagrange_derive::Arguments;

use crate::{Model, ModelError, Parameters, System};

/// A model, with each parameter of a value of its own.
fn model(text: &str) -> Model {
    let system = System::parse(text).expect("it is derived");
    let names = system.parameters().iter().enumerate();
    let parameters: Parameters = names.map(|(k, name)| (name.clone(), 1.0 + 0.1 * k as f64)).collect();
    Model::new(&system, parameters).expect("it moves")
}

fn refusal(text: &str) -> String {
    let system = System::parse(text).expect("it is derived");
    let Err(ModelError::Unsupported(unsupported)) = Model::new(&system, Parameters::default()) else {
        panic!("it is supported")
    };
    unsupported.to_string()
}

const FOUR_BAR: &str = "#[coordinates(a, b, c)]
    #[lagrangian(j/2*(a_dot^2 + b_dot^2 + 2*c_dot^2) - g*(sin(a) + sin(b) + sin(c)))]
    #[constraint(closed: [cos(a) + 2*cos(b) - 1.5*cos(c) - 1, sin(a) + 2*sin(b) - 1.5*sin(c)] = [0, 0])]
    struct FourBar { j: f64, g: f64 }";

/// A rod that is stated twice where `a` is one.
const DOUBLED_ROD: &str = "#[coordinates(x, y)]
    #[lagrangian((x_dot^2 + y_dot^2)/2 - y)]
    #[constraint(rod: x^2 + y^2 = 1)]
    #[constraint(again: a*x^2 + y^2 = 1)]
    struct DoubledRod { a: f64 }";

/// Masses that are all coupled by a function of the coordinates.
fn coupled(masses: usize) -> String {
    format!(
        "#[coordinates(x: [{masses}])]
         #[lagrangian(sum(i in 0..{masses}, 30*x_dot[i]^2 + sum(j in 0..i, cos(x[i] - x[j] + k)*x_dot[i]*x_dot[j])))]
         struct Coupled {{ k: f64 }}"
    )
}

/// Two derivations of the accelerations: the elimination, and the general solver.
#[test]
fn the_general_solver_agrees_with_the_elimination() {
    let mut bar = model(FOUR_BAR);
    let at = Arguments { q: &[1.2, 0.3, 1.5], v: &[0.3, -0.2, 0.7], ..Arguments::default() };
    let mut solutions = [(); 2].map(|()| vec![0.0; 5]);
    bar.write_solution(&at, &mut solutions[0]);
    let with = bar.correction(&at, &[0.1, -0.2]).expect("regular");
    bar.tapes.elimination = None;
    bar.write_solution(&at, &mut solutions[1]);
    for (x, y) in solutions[0].iter().zip(&solutions[1]) {
        assert!((x - y).abs() < 1e-13 * y.abs().max(1.0), "{solutions:?}");
    }
    let without = bar.correction(&at, &[0.1, -0.2]).expect("regular");
    assert!((with - without).amax() < 1e-14);
}

#[test]
fn long_eliminations_are_left_to_the_general_solver() {
    assert!(model(&coupled(5)).tapes.elimination.is_some());
    assert!(model(&coupled(24)).tapes.elimination.is_none());
}

/// Each method keeps the constraints to round-off, and the energy to its error.
#[test]
fn steps_end_on_the_constraints() -> Result<(), Error> {
    let bar = model(FOUR_BAR);
    let (start, _) = bar.project(&bar.state([1.2, 0.3, 1.5], [0.5, 0.0, 0.0]))?;
    let check = |name: &str, end: &crate::model::State, loss: f64| {
        let [residual, rate] = bar.residuals(end).expect("finite");
        let largest = residual.iter().chain(&rate).fold(0.0, |largest: f64, x| largest.max(x.abs()));
        assert!(largest < 4e-15, "{name}: {residual:?}, {rate:?}");
        let lost = (bar.energy(end) - bar.energy(&start)).abs();
        assert!(lost < loss, "{name} loses {lost:e}");
    };
    check("Dop853", bar.integrate(start.clone(), 20.0, Dop853::default())?.end().state(), 1e-6);
    check("Dopri5", bar.integrate(start.clone(), 20.0, Dopri5::default())?.end().state(), 1e-5);
    check(
        "RungeKutta4",
        bar.integrate(start.clone(), 20.0, RungeKutta4::with_step(1e-3))?.end().state(),
        1e-8,
    );
    Ok(())
}

/// cos t has its first zero at π/2, and a pendulum on a rod passes its lowest point when the one in an angle does.
#[test]
fn events_are_located() -> Result<(), Error> {
    let spring = model("#[coordinates(x)] #[lagrangian(x_dot^2/2 - x^2/2)] struct Spring;");
    let bob = model(
        "#[coordinates(x, y)]
         #[lagrangian((x_dot^2 + y_dot^2)/2 - y)]
         #[constraint(rod: x^2 + y^2 = 1)]
         struct Bob;",
    );
    let angle = model("#[coordinates(theta)] #[lagrangian(theta_dot^2/2 + cos(theta))] struct Angle;");
    let first = |model: &Model, start: [f64; 2]| {
        let mut lowest = model.event("lowest", |sample| sample.state().q[0]).terminal();
        let start = model.at_rest(start.into_iter().take(model.coordinates().len()));
        let path = model.motion(start).by(Dop853::with_tolerance(1e-12)).event(&mut lowest).towards(10.0)?;
        Ok::<_, Error>(path.end().state().t)
    };
    assert!((first(&spring, [1.0, 0.0])? - std::f64::consts::FRAC_PI_2).abs() < 1e-11);
    let [x, y] = [1.0_f64.sin(), -1.0_f64.cos()];
    assert!((first(&bob, [x, y])? - first(&angle, [1.0, 0.0])?).abs() < 1e-10);
    Ok(())
}

#[test]
fn dependent_constraints_are_named() {
    let system = System::parse(DOUBLED_ROD).expect("it is derived");
    let doubled = Model::new(&system, [("a", 1.0)]).expect("it moves");
    let error =
        doubled.integrate(doubled.at_rest([0.6, -0.8]), 1.0, Dop853::default()).map(|_| ()).unwrap_err();
    assert!(error.to_string().contains("`again`"), "{error}");
}

#[test]
fn what_has_no_tape_is_refused_by_name() {
    let refused = [
        (
            "#[contact(floor: x >= 0, restitution: e)] struct S { e: f64, floor: Contact }",
            "`floor` opens and closes",
        ),
        ("#[constraint(held: x = 0, when: on)] struct S { on: bool }", "`on` opens and closes"),
        ("#[friction(f: x_dot, limit: 1, sliding: 1)] struct S { f: Friction }", "`f` opens and closes"),
        ("#[function(U(x) = field)] #[force(x: U(x))] struct S<F> { field: F }", "`U` is a function"),
        ("#[force(x: k)] struct S { k: f32 }", "of the type `f32`"),
        ("#[force(x: k)] struct S<T> { k: T }", "of the type `T`"),
        (
            "#[parameter(R: rotation)] #[force(x: R[0][1])] struct S { R: [[f64; 3]; 3] }",
            "`R` has to be a rotation",
        ),
    ];
    for (rest, reason) in refused {
        let found = refusal(&format!("#[coordinates(x)] #[lagrangian(x_dot^2/2)] {rest}"));
        assert!(found.contains(reason), "{found}");
    }
    let found =
        refusal("#[coordinates(x: [n])] #[lagrangian(sum(i in 0..n, x_dot[i]^2/2))] struct S { n: usize }");
    assert!(found.contains("the length `n` is known only"), "{found}");
}

#[test]
fn parameters_are_checked_by_name() {
    let system = System::parse(
        "#[coordinates(x: [2])]
         #[parameter(M: symmetric)]
         #[lagrangian(sum(i in 0..2, sum(j in 0..2, M[i][j]*x_dot[i]*x_dot[j]/2)) - k*dot(x, x))]
         struct Coupled { M: [[f64; 2]; 2], k: f64, unused: f64 }",
    )
    .expect("it is derived");
    let errors = |parameters: Parameters| Model::new(&system, parameters).unwrap_err().to_string();
    let with_k = || Parameters::default().with("k", 1.0);
    assert_eq!(
        errors(with_k().with("M", [[2.0, 1.0], [0.5, 2.0]])),
        "the matrix `M` is declared symmetric, and is not"
    );
    assert_eq!(errors(with_k().with("M", [2.0, 1.0])), "the field `M` has 4 entries, not 2");
    assert_eq!(
        errors(with_k().with("M", [[2.0, 1.0], [1.0, 2.0]]).with("M[0][0]", 1.0)),
        "the parameter `M[0][0]` has two values"
    );
    assert!(errors(with_k()).contains("the parameter `M[0][1]` has no value"));
    let unused = errors(with_k().with("M", [[2.0, 1.0], [1.0, 2.0]]).with("unused", 1.0));
    assert_eq!(unused, "the equations contain no parameter `unused`");
    let mut model = Model::new(&system, with_k().with("M", [[2.0, 1.0], [1.0, 2.0]])).expect("it moves");
    assert_eq!(
        model.set("K", 2.0).unwrap_err().to_string(),
        "the equations contain no parameter `K`: did you mean `k`?"
    );
    model.set("k", 3.0).expect("known");
    assert_eq!(model.parameters().last(), Some(("k", 3.0)));
}
