//! Numbers and angles as text.

use std::f64::consts::FRAC_PI_2;

use crate::robot::Robot;

/// A number of Rust, in shortest form.
pub(crate) fn rust(x: f64) -> String {
    match x {
        f64::INFINITY => "f64::INFINITY".to_owned(),
        f64::NEG_INFINITY => "f64::NEG_INFINITY".to_owned(),
        _ => format!("{:?}", x + 0.0),
    }
}

/// A number of an expression: as in Rust, whole ones without a point.
pub(crate) fn expression(x: f64) -> String {
    let text = rust(x);
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// A vector of an expression.
pub(crate) fn vector(entries: &[f64]) -> String {
    format!("[{}]", entries.iter().map(|x| expression(*x)).collect::<Vec<_>>().join(", "))
}

/// An angle of an expression. Multiples of π/2 are written as such where they are that to the last bit.
pub(crate) fn angle(x: f64) -> String {
    let quarters = (x / FRAC_PI_2).round();
    if x == 0.0 || quarters * FRAC_PI_2 != x {
        return expression(x);
    }
    match quarters {
        1.0 => "pi/2".to_owned(),
        -1.0 => "-pi/2".to_owned(),
        2.0 => "pi".to_owned(),
        -2.0 => "-pi".to_owned(),
        _ => format!("{}*pi/2", expression(quarters)),
    }
}

/// Reads angles of origins that are multiples of π/2 to all their digits as these if `read` is true; otherwise returns a
/// note that there are some.
pub(crate) fn right_angles(robot: &mut Robot, read: bool) -> Option<String> {
    let links = robot.links.iter_mut().map(|link| &mut link.inertial.origin);
    let joints = robot.joints.iter_mut().map(|joint| &mut joint.origin);
    let mut found = None;
    for angle in links.chain(joints).flat_map(|origin| origin.rpy.iter_mut()) {
        let Some(right) = right_angle(*angle).filter(|right| right != angle) else { continue };
        found.get_or_insert(*angle);
        if read {
            *angle = right;
        }
    }
    let found = found.filter(|_| !read)?;
    Some(format!(
        "angles such as {found} are multiples of π/2 to all digits written: --right-angles reads them so, which makes \
         the equations shorter"
    ))
}

/// Multiple of π/2 that is this number when it is rounded or cut to as many digits after the point, of which there are at
/// least three.
fn right_angle(x: f64) -> Option<f64> {
    let quarters = (x / FRAC_PI_2).round();
    let exact = quarters * FRAC_PI_2;
    let digits = format!("{x}").split_once('.').map_or(0, |(_, after)| after.len());
    let unit = 10_f64.powi(-i32::try_from(digits.min(17)).unwrap_or(17));
    let is_right = quarters != 0.0 && digits >= 3 && (x - exact).abs() < unit;
    is_right.then_some(exact)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_back_as_they_are() {
        for x in [0.0, -0.0, 1.0, -2.5, 0.1 + 0.2, 1e-7, 1e22, f64::MIN_POSITIVE, -f64::MAX] {
            assert_eq!(expression(x).parse::<f64>().map(f64::to_bits), Ok((x + 0.0).to_bits()));
        }
        assert_eq!([expression(-3.0), rust(-3.0), rust(f64::INFINITY)], ["-3", "-3.0", "f64::INFINITY"]);
    }

    #[test]
    fn right_angles_are_those_to_all_digits() {
        for (text, quarters) in [
            ("1.571", Some(1.0)),
            ("1.5708", Some(1.0)),
            ("-1.57079632679", Some(-1.0)),
            ("3.14159", Some(2.0)),
            ("3.1416", Some(2.0)),
            ("-4.712388980384", Some(-3.0)),
            ("1.57", None),
            ("1.5709", None),
            ("1.56", None),
            ("0.0001", None),
            ("3.1415", Some(2.0)),
            ("3.1414", None),
        ] {
            let x: f64 = text.parse().expect("a number");
            assert_eq!(right_angle(x), quarters.map(|quarters| quarters * FRAC_PI_2), "{text}");
        }
        let angles = [1.0, -1.0, 2.0, -2.0, 3.0].map(|quarters| angle(quarters * FRAC_PI_2));
        assert_eq!(angles, ["pi/2", "-pi/2", "pi", "-pi", "3*pi/2"]);
        assert_eq!("1.5708".parse().map(angle), Ok("1.5708".to_owned()));
    }
}
