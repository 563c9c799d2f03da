//! Contacts: joints at their limits, and links on the floor.

use super::limits::limit;
use crate::names::{Label, Labels};
use crate::number::{expression, vector};
use crate::options::Options;
use crate::tree::{Moving, Tool, Tree};

pub(super) fn are_there(tree: &Tree, options: &Options) -> bool {
    let stops = tree.links.iter().any(|moving| options.limits && ends(moving).is_some());
    stops || !tree.feet.is_empty()
}

/// Names of the contacts at the limits of a joint, if it has any.
pub(super) fn stops<'a>(moving: &Moving, label: &'a Label, options: &Options) -> Vec<&'a String> {
    if options.limits && ends(moving).is_some() { label.stops.iter().collect() } else { Vec::new() }
}

/// Lower and upper limit of the position of a joint.
fn ends(moving: &Moving) -> Option<[f64; 2]> {
    limit(moving).map(|limit| limit.position).filter(|ends| ends.iter().all(|end| end.is_finite()))
}

pub(super) fn statements(tree: &Tree, labels: &Labels, options: &Options) -> impl Iterator<Item = String> {
    let joints = tree.links.iter().zip(&labels.links).filter(|_| options.limits);
    let joints = joints.filter_map(|(moving, label)| Some((ends(moving)?, label)));
    let stops = joints.flat_map(|([lower, upper], Label { q, stops: [below, above], .. })| {
        [format!("{below}: {q} >= {}", expression(lower)), format!("{above}: {} >= {q}", expression(upper))]
    });
    stops.chain(tree.feet.iter().zip(&labels.feet).map(|(foot, name)| on_floor(foot, name, labels)))
}

fn on_floor(foot: &Tool, name: &str, labels: &Labels) -> String {
    let frame = &labels.links[foot.host].frame;
    let place = foot.place.xyz;
    let point = if place.norm() == 0.0 { String::new() } else { format!(", {}", vector(place.as_slice())) };
    let velocity = format!("express(velocity({frame}{point}), fixed)[0..2]");
    format!("{name}: position({frame}{point})[2] >= 0, friction({}): {velocity}", labels.mu)
}
