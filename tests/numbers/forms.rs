//! Which structs a system may be, and which types its fields may have.

use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[lagrangian(m/2*dot(r_dot, r_dot) + dot(b, r) + a[0][1]*r[2] - k*r[0])]
struct Borrowed<'a, 'b, T> {
    m: &'a T,
    b: &'b [T; 3],
    a: &'a [[T; 2]; 2],
    k: T,
}

#[test]
fn fields_may_be_borrowed() {
    let (m, b, a) = (2.0_f32, [1.0, 2.0, 3.0], [[0.0, 5.0], [0.0, 0.0]]);
    let system = Borrowed { m: &m, b: &b, a: &a, k: 3.0 };
    let solution = system.accelerations_unchecked(&State::at_rest([0.0; 3]));
    assert_eq!(solution.accelerations.as_slice(), [-1.0, 1.0, 4.0]);
}

/// Nothing but `m` and `k` is used; the rest may be anything.
#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2*x_dot^2 - k*x)]
struct Annotated<'a, T, F, const TAGS: usize>
where
    F: Fn(f64) -> f64,
    T: PartialOrd,
{
    m: T,
    k: T,
    name: String,
    response: F,
    log: Box<dyn Fn(&str) + Send>,
    tags: [&'a str; TAGS],
    sin: Option<(u8, char)>,
}

#[test]
fn unused_fields_and_generics_may_be_anything() {
    let system = Annotated {
        m: 2.0,
        k: 3.0,
        name: String::from("spring"),
        response: |x| 2.0 * x,
        log: Box::new(|text| assert_eq!(text, "spring")),
        tags: ["a", "b"],
        sin: Some((1, 'x')),
    };
    assert_eq!(system.accelerations_unchecked(&State::at_rest([1.0])).accelerations[0], -1.5);
    (system.log)(&system.name);
    assert_eq!(((system.response)(1.0), system.tags.len(), system.sin), (2.0, 2, Some((1, 'x'))));
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^2)]
struct Unit;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - 4*x^2/2)]
#[observable(momentum_doubled = 2*x_dot)]
struct Empty {}

#[test]
fn a_struct_may_have_no_fields() {
    let state = State::new([0.5], [1.5]);
    assert_eq!(Unit.accelerations_unchecked(&state).accelerations[0], -1.0);
    assert_eq!(Empty {}.accelerations_unchecked(&state).accelerations[0], -2.0);
    assert_eq!(Empty {}.momentum_doubled(&state), 3.0);
    assert_eq!((<Unit as Lagrangian>::NAME, Unit::COORDINATES), ("Unit", &["x"] as &[_]));
}

/// Where the type does not show the shape, the attribute says it.
#[derive(Lagrangian)]
#[coordinates(r: [2])]
#[parameter(b: [2])]
#[parameter(m: 0.1..10)]
#[lagrangian(m/2*dot(r_dot, r_dot) + dot(b, r))]
struct Declared {
    m: f64,
    b: Vec<f64>,
}

#[test]
fn the_shape_of_a_field_may_be_declared() {
    let solution = Declared { m: 2.0, b: vec![4.0, 6.0] }.accelerations_unchecked(&State::at_rest([0.0; 2]));
    assert_eq!(solution.accelerations.as_slice(), [2.0, 3.0]);
}

type Single = f32;

#[derive(Lagrangian)]
#[lagrange(crate = crate::forms::reexport::mechanics, scalar = Single)]
#[coordinates(x)]
#[lagrangian(m/2*x_dot^2 - 3/2*x^2)]
struct Aliased {
    m: Single,
}

/// Without fields only the attribute can say that the numbers are not f64.
#[derive(Lagrangian)]
#[lagrange(scalar = f32)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^2/3)]
struct UnitSingle;

mod reexport {
    pub(crate) use lagrange_core as mechanics;
}

#[test]
fn the_runtime_and_the_scalar_may_be_named() {
    let aliased = Aliased { m: 2.0 }.accelerations_unchecked(&State::at_rest([0.5_f32]));
    assert_eq!(aliased.accelerations[0], -0.75_f32);
    assert_eq!(UnitSingle.accelerations_unchecked(&State::at_rest([3.0_f32])).accelerations[0], -2.0_f32);
}
