// The robot `standing`, written by lagrange-urdf from its description, to be read and edited.
// SI units, angles in rad; gravity is along −z.
// Note: the limit of the effort is zero, of the joints: `slide`.

use lagrange_core::contact::{Contact, Friction};
use lagrange_core::nalgebra::{Matrix3, Vector3};
use lagrange_core::prelude::*;

/// The robot `standing`: a frame for each link that moves, a coordinate for each joint.
///
/// Its joints stop at their limits, its joints stick and slide, its links touch the floor in motions `robot.motion(start).with_contacts().to(end)`.
#[derive(Clone, Debug, Lagrangian)]
#[coordinates(slide, hip, knee)]
#[frame(
    // `body`, by the prismatic joint `slide`
    body: translate([0, 0, 1]), translate([0, 0, slide]);
    // `thigh`, by the continuous joint `hip`
    thigh in body: rotate([0.6, 0.8, 0], hip);
    // `shank`, by the revolute joint `knee`
    shank in thigh: translate([0, 0, -0.3]), rotate_y(knee)
)]
#[parameter(
    body_body: {m, centre: [3], inertia: symmetric};
    thigh_body: {m, centre: [3], inertia: symmetric};
    shank_body: {m, centre: [3], inertia: symmetric}
)]
#[lagrangian(
    kinetic(body, body_body.m, body_body.centre, body_body.inertia)
    + kinetic(thigh, thigh_body.m, thigh_body.centre, thigh_body.inertia)
    + kinetic(shank, shank_body.m, shank_body.centre, shank_body.inertia)
    - g*(
        body_body.m*position(body, body_body.centre)[2]
        + thigh_body.m*position(thigh, thigh_body.centre)[2]
        + shank_body.m*position(shank, shank_body.centre)[2]
    )
)]
#[force(slide: tau_slide; hip: tau_hip; knee: tau_knee)]
#[contact(
    slide_lower: slide >= -2;
    slide_upper: 2 >= slide;
    knee_lower: knee >= 0.2;
    knee_upper: 2.5 >= knee;
    shank_floor: position(shank)[2] >= 0, friction(mu): express(velocity(shank), fixed)[0..2];
    foot_floor: position(shank, [0, 0, -0.3])[2] >= 0, friction(mu): express(velocity(shank, [0, 0, -0.3]), fixed)[0..2]
)]
#[friction(knee_friction: knee_dot, limit: knee_coulomb, sliding: knee_coulomb)]
pub struct Standing {
    /// Acceleration of gravity along −z, in m/s².
    pub g: f64,
    /// Body of the link `body`.
    pub body_body: Body,
    /// Body of the link `thigh`.
    pub thigh_body: Body,
    /// Body of the link `shank`.
    pub shank_body: Body,
    /// Effort of the joint `slide`, in N.
    pub tau_slide: f64,
    /// Whether the joint `slide` is at its lower limit.
    pub slide_lower: Contact,
    /// Whether the joint `slide` is at its upper limit.
    pub slide_upper: Contact,
    /// Effort of the joint `hip`, in N m.
    pub tau_hip: f64,
    /// Effort of the joint `knee`, in N m.
    pub tau_knee: f64,
    /// Whether the joint `knee` sticks or slides.
    pub knee_friction: Friction,
    /// Dry friction of the joint `knee`, in N m.
    pub knee_coulomb: f64,
    /// Whether the joint `knee` is at its lower limit.
    pub knee_lower: Contact,
    /// Whether the joint `knee` is at its upper limit.
    pub knee_upper: Contact,
    /// Coefficient of friction of the floor, which the description does not state.
    pub mu: f64,
    /// Whether the link `shank` touches the floor.
    pub shank_floor: Contact,
    /// Whether the link `foot` touches the floor.
    pub foot_floor: Contact,
}

#[rustfmt::skip]
#[allow(clippy::approx_constant)]
impl Default for Standing {
    /// The robot of the description, without efforts.
    fn default() -> Self {
        Self {
            g:             9.81,
            body_body:     Body::new(3.0, [0.0, 0.0, 0.0], [0.01, 0.0, 0.0, 0.02, 0.0, 0.01]),
            thigh_body:    Body::new(0.8, [0.0, 0.0, -0.15], [0.006, 0.0, 0.0, 0.006, 0.0, 0.0004]),
            shank_body:    Body::new(0.4, [0.0, 0.0, -0.15], [0.003, 0.0, 0.0, 0.003, 0.0, 0.0002]),
            tau_slide:     0.0,
            slide_lower:   Contact::default(),
            slide_upper:   Contact::default(),
            tau_hip:       0.0,
            tau_knee:      0.0,
            knee_friction: Friction::default(),
            knee_coulomb:  0.1,
            knee_lower:    Contact::default(),
            knee_upper:    Contact::default(),
            mu:            1.0,
            shank_floor:   Contact::default(),
            foot_floor:    Contact::default(),
        }
    }
}

/// A rigid body in the axes of its link.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// Mass, in kg.
    pub m: f64,
    /// Centre of mass, in m.
    pub centre: Vector3<f64>,
    /// Inertia about the centre of mass, in kg m².
    pub inertia: Matrix3<f64>,
}

impl Body {
    /// The inertia is given by its entries xx, xy, xz, yy, yz, zz.
    pub fn new(m: f64, centre: [f64; 3], [xx, xy, xz, yy, yz, zz]: [f64; 6]) -> Self {
        let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        Self { m, centre: centre.into(), inertia }
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

impl Standing {
    /// Limits of the coordinates, in their order. The equations know positions alone, as contacts.
    #[rustfmt::skip]
    #[allow(dead_code, clippy::approx_constant, reason = "for those who read the limits, as described")]
    pub const LIMITS: [Limit; 3] = [
        Limit { coordinate: "slide", position: [-2.0,              2.0],           velocity: 10.0,          effort: 0.0 },
        Limit { coordinate: "hip",   position: [f64::NEG_INFINITY, f64::INFINITY], velocity: f64::INFINITY, effort: f64::INFINITY },
        Limit { coordinate: "knee",  position: [0.2,               2.5],           velocity: 10.0,          effort: 30.0 },
    ];
}

#[allow(dead_code, reason = "for those who set efforts, as described")]
impl Standing {
    /// Names of the efforts, as `inputs_for` takes them.
    pub const EFFORTS: [&str; 3] = [
        "tau_slide",
        "tau_hip",
        "tau_knee",
    ];

    /// Sets the efforts, in the order of `EFFORTS`.
    pub fn set_efforts(&mut self, efforts: &[f64; 3]) {
        self.tau_slide = efforts[0];
        self.tau_hip = efforts[1];
        self.tau_knee = efforts[2];
    }
}
