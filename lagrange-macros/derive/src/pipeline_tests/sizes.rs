//! Long fields that cost nothing, and long input that is refused before it costs much.

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

/// Entries of a field that are not used leave no code. Its length appears only in the type of the field, for the
/// struct over lanes.
#[test]
fn of_a_long_field_only_what_is_used_is_emitted() {
    for scalar in ["f64", "T"] {
        let [short, long] = [29, 29_999].map(|length| expansion(length, scalar));
        assert!(!short.contains("compile_error"), "{short}");
        assert_eq!(short.replace("29", ""), long.replace("29999", ""));
        assert!(long.contains(r#""m" , "eps[0]" , "rows[1][2]""#), "{long}");
    }
}

/// The first error gives the size of the Lagrangian. Without functions there are no further errors. The Lagrangian
/// uses the largest accepted number of field entries.
#[test]
fn a_lagrangian_that_no_function_holds_is_refused_as_a_whole() {
    let source = "#[coordinates(x)]
        #[lagrangian(x_dot^2/2 - sum(k in 0..7, sum(i in 0..9_990, eps[i]*eps[i + k]))*x + eps[9_999])]
        struct Large { eps: [f64; 10_000] }";
    let [error] = &said(source)[..] else { panic!("one error") };
    // Operations: x_dot^2/2, a minus and a plus, 69,930 products, one addition less, and one product.
    assert!(error.contains("the Lagrangian takes 139864 operations"), "{error}");
}

/// Returns the errors for a system.
fn said(source: &str) -> Vec<String> {
    let emitted = expand(tokens(source)).to_string();
    let errors = emitted.split("compile_error ! {").skip(1);
    errors.filter_map(|rest| rest.split('"').nth(1)).map(String::from).collect()
}

#[test]
fn more_numbers_than_parameters_can_be_are_refused_where_they_are_used() {
    let wanted = "the expressions use more than 10000 numbers of fields: leave them to a function";
    for (term, field) in [
        ("dot(eps, eps)", "eps"),
        ("norm(table*table[0])", "table"),
        ("norm(table*table[0]) + dot(eps, eps)", "table"),
        ("sum(i in 0..9_999, eps[i]*x^i) + few[0]*few[1]*few[2]", "few"),
        ("sum(i in 0..9_999, eps[i]*x^i) + dot(few, few)", "few"),
        ("norm(rows[0]) + dot(eps, eps)", "eps"),
    ] {
        let source = format!(
            "#[coordinates(x)]
             #[lagrangian(x_dot^2/2 - {term})]
             #[observable(first = eps[0])]
             struct Large {{
                 eps: [f64; 99_999], few: [f64; 3], table: SMatrix<f64, 300, 300>, rows: [[f64; 100]; 101]
             }}"
        );
        let found = said(&source);
        assert!(found[0].starts_with(&format!("with `{field}` {wanted}")), "{term}: {found:?}");
    }
}

#[test]
fn ranges_too_long_to_be_written_out_are_refused() {
    for attributes in [
        "#[define(w[i in 0..10_001] = i*x)] #[lagrangian(x_dot^2 - w[3])]",
        "#[define(w[0] = x)] #[define(w[i in 1..100_000] = w[i-1] + x)] #[lagrangian(x_dot^2 - w[99_999])]",
        "#[lagrangian(x_dot^2 - sum(i in 0..100_000, x^i))]",
        "#[lagrangian(x_dot^2)] #[constraint(c[i in 0..100_000]: x = i)]",
    ] {
        let found = said(&format!("#[coordinates(x)] {attributes} struct Long;"));
        let wanted = "the range ends beyond 10000: leave so many parts to a function, `#[function(U(x))]`";
        assert!(found[0].starts_with(wanted), "{attributes}: {found:?}");
    }
    let longest = "#[coordinates(x)] #[lagrangian(x_dot^2 - sum(i in 0..10_000, x))] struct Long;";
    assert_eq!(said(longest), [""; 0]);
}

#[test]
fn functions_have_no_more_results_than_can_be_called_for() {
    let system = |length| {
        format!(
            "#[coordinates(x)] #[function(f(t): [{length}])] #[lagrangian(x_dot^2 - f(t)[1]*x)] struct S<F> {{ f: F }}"
        )
    };
    assert_eq!(said(&system(1000)), [""; 0]);
    assert_eq!(said(&system(1001)), ["a function has at most 1000 results"]);
}
