//! A body on two legs, with arms.

use lagrange_core::{
    nalgebra::{Matrix3, Vector3},
    prelude::*,
};

/// Two legs of six joints, two arms of seven, waist and neck of two, on a pelvis that is free in space.
#[derive(Lagrangian)]
#[coordinates(r: [3], turn: [4], q: [30])]
#[parameter(inertia: symmetric)]
#[frame(pelvis: translate(r), rotate(turn))]
#[frame(hip[s in 0..2] in pelvis: translate(at[6*s]), rotate_z(q[6*s]))]
#[frame(hip_roll[s in 0..2] in hip[s]: translate(at[6*s+1]), rotate_x(q[6*s+1]))]
#[frame(thigh[s in 0..2] in hip_roll[s]: translate(at[6*s+2]), rotate_y(q[6*s+2]))]
#[frame(shank[s in 0..2] in thigh[s]: translate(at[6*s+3]), rotate_y(q[6*s+3]))]
#[frame(ankle[s in 0..2] in shank[s]: translate(at[6*s+4]), rotate_y(q[6*s+4]))]
#[frame(foot[s in 0..2] in ankle[s]: translate(at[6*s+5]), rotate_x(q[6*s+5]))]
#[frame(waist in pelvis: translate(at[12]), rotate_z(q[12]))]
#[frame(chest in waist: translate(at[13]), rotate_y(q[13]))]
#[frame(neck in chest: translate(at[14]), rotate_z(q[14]))]
#[frame(head in neck: translate(at[15]), rotate_y(q[15]))]
#[frame(shoulder[s in 0..2] in chest: translate(at[7*s+16]), rotate_y(q[7*s+16]))]
#[frame(shoulder_roll[s in 0..2] in shoulder[s]: translate(at[7*s+17]), rotate_x(q[7*s+17]))]
#[frame(upper_arm[s in 0..2] in shoulder_roll[s]: translate(at[7*s+18]), rotate_z(q[7*s+18]))]
#[frame(forearm[s in 0..2] in upper_arm[s]: translate(at[7*s+19]), rotate_y(q[7*s+19]))]
#[frame(wrist[s in 0..2] in forearm[s]: translate(at[7*s+20]), rotate_z(q[7*s+20]))]
#[frame(wrist_roll[s in 0..2] in wrist[s]: translate(at[7*s+21]), rotate_x(q[7*s+21]))]
#[frame(hand[s in 0..2] in wrist_roll[s]: translate(at[7*s+22]), rotate_y(q[7*s+22]))]
#[define(T_trunk = kinetic(pelvis, m[0], centre[0], inertia[0])
    + kinetic(waist, m[13], centre[13], inertia[13])
    + kinetic(chest, m[14], centre[14], inertia[14])
    + kinetic(neck, m[15], centre[15], inertia[15])
    + kinetic(head, m[16], centre[16], inertia[16]))]
#[define(T_legs = sum(s in 0..2,
    kinetic(hip[s], m[6*s+1], centre[6*s+1], inertia[6*s+1])
    + kinetic(hip_roll[s], m[6*s+2], centre[6*s+2], inertia[6*s+2])
    + kinetic(thigh[s], m[6*s+3], centre[6*s+3], inertia[6*s+3])
    + kinetic(shank[s], m[6*s+4], centre[6*s+4], inertia[6*s+4])
    + kinetic(ankle[s], m[6*s+5], centre[6*s+5], inertia[6*s+5])
    + kinetic(foot[s], m[6*s+6], centre[6*s+6], inertia[6*s+6])))]
#[define(T_arms = sum(s in 0..2,
    kinetic(shoulder[s], m[7*s+17], centre[7*s+17], inertia[7*s+17])
    + kinetic(shoulder_roll[s], m[7*s+18], centre[7*s+18], inertia[7*s+18])
    + kinetic(upper_arm[s], m[7*s+19], centre[7*s+19], inertia[7*s+19])
    + kinetic(forearm[s], m[7*s+20], centre[7*s+20], inertia[7*s+20])
    + kinetic(wrist[s], m[7*s+21], centre[7*s+21], inertia[7*s+21])
    + kinetic(wrist_roll[s], m[7*s+22], centre[7*s+22], inertia[7*s+22])
    + kinetic(hand[s], m[7*s+23], centre[7*s+23], inertia[7*s+23])))]
#[define(U_trunk = g*(m[0]*position(pelvis, centre[0])[2]
    + m[13]*position(waist, centre[13])[2]
    + m[14]*position(chest, centre[14])[2]
    + m[15]*position(neck, centre[15])[2]
    + m[16]*position(head, centre[16])[2]))]
#[define(U_legs = g*sum(s in 0..2,
    m[6*s+1]*position(hip[s], centre[6*s+1])[2]
    + m[6*s+2]*position(hip_roll[s], centre[6*s+2])[2]
    + m[6*s+3]*position(thigh[s], centre[6*s+3])[2]
    + m[6*s+4]*position(shank[s], centre[6*s+4])[2]
    + m[6*s+5]*position(ankle[s], centre[6*s+5])[2]
    + m[6*s+6]*position(foot[s], centre[6*s+6])[2]))]
#[define(U_arms = g*sum(s in 0..2,
    m[7*s+17]*position(shoulder[s], centre[7*s+17])[2]
    + m[7*s+18]*position(shoulder_roll[s], centre[7*s+18])[2]
    + m[7*s+19]*position(upper_arm[s], centre[7*s+19])[2]
    + m[7*s+20]*position(forearm[s], centre[7*s+20])[2]
    + m[7*s+21]*position(wrist[s], centre[7*s+21])[2]
    + m[7*s+22]*position(wrist_roll[s], centre[7*s+22])[2]
    + m[7*s+23]*position(hand[s], centre[7*s+23])[2]))]
#[lagrangian(T_trunk + T_legs + T_arms - U_trunk - U_legs - U_arms)]
#[force(q: tau)]
#[repr(C)]
pub struct Humanoid {
    at: [Vector3<f64>; 30],
    centre: [Vector3<f64>; 31],
    inertia: [Matrix3<f64>; 31],
    m: [f64; 31],
    g: f64,
    tau: [f64; 30],
}
