//! What is said of descriptions that are wrong.

use std::process::{Command, Output};

use lagrange_urdf::{Import, Options, import};

const BODY: &str = "<inertial><mass value='1'/>\
    <inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>";

fn robot(parts: &str) -> String {
    format!("<robot name='r'>{parts}</robot>")
}

fn link(name: &str) -> String {
    format!("<link name='{name}'>{BODY}</link>")
}

/// A joint with this type, and what else it has.
fn joint(name: &str, kind: &str, [parent, child]: [&str; 2], more: &str) -> String {
    format!(
        "<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>{more}</joint>"
    )
}

fn turns(name: &str, links: [&str; 2]) -> String {
    joint(name, "continuous", links, "")
}

fn errors_of(parts: &[&str], options: &Options) -> Vec<String> {
    import(&robot(&parts.concat()), options).expect_err("wrong")
}

/// The only error without options.
fn error_of(parts: &[&str]) -> String {
    let errors = errors_of(parts, &Options::default());
    assert_eq!(errors.len(), 1, "{errors:?}");
    errors.concat()
}

fn imported(parts: &[&str], options: &Options) -> Import {
    import(&robot(&parts.concat()), options).expect("a robot")
}

#[test]
fn no_link() {
    let errors = errors_of(&[], &Options::default());
    assert_eq!(errors, ["the robot has no `<link name=\"…\"/>`: add it, or expand xacro first"]);
}

#[test]
fn names_that_are_given_twice() {
    let errors = errors_of(&[&link("a"), &link("a")], &Options::default());
    assert!(errors.contains(&"two links have the name `a`".to_owned()), "{errors:?}");
    let links = [link("a"), link("b"), link("c")].concat();
    let error = error_of(&[&links, &turns("j", ["a", "b"]), &turns("j", ["a", "c"])]);
    assert_eq!(error, "two joints have the name `j`");
}

#[test]
fn several_roots() {
    let error = error_of(&[&link("a"), &link("b")]);
    assert_eq!(error, "there are 2 roots, `a`, `b`: all but one must be the child of a joint");
}

#[test]
fn a_cycle_without_a_root() {
    let links = [link("a"), link("b")].concat();
    let error = error_of(&[&links, &turns("j", ["a", "b"]), &turns("k", ["b", "a"])]);
    assert_eq!(error, "every link is the child of a joint: the joints go round in a cycle");
}

#[test]
fn a_cycle_beside_the_root() {
    let links = ["a", "b", "c", "d"].map(link).concat();
    let joints = [turns("j", ["a", "b"]), turns("k", ["c", "d"]), turns("l", ["d", "c"])].concat();
    assert_eq!(error_of(&[&links, &joints]), "the joints of `c`, `d` go round in a cycle");
}

#[test]
fn a_loop() {
    let links = ["a", "b", "c"].map(link).concat();
    let joints = [turns("j", ["a", "b"]), turns("k", ["a", "c"]), turns("l", ["b", "c"])].concat();
    let expected =
        "link `c` is the child of several joints, `k`, `l`: a loop must be cut, and closed by a constraint";
    assert_eq!(error_of(&[&links, &joints]), expected);
}

#[test]
fn a_link_that_is_not_there() {
    let error = error_of(&[&link("a"), &link("b"), &turns("j", ["a", "b"]), &turns("k", ["b", "c"])]);
    assert_eq!(error, "joint `k`: there is no link `c`, its child");
    // No link is called a root or part of a cycle because of that.
    for parents in [["bass_link", "base_link"], ["base_link", "bass_link"]] {
        let links = [link("base_link"), link("arm"), link("hand")].concat();
        let [first, second] = parents;
        let error = error_of(&[&links, &turns("j", [first, "arm"]), &turns("k", [second, "hand"])]);
        let joint = if first == "bass_link" { "j" } else { "k" };
        let expected =
            format!("joint `{joint}`: there is no link `bass_link`, its parent: did you mean `base_link`?");
        assert_eq!(error, expected);
    }
}

#[test]
fn a_link_without_inertia() {
    let error = error_of(&[&link("a"), "<link name='b'/>", &turns("j", ["a", "b"])]);
    let expected = "link `b` moves, and has neither mass nor inertia against the joint `j`, nor has what it carries: give \
                    it some, or --fix j";
    assert_eq!(error, expected);
    // A mass on the axis does not resist either; one beside it does, and so does what the link carries.
    let point = |x| {
        format!("<link name='b'><inertial><origin xyz='0 {x} 0'/><mass value='1'/>{NONE}</inertial></link>")
    };
    const NONE: &str = "<inertia ixx='0' ixy='0' ixz='0' iyy='0' iyz='0' izz='0'/>";
    assert_eq!(error_of(&[&link("a"), &point(0), &turns("j", ["a", "b"])]), expected);
    imported(&[&link("a"), &point(1), &turns("j", ["a", "b"])], &Options::default());
    let joints = [turns("j", ["a", "b"]), turns("k", ["b", "c"])].concat();
    let carrying = imported(&[&link("a"), "<link name='b'/>", &link("c"), &joints], &Options::default());
    assert!(!carrying.rust.contains("kinetic(b,"));
    // A joint that mimics another has no equation of its own.
    let follows = joint("k", "revolute", ["a", "c"], "<mimic joint='j'/>");
    let links = [link("a"), link("b"), "<link name='c'/>".to_owned()].concat();
    imported(&[&links, &turns("j", ["a", "b"]), &follows], &Options::default());
}

#[test]
fn a_free_root_without_inertia() {
    let floating = Options { floating: true, ..Options::default() };
    let errors = errors_of(&["<link name='a'/>", &link("b"), &turns("j", ["a", "b"])], &floating);
    assert_eq!(errors, ["the root `a` is free in space, and has no mass or inertia: give it some"]);
}

#[test]
fn nothing_that_moves() {
    let error = error_of(&[&link("a"), &link("b"), &joint("j", "fixed", ["a", "b"], "")]);
    assert_eq!(error, "no link of the robot moves: all joints are fixed, or --floating is missing");
}

#[test]
fn a_negative_mass() {
    let negative = link("b").replace("<mass value='1'/>", "<mass value='-2'/>");
    let error = error_of(&[&link("a"), &negative, &turns("j", ["a", "b"])]);
    assert_eq!(error, "link `b` has a negative mass, -2");
}

#[test]
fn numbers_that_are_not_finite() {
    let infinite = link("b").replace("ixx='1'", "ixx='inf'");
    let error = error_of(&[&link("a"), &infinite, &turns("j", ["a", "b"])]);
    assert_eq!(error, "link `b`: a number of its inertia is not finite");
    let far = joint("j", "revolute", ["a", "b"], "<origin xyz='0 NaN 0'/>");
    let error = error_of(&[&link("a"), &link("b"), &far]);
    assert_eq!(error, "joint `j`: a number of its origin or axis is not finite");
}

#[test]
fn an_inertia_that_no_body_has() {
    let with = |izz: &str| link("b").replace("izz='1'", izz);
    let notes = |izz| imported(&[&link("a"), &with(izz), &turns("j", ["a", "b"])], &Options::default()).notes;
    assert_eq!(notes("izz='2'"), [""; 0]);
    let expected = "link `b` has an inertia that no body has: of its principal moments, 1.0000e0, 1.0000e0 and 2.5000e0 \
                    kg m², the largest exceeds the sum of the others by 20.00 %";
    assert_eq!(notes("izz='2.5'"), [expected]);
    let expected = "link `b` has an inertia that no body has: a principal moment is negative, of -1.0000e0, 1.0000e0 and \
                    1.0000e0 kg m²";
    assert_eq!(notes("izz='-1'"), [expected]);
}

#[test]
fn an_axis_of_no_length() {
    let axis = "<axis xyz='0 0 0'/>";
    let still = joint("j", "revolute", ["a", "b"], axis);
    assert_eq!(error_of(&[&link("a"), &link("b"), &still]), "joint `j` has an axis of length zero");
    // A joint that is fixed needs none.
    let fixed = joint("k", "fixed", ["b", "c"], axis);
    imported(&[&["a", "b", "c"].map(link).concat(), &turns("j", ["a", "b"]), &fixed], &Options::default());
}

#[test]
fn negative_damping() {
    let pushed = joint("j", "revolute", ["a", "b"], "<dynamics damping='-1'/>");
    assert_eq!(error_of(&[&link("a"), &link("b"), &pushed]), "joint `j` has negative damping or friction");
}

#[test]
fn limits_that_no_motion_keeps() {
    let links = [link("a"), link("b")].concat();
    let with = |limit: &str| joint("j", "revolute", ["a", "b"], &format!("<limit {limit}/>"));
    for (limit, expected) in [
        (
            "lower='1' upper='-1' effort='1' velocity='1'",
            "joint `j`: its lower limit, 1, is above the upper, -1: exchange them, or correct a sign",
        ),
        (
            "lower='-1' upper='1' effort='-1' velocity='1'",
            "joint `j`: the limit of its effort, -1, is negative: write the magnitude",
        ),
        (
            "lower='-1' upper='1' effort='1' velocity='-2'",
            "joint `j`: the limit of its velocity, -2, is negative: write the magnitude",
        ),
        ("lower='nan' upper='1' effort='1' velocity='1'", "joint `j`: one of its limits is no number"),
    ] {
        assert_eq!(error_of(&[&links, &with(limit)]), expected);
    }
    let notes = |joint: &str| imported(&[&links, joint], &Options::default()).notes;
    for (limit, expected) in [
        ("lower='-1' upper='1' effort='1' velocity='1'", ""),
        ("effort='0' velocity='0'", "limits that are all zero are taken as missing, of the joints: `j`"),
        ("effort='1' velocity='1'", "lower and upper limit are the same, of the joints: `j`"),
        ("upper='1' effort='0' velocity='1'", "the limit of the effort is zero, of the joints: `j`"),
        ("upper='1' effort='1' velocity='0'", "the limit of the velocity is zero, of the joints: `j`"),
    ] {
        assert_eq!(notes(&with(limit)).concat(), expected);
    }
    let missing = "revolute and prismatic joints without <limit> are taken to have no limits: `j`";
    assert_eq!(notes(&joint("j", "revolute", ["a", "b"], "")), [missing]);
    // A joint that turns without end may well have none, and needs no positions.
    assert_eq!(notes(&turns("j", ["a", "b"])), [""; 0]);
    let endless = joint("j", "continuous", ["a", "b"], "<limit effort='1' velocity='1'/>");
    assert_eq!(notes(&endless), [""; 0]);
}

#[test]
fn joints_that_mimic_none() {
    let links = ["a", "b", "c"].map(link).concat();
    let of = |name: &str, links, other: &str| {
        joint(name, "continuous", links, &format!("<mimic joint='{other}'/>"))
    };
    let error = error_of(&[&links, &turns("j", ["a", "b"]), &of("k", ["b", "c"], "x")]);
    assert_eq!(error, "joint `k` mimics `x`: there is no joint of this name");
    let fixed = joint("finger", "fixed", ["a", "b"], "");
    let error = error_of(&[&links, &fixed, &of("k", ["b", "c"], "finger")]);
    assert_eq!(error, "joint `k` mimics `finger`, which does not move");
    let error = error_of(&[&links, &fixed, &of("k", ["b", "c"], "figner")]);
    assert_eq!(error, "joint `k` mimics `figner`: there is no joint of this name: did you mean `finger`?");
    let errors =
        errors_of(&[&links, &of("j", ["a", "b"], "k"), &of("k", ["b", "c"], "j")], &Options::default());
    let expected =
        ["joint `j` mimics `k`, which mimics it in turn", "joint `k` mimics `j`, which mimics it in turn"];
    assert_eq!(errors, expected);
    let planar = joint("j", "planar", ["a", "b"], "");
    let error = error_of(&[&links, &planar, &of("k", ["b", "c"], "j")]);
    assert_eq!(error, "joint `k` mimics `j`, which has several coordinates");
    let planar = joint("k", "planar", ["b", "c"], "<mimic joint='j'/>");
    let error = error_of(&[&links, &turns("j", ["a", "b"]), &planar]);
    assert_eq!(error, "joint `k` has several coordinates, and cannot mimic");
}

#[test]
fn options_with_names_that_are_not_there() {
    let options =
        Options { fixed: vec!["x".into()], tools: vec!["a".into(), "y".into()], ..Options::default() };
    let errors = errors_of(&[&link("a"), &link("b"), &turns("j", ["a", "b"])], &options);
    let expected = [
        "--fix x: there is no joint of this name",
        "--tool a: the link does not move",
        "--tool y: there is no link of this name",
    ];
    assert_eq!(errors, expected);
}

#[test]
fn all_errors_come_at_once() {
    let negative = link("b").replace("<mass value='1'/>", "<mass value='-2'/>");
    let still = joint("j", "revolute", ["a", "b"], "<axis xyz='0 0 0'/>");
    let errors = errors_of(&[&link("a"), &negative, &still, &link("c")], &Options::default());
    let expected = [
        "link `b` has a negative mass, -2",
        "joint `j` has an axis of length zero",
        "there are 2 roots, `a`, `c`: all but one must be the child of a joint",
    ];
    assert_eq!(errors, expected);
}

#[test]
fn names_that_must_change_are_noted() {
    let links = ["a", "elbow"].map(link).concat();
    let import = imported(&[&links, &turns("elbow", ["a", "elbow"])], &Options::default());
    let note = "names that had to change: `elbow` is `elbow_link`";
    assert_eq!(import.notes, [note]);
    assert!(import.rust.contains(&format!("\n// Note: {note}.\n")), "{}", import.rust);
}

#[test]
fn angles_that_are_nearly_right_are_noted_or_read() {
    let origin = joint("j", "continuous", ["a", "b"], "<origin rpy='0 0 1.5708'/>");
    let parts = [&link("a"), &link("b"), &*origin];
    let kept = imported(&parts, &Options::default());
    assert!(kept.rust.contains("rotate_z(1.5708)") && kept.notes[0].contains("--right-angles"), "{kept:?}");
    let read = imported(&parts, &Options { right_angles: true, ..Options::default() });
    assert!(read.rust.contains("rotate_z(pi/2)") && read.notes.is_empty(), "{read:?}");
}

#[test]
fn friction_that_is_left_out_is_noted() {
    let dry = "<dynamics damping='2' friction='1'/>";
    let links = ["a", "b", "c"].map(link).concat();
    let parts = [&*links, &joint("j", "continuous", ["a", "b"], dry), &joint("k", "planar", ["b", "c"], dry)];
    let expected = [
        "damping and friction are left out of joints with several coordinates: `k`",
        "dry friction is left out without --friction, of the joints: `j`",
    ];
    assert_eq!(imported(&parts, &Options::default()).notes, expected);
    let rubbing = imported(&parts, &Options { friction: true, ..Options::default() });
    assert_eq!(rubbing.notes, expected[..1]);
}

/// An inertia without a mass has no weight.
#[test]
fn a_flywheel_without_a_mass() {
    let wheel = link("b").replace("<mass value='1'/>", "<mass value='0'/>");
    let rust = imported(&[&link("a"), &wheel, &turns("j", ["a", "b"])], &Options::default()).rust;
    assert!(
        rust.contains("#[lagrangian(\n    kinetic(b, b_body.m, b_body.centre, b_body.inertia)\n)]"),
        "{rust}"
    );
}

/// rustc takes 127 attributes unless the crate asks for more.
#[test]
fn robots_of_many_links_have_few_attributes() {
    let names: Vec<String> = (0..60).map(|k| format!("l{k}")).collect();
    let links: String = names.iter().map(|name| link(name)).collect();
    let joints: String =
        names.windows(2).map(|pair| turns(&pair[1].replace('l', "j"), [&pair[0], &pair[1]])).collect();
    let import = imported(&[&links, &joints], &Options::default());
    let attributes = import.rust.lines().filter(|line| line.starts_with("#[")).count();
    assert!(attributes < 20 && import.notes.is_empty(), "{attributes} attributes, {:?}", import.notes);
}

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lagrange-urdf")).args(arguments).output().expect("it runs")
}

#[test]
fn the_program_says_what_is_wrong_and_fails() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/robots/");
    let arm = format!("{folder}two_link.urdf");
    let written = run(&["--tool", "tip", &arm]);
    let expected = std::fs::read_to_string(format!("{folder}two_link.rs")).expect("a file");
    let note = "note: dry friction is left out without --friction, of the joints: `shoulder`\n";
    assert!(written.status.success());
    let [text, said] = [written.stdout, written.stderr].map(|bytes| String::from_utf8(bytes).expect("text"));
    assert_eq!((text, said.as_str()), (expected, note));
    assert_eq!(run(&["--help"]).stdout, lagrange_urdf::HELP.as_bytes());
    for (arguments, expected) in [
        (&["nowhere.urdf"][..], "error: nowhere.urdf: "),
        (&[], "error: one file is expected, found 0; see --help\n"),
        (&[&arm, &arm], "error: one file is expected, found 2; see --help\n"),
        (&["--fast", &arm], "error: unknown option --fast; see --help\n"),
        (&["--limts", &arm], "error: unknown option --limts: did you mean `--limits`?\n"),
        (&[&arm, "--tool"], "error: --tool is followed by a name; see --help\n"),
    ] {
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(1));
        assert!(output.stdout.is_empty());
        let said = String::from_utf8(output.stderr).expect("text");
        assert!(said.starts_with(expected), "{said}");
    }
}
