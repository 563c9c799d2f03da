//! Mass matrix of rigid bodies by the composite-rigid-body algorithm: all bodies beyond a joint move as one while the
//! later joints are at rest (Walker and Orin, *Journal of Dynamic Systems, Measurement, and Control* 104, 1982;
//! Featherstone, *Rigid Body Dynamics Algorithms*, chapter 6).

use super::super::euler_lagrange::hessian;
use super::components::Twists;
use crate::resolve::{Frame, Step, Triple, cross, symmetric};
use crate::symbolic::{Graph, Id, Rational};

/// Composite body of a frame, in its axes: mass, first moment (mass times position of the centre), and inertia about
/// the origin.
#[derive(Clone, Copy)]
struct Carried {
    mass: Id,
    moment: Triple,
    inertia: [Triple; 3],
}

/// Momentum, and angular momentum about the origin of a frame.
#[derive(Clone, Copy)]
struct Momentum {
    moving: Triple,
    turning: Triple,
}

impl Twists<'_> {
    /// Mass matrix over the [outer velocities](Twists::outer). Bodies contribute by the recursion from frame
    /// to frame, all other terms of L by differentiation.
    pub(super) fn mass(&self, graph: &mut Graph) -> Vec<Vec<Id>> {
        let momenta = graph.gradient_to(self.others, &self.velocities.nodes[..self.outer]);
        let mut mass = hessian(graph, &momenta, &self.velocities.nodes[..self.outer]);
        let carried = self.carried_by_frames(graph);
        for (frame, carried) in carried.into_iter().enumerate().rev() {
            if let Some(carried) = carried {
                self.add_columns(graph, frame, &carried, &mut mass);
            }
        }
        mass
    }

    /// Composite body of each frame: its own bodies and those of all frames after it.
    fn carried_by_frames(&self, graph: &mut Graph) -> Vec<Option<Carried>> {
        let frames = &self.problem.frames;
        let mut carried: Vec<Option<Carried>> = vec![None; frames.len()];
        for (number, frame) in frames.iter().enumerate().rev() {
            for body in self.bodies.iter().filter(|body| body.frame == number) {
                let own = Carried { mass: body.mass, moment: body.moment, inertia: body.inertia };
                carried[number] = Some(own.and(carried[number], graph));
            }
            if let (Some(all), true) = (carried[number], number > 0) {
                let before = all.before(&frame.step, graph);
                carried[frame.before] = Some(before.and(carried[frame.before], graph));
            }
        }
        carried
    }

    /// Adds the entries that couple the coordinates of this frame with each other and with the coordinates of earlier
    /// frames.
    fn add_columns(&self, graph: &mut Graph, frame: usize, carried: &Carried, mass: &mut [Vec<Id>]) {
        let own = self.columns_of(graph, frame);
        for &(j, column) in &own {
            let mut momentum = carried.momentum(column, &self.problem.frames[frame].step, graph);
            for &(k, other) in own.iter().filter(|(k, _)| *k <= j) {
                let entry = momentum.along(other, &self.problem.frames[frame].step, graph);
                add(graph, mass, (j, k), entry);
            }
            let mut at = frame;
            while at != 0 {
                let Frame { before, step, .. } = &self.problem.frames[at];
                momentum = momentum.before(step, graph);
                at = *before;
                let step = &self.problem.frames[at].step;
                for (k, other) in self.columns_of(graph, at) {
                    let entry = momentum.along(other, step, graph);
                    // A coordinate that moves both frames contributes to its diagonal entry twice.
                    let twice = Rational::from_integer(if j == k { 2 } else { 1 });
                    let entry = graph.sum([(entry, twice)]);
                    add(graph, mass, (j, k), entry);
                }
            }
        }
    }

    /// For each [outer velocity](Twists::outer) that the step to a frame depends on, its index and the part
    /// of the frame's twist due to a unit rate.
    fn columns_of(&self, graph: &mut Graph, frame: usize) -> Vec<(usize, Triple)> {
        match &self.problem.frames[frame].step {
            Step::None => Vec::new(),
            Step::Moved(moved) => self.columns(graph, moved.rate),
            Step::Turned(turned) => self.columns(graph, turned.rate),
        }
    }
}

fn add(graph: &mut Graph, mass: &mut [Vec<Id>], (j, k): (usize, usize), entry: Id) {
    let sum = graph.add(mass[j][k], entry);
    (mass[j][k], mass[k][j]) = (sum, sum);
}

impl Carried {
    fn and(self, other: Option<Self>, graph: &mut Graph) -> Self {
        let Some(other) = other else { return self };
        let mut both = |x: Id, y: Id| {
            let sum = graph.add(x, y);
            graph.defined(sum)
        };
        Self {
            mass: both(self.mass, other.mass),
            moment: pairs(self.moment, other.moment).map(|(x, y)| both(x, y)),
            inertia: symmetric(|i, j| both(self.inertia[i][j], other.inertia[i][j])),
        }
    }

    /// Transforms the composite body to the preceding frame.
    fn before(self, step: &Step, graph: &mut Graph) -> Self {
        match step {
            Step::None => self,
            Step::Moved(moved) => self.moved(moved.by, graph),
            Step::Turned(turned) => self.turned(turned.by, graph),
        }
    }

    /// Shifts every position r to s + r. The first moment h becomes h' = h + m s. For different i, j, k the
    /// entry J_ij of the inertia decreases by s_i h_j + h'_i s_j. With p_i = s_i (h_i + h'_i), J_ii grows by
    /// p_j + p_k.
    fn moved(self, s: Triple, graph: &mut Graph) -> Self {
        let moment = pairs(self.moment, s).map(|(h, s)| {
            let shift = graph.mul(self.mass, s);
            let sum = graph.add(h, shift);
            graph.defined(sum)
        });
        let products: Triple = std::array::from_fn(|i| {
            let both = graph.add(self.moment[i], moment[i]);
            let both = graph.mul(s[i], both);
            graph.defined(both)
        });
        let one = Rational::from_integer(1);
        let inertia = symmetric(|i, j| {
            let terms = if i == j {
                let [b, c] = [(i + 1) % 3, (i + 2) % 3];
                [(self.inertia[i][i], one), (products[b], one), (products[c], one)]
            } else {
                let [x, y] = [graph.mul(s[i], self.moment[j]), graph.mul(moment[i], s[j])];
                [(self.inertia[i][j], one), (x, -one), (y, -one)]
            };
            let sum = graph.sum(terms);
            graph.defined(sum)
        });
        Self { mass: self.mass, moment, inertia }
    }

    /// Rotates h to E h, and J to E J Eᵀ.
    fn turned(self, by: [Triple; 3], graph: &mut Graph) -> Self {
        let moment = by.map(|row| graph.dot(&row, &self.moment)).map(|entry| graph.defined(entry));
        // J Eᵀ, by the rows of E.
        let half = by.map(|row| {
            self.inertia.map(|inertia| {
                let entry = graph.dot(&inertia, &row);
                graph.defined(entry)
            })
        });
        let inertia = symmetric(|i, j| {
            let entry = graph.dot(&by[i], &half[j]);
            graph.defined(entry)
        });
        Self { mass: self.mass, moment, inertia }
    }

    /// Momentum of the composite body if it rotates with the angular velocity `rate`, for a rotation `step`, or
    /// translates with the velocity `rate`.
    fn momentum(&self, rate: Triple, step: &Step, graph: &mut Graph) -> Momentum {
        let momentum = match step {
            Step::Turned(_) => Momentum {
                moving: cross(rate, self.moment, graph),
                turning: self.inertia.map(|row| graph.dot(&row, &rate)),
            },
            Step::Moved(_) | Step::None => Momentum {
                moving: rate.map(|component| graph.mul(self.mass, component)),
                turning: cross(self.moment, rate, graph),
            },
        };
        momentum.named(graph)
    }
}

impl Momentum {
    fn named(self, graph: &mut Graph) -> Self {
        let mut named = |vector: Triple| vector.map(|component| graph.defined(component));
        Self { moving: named(self.moving), turning: named(self.turning) }
    }

    /// Transforms the momentum to the preceding frame.
    fn before(self, step: &Step, graph: &mut Graph) -> Self {
        let before = match step {
            Step::None => self,
            Step::Moved(moved) => {
                let arm = cross(moved.by, self.moving, graph);
                let turning = pairs(self.turning, arm).map(|(x, y)| graph.add(x, y));
                Self { moving: self.moving, turning }
            }
            Step::Turned(turned) => {
                let mut turn = |vector: Triple| turned.by.map(|row| graph.dot(&row, &vector));
                Self { moving: turn(self.moving), turning: turn(self.turning) }
            }
        };
        before.named(graph)
    }

    /// Component of the momentum along the rate `rate` of a step.
    fn along(&self, rate: Triple, step: &Step, graph: &mut Graph) -> Id {
        match step {
            Step::Turned(_) => graph.dot(&rate, &self.turning),
            Step::Moved(_) | Step::None => graph.dot(&rate, &self.moving),
        }
    }
}

fn pairs(x: Triple, y: Triple) -> [(Id, Id); 3] {
    std::array::from_fn(|i| (x[i], y[i]))
}
