//! Renders equations of motion in the angular velocity of a quaternion.

use num_traits::One;

use super::formula::Formula;
use super::length::{READABLE, length};
use super::letters::PageQuantity;
use super::lines::{Equation, Line};
use super::motion::MotionRow;
use super::notation::Notation;
use super::page::Page;
use super::remark::{Fragment, Remark};
use super::resultants::Speed;
use crate::mechanics::{EnergyForm, Euler, Turning, Turnings};
use crate::resolve::{Label, vector};
use crate::symbolic::{Id, Node, Rational};
use crate::variables::Variable;

impl Page<'_> {
    /// Name of a component of an angular velocity, by its index among the velocities: `omega_q[0]` for the quaternion q.
    pub(super) fn angular_velocity(&self, number: usize) -> String {
        let of = |turning: &&Turning| (turning.rate..turning.rate + 3).contains(&number);
        let found = self.derived.turnings.all.iter().find(of).map(|turning| {
            let quaternion = &self.problem.coordinates[turning.first].text;
            let name =
                self.letters.text_of(PageQuantity::AngularVelocity, vector(quaternion).unwrap_or(quaternion));
            format!("{name}[{}]", number - turning.rate)
        });
        found.unwrap_or_default()
    }

    /// q̇ = ½ q ω, and the equation of ω: as a vector, or one line for each component.
    pub(super) fn turning(&self, number: usize, labels: &[Label]) -> Vec<MotionRow> {
        let turning = &self.derived.turnings.all[number];
        let quaternion = vector(&labels[0].text).unwrap_or_default();
        let name = self.letters.text_of(PageQuantity::AngularVelocity, quaternion);
        let line = |text: &str, equation| Line::labelled(&Formula::labelled(text, 0), equation);
        let [omega, _] = self.angular(quaternion);
        let half = Formula::product(
            Rational::new(1, 2).into(),
            vec![Formula::labelled(quaternion, 0), omega.clone()],
            Vec::new(),
        );
        let relation = Equation::Known(Formula::labelled(quaternion, 1), half);
        let remark = vec![
            Fragment::words("product of quaternions, "),
            Fragment::Formula(omega),
            Fragment::words(" along the turned axes"),
        ];
        let relation = Line { remark: Remark::of(remark), ..line(quaternion, relation) };
        let row = |axis: usize| {
            let (left, right) = &turning.rows[axis];
            let equation = self.row(turning.rate + axis, *left, right);
            let speeds = vec![Speed::Turning(number, axis)];
            MotionRow { speeds, lines: vec![line(&format!("{name}[{axis}]"), equation)] }
        };
        let rows = match &turning.euler {
            Some(euler) => {
                let speeds = [0, 1, 2].map(|axis| Speed::Turning(number, axis)).to_vec();
                vec![MotionRow { speeds, lines: self.euler(euler, quaternion) }]
            }
            None => (0..3).map(row).collect(),
        };
        [MotionRow { speeds: Vec::new(), lines: vec![relation] }].into_iter().chain(rows).collect()
    }

    /// I ω̇ + ω × I ω = N, and I if it is no parameter.
    fn euler(&self, euler: &Euler, quaternion: &str) -> Vec<Line> {
        let ([rate, acceleration], inertia) = (self.angular(quaternion), self.inertia(euler, quaternion));
        let times = |vector: Formula| Formula::Product(vec![inertia.clone(), vector], Vec::new());
        let gyroscopic = Formula::Call("cross".to_owned(), vec![rate.clone(), times(rate.clone())]);
        let mut terms = vec![times(acceleration), gyroscopic];
        let label = Some(Notation::UNICODE.write(&rate));
        let coupled = Some(&euler.coupled).filter(|coupled| **coupled != [Id::ZERO; 3]);
        let coupled = coupled.map(|coupled| self.vector_of_components(coupled)).transpose();
        let right = coupled.and_then(|coupled| {
            terms.extend(coupled);
            self.vector_of_components(&euler.torque)
        });
        let equation = Line { label, ..Line::known(Formula::sum(terms), right) };
        let is_parameter = self.matrix(&euler.inertia).is_some();
        let definition = (!is_parameter).then(|| Line::known(inertia, self.matrix_of(&euler.inertia)));
        [equation].into_iter().chain(definition).collect()
    }

    /// Name of the moments of inertia: of the parameter, or I with the name of the quaternion.
    fn inertia(&self, euler: &Euler, quaternion: &str) -> Formula {
        let parameter = self.matrix(&euler.inertia);
        let own = || self.letters.text_of(PageQuantity::Inertia, quaternion);
        Formula::labelled(&parameter.unwrap_or_else(own), 0)
    }

    /// ω and ω̇ of a quaternion.
    fn angular(&self, quaternion: &str) -> [Formula; 2] {
        [0, 1].map(|dots| self.letters.name_of(PageQuantity::AngularVelocity, quaternion, dots))
    }

    /// E = … + ½ ω·(I ω); `None` if no quaternion turns a body, or if L is not quadratic in the velocities.
    pub(super) fn energy_of_turnings(&self) -> Option<Result<Formula, u64>> {
        let Turnings { all, energy, .. } = &self.derived.turnings;
        let is_quadratic = !matches!(self.derived.facts.energy_form, EnergyForm::General);
        let [energy, _] = energy.filter(|_| is_quadratic)?;
        let spinning = all.iter().filter_map(|turning| {
            let quaternion = vector(&self.problem.coordinates[turning.first].text)?;
            let inertia = self.inertia(turning.euler.as_ref()?, quaternion);
            let [rate, _] = self.angular(quaternion);
            let momentum = Formula::Product(vec![inertia, rate.clone()], Vec::new());
            let dot = Formula::Call("dot".to_owned(), vec![rate, momentum]);
            Some(Formula::product(Rational::new(1, 2).into(), vec![dot], Vec::new()))
        });
        let spinning = spinning.collect::<Vec<_>>();
        Some(self.quantity(energy).map(|rest| match rest {
            _ if energy == Id::ZERO && !spinning.is_empty() => Formula::sum(spinning),
            Formula::Sum(terms) => Formula::Sum(spinning.into_iter().chain(terms).collect()),
            rest => Formula::sum(spinning.into_iter().chain([rest]).collect()),
        }))
    }

    pub(super) fn vector_of(&self, components: &[Id; 3]) -> Result<Formula, u64> {
        let components = components.iter().map(|&component| self.expression(component));
        Ok(Formula::Vector(components.collect::<Result<_, _>>()?))
    }

    pub(super) fn matrix_of(&self, rows: &[[Id; 3]; 3]) -> Result<Formula, u64> {
        rows.iter().map(|row| self.vector_of(row)).collect::<Result<_, u64>>().map(Formula::Vector)
    }

    /// A vector, or its components along the turned axes.
    pub(super) fn vector_of_components(&self, components: &[Id; 3]) -> Result<Formula, u64> {
        let by_components = || match self.vector_of(components)? {
            formula if length(&formula) > READABLE as usize => Err(length(&formula) as u64),
            formula => Ok(formula),
        };
        let vector = self.vector_expression(components).map(without_sign);
        vector.map_or_else(by_components, Ok)
    }

    /// Constraint force R = 2 q N + (R·q) q on a quaternion, where N is its torque along the turned axes: R·q̇ is N·ω for
    /// q̇ = ½ q ω.
    pub(super) fn force_on_quaternion(&self, turning: &Turning) -> Line {
        let quaternion = vector(&self.problem.coordinates[turning.first].text).unwrap_or_default();
        let (torque, along) = &turning.constraint;
        let q = || Formula::labelled(quaternion, 0);
        let force = self.vector_of_components(torque).and_then(|torque| {
            let (is_negative, torque) = torque.sign_and_magnitude();
            let two = Rational::from_integer(2).into();
            let turning = Formula::product(two, vec![q(), torque], Vec::new()).signed(is_negative);
            let along = vec![self.expression(*along)?, q()];
            let along = Formula::flat_product(Rational::one().into(), along, Vec::new());
            Ok(Formula::sum(vec![turning, along]))
        });
        let words = Remark::of(vec![Fragment::words("product of quaternions")]);
        Line {
            remark: words,
            ..Line::known(self.letters.name_of(PageQuantity::ConstraintForce, quaternion, 0), force)
        }
    }

    /// Name of the parameter whose entries these are.
    pub(super) fn matrix(&self, entries: &[[Id; 3]; 3]) -> Option<String> {
        let name = |id: Id| match self.graph.node(id) {
            Node::Symbol(symbol) => match Variable::of(*symbol) {
                Variable::Parameter(k) => Some(self.problem.parameters.name(k)),
                _ => None,
            },
            _ => None,
        };
        let whole = name(entries[0][0])?.strip_suffix("[0][0]")?.to_owned();
        let is_entry = |i: usize, j: usize| {
            let name = name(entries[i][j]);
            [[i, j], [j, i]].iter().any(|[i, j]| name.as_deref() == Some(&format!("{whole}[{i}][{j}]")))
        };
        let parameters = &self.problem.parameters;
        let names: Vec<String> = (0..parameters.entries.len()).map(|k| parameters.name(k)).collect();
        let is_used = |i: usize, j: usize| names.contains(&format!("{whole}[{i}][{j}]"));
        let first = names.iter().position(|name| *name == format!("{whole}[0][0]"))?;
        let is_symmetric = parameters.is_symmetric(parameters.entries[first]);
        (0..3).all(|i| (0..3).all(|j| is_entry(i, j) && (is_symmetric || is_used(i, j)))).then_some(whole)
    }
}

/// A vector whose minus sign turns the factors of a cross product around, as −(λ×p) = p×λ.
fn without_sign(vector: Formula) -> Formula {
    let is_cross = |formula: &Formula| matches!(formula, Formula::Call(name, _) if name == "cross");
    let (is_negative, mut vector) = vector.sign_and_magnitude();
    if let Formula::Product(above, _) = &mut vector
        && let Some(Formula::Call(name, sides)) = above.last_mut()
        && is_negative
        && name == "cross"
        && !sides.iter().any(is_cross)
    {
        sides.reverse();
        return vector;
    }
    vector.signed(is_negative)
}
