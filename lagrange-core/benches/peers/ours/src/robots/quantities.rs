//! What else is asked of an arm than its accelerations, behind the same signature: matrices are left in `a` by columns.

use lagrange_core::{
    Direction, StateDerivatives,
    nalgebra::{Matrix3, Rotation3, SMatrix, SVector, Vector3},
    number::FourLanes,
    prelude::*,
};

/// The arm, a point of its last link held at a place: what that takes is the Jacobian of the point.
#[derive(Lagrangian)]
#[coordinates(q: [6])]
#[parameter(inertia: symmetric)]
#[frame(link[0]: translate(at[0]), rotate(place[0]), rotate_z(q[0]))]
#[frame(link[i in 1..6] in link[i-1]: translate(at[i]), rotate(place[i]), rotate_z(q[i]))]
#[lagrangian(sum(i in 0..6, kinetic(link[i], m[i], centre[i], inertia[i]) - m[i]*g*position(link[i], centre[i])[2]))]
#[constraint(held: position(link[5], point) = target)]
#[force(q: tau)]
#[repr(C)]
pub struct Held6 {
    place: [Rotation3<f64>; 6],
    at: [Vector3<f64>; 6],
    centre: [Vector3<f64>; 6],
    inertia: [Matrix3<f64>; 6],
    m: [f64; 6],
    g: f64,
    tau: [f64; 6],
    point: Vector3<f64>,
    target: Vector3<f64>,
}

type Columns = SMatrix<f64, 6, 6>;

/// The forces at the joints for the accelerations that stand after q̇.
///
/// # Safety
/// `q`, `v`, `p` and `a` are as the harness has them for this system, and so for the others.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arm_inverse_6(
    q: *const [f64; 6],
    v: *const [f64; 6],
    p: *const super::Arm6,
    a: *mut SVector<f64, 6>,
    _: *mut f64,
) {
    unsafe {
        let (state, accelerations) = (State::new(*q, *v), *q.add(2));
        *a = (*p).inverse_dynamics(&state, &accelerations.into(), &SVector::zeros());
    }
}

/// # Safety
/// See `arm_inverse_6`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arm_mass_6(
    q: *const [f64; 6],
    v: *const [f64; 6],
    p: *const super::Arm6,
    a: *mut Columns,
    _: *mut f64,
) {
    unsafe { *a = (*p).mass_matrix(&State::new(*q, *v)) }
}

/// # Safety
/// See `arm_inverse_6`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arm_jacobian_6(
    q: *const [f64; 6],
    v: *const [f64; 6],
    p: *const Held6,
    a: *mut SMatrix<f64, 3, 6>,
    _: *mut f64,
) {
    unsafe { *a = (*p).constraint_jacobian(&State::new(*q, *v)) }
}

/// The derivatives of the accelerations by q, q̇ and the forces at the joints.
///
/// # Safety
/// See `arm_inverse_6`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arm_derivatives_6(
    q: *const [f64; 6],
    v: *const [f64; 6],
    p: *const super::Arm6,
    a: *mut [Columns; 3],
    _: *mut f64,
) {
    unsafe {
        let (state, arm) = (State::new(*q, *v), &*p);
        let solution = arm.accelerations_unchecked(&state);
        let (factor, slopes) = (arm.factor(&state), arm.residual_slopes(&state, &solution));
        for block in (0..18).step_by(FourLanes::COUNT) {
            let lanes = block..(block + FourLanes::COUNT).min(18);
            let one_at = |k: usize| -> FourLanes {
                FourLanes::from(core::array::from_fn(|lane| f64::from(u8::from(block + lane == k))))
            };
            let unit = |first: usize| SVector::<FourLanes, 6>::from_fn(|i, _| one_at(first + i));
            let direction = Direction { t: FourLanes::constant(0.0), q: unit(0), v: unit(6) };
            let change = arm.residual_change_with(&slopes, &direction);
            let forces = unit(12).zip_map(&change.motion, |force, motion| force - motion);
            let response = arm.solve_with(&factor, &forces, &change.acceleration).accelerations;
            for (lane, k) in lanes.enumerate() {
                (&mut *a)[k / 6].set_column(k % 6, &response.map(|x| x.to_array()[lane]));
            }
        }
    }
}

/// The same by the function that checks what it gives; it differentiates by the time, too.
///
/// # Safety
/// See `arm_inverse_6`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn arm_derivatives_checked_6(
    q: *const [f64; 6],
    v: *const [f64; 6],
    p: *const super::Arm6,
    a: *mut [Columns; 3],
    _: *mut f64,
) {
    unsafe {
        let (state, arm, a) = (State::new(*q, *v), &*p, &mut *a);
        let Ok(jacobian) = arm.state_jacobian(&state) else { return };
        (a[0], a[1]) = (jacobian.accelerations.q, jacobian.accelerations.v);
        let factor = arm.factor(&state);
        for k in 0..6 {
            let unit = SVector::from_fn(|i, _| f64::from(u8::from(i == k)));
            a[2].set_column(k, &arm.solve_with(&factor, &unit, &SVector::zeros()).accelerations);
        }
    }
}
