//! The hint that frames would be cheaper than differentiated positions, and the cost of both.

use super::bodies::{ARM, least};
use super::{equations, systems};

const FIELDS: &str =
    "struct System { place: [Rotation3<f64>; 6], arm: [Vector3<f64>; 6], centre: [Vector3<f64>; 6],
    inertia: [Matrix3<f64>; 6], m: [f64; 6], l: [f64; 6], g: f64, tau: [f64; 6] }";

/// Systems with positions along the fixed axes, each with the same system in frames.
const IN_TURN: [[&str; 2]; 7] = [
    // Two point masses on an arm with three joints.
    [
        "#[coordinates(a, b, c)]
         #[define(R = rot_z(a)*rot_y(b))] #[define(x = R*centre[0])] #[define(y = R*(arm[0] + rot_y(c)*centre[1]))]
         #[lagrangian(m[0]/2*dot(der(x), der(x)) + m[1]/2*dot(der(y), der(y)) - g*(m[0]*x[2] + m[1]*y[2]))]",
        "#[coordinates(a, b, c)]
         #[frame(upper: rotate_z(a), rotate_y(b))] #[frame(lower in upper: translate(arm[0]), rotate_y(c))]
         #[lagrangian(kinetic(upper, m[0], centre[0]) + kinetic(lower, m[1], centre[1])
           - g*(m[0]*position(upper, centre[0])[2] + m[1]*position(lower, centre[1])[2]))]",
    ],
    // A double spherical pendulum, the second arm by angles relative to the first.
    [
        "#[coordinates(a, b, c, d)]
         #[define(R = rot_x(a)*rot_y(b))] #[define(x = R*[0, 0, -l[0]])] #[define(y = x + R*rot_x(c)*rot_y(d)*[0, 0, -l[1]])]
         #[lagrangian(m[0]/2*dot(der(x), der(x)) + m[1]/2*dot(der(y), der(y)) - g*(m[0]*x[2] + m[1]*y[2]))]",
        "#[coordinates(a, b, c, d)]
         #[frame(x: rotate_x(a), rotate_y(b), translate([0, 0, -l[0]]))]
         #[frame(y in x: rotate_x(c), rotate_y(d), translate([0, 0, -l[1]]))]
         #[lagrangian(kinetic(x, m[0]) + kinetic(y, m[1]) - g*(m[0]*position(x)[2] + m[1]*position(y)[2]))]",
    ],
    // A gyroscope, its angular velocity from the rate of its rotation matrix.
    [
        "#[coordinates(phi, theta, psi)]
         #[define(R = rot_z(phi)*rot_x(theta)*rot_z(psi))] #[define(S = transpose(R)*der(R))] #[define(w = [S[2][1], S[0][2], S[1][0]])]
         #[lagrangian((m[0]*(w[0]^2 + w[1]^2) + m[1]*w[2]^2)/2 - l[0]*g*cos(theta))]",
        "#[coordinates(phi, theta, psi)]
         #[frame(top: rotate_z(phi), rotate_x(theta), rotate_z(psi))]
         #[lagrangian(kinetic(top, 0, [0, 0, 0], [[m[0], 0, 0], [0, m[0], 0], [0, 0, m[1]]]) - l[0]*g*cos(theta))]",
    ],
    // A free rigid body of four point masses, held by springs.
    [
        "#[coordinates(r: [3], a: [3])]
         #[define(R = rot_z(a[0])*rot_y(a[1])*rot_x(a[2]))] #[define(x[i in 0..4] = r + R*arm[i])]
         #[lagrangian(sum(i in 0..4, m[i]/2*dot(der(x[i]), der(x[i])) - l[i]/2*(norm(x[i] - centre[i]) - 1)^2))]",
        "#[coordinates(r: [3], a: [3])]
         #[frame(body: translate(r), rotate_z(a[0]), rotate_y(a[1]), rotate_x(a[2]))]
         #[lagrangian(sum(i in 0..4, kinetic(body, m[i], arm[i]) - l[i]/2*(norm(position(body, arm[i]) - centre[i]) - 1)^2))]",
    ],
    // A pendulum on a rotating planet.
    [
        "#[coordinates(a, b)]
         #[define(x = rot_z(l[0]*t)*rot_y(l[1])*([0, 0, l[2]] + rot_z(a)*(rot_x(b)*[0, 0, -l[3]])))]
         #[lagrangian(m[0]/2*dot(der(x), der(x)) + g*m[0]/norm(x))]",
        "#[coordinates(a, b)]
         #[frame(site: rotate_z(l[0]*t), rotate_y(l[1]), translate([0, 0, l[2]]))]
         #[frame(x in site: rotate_z(a), rotate_x(b), translate([0, 0, -l[3]]))]
         #[lagrangian(kinetic(x, m[0]) + g*m[0]/norm(position(x)))]",
    ],
    // A planar chain with products of rotations.
    [
        "#[coordinates(q: [4])]
         #[define(R[0] = rot_z(q[0]))] #[define(R[i in 1..4] = R[i-1]*rot_z(q[i]))]
         #[define(x[0] = R[0]*[l[0], 0, 0])] #[define(x[i in 1..4] = x[i-1] + R[i]*[l[i], 0, 0])]
         #[lagrangian(sum(i in 0..4, m[i]/2*dot(der(x[i]), der(x[i])) - m[i]*g*x[i][1]))]",
        "#[coordinates(q: [4])]
         #[frame(x[0]: rotate_z(q[0]), translate([l[0], 0, 0]))] #[frame(x[i in 1..4] in x[i-1]: rotate_z(q[i]), translate([l[i], 0, 0]))]
         #[lagrangian(sum(i in 0..4, kinetic(x[i], m[i]) - m[i]*g*position(x[i])[1]))]",
    ],
    // Two bodies with orientations of their own, the second attached to a point of the first.
    [
        "#[coordinates(a: [3], b: [3])]
         #[define(R = rot_z(a[0])*rot_x(a[1])*rot_z(a[2]))] #[define(S = rot_z(b[0])*rot_x(b[1])*rot_z(b[2]))]
         #[define(x = R*centre[0])] #[define(y = R*arm[0] + S*centre[1])]
         #[lagrangian(m[0]/2*dot(der(x), der(x)) + m[1]/2*dot(der(y), der(y)) - g*(m[0]*x[2] + m[1]*y[2]))]",
        "#[coordinates(a: [3], b: [3])]
         #[define(R = rot_z(a[0])*rot_x(a[1])*rot_z(a[2]))]
         #[frame(x: rotate(R))] #[frame(y: translate(R*arm[0]), rotate_z(b[0]), rotate_x(b[1]), rotate_z(b[2]))]
         #[lagrangian(kinetic(x, m[0], centre[0]) + kinetic(y, m[1], centre[1])
           - g*(m[0]*position(x, centre[0])[2] + m[1]*position(y, centre[1])[2]))]",
    ],
];

/// Systems of the same form for which equations in frames save little work, or need more.
const NOT_IN_TURN: [[&str; 2]; 3] = [
    // Links at absolute angles, one angle each.
    [
        "#[coordinates(q: [4])]
         #[define(x[0] = rot_z(q[0])*[l[0], 0, 0])] #[define(x[i in 1..4] = x[i-1] + rot_z(q[i])*[l[i], 0, 0])]
         #[lagrangian(sum(i in 0..4, m[i]/2*dot(der(x[i]), der(x[i])) - m[i]*g*x[i][1]))]",
        "#[coordinates(q: [4])]
         #[frame(x[0]: rotate_z(q[0]), translate([l[0], 0, 0]))] #[frame(x[i in 1..4] in x[i-1]: rotate_z(q[i] - q[i-1]), translate([l[i], 0, 0]))]
         #[lagrangian(sum(i in 0..4, kinetic(x[i], m[i]) - m[i]*g*position(x[i])[1]))]",
    ],
    // Links at absolute angles, two angles each.
    [
        "#[coordinates(a, b, c, d)]
         #[define(x = rot_z(a)*rot_x(b)*[0, 0, -l[0]])] #[define(y = x + rot_z(c)*rot_x(d)*[0, 0, -l[1]])]
         #[lagrangian(m[0]/2*dot(der(x), der(x)) + m[1]/2*dot(der(y), der(y)) - g*(m[0]*x[2] + m[1]*y[2]))]",
        "#[coordinates(a, b, c, d)]
         #[define(at = rot_z(a)*rot_x(b)*[0, 0, -l[0]])]
         #[frame(x: rotate_z(a), rotate_x(b), translate([0, 0, -l[0]]))] #[frame(y: translate(at), rotate_z(c), rotate_x(d), translate([0, 0, -l[1]]))]
         #[lagrangian(kinetic(x, m[0]) + kinetic(y, m[1]) - g*(m[0]*position(x)[2] + m[1]*position(y)[2]))]",
    ],
    // Two links with perpendicular joint axes.
    [
        "#[coordinates(a, b)]
         #[define(x = rot_z(a)*(arm[0] + rot_y(b)*arm[1]))]
         #[lagrangian(m[0]/2*dot(der(x), der(x)) - m[0]*g*x[2])]",
        "#[coordinates(a, b)]
         #[frame(x: rotate_z(a), translate(arm[0]), rotate_y(b), translate(arm[1]))]
         #[lagrangian(kinetic(x, m[0]) - m[0]*g*position(x)[2])]",
    ],
];

/// The system [`ARM`] with positions along the fixed axes and their rates.
const WORLD_ARM: &str = "#[coordinates(q: [6])]
    #[define(R[0] = place[0]*rot_z(q[0]))] #[define(R[i in 1..6] = R[i-1]*place[i]*rot_z(q[i]))]
    #[define(at[0] = [0, 0, 0])] #[define(at[i in 1..6] = at[i-1] + R[i-1]*arm[i])] #[define(x[i in 0..6] = at[i] + R[i]*centre[i])]
    #[define(spin[0] = place[0]*[0, 0, q_dot[0]])] #[define(spin[i in 1..6] = spin[i-1] + R[i]*[0, 0, q_dot[i]])]
    #[define(w[i in 0..6] = spin[i]*R[i])]
    #[lagrangian(sum(i in 0..6, m[i]/2*dot(der(x[i]), der(x[i])) + dot(w[i], inertia[i]*w[i])/2 - m[i]*g*x[i][2]))]
    #[force(q: tau)]";

fn is_told(source: &str) -> bool {
    equations(source).1.frames_are_cheaper
}

/// Operation count with frames, as a fraction of the count without.
fn share(world: &str, frames: &str) -> f64 {
    least(frames) as f64 / least(world) as f64
}

#[test]
fn where_frames_are_cheaper_that_is_said() {
    let systems = IN_TURN.map(|pair| pair.map(|source| format!("{source} {FIELDS}")));
    let arm = [format!("#[parameter(inertia: symmetric)] {WORLD_ARM} {FIELDS}"), ARM.to_owned()];
    for [world, frames] in systems.into_iter().chain([arm]) {
        let share = share(&world, &frames);
        assert!(is_told(&world) && share < 0.65, "{share}: {world}");
        assert!(!is_told(&frames), "{frames}");
    }
}

#[test]
fn where_they_are_not_nothing_is_said() {
    for [world, frames] in NOT_IN_TURN.map(|pair| pair.map(|source| format!("{source} {FIELDS}"))) {
        let share = share(&world, &frames);
        assert!(!is_told(&world) && share > 0.8, "{share}: {world}");
    }
    assert!(!is_told(&systems::chain(10)) && !is_told(&systems::rods(3)) && !is_told(systems::TOP));
}

/// A rate that only an observable contains gives no hint, nor do positions without a rate.
#[test]
fn what_the_equations_do_not_differentiate_is_no_matter() {
    let by_rates = "w = [phi_dot*sin(theta)*sin(psi) + theta_dot*cos(psi), phi_dot*sin(theta)*cos(psi) - theta_dot*sin(psi), phi_dot*cos(theta) + psi_dot]";
    let top = format!(
        "#[coordinates(phi, theta, psi)] #[define({by_rates})] #[define(R = rot_z(phi)*rot_x(theta)*rot_z(psi))]
         #[lagrangian(dot(w, inertia[0]*w)/2 - m[0]*g*(R*centre[0])[2])] #[observable(v = der(R*centre[0]))] {FIELDS}"
    );
    assert!(!is_told(&top));
}
