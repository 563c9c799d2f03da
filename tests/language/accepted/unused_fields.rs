//! Fields that no expression uses may have any type and any name.
use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2)]
#[allow(dead_code, reason = "that fields may be unused is what is shown")]
struct System<'a, T, const N: usize> {
    m: f64,
    label: String,
    limit: Option<f32>,
    table: [T; N],
    other: &'a (bool, u8),
    t: f64,
    sin: f64,
}

#[test]
fn unused_fields_may_be_anything() {
    let system = System {
        m: 1.0,
        label: String::new(),
        limit: None,
        table: ['a', 'b'],
        other: &(true, 1),
        t: 0.0,
        sin: 0.0,
    };
    assert_eq!(system.accelerations_unchecked(&State::at_rest([0.0])).accelerations[0], 0.0);
}
