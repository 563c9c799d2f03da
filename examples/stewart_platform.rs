//! A platform on six legs that are screwed in and out (D. Stewart, *Proceedings of the Institution of Mechanical Engineers*
//! 180, 1965), driven around a circle and banked as a road is in a bend: who stands on it is not pushed aside.
//!
//! Each leg is a cylinder on a universal joint and a piston in it; that its end is at the plate are three constraints, so that
//! 25 coordinates with the 19 constraints, one of them the quaternion's own, have six degrees of freedom. The motors are told 200
//! times a second how hard to push, and do not change it in between. The control wants the plate to come to its path as
//! z̈ = −2κ ż − κ² z for the deviation z; the constraints say what the legs then do, and inverse dynamics says by which forces; the
//! multipliers are the forces in the joints (J. Y. S. Luh, M. W. Walker and R. P. C. Paul,
//! "Resolved-acceleration control of mechanical manipulators", *IEEE Transactions on Automatic Control* 25, 1980).

mod picture;

use std::f64::consts::PI;

use lagrange_core::Solution;
use lagrange_core::nalgebra::{Matrix3, Quaternion, SMatrix, SVector, UnitQuaternion, Vector3, Vector4};
use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(r: [3], turn: [4], roll: [6], pitch: [6], length: [6])]
#[parameter(inertia: symmetric)]
#[frame(plate: translate(r), rotate(turn))]
#[frame(cylinder[k in 0..6]: translate(foot[k]), rotate_x(roll[k]), rotate_y(pitch[k]))]
#[frame(piston[k in 0..6] in cylinder[k]: translate([0, 0, length[k]]))]
#[define(T = kinetic(plate, m, [0, 0, 0], inertia)
    + sum(k in 0..6, kinetic(cylinder[k], rod, [0, 0, half], slender) + kinetic(piston[k], rod, [0, 0, -half], slender)))]
#[define(U = m*g*position(plate)[2]
    + rod*g*sum(k in 0..6, position(cylinder[k], [0, 0, half])[2] + position(piston[k], [0, 0, -half])[2]))]
#[lagrangian(T - U)]
#[constraint(joint[k in 0..6]: position(plate, corner[k]) = position(piston[k]))]
#[force(length: push)]
#[observable(felt = express(der(velocity(plate)), plate) + express(vector(fixed, [0, 0, g]), plate))]
struct Platform {
    m: f64,
    inertia: Matrix3<f64>,
    foot: [Vector3<f64>; 6],
    corner: [Vector3<f64>; 6],
    /// The mass of a cylinder, and of a piston; their centres are half their length from the joints.
    rod: f64,
    half: f64,
    slender: Matrix3<f64>,
    g: f64,
    push: [f64; 6],
}

type At = State<f64, 25>;

/// Where the centre of the plate goes, and how often.
const RADIUS: f64 = 0.15;
const HEIGHT: f64 = 0.75;
const ROUND: f64 = 1.5;
/// How often the motors are told what to do, and for how long.
const TICK: f64 = 0.005;
const END: f64 = 3.0;
/// κ, by which deviations from the path go.
const FOLLOW: f64 = 12.0;

/// A pose of the plate with its first and second derivatives.
struct Pose {
    r: [Vector3<f64>; 3],
    turn: [Vector4<f64>; 3],
}

/// What is kept of the motion, at the ticks, when the motors have been told.
struct Moment {
    state: At,
    solution: Solution<f64, 25, 19>,
    /// Of all coordinates, by the control.
    wanted: SVector<f64, 25>,
    push: [f64; 6],
    /// What all motors have done so far, and the energy.
    work: f64,
    energy: f64,
}

fn main() -> Result<()> {
    let platform = Platform::of_hexagons();
    println!("{} coordinates, {} constraints", Platform::COORDINATES.len(), Platform::CONSTRAINTS.len());
    let record = run(platform.clone())?;
    table(&record);
    checks(&platform, &record)?;
    let file = picture::path("stewart_platform")?;
    draw(&platform, &record, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

/// Where the plate is to be: banked by the angle whose tangent is ρ φ̇²/g.
fn path(t: f64, g: f64) -> Pose {
    let rate = 2.0 * PI / ROUND;
    let (half, (sine, cosine)) = ((RADIUS * rate * rate / g).atan() / 2.0, (rate * t).sin_cos());
    let circle = [Vector3::new(cosine, sine, 0.0), rate * Vector3::new(-sine, cosine, 0.0)];
    let circle = [circle[0], circle[1], -rate * rate * circle[0]];
    let mut r = circle.map(|c| RADIUS * c);
    r[0][2] = HEIGHT;
    // About the direction in which it moves, towards the middle of the circle.
    let mut turn = circle.map(|c| half.sin() * Vector4::new(0.0, c[1], -c[0], 0.0));
    turn[0][0] = half.cos();
    Pose { r, turn }
}

impl Platform {
    /// Of the size of one that carries a child.
    fn of_hexagons() -> Self {
        // Two close together, three times; the corners are between the feet.
        let hexagon = |radius: f64, first: f64, apart: f64| {
            std::array::from_fn(|k| {
                let side = if k % 2 == 0 { first + apart } else { first + 120.0 - apart };
                let angle = (side + 120.0 * f64::from(k as u32 / 2)).to_radians();
                radius * Vector3::new(angle.cos(), angle.sin(), 0.0)
            })
        };
        Self {
            m: 40.0,
            inertia: Matrix3::from_diagonal(&Vector3::new(1.6, 1.4, 2.4)),
            foot: hexagon(0.6, 0.0, 10.0),
            corner: hexagon(0.4, 0.0, 50.0),
            rod: 1.5,
            half: 0.2,
            slender: Matrix3::from_diagonal(&Vector3::new(0.02, 0.02, 2e-4)),
            g: 9.81,
            push: [0.0; 6],
        }
    }

    /// From the joints below to those above, in space.
    fn legs(&self, s: &At) -> [Vector3<f64>; 6] {
        let (r, turn) = (s.q.fixed_rows::<3>(0), s.q.fixed_rows::<4>(3).into_owned());
        let turn = UnitQuaternion::new_unchecked(quaternion(&turn));
        std::array::from_fn(|k| r + turn * self.corner[k] - self.foot[k])
    }

    /// At rest in a pose: roll and pitch take the z-axis to (sin p, −sin r cos p, cos r cos p).
    fn at(&self, r: Vector3<f64>, turn: UnitQuaternion<f64>) -> At {
        let mut s = State::at_rest([0.0; 25]);
        s.q.fixed_rows_mut::<3>(0).copy_from(&r);
        s.q.fixed_rows_mut::<4>(3).copy_from(&Vector4::new(turn.w, turn.i, turn.j, turn.k));
        for (k, leg) in self.legs(&s).iter().enumerate() {
            s.q[7 + k] = (-leg[1]).atan2(leg[2]);
            s.q[13 + k] = (leg[0] / leg.norm()).asin();
            s.q[19 + k] = leg.norm();
        }
        s
    }

    /// The accelerations that the control wants: its own of the plate, and those of the legs that go with them.
    fn wanted(&self, s: &At) -> Result<SVector<f64, 25>> {
        let path = path(s.t, self.g);
        let follow =
            |[x, v, a]: [f64; 3], k: usize| a + 2.0 * FOLLOW * (v - s.v[k]) + FOLLOW * FOLLOW * (x - s.q[k]);
        let mut wanted = SVector::<f64, 25>::zeros();
        (0..3).for_each(|k| wanted[k] = follow(path.r.map(|r| r[k]), k));
        (0..4).for_each(|k| wanted[3 + k] = follow(path.turn.map(|turn| turn[k]), 3 + k));
        // Of the quaternion only what leaves its length alone: q·q̈ + q̇² = 0.
        let (turn, rate) = (s.q.fixed_rows::<4>(3), s.v.fixed_rows::<4>(3));
        let along = turn.dot(&wanted.fixed_rows::<4>(3)) + rate.norm_squared();
        wanted.fixed_rows_mut::<4>(3).axpy(-along / turn.norm_squared(), &turn, 1.0);
        // F q̈ + γ = 0, three rows a leg.
        let f = self.constraint_jacobian(s).fixed_rows::<18>(0).into_owned();
        let left = -(f * wanted + self.constraint_bias(s).fixed_rows::<18>(0));
        let of_legs: SMatrix<f64, 18, 18> = f.fixed_columns::<18>(7).into();
        let legs = of_legs.lu().solve(&left).ok_or("the legs do not know where to go")?;
        wanted.fixed_rows_mut::<18>(7).copy_from(&legs);
        Ok(wanted)
    }

    /// What the legs have to push by for these accelerations. Only the last six coordinates have motors: what the others
    /// need, the joints have to do.
    fn push_for(&self, s: &At, accelerations: &SVector<f64, 25>) -> Result<[f64; 6]> {
        let still = Self { push: [0.0; 6], ..self.clone() };
        let needed = still.inverse_dynamics(s, accelerations, &SVector::zeros());
        let joints = self.constraint_jacobian(s).fixed_columns::<19>(0).transpose();
        let joints =
            joints.lu().solve(&needed.fixed_rows::<19>(0)).ok_or("the joints cannot hold the plate")?;
        let left = still.inverse_dynamics(s, accelerations, &joints);
        Ok(left.fixed_rows::<6>(19).into_owned().into())
    }
}

fn quaternion(x: &Vector4<f64>) -> Quaternion<f64> {
    Quaternion::new(x[0], x[1], x[2], x[3])
}

/// From rest, level and a little aside of where the path begins.
fn run(platform: Platform) -> Result<Vec<Moment>> {
    let start = platform.at(Vector3::new(0.11, 0.04, 0.7), UnitQuaternion::identity());
    let mut motion = Motion::new(platform, start, Dop853::with_tolerance(1e-11))?;
    let (mut record, mut work) = (Vec::<Moment>::new(), 0.0);
    for tick in 1..=(END / TICK).round() as u32 {
        let state = *motion.state();
        let wanted = motion.system().wanted(&state)?;
        let push = motion.system().push_for(&state, &wanted)?;
        motion.system_mut().push = push;
        let lengths = |s: &At| s.q.fixed_rows::<6>(19).into_owned();
        let (solution, energy) = (motion.system().solve(&state)?, motion.system().energy(&state));
        record.push(Moment { state, solution, wanted, push, work, energy });
        motion.advance_to(TICK * f64::from(tick))?;
        // The forces are constant in between.
        work += SVector::from(push).dot(&(lengths(motion.state()) - lengths(&state)));
    }
    Ok(record)
}

/// How far the plate is from its path, in m and rad.
fn deviation(moment: &Moment, g: f64) -> [f64; 2] {
    let (s, path) = (&moment.state, path(moment.state.t, g));
    let turn = path.turn[0].dot(&s.q.fixed_rows::<4>(3)).abs().min(1.0);
    [(s.q.fixed_rows::<3>(0) - path.r[0]).norm(), 2.0 * turn.acos()]
}

fn table(record: &[Moment]) {
    println!("\n{:>5} {:>23} {:>49}", "t/s", "plate in m", "legs push by, in N");
    for Moment { state, push, .. } in record.iter().step_by(60) {
        let r: String = state.q.iter().take(3).map(|x| format!("{x:8.3}")).collect();
        let push: String = push.iter().map(|x| format!("{x:9.2}")).collect();
        println!("{:5.2} {r} {push}", state.t);
    }
}

fn checks(platform: &Platform, record: &[Moment]) -> Result<()> {
    let mut worst = [0.0_f64; 8];
    let last = &record[record.len() - 1];
    let found = platform.inputs_for(&last.state, &last.wanted, &["push"])?.inputs;
    worst[7] = (SVector::from(last.push) - found).amax();
    for moment in record {
        let Moment { state: s, solution, wanted, .. } = moment;
        let (felt, [apart, turned]) = (platform.felt(s, solution), deviation(moment, platform.g));
        let is_there = s.t >= END - ROUND;
        let deviations = [
            open(platform, s),
            (solution.accelerations - wanted).amax(),
            unbalanced(platform, moment),
            (moment.energy - record[0].energy - moment.work).abs(),
            if is_there { apart } else { 0.0 },
            if is_there { turned } else { 0.0 },
            if is_there { felt[0].hypot(felt[1]) } else { 0.0 },
        ];
        for (worst, deviation) in worst.iter_mut().zip(deviations) {
            *worst = worst.max(deviation);
        }
    }
    let laws = [
        ("the legs end at the corners of the plate, in m", 1e-9),
        ("the plate accelerates as the control wants, in m/s² and 1/s²", 1e-7),
        ("its joints' forces do it, by Newton and Euler, in N and N m", 1e-7),
        ("the motors' work is the energy, in J", 1e-7),
        ("second round: from the path, in m", 1e-3),
        ("second round: turned from it, in rad", 1e-2),
        ("second round: pushed aside on the plate, in m/s²", 0.1),
        ("at the end: the legs push as `inputs_for` says, in N", 1e-9),
    ];
    println!("\nlargest deviation in {} moments", record.len());
    for ((law, most), worst) in laws.into_iter().zip(worst) {
        println!("  {law:<62} {worst:8.1e}");
        assert!(worst < most, "{law}: {worst:e}");
    }
    Ok(())
}

/// How far the legs' ends are from the plate.
fn open(platform: &Platform, s: &At) -> f64 {
    let end = |k: usize| {
        let ((sr, cr), (sp, cp)) = (s.q[7 + k].sin_cos(), s.q[13 + k].sin_cos());
        s.q[19 + k] * Vector3::new(sp, -sr * cp, cr * cp)
    };
    platform.legs(s).iter().enumerate().map(|(k, leg)| (leg - end(k)).norm()).fold(0.0, f64::max)
}

/// What the forces of the joints lack of what moves the plate so.
fn unbalanced(platform: &Platform, Moment { state: s, solution, .. }: &Moment) -> f64 {
    let of =
        |x: &SVector<f64, 25>| (x.fixed_rows::<3>(0).into_owned(), quaternion(&x.fixed_rows::<4>(3).into()));
    let ((_, turn), (_, rate), (acceleration, second)) = (of(&s.q), of(&s.v), of(&solution.accelerations));
    let spin = 2.0 * (turn.conjugate() * rate).imag();
    let inertia = platform.inertia;
    let mut force = platform.m * (acceleration + platform.g * Vector3::z());
    let mut torque = inertia * 2.0 * (turn.conjugate() * second).imag() + spin.cross(&(inertia * spin));
    for (k, corner) in platform.corner.iter().enumerate() {
        let joint = solution.multipliers.fixed_rows::<3>(3 * k).into_owned();
        force -= joint;
        torque -= corner.cross(&UnitQuaternion::new_unchecked(turn).inverse_transform_vector(&joint));
    }
    force.norm().max(torque.norm())
}

fn draw(platform: &Platform, record: &[Moment], file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1200, 900))?;
    let (poses, curves) = root.split_vertically(picture::px(470));
    for (area, t) in poses.split_evenly((1, 3)).iter().zip([0.0, 0.75, 2.0]) {
        draw_pose(platform, &record[(t / TICK).round() as usize], area)?;
    }
    let panels = curves.split_evenly((1, 2));
    draw_forces(record, &panels[0])?;
    draw_deviation(record, platform.g, &panels[1])?;
    root.present()?;
    Ok(())
}

/// From ahead, a little from the right and from above.
fn oblique(p: Vector3<f64>) -> (f64, f64) {
    (0.94 * p[1] - 0.34 * p[0], 0.94 * p[2] - 0.34 * (0.94 * p[0] + 0.34 * p[1]))
}

fn draw_pose(platform: &Platform, moment: &Moment, area: &picture::Area) -> Result<()> {
    let legs = platform.legs(&moment.state);
    let closed = |points: &[Vector3<f64>]| -> Points {
        points.iter().chain(points.first()).map(|&p| oblique(p)).collect()
    };
    let corners: Vec<_> = legs.iter().zip(&platform.foot).map(|(leg, foot)| leg + foot).collect();
    let circle: Vec<_> = (0..100).map(|k| path(ROUND * f64::from(k) / 100.0, platform.g).r[0]).collect();
    let (base, plate, circle) = (closed(&platform.foot), closed(&corners), closed(&circle));
    let ranges = [-0.75..0.75, -0.3..1.25];
    let title = format!("t = {:.2} s", moment.state.t);
    let mut chart = Panel::new(&title, ["", ""]).within(ranges).equal_axes();
    chart.face(base, GREY.mix(0.25));
    for (foot, leg) in platform.foot.iter().zip(&legs) {
        let [thick, thin] = [2.0 * platform.half * leg.normalize(), *leg].map(|end| oblique(foot + end));
        chart.line([oblique(*foot), thin], GREY.stroke_width(2));
        chart.line([oblique(*foot), thick], BLACK.stroke_width(5));
    }
    chart.face(plate.clone(), BLUE.mix(0.35));
    chart.line(plate, BLUE.stroke_width(2));
    chart.curve("where its centre is to go", RED, &circle);
    let centre = moment.state.q.fixed_rows::<3>(0).into_owned();
    chart.dots("its centre", RED, &vec![oblique(centre)]);
    chart.draw(area)
}

fn draw_forces(record: &[Moment], area: &picture::Area) -> Result<()> {
    let of = |k: usize| -> Points { record.iter().map(|m| (m.state.t, m.push[k])).collect() };
    let curves: [Points; 6] = std::array::from_fn(of);
    let mut chart = Panel::new("What the legs push by", ["t in s", "force in N"]);
    let light = |RGBColor(r, g, b): RGBColor| {
        let half = |x: u8| 255 - (255 - x) / 2;
        RGBColor(half(r), half(g), half(b))
    };
    let colors = [BLACK, RED, BLUE].into_iter().flat_map(|color| [color, light(color)]);
    for ((k, curve), color) in curves.iter().enumerate().zip(colors) {
        chart.curve(&format!("leg {}", k + 1), color, curve);
    }
    chart.draw(area)
}

fn draw_deviation(record: &[Moment], g: f64, area: &picture::Area) -> Result<()> {
    let of = |k: usize, unit: f64| -> Points {
        record.iter().map(|m| (m.state.t, unit * deviation(m, g)[k])).collect()
    };
    let (apart, turned) = (of(0, 1e3), of(1, 180.0 / PI));
    let mut chart = Panel::new("How far it is from its path", ["t in s", ""]);
    chart.curve("centre, in mm", BLACK, &apart);
    chart.curve("turned, in degrees", RED, &turned);
    chart.draw(area)
}
