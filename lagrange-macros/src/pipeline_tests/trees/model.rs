//! A system of rigid bodies in numbers, and where everything in it is and how it moves at one state.

use super::algebra::{
    Matrix, UNIT, Vector, cross, dot, product, quaternion_product, scaled, sum, times, turn, turn_by,
};

#[derive(Clone, Debug, Default)]
pub(super) struct Model {
    pub(super) time: f64,
    pub(super) coordinates: Vec<f64>,
    pub(super) velocities: Vec<f64>,
    /// After the fixed one, which is number 0 and not among them: link k is `links[k - 1]`.
    pub(super) links: Vec<Link>,
    pub(super) bodies: Vec<Body>,
    pub(super) loads: Vec<Load>,
    /// Q of each coordinate.
    pub(super) forces: Vec<f64>,
    pub(super) ties: Vec<Tie>,
}

/// What a joint leads to from the link before.
#[derive(Clone, Debug)]
pub(super) struct Link {
    pub(super) before: usize,
    pub(super) joint: Joint,
}

#[derive(Clone, Debug)]
pub(super) enum Joint {
    /// By a vector in the axes of the link before.
    Slide([Motion; 3]),
    /// About an axis of length 1.
    Turn(Vector, Motion),
    /// At rest in the link before.
    Placed(Matrix),
    /// By the quaternion that four coordinates from this one on are.
    Ball(usize),
}

/// A number that depends on coordinates and time: c + Σ c q + Σ c q q + Σ c tᵏ + Σ a sin(w t + p).
#[derive(Clone, Debug, Default)]
pub(super) struct Motion {
    pub(super) constant: f64,
    pub(super) linear: Vec<(f64, usize)>,
    pub(super) products: Vec<(f64, usize, usize)>,
    /// Of t and of t².
    pub(super) powers: [f64; 2],
    pub(super) waves: Vec<[f64; 3]>,
}

/// In the axes of its link, the inertia about the centre: a matrix that rests, times a number.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub(super) mass: Motion,
    pub(super) centre: Point,
    pub(super) inertia: Matrix,
    pub(super) growth: Motion,
    /// The acceleration of gravity, along the fixed axes.
    pub(super) gravity: Vector,
}

/// At rest in a link.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub(super) link: usize,
    pub(super) at: Vector,
}

/// Forces at points, in the fixed axes.
#[derive(Clone, Debug)]
pub(super) enum Load {
    Given(Point, Vector),
    /// On a link, in its own axes.
    Torque(usize, Vector),
    /// k (d − l) between two points at the distance d.
    Spring(Point, Point, f64, f64),
    /// −c v
    Damper(Point, f64),
    /// v × B
    Magnetic(Point, Vector),
}

/// Left side − right side = 0.
#[derive(Clone, Debug)]
pub(super) enum Tie {
    /// The one point less the other.
    Together(Point, Point),
    /// The square of their distance.
    Distance(Point, Point),
    /// A component along the fixed axes.
    Level(Point, usize),
    /// A component of the velocity along the axes of its link.
    Skate(Point, usize),
    /// The square of the length of four coordinates from this one on.
    Unit(usize),
}

/// What a motion is at a state.
pub(super) struct Jet {
    pub(super) value: f64,
    pub(super) rate: f64,
    /// ∂/∂q of the coordinates in it.
    pub(super) slopes: Vec<(usize, f64)>,
    /// How fast the rate changes where no coordinate accelerates.
    pub(super) drift: f64,
}

/// How a link lies and moves, along the fixed axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose {
    /// Its axes are the columns.
    pub(super) axes: Matrix,
    pub(super) origin: Vector,
    pub(super) turning: Vector,
    pub(super) moving: Vector,
}

impl Motion {
    pub(super) fn of(coordinate: usize) -> Self {
        Self { linear: vec![(1.0, coordinate)], ..Self::default() }
    }

    pub(super) fn fixed(constant: f64) -> Self {
        Self { constant, ..Self::default() }
    }

    pub(super) fn times(&self, c: f64) -> Self {
        Self {
            constant: c * self.constant,
            linear: self.linear.iter().map(|&(x, i)| (c * x, i)).collect(),
            products: self.products.iter().map(|&(x, i, j)| (c * x, i, j)).collect(),
            powers: self.powers.map(|x| c * x),
            waves: self.waves.iter().map(|&[a, w, p]| [c * a, w, p]).collect(),
        }
    }

    fn has_coordinates(&self) -> bool {
        !(self.linear.is_empty() && self.products.is_empty())
    }

    pub(super) fn jet(&self, model: &Model) -> Jet {
        let (q, v, t) = (&model.coordinates, &model.velocities, model.time);
        let [first, second] = self.powers;
        let mut jet = Jet {
            value: self.constant + first * t + second * t * t,
            rate: first + 2.0 * second * t,
            slopes: Vec::new(),
            drift: 2.0 * second,
        };
        for &[a, w, p] in &self.waves {
            let (sin, cos) = (w * t + p).sin_cos();
            jet.value += a * sin;
            jet.rate += a * w * cos;
            jet.drift -= a * w * w * sin;
        }
        for &(c, i) in &self.linear {
            jet.value += c * q[i];
            jet.slopes.push((i, c));
        }
        for &(c, i, j) in &self.products {
            jet.value += c * q[i] * q[j];
            jet.slopes.extend([(i, c * q[j]), (j, c * q[i])]);
            jet.drift += 2.0 * c * v[i] * v[j];
        }
        jet.rate += jet.slopes.iter().map(|&(i, slope)| slope * v[i]).sum::<f64>();
        jet
    }
}

impl Model {
    /// Of every link, the fixed one first.
    pub(super) fn poses(&self) -> Vec<Pose> {
        let mut poses = vec![Pose { axes: UNIT, origin: [0.0; 3], turning: [0.0; 3], moving: [0.0; 3] }];
        for Link { before, joint } in &self.links {
            poses.push(self.after(&poses[*before], joint));
        }
        poses
    }

    fn after(&self, before: &Pose, joint: &Joint) -> Pose {
        match joint {
            Joint::Slide(by) => {
                let jets = by.each_ref().map(|motion| motion.jet(self));
                let arm = times(before.axes, jets.each_ref().map(|jet| jet.value));
                let rate = times(before.axes, jets.each_ref().map(|jet| jet.rate));
                let moving = sum([before.moving, cross(before.turning, arm), rate]);
                Pose { origin: sum([before.origin, arm]), moving, ..*before }
            }
            Joint::Turn(axis, angle) => {
                let angle = angle.jet(self);
                let rate = scaled(angle.rate, times(before.axes, *axis));
                before.turned(turn(*axis, angle.value), rate)
            }
            Joint::Placed(by) => before.turned(*by, [0.0; 3]),
            Joint::Ball(first) => {
                let columns = self.ball(before, *first);
                let rates = columns.into_iter().zip(&self.velocities[*first..]);
                let rate = rates.fold([0.0; 3], |sum_, (column, v)| sum([sum_, scaled(*v, column)]));
                before.turned(turn_by(self.quaternion(*first)), rate)
            }
        }
    }

    pub(super) fn quaternion(&self, first: usize) -> [f64; 4] {
        std::array::from_fn(|k| self.coordinates[first + k])
    }

    /// What the rate of each of the four numbers of q adds to the angular velocity 2 q̇ q̄, where |q| = 1.
    pub(super) fn ball(&self, before: &Pose, first: usize) -> [Vector; 4] {
        let [w, x, y, z] = self.quaternion(first);
        std::array::from_fn(|k| {
            let mut rate = [0.0; 4];
            rate[k] = 2.0;
            let [_, turning @ ..] = quaternion_product(rate, [w, -x, -y, -z]);
            times(before.axes, turning)
        })
    }

    /// Whether any coordinate moves a link.
    pub(super) fn is_moved(&self, link: usize) -> bool {
        self.is_turned(link)
            || self.is_any(link, |joint| match joint {
                Joint::Slide(by) => by.iter().any(Motion::has_coordinates),
                _ => false,
            })
    }

    /// Whether any coordinate turns it.
    pub(super) fn is_turned(&self, link: usize) -> bool {
        self.is_any(link, |joint| match joint {
            Joint::Turn(_, angle) => angle.has_coordinates(),
            Joint::Ball(_) => true,
            Joint::Slide(_) | Joint::Placed(_) => false,
        })
    }

    /// Of the joints between a link and the fixed one.
    fn is_any(&self, link: usize, is: impl Fn(&Joint) -> bool) -> bool {
        let on_the_way = std::iter::successors(link.checked_sub(1), |&k| self.links[k].before.checked_sub(1));
        on_the_way.into_iter().any(|k| is(&self.links[k].joint))
    }

    /// Where a point is along the fixed axes, and its velocity.
    pub(super) fn place(&self, poses: &[Pose], point: Point) -> (Vector, Vector) {
        let pose = &poses[point.link];
        let arm = times(pose.axes, point.at);
        (sum([pose.origin, arm]), sum([pose.moving, cross(pose.turning, arm)]))
    }

    /// Whether the rows of the ties are far from depending on each other: det of the rows' products with each other, each
    /// row of length 1.
    pub(super) fn is_tied_well(&self) -> bool {
        let rows = self.tie_rows();
        let lengths: Vec<f64> =
            rows.iter().map(|row| row.iter().map(|x| x * x).sum::<f64>().sqrt()).collect();
        if lengths.iter().any(|length| *length < 0.1) {
            return false;
        }
        let product = |i: usize, j: usize| {
            rows[i].iter().zip(&rows[j]).map(|(x, y)| x * y).sum::<f64>() / (lengths[i] * lengths[j])
        };
        let gram: Vec<Vec<f64>> =
            (0..rows.len()).map(|i| (0..rows.len()).map(|j| product(i, j)).collect()).collect();
        let zero = vec![0.0; rows.len()];
        super::algebra::solved(gram, zero).1 > 0.02
    }

    /// How fast each tie changes by the velocity of each coordinate.
    fn tie_rows(&self) -> Vec<Vec<f64>> {
        let rates = |velocities: Vec<f64>| Self { velocities, ..self.clone() }.tie_rates();
        let n = self.coordinates.len();
        let rest = rates(vec![0.0; n]);
        let columns: Vec<Vec<f64>> =
            (0..n).map(|i| rates((0..n).map(|j| if i == j { 1.0 } else { 0.0 }).collect())).collect();
        let row = |a: usize| columns.iter().map(|column| column[a] - rest[a]).collect();
        (0..rest.len()).map(row).collect()
    }

    fn tie_rates(&self) -> Vec<f64> {
        let poses = self.poses();
        let of = |tie: &Tie| match *tie {
            Tie::Together(a, b) => {
                let (a, b) = (self.place(&poses, a).1, self.place(&poses, b).1);
                (0..3).map(|k| a[k] - b[k]).collect()
            }
            Tie::Distance(a, b) => {
                let ((r, v), (s, w)) = (self.place(&poses, a), self.place(&poses, b));
                let (arm, rate) = (sum([r, scaled(-1.0, s)]), sum([v, scaled(-1.0, w)]));
                vec![2.0 * dot(arm, rate)]
            }
            Tie::Level(point, axis) => vec![self.place(&poses, point).1[axis]],
            Tie::Skate(point, axis) => {
                let direction = times(poses[point.link].axes, UNIT[axis]);
                vec![dot(direction, self.place(&poses, point).1)]
            }
            Tie::Unit(first) => {
                let q = self.quaternion(first);
                vec![(0..4).map(|k| 2.0 * q[k] * self.velocities[first + k]).sum()]
            }
        };
        self.ties.iter().flat_map(of).collect::<Vec<f64>>()
    }
}

impl Pose {
    fn turned(&self, by: Matrix, rate: Vector) -> Self {
        Self { axes: product(self.axes, by), turning: sum([self.turning, rate]), ..*self }
    }
}
