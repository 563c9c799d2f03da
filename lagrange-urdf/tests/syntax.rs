//! What is said of text that is no description: the element, its line, and what to write.

use lagrange_urdf::{Import, Options, import};

/// A pendulum without faults, a statement a line.
const PENDULUM: &str = r#"<robot name="r">
  <link name="base"/>
  <joint name="hinge" type="revolute">
    <parent link="base"/>
    <child link="bob"/>
    <origin xyz="0 0 1" rpy="0 0 0.5"/>
    <axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="2" velocity="3"/>
    <dynamics damping="0.7" friction="0"/>
  </joint>
  <link name="bob">
    <visual><geometry/></visual>
    <inertial>
      <origin xyz="0 0 -1"/>
      <mass value="2.5"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>
    </inertial>
  </link>
</robot>
"#;

fn with(from: &str, to: &str) -> Result<Import, Vec<String>> {
    assert_eq!(PENDULUM.matches(from).count(), 1, "{from}");
    import(&PENDULUM.replace(from, to), &Options::default())
}

#[test]
fn faults_are_said_of_the_link_or_joint_with_the_line() {
    for (from, to, expected) in [
        // Values.
        (
            r#"value="2.5""#,
            r#"value="2.5kg""#,
            r#"link `bob`, line 15: `value="2.5kg"` of `mass` has `2.5kg` for a number: write `value="0.5"` or the like, in SI units without their names"#,
        ),
        (
            r#"rpy="0 0 0.5""#,
            r#"rpy="0 0""#,
            r#"joint `hinge`, line 6: `rpy="0 0"` of `origin` has 2 numbers in place of 3: write `rpy="0 0 1"` or the like"#,
        ),
        (
            r#"effort="2""#,
            r#"effort="${effort}""#,
            r#"joint `hinge`, line 8: `effort="${effort}"` of `limit` is not expanded: expand xacro first, by `xacro robot.urdf.xacro > robot.urdf`"#,
        ),
        (
            r#"type="revolute""#,
            r#"type="screw""#,
            r#"joint `hinge`, line 3: `type="screw"` of `joint` is no type of a joint: they are revolute, continuous, prismatic, fixed, floating, planar, spherical"#,
        ),
        // What is missing.
        (
            r#"      <mass value="2.5"/>"#,
            "",
            r#"link `bob`, line 13: `inertial` is without `<mass value="0.5"/>`: add it"#,
        ),
        (r#"<mass value="2.5"/>"#, "<mass/>", r#"link `bob`, line 15: `mass` is without `value="0.5"`"#),
        (
            r#"<child link="bob"/>"#,
            "",
            r#"joint `hinge`, line 3: `joint` is without `<child link="…"/>`: add it"#,
        ),
        (r#" velocity="3""#, "", r#"joint `hinge`, line 8: `limit` is without `velocity="0.5"`"#),
        (r#"<link name="base"/>"#, "<link/>", r#"link, line 2: `link` is without `name="…"`"#),
        // Names.
        (
            r#"damping="0.7""#,
            r#"dampign="0.7""#,
            "joint `hinge`, line 9: `dynamics` has no attribute `dampign`: did you mean `damping`?",
        ),
        (
            r#"<limit lower"#,
            r#"<limits lower"#,
            "joint `hinge`, line 8: `joint` has no element `limits`: did you mean `limit`?",
        ),
        (
            r#"<link name="base"/>"#,
            r#"<Link name="base"/>"#,
            "line 2: `robot` has no element `Link`: did you mean `link`?",
        ),
        (
            r#"<axis xyz="0 1 0"/>"#,
            r#"<axis xyz="0 1 0"/> <axis xyz="1 0 0"/>"#,
            "joint `hinge`, line 3: `joint` has 2 of `axis`: leave one",
        ),
        (
            r#"rpy="0 0 0.5""#,
            r#"quat_xyzw="0 0 0 1""#,
            r#"joint `hinge`, line 6: `quat_xyzw` is read from version 1.1 on: write `<robot version="1.1" …>`, or `rpy`"#,
        ),
        (
            r#"rpy="0 0 0.5""#,
            r#"rpy="0 0 0.5" quat_xyzw="0 0 0 1""#,
            "joint `hinge`, line 6: `origin` has both `rpy` and `quat_xyzw`: leave one",
        ),
    ] {
        assert_eq!(with(from, to).expect_err("wrong"), [expected], "{from} → {to}");
    }
    assert_eq!(with("\"base\"/>\n  <joint", "\"base\"/>\n  <joint").expect("a robot").notes, [""; 0]);
}

#[test]
fn text_that_is_not_xml_is_said_of_the_element_that_is_open() {
    for (from, to, expected) in [
        (
            "</robot>\n",
            "",
            "line 19: Unexpected end of stream: still inside the root element: robot `r` of line 1 is not closed: write \
             `</robot>` or `/>`",
        ),
        (
            "  </joint>\n",
            "",
            "line 18: Unexpected closing tag: robot != joint: joint `hinge` of line 3 is not closed: write `</joint>` or \
             `/>`",
        ),
        (
            r#"link="bob""#,
            "link=bob",
            "line 5: Unexpected token: b: the mistake is within joint `hinge` of line 3",
        ),
        (
            r#"<link name="base"/>"#,
            r#"<xacro:arm name="base"/>"#,
            "line 2: Element xacro:arm prefix is unbound: expand xacro first, by `xacro robot.urdf.xacro > robot.urdf`",
        ),
    ] {
        assert_eq!(with(from, to).expect_err("wrong"), [expected], "{from} → {to}");
    }
    let error = |text: &str| import(text, &Options::default()).expect_err("wrong").concat();
    for text in ["", "no XML"] {
        assert!(error(text).contains("it is XML with the root element `robot`"), "{}", error(text));
    }
    assert_eq!(error("<sdf version='1.7'/>"), "the root element is `sdf`: that of URDF is `robot`");
    let macros = "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'>\n<xacro:arm/></robot>";
    assert!(
        error(macros).starts_with("line 2: `xacro:arm` is not of URDF: expand xacro first"),
        "{}",
        error(macros)
    );
}

/// All errors of a text come at once, in its order.
#[test]
fn several_faults() {
    let text = PENDULUM.replace("dampign", "damping").replace("0 0 1", "0 1").replace("\"2.5\"", "\"\"");
    let errors = import(&text, &Options::default()).expect_err("wrong");
    let starts =
        ["joint `hinge`, line 6: `xyz=\"0 1\"`", "link `bob`, line 15: `value=\"\"` of `mass` has 0 numbers"];
    assert_eq!(errors.len(), 2, "{errors:?}");
    assert!(errors.iter().zip(starts).all(|(error, start)| error.starts_with(start)), "{errors:?}");
}

#[test]
fn what_is_not_read_is_noted_where_equations_might_depend_on_it() {
    let spring = with(r#"friction="0""#, r#"spring_stiffness="40""#).expect("a robot");
    let note = "joint `hinge`, line 9: the attribute `spring_stiffness` of `dynamics` is not read";
    assert_eq!(spring.notes, [note]);
    assert!(spring.rust.contains(&format!("\n// Note: {note}.\n")), "{}", spring.rust);
    // Extensions of simulators, and what says how a link looks, are none of the equations.
    for extension in
        ["<gazebo reference='bob'/>", "<transmission><joint name='x'/></transmission>", "<material/>"]
    {
        let import =
            with("<link name=\"base\"/>", &format!("<link name=\"base\"><contact/></link>{extension}"));
        assert_eq!(import.expect("a robot").notes, [""; 0], "{extension}");
    }
    let safe = with(r#"<axis xyz="0 1 0"/>"#, r#"<axis xyz="0 1 0"/><safety_controller/><calibration/>"#);
    assert_eq!(safe.expect("a robot").notes, [""; 0]);
}

/// From version 1.2 on, what a limit does not state is infinite; rotations may be quaternions from 1.1 on.
#[test]
fn versions_of_the_format() {
    let version = |number: &str, from: &str, to: &str| {
        let text = PENDULUM.replace(from, to).replace("<robot", &format!("<robot version='{number}'"));
        import(&text, &Options::default()).expect("a robot").rust
    };
    let limit = version("1.2", r#"effort="2" "#, "");
    assert!(limit.contains("position: [-1.0, 1.0], velocity: 3.0, effort: f64::INFINITY }"), "{limit}");
    // Half a right angle about y.
    let turned =
        version("1.1", r#"rpy="0 0 0.5""#, r#"quat_xyzw="0 0.3826834323650898 0 0.9238795325112867""#);
    assert!(turned.contains("translate([0, 0, 1]), rotate_y(0.785398163397448"), "{turned}");
}
