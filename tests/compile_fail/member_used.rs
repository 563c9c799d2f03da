use lagrange_core::nalgebra::Isometry3;
use lagrange_core::prelude::*;

struct Base {
    m: f64,
    mass: f64,
    tip: Tip,
}

struct Tip {
    m: f64,
}

#[derive(Lagrangian)]
#[coordinates(x, r: [3])]
#[parameter(link: [3] {mass, c: [3], tip: {m}})]
#[parameter(base: {mass, tip: {m}})]
#[define(twice(y) = 2*y.mass)]
#[define(total = link[0].mass + link[1].mass)]
#[frame(body: translate(r))]
#[lagrangian(x_dot^2/2 + dot(r_dot, r_dot)/2)]
#[force(x: link*x)]
#[force(x: link[0]*x)]
#[force(x: base)]
#[force(x: base.tip)]
#[force(x: link.mass)]
#[force(x: link[0].mas)]
#[force(x: base.colour)]
#[force(x: link[3].mass)]
#[force(x: link[0][1].mass)]
#[force(x: base[0].mass)]
#[force(x: link[0].mass[1])]
#[force(x: link[0].c[3])]
#[force(x: link[0].c)]
#[force(x: link[0].mass.x)]
#[force(x: link[0].tip.g)]
#[force(x: k.x)]
#[force(x: r.x)]
#[force(x: total.m)]
#[force(x: body.m)]
#[force(x: nothing.m)]
#[force(x: twice(base))]
#[force(x: other.m)]
#[force(x: others[0].m)]
#[force(x: boxed[0].m)]
#[force(x: other)]
#[force(x: place.origin[0])]
#[force(r: place*r)]
struct Used {
    link: [Base; 3],
    base: Base,
    k: f64,
    other: Base,
    others: [Base; 2],
    boxed: Vec<Base>,
    place: Isometry3<f64>,
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[parameter(base: {mass})]
#[frame(a: pose(1))]
#[frame(b: pose(base))]
#[frame(c: pose(places))]
#[frame(d: pose(place, place))]
#[frame(e: rotate(place))]
#[frame(f: translate(place))]
#[frame(g: pose(place.rotation))]
#[lagrangian(x_dot^2/2)]
struct Placed {
    base: Base,
    place: Isometry3<f64>,
    places: [Isometry3<f64>; 2],
}

fn main() {}
