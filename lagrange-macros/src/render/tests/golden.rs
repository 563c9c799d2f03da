//! Whole systems, as they are to be read. `UPDATE_EXPECT=1 cargo test` accepts a change.

use expect_test::{Expect, expect};

use super::reader::assert_balanced;
use crate::diagnostics::Diagnostics;
use crate::render::{Rendered, render};
use crate::{mechanics, resolve, syntax};

fn rendered(source: &str) -> Rendered {
    let mut diagnostics = Diagnostics::default();
    let input = syn::parse_str(source).expect("a struct");
    let declaration = syntax::declaration(input, &mut diagnostics);
    let (mut graph, problem) = resolve::problem(&declaration, &mut diagnostics).expect("no errors");
    let derived = mechanics::derive(&mut graph, &problem, &mut diagnostics).expect("no errors");
    render(&declaration, &graph, &problem, &derived)
}

fn check(source: &str, text: Expect, latex: Expect) {
    let rendered = rendered(source);
    assert_balanced(&rendered.latex);
    text.assert_eq(&rendered.text);
    latex.assert_eq(&rendered.latex);
}

/// Milton (8.8)–(8.10).
#[test]
fn sphere_down_an_incline() {
    check(
        "#[coordinates(x, phi)]
         #[define(inertia = 2/5 * m * a^2)]
         #[lagrangian(m/2 * x_dot^2 + inertia/2 * phi_dot^2 + m*g*x*sin(alpha))]
         #[constraint(no_slip: x_dot - a*phi_dot = 0)]
         struct RollingSphere { m: f64, a: f64, g: f64, alpha: f64 }",
        expect![[r#"
            RollingSphere

            Lagrangian
              L = ½ m ẋ² + ½ inertia φ̇² + m g x sin α
              inertia = ⅖ m a²

            Constraints
              no_slip: ẋ − a φ̇ = 0   (integrable: x − a φ is constant)

            Equations of motion
              x: m ẍ = m g sin α + λ_no_slip
              φ: inertia φ̈ = −a λ_no_slip

            Conserved
              E = ½ m ẋ² + ½ inertia φ̇² − m g x sin α   (T + U)
        "#]],
        expect![[r#"
            \begin{align*}
              L &= \tfrac{1}{2} \, m \, \dot{x}^{2} + \tfrac{1}{2} \, \mathit{inertia} \, \dot{\phi}^{2} + m \, g \, x \, \sin \alpha \\
              \mathit{inertia} &= \tfrac{2}{5} \, m \, a^{2} \\
              \dot{x} - a \, \dot{\phi} &= 0 \\
              m \, \ddot{x} &= m \, g \, \sin \alpha + \lambda_{\mathrm{no\_slip}} \\
              \mathit{inertia} \, \ddot{\phi} &= -a \, \lambda_{\mathrm{no\_slip}} \\
              E &= \tfrac{1}{2} \, m \, \dot{x}^{2} + \tfrac{1}{2} \, \mathit{inertia} \, \dot{\phi}^{2} - m \, g \, x \, \sin \alpha \\
            \end{align*}
        "#]],
    );
}

/// Milton (8.11)–(8.14).
#[test]
fn spherical_pendulum() {
    check(
        "#[coordinates(x, y, z)]
         #[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
         #[constraint(string: (x^2 + y^2 + z^2 - l^2)/2 = 0)]
         struct SphericalPendulum { m: f64, g: f64, l: f64 }",
        expect![[r#"
            SphericalPendulum

            Lagrangian
              L = ½ m (ẋ² + ẏ² + ż²) − m g z

            Constraints
              string: ½ (x² + y² + z² − l²) = 0   (holonomic)

            Equations of motion
              x: m ẍ = λ_string x
              y: m ÿ = λ_string y
              z: m z̈ = −m g + λ_string z

            Conserved
              E = ½ m (ẋ² + ẏ² + ż²) + m g z   (T + U)
        "#]],
        expect![[r#"
            \begin{align*}
              L &= \tfrac{1}{2} \, m \, \left(\dot{x}^{2} + \dot{y}^{2} + \dot{z}^{2}\right) - m \, g \, z \\
              \tfrac{1}{2} \, \left(x^{2} + y^{2} + z^{2} - l^{2}\right) &= 0 \\
              m \, \ddot{x} &= \lambda_{\mathrm{string}} \, x \\
              m \, \ddot{y} &= \lambda_{\mathrm{string}} \, y \\
              m \, \ddot{z} &= -m \, g + \lambda_{\mathrm{string}} \, z \\
              E &= \tfrac{1}{2} \, m \, \left(\dot{x}^{2} + \dot{y}^{2} + \dot{z}^{2}\right) + m \, g \, z \\
            \end{align*}
        "#]],
    );
}

/// Milton (8.23).
#[test]
fn spherical_pendulum_in_angles() {
    check(
        "#[coordinates(theta, phi)]
         #[lagrangian(m*l^2/2 * (theta_dot^2 + sin(theta)^2*phi_dot^2) + m*g*l*cos(theta))]
         struct SphericalPendulum { m: f64, g: f64, l: f64 }",
        expect![[r#"
            SphericalPendulum

            Lagrangian
              L = ½ m l² (θ̇² + sin²(θ) φ̇²) + m g l cos θ

            Equations of motion
              θ: m l² θ̈ = m l² sin θ cos(θ) φ̇² − m l g sin θ
              φ: m l² sin²(θ) φ̈ = −2 m l² sin θ cos(θ) θ̇ φ̇

            Conserved
              p_phi = m l² sin²(θ) φ̇
              E = ½ m l² (θ̇² + sin²(θ) φ̇²) − m l g cos θ   (T + U)
        "#]],
        expect![[r#"
            \begin{align*}
              L &= \tfrac{1}{2} \, m \, l^{2} \, \left(\dot{\theta}^{2} + \sin^{2}\left(\theta\right) \, \dot{\phi}^{2}\right) + m \, g \, l \, \cos \theta \\
              m \, l^{2} \, \ddot{\theta} &= m \, l^{2} \, \sin \theta \, \cos\left(\theta\right) \, \dot{\phi}^{2} - m \, l \, g \, \sin \theta \\
              m \, l^{2} \, \sin^{2}\left(\theta\right) \, \ddot{\phi} &= -2 \, m \, l^{2} \, \sin \theta \, \cos\left(\theta\right) \, \dot{\theta} \, \dot{\phi} \\
              p_{\phi} &= m \, l^{2} \, \sin^{2}\left(\theta\right) \, \dot{\phi} \\
              E &= \tfrac{1}{2} \, m \, l^{2} \, \left(\dot{\theta}^{2} + \sin^{2}\left(\theta\right) \, \dot{\phi}^{2}\right) - m \, l \, g \, \cos \theta \\
            \end{align*}
        "#]],
    );
}

/// Milton (8.44).
#[test]
fn rotating_frame() {
    check(
        "#[coordinates(r: [3])]
         #[function(Omega(t): [3] = spin)]
         #[function(A(t): [3] = acceleration)]
         #[function(U(r) = potential)]
         #[define(v = r_dot)]
         #[define(W = Omega(t))]
         #[lagrangian(m/2*dot(v, v) + m/2*dot(cross(W, r), cross(W, r)) + m*dot(v, cross(W, r)) - U(r) - m*dot(r, A(t)))]
         struct RotatingFrame { m: f64, spin: Spin, acceleration: Acceleration, potential: Potential }",
        expect![[r#"
            RotatingFrame

            Lagrangian
              L = ½ m v·v + ½ m (W×r)·(W×r) + m v·(W×r) − U(r) − m r·A(t)
              v = ṙ
              W = Ω(t)

            Equations of motion
              r[0]: m r̈[0] = W[2] (m (W[2] r[0] − W[0] r[2]) + m ṙ[1]) + m (Ω[2]′(t) r[1] + W[2] ṙ[1] − Ω[1]′(t) r[2] − W[1] ṙ[2]) − m A[0](t) − ∂U/∂r[0] − W[1] (m (W[0] r[1] − W[1] r[0]) + m ṙ[2])
              r[1]: m r̈[1] = W[0] (m (W[0] r[1] − W[1] r[0]) + m ṙ[2]) + m (Ω[0]′(t) r[2] + W[0] ṙ[2] − Ω[2]′(t) r[0] − W[2] ṙ[0]) − m A[1](t) − ∂U/∂r[1] − W[2] (m (W[1] r[2] − W[2] r[1]) + m ṙ[0])
              r[2]: m r̈[2] = W[1] (m (W[1] r[2] − W[2] r[1]) + m ṙ[0]) + m (Ω[1]′(t) r[0] + W[1] ṙ[0] − Ω[0]′(t) r[1] − W[0] ṙ[1]) − m A[2](t) − ∂U/∂r[2] − W[0] (m (W[2] r[0] − W[0] r[2]) + m ṙ[1])
        "#]],
        expect![[r#"
            \begin{align*}
              L &= \tfrac{1}{2} \, m \, v \cdot v + \tfrac{1}{2} \, m \, \left(W \times r\right) \cdot \left(W \times r\right) + m \, v \cdot \left(W \times r\right) - U\left(r\right) - m \, r \cdot A\left(t\right) \\
              v &= \dot{r} \\
              W &= \Omega\left(t\right) \\
              m \, \ddot{r}_{0} &= W_{2} \, \left(m \, \left(W_{2} \, r_{0} - W_{0} \, r_{2}\right) + m \, \dot{r}_{1}\right) + m \, \left(\Omega_{2}'\left(t\right) \, r_{1} + W_{2} \, \dot{r}_{1} - \Omega_{1}'\left(t\right) \, r_{2} - W_{1} \, \dot{r}_{2}\right) - m \, A_{0}\left(t\right) - \frac{\partial U}{\partial r_{0}} - W_{1} \, \left(m \, \left(W_{0} \, r_{1} - W_{1} \, r_{0}\right) + m \, \dot{r}_{2}\right) \\
              m \, \ddot{r}_{1} &= W_{0} \, \left(m \, \left(W_{0} \, r_{1} - W_{1} \, r_{0}\right) + m \, \dot{r}_{2}\right) + m \, \left(\Omega_{0}'\left(t\right) \, r_{2} + W_{0} \, \dot{r}_{2} - \Omega_{2}'\left(t\right) \, r_{0} - W_{2} \, \dot{r}_{0}\right) - m \, A_{1}\left(t\right) - \frac{\partial U}{\partial r_{1}} - W_{2} \, \left(m \, \left(W_{1} \, r_{2} - W_{2} \, r_{1}\right) + m \, \dot{r}_{0}\right) \\
              m \, \ddot{r}_{2} &= W_{1} \, \left(m \, \left(W_{1} \, r_{2} - W_{2} \, r_{1}\right) + m \, \dot{r}_{0}\right) + m \, \left(\Omega_{1}'\left(t\right) \, r_{0} + W_{1} \, \dot{r}_{0} - \Omega_{0}'\left(t\right) \, r_{1} - W_{0} \, \dot{r}_{1}\right) - m \, A_{2}\left(t\right) - \frac{\partial U}{\partial r_{2}} - W_{0} \, \left(m \, \left(W_{2} \, r_{0} - W_{0} \, r_{2}\right) + m \, \dot{r}_{1}\right) \\
            \end{align*}
        "#]],
    );
}

#[test]
fn functions_families_and_vectors() {
    check(
        "#[coordinates(a: [2], b: [2], s)]
         #[function(pair(s) = interaction)]
         #[function(f(r: [2], s) = surface)]
         #[define(p[0] = a)]
         #[define(p[i in 1..3] = p[i-1] + b/i)]
         #[lagrangian(dot(a_dot, a_dot)/2 + norm(b_dot)^2/2 + s_dot^2/2 - pair(norm(a - b)) - f(a, s) - f([s, 1], s) - sum(i in 0..3, p[i][0]))]
         #[force(a: -k*a_dot)]
         #[constraint(meet: cross([a[0], a[1], 0], [b[0], b[1], 0])[2] = 0)]
         struct Everything { k: f64, interaction: Pair, surface: Surface }",
        expect![[r#"
            Everything

            Lagrangian
              L = ½ ȧ·ȧ + ½ |ḃ|² + ½ ṡ² − pair(|a − b|) − f(a, s) − f([s, 1], s) − (Σ(i = 0 … 2) p[i][0])
              p[0] = a
              p[i = 1 … 2] = p[i − 1] + b/i
              Q_a = −k ȧ

            Constraints
              meet: ([a[0], a[1], 0]×[b[0], b[1], 0])[2] = 0   (holonomic)

            Equations of motion
              a[0]: ä[0] = −3 − k ȧ[0] − (∂f/∂r[0])(a, s) − (a[0] − b[0]) pair′(√((a[0] − b[0])² + (a[1] − b[1])²))/√((a[0] − b[0])² + (a[1] − b[1])²) + λ_meet b[1]
              a[1]: ä[1] = −k ȧ[1] − (∂f/∂r[1])(a, s) − (a[1] − b[1]) pair′(√((a[0] − b[0])² + (a[1] − b[1])²))/√((a[0] − b[0])² + (a[1] − b[1])²) − λ_meet b[0]
              b[0]: b̈[0] = (a[0] − b[0]) pair′(√((a[0] − b[0])² + (a[1] − b[1])²))/√((a[0] − b[0])² + (a[1] − b[1])²) − 5/2 − λ_meet a[1]
              b[1]: b̈[1] = (a[1] − b[1]) pair′(√((a[0] − b[0])² + (a[1] − b[1])²))/√((a[0] − b[0])² + (a[1] − b[1])²) + λ_meet a[0]
              s:    s̈ = −(∂f/∂r[0])([s, 1], s) − (∂f/∂s)([s, 1], s) − (∂f/∂s)(a, s)
        "#]],
        expect![[r#"
            \begin{align*}
              L &= \tfrac{1}{2} \, \dot{a} \cdot \dot{a} + \tfrac{1}{2} \, \left|\dot{b}\right|^{2} + \tfrac{1}{2} \, \dot{s}^{2} - \mathit{pair}\left(\left|a - b\right|\right) - f\left(a, s\right) - f\left(\left[s, 1\right], s\right) - \left(\sum_{i = 0}^{2} p_{i, 0}\right) \\
              p_{0} &= a \\
              p_{i = 1 \ldots 2} &= p_{i - 1} + \frac{b}{i} \\
              Q_{a} &= -k \, \dot{a} \\
              \left(\left[a_{0}, a_{1}, 0\right] \times \left[b_{0}, b_{1}, 0\right]\right)_{2} &= 0 \\
              \ddot{a}_{0} &= -3 - k \, \dot{a}_{0} - \left(\frac{\partial f}{\partial r_{0}}\right)\left(a, s\right) - \frac{\left(a_{0} - b_{0}\right) \, \mathit{pair}'\left(\sqrt{\left(a_{0} - b_{0}\right)^{2} + \left(a_{1} - b_{1}\right)^{2}}\right)}{\sqrt{\left(a_{0} - b_{0}\right)^{2} + \left(a_{1} - b_{1}\right)^{2}}} + \lambda_{\mathrm{meet}} \, b_{1} \\
              \ddot{a}_{1} &= -k \, \dot{a}_{1} - \left(\frac{\partial f}{\partial r_{1}}\right)\left(a, s\right) - \frac{\left(a_{1} - b_{1}\right) \, \mathit{pair}'\left(\sqrt{\left(a_{0} - b_{0}\right)^{2} + \left(a_{1} - b_{1}\right)^{2}}\right)}{\sqrt{\left(a_{0} - b_{0}\right)^{2} + \left(a_{1} - b_{1}\right)^{2}}} - \lambda_{\mathrm{meet}} \, b_{0} \\
              \ddot{b}_{0} &= \frac{\left(a_{0} - b_{0}\right) \, \mathit{pair}'\left(\sqrt{\left(a_{0} - b_{0}\right)^{2} + \left(a_{1} - b_{1}\right)^{2}}\right)}{\sqrt{\left(a_{0} - b_{0}\right)^{2} + \left(a_{1} - b_{1}\right)^{2}}} - \tfrac{5}{2} - \lambda_{\mathrm{meet}} \, a_{1} \\
              \ddot{b}_{1} &= \frac{\left(a_{1} - b_{1}\right) \, \mathit{pair}'\left(\sqrt{\left(a_{0} - b_{0}\right)^{2} + \left(a_{1} - b_{1}\right)^{2}}\right)}{\sqrt{\left(a_{0} - b_{0}\right)^{2} + \left(a_{1} - b_{1}\right)^{2}}} + \lambda_{\mathrm{meet}} \, a_{0} \\
              \ddot{s} &= -\left(\frac{\partial f}{\partial r_{0}}\right)\left(\left[s, 1\right], s\right) - \left(\frac{\partial f}{\partial s}\right)\left(\left[s, 1\right], s\right) - \left(\frac{\partial f}{\partial s}\right)\left(a, s\right) \\
            \end{align*}
        "#]],
    );
}

/// What frames would be cheaper for is told so, where the equations stand.
#[test]
fn positions_by_turns_are_told_of_frames() {
    let source = "#[coordinates(a, b, c)]
         #[define(x = rot_z(a)*rot_y(b)*rot_x(c)*centre)]
         #[lagrangian(m/2*dot(der(x), der(x)) + J/2*(a_dot^2 + b_dot^2 + c_dot^2))]
         struct Turned { m: f64, J: f64, centre: Vector3<f64> }";
    let Rendered { text, .. } = rendered(source);
    let (_, motion) = text.split_once("Equations of motion").expect("a heading");
    let (motion, _) = motion.split_once("\n\n").expect("a section after it");
    let note: Vec<&str> = motion.trim().lines().skip(3).map(str::trim).collect();
    expect![[r#"
        `der` differentiates here what three angles or more turn, one after another: say how the parts lie
        by `#[frame(…)]`, and what they do by `position(…)`, `velocity(…)` and `kinetic(…)`, and the accelerations
        take fewer operations (see lagrange_core::language#frames)."#]].assert_eq(&note.join("\n"));
}
