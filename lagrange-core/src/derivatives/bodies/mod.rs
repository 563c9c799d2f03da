//! Derivatives of the inertial forces of a tree of rigid bodies, by the composite bodies that its joints carry
//! (Carpentier and Mansard, *Robotics: Science and Systems* XIV, 2018; Singh, Russell and Wensing, *IEEE Robotics and
//! Automation Letters* 7, 2022).
//!
//! Let S_a be the twist of the bodies beyond a joint for the unit rate of a coordinate a, and Ṡ_a, S̈_a its rates of
//! change along the motion. A displacement along a moves these bodies as one rigid body. Beside that, it changes their
//! twists by Ṡ_a, and the rates of change of the twists by S̈_a. A rate of a changes twists by S_a, and their rates of
//! change by 2 Ṡ_a. The inertial forces of the bodies change by
//!
//! ```text
//! I A + B V    for changes V of the twists and A + V × (twist) of their rates of change
//! ```
//!
//! with sums I and B over the bodies. If joint b lies beyond joint a, or is the same, the inertial force τ along b changes by
//! S_b·(I S̈_a + B Ṡ_a) with the sums over the bodies beyond b. If a lies beyond b, these are the bodies beyond a, and
//! their forces turn with them: S_b·(I S̈_a + B Ṡ_a + S_a × F). All vectors are taken along common axes, about a common
//! point: the origin of the first frame that carries bodies or several frames. At a distance of d from it, what depends on
//! the inertia of a body with the radius of gyration k alone has the relative error (d/k)² 2⁻⁵³.

mod carriers;
mod composite;
mod spatial;

use carriers::{Carriers, LANES, Weights};
use composite::{Composite, Pose};
use spatial::{Spatial, cross, dot, plus, product};

use crate::number::{Broadcast, Scalar, Wide};
use crate::system::Direction;
use crate::vector::{Array, Element, StaticLength, Vector};

/// Structure of trees of rigid bodies.
#[derive(Clone, Copy, Debug)]
pub struct Tree {
    /// Frames that move relative to those that carry them, or have bodies; each after the one that carries it.
    pub joints: &'static [Joint],
    /// What a coordinate moves in a joint, joint by joint.
    pub columns: &'static [JointColumn],
    /// Joint of each body.
    pub bodies: &'static [usize],
    /// Pairs of columns of one joint, the first of which has an axis that depends on the coordinate of the second.
    pub bends: &'static [[usize; 2]],
}

/// Joint of a tree.
#[derive(Clone, Copy, Debug)]
pub struct Joint {
    /// Index of the joint that carries this one.
    pub before: Option<usize>,
    /// True for a rotation, whose axes are given along those after it. False for a displacement.
    pub turns: bool,
    /// Index of the first of its columns, and of the first after them.
    pub columns: [usize; 2],
    /// Number of columns of the joints that carry this one.
    pub depth: usize,
}

/// A coordinate of a joint.
#[derive(Clone, Copy, Debug)]
pub struct JointColumn {
    /// Index of the coordinate.
    pub coordinate: usize,
    /// Index among the axes that change along the axes of the joint.
    pub changing: Option<usize>,
}

/// Numbers of a [`Tree`] with `J` joints and `C` columns at a state.
#[derive(Clone, Copy, Debug)]
pub struct TreeNumbers<'a, T, const J: usize, const C: usize> {
    /// Rotation matrix of each joint to the common axes, by rows, and its origin.
    pub poses: &'a [[T; 12]; J],
    /// Angular velocity or velocity of each column for the unit rate of its coordinate, along the axes of its joint.
    pub axes: &'a [[T; 3]; C],
    /// First and second derivative by the time of each axis that changes.
    pub rates: &'a [[T; 6]],
    /// Derivative of the axis of the first column of each bend by the coordinate of the second.
    pub bends: &'a [[T; 3]],
    /// Mass, centre of mass, and inertia about it by its upper triangle.
    pub bodies: &'a [[T; 10]],
    /// Acceleration of the fixed axes, opposite to that of gravity.
    pub fixed: &'a [T; 3],
}

/// Derivatives of the residuals of all equations of motion, one list for each coordinate and each velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionGradients<T: Element, N: StaticLength> {
    /// Derivatives by each coordinate.
    pub q: Array<Array<T, N>, N>,
    /// Derivatives by each velocity.
    pub v: Array<Array<T, N>, N>,
}

impl<T: Scalar, N: StaticLength> MotionGradients<T, N> {
    /// Derivatives that are all zero.
    pub fn zero() -> Self {
        let zeros = Array::filled(Array::filled(T::constant(0.0)));
        Self { q: zeros, v: zeros }
    }

    /// Adds the derivatives along a direction of coordinates and velocities.
    pub fn add_along<S: Broadcast<T>>(&self, direction: &Direction<S, N>, motion: &mut Vector<S, N>) {
        for (columns, rates) in [(&self.q, &direction.q), (&self.v, &direction.v)] {
            for (column, &rate) in columns.iter().zip(rates.as_slice()) {
                let entries = motion.as_mut_slice().iter_mut().zip(column.iter());
                entries.for_each(|(entry, &x)| *entry = S::of(x).multiply_add(rate, *entry));
            }
        }
    }

    /// Adds the derivatives by one argument to each component: 1 … N are the coordinates, N + 1 … 2N the velocities.
    #[inline]
    pub(super) fn add_columns<W: Wide<T>>(
        &self,
        arguments: impl Iterator<Item = usize>,
        motion: &mut Vector<W, N>,
    ) {
        const { assert!(W::COUNT <= LANES) };
        let zeros = Array::filled(T::constant(0.0));
        let mut columns = [&zeros; LANES];
        for (column, k) in columns.iter_mut().zip(arguments).filter(|(_, k)| *k > 0) {
            *column = if k <= N::COUNT { &self.q[k - 1] } else { &self.v[k - 1 - N::COUNT] };
        }
        for (i, entry) in motion.as_mut_slice().iter_mut().enumerate() {
            *entry = *entry + W::from_lanes(|lane| columns[lane][i]);
        }
    }

    /// Adds the derivatives of the inertial forces of a tree of bodies with `J` joints and `C` columns. No body may have more
    /// than 4 `P` columns between it and the fixed frame.
    pub fn add_bodies<const J: usize, const C: usize, const P: usize>(
        &mut self,
        tree: &Tree,
        numbers: &TreeNumbers<T, J, C>,
        v: &Vector<T, N>,
        accelerations: &Vector<T, N>,
    ) {
        let moving = TreeMotion::of(tree, numbers, v, accelerations);
        let mut carried = [Composite::nothing(); J];
        for (body, &joint) in numbers.bodies.iter().zip(tree.bodies) {
            let pose = Pose::of(&numbers.poses[joint]);
            carried[joint].add(&Composite::of(body, &pose, moving.twists[joint], moving.rates[joint]));
        }
        let mut path = Carriers::<T, P, C>::new();
        for (number, joint) in tree.joints.iter().enumerate().rev() {
            let own = carried[number];
            path.lead_to(tree, number, &moving.columns);
            for a in joint.columns[0]..joint.columns[1] {
                self.add_column(tree.columns[a].coordinate, joint, &own, &moving.columns[a], &path);
            }
            if let Some(before) = joint.before {
                carried[before].add(&own);
            }
        }
        for (&[a, b], bend) in tree.bends.iter().zip(numbers.bends) {
            let joint = moving.joints[a];
            let Spatial { turning, moving: force } = carried[joint].wrench;
            let Pose { axes, origin } = Pose::of(&numbers.poses[joint]);
            let torque = plus(turning, cross(force, origin));
            let along = product(&axes, *bend);
            let part = dot(along, if tree.joints[joint].turns { torque } else { force });
            let entry = &mut self.q[tree.columns[b].coordinate][tree.columns[a].coordinate];
            *entry = *entry + part;
        }
    }

    /// Adds the derivatives that couple a column of a joint, which moves coordinate `i`, with those of its joint and of the
    /// joints that carry it.
    fn add_column<const P: usize, const C: usize>(
        &mut self,
        i: usize,
        joint: &Joint,
        own: &Composite<T>,
        &[s, first, second]: &[Spatial<T>; 3],
        path: &Carriers<T, P, C>,
    ) {
        let momentum = own.momentum_of(s);
        let weights = Weights {
            momentum,
            twice: momentum.plus(momentum),
            gyroscopic: own.gyroscopic_transposed(s),
            by_q: own
                .momentum_of(second)
                .plus(own.gyroscopic(first.turning))
                .plus(s.carries_wrench(own.wrench)),
            by_v: own.momentum_of(first.plus(first)).plus(own.gyroscopic(s.turning)),
        };
        let end = joint.depth + joint.columns[1] - joint.columns[0];
        for (block, columns) in path.blocks[..end.div_ceil(LANES)].iter().enumerate() {
            let [q, v, q_below, v_below] = weights.entries(columns);
            for lane in 0..LANES.min(end - LANES * block) {
                let place = LANES * block + lane;
                let j = path.coordinates[place];
                self.add(i, j, [q[lane], v[lane]]);
                if place < joint.depth {
                    self.add(j, i, [q_below[lane], v_below[lane]]);
                }
            }
        }
    }

    #[inline(always)]
    fn add(&mut self, row: usize, column: usize, [q, v]: [T; 2]) {
        for (columns, part) in [(&mut self.q, q), (&mut self.v, v)] {
            let entry = &mut columns[column][row];
            *entry = *entry + part;
        }
    }
}

/// Twists of the joints in the motion, along the common axes and about the common point.
struct TreeMotion<T, const J: usize, const C: usize> {
    /// Twist of each joint, and its rate of change.
    twists: [Spatial<T>; J],
    rates: [Spatial<T>; J],
    /// S, Ṡ and S̈ of each column.
    columns: [[Spatial<T>; 3]; C],
    /// Joint of each column.
    joints: [usize; C],
}

impl<T: Scalar, const J: usize, const C: usize> TreeMotion<T, J, C> {
    fn of<N: StaticLength>(
        tree: &Tree,
        numbers: &TreeNumbers<T, J, C>,
        v: &Vector<T, N>,
        accelerations: &Vector<T, N>,
    ) -> Self {
        let zero = Spatial::zero();
        let mut moving =
            Self { twists: [zero; J], rates: [zero; J], columns: [[zero; 3]; C], joints: [0; C] };
        let still = [zero, Spatial { moving: *numbers.fixed, ..zero }];
        for (number, joint) in tree.joints.iter().enumerate() {
            let before = joint.before.map_or(still, |before| [moving.twists[before], moving.rates[before]]);
            moving.joint(tree, numbers, number, before, |column| (v[column], accelerations[column]));
        }
        moving
    }

    /// Computes the twist of a joint and its columns.
    fn joint(
        &mut self,
        tree: &Tree,
        numbers: &TreeNumbers<T, J, C>,
        number: usize,
        before: [Spatial<T>; 2],
        motion: impl Fn(usize) -> (T, T),
    ) {
        let Joint { turns, columns: [start, end], .. } = tree.joints[number];
        let Pose { axes, origin } = Pose::of(&numbers.poses[number]);
        let zero = T::constant(0.0);
        let spatial = |axis: [T; 3]| match (product(&axes, axis), turns) {
            (turning, true) => Spatial { turning, moving: cross(origin, turning) },
            (moving, false) => Spatial { turning: [zero; 3], moving },
        };
        let [mut twist, mut rate] = before;
        for a in start..end {
            self.joints[a] = number;
            self.columns[a][0] = spatial(numbers.axes[a]);
            twist = twist.plus(self.columns[a][0].times(motion(tree.columns[a].coordinate).0));
        }
        let changes = |a: usize| {
            tree.columns[a].changing.map(|k| {
                let [x, y, z, first @ ..] = numbers.rates[k];
                [[x, y, z], first].map(spatial)
            })
        };
        let carrier = if turns { twist } else { before[0] };
        for a in start..end {
            let (velocity, acceleration) = motion(tree.columns[a].coordinate);
            let [s, first, _] = &mut self.columns[a];
            *first = carrier.carries(*s);
            if let Some([own, _]) = changes(a) {
                *first = first.plus(own);
            }
            rate = rate.plus(s.times(acceleration)).plus(first.times(velocity));
        }
        let carrier_rate = if turns { rate } else { before[1] };
        for a in start..end {
            let [s, first, second] = &mut self.columns[a];
            *second = carrier_rate.carries(*s).plus(carrier.carries(*first));
            if let Some([own, further]) = changes(a) {
                *second = second.plus(carrier.carries(own)).plus(further);
            }
        }
        (self.twists[number], self.rates[number]) = (twist, rate);
    }
}
