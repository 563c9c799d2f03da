//! Options of the command line.

use crate::names::suggestion;
use crate::robot::{JointType, Robot};

/// Text of `--help`.
pub const HELP: &str = "\
Writes a robot described by URDF as a Rust struct with #[derive(Lagrangian)].

Usage: lagrange-urdf [options] robot.urdf > robot.rs

  --floating       the root link is free in space, by a position and a quaternion
  --numbers        masses, centres of mass, inertias and damping are numbers in the equations, not fields
  --friction       dry friction of the joints, from <dynamics friction=\"…\"/>
  --limits         joints stop at their lower and upper limits, by contacts
  --contact LINK   the origin of the link touches the floor z = 0, with friction; may be repeated
  --right-angles   angles that are multiples of π/2 to all digits written, as 1.5708, are read as these
  --tool LINK      the link has observables: its position, velocity and Jacobian; may be repeated
  --fix JOINT      the joint stays at 0; may be repeated
  --name NAME      name of the struct; without it, that of the robot
  --help           this text

What is wrong goes to stderr, all at once, with exit status 1. Notes on what differs from the description go to stderr, and into
the file as comments.
";

/// Options of an import: which joints move, and what is written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// The root link is free in space.
    pub floating: bool,
    /// Properties of bodies and joints are numbers in the equations, not fields.
    pub numbers: bool,
    /// Joints have dry friction.
    pub friction: bool,
    /// Joints stop at their limits.
    pub limits: bool,
    /// Links whose origins touch the floor.
    pub contacts: Vec<String>,
    /// Angles that are multiples of π/2 to all digits written are read as these.
    pub right_angles: bool,
    /// Links that have observables.
    pub tools: Vec<String>,
    /// Joints that stay at 0.
    pub fixed: Vec<String>,
    /// Name of the struct.
    pub name: Option<String>,
}

impl Options {
    /// Reads the arguments of the command line after the program's name. Returns the options and the file.
    pub fn parse(arguments: impl IntoIterator<Item = String>) -> Result<(Self, String), Vec<String>> {
        let (mut options, mut files, mut errors) = (Self::default(), Vec::new(), Vec::new());
        let mut arguments = arguments.into_iter();
        while let Some(argument) = arguments.next() {
            if let Err(error) = options.take(&argument, &mut arguments, &mut files) {
                errors.push(error);
            }
        }
        match <[String; 1]>::try_from(files) {
            Ok([file]) if errors.is_empty() => Ok((options, file)),
            Ok(_) => Err(errors),
            Err(files) => {
                errors.push(format!("one file is expected, found {}; see --help", files.len()));
                Err(errors)
            }
        }
    }

    fn take(
        &mut self,
        argument: &str,
        rest: &mut impl Iterator<Item = String>,
        files: &mut Vec<String>,
    ) -> Result<(), String> {
        let mut value = || rest.next().ok_or_else(|| format!("{argument} is followed by a name; see --help"));
        match argument {
            "--floating" => self.floating = true,
            "--numbers" => self.numbers = true,
            "--friction" => self.friction = true,
            "--limits" => self.limits = true,
            "--contact" => self.contacts.push(value()?),
            "--right-angles" => self.right_angles = true,
            "--tool" => self.tools.push(value()?),
            "--fix" => self.fixed.push(value()?),
            "--name" => self.name = Some(value()?),
            _ if argument.starts_with('-') => {
                let known: Vec<&str> =
                    HELP.split_whitespace().filter(|word| word.starts_with("--")).collect();
                let meant = suggestion(argument, &known);
                let end = if meant.is_empty() { "; see --help" } else { &meant };
                return Err(format!("unknown option {argument}{end}"));
            }
            _ => files.push(argument.to_owned()),
        }
        Ok(())
    }

    /// Makes the joints of `--fix` fixed ones. Returns errors.
    pub(crate) fn fix_joints(&self, robot: &mut Robot) -> Vec<String> {
        let mut errors = Vec::new();
        for name in &self.fixed {
            if let Some(joint) = robot.joints.iter_mut().find(|joint| joint.name == *name) {
                joint.kind = JointType::Fixed;
            } else {
                let known: Vec<&str> = robot.joints.iter().map(|joint| joint.name.as_str()).collect();
                let meant = suggestion(name, &known);
                errors.push(format!("--fix {name}: there is no joint of this name{meant}"));
            }
        }
        errors
    }
}
