//! Systems with contacts and friction as rendered. `UPDATE_EXPECT=1 cargo test` accepts a change.

use expect_test::expect;

use super::golden::{check, rendered};
use super::golden_lines::lines;

/// Gaps and the multipliers of contacts are complementary; impacts take energy, but no momentum along the floor.
#[test]
fn contacts_are_complementary() {
    check(
        "#[coordinates(x, y)]
         #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
         #[contact(floor: y >= r, restitution: e)]
         struct Ball { m: f64, g: f64, r: f64, e: f64, floor: Contact }",
        expect![[r#"
            Ball

            Lagrangian
              L = ½ m (ẋ² + ẏ²) − m g y

            Constraints
              floor: 0 ≤ y − r ⊥ λ_floor ≥ 0   (holonomic; restitution e)

            Equations of motion
              x: ẍ = 0
              y: m ÿ = −m g + λ_floor

            Constraint forces
              R_y = λ_floor

            Conserved
              p_x = m ẋ
              E = ½ m (ẋ² + ẏ²) + m g y   (T + U if U is m g y; between impacts)

            Momenta
              p_y = m ẏ

            Hamiltonian
              H = (p_x² + p_y²)/(2 m) + m g y

            Hamilton's equations
              ẋ = p_x/m
              ẏ = p_y/m
              ṗ_x = 0
              ṗ_y = λ_floor − m g
        "#]],
        expect![[r#"
            \begingroup\allowdisplaybreaks
            \par\medskip\noindent\textbf{Lagrangian}
            \begin{align}
              L &= \tfrac{1}{2} m (\dot x^2 + \dot y^2) - m g y \label{eq:Ball-L}
            \end{align}
            \par\medskip\noindent\textbf{Constraints}
            \begin{align}
              0 \le y - r &\perp \lambda_{\mathrm{floor}} \ge 0 \quad \text{(holonomic; }\text{restitution }e\text{)} \label{eq:Ball-floor}
            \end{align}
            \par\medskip\noindent\textbf{Equations of motion}
            \begin{align}
              \ddot x &= 0 \label{eq:Ball-x} \\
              m \ddot y &= -m g + \lambda_{\mathrm{floor}} \label{eq:Ball-y}
            \end{align}
            \par\medskip\noindent\textbf{Constraint forces}
            \begin{align}
              R_y &= \lambda_{\mathrm{floor}} \label{eq:Ball-R_y}
            \end{align}
            \par\medskip\noindent\textbf{Conserved}
            \begin{align}
              p_x &= m \dot x \label{eq:Ball-p_x} \\
              E &= \tfrac{1}{2} m (\dot x^2 + \dot y^2) + m g y \quad \text{(}T + U\text{ if }U\text{ is }m g y\text{; }\text{between impacts)} \label{eq:Ball-E}
            \end{align}
            \par\medskip\noindent\textbf{Momenta}
            \begin{align}
              p_y &= m \dot y \label{eq:Ball-p_y}
            \end{align}
            \par\medskip\noindent\textbf{Hamiltonian}
            \begin{align}
              H &= \frac{p_x^2 + p_y^2}{2 m} + m g y \label{eq:Ball-H}
            \end{align}
            \par\medskip\noindent\textbf{Hamilton's equations}
            \begin{align}
              \dot x &= \frac{p_x}{m} \label{eq:Ball-x-dot} \\
              \dot y &= \frac{p_y}{m} \label{eq:Ball-y-dot} \\
              \dot p_x &= 0 \label{eq:Ball-p-dot_x} \\
              \dot p_y &= \lambda_{\mathrm{floor}} - m g \label{eq:Ball-p-dot_y}
            \end{align}
            \endgroup
        "#]],
    );
    check(
        "#[coordinates(z, a)]
         #[lagrangian(m/2 * z_dot^2 + j/2 * a_dot^2 - m*g*z)]
         #[define(leg = [z + a, z - a])]
         #[contact(legs[i in 0..2]: leg[i] >= 0)]
         #[constraint(level: a = 0, when: held)]
         struct Table { m: f64, j: f64, g: f64, legs: [Contact; 2], held: bool }",
        expect![[r#"
            Table

            Lagrangian
              L = ½ m ż² + ½ j ȧ² − m g z
              leg = [z + a, z − a]

            Constraints
              legs[i = 0 … 1]: 0 ≤ leg[i] ⊥ λ_legs[i] ≥ 0   (holonomic; restitution 0)
              level:           a = 0   (holonomic; while held is true)

            Equations of motion
              z: m z̈ = −m g + λ_legs[1] + λ_legs[0]
              a: j ä = λ_legs[0] + λ_level − λ_legs[1]

            Constraint forces
              R_z = λ_legs[1] + λ_legs[0]
              R_a = λ_legs[0] + λ_level − λ_legs[1]

            Conserved
              E = ½ m ż² + ½ j ȧ² + m g z   (T + U if U is m g z; between impacts)

            Momenta
              p_z = m ż
              p_a = j ȧ

            Hamiltonian
              H = p_z²/(2 m) + p_a²/(2 j) + m g z

            Hamilton's equations
              ż = p_z/m
              ȧ = p_a/j
              ṗ_z = λ_legs[0] + λ_legs[1] − m g
              ṗ_a = λ_legs[0] + λ_level − λ_legs[1]
        "#]],
        expect![[r#"
            \begingroup\allowdisplaybreaks
            \par\medskip\noindent\textbf{Lagrangian}
            \begin{align}
              L &= \tfrac{1}{2} m \dot z^2 + \tfrac{1}{2} j \dot a^2 - m g z \label{eq:Table-L} \\
              \mathbf{leg} &= [z + a, z - a] \label{eq:Table-leg}
            \end{align}
            \par\noindent Indices count from 0, as in the program.
            \par\medskip\noindent\textbf{Constraints}
            \begin{align}
              0 \le \mathit{leg}_i &\perp \lambda_{\mathrm{legs}, i} \ge 0 \quad \text{(holonomic; }\text{restitution }0\text{)} \label{eq:Table-legs-i-0-1} \\
              a &= 0 \quad \text{(holonomic; }\text{while }\mathit{held}\text{ is true)} \label{eq:Table-level}
            \end{align}
            \par\medskip\noindent\textbf{Equations of motion}
            \begin{align}
              m \ddot z &= -m g + \lambda_{\mathrm{legs}, 1} + \lambda_{\mathrm{legs}, 0} \label{eq:Table-z} \\
              j \ddot a &= \lambda_{\mathrm{legs}, 0} + \lambda_{\mathrm{level}} - \lambda_{\mathrm{legs}, 1} \label{eq:Table-a}
            \end{align}
            \par\medskip\noindent\textbf{Constraint forces}
            \begin{align}
              R_z &= \lambda_{\mathrm{legs}, 1} + \lambda_{\mathrm{legs}, 0} \label{eq:Table-R_z} \\
              R_a &= \lambda_{\mathrm{legs}, 0} + \lambda_{\mathrm{level}} - \lambda_{\mathrm{legs}, 1} \label{eq:Table-R_a}
            \end{align}
            \par\medskip\noindent\textbf{Conserved}
            \begin{align}
              E &= \tfrac{1}{2} m \dot z^2 + \tfrac{1}{2} j \dot a^2 + m g z \quad \text{(}T + U\text{ if }U\text{ is }m g z\text{; } \nonumber \\*
                &\quad \text{between impacts)} \label{eq:Table-E}
            \end{align}
            \par\medskip\noindent\textbf{Momenta}
            \begin{align}
              p_z &= m \dot z \label{eq:Table-p_z} \\
              p_a &= j \dot a \label{eq:Table-p_a}
            \end{align}
            \par\medskip\noindent\textbf{Hamiltonian}
            \begin{align}
              H &= \frac{p_z^2}{2 m} + \frac{p_a^2}{2 j} + m g z \label{eq:Table-H}
            \end{align}
            \par\medskip\noindent\textbf{Hamilton's equations}
            \begin{align}
              \dot z &= \frac{p_z}{m} \label{eq:Table-z-dot} \\
              \dot a &= \frac{p_a}{j} \label{eq:Table-a-dot} \\
              \dot p_z &= \lambda_{\mathrm{legs}, 0} + \lambda_{\mathrm{legs}, 1} - m g \label{eq:Table-p-dot_z} \\
              \dot p_a &= \lambda_{\mathrm{legs}, 0} + \lambda_{\mathrm{level}} - \lambda_{\mathrm{legs}, 1} \label{eq:Table-p-dot_a}
            \end{align}
            \endgroup
        "#]],
    );
}

/// Elastic impacts keep the energy.
#[test]
fn elastic_contacts_keep_the_energy() {
    let source = |restitution: &str| {
        format!(
            "#[coordinates(x: [2])]
             #[lagrangian(m/2 * (x_dot[0]^2 + x_dot[1]^2))]
             #[contact(wall: x[0] >= 0, restitution: 1)]
             #[contact(blocks: x[1] - x[0] >= 0, restitution{restitution})]
             struct Blocks {{ m: f64, e: f64, wall: Contact, blocks: Contact }}"
        )
    };
    for (restitution, is_kept) in [(": 1", true), (": e", false), (": 1/2", false), ("(poisson): 1", false)] {
        let [[text, latex, _], ..] = rendered(&source(restitution)).forms;
        for (form, start) in [(text, "E = "), (latex, "E &= ")] {
            let energy = form.split_once(start).and_then(|(_, rest)| rest.split("\n\n").next());
            let energy = energy.and_then(|rest| rest.split("\\label").next()).expect("an energy");
            assert_eq!(energy.contains("between impacts"), !is_kept, "{restitution}: {form}");
        }
    }
}

#[test]
fn the_law_of_an_impact_is_named() {
    let source = "#[coordinates(y)]
         #[lagrangian(m/2 * y_dot^2 - m*g*y)]
         #[contact(floor: y >= 0, restitution(poisson): e)]
         struct Ball { m: f64, g: f64, e: f64, floor: Contact }";
    assert_eq!(
        lines(source, "Constraints\n"),
        "floor: 0 ≤ y ⊥ λ_floor ≥ 0   (holonomic; restitution e by Poisson's law)"
    );
    let elastic = source.replace(": e)", ": 1)");
    assert!(!rendered(&elastic).forms[0][0].contains("between impacts"));
}

/// Friction that sticks does no work.
#[test]
fn friction_takes_energy_where_it_slides() {
    let source = "#[coordinates(x, y)]
         #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
         #[contact(floor: y >= 0, friction(mu): x_dot)]
         struct Block { m: f64, g: f64, mu: f64, floor: Contact }";
    let [[text, latex, _], ..] = rendered(source).forms;
    assert!(text.contains("floor: ") && text.contains("0 ≤ y ⊥ λ_floor ≥ 0"), "{text}");
    let energy = text.lines().find(|line| line.trim_start().starts_with("E = "));
    assert!(energy.is_some_and(|line| line.ends_with("; between impacts; while nothing slides)")), "{text}");
    assert!(latex.contains("while nothing slides"), "{latex}");
}

/// Where a ball rolls on a floor, friction has no force, and the momentum along it stays; where it slides, it does not. Friction
/// between two sledges keeps their sum, and a leg that presses alone turns a table.
#[test]
fn momenta_are_conserved_whether_bodies_stick_slide_or_part() {
    let ball = "#[coordinates(x, y, phi)]
         #[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m/5 * r^2 * phi_dot^2 - m*g*y)]
         #[contact(floor: y - r >= 0, friction(mu): x_dot - r*phi_dot)]
         struct Ball { m: f64, g: f64, mu: f64, r: f64, floor: Contact }";
    let sledges = "#[coordinates(a, b)]
         #[lagrangian(m/2 * (a_dot^2 + 2*b_dot^2))]
         #[friction(rope: a_dot - b_dot, sliding: hold)]
         #[conserved(total = m*(a_dot + 2*b_dot))]
         struct Sledges { m: f64, hold: f64, rope: Friction }";
    let table = "#[coordinates(z, a)]
         #[lagrangian(m/2 * z_dot^2 + j/2 * a_dot^2 - m*g*z)]
         #[contact(left: z + a >= 0)]
         #[contact(right: z - a >= 0)]
         struct Table { m: f64, j: f64, g: f64, left: Contact, right: Contact }";
    // Walls face each other, so that most combinations of closed contacts contradict one another.
    let boxed = "#[coordinates(x: [3], y: [3])]
         #[lagrangian(m/2 * sum(i in 0..3, x_dot[i]^2 + y_dot[i]^2))]
         #[contact(left[i in 0..3]: x[i] >= 0, restitution: 1, friction(mu): y_dot[i])]
         #[contact(right[i in 0..3]: 1 - x[i] >= 0, restitution: 1)]
         #[conserved(px = m*(x_dot[0] + x_dot[1] + x_dot[2]))]
         struct Boxed { m: f64, mu: f64, left: [Contact; 3], right: [Contact; 3] }";
    for (source, kept) in [(ball, "E"), (sledges, "E total"), (table, "E"), (boxed, "p_x p_y E px")] {
        let conserved = lines(source, "Conserved\n");
        let names: Vec<&str> = conserved.lines().filter_map(|line| line.trim().split(' ').next()).collect();
        assert_eq!(names.join(" "), kept, "{conserved}");
        // An impulse changes them, though no force does.
        let is_said = |line: &str| line.contains("between impacts");
        assert!(source != boxed || conserved.lines().all(is_said), "{conserved}");
    }
}

#[test]
fn coefficients_at_rest_and_of_sliding_are_printed() {
    let source = "#[coordinates(x, y)]
         #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
         #[contact(floor: y >= 0, friction(static: mu, kinetic: nu): x_dot)]
         struct Block { m: f64, g: f64, mu: f64, nu: f64, floor: Contact }";
    let law = "(while floor sticks; |λ_floor_friction| ≤ μ λ_floor; slides with ν λ_floor)";
    let printed = lines(source, "Constraints\n");
    assert!(printed.ends_with(&format!("floor_friction: ẋ = 0   {law}")), "{printed}");
}
