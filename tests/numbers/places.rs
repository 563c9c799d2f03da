//! Where a system may be declared, and from where its observables can be reached.

use lagrange_core::prelude::*;

mod springs {
    use lagrange_core::Lagrangian;

    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(m/2*x_dot^2 - k/2*x^2)]
    #[observable(stretch = x)]
    pub(crate) struct Visible {
        pub(crate) m: f64,
        pub(crate) k: f64,
    }

    /// The same names again, and private.
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(m/2*x_dot^2 - k*x^4)]
    #[observable(stretch = 2*x)]
    struct Hidden {
        m: f64,
        k: f64,
    }

    pub(crate) fn stretch_of_the_hidden_one(x: f64) -> f64 {
        use lagrange_core::State;
        let hidden = Hidden { m: 1.0, k: 1.0 };
        hidden.stretch(&State::at_rest([x]))
    }

    pub(crate) mod inner {
        use lagrange_core::Lagrangian;

        #[derive(Lagrangian)]
        #[coordinates(x)]
        #[lagrangian(m/2*x_dot^2)]
        #[observable(stretch = 3*x)]
        pub(in crate::places) struct Restricted {
            pub(in crate::places) m: f64,
        }
    }
}

mod sibling {
    use lagrange_core::State;

    pub(crate) fn stretch(x: f64) -> f64 {
        super::springs::Visible { m: 1.0, k: 1.0 }.stretch(&State::at_rest([x]))
    }
}

#[test]
fn observables_are_as_visible_as_their_struct() {
    let restricted = springs::inner::Restricted { m: 1.0 };
    assert_eq!(sibling::stretch(0.5), 0.5);
    assert_eq!(springs::stretch_of_the_hidden_one(0.5), 1.0);
    assert_eq!(restricted.stretch(&State::at_rest([0.5])), 1.5);
}

#[test]
fn a_system_may_stand_in_a_function() {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(m/2*x_dot^2 - m*g*x)]
    struct Falling {
        m: f64,
        g: f64,
    }

    let falling = Falling { m: 2.0, g: 9.81 };
    assert_eq!(falling.accelerations_unchecked(&State::at_rest([0.0])).accelerations[0], -9.81);
}

/// The emitted code names nothing that its surroundings could redefine.
#[test]
fn surroundings_may_shadow_the_prelude() {
    #[allow(dead_code, non_camel_case_types, reason = "they are there to shadow")]
    mod shadowing {
        type f64 = lagrange_core::Error;
        struct Option;
        struct Some;
        struct None;

        #[derive(lagrange_core::Lagrangian)]
        #[coordinates(x)]
        #[lagrangian(m/2*x_dot^2)]
        #[observable(twice = 2*x)]
        pub(super) struct Number<T> {
            pub(super) m: T,
        }
    }

    let number = shadowing::Number { m: 2.0 };
    let state = State::new([0.5], [0.0]);
    let solution = number.accelerations_unchecked(&state);
    assert_eq!(number.observable(0, &state, &solution), Some(1.0));
    assert_eq!(number.observable(1, &state, &solution), None);
}
