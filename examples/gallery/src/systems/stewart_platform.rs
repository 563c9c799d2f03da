//! A plate on six legs with springs.

use lagrange_core::nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob};

/// Each leg is a cylinder on a universal joint, a piston in it and a spring between them; the plate is at their ends.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [3], turn: [4], roll: [6], pitch: [6], length: [6])]
#[parameter(inertia: symmetric)]
#[frame(plate: translate(r), rotate(turn))]
#[frame(cylinder[i in 0..6]: translate(foot[i]), rotate_x(roll[i]), rotate_y(pitch[i]))]
#[frame(piston[i in 0..6] in cylinder[i]: translate([0, 0, length[i]]))]
#[define(T = kinetic(plate, m, [0, 0, 0], inertia)
    + sum(i in 0..6, kinetic(cylinder[i], rod, [0, 0, half], slender) + kinetic(piston[i], rod, [0, 0, -half], slender)))]
#[define(U = m*g*position(plate)[2]
    + rod*g*sum(i in 0..6, position(cylinder[i], [0, 0, half])[2] + position(piston[i], [0, 0, -half])[2]))]
#[lagrangian(T - U - k/2*sum(i in 0..6, (length[i] - rest)^2))]
#[constraint(joint[i in 0..6]: position(plate, corner[i]) = position(piston[i]))]
pub(super) struct StewartPlatform {
    m: f64,
    inertia: Matrix3<f64>,
    foot: [Vector3<f64>; 6],
    corner: [Vector3<f64>; 6],
    rod: f64,
    half: f64,
    slender: Matrix3<f64>,
    g: f64,
    k: f64,
    rest: f64,
}

impl Exhibit<5> for StewartPlatform {
    const TITLE: &'static str = "Stewart platform on springs";
    const ABOUT: &'static str = "A plate on six legs that can stretch: 25 coordinates with 19 constraints, \
        of which six degrees of freedom are left. That the legs end at the plate are the constraints, and \
        the arrows what they push it with.";
    const KNOBS: &'static [Knob; 5] = &[
        knob("z_0", "how high it is lifted", "m", [-0.15, 0.3], 0.1),
        knob("x_0", "how far to the side", "m", [-0.2, 0.2], 0.1),
        knob("psi", "how far it is twisted", "rad", [-0.5, 0.5], 0.3),
        knob("k", "stiffness of a leg", "N/m", [800.0, 8000.0], 2500.0),
        knob("m", "mass of the plate", "kg", [10.0, 80.0], 40.0),
    ];
    const UNITS: Option<Units> = Some(&[("joint", "N")]);
    const PACE: f64 = 0.5;

    fn set([z, x, twist, k, m]: [f64; 5]) -> (Self, State<f64, 25>) {
        // Two close together, three times; the corners are between the feet.
        let hexagon = |radius: f64, first: f64, apart: f64| {
            std::array::from_fn(|i| {
                let side = if i % 2 == 0 { first + apart } else { first + 120.0 - apart };
                let angle = (side + 120.0 * (i / 2) as f64).to_radians();
                radius * Point::new(angle.cos(), angle.sin(), 0.0)
            })
        };
        let platform = Self {
            m,
            inertia: Matrix3::from_diagonal(&(m / 40.0 * Point::new(1.6, 1.4, 2.4))),
            foot: hexagon(0.6, 0.0, 10.0),
            corner: hexagon(0.4, 0.0, 50.0),
            rod: 1.5,
            half: 0.2,
            slender: Matrix3::from_diagonal(&Point::new(0.02, 0.02, 2e-4)),
            g: 9.81,
            k,
            rest: 0.85,
        };
        let start = platform
            .at_rest(Point::new(x, 0.0, 0.75 + z), UnitQuaternion::from_euler_angles(0.0, 0.0, twist));
        (platform, start)
    }

    fn view(&self, _: &State<f64, 25>) -> View {
        View::space(Point::z() * 0.42, 0.9, 16.0 * self.m)
    }

    fn trails(&self, state: &State<f64, 25>) -> Vec<Point> {
        vec![state.q.fixed_rows::<3>(0).into()]
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let q = now.state.q;
        let pose = UnitQuaternion::new_normalize(Quaternion::new(q[3], q[4], q[5], q[6]));
        let joints: [Point; 6] = std::array::from_fn(|i| now.place(0) + pose * self.corner[i]);
        scene.face(Paint::Guide, &self.foot);
        for (foot, joint) in self.foot.iter().zip(&joints) {
            let along = (joint - foot).normalize();
            scene.line(Paint::Fixed, 7.0, &[*foot, foot + along * 2.0 * self.half]);
            scene.spring(foot + along * 2.0 * self.half, *joint, 0.03);
        }
        scene.face(Paint::Body, &joints);
        for (i, joint) in joints.iter().enumerate() {
            scene.dot(Paint::Fixed, 7.0, *joint);
            scene.constraint_force(*joint, now.multiplier(3 * i));
        }
    }
}

impl StewartPlatform {
    /// In this pose: roll and pitch take the z-axis to (sin p, −sin r cos p, cos r cos p).
    fn at_rest(&self, r: Point, pose: UnitQuaternion<f64>) -> State<f64, 25> {
        let mut state = State::at_rest([0.0; 25]);
        state.q.fixed_rows_mut::<3>(0).copy_from(&r);
        for (k, part) in [pose.w, pose.i, pose.j, pose.k].into_iter().enumerate() {
            state.q[3 + k] = part;
        }
        for i in 0..6 {
            let leg = r + pose * self.corner[i] - self.foot[i];
            state.q[7 + i] = (-leg.y).atan2(leg.z);
            state.q[13 + i] = (leg.x / leg.norm()).asin();
            state.q[19 + i] = leg.norm();
        }
        state
    }
}
