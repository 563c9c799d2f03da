// The robot `two_link`, written by lagrange-urdf from its description, to be read and edited.
// SI units, angles in rad; gravity is along −z.

use lagrange_core::contact::Friction;
use lagrange_core::prelude::*;

/// The robot `two_link`: a frame for each link that moves, a coordinate for each joint.
///
/// Its joints stick and slide in motions `robot.motion(start).with_contacts().to(end)`.
#[derive(Clone, Debug, Lagrangian)]
#[coordinates(shoulder, elbow)]
#[frame(
    // `upper_arm`, by the revolute joint `shoulder`
    upper_arm: translate([0.1, 0, 0.4]), rotate_z(pi/2), rotate_y(0.2), rotate_z(shoulder);
    // `forearm`, by the revolute joint `elbow`, with `tool` fixed to it
    forearm in upper_arm:
        translate([0, 0.05, 0.3]),
        rotate_z(0.5),
        rotate_x(-1.2),
        rotate([0.3333333333333333, 0.6666666666666666, -0.6666666666666666], elbow)
)]
#[lagrangian(
    kinetic(upper_arm, 3.5, [0.02, 0, 0.15], [[0.029175588250450506, 0.00017640110846235668, 0.002779638277606308], [0.00017640110846235668, 0.024176477154204474, 0.009107400257341726], [0.002779638277606308, 0.009107400257341726, 0.010647934595345018]])
    + kinetic(forearm, 1.65, [-0.0007164126222093081, 0.0023159672463651058, 0.12666666666666668], [[0.008033984111269647, 3.6332443621882275e-5, 7.685018410172445e-5], [3.6332443621882275e-5, 0.00794777014009055, -0.0002763639824842443], [7.685018410172445e-5, -0.0002763639824842443, 0.0012621851425791966]])
    - g*(
        3.5*position(upper_arm, [0.02, 0, 0.15])[2]
        + 1.65*position(forearm, [-0.0007164126222093081, 0.0023159672463651058, 0.12666666666666668])[2]
    )
)]
#[force(shoulder: tau_shoulder; elbow: tau_elbow)]
#[dissipation(0.3/2*shoulder_dot^2 + 0.1/2*elbow_dot^2)]
#[friction(shoulder_friction: shoulder_dot, limit: 0.5, sliding: 0.5)]
pub struct Rubbing {
    /// Acceleration of gravity along −z, in m/s².
    pub g: f64,
    /// Effort of the joint `shoulder`, in N m.
    pub tau_shoulder: f64,
    /// Whether the joint `shoulder` sticks or slides.
    pub shoulder_friction: Friction,
    /// Effort of the joint `elbow`, in N m.
    pub tau_elbow: f64,
}

#[rustfmt::skip]
#[allow(clippy::approx_constant)]
impl Default for Rubbing {
    /// The robot of the description, without efforts.
    fn default() -> Self {
        Self {
            g:                 9.81,
            tau_shoulder:      0.0,
            shoulder_friction: Friction::default(),
            tau_elbow:         0.0,
        }
    }
}

/// Limits of a coordinate, infinite where there are none.
#[allow(dead_code, reason = "for those who read the limits")]
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// Its name.
    pub coordinate: &'static str,
    /// Least and greatest position, in rad or m.
    pub position: [f64; 2],
    /// Greatest speed, in rad/s or m/s.
    pub velocity: f64,
    /// Greatest effort, in N m or N.
    pub effort: f64,
}

impl Rubbing {
    /// Limits of the coordinates, in their order, which the equations do not know.
    #[rustfmt::skip]
    #[allow(dead_code, clippy::approx_constant, reason = "for those who read the limits, as described")]
    pub const LIMITS: [Limit; 2] = [
        Limit { coordinate: "shoulder", position: [-2.5, 2.5], velocity: 3.0, effort: 40.0 },
        Limit { coordinate: "elbow",    position: [-1.5, 2.0], velocity: 4.0, effort: 15.0 },
    ];
}

#[allow(dead_code, reason = "for those who set efforts, as described")]
impl Rubbing {
    /// Names of the efforts, as `inputs_for` takes them.
    pub const EFFORTS: [&str; 2] = [
        "tau_shoulder",
        "tau_elbow",
    ];

    /// Sets the efforts, in the order of `EFFORTS`.
    pub fn set_efforts(&mut self, efforts: &[f64; 2]) {
        self.tau_shoulder = efforts[0];
        self.tau_elbow = efforts[1];
    }
}
