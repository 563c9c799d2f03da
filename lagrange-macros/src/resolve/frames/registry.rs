//! Frames and rigid bodies known so far.

use std::rc::Rc;

use rustc_hash::FxHashSet;

use super::super::value::Axes;
use super::pose::{Frame, Triple};
use crate::symbolic::Id;

/// The name of the frame that all others lie in, in the end.
pub(super) const FIXED: &str = "fixed";

/// What is known of frames.
pub(crate) struct Frames {
    /// One a step: those that have a name, and those on the way to them.
    pub(crate) all: Vec<Frame>,
    pub(crate) bodies: Vec<Body>,
    /// |q|² of the quaternions that turn them.
    pub(crate) squares: Vec<Id>,
    /// By name and index; none where something was wrong with one, which is then reported.
    pub(super) named: Vec<(Rc<str>, Option<Axes>)>,
    /// The one that is being declared.
    pub(super) current: Option<Rc<str>>,
    /// Those of which it is asked what they lie in, by their declarations: each lies in the next.
    pub(super) asked: Vec<(usize, Rc<str>)>,
    /// Those that were declared before their turn, because others lie in them.
    pub(super) early: FxHashSet<Rc<str>>,
}

/// A rigid body, by what it is in the axes of its frame and about the frame's origin.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    pub(crate) frame: usize,
    pub(crate) mass: Id,
    /// Mass times the position of its centre.
    pub(crate) moment: Triple,
    pub(crate) inertia: [Triple; 3],
    /// The node of its kinetic energy.
    pub(crate) energy: Id,
}

impl Default for Frames {
    fn default() -> Self {
        Self {
            all: vec![Frame::fixed()],
            bodies: Vec::new(),
            squares: Vec::new(),
            named: Vec::new(),
            current: None,
            asked: Vec::new(),
            early: FxHashSet::default(),
        }
    }
}

impl Frames {
    pub(super) fn get(&self, name: &str) -> Option<&Option<Axes>> {
        self.named.iter().find(|(known, _)| **known == *name).map(|(_, axes)| axes)
    }
}
