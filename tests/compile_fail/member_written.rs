use lagrange_core::prelude::*;

struct Base {
    m: f64,
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[parameter(a: {})]
#[parameter(b: {m, m})]
#[parameter(c: {m c})]
#[parameter(d: {m: 3})]
#[parameter(e: {m: symetric})]
#[parameter(f: {m: [3, 3, 3]})]
#[parameter(g: {m: [n]})]
#[parameter(h: {0})]
#[parameter(j: {m: f64})]
#[parameter(k: {m: 0..1})]
#[parameter(l: {tip: {m, m}})]
#[lagrangian(x_dot^2/2)]
struct Written {
    a: Base,
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[parameter(a: {m})]
#[lagrangian(a.m*x_dot^2/2)]
#[force(x: (2*x).m)]
#[force(x: a.m())]
#[force(x: a.0)]
#[force(x: a.)]
#[force(x: self.a.m)]
#[force(x: a.m.)]
struct Called {
    a: Base,
}

fn main() {}
