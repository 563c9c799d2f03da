//! Robots described by URDF as structs with `#[derive(Lagrangian)]`.
//!
//! [`import`] reads a description and returns Rust for people to read and edit; the program `lagrange-urdf` does so for
//! a file. Each joint that moves has a coordinate of its name, each link that moves a frame; links that are fixed to
//! another become part of it. All quantities are in SI units, angles in radians.

mod body;
mod check;
mod grammar;
mod limits;
mod names;
mod number;
mod options;
mod pose;
mod robot;
mod steps;
mod syntax;
mod tree;
mod write;
mod xml;

pub use options::{HELP, Options};
use robot::Robot;
use tree::Tree;

/// A robot as Rust.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Import {
    /// Text of a module: a struct with its attributes, default values and the limits of its joints.
    pub rust: String,
    /// What differs from the description or is missing in it, one sentence each. The text has them as comments.
    pub notes: Vec<String>,
}

/// Returns the robot that the text of a URDF file describes, or all that is wrong with it, one message each.
///
/// ```
/// let description = r#"
///     <robot name="swing">
///       <link name="frame"/>
///       <joint name="hinge" type="continuous">
///         <parent link="frame"/> <child link="seat"/> <axis xyz="0 1 0"/>
///       </joint>
///       <link name="seat">
///         <inertial>
///           <origin xyz="0 0 -2"/> <mass value="20"/>
///           <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>
///         </inertial>
///       </link>
///     </robot>"#;
/// let swing = lagrange_urdf::import(description, &lagrange_urdf::Options::default())?;
/// assert!(swing.rust.contains("seat: rotate_y(hinge)\n"));
/// assert!(swing.rust.contains("seat_body: Body::new(20.0, [0.0, 0.0, -2.0], [1.0, 0.0, 0.0, 1.0, 0.0, 1.0])"));
/// # Ok::<(), Vec<String>>(())
/// ```
///
/// # Errors
/// What the equations of motion cannot do without: one root, a body for each link that moves, axes of some length.
pub fn import(description: &str, options: &Options) -> Result<Import, Vec<String>> {
    let root = xml::parse(description).map_err(|error| vec![error])?;
    let found = syntax::check(&root);
    if !found.errors.is_empty() {
        return Err(found.errors);
    }
    let mut robot = Robot::of(&root);
    let mut errors = options.fix_joints(&mut robot);
    errors.extend(check::errors(&robot));
    let mut notes: Vec<String> = found.notes().collect();
    notes.extend(robot.links.iter().filter_map(check::impossible_inertia));
    notes.extend(number::right_angles(&mut robot, options.right_angles));
    let missing = check::missing_links(&robot);
    if !missing.is_empty() || robot.links.is_empty() {
        // Joints between links that do not exist make no tree, and further errors would only be consequences.
        return Err(errors.into_iter().chain(missing).collect());
    }
    let tree = match Tree::new(&robot, options) {
        Ok(tree) if errors.is_empty() => tree,
        Ok(_) => return Err(errors),
        Err(more) => return Err(errors.into_iter().chain(more).collect()),
    };
    notes.extend(check::left_out(&tree.links, options.friction));
    let labels = names::Labels::new(&robot.name, &tree, options);
    notes.extend(limits::notes(&tree.links));
    notes.extend(labels.notes());
    let rust = write::write(&robot.name, &tree, &labels, options, &notes);
    Ok(Import { rust, notes })
}
