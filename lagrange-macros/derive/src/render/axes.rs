//! Names of the matrices of rotations by quaternions: A_q turns the components c of a vector along the turned axes into those
//! along the fixed ones, the vector part of q (0, c) q*.

use super::formula::Formula;
use super::length::length;
use super::lines::{Equation, Line};
use super::page::Page;
use super::remark::{Fragment, Remark};
use super::roots::{is_taken, taken};
use crate::mechanics::Turnings;
use crate::resolve::{Problem, vector};
use crate::symbolic::{Graph, Id, Node};

/// Letters for a matrix: the first that is free.
const LETTERS: [&str; 3] = ["A", "C", "S"];

/// A rotation matrix with its name.
pub(super) struct NamedAxes {
    /// Name of the matrix, with the index of its quaternion among several.
    pub(super) text: String,
    pub(super) quaternion: Formula,
    /// Entries by rows, for |q| = 1.
    pub(super) entries: [[Id; 3]; 3],
    /// Nodes with the values of the entries: themselves, and those where |q| is not replaced by 1.
    pub(super) nodes: Vec<(Id, [usize; 2])>,
}

impl NamedAxes {
    pub(super) fn name(&self) -> Formula {
        Formula::labelled(&self.text, 0)
    }

    pub(super) fn entry(&self, [i, j]: [usize; 2]) -> Formula {
        Formula::labelled(&format!("{}[{i}][{j}]", self.text), 0)
    }
}

/// Names of the rotation matrices of a system.
pub(super) fn named_axes(problem: &Problem, turnings: &Turnings) -> Vec<NamedAxes> {
    let taken = taken(problem);
    let name = |letter: &str, quaternion: &str| format!("{letter}_{quaternion}");
    let turned = turnings.all.iter().filter_map(|turning| {
        let quaternion = vector(&problem.coordinates[turning.first].text)?;
        Some((quaternion, turning.axes?))
    });
    let turned: Vec<_> = turned.collect();
    let is_free =
        |letter: &&&str| turned.iter().all(|(quaternion, _)| !is_taken(&taken, &name(letter, quaternion)));
    let Some(letter) = LETTERS.iter().find(is_free) else { return Vec::new() };
    let named = turned.iter().map(|&(quaternion, [written, entries])| {
        let nodes = [entries, written]
            .into_iter()
            .flat_map(|axes| (0..3).flat_map(move |i| (0..3).map(move |j| (axes[i][j], [i, j]))));
        let (text, quaternion) = (name(letter, quaternion), Formula::labelled(quaternion, 0));
        NamedAxes { text, quaternion, entries, nodes: nodes.collect() }
    });
    named.collect()
}

/// What a definition stands for.
fn defined(graph: &Graph, id: Id) -> Id {
    if let &Node::Defined(inner) = graph.node(id) { inner } else { id }
}

impl Page<'_> {
    /// Length of a formula with the definitions of the matrices in it.
    pub(super) fn length(&self, formula: &Formula) -> usize {
        let of_axes = self.axes.iter().zip(&self.axes_lengths);
        let of_axes = of_axes.filter(|(axes, _)| formula.has_name(&axes.name())).map(|(_, length)| length);
        length(formula) + of_axes.sum::<usize>()
    }

    pub(super) fn definition(&self, axes: &NamedAxes) -> Result<Formula, u64> {
        let row = |row: &[Id; 3]| {
            let entries = row.iter().map(|&entry| self.expression(defined(self.graph, entry)));
            Ok(Formula::Vector(entries.collect::<Result<_, u64>>()?))
        };
        axes.entries.iter().map(row).collect::<Result<_, u64>>().map(Formula::Vector)
    }

    /// Lines of the rotation matrices that these lines mention.
    pub(super) fn axes_lines<'l>(&self, lines: impl Iterator<Item = &'l Line> + Clone) -> Vec<Line> {
        let mentioned = self.axes.iter().filter(|axes| lines.clone().any(|line| line.has_name(&axes.name())));
        let line = |axes: &NamedAxes| {
            let remark = vec![
                Fragment::words("matrix of the rotation by "),
                Fragment::Formula(axes.quaternion.clone()),
                Fragment::words(", from the turned axes to the fixed ones"),
            ];
            let right = self.definition(axes).ok()?;
            let line = Line::of(Equation::Known(axes.name(), right));
            Some(Line { remark: Remark::of(remark), ..line })
        };
        mentioned.filter_map(line).collect()
    }
}
