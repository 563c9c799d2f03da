// The robot `hopper`, written by lagrange-urdf from its description, to be read and edited.
// SI units, angles in rad; gravity is along −z.
// Note: revolute and prismatic joints without <limit> are taken to have no limits: `KNEE`.

use lagrange_core::prelude::*;

/// The robot `hopper`: a frame for each link that moves, a coordinate for each joint.
#[derive(Clone, Debug, Lagrangian)]
#[allow(non_snake_case)]
#[coordinates(place: [3], turn: [4], HIP, KNEE, ball: [4])]
#[frame(
    // `base_footprint`, free in space, with `trunk` fixed to it
    base_footprint: translate(place), rotate(turn);
    // `THIGH`, by the revolute joint `HIP`
    THIGH in base_footprint:
        translate([-0.015364674647749002, 0.10984944839838585, 0.012267306780543982]),
        rotate_z(-2.8415926535897933),
        rotate_y(0.2),
        rotate_x(-0.1),
        rotate_y(HIP);
    // `shank`, by the prismatic joint `KNEE`
    shank in THIGH: translate([0, 0, -0.2]), translate([0, 0, KNEE]);
    // `tail`, by the spherical joint `ball`
    tail in base_footprint:
        translate([-0.18725867271683985, -0.05792589552510311, 0.06026613384098776]),
        rotate_z(0.4201405028452248),
        rotate_y(0.7941042492909617),
        rotate_x(0.14004940014784178),
        rotate(ball)
)]
#[lagrangian(
    kinetic(base_footprint, 8, [0.010842417772312015, -0.020611514883311657, 0.12928493522385998], [[0.09208056926493466, -0.007635005910314363, -0.002554530915544328], [-0.007635005910314363, 0.11603423354892252, 0.005338263575473512], [-0.002554530915544328, 0.005338263575473512, 0.1018851971861428]])
    + kinetic(THIGH, 0.8, [0, 0, -0.1], [[0.004, 0, 0], [0, 0.004, 0], [0, 0, 0.0004]])
    + kinetic(shank, 0.3, [0, 0, -0.08], [[0.001, 0, 0], [0, 0.001, 0], [0, 0, 0.0001]])
    + kinetic(tail, 0.5, [0, 0, 0.2], [[0.002, 0, 0], [0, 0.003, 0], [0, 0, 0.001]])
    - g*(
        8*position(base_footprint, [0.010842417772312015, -0.020611514883311657, 0.12928493522385998])[2]
        + 0.8*position(THIGH, [0, 0, -0.1])[2]
        + 0.3*position(shank, [0, 0, -0.08])[2]
        + 0.5*position(tail, [0, 0, 0.2])[2]
    )
)]
#[force(HIP: tau_HIP; KNEE: tau_KNEE)]
#[dissipation(0.7/2*KNEE_dot^2)]
pub struct Hopper {
    /// Acceleration of gravity along −z, in m/s².
    pub g: f64,
    /// Effort of the joint `HIP`, in N m.
    pub tau_HIP: f64,
    /// Effort of the joint `KNEE`, in N.
    pub tau_KNEE: f64,
}

#[rustfmt::skip]
#[allow(clippy::approx_constant)]
impl Default for Hopper {
    /// The robot of the description, without efforts.
    fn default() -> Self {
        Self {
            g:        9.81,
            tau_HIP:  0.0,
            tau_KNEE: 0.0,
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

impl Hopper {
    /// Limits of the coordinates, in their order, which the equations do not know.
    #[rustfmt::skip]
    #[allow(dead_code, clippy::approx_constant, reason = "for those who read the limits, as described")]
    pub const LIMITS: [Limit; 13] = [
        Limit { coordinate: "place[0]", position: [f64::NEG_INFINITY, f64::INFINITY], velocity: f64::INFINITY, effort: f64::INFINITY },
        Limit { coordinate: "place[1]", position: [f64::NEG_INFINITY, f64::INFINITY], velocity: f64::INFINITY, effort: f64::INFINITY },
        Limit { coordinate: "place[2]", position: [f64::NEG_INFINITY, f64::INFINITY], velocity: f64::INFINITY, effort: f64::INFINITY },
        Limit { coordinate: "turn[0]",  position: [f64::NEG_INFINITY, f64::INFINITY], velocity: f64::INFINITY, effort: f64::INFINITY },
        Limit { coordinate: "turn[1]",  position: [f64::NEG_INFINITY, f64::INFINITY], velocity: f64::INFINITY, effort: f64::INFINITY },
        Limit { coordinate: "turn[2]",  position: [f64::NEG_INFINITY, f64::INFINITY], velocity: f64::INFINITY, effort: f64::INFINITY },
        Limit { coordinate: "turn[3]",  position: [f64::NEG_INFINITY, f64::INFINITY], velocity: f64::INFINITY, effort: f64::INFINITY },
        Limit { coordinate: "HIP",      position: [-1.0,              1.0],           velocity: 10.0,          effort: 30.0 },
        Limit { coordinate: "KNEE",     position: [f64::NEG_INFINITY, f64::INFINITY], velocity: f64::INFINITY, effort: f64::INFINITY },
        Limit { coordinate: "ball[0]",  position: [f64::NEG_INFINITY, f64::INFINITY], velocity: f64::INFINITY, effort: f64::INFINITY },
        Limit { coordinate: "ball[1]",  position: [f64::NEG_INFINITY, f64::INFINITY], velocity: f64::INFINITY, effort: f64::INFINITY },
        Limit { coordinate: "ball[2]",  position: [f64::NEG_INFINITY, f64::INFINITY], velocity: f64::INFINITY, effort: f64::INFINITY },
        Limit { coordinate: "ball[3]",  position: [f64::NEG_INFINITY, f64::INFINITY], velocity: f64::INFINITY, effort: f64::INFINITY },
    ];
}

#[allow(dead_code, reason = "for those who set efforts, as described")]
impl Hopper {
    /// Names of the efforts, as `inputs_for` takes them.
    pub const EFFORTS: [&str; 2] = [
        "tau_HIP",
        "tau_KNEE",
    ];

    /// Sets the efforts, in the order of `EFFORTS`.
    pub fn set_efforts(&mut self, efforts: &[f64; 2]) {
        self.tau_HIP = efforts[0];
        self.tau_KNEE = efforts[1];
    }
}
