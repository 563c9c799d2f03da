use std::string::{String, ToString};

use crate::prelude::*;
use crate::solution::Sample;

/// A particle on a sphere and a bead on a wire, with names of every kind.
#[derive(Clone, Lagrangian)]
#[coordinates(theta, phi, r: [2])]
#[lagrangian(m/2*(theta_dot^2 + sin(theta)^2*phi_dot^2 + dot(r_dot, r_dot)) + m*g*cos(theta))]
#[constraint(wire: r[0] = r[1])]
#[observable(height = cos(theta))]
#[conserved(action = m*sin(theta)^2*phi_dot)]
struct Named {
    m: f64,
    g: f64,
}

const NAMED: Named = Named { m: 1.0, g: 9.81 };

fn start() -> State<f64, 4> {
    NAMED.state_from(&[("theta", 1.0), ("phi_dot", 2.0), ("r_dot[1]", 3.0), ("r_dot[0]", 3.0)]).unwrap()
}

/// Returns the error message of a query for a wrong name.
fn said(ask: impl Fn(&Sample<&Named>) -> Result<f64, Error>) -> String {
    let path = NAMED.integrate(start(), 0.0, Dop853::default()).unwrap();
    ask(&path.end()).unwrap_err().to_string()
}

#[test]
fn a_name_asked_for_in_the_wrong_place_is_answered_with_the_right_one() {
    let of = |kind: &str, name: &str, meaning: &str, method: &str| {
        std::format!("there is no {kind} `{name}`: it is {meaning}, which a sample's `{method}` gives")
    };
    let velocity = of("coordinate", "phi_dot", "the velocity of `phi`", "velocity(\"phi\")");
    assert_eq!(said(|s| s.coordinate("phi_dot")), velocity);
    assert_eq!(said(|s| s.velocity("phi_dot")), velocity);
    let acceleration = of("coordinate", "phi_ddot", "the acceleration of `phi`", "acceleration(\"phi\")");
    assert_eq!(said(|s| s.acceleration("phi_ddot")), acceleration);
    for name in ["p_theta", "p(theta)"] {
        let momentum = |kind: &str| of(kind, name, "the momentum of `theta`", "momentum(\"theta\")");
        assert_eq!(said(|s| s.momentum(name)), momentum("coordinate"));
        assert_eq!(said(|s| s.conserved(name)), momentum("conserved quantity"));
    }
    let multiplier = "the multiplier of constraint `wire`";
    let multiplier = of("coordinate", "lambda(wire)", multiplier, "multiplier(\"wire\")");
    assert_eq!(said(|s| s.coordinate("lambda(wire)")), multiplier);
    let constraint = of("observable", "wire", "a constraint", "multiplier(\"wire\")");
    assert_eq!(said(|s| s.observable("wire")), constraint);
    let coordinate = of("constraint", "phi", "a coordinate", "coordinate(\"phi\")");
    assert_eq!(said(|s| s.multiplier("phi")), coordinate);
    let observable = of("coordinate", "height", "an observable", "observable(\"height\")");
    assert_eq!(said(|s| s.coordinate("height")), observable);
    let observable = of("conserved quantity", "height", "an observable", "observable(\"height\")");
    assert_eq!(said(|s| s.conserved("height")), observable);
    let energy = of("conserved quantity", "E", "the energy", "energy()");
    assert_eq!(said(|s| s.conserved("E")), energy);
    let time = of("observable", "t", "the time", "time()") + " and a state's `at_time(…)` sets";
    assert_eq!(said(|s| s.observable("t")), time);
}

#[test]
fn every_method_that_is_named_gives_what_is_said() {
    let path = NAMED.integrate(start(), 0.0, Dop853::default()).unwrap();
    let end = path.end();
    assert_eq!(end.velocity("phi"), Ok(2.0));
    assert_eq!(end.momentum("phi"), end.conserved("p_phi"));
    assert!((end.conserved("action").unwrap() - 2.0 * 1.0_f64.sin().powi(2)).abs() < 1e-15);
    assert_eq!(Ok(end.energy()), end.conserved("energy"));
    assert!(end.multiplier("wire").is_ok() && end.acceleration("phi").is_ok());
}

#[test]
fn a_vector_asks_for_an_index() {
    let expected = "there is no coordinate `r`: it is a vector: name an element, such as `r[0]`";
    assert_eq!(said(|s| s.momentum("r")), expected);
    let element =
        "its element `r_dot[0]` is the velocity of `r[0]`, which a sample's `velocity(\"r[0]\")` gives";
    assert_eq!(said(|s| s.velocity("r_dot")), std::format!("there is no coordinate `r_dot`: {element}"));
    let error = NAMED.state_from(&[("r_dot", 1.0)]).unwrap_err().to_string();
    let expected =
        "there is no coordinate or velocity `r_dot`: it is a vector: name an element, such as `r_dot[0]`";
    assert_eq!(error, expected);
}

#[test]
fn a_name_that_is_nearly_right_is_suggested() {
    assert_eq!(said(|s| s.coordinate("tetha")), "there is no coordinate `tetha`: did you mean `theta`?");
    assert_eq!(said(|s| s.coordinate("Phi")), "there is no coordinate `Phi`: did you mean `phi`?");
    assert_eq!(said(|s| s.coordinate("r[7]")), "there is no coordinate `r[7]`: did you mean `r[0]`?");
    let error = NAMED.state_from(&[("theta_dto", 1.0)]).unwrap_err().to_string();
    assert_eq!(error, "there is no coordinate or velocity `theta_dto`: did you mean `theta_dot`?");
    let error = NAMED.linearize(&start(), &["theta"]).unwrap_err().to_string();
    let advice = "a parameter is a field, such as the force `u` of `#[force(theta: u)]`";
    assert_eq!(error, std::format!("there is no parameter `theta`: it is a coordinate; {advice}"));
    let error = NAMED.linearize(&start(), &["theta_dot"]).unwrap_err().to_string();
    assert!(error.ends_with(&std::format!("it is the velocity of `theta`; {advice}")), "{error}");
    let error = NAMED.equilibrium(&start(), &["thta"]).unwrap_err();
    assert!(error.to_string().ends_with("`thta`: did you mean `theta`?"), "{error}");
    // A name that is not similar to any gets the list of names.
    let expected = "there is no coordinate `length`; there are `theta`, `phi`, `r[0]`, `r[1]`";
    assert_eq!(said(|s| s.coordinate("length")), expected);
    let error = NAMED.state_from(&[("radius", 1.0)]).unwrap_err().to_string();
    assert_eq!(
        error,
        "there is no coordinate or velocity `radius`; there are `phi`, `r[0]`, `r[1]` and 5 more"
    );
    let error = said(|s| s.coordinate(""));
    assert!(error.starts_with("there is no coordinate ``; there are"), "{error}");
}
