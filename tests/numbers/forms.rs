//! Which structs a system may be, and which types its fields may have.

use lagrange_core::nalgebra::{Matrix2, SMatrix, SVector, Vector3};
use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[lagrangian(m/2*dot(r_dot, r_dot) + dot(b, r) + a[0][1]*r[2])]
struct Borrowed<'a, 'b> {
    m: &'a f64,
    b: &'b [f64; 3],
    a: &'a [[f64; 2]; 2],
}

#[test]
fn fields_may_be_borrowed() {
    let (m, b, a) = (2.0, [1.0, 2.0, 3.0], [[0.0, 5.0], [0.0, 0.0]]);
    let system = Borrowed { m: &m, b: &b, a: &a };
    let solution = system.accelerations_unchecked(&State::at_rest([0.0; 3]));
    assert_eq!(solution.accelerations.as_slice(), [0.5, 1.0, 4.0]);
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2*x_dot^2 - k/2*x^2)]
struct Borrowing<'a, T> {
    m: &'a T,
    k: T,
}

#[test]
fn generic_fields_may_be_borrowed() {
    let m = 2.0_f32;
    let solution = Borrowing { m: &m, k: 3.0 }.accelerations_unchecked(&State::at_rest([0.5_f32]));
    assert_eq!(solution.accelerations[0], -0.75_f32);
}

/// Nothing but `m` and `k` is used; the rest may be anything.
#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2*x_dot^2 - k/2*x^2)]
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
#[lagrangian(x_dot^2/2 - x^2/2)]
struct Unit;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - 4*x^2/2)]
#[observable(momentum_doubled = 2*x_dot)]
struct Empty {}

#[test]
fn a_struct_may_have_no_fields() {
    let state = State::new([0.5], [1.5]);
    assert_eq!(Unit.accelerations_unchecked(&state).accelerations[0], -0.5);
    assert_eq!(Empty {}.accelerations_unchecked(&state).accelerations[0], -2.0);
    assert_eq!(Empty {}.momentum_doubled(&state), 3.0);
    assert_eq!((<Unit as Lagrangian>::NAME, Unit::COORDINATES), ("Unit", &["x"] as &[_]));
}

#[derive(Lagrangian)]
#[coordinates(r: [2])]
#[lagrangian(
    b[2]/2*dot(r_dot, r_dot) + a[1][2]*r[0] + rows[1][0]*r[1] + dot(w, square*r) + dot(a*b, r) + w[1]
)]
struct Shaped {
    b: Vector3<f64>,
    w: SVector<f64, 2>,
    a: SMatrix<f64, 2, 3>,
    rows: [[f64; 3]; 2],
    square: Matrix2<f64>,
}

#[test]
fn vectors_and_matrices_are_read_by_row_and_column() {
    let system = Shaped {
        b: [1.0, 0.0, 2.0].into(),
        w: [7.0, 11.0].into(),
        a: SMatrix::from_row_slice(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
        rows: [[0.0, 0.0, 0.0], [13.0, 0.0, 0.0]],
        square: Matrix2::new(1.0, 2.0, 3.0, 4.0),
    };
    let state = State::at_rest([0.0, 0.0]);
    // h = (a₁₂, rows₁₀) + squareᵀ w + a b
    let expected = [6.0 + (7.0 + 33.0) + 7.0, 13.0 + (14.0 + 44.0) + 16.0];
    assert_eq!(system.forcing(&state).as_slice(), expected);
    assert_eq!(system.mass_matrix(&state), Matrix2::new(2.0, 0.0, 0.0, 2.0));
    assert_eq!(system.lagrangian(&state), 11.0);
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

type Length = f64;
type Single = f32;

#[derive(Lagrangian)]
#[lagrange(crate = crate::forms::reexport::mechanics, scalar = Length)]
#[coordinates(x)]
#[lagrangian(m/2*x_dot^2 - 3/2*x^2)]
struct Aliased {
    m: Length,
}

#[derive(Lagrangian)]
#[lagrange(scalar = Single)]
#[coordinates(x)]
#[lagrangian(m/2*x_dot^2 - 3/2*x^2)]
struct AliasedSingle {
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
    let double = Aliased { m: 2.0 }.accelerations_unchecked(&State::at_rest([0.5_f64]));
    let single = AliasedSingle { m: 2.0 }.accelerations_unchecked(&State::at_rest([0.5_f32]));
    assert_eq!((double.accelerations[0], single.accelerations[0]), (-0.75_f64, -0.75_f32));
    assert_eq!(UnitSingle.accelerations_unchecked(&State::at_rest([3.0_f32])).accelerations[0], -2.0_f32);
}
