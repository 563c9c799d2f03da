//! Second derivatives of motions of a tree of rigid bodies with 20 joints, whose inertial forces are differentiated by composite
//! bodies. Without optimization too, they fit the stack of a thread.

use lagrange_core::linearized::DiscreteTime;
use lagrange_core::nalgebra::{DVector, Matrix3};
use lagrange_core::{Scalar, StateDerivatives, prelude::*};

use crate::differences::difference;

/// A hull on four legs of three joints, with a neck that slides and turns; springs and dampers at the joints.
#[derive(Clone, Debug, Lagrangian)]
#[coordinates(r: [3], a: [3], q: [12], s: [2])]
#[parameter(inertia: symmetric)]
#[frame(hull: translate(r), rotate_z(a[0]), rotate_y(a[1]), rotate_x(a[2]))]
#[frame(hip[i in 0..4] in hull: translate(at[i]), rotate_x(q[3*i]))]
#[frame(thigh[i in 0..4] in hip[i]: rotate_y(q[3*i + 1]))]
#[frame(shank[i in 0..4] in thigh[i]: translate([0, 0, -l]), rotate_y(q[3*i + 2]))]
#[frame(neck in hull: translate([s[0], 0, l]), rotate_y(s[1]))]
#[lagrangian(
    kinetic(hull, 8*m, centre, inertia) + kinetic(neck, 2*m, centre, inertia)
    + sum(i in 0..4, kinetic(thigh[i], m, centre, inertia) + kinetic(shank[i], m/2, centre, inertia))
    - g*m*(8*position(hull, centre)[2] + 2*position(neck, centre)[2]
        + sum(i in 0..4, position(thigh[i], centre)[2] + position(shank[i], centre)[2]/2))
    - k/2*(dot(q, q) + dot(s, s))
)]
#[dissipation(c/2*(dot(q_dot, q_dot) + dot(s_dot, s_dot)))]
struct Walker<T: Scalar> {
    at: [[T; 3]; 4],
    centre: [T; 3],
    inertia: Matrix3<T>,
    m: T,
    l: T,
    g: T,
    k: T,
    c: T,
}

const N: usize = 20;

fn walker() -> Walker<f64> {
    let at = [[0.4, 0.2, 0.0], [0.4, -0.2, 0.05], [-0.4, 0.25, 0.0], [-0.35, -0.2, 0.1]];
    let inertia = Matrix3::new(0.05, 0.004, -0.003, 0.004, 0.06, 0.002, -0.003, 0.002, 0.03);
    Walker { at, centre: [0.03, -0.02, -0.15], inertia, m: 1.1, l: 0.3, g: 9.81, k: 5.0, c: 0.3 }
}

/// Numbers between −1 and 1 without a pattern.
fn irregular(k: usize) -> f64 {
    (1.0 + 12.9898 * k as f64).sin()
}

fn start() -> State<f64, N> {
    State::new(std::array::from_fn(|i| 0.7 * irregular(i)), std::array::from_fn(|i| 0.8 * irregular(N + i)))
}

/// A change of the state, of `l` and of `centre[1]`.
fn change() -> DVector<f64> {
    DVector::from_fn(2 * N + 2, |i, _| 0.3 * irregular(100 + i))
}

/// System and state after a multiple of the change.
fn changed(by: f64) -> (Walker<f64>, State<f64, N>) {
    let (mut walker, mut state, change) = (walker(), start(), by * change());
    for i in 0..N {
        state.q[i] += change[i];
        state.v[i] += change[N + i];
    }
    walker.l += change[2 * N];
    walker.centre[1] += change[2 * N + 1];
    (walker, state)
}

/// Compares a derivative along the change with differences. Truncated, they are off by 3·10⁻¹⁴ with this step, and rounded, by
/// 10⁻¹⁵ over the step.
fn check(found: &DVector<f64>, of: impl Fn(f64) -> DVector<f64>) {
    let exact = difference(1e-2, of);
    let off = (found - &exact).amax() / exact.amax();
    println!("off by {off:.1e}");
    assert!(off < 1e-12, "off by {off:e}");
}

#[test]
fn the_map_of_a_step_has_its_second_derivatives() {
    let (walker, start, h) = (walker(), start(), 0.01);
    let slopes = walker.residual_slopes(&start, &walker.solve(&start).unwrap());
    assert!(Walker::<f64>::motion_gradients(&slopes).is_some(), "no tree");
    let weight = DVector::from_fn(2 * N, |i, _| irregular(50 + i));
    let weights = [0, N].map(|first| std::array::from_fn::<f64, N, _>(|i| weight[first + i]).into());
    let new = |walker| DiscreteTime::new(walker, RungeKutta4::with_step(h), &["l", "centre[1]"]).unwrap();
    let second = new(walker).second_derivatives(&start, h, &weights).unwrap();
    assert!((&second - second.transpose()).amax() < 1e-14 * second.amax());
    check(&(second * change()), |by| {
        let (walker, state) = changed(by);
        let mut discrete = new(walker);
        discrete.advance(&state, h).unwrap();
        let gradient = [discrete.a(), discrete.b()].map(|matrix| matrix.tr_mul(&weight));
        DVector::from_iterator(2 * N + 2, gradient.iter().flatten().copied())
    });
}
