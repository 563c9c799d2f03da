//! Registry of frames and rigid bodies.

use std::rc::Rc;

use rustc_hash::FxHashSet;

use super::super::value::Axes;
use super::pose::{Frame, Triple};
use crate::symbolic::Id;

/// Name of the fixed frame, the root of all others.
pub(in crate::resolve) const FIXED: &str = "fixed";

/// Frames declared so far.
pub(crate) struct Frames {
    /// One frame for each step: named frames, and the unnamed ones between them.
    pub(crate) all: Vec<Frame>,
    pub(crate) bodies: Vec<Body>,
    /// Quaternions that turn frames.
    pub(crate) quaternions: Vec<[Id; 4]>,
    /// Axes of each named frame, keyed by name and index; `None` after a reported error.
    pub(super) named: Vec<(Rc<str>, Option<Axes>)>,
    /// Name of the frame being declared.
    pub(super) current: Option<Rc<str>>,
    /// Stack of frames whose parent is being resolved, each with the index of its declaration: each lies in the next.
    pub(super) asked: Vec<(usize, Rc<str>)>,
    /// Frames declared before their turn, because others lie in them.
    pub(super) early: FxHashSet<Rc<str>>,
}

/// A rigid body. First moment and `inertia` are about the origin of its frame, with components along the
/// axes of the frame.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    pub(crate) frame: usize,
    pub(crate) mass: Id,
    /// Mass times the position of the centre of mass.
    pub(crate) moment: Triple,
    pub(crate) inertia: [Triple; 3],
    /// Centre of mass, along the axes of the frame, and inertia about it, as written.
    pub(crate) centre: Triple,
    pub(crate) central: [Triple; 3],
    /// Graph node of the kinetic energy.
    pub(crate) energy: Id,
}

impl Default for Frames {
    fn default() -> Self {
        Self {
            all: vec![Frame::fixed()],
            bodies: Vec::new(),
            quaternions: Vec::new(),
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

    /// Names of the frames, each with the index of its frame.
    pub(crate) fn names(&self) -> Vec<(usize, String)> {
        let axes = self.named.iter().filter_map(|(_, axes)| axes.as_ref());
        axes.map(|axes| (axes.frame, axes.name.to_string())).collect()
    }
}
