//! Equations of motion of rigid bodies in their angular velocities, to be read.
//!
//! A quaternion q turns a frame with the angular velocity ω, along the axes of the frame: q̇ = ½ q (0, ω). The equations of
//! its four coordinates, projected onto the three rotations that leave |q| = 1 alone, are Poincaré's equations in ω. For a
//! body alone they are Euler's: I ω̇ + ω × I ω = N.

use rustc_hash::FxHashMap;

use super::super::evidence::vanishes;
use super::Twists;
use crate::resolve::{Frame, Problem, Step, cross};
use crate::symbolic::{Graph, Id, Node, Rational};
use crate::variables::{Variable, drift, has_velocity, nodes};

/// Largest number of quaternions for which the equations are derived: beyond it they are too long to be read.
const MOST: usize = 3;

/// Rotation of a frame by a quaternion, with the equations of motion in its angular velocity ω.
///
/// In these, ω and its rate stand as the velocities and accelerations [`rate`](Self::rate) to `rate` + 2, beyond those of
/// the coordinates.
#[derive(Debug)]
pub(crate) struct Turning {
    /// Index of the first of the four coordinates.
    pub(crate) first: usize,
    /// Index of the first component of ω among the velocities.
    pub(crate) rate: usize,
    /// ∂q̇/∂ω, by rows.
    pub(super) spread: [[Id; 3]; 4],
    /// Rotation matrix from the turned axes to the fixed ones, by rows, as it stands in the equations of the coordinates, and
    /// in `rows`; `None` if the frame is carried by one that turns.
    pub(crate) axes: Option<[[[Id; 3]; 3]; 2]>,
    /// Terms with accelerations of each equation, and the others, on the other side.
    pub(crate) rows: [(Id, Vec<Id>); 3],
    /// I and N of Euler's equations I ω̇ + ω × I ω = N, if I is constant and not diagonal: if it is, the equations of the
    /// components are shorter.
    pub(crate) euler: Option<Euler>,
    /// Torque of the constraint forces along the turned axes, without the force that keeps |q| = 1, and the component of the
    /// constraint force along q.
    pub(crate) constraint: ([Id; 3], Id),
}

/// Moments of inertia, and the components of the torque.
#[derive(Debug)]
pub(crate) struct Euler {
    pub(crate) inertia: [[Id; 3]; 3],
    /// Terms with accelerations of other coordinates, on the side of I ω̇.
    pub(crate) coupled: [Id; 3],
    pub(crate) torque: [Id; 3],
}

/// Rotations by quaternions, and what is printed in their angular velocities.
#[derive(Debug, Default)]
pub(crate) struct Turnings {
    pub(crate) all: Vec<Turning>,
    /// Equations of other coordinates whose accelerations are coupled to ω̇, each with the index of its coordinate.
    pub(crate) coupled: Vec<(usize, (Id, Vec<Id>))>,
    /// E of an L that is quadratic in the velocities, without the ½ ω·I ω of each [`Euler`], and dE/dt.
    pub(crate) energy: Option<[Id; 2]>,
    /// Definitions as they stand in the equations in ω, each with the definition itself.
    pub(crate) renamed: Vec<(Id, Id)>,
    /// Nodes as they stand in the equations in ω, by what they stand for.
    pub(super) new: FxHashMap<Id, Id>,
}

impl Turnings {
    /// Empty if a rotation depends on more than a quaternion, or if fields switch constraints on and off.
    pub(in super::super) fn of(graph: &mut Graph, problem: &Problem, energy_rate: Id) -> Self {
        let quaternions = &problem.quaternions;
        let is_short = (1..=MOST).contains(&quaternions.len()) && problem.parameters.switches.is_empty();
        let twists = Some(()).filter(|()| is_short).and_then(|()| Twists::of(graph, problem));
        twists.and_then(|twists| twists.turnings(graph, energy_rate)).unwrap_or_default()
    }
}

impl Twists<'_> {
    fn turnings(&self, graph: &mut Graph, energy_rate: Id) -> Option<Turnings> {
        let n = self.problem.coordinates.len();
        let quaternions = &self.problem.quaternions;
        (self.outer == n + 3 * quaternions.len()).then_some(())?;
        let mut spins = Vec::new();
        for k in 0..quaternions.len() {
            spins.push(self.spin(graph, k)?);
        }
        let equations = OuterEquations {
            mass: self.mass(graph),
            linear: self.handed_back(graph, drift, self.outer),
            rows: self.rows(graph, self.outer),
        };
        let new = self.in_angular_velocities(graph, &spins);
        let mut all = Vec::new();
        for spin in &spins {
            all.push(self.turning(graph, spin, &spins, &equations, &new)?);
        }
        let is_quaternion = |i: usize| spins.iter().any(|spin| (spin.first..spin.first + 4).contains(&i));
        let is_coupled = |i: &usize| equations.mass[*i][n..].iter().any(|&entry| entry != Id::ZERO);
        let coupled = (0..n).filter(|&i| !is_quaternion(i)).filter(is_coupled);
        let coupled = coupled.map(|i| (i, equations.row(graph, i, &|_, values| values[i], &new))).collect();
        let energy = [self.energy(graph, &equations.mass, &all, &new), graph.replaced(energy_rate, &new)];
        let is_quadratic = !has_velocity(graph, &equations.mass.concat());
        let definitions: Vec<Id> = self.problem.names.keys().copied().collect();
        let renamed = definitions.into_iter().map(|id| (graph.replaced(id, &new), id)).collect();
        Some(Turnings { all, coupled, energy: Some(energy).filter(|_| is_quadratic), renamed, new })
    }

    /// ½ wᵀM w − L₀, where w are the outer velocities and L₀ is L at rest.
    fn energy(
        &self,
        graph: &mut Graph,
        mass: &[Vec<Id>],
        turnings: &[Turning],
        new: &FxHashMap<Id, Id>,
    ) -> Id {
        let w = nodes(graph, mass.len(), Variable::Velocity);
        let apart = |i: usize, j: usize| {
            let of = |turning: &&Turning| [i, j].iter().all(|k| (turning.rate..turning.rate + 3).contains(k));
            turnings.iter().find(of).is_some_and(|turning| turning.euler.is_some())
        };
        let mut twice = Id::ZERO;
        for i in 0..w.len() {
            let row: Vec<Id> =
                (0..w.len()).map(|j| if apart(i, j) { Id::ZERO } else { mass[i][j] }).collect();
            let momentum = graph.dot(&row, &w);
            let part = graph.mul(momentum, w[i]);
            twice = graph.add(twice, part);
        }
        let half = graph.number(Rational::new(1, 2));
        let kinetic = graph.mul(half, twice);
        let rest = w[..self.problem.coordinates.len()].iter().map(|&velocity| (velocity, Id::ZERO)).collect();
        let at_rest = graph.replaced(self.problem.lagrangian, &rest);
        let energy = graph.sub(kinetic, at_rest);
        graph.replaced(energy, new)
    }

    /// The `k`-th rotation; `None` if its angular velocity is another than that of the quaternion.
    fn spin(&self, graph: &mut Graph, k: usize) -> Option<Spin> {
        let n = self.problem.coordinates.len();
        let rows = &self.velocities.rows[3 * k..3 * k + 3];
        let entries = |row: &Vec<Id>| row.iter().position(|&entry| entry != Id::ZERO);
        let first = *self.problem.quaternions.iter().find(|&&first| {
            rows.iter().all(|row| entries(row).is_some_and(|at| (first..first + 4).contains(&at)))
        })?;
        let q = nodes(graph, n, Variable::Coordinate);
        let spread = spread(graph, [q[first], q[first + 1], q[first + 2], q[first + 3]]);
        for (i, row) in rows.iter().enumerate() {
            for j in [0, 1, 2] {
                let column = spread.map(|row| row[j]);
                let turned = graph.dot(&row[first..first + 4], &column);
                let expected = if i == j { Id::ONE } else { Id::ZERO };
                let off = graph.sub(turned, expected);
                vanishes(graph, self.problem, off)?;
            }
        }
        Some(Spin { first, number: n + 3 * k, spread })
    }

    /// What stands in place of nodes: new velocities for ω, q̇ by ω, 1 for |q|², and one for the other of two equal
    /// moments of inertia.
    fn in_angular_velocities(&self, graph: &mut Graph, spins: &[Spin]) -> FxHashMap<Id, Id> {
        let mut new = FxHashMap::default();
        let q = nodes(graph, self.problem.coordinates.len(), Variable::Coordinate);
        for &Spin { first, number, ref spread } in spins {
            let rates = [0, 1, 2].map(|axis| graph.symbol(Variable::Velocity(number + axis).symbol()));
            new.extend((0..3).map(|axis| (self.velocities.nodes[number + axis], rates[axis])));
            for (a, row) in spread.iter().enumerate() {
                let rate = graph.dot(row, &rates);
                new.insert(graph.symbol(Variable::Velocity(first + a).symbol()), rate);
            }
            let square = graph.dot(&q[first..first + 4], &q[first..first + 4]);
            new.insert(square, Id::ONE);
        }
        for body in &self.bodies {
            let equal = body.inertia.iter().flatten().filter_map(|&entry| equal(graph, entry));
            new.extend(equal.map(|[one, other]| (other, one)));
        }
        new
    }

    fn turning(
        &self,
        graph: &mut Graph,
        spin: &Spin,
        spins: &[Spin],
        equations: &OuterEquations,
        new: &FxHashMap<Id, Id>,
    ) -> Option<Turning> {
        let OuterEquations { mass, linear, .. } = equations;
        let is_quaternion = |j: usize| spins.iter().any(|spin| (spin.first..spin.first + 4).contains(&j));
        // A mass of the coordinates of a quaternion belongs to no rigid body.
        let is_massless = |i: usize| mass[i].iter().all(|&entry| entry == Id::ZERO);
        (0..linear.len()).all(|i| !is_quaternion(i) || is_massless(i)).then_some(())?;
        let rows = [0, 1, 2].map(|axis| {
            let number = spin.number + axis;
            let column = spin.spread.map(|row| row[axis]);
            let along = |graph: &mut Graph, values: &[Id]| {
                let by_coordinates = graph.dot(&column, &values[spin.first..spin.first + 4]);
                graph.add(values[number], by_coordinates)
            };
            equations.row(graph, number, &along, new)
        });
        let entry = |i: usize, j: usize| mass[spin.number + i][spin.number + j];
        let inertia = [0, 1, 2].map(|i| [0, 1, 2].map(|j| graph.replaced(entry(i, j), new)));
        let euler = self.euler(graph, spin.number, &rows, inertia);
        let axes = self.axes(spin.number);
        let axes = axes.map(|axes| [axes, axes.map(|row| row.map(|entry| graph.replaced(entry, new)))]);
        let constraint = equations.constraint(graph, spin, new);
        let &Spin { first, number: rate, spread } = spin;
        Some(Turning { first, rate, spread, axes, rows, euler, constraint })
    }

    /// Axes of the frame that turns at this angular velocity, if the frame before does not turn.
    fn axes(&self, number: usize) -> Option<[[Id; 3]; 3]> {
        let rate = self.velocities.nodes[number];
        let frames = &self.problem.frames;
        let frame = frames.iter().find(|frame| match &frame.step {
            Step::Turned(turned) => turned.rate[0] == rate,
            _ => false,
        })?;
        (frames[frame.before].axes == Frame::fixed().axes).then_some(frame.axes)
    }
}

impl Twists<'_> {
    fn euler(
        &self,
        graph: &mut Graph,
        number: usize,
        rows: &[(Id, Vec<Id>); 3],
        inertia: [[Id; 3]; 3],
    ) -> Option<Euler> {
        let is_parameter = |symbol| matches!(Variable::of(symbol), Variable::Parameter(_));
        let is_constant = graph.symbols(&inertia.concat()).all(is_parameter);
        let is_diagonal = (0..3).all(|i| (0..3).all(|j| i == j || inertia[i][j] == Id::ZERO));
        (is_constant && !is_diagonal).then_some(())?;
        let [rate, acceleration] = [Variable::Velocity, Variable::Acceleration]
            .map(|variable| [0, 1, 2].map(|axis| graph.symbol(variable(number + axis).symbol())));
        let mut coupled = [Id::ZERO; 3];
        for ((others, row), (left, _)) in coupled.iter_mut().zip(&inertia).zip(rows) {
            let turned = graph.dot(row, &acceleration);
            *others = graph.sub(*left, turned);
            if vanishes(graph, self.problem, *others).is_some() {
                *others = Id::ZERO;
            }
        }
        let momentum = inertia.map(|row| graph.dot(&row, &rate));
        let gyroscopic = cross(rate, momentum, graph);
        let torque =
            [0, 1, 2].map(|axis| graph.total([rows[axis].1.as_slice(), &[gyroscopic[axis]]].concat()));
        Some(Euler { inertia, coupled, torque })
    }
}

/// ∂q̇/∂ω of the quaternion q, from q̇ = ½ q ω.
fn spread(graph: &mut Graph, [w, x, y, z]: [Id; 4]) -> [[Id; 3]; 4] {
    let [minus_x, minus_y, minus_z] = [x, y, z].map(|entry| graph.neg(entry));
    let twice = [[minus_x, minus_y, minus_z], [w, minus_z, y], [z, w, minus_x], [minus_y, x, w]];
    let half = graph.number(Rational::new(1, 2));
    twice.map(|row| row.map(|entry| graph.mul(half, entry)))
}

/// Two parameters of which this is the mean, as those on both sides of the diagonal of a matrix of inertia, which must be
/// equal.
fn equal(graph: &Graph, entry: Id) -> Option<[Id; 2]> {
    let is_parameter = |id: Id| match graph.node(id) {
        Node::Symbol(symbol) => matches!(Variable::of(*symbol), Variable::Parameter(_)),
        _ => false,
    };
    let half = Rational::new(1, 2);
    match graph.node(entry) {
        Node::Sum(terms) => match terms[..] {
            [(one, c), (other, d)] if c == half && d == half && is_parameter(one) && is_parameter(other) => {
                Some([one.min(other), one.max(other)])
            }
            _ => None,
        },
        Node::Defined(inner) => equal(graph, *inner),
        _ => None,
    }
}

impl OuterEquations {
    /// Accelerations and the other terms of the equation of velocity `number`; `along` takes its part of the forces, and of
    /// each row of F.
    fn row(
        &self,
        graph: &mut Graph,
        number: usize,
        along: &dyn Fn(&mut Graph, &[Id]) -> Id,
        new: &FxHashMap<Id, Id>,
    ) -> (Id, Vec<Id>) {
        let accelerations = nodes(graph, self.mass.len(), Variable::Acceleration);
        let multipliers = nodes(graph, self.rows.len(), Variable::Multiplier);
        let left = graph.dot(&self.mass[number], &accelerations);
        let mut right = vec![along(graph, &self.linear)];
        for (row, &multiplier) in self.rows.iter().zip(&multipliers) {
            let entry = along(graph, row);
            right.push(graph.mul(entry, multiplier));
        }
        let right = right.into_iter().map(|part| graph.replaced(part, new)).filter(|&part| part != Id::ZERO);
        let right = right.collect();
        (graph.replaced(left, new), right)
    }
}

impl OuterEquations {
    /// Constraint force on a quaternion: its torque along the turned axes, and its component along q.
    fn constraint(&self, graph: &mut Graph, spin: &Spin, new: &FxHashMap<Id, Id>) -> ([Id; 3], Id) {
        let &Spin { first, number, ref spread } = spin;
        let multipliers = nodes(graph, self.rows.len(), Variable::Multiplier);
        let q = nodes(graph, first + 4, Variable::Coordinate);
        let (mut torque, mut along) = ([Id::ZERO; 3], Id::ZERO);
        let add = |graph: &mut Graph, sum: &mut Id, entry: Id, multiplier: Id| {
            let part = graph.mul(entry, multiplier);
            *sum = graph.add(*sum, part);
        };
        for (row, &multiplier) in self.rows.iter().zip(&multipliers) {
            let of_coordinates = &row[first..first + 4];
            for (axis, sum) in torque.iter_mut().enumerate() {
                let entry = graph.dot(&spread.map(|row| row[axis]), of_coordinates);
                let entry = graph.add(entry, row[number + axis]);
                add(graph, sum, entry, multiplier);
            }
            let entry = graph.dot(&q[first..], of_coordinates);
            add(graph, &mut along, entry, multiplier);
        }
        (torque.map(|sum| graph.replaced(sum, new)), graph.replaced(along, new))
    }
}

/// A quaternion, the index of its angular velocity among the velocities, and ∂q̇/∂ω.
struct Spin {
    first: usize,
    number: usize,
    spread: [[Id; 3]; 4],
}

/// Equations over the rates of the outer velocities: M, h, and the rows of the constraints.
struct OuterEquations {
    mass: Vec<Vec<Id>>,
    linear: Vec<Id>,
    rows: Vec<Vec<Id>>,
}
