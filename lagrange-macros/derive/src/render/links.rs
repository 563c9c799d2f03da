//! Frames that carry bodies, by name: the matrix A of the axes, the angular velocity ω, its value Ω at rest of the coordinates, and
//! the position r of a centre of mass.

use super::axes::named_axes;
use super::formula::Formula;
use super::letters::{Letters, PageQuantity};
use super::lines::{Line, Section};
use super::page::Page;
use super::remark::{Fragment, Remark};
use super::roots::{is_taken, taken};
use crate::mechanics::{Derived, Link, Resultants, RigidBody, Turning};
use crate::resolve::{Frame, Problem, Triple, vector};
use crate::symbolic::{Id, Node};
use crate::variables::Variable;

/// Letters for A, ω, r, F, N, I and Ω: of each, the first that is free.
const LETTERS: [[&str; 2]; 7] =
    [["A", "C"], ["omega", "Omega"], ["r", "x"], ["F", "K"], ["N", "M"], ["I", "Theta"], ["Omega", "W"]];

/// Most bodies beside which a potential is named: the lines of more, which its equations need, are too long for a page.
const FEW: usize = 3;

/// Names of the links and bodies of [`Resultants`], in their order.
pub(super) struct BodyNames {
    pub(super) links: Vec<LinkNames>,
    pub(super) bodies: Vec<RigidBodyNames>,
}

/// Names of bodies, and the lines that define them with the names that they define.
pub(super) struct NamedBodies {
    pub(super) names: BodyNames,
    pub(super) lines: Vec<(Formula, Line)>,
}

pub(super) struct LinkNames {
    /// Name of the frame.
    pub(super) frame: String,
    /// Name of the rotation matrix from the axes of the frame to the fixed ones; `None` if these are the same.
    pub(super) axes: Option<String>,
    pub(super) rate: String,
    /// Name of the angular velocity at rest of the coordinates; `None` if it is zero.
    pub(super) imposed: Option<String>,
    /// True if the names are those of another link, or of a quaternion: the page has lines for them already.
    pub(super) is_known: bool,
}

/// Names of r, F, N and I of a body.
pub(super) struct RigidBodyNames {
    pub(super) position: String,
    pub(super) force: String,
    pub(super) torque: String,
    pub(super) inertia: String,
}

impl BodyNames {
    /// `None` without rigid bodies, or if too many names are taken.
    pub(super) fn of(problem: &Problem, derived: &Derived, letters: &Letters) -> Option<Self> {
        let resultants = derived.resultants.as_ref()?;
        let Resultants { links, bodies, .. } = resultants;
        let frame = |link: &Link| problem.frame_names.iter().find(|(frame, _)| *frame == link.frame);
        let frames: Vec<&str> =
            links.iter().map(|link| frame(link).map(|(_, name)| &**name)).collect::<Option<_>>()?;
        let [axes, rate, position, force, torque, inertia, imposed] = free_letters(problem, &frames)?;
        let mut named = Vec::new();
        for (link, frame) in links.iter().zip(&frames) {
            let [axes, rate, imposed] = [axes, rate, imposed].map(|letter| format!("{letter}_{frame}"));
            let own = LinkNames::of((problem, derived, letters), &named, (link, frame), [axes, rate]);
            let imposed = own.imposed((link, resultants), &named, imposed);
            named.push(LinkNames { imposed, ..own });
        }
        let on_link = |bodies: &[RigidBody], link| bodies.iter().filter(|body| body.link == link).count();
        let bodies = bodies.iter().enumerate().map(|(k, body)| {
            let (base, indices) = apart(frames[body.link]);
            let place = on_link(&bodies[..=k], body.link).to_string();
            let place = if on_link(bodies, body.link) > 1 { place } else { String::new() };
            let [position, force, torque, inertia] =
                [position, force, torque, inertia].map(|letter| format!("{letter}_{base}{place}{indices}"));
            RigidBodyNames { position, force, torque, inertia }
        });
        let bodies: Vec<RigidBodyNames> = bodies.collect();
        Some(Self { links: named, bodies })
    }

    /// True if the bodies are so few that a potential beside them has a name.
    pub(super) fn has_potential(&self) -> bool {
        self.bodies.len() <= FEW
    }
}

/// Name and indices of an element of a family.
fn apart(name: &str) -> (&str, &str) {
    name.split_at(name.find('[').unwrap_or(name.len()))
}

/// One free letter for each quantity.
fn free_letters(problem: &Problem, frames: &[&str]) -> Option<[&'static str; 7]> {
    let taken = taken(problem);
    let is_free = |letter: &str| frames.iter().all(|frame| !is_taken(&taken, &format!("{letter}_{frame}")));
    let mut chosen: Vec<&str> = Vec::new();
    for letters in LETTERS {
        chosen.push(letters.into_iter().find(|letter| is_free(letter) && !chosen.contains(letter))?);
    }
    chosen.try_into().ok()
}

impl LinkNames {
    fn of(
        (problem, derived, letters): (&Problem, &Derived, &Letters),
        named: &[Self],
        (link, frame): (&Link, &str),
        [axes, rate]: [String; 2],
    ) -> Self {
        let own_axes = problem.frames[link.frame].axes;
        let is_it = |turning: &&Turning| turning.axes.is_some_and(|[written, _]| written == own_axes);
        let quaternion = derived.turnings.all.iter().find(is_it);
        let quaternion = quaternion.and_then(|turning| vector(&problem.coordinates[turning.first].text));
        let known = quaternion.and_then(|quaternion| {
            let named = named_axes(problem, &derived.turnings).into_iter();
            let axes =
                named.map(|axes| (axes.quaternion == Formula::labelled(quaternion, 0)).then_some(axes.text));
            Some((Some(axes.flatten().next()?), letters.text_of(PageQuantity::AngularVelocity, quaternion)))
        });
        let is_turned = link.turned != Frame::fixed().axes;
        let before = link.before.filter(|_| !is_turned).map(|before| &named[before]);
        let known = known.or_else(|| before.map(|before| (before.axes.clone(), before.rate.clone())));
        let is_known = known.is_some();
        let (axes, rate) = known.unwrap_or((Some(axes).filter(|_| is_turned), rate));
        Self { frame: frame.to_owned(), axes, rate, imposed: None, is_known }
    }

    /// Name of the angular velocity at rest of the coordinates: that of ω if all of it is, of the link before if the link does
    /// not turn in it, or else `own`.
    fn imposed(&self, (link, all): (&Link, &Resultants), named: &[Self], own: String) -> Option<String> {
        let before = link.before.filter(|&before| all.is_turning(before)).map(|before| &named[before]);
        let carried = before.and_then(|before| before.imposed.as_ref());
        let is_whole = before.is_none_or(|before| carried == Some(&before.rate)) && link.imposed == link.rate;
        let name = if is_whole { &self.rate } else { carried.filter(|_| self.is_known).unwrap_or(&own) };
        let is_turning = carried.is_some() || link.imposed != [Id::ZERO; 3];
        is_turning.then(|| name.clone())
    }
}

fn name(text: &str) -> Formula {
    Formula::labelled(text, 0)
}

/// A vector by its components along other axes; `None` stands for the identity.
fn turned(axes: Option<&str>, vector: Formula) -> Formula {
    let Some(axes) = axes else { return vector };
    let (is_negative, vector) = vector.sign_and_magnitude();
    Formula::Product(vec![name(axes), vector], Vec::new()).signed(is_negative)
}

impl Page<'_> {
    /// Lines of A, ω, Ω, r and I, each after those that it mentions, with the names that they define.
    pub(super) fn body_lines(&self, names: &BodyNames, resultants: &Resultants) -> Vec<(Formula, Line)> {
        let own = (0..names.links.len()).filter(|&k| !names.links[k].is_known);
        let of_links = own.flat_map(|k| {
            [
                self.axes_line(resultants, names, k),
                self.rate_line(resultants, names, k),
                self.imposed_line(resultants, names, k),
            ]
        });
        let positions = (0..names.bodies.len()).map(|k| Some(self.position_line(resultants, names, k)));
        let inertias = names.bodies.iter().zip(&resultants.bodies).map(|(own, body)| {
            let left = name(&own.inertia);
            let is_named = !body.has_inertia() || self.matrix(&body.inertia).is_some();
            (!is_named).then(|| (left.clone(), Line::known(left, self.matrix_of(&body.inertia))))
        });
        of_links.chain(positions).chain(inertias).flatten().collect()
    }

    /// The lines of A, ω, Ω, r and I that these lines mention.
    pub(super) fn mentioned_of_bodies(&mut self, sections: &[Section]) -> Vec<Line> {
        let mut mentioned: Vec<Line> = Vec::new();
        let all = self.bodies.take().map_or_else(Vec::new, |bodies| bodies.lines);
        for (name, line) in all.into_iter().rev() {
            let lines = sections.iter().flat_map(|section| &section.lines).chain(&mentioned);
            if lines.into_iter().any(|other| other.has_name(&name)) {
                mentioned.push(line);
            }
        }
        mentioned.reverse();
        mentioned
    }

    /// A = A_before E with the rotation matrix E from the axes of a link to those of the link before.
    fn axes_line(&self, resultants: &Resultants, names: &BodyNames, k: usize) -> Option<(Formula, Line)> {
        let own = &names.links[k];
        let link = &resultants.links[k];
        let left = name(own.axes.as_ref()?);
        let before = link.before.and_then(|before| names.links[before].axes.as_deref());
        let right = self.matrix_of(&link.turned).map(|matrix| turned(before, matrix));
        let remark = vec![
            Fragment::words("from the axes of "),
            Fragment::Formula(name(&own.frame)),
            Fragment::words(" to the fixed ones"),
        ];
        Some((left.clone(), Line { remark: Remark::of(remark), ..Line::known(left, right) }))
    }

    /// ω = Aᵀ A_before ω_before + ω relative to the link before.
    fn rate_line(&self, resultants: &Resultants, names: &BodyNames, k: usize) -> Option<(Formula, Line)> {
        let own = &names.links[k];
        let before = resultants.links[k].before.filter(|&before| resultants.is_turning(before));
        let before = before.map(|before| &*names.links[before].rate);
        let remark = vec![
            Fragment::words("angular velocity of "),
            Fragment::Formula(name(&own.frame)),
            Fragment::words(" along its axes"),
        ];
        let right = self.carried_on((resultants, names, k), before, &resultants.links[k].rate);
        let left = name(&own.rate);
        Some((left.clone(), Line { remark: Remark::of(remark), ..Line::known(left, right) }))
    }

    /// Ω = Aᵀ A_before Ω_before + ω relative to the link before, for q̇ = 0; `None` if it is zero or all of ω.
    fn imposed_line(&self, resultants: &Resultants, names: &BodyNames, k: usize) -> Option<(Formula, Line)> {
        let (own, link) = (&names.links[k], &resultants.links[k]);
        let left = own.imposed.as_ref().filter(|imposed| **imposed != own.rate).map(|text| name(text))?;
        let before = link.before.and_then(|before| names.links[before].imposed.as_deref());
        let right = self.carried_on((resultants, names, k), before, &link.imposed);
        let remark = vec![Fragment::Formula(name(&own.rate)), Fragment::words(" while the coordinates rest")];
        Some((left.clone(), Line { remark: Remark::of(remark), ..Line::known(left, right) }))
    }

    /// Aᵀ A_before ω_before + ω relative to the link before.
    fn carried_on(
        &self,
        (resultants, names, k): (&Resultants, &BodyNames, usize),
        before: Option<&str>,
        relative: &Triple,
    ) -> Result<Formula, u64> {
        let axes = |k: usize| names.links[k].axes.as_deref();
        let forth = resultants.links[k].before.and_then(axes);
        let back = axes(k).map(|axes| Formula::Transpose(Box::new(name(axes))));
        let carried = before.map(|rate| {
            Formula::Product(
                back.into_iter().chain(forth.into_iter().chain([rate]).map(name)).collect(),
                Vec::new(),
            )
        });
        let relative = (*relative != [Id::ZERO; 3]).then(|| self.vector_or_name(relative)).transpose()?;
        Ok(Formula::sum(carried.into_iter().chain(relative).collect()))
    }

    /// r = Σ A_before s + A c, with the displacements s that lead to the link and the centre of mass c in its axes.
    fn position_line(&self, resultants: &Resultants, names: &BodyNames, k: usize) -> (Formula, Line) {
        let RigidBody { link, centre, .. } = &resultants.bodies[k];
        let axes = |link: Option<usize>| link.and_then(|link| names.links[link].axes.as_deref());
        let mut shifts = vec![(axes(Some(*link)), *centre)];
        let mut at = Some(*link);
        while let Some(link) = at {
            let Link { before, moved, .. } = &resultants.links[link];
            shifts.extend(moved.iter().rev().map(|&shift| (axes(*before), shift)));
            at = *before;
        }
        let shifts = shifts.into_iter().rev().filter(|(_, shift)| *shift != [Id::ZERO; 3]);
        let terms = shifts.map(|(axes, shift)| Ok(turned(axes, self.vector_or_name(&shift)?)));
        let left = name(&names.bodies[k].position);
        let remark =
            vec![Fragment::words("centre of mass of "), Fragment::Formula(name(&names.links[*link].frame))];
        let line = Line::known(left.clone(), terms.collect::<Result<_, u64>>().map(Formula::sum));
        (left, Line { remark: Remark::of(remark), ..line })
    }

    /// A vector of three by its name, or as [`vector_of_components`](Self::vector_of_components) writes it.
    fn vector_or_name(&self, components: &Triple) -> Result<Formula, u64> {
        let named = || {
            let texts = components.map(|component| self.text(component));
            let whole = vector(texts[0].as_deref()?)?.to_owned();
            let entry = |k: usize| format!("{whole}[{k}]");
            let is_it = (0..3).all(|k| texts[k].as_deref() == Some(&entry(k))) && !self.is_name(&entry(3));
            is_it.then(|| name(&whole))
        };
        named().map_or_else(|| self.vector_of_components(components), Ok)
    }

    /// Name of a coordinate or a parameter.
    fn text(&self, id: Id) -> Option<String> {
        match self.graph.node(id) {
            Node::Symbol(symbol) => match Variable::of(*symbol) {
                Variable::Coordinate(i) => Some(self.problem.coordinates[i].text.clone()),
                Variable::Parameter(k) => Some(self.problem.parameters.name(k)),
                _ => None,
            },
            _ => None,
        }
    }

    fn is_name(&self, text: &str) -> bool {
        let parameters = (0..self.problem.parameters.entries.len()).map(|k| self.problem.parameters.name(k));
        let mut all = parameters.chain(self.problem.coordinates.iter().map(|label| label.text.clone()));
        all.any(|name| name == text)
    }
}
