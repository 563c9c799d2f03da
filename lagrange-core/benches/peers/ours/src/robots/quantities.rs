//! What else is asked of bodies in space than their accelerations, behind the same signature: matrices are left in `a` by
//! columns, one after another.

use core::{array::from_fn, ops::Range};

use lagrange_core::{
    StateDerivatives,
    nalgebra::{Const, Matrix3, Rotation3, SMatrix, SVector, Vector3},
    number::FourLanes as Block,
    prelude::*,
};

use super::{Arm6, Humanoid, Quadruped};

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

/// # Safety
/// `q`, `v`, `p` and `a` are as the harness has them for this system, and so for the others.
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

/// The forces for the accelerations that stand after q̇.
///
/// # Safety
/// See `arm_jacobian_6`.
#[inline(always)]
unsafe fn inverse<L, const N: usize, const M: usize>(q: *const f64, v: *const f64, p: *const f64, a: *mut f64)
where
    L: Lagrangian<N = Const<N>, M = Const<M>, Scalar = f64>,
{
    unsafe {
        let state = State::new(*q.cast::<[f64; N]>(), *v.cast::<[f64; N]>());
        let accelerations = SVector::from(*v.cast::<[f64; N]>().add(1));
        *a.cast() = (*p.cast::<L>()).inverse_dynamics(&state, &accelerations, &SVector::zeros());
    }
}

/// # Safety
/// See `arm_jacobian_6`.
#[inline(always)]
unsafe fn mass<L, const N: usize, const M: usize>(q: *const f64, v: *const f64, p: *const f64, a: *mut f64)
where
    L: Lagrangian<N = Const<N>, M = Const<M>, Scalar = f64>,
{
    unsafe {
        let state = State::new(*q.cast::<[f64; N]>(), *v.cast::<[f64; N]>());
        *a.cast() = (*p.cast::<L>()).mass_matrix(&state);
    }
}

/// The derivatives of the accelerations by q, q̇ and the forces at the last J coordinates, then the accelerations.
///
/// # Safety
/// See `arm_jacobian_6`.
#[inline(always)]
unsafe fn derivatives<L, const N: usize, const M: usize, const J: usize>(
    q: *const f64,
    v: *const f64,
    p: *const f64,
    a: *mut f64,
) where
    L: StateDerivatives<N = Const<N>, M = Const<M>, Scalar = f64>,
{
    unsafe {
        let (state, system) = (State::new(*q.cast::<[f64; N]>(), *v.cast::<[f64; N]>()), &*p.cast::<L>());
        let columns = a.cast::<SVector<f64, N>>();
        let solution = system.accelerations_unchecked(&state);
        let (factor, slopes) = (system.factor(&state), system.residual_slopes(&state, &solution));
        // The place of a free base changes nothing.
        let arguments = L::STATE_ARGUMENTS.expect("the derive knows them");
        let mut left = arguments.iter().peekable();
        for k in 1..=2 * N {
            if left.next_if_eq(&&k).is_none() {
                *columns.add(k - 1) = SVector::zeros();
            }
        }
        for block in arguments.chunks(Block::COUNT) {
            let change = system.residual_change_by::<Block>(&slopes, block.iter().copied());
            let response = system.solve_with(&factor, &-change.motion, &change.acceleration);
            for (lane, k) in block.iter().enumerate() {
                *columns.add(k - 1) = response.accelerations.map(|x| x.to_array()[lane]);
            }
        }
        for block in blocks(J) {
            let forces = units(&(block.start + N - J..block.end + N - J), 0);
            let response = system.solve_with(&factor, &forces, &SVector::from_element(Block::constant(0.0)));
            leave(&response.accelerations, block, columns.add(2 * N));
        }
        *columns.add(2 * N + J) = solution.accelerations;
    }
}

/// As many columns at once as there are lanes.
fn blocks(count: usize) -> impl Iterator<Item = Range<usize>> {
    (0..count).step_by(Block::COUNT).map(move |first| first..count.min(first + Block::COUNT))
}

/// In each lane the unit vector of a number of the block; the first entry is `first`.
#[inline(always)]
fn units<const N: usize>(block: &Range<usize>, first: usize) -> SVector<Block, N> {
    SVector::from_fn(|i, _| Block::from(from_fn(|lane| f64::from(u8::from(block.start + lane == first + i)))))
}

/// # Safety
/// There is room for the columns of the block.
#[inline(always)]
unsafe fn leave<const N: usize>(
    response: &SVector<Block, N>,
    block: Range<usize>,
    columns: *mut SVector<f64, N>,
) {
    for (lane, k) in block.enumerate() {
        unsafe { *columns.add(k) = response.map(|x| x.to_array()[lane]) }
    }
}

/// The same by the function that checks what it gives.
///
/// # Safety
/// See `arm_jacobian_6`.
#[inline(always)]
unsafe fn checked<L, const N: usize, const M: usize, const J: usize>(
    q: *const f64,
    v: *const f64,
    p: *const f64,
    a: *mut f64,
) where
    L: StateDerivatives<N = Const<N>, M = Const<M>, Scalar = f64>,
{
    unsafe {
        let (state, system) = (State::new(*q.cast::<[f64; N]>(), *v.cast::<[f64; N]>()), &*p.cast::<L>());
        let columns = a.cast::<SVector<f64, N>>();
        let Ok(jacobian) = system.state_jacobian(&state) else { return };
        *columns.cast() = [jacobian.accelerations.q, jacobian.accelerations.v];
        let factor = system.factor(&state);
        for k in 0..J {
            let unit = SVector::from_fn(|i, _| f64::from(u8::from(i == N - J + k)));
            *columns.add(2 * N + k) = system.solve_with(&factor, &unit, &SVector::zeros()).accelerations;
        }
        *columns.add(2 * N + J) = jacobian.solution.accelerations;
    }
}

macro_rules! export {
    ($($name:ident = $function:ident<$($of:tt),*>;)*) => {
        $(
            /// # Safety
            /// See `arm_jacobian_6`.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $name(
                q: *const f64,
                v: *const f64,
                p: *const f64,
                a: *mut f64,
                _: *mut f64,
            ) {
                unsafe { $function::<$($of),*>(q, v, p, a) }
            }
        )*
    };
}

export! {
    arm_inverse_6 = inverse<Arm6, 6, 0>;
    arm_mass_6 = mass<Arm6, 6, 0>;
    arm_derivatives_6 = derivatives<Arm6, 6, 0, 6>;
    arm_derivatives_checked_6 = checked<Arm6, 6, 0, 6>;
    quadruped_inverse_0 = inverse<Quadruped, 19, 1>;
    quadruped_mass_0 = mass<Quadruped, 19, 1>;
    quadruped_derivatives_0 = derivatives<Quadruped, 19, 1, 12>;
    quadruped_derivatives_checked_0 = checked<Quadruped, 19, 1, 12>;
    humanoid_inverse_0 = inverse<Humanoid, 37, 1>;
    humanoid_mass_0 = mass<Humanoid, 37, 1>;
    humanoid_derivatives_0 = derivatives<Humanoid, 37, 1, 30>;
    humanoid_derivatives_checked_0 = checked<Humanoid, 37, 1, 30>;
}
