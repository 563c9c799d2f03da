// The robot `cart-and gripper`, written by lagrange-urdf from its description, to be read and edited.
// SI units, angles in rad; gravity is along −z.
// Note: names that had to change: `t` is `t_joint`, `left-finger` is `left_finger`, `cart` is `cart_link`.

use lagrange_core::nalgebra::{Matrix3, Vector3};
use lagrange_core::prelude::*;

/// The robot `cart-and gripper`: a frame for each link that moves, a coordinate for each joint.
#[derive(Clone, Debug, Lagrangian)]
#[coordinates(cart, t_joint, left_finger, sliding: [3])]
#[define(right_finger = -2*left_finger + 0.02; tilt = 0.5*right_finger)]
#[frame(
    // `cart`, by the prismatic joint `cart`
    cart_link: translate([-cart, 0, 0]);
    // `mast`, by the continuous joint `t`
    mast in cart_link: translate([0, 0, 0.2]), rotate_x(0.3), rotate_y(-t_joint);
    // `left`, by the prismatic joint `left-finger`
    left in mast: translate([0.01, 0, 0.6]), rotate_z(0.4), translate(left_finger*[0.6, 0.8, 0]);
    // `right`, by the revolute joint `tilt`
    right in mast: translate([-0.01, 0, 0.6]), rotate_x(tilt);
    // `pad`, by the prismatic joint `right_finger`
    pad in right: translate([0, 0, -right_finger]);
    // `puck`, by the planar joint `sliding`
    puck:
        translate([0, 2, 0]),
        rotate_z(0.3),
        rotate_y(0.2),
        rotate_x(0.1),
        translate(sliding[0]*[-0.23570226039551584, 0.9428090415820634, -0.23570226039551584] + sliding[1]*[-0.7071067811865475, 0, 0.7071067811865475]),
        rotate([0.6666666666666666, 0.3333333333333333, 0.6666666666666666], sliding[2])
)]
#[parameter(
    cart_link_body: {m, centre: [3], inertia: symmetric};
    mast_body: {m, centre: [3], inertia: symmetric};
    left_body: {m, centre: [3], inertia: symmetric};
    right_body: {m, centre: [3], inertia: symmetric};
    pad_body: {m, centre: [3], inertia: symmetric};
    puck_body: {m, centre: [3], inertia: symmetric}
)]
#[lagrangian(
    kinetic(cart_link, cart_link_body.m, cart_link_body.centre, cart_link_body.inertia)
    + kinetic(mast, mast_body.m, mast_body.centre, mast_body.inertia)
    + kinetic(left, left_body.m, left_body.centre, left_body.inertia)
    + kinetic(right, right_body.m, right_body.centre, right_body.inertia)
    + kinetic(pad, pad_body.m, pad_body.centre, pad_body.inertia)
    + kinetic(puck, puck_body.m, puck_body.centre, puck_body.inertia)
    - g*(
        cart_link_body.m*position(cart_link, cart_link_body.centre)[2]
        + mast_body.m*position(mast, mast_body.centre)[2]
        + left_body.m*position(left, left_body.centre)[2]
        + right_body.m*position(right, right_body.centre)[2]
        + pad_body.m*position(pad, pad_body.centre)[2]
        + puck_body.m*position(puck, puck_body.centre)[2]
    )
)]
#[force(cart: tau_cart; t_joint: tau_t_joint; left_finger: tau_left_finger)]
#[dissipation(
    cart_damping/2*cart_dot^2
    + left_finger_damping/2*left_finger_dot^2
    + tilt_damping/2*der(tilt)^2
)]
pub struct CartAndGripper {
    /// Acceleration of gravity along −z, in m/s².
    pub g: f64,
    /// Body of the link `cart`.
    pub cart_link_body: Body,
    /// Body of the link `mast`.
    pub mast_body: Body,
    /// Body of the link `left`.
    pub left_body: Body,
    /// Body of the link `right`.
    pub right_body: Body,
    /// Body of the link `pad`.
    pub pad_body: Body,
    /// Body of the link `puck`.
    pub puck_body: Body,
    /// Effort of the joint `cart`, in N.
    pub tau_cart: f64,
    /// Damping of the joint `cart`, in N s/m.
    pub cart_damping: f64,
    /// Effort of the joint `t`, in N m.
    pub tau_t_joint: f64,
    /// Effort of the joint `left-finger`, in N.
    pub tau_left_finger: f64,
    /// Damping of the joint `left-finger`, in N s/m.
    pub left_finger_damping: f64,
    /// Damping of the joint `tilt`, in N m s/rad.
    pub tilt_damping: f64,
}

#[rustfmt::skip]
#[allow(clippy::approx_constant)]
impl Default for CartAndGripper {
    /// The robot of the description, without efforts.
    fn default() -> Self {
        Self {
            g:                   9.81,
            cart_link_body:      Body::new(6.0, [0.0, 0.0, -0.05], [0.1, 0.0, 0.0, 0.1, 0.0, 0.15]),
            mast_body:           Body::new(2.0, [0.0, 0.0, 0.3], [0.06, 0.0, 0.0, 0.06, 0.0, 0.002]),
            left_body:           Body::new(0.1, [0.0, 0.01, 0.03], [0.0001, 0.0, 0.0, 8e-5, 0.0, 4e-5]),
            right_body:          Body::new(0.12, [0.0, -0.01, 0.03], [0.0001, 1e-5, 0.0, 8e-5, 0.0, 4e-5]),
            pad_body:            Body::new(0.05, [0.0, 0.0, 0.0], [2e-5, 0.0, 0.0, 2e-5, 0.0, 2e-5]),
            puck_body:           Body::new(0.3, [0.02, 0.0, 0.01], [0.0003, 5e-5, 0.0, 0.0004, 0.0, 0.0006]),
            tau_cart:            0.0,
            cart_damping:        4.0,
            tau_t_joint:         0.0,
            tau_left_finger:     0.0,
            left_finger_damping: 1.5,
            tilt_damping:        0.02,
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

impl CartAndGripper {
    /// Limits of the coordinates, in their order, which the equations do not know.
    #[rustfmt::skip]
    #[allow(dead_code, clippy::approx_constant, reason = "for those who read the limits, as described")]
    pub const LIMITS: [Limit; 6] = [
        Limit { coordinate: "cart",        position: [0.0,               1.5],           velocity: 2.0,           effort: 100.0 },
        Limit { coordinate: "t_joint",     position: [f64::NEG_INFINITY, f64::INFINITY], velocity: 5.0,           effort: 30.0 },
        Limit { coordinate: "left_finger", position: [0.0,               0.04],          velocity: 0.2,           effort: 20.0 },
        Limit { coordinate: "sliding[0]",  position: [f64::NEG_INFINITY, f64::INFINITY], velocity: f64::INFINITY, effort: f64::INFINITY },
        Limit { coordinate: "sliding[1]",  position: [f64::NEG_INFINITY, f64::INFINITY], velocity: f64::INFINITY, effort: f64::INFINITY },
        Limit { coordinate: "sliding[2]",  position: [f64::NEG_INFINITY, f64::INFINITY], velocity: f64::INFINITY, effort: f64::INFINITY },
    ];
    /// Limits of joints that mimic others.
    #[rustfmt::skip]
    #[allow(dead_code, clippy::approx_constant, reason = "for those who read the limits, as described")]
    pub const MIMIC_LIMITS: [Limit; 2] = [
        Limit { coordinate: "tilt",         position: [0.0, 0.1],  velocity: 0.5, effort: 20.0 },
        Limit { coordinate: "right_finger", position: [0.0, 0.04], velocity: 0.2, effort: 20.0 },
    ];
}

#[allow(dead_code, reason = "for those who set efforts, as described")]
impl CartAndGripper {
    /// Names of the efforts, as `inputs_for` takes them.
    pub const EFFORTS: [&str; 3] = [
        "tau_cart",
        "tau_t_joint",
        "tau_left_finger",
    ];

    /// Sets the efforts, in the order of `EFFORTS`.
    pub fn set_efforts(&mut self, efforts: &[f64; 3]) {
        self.tau_cart = efforts[0];
        self.tau_t_joint = efforts[1];
        self.tau_left_finger = efforts[2];
    }
}
