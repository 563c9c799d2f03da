//! Newton–Euler equations of every link, with the forces and torques in the joints as unknowns.
//!
//! Unknowns of each link are the acceleration of its origin, its angular acceleration, and the force and the torque
//! about its origin that the link before exerts on it, all along the fixed axes. The accelerations of the
//! coordinates and the multipliers follow.
//!
//! Equations of each link are its acceleration relative to the link before, and the balance of forces and torques.
//! For each coordinate, the joint forces do the given work along it. The ties follow.

use super::algebra::{
    Matrix, UNIT, Vector, cross, difference, dot, norm, product, scaled, skew, solved, sum, times, transposed,
};
use super::model::{Body, Jet, Joint, Link, Load, Model, Motion, Point, Pose, Tie};

/// Accelerations, and multipliers in the order of the ties.
pub(super) struct Solution {
    pub(super) accelerations: Vec<f64>,
    pub(super) multipliers: Vec<f64>,
    /// Smallest pivot. If it is tiny, the solution cannot be trusted.
    pub(super) pivot: f64,
}

pub(super) fn solve(model: &Model) -> Solution {
    let mut system = System::new(model);
    for link in 1..=model.links.len() {
        system.kinematics(link);
        system.balance(link);
    }
    model.bodies.iter().for_each(|body| system.body(body));
    model.loads.iter().for_each(|load| system.load(load));
    system.works();
    system.ties();
    let (solution, pivot) = solved(system.rows, system.right);
    let (n, links) = (model.coordinates.len(), WIDTH * model.links.len());
    let multipliers = solution[links + n..].to_vec();
    Solution { accelerations: solution[links..links + n].to_vec(), multipliers, pivot }
}

/// Unknowns of a link, three numbers each, and its equations by the same names: acceleration and angular
/// acceleration relative to the link before, balance of forces and of torques.
#[derive(Clone, Copy)]
enum Part {
    Acceleration,
    Turning,
    Force,
    Torque,
}
use Part::{Acceleration, Force, Torque, Turning};

const WIDTH: usize = 12;

struct System<'m> {
    model: &'m Model,
    poses: Vec<Pose>,
    rows: Vec<Vec<f64>>,
    right: Vec<f64>,
}

impl<'m> System<'m> {
    fn new(model: &'m Model) -> Self {
        let multipliers: usize = model.ties.iter().map(|tie| tie.rows()).sum();
        let size = WIDTH * model.links.len() + model.coordinates.len() + multipliers;
        let (rows, right) = (vec![vec![0.0; size]; size], vec![0.0; size]);
        Self { model, poses: model.poses(), rows, right }
    }

    fn add(&mut self, row: usize, column: usize, entry: f64) {
        self.rows[row][column] += entry;
    }

    /// Adds a matrix times three unknowns of a link to three equations. The fixed link has no unknowns.
    fn add_block(&mut self, row: usize, (link, part): (usize, Part), block: Matrix) {
        if link > 0 {
            let column = at(link, part);
            (0..3).for_each(|i| (0..3).for_each(|j| self.add(row + i, column + j, block[i][j])));
        }
    }

    fn add_right(&mut self, row: usize, vector: Vector) {
        (0..3).for_each(|i| self.right[row + i] += vector[i]);
    }

    fn add_column(&mut self, row: usize, column: usize, vector: Vector) {
        (0..3).for_each(|i| self.add(row + i, column, vector[i]));
    }

    fn coordinate(&self, i: usize) -> usize {
        WIDTH * self.model.links.len() + i
    }

    /// Adds the kinematics of a joint: a' = a + ω̇ × s + ω × (ω × s) + 2 ω × ṡ + s̈ for a translation s, ω̇' = ω̇ +
    /// ω × ρ + ρ̇ for a rotation at the rate ρ.
    fn kinematics(&mut self, link: usize) {
        let Link { before, joint } = &self.model.links[link - 1];
        let (pose, own) = (self.poses[*before], self.poses[link]);
        let [moves, turns] = [at(link, Acceleration), at(link, Turning)];
        for (row, part) in [(moves, Acceleration), (turns, Turning)] {
            self.add_block(row, (link, part), UNIT);
            self.add_block(row, (*before, part), UNIT.map(|line| scaled(-1.0, line)));
        }
        self.add_right(turns, cross(pose.turning, difference(own.turning, pose.turning)));
        match joint {
            Joint::Slide(by) => {
                let arm = difference(own.origin, pose.origin);
                let across = skew(arm);
                self.add_block(moves, (*before, Turning), across);
                let relative = times(pose.axes, by.each_ref().map(|motion| motion.jet(self.model).rate));
                let coriolis = scaled(2.0, cross(pose.turning, relative));
                let centripetal = cross(pose.turning, cross(pose.turning, arm));
                self.add_right(moves, sum([centripetal, coriolis]));
                let axes = transposed(pose.axes);
                by.iter().zip(axes).for_each(|(motion, axis)| self.accelerated(moves, motion, axis));
            }
            Joint::Turn(axis, angle) => self.accelerated(turns, angle, times(pose.axes, *axis)),
            Joint::Placed(_) => {}
            Joint::Ball(first) => {
                for (k, column) in self.model.ball(&pose, *first).into_iter().enumerate() {
                    self.add_column(turns, self.coordinate(first + k), scaled(-1.0, column));
                }
            }
        }
    }

    /// Adds the acceleration by a motion along an axis.
    fn accelerated(&mut self, row: usize, motion: &Motion, axis: Vector) {
        let jet = motion.jet(self.model);
        for (i, slope) in jet.slopes {
            self.add_column(row, self.coordinate(i), scaled(-slope, axis));
        }
        self.add_right(row, scaled(jet.drift, axis));
    }

    /// Adds the joint force and torque on a link, and the reaction on the link before.
    fn balance(&mut self, link: usize) {
        let before = self.model.links[link - 1].before;
        let arm = difference(self.poses[link].origin, self.poses[before].origin);
        let minus = UNIT.map(|line| scaled(-1.0, line));
        for part in [Force, Torque] {
            self.add_block(at(link, part), (link, part), UNIT);
            if before > 0 {
                self.add_block(at(before, part), (link, part), minus);
            }
        }
        if before > 0 {
            self.add_block(at(before, Torque), (link, Force), skew(scaled(-1.0, arm)));
        }
    }

    /// Adds m a of the centre and the rate of the angular momentum about the link's origin, with m and I constant.
    fn body(&mut self, body: &Body) {
        let &Body { centre, inertia, .. } = body;
        let (link, pose) = (centre.link, self.poses[centre.link]);
        let [mass, growth] = [&body.mass, &body.growth].map(|motion| motion.jet(self.model));
        let arm = times(pose.axes, centre.at);
        let per_growth = product(product(pose.axes, inertia), transposed(pose.axes));
        let own = per_growth.map(|line| scaled(growth.value, line));
        self.growing(body, per_growth, [&mass, &growth]);
        let mass = mass.value;
        let [force, torque] = [at(link, Force), at(link, Torque)];
        // −m (a + ω̇ × c), and c × that force
        let (across, weight) = (skew(arm), |m: Matrix, c: f64| m.map(|line| scaled(c, line)));
        self.add_block(force, (link, Acceleration), weight(UNIT, -mass));
        self.add_block(force, (link, Turning), weight(across, mass));
        self.add_block(torque, (link, Acceleration), weight(across, -mass));
        self.add_block(torque, (link, Turning), weight(product(across, across), mass));
        self.add_block(torque, (link, Turning), weight(own, -1.0));
        let centripetal = scaled(mass, cross(pose.turning, cross(pose.turning, arm)));
        self.add_right(force, centripetal);
        let gyroscopic = cross(pose.turning, times(own, pose.turning));
        self.add_right(torque, sum([cross(arm, centripetal), gyroscopic]));
        self.push(centre, scaled(mass, body.gravity));
    }

    /// Adds ṁ u and İ ω, and the derivatives of m (u²/2 + g·r) and ω·Iω/2 by the coordinates that m and I depend
    /// on.
    fn growing(&mut self, body: &Body, per_growth: Matrix, [mass, growth]: [&Jet; 2]) {
        let (place, velocity) = self.place(body.centre);
        let turning = self.poses[body.centre.link].turning;
        let spin = times(per_growth, turning);
        self.push(body.centre, scaled(-mass.rate, velocity));
        if body.centre.link > 0 {
            self.add_right(at(body.centre.link, Torque), scaled(growth.rate, spin));
        }
        let per_mass = dot(velocity, velocity) / 2.0 + dot(body.gravity, place);
        for (jet, energy) in [(mass, per_mass), (growth, dot(turning, spin) / 2.0)] {
            for &(i, slope) in &jet.slopes {
                let row = self.coordinate(i);
                self.right[row] += slope * energy;
            }
        }
    }

    fn load(&mut self, load: &Load) {
        match *load {
            Load::Given(point, force) => self.push(point, force),
            Load::Torque(link, torque) => {
                let torque = times(self.poses[link].axes, torque);
                self.add_right(at(link, Torque), scaled(-1.0, torque));
            }
            Load::Spring(from, to, stiffness, rest) => {
                let arm = difference(self.place(to).0, self.place(from).0);
                let pull = scaled(stiffness * (1.0 - rest / norm(arm)), arm);
                self.push(from, pull);
                self.push(to, scaled(-1.0, pull));
            }
            Load::Damper(point, c) => self.push(point, scaled(-c, self.place(point).1)),
            Load::Magnetic(point, field) => self.push(point, cross(self.place(point).1, field)),
        }
    }

    /// Adds a force at a point.
    fn push(&mut self, point: Point, force: Vector) {
        if point.link > 0 {
            let arm = times(self.poses[point.link].axes, point.at);
            self.add_right(at(point.link, Force), scaled(-1.0, force));
            self.add_right(at(point.link, Torque), cross(force, arm));
        }
    }

    /// Adds a force at a point that is an unknown times a vector.
    fn push_by(&mut self, point: Point, force: Vector, unknown: usize) {
        if point.link > 0 {
            let arm = times(self.poses[point.link].axes, point.at);
            self.add_column(at(point.link, Force), unknown, force);
            self.add_column(at(point.link, Torque), unknown, cross(arm, force));
        }
    }

    fn place(&self, point: Point) -> (Vector, Vector) {
        self.model.place(&self.poses, point)
    }

    /// Adds, for each coordinate, the work of the joint forces along it and the given force.
    fn works(&mut self) {
        for (k, Link { before, joint }) in self.model.links.iter().enumerate() {
            let (pose, link) = (self.poses[*before], k + 1);
            match joint {
                Joint::Slide(by) => {
                    let axes = transposed(pose.axes);
                    by.iter().zip(axes).for_each(|(motion, axis)| self.work((link, Force), motion, axis));
                }
                Joint::Turn(axis, angle) => self.work((link, Torque), angle, times(pose.axes, *axis)),
                Joint::Placed(_) => {}
                Joint::Ball(first) => {
                    for (k, column) in self.model.ball(&pose, *first).into_iter().enumerate() {
                        self.work((link, Torque), &Motion::of(first + k), column);
                    }
                }
            }
        }
        for (i, &force) in self.model.forces.iter().enumerate() {
            let row = self.coordinate(i);
            self.right[row] += force;
        }
    }

    fn work(&mut self, (link, part): (usize, Part), motion: &Motion, axis: Vector) {
        for (i, slope) in motion.jet(self.model).slopes {
            let row = self.coordinate(i);
            (0..3).for_each(|k| self.add(row, at(link, part) + k, slope * axis[k]));
        }
    }

    fn ties(&mut self) {
        let mut row = self.coordinate(self.model.coordinates.len());
        for tie in &self.model.ties {
            self.tie(tie, row);
            row += tie.rows();
        }
    }

    fn tie(&mut self, tie: &Tie, row: usize) {
        match *tie {
            Tie::Together(a, b) => {
                for (k, axis) in UNIT.into_iter().enumerate() {
                    self.tied(row + k, a, axis);
                    self.tied(row + k, b, scaled(-1.0, axis));
                }
            }
            Tie::Distance(a, b) => {
                let ((r, v), (s, w)) = (self.place(a), self.place(b));
                let (arm, rate) = (scaled(2.0, difference(r, s)), difference(v, w));
                self.tied(row, a, arm);
                self.tied(row, b, scaled(-1.0, arm));
                self.right[row] -= 2.0 * dot(rate, rate);
            }
            Tie::Level(point, axis) => self.tied(row, point, UNIT[axis]),
            Tie::Skate(point, axis) => {
                let pose = self.poses[point.link];
                let direction = times(pose.axes, UNIT[axis]);
                self.tied(row, point, direction);
                self.right[row] -= dot(cross(pose.turning, direction), self.place(point).1);
            }
            Tie::Unit(first) => {
                let q = self.model.quaternion(first);
                for (k, entry) in q.into_iter().enumerate() {
                    let i = self.coordinate(first + k);
                    self.add(row, i, 2.0 * entry);
                    self.add(i, row, -2.0 * entry);
                    self.right[row] -= 2.0 * self.model.velocities[first + k].powi(2);
                }
            }
        }
    }

    /// Adds the acceleration of a point along a direction to the equation of a tie, and a force along it to the
    /// point. The multiplier is the unknown of that force.
    fn tied(&mut self, row: usize, point: Point, direction: Vector) {
        let pose = self.poses[point.link];
        let arm = times(pose.axes, point.at);
        let turning = cross(arm, direction);
        if point.link > 0 {
            for k in 0..3 {
                self.add(row, at(point.link, Acceleration) + k, direction[k]);
                self.add(row, at(point.link, Turning) + k, turning[k]);
            }
        }
        let centripetal = cross(pose.turning, cross(pose.turning, arm));
        self.right[row] -= dot(direction, centripetal);
        self.push_by(point, direction, row);
    }
}

fn at(link: usize, part: Part) -> usize {
    let offset = match part {
        Acceleration => 0,
        Turning => 3,
        Force => 6,
        Torque => 9,
    };
    WIDTH * (link - 1) + offset
}

impl Tie {
    /// Number of multipliers of the tie.
    fn rows(&self) -> usize {
        match self {
            Self::Together(..) => 3,
            _ => 1,
        }
    }
}
