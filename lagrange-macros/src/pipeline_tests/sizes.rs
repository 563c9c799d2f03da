//! What costs nothing, and what is refused before it costs much.

use super::tokens;
use crate::expand;

fn expansion(length: usize, scalar: &str) -> String {
    let source = format!(
        "#[coordinates(x)]
         #[lagrangian(m/2 * x_dot^2 - (eps[0] - rows[1][2])*x^2/2)]
         struct Large<T> {{ m: {scalar}, eps: [{scalar}; {length}], rows: [[{scalar}; 3]; {length}] }}"
    );
    expand(tokens(&source)).to_string()
}

/// Of the length nothing is left but the field's type, where the struct is put on lanes.
#[test]
fn of_a_long_field_only_what_is_used_is_emitted() {
    for scalar in ["f64", "T"] {
        let [short, long] = [29, 29_999].map(|length| expansion(length, scalar));
        assert!(!short.contains("compile_error"), "{short}");
        assert_eq!(short.replace("29", ""), long.replace("29999", ""));
        assert!(long.contains(r#""m" , "eps[0]" , "rows[1][2]""#), "{long}");
    }
}

/// The first error says how large it is; there are no functions, and so no errors of theirs.
#[test]
fn a_lagrangian_that_no_function_holds_is_refused_as_a_whole() {
    let source = "#[coordinates(x)]
        #[lagrangian(x_dot^2/2 - dot(eps, eps)*x)]
        struct Large { eps: [f64; 60_000] }";
    let emitted = expand(tokens(source)).to_string();
    assert_eq!(emitted.matches("compile_error").count(), 1, "{emitted}");
    // x_dot^2/2 and a minus, 60,000 squares, 59,999 sums and one product.
    assert!(emitted.contains("the Lagrangian takes 120003 operations"), "{emitted}");
}
