use lagrange_core::prelude::*;

struct Link {
    m: f64,
    c: [f64; 3],
    inertia: [[f64; 3]; 3],
    name: String,
    single: f32,
    tip: Tip,
}

struct Tip {
    m: f64,
}

// What the members that are declared are not.
#[derive(Lagrangian)]
#[coordinates(x)]
#[parameter(link: [2] {
    m: [3],
    mass,
    c: [2],
    inertia,
    name,
    single,
    tip: {m: symmetric, mass},
})]
#[lagrangian(x_dot^2/2 - link[0].m[0]*x)]
struct Wrong {
    link: [Link; 2],
}

mod elsewhere {
    pub struct Base {
        m: f64,
        pub g: f64,
    }
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[parameter(base: {m, g})]
#[lagrangian(base.m*x_dot^2/2 - base.g*x)]
struct Private {
    base: elsewhere::Base,
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[parameter(links: [2] {m})]
#[lagrangian(links[1].m*x_dot^2/2)]
struct NotSeveral {
    links: Link,
}

fn main() {}
