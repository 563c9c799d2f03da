use lagrange_core::nalgebra::{Isometry3, Vector3};
use lagrange_core::prelude::*;

struct Base {
    m: f64,
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[parameter(k: {m})]
#[parameter(c: {m})]
#[parameter(base: [3] {m})]
#[parameter(bases: {m})]
#[parameter(more: [3] {m})]
#[parameter(place: {translation: [3]})]
#[parameter(basis: {m})]
#[parameter(twice: {m})]
#[parameter(twice: {m})]
#[parameter(said: {m})]
#[parameter(said: symmetric)]
#[parameter(set: {m})]
#[parameter(set: [3])]
#[lagrangian(x_dot^2/2)]
struct Declared {
    k: f64,
    c: Vector3<f64>,
    base: Base,
    bases: [Base; 2],
    more: [Base; 2],
    place: Isometry3<f64>,
    twice: Base,
    said: Base,
    set: Base,
}

fn main() {}
