//! Text of a description as links and joints.

use urdf_rs::Robot;

/// Elements that say how a robot looks, and their ends. The equations do not depend on them: faults in them do no harm.
const LOOKS: [(&str, &str); 3] =
    [("<visual", "</visual>"), ("<collision", "</collision>"), ("<material", "</material>")];

/// Types of joints.
const TYPES: &str = "revolute, continuous, prismatic, fixed, floating, planar or spherical";

/// Reads a description.
pub(crate) fn read(description: &str) -> Result<Robot, String> {
    let mut text = without(description, |rest| rest.starts_with("<!--").then_some("-->"));
    for (begin, end) in LOOKS {
        text = without(&text, |rest| element_end(rest, begin, end));
    }
    urdf_rs::read_from_string(&text).map_err(|error| {
        let hint = match error.to_string() {
            error if error.contains("unknown variant") => format!("the type of a joint is {TYPES}"),
            _ => "a description is XML with the root element `robot`; expand xacro first".to_owned(),
        };
        format!("the description cannot be read: {error}: {hint}")
    })
}

/// The text without all that begins where `begins` returns an end, and goes up to that.
fn without(text: &str, begins: impl Fn(&str) -> Option<&'static str>) -> String {
    let (mut kept, mut rest) = (String::new(), text);
    while let Some(place) = rest.find('<') {
        kept.push_str(&rest[..place]);
        rest = &rest[place..];
        match begins(rest).and_then(|end| Some(rest.find(end)? + end.len())) {
            Some(end) => rest = &rest[end..],
            None => {
                kept.push('<');
                rest = &rest[1..];
            }
        }
    }
    kept + rest
}

/// Where the element ends that begins here, if it is one of this kind.
fn element_end(text: &str, begin: &str, end: &'static str) -> Option<&'static str> {
    let rest = text.strip_prefix(begin)?;
    let is_name = rest.starts_with(|c: char| c.is_whitespace() || c == '>' || c == '/');
    let tag = rest.get(..rest.find('>')?)?;
    is_name.then_some(if tag.ends_with('/') { "/>" } else { end })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_and_comments_are_not_read() {
        let robot = read(
            "<robot name='r'><!-- <visual> --><material name='m'/><link name='a'><visual><geometry/></visual></link>
            <material name='n'><texture/></material><!-- <link name='c'/> --><link name='b'><collision/></link></robot>",
        );
        let names: Vec<String> = robot.expect("a robot").links.into_iter().map(|link| link.name).collect();
        assert_eq!(names, ["a", "b"]);
    }
}
