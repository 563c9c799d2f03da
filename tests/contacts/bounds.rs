//! Contacts that have no gradient, ends that are none, and systems behind pointers.

use lagrange_core::contact::Contact;
use lagrange_core::{Ending, Lagrangian, prelude::*};

/// A gap whose gradient vanishes where it closes.
#[derive(Clone, Lagrangian)]
#[coordinates(y)]
#[lagrangian(m/2 * y_dot^2 - m*g*y)]
#[contact(floor: y^3 >= 0)]
struct Cubed {
    m: f64,
    g: f64,
    floor: Contact,
}

#[test]
fn a_gap_without_a_gradient_is_named() {
    let cubed = Cubed { m: 1.0, g: 9.81, floor: Contact::Open };
    let path = cubed.motion(State::at_rest([1.0])).with_contacts().towards(2.0).unwrap();
    let Ending::Unsolved { error, time } = path.ending() else { panic!("{}", path.ending()) };
    assert!(matches!(error, Error::NoGradient { constraint: "floor", .. }), "{error}");
    assert!((time - (2.0_f64 / 9.81).sqrt()).abs() < 1e-9, "{time}");
    assert!(path.end().q[0].abs() < 1e-9);
}

#[test]
fn ends_that_are_none() {
    let cubed = Cubed { m: 1.0, g: 9.81, floor: Contact::Open };
    for end in [f64::NAN, f64::INFINITY] {
        let error = cubed.motion(State::at_rest([1.0])).with_contacts().to(end).unwrap_err();
        assert!(matches!(error, Error::EndNotFinite { .. }), "{error}");
    }
    let error = cubed.motion(State::at_rest([1.0])).with_contacts().to(-1.0).unwrap_err();
    assert!(matches!(error, Error::MotionBackwards { .. }), "{error}");
    // No time passes, and nothing happens.
    let path = cubed.motion(State::at_rest([1.0])).with_contacts().to(0.0).unwrap();
    assert!(path.transitions().is_empty() && path.end().q[0] == 1.0);
}

/// What a pointer does not forward would have the default: no contacts, and all constraints on.
#[test]
fn systems_behind_pointers_have_their_contacts() {
    fn of<L: Lagrangian<Scalar = f64>>(system: &L) -> (bool, f64) {
        (L::HAS_CONTACTS, system.compliance()[0])
    }
    let cubed = Cubed { m: 1.0, g: 9.81, floor: Contact::Open };
    assert_eq!([of(&cubed), of(&&cubed), of(&Box::new(cubed.clone()))], [(true, 1.0); 3]);
}
