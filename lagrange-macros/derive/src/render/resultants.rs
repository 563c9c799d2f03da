//! Equations of motion by the forces and torques on rigid bodies, in the place of those that are too long to be read.
//!
//! F = m (r̈ − g), N = I ω̇ + ω × I ω, and for each velocity u Jourdain's principle, Σ F·∂ṙ/∂u + N·∂ω/∂u = Q.

use num_traits::One;

use super::formula::Formula;
use super::length::{READABLE, length};
use super::lines::{Equation, Line};
use super::links::{BodyNames, NamedBodies, RigidBodyNames};
use super::page::Page;
use super::remark::{Fragment, Remark};
use crate::mechanics::{Dependence, Resultants, RigidBody};
use crate::resolve::Triple;
use crate::symbolic::{Id, Rational};

/// Velocity whose equation a line states.
#[derive(Clone, Copy)]
pub(super) enum Speed {
    /// Of this coordinate.
    Coordinate(usize),
    /// Component of the angular velocity of a quaternion: the index of its turning, and the axis.
    Turning(usize, usize),
}

/// A rigid body with its names.
#[derive(Clone, Copy)]
pub(super) struct BodyWithNames<'a> {
    pub(super) body: &'a RigidBody,
    pub(super) own: &'a RigidBodyNames,
    frame: &'a str,
    pub(super) rate: &'a str,
    pub(super) imposed: Option<&'a str>,
}

pub(super) fn name(text: &str, dots: usize) -> Formula {
    Formula::labelled(text, dots)
}

pub(super) fn product(factors: Vec<Formula>) -> Formula {
    Formula::flat_product(Rational::one().into(), factors, Vec::new())
}

pub(super) fn dot(one: Formula, other: Formula) -> Formula {
    Formula::Call("dot".to_owned(), vec![one, other])
}

/// Component of a vector; of a product, the component of the cross product at its end, times the other factors.
pub(super) fn component(vector: Formula, k: usize) -> Formula {
    let index = Formula::Number(Rational::from_integer(k as i128));
    match vector {
        Formula::Product(mut above, below) if matches!(above.last(), Some(Formula::Call(name, _)) if name == "cross") =>
        {
            let last = above.pop().map(|last| last.indexed(index));
            Formula::Product(above.into_iter().chain(last).collect(), below)
        }
        vector => vector.indexed(index),
    }
}

/// vector·∂(function)/∂u, a component of the vector if this is a unit vector; `None` if it is zero.
fn along(vector: Formula, function: Formula, u: &Formula, dependence: Dependence) -> Option<Formula> {
    match dependence {
        Dependence::None => None,
        Dependence::Component(k) => Some(component(vector, k)),
        Dependence::Any => {
            let (function, by) = (Box::new(function), vec![u.clone()]);
            Some(dot(vector, Formula::Partial { function, by, arguments: Vec::new() }))
        }
    }
}

impl Page<'_> {
    /// Gives bodies names, for equations that are too long without them.
    pub(super) fn name_bodies(&mut self) {
        let names = BodyNames::of(self.problem, self.derived, &self.letters);
        self.begin_readings();
        let lines = names.zip(self.derived.resultants.as_ref()).map(|(names, resultants)| {
            let lines = self.body_lines(&names, resultants);
            NamedBodies { names, lines }
        });
        self.bodies = lines.filter(|bodies| bodies.lines.iter().all(|(_, line)| !line.is_too_long()));
        self.begin_readings();
        self.choose_chain();
        let potential = self.potential_line();
        if let Some(bodies) = &mut self.bodies {
            bodies.lines.extend(potential);
        }
    }

    pub(super) fn named_bodies(&self) -> Option<(&Resultants, Vec<BodyWithNames<'_>>)> {
        let (NamedBodies { names, .. }, resultants) =
            self.bodies.as_ref().zip(self.derived.resultants.as_ref())?;
        let named = names.bodies.iter().zip(&resultants.bodies).map(|(own, body)| {
            let link = &names.links[body.link];
            let imposed = link.imposed.as_deref();
            BodyWithNames { body, own, frame: &link.frame, rate: &link.rate, imposed }
        });
        Some((resultants, named.collect()))
    }

    /// The equation of a velocity; `None` if no body moves with it, or if it is too long, too.
    pub(super) fn row_by_bodies(&self, speed: Speed) -> Option<Line> {
        let (resultants, bodies) = self.named_bodies()?;
        let terms = bodies.iter().flat_map(|named| {
            let [force, torque] = [&named.own.force, &named.own.torque].map(|text| name(text, 0));
            self.projected(resultants, *named, speed, [force, torque])
        });
        let left = Formula::sum(terms.flatten().collect());
        let right = match speed {
            Speed::Coordinate(i) => [self.given_force(resultants, i), self.constraint_force(i)],
            Speed::Turning(k, axis) => {
                let turning = &self.derived.turnings.all[k];
                let torques = [resultants.torques[k], turning.constraint.0];
                let [given, constraint] = torques.map(|torque| self.component_of(&torque, axis));
                let by_arguments =
                    || self.torque_by_arguments(resultants, turning.first, &self.speed(speed, 0));
                [given.or_else(|size| by_arguments().ok_or(size)), constraint]
            }
        };
        let zero = Formula::sum(Vec::new());
        let right = right.into_iter().collect::<Result<Vec<_>, u64>>().ok()?;
        let right = Formula::sum(right.into_iter().filter(|part| *part != zero).collect());
        let is_short = length(&left) + length(&right) <= READABLE as usize;
        (is_short && left != zero).then_some(())?;
        Some(Line::labelled(&self.speed(speed, 0), Equation::Known(left, right)))
    }

    /// Component of a vector, by the vector or in coordinates, whichever is shorter.
    fn component_of(&self, vector: &Triple, axis: usize) -> Result<Formula, u64> {
        let whole = self.vector_expression(vector).map(|whole| {
            let (is_negative, whole) = whole.sign_and_magnitude();
            component(whole, axis).signed(is_negative)
        });
        match (whole, self.expression(vector[axis])) {
            (Some(whole), Ok(other)) if length(&other) <= length(&whole) => Ok(other),
            (whole, other) => whole.map_or(other, Ok),
        }
    }

    /// A coordinate with dots, or a component of an angular velocity.
    fn speed(&self, speed: Speed, dots: usize) -> Formula {
        match speed {
            Speed::Coordinate(i) => name(&self.problem.coordinates[i].text, dots),
            Speed::Turning(k, axis) => {
                name(&self.angular_velocity(self.derived.turnings.all[k].rate + axis), 0)
            }
        }
    }

    /// F·∂ṙ/∂u and N·∂ω/∂u of a body, for vectors F and N.
    pub(super) fn projected(
        &self,
        resultants: &Resultants,
        BodyWithNames { body, own, rate, .. }: BodyWithNames,
        speed: Speed,
        [force, torque]: [Formula; 2],
    ) -> [Option<Formula>; 2] {
        let u = self.speed(speed, 1);
        let moves = Some(self.moves_with(resultants, body, speed)).filter(|_| body.mass != Id::ZERO);
        let turns = Some(self.turns_with(resultants, body, speed)).filter(|_| body.has_inertia());
        [
            moves.and_then(|moves| along(force, name(&own.position, 1), &u, moves)),
            turns.and_then(|turns| along(torque, name(rate, 0), &u, turns)),
        ]
    }

    fn moves_with(&self, resultants: &Resultants, body: &RigidBody, speed: Speed) -> Dependence {
        let moves = |i: usize| resultants.moves_with(self.graph, body, i);
        match speed {
            Speed::Coordinate(i) => moves(i),
            Speed::Turning(k, _) => {
                let first = self.derived.turnings.all[k].first;
                let rests = (first..first + 4).all(|i| moves(i) == Dependence::None);
                if rests { Dependence::None } else { Dependence::Any }
            }
        }
    }

    fn turns_with(&self, resultants: &Resultants, body: &RigidBody, speed: Speed) -> Dependence {
        let velocity = match speed {
            Speed::Coordinate(i) => i,
            Speed::Turning(k, axis) => self.derived.turnings.all[k].rate + axis,
        };
        resultants.turns_with(self.graph, body.link, velocity)
    }

    /// Lines of F and N that these lines mention.
    pub(super) fn resultant_lines(&self, lines: &[Line]) -> Vec<Line> {
        let Some((resultants, bodies)) = self.named_bodies() else { return Vec::new() };
        let is_mentioned = |text: &str| lines.iter().any(|line| line.has_name(&name(text, 0)));
        let both = bodies.iter().flat_map(|named| {
            let (force, torque) = (self.force_line(resultants, *named), self.torque_line(*named));
            [(&named.own.force, force), (&named.own.torque, torque)]
        });
        both.filter(|(text, _)| is_mentioned(text)).map(|(_, line)| line).collect()
    }

    /// F = m (r̈ − g)
    fn force_line(
        &self,
        resultants: &Resultants,
        BodyWithNames { body, own, frame, .. }: BodyWithNames,
    ) -> Line {
        let acceleration = name(&own.position, 2);
        let is_weightless = resultants.lift == [Id::ZERO; 3];
        let acceleration = match is_weightless {
            true => Ok(acceleration),
            false => {
                self.vector_of_components(&resultants.lift).map(|lift| Formula::sum(vec![acceleration, lift]))
            }
        };
        let force = acceleration
            .and_then(|acceleration| Ok(product(vec![self.expression(body.mass)?, acceleration])));
        let mut remark = vec![Fragment::words("force on "), Fragment::Formula(name(frame, 0))];
        remark.push(Fragment::words(if is_weightless { "" } else { " without its weight" }));
        remark.push(Fragment::words(", along the fixed axes"));
        Line { remark: Remark::of(remark), ..Line::known(name(&own.force, 0), force) }
    }

    /// N = I ω̇ + ω × I ω
    fn torque_line(&self, named: BodyWithNames) -> Line {
        let [omega, change] = [0, 1].map(|dots| name(named.rate, dots));
        let spin = |rate| self.spin(named, rate);
        let gyroscopic = Formula::Call("cross".to_owned(), vec![omega.clone(), spin(omega)]);
        let torque = Formula::sum(vec![spin(change), gyroscopic]);
        let remark = vec![
            Fragment::words("torque on "),
            Fragment::Formula(name(named.frame, 0)),
            Fragment::words(" about its centre of mass, along its axes"),
        ];
        Line { remark: Remark::of(remark), ..Line::known(name(&named.own.torque, 0), Ok(torque)) }
    }

    /// I ω, or I ω̇
    pub(super) fn spin(&self, BodyWithNames { body, own, .. }: BodyWithNames, rate: Formula) -> Formula {
        let inertia = self.matrix(&body.inertia).unwrap_or_else(|| own.inertia.clone());
        Formula::Product(vec![name(&inertia, 0), rate], Vec::new())
    }
}
