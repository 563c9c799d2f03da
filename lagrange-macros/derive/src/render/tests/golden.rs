//! Entire systems as rendered. `UPDATE_EXPECT=1 cargo test` accepts a change.

use expect_test::{Expect, expect};

use super::reader::assert_balanced;
use crate::diagnostics::Diagnostics;
use crate::render::{Rendered, render};
use crate::{mechanics, resolve, syntax};

pub(super) fn rendered(source: &str) -> Rendered {
    let mut diagnostics = Diagnostics::default();
    let input = syn::parse_str(source).expect("a struct");
    let declaration = syntax::declaration(input, &mut diagnostics);
    let (mut graph, problem) =
        resolve::problem(&declaration, &mut diagnostics).unwrap_or_else(|| panic!("errors in {source}"));
    let derived = mechanics::derive(&mut graph, &problem, &mut diagnostics).expect("no errors");
    render(&declaration, &graph, &problem, &derived)
}

pub(super) fn check(source: &str, text: Expect, latex: Expect) {
    let rendered = rendered(source);
    let [[shortest, in_latex, _], ..] = rendered.forms;
    assert_balanced(&in_latex);
    text.assert_eq(&shortest);
    latex.assert_eq(&in_latex);
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

            Constraint forces
              λ_no_slip = −2/7 m g sin α
              R_x = λ_no_slip
              R_φ = −a λ_no_slip

            Conserved
              E = ½ m ẋ² + ½ inertia φ̇² − m g x sin α   (T + U if U is −m g x sin α)

            Momenta
              p_x = m ẋ
              p_φ = inertia φ̇

            Hamiltonian
              H = p_x²/(2 m) + p_φ²/(2 inertia) − m g x sin α

            Hamilton's equations
              ẋ = p_x/m
              φ̇ = p_φ/inertia
              ṗ_x = m g sin α + λ_no_slip
              ṗ_φ = −a λ_no_slip
        "#]],
        expect![[r#"
            \begingroup\allowdisplaybreaks
            \par\medskip\noindent\textbf{Lagrangian}
            \begin{align}
              L &= \tfrac{1}{2} m \dot x^2 + \tfrac{1}{2} \, \mathit{inertia} \, \dot\varphi^2 + m g x \sin \alpha \label{eq:RollingSphere-L} \\
              \mathit{inertia} &= \tfrac{2}{5} m a^2 \label{eq:RollingSphere-inertia}
            \end{align}
            \par\medskip\noindent\textbf{Constraints}
            \begin{align}
              \dot x - a \dot\varphi &= 0 \quad \text{(integrable: }x - a \varphi\text{ is constant)} \label{eq:RollingSphere-no_slip}
            \end{align}
            \par\medskip\noindent\textbf{Equations of motion}
            \begin{align}
              m \ddot x &= m g \sin \alpha + \lambda_{\mathrm{no}\,\mathrm{slip}} \label{eq:RollingSphere-x} \\
              \mathit{inertia} \, \ddot\varphi &= -a \lambda_{\mathrm{no}\,\mathrm{slip}} \label{eq:RollingSphere-phi}
            \end{align}
            \par\medskip\noindent\textbf{Constraint forces}
            \begin{align}
              \lambda_{\mathrm{no}\,\mathrm{slip}} &= -\tfrac{2}{7} m g \sin \alpha \label{eq:RollingSphere-lambda_no_slip} \\
              R_x &= \lambda_{\mathrm{no}\,\mathrm{slip}} \label{eq:RollingSphere-R_x} \\
              R_\varphi &= -a \lambda_{\mathrm{no}\,\mathrm{slip}} \label{eq:RollingSphere-R_phi}
            \end{align}
            \par\medskip\noindent\textbf{Conserved}
            \begin{align}
              E &= \tfrac{1}{2} m \dot x^2 + \tfrac{1}{2} \, \mathit{inertia} \, \dot\varphi^2 - m g x \sin \alpha \nonumber \\*
                &\quad \quad \text{(}T + U\text{ if }U\text{ is }-m g x \sin \alpha\text{)} \label{eq:RollingSphere-E}
            \end{align}
            \par\medskip\noindent\textbf{Momenta}
            \begin{align}
              p_x &= m \dot x \label{eq:RollingSphere-p_x} \\
              p_\varphi &= \mathit{inertia} \, \dot\varphi \label{eq:RollingSphere-p_phi}
            \end{align}
            \par\medskip\noindent\textbf{Hamiltonian}
            \begin{align}
              H &= \frac{p_x^2}{2 m} + \frac{p_\varphi^2}{2 \, \mathit{inertia}} - m g x \sin \alpha \label{eq:RollingSphere-H}
            \end{align}
            \par\medskip\noindent\textbf{Hamilton's equations}
            \begin{align}
              \dot x &= \frac{p_x}{m} \label{eq:RollingSphere-x-dot} \\
              \dot\varphi &= \frac{p_\varphi}{\mathit{inertia}} \label{eq:RollingSphere-phi-dot} \\
              \dot p_x &= m g \sin \alpha + \lambda_{\mathrm{no}\,\mathrm{slip}} \label{eq:RollingSphere-p-dot_x} \\
              \dot p_\varphi &= -a \lambda_{\mathrm{no}\,\mathrm{slip}} \label{eq:RollingSphere-p-dot_phi}
            \end{align}
            \endgroup
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

            Constraint forces
              λ_string = m (g z − ẋ² − ẏ² − ż²)/l²
              R_x = λ_string x
              R_y = λ_string y
              R_z = λ_string z

            Conserved
              E = ½ m (ẋ² + ẏ² + ż²) + m g z   (T + U if U is m g z)

            Momenta
              p_x = m ẋ
              p_y = m ẏ
              p_z = m ż

            Hamiltonian
              H = (p_x² + p_y² + p_z²)/(2 m) + m g z

            Hamilton's equations
              ẋ = p_x/m
              ẏ = p_y/m
              ż = p_z/m
              ṗ_x = λ_string x
              ṗ_y = λ_string y
              ṗ_z = λ_string z − m g
        "#]],
        expect![[r#"
            \begingroup\allowdisplaybreaks
            \par\medskip\noindent\textbf{Lagrangian}
            \begin{align}
              L &= \tfrac{1}{2} m (\dot x^2 + \dot y^2 + \dot z^2) - m g z \label{eq:SphericalPendulum-L}
            \end{align}
            \par\medskip\noindent\textbf{Constraints}
            \begin{align}
              \tfrac{1}{2} (x^2 + y^2 + z^2 - l^2) &= 0 \quad \text{(holonomic)} \label{eq:SphericalPendulum-string}
            \end{align}
            \par\medskip\noindent\textbf{Equations of motion}
            \begin{align}
              m \ddot x &= \lambda_{\mathrm{string}} x \label{eq:SphericalPendulum-x} \\
              m \ddot y &= \lambda_{\mathrm{string}} y \label{eq:SphericalPendulum-y} \\
              m \ddot z &= -m g + \lambda_{\mathrm{string}} z \label{eq:SphericalPendulum-z}
            \end{align}
            \par\medskip\noindent\textbf{Constraint forces}
            \begin{align}
              \lambda_{\mathrm{string}} &= \frac{m (g z - \dot x^2 - \dot y^2 - \dot z^2)}{l^2} \label{eq:SphericalPendulum-lambda_string} \\
              R_x &= \lambda_{\mathrm{string}} x \label{eq:SphericalPendulum-R_x} \\
              R_y &= \lambda_{\mathrm{string}} y \label{eq:SphericalPendulum-R_y} \\
              R_z &= \lambda_{\mathrm{string}} z \label{eq:SphericalPendulum-R_z}
            \end{align}
            \par\medskip\noindent\textbf{Conserved}
            \begin{align}
              E &= \tfrac{1}{2} m (\dot x^2 + \dot y^2 + \dot z^2) + m g z \quad \text{(}T + U\text{ if }U\text{ is }m g z\text{)} \label{eq:SphericalPendulum-E}
            \end{align}
            \par\medskip\noindent\textbf{Momenta}
            \begin{align}
              p_x &= m \dot x \label{eq:SphericalPendulum-p_x} \\
              p_y &= m \dot y \label{eq:SphericalPendulum-p_y} \\
              p_z &= m \dot z \label{eq:SphericalPendulum-p_z}
            \end{align}
            \par\medskip\noindent\textbf{Hamiltonian}
            \begin{align}
              H &= \frac{p_x^2 + p_y^2 + p_z^2}{2 m} + m g z \label{eq:SphericalPendulum-H}
            \end{align}
            \par\medskip\noindent\textbf{Hamilton's equations}
            \begin{align}
              \dot x &= \frac{p_x}{m} \label{eq:SphericalPendulum-x-dot} \\
              \dot y &= \frac{p_y}{m} \label{eq:SphericalPendulum-y-dot} \\
              \dot z &= \frac{p_z}{m} \label{eq:SphericalPendulum-z-dot} \\
              \dot p_x &= \lambda_{\mathrm{string}} x \label{eq:SphericalPendulum-p-dot_x} \\
              \dot p_y &= \lambda_{\mathrm{string}} y \label{eq:SphericalPendulum-p-dot_y} \\
              \dot p_z &= \lambda_{\mathrm{string}} z - m g \label{eq:SphericalPendulum-p-dot_z}
            \end{align}
            \endgroup
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
              θ: l θ̈ = l φ̇² sin θ cos θ − g sin θ
              φ: φ̈ sin θ = −2 θ̇ φ̇ cos θ

            Conserved
              p_φ = m l² φ̇ sin² θ
              E = ½ m l² (θ̇² + φ̇² sin² θ) − m g l cos θ   (T + U if U is −m g l cos θ)

            Momenta
              p_θ = m l² θ̇

            Hamiltonian
              H = p_θ²/(2 m l²) + p_φ²/(2 m l² sin² θ) − m g l cos θ

            Hamilton's equations
              θ̇ = p_θ/(m l²)
              φ̇ = p_φ/(m l² sin² θ)
              ṗ_θ = p_φ² cos(θ)/(m l² sin³ θ) − m g l sin θ
              ṗ_φ = 0
        "#]],
        expect![[r#"
            \begingroup\allowdisplaybreaks
            \par\medskip\noindent\textbf{Lagrangian}
            \begin{align}
              L &= \tfrac{1}{2} m l^2 (\dot\theta^2 + \sin^2(\theta) \dot\varphi^2) + m g l \cos \theta \label{eq:SphericalPendulum-L}
            \end{align}
            \par\medskip\noindent\textbf{Equations of motion}
            \begin{align}
              l \ddot\theta &= l \dot\varphi^2 \sin \theta \cos \theta - g \sin \theta \label{eq:SphericalPendulum-theta} \\
              \ddot\varphi \sin \theta &= -2 \dot\theta \dot\varphi \cos \theta \label{eq:SphericalPendulum-phi}
            \end{align}
            \par\medskip\noindent\textbf{Conserved}
            \begin{align}
              p_\varphi &= m l^2 \dot\varphi \sin^2 \theta \label{eq:SphericalPendulum-p_phi} \\
              E &= \tfrac{1}{2} m l^2 (\dot\theta^2 + \dot\varphi^2 \sin^2 \theta) - m g l \cos \theta \nonumber \\*
                &\quad \quad \text{(}T + U\text{ if }U\text{ is }-m g l \cos \theta\text{)} \label{eq:SphericalPendulum-E}
            \end{align}
            \par\medskip\noindent\textbf{Momenta}
            \begin{align}
              p_\theta &= m l^2 \dot\theta \label{eq:SphericalPendulum-p_theta}
            \end{align}
            \par\medskip\noindent\textbf{Hamiltonian}
            \begin{align}
              H &= \frac{p_\theta^2}{2 m l^2} + \frac{p_\varphi^2}{2 m l^2 \sin^2 \theta} - m g l \cos \theta \label{eq:SphericalPendulum-H}
            \end{align}
            \par\medskip\noindent\textbf{Hamilton's equations}
            \begin{align}
              \dot\theta &= \frac{p_\theta}{m l^2} \label{eq:SphericalPendulum-theta-dot} \\
              \dot\varphi &= \frac{p_\varphi}{m l^2 \sin^2 \theta} \label{eq:SphericalPendulum-phi-dot} \\
              \dot p_\theta &= \frac{p_\varphi^2 \cos \theta}{m l^2 \sin^3 \theta} - m g l \sin \theta \label{eq:SphericalPendulum-p-dot_theta} \\
              \dot p_\varphi &= 0 \label{eq:SphericalPendulum-p-dot_phi}
            \end{align}
            \endgroup
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
              r: m r̈ = m (r×Ω′(t) + 2 (ṙ×W) − W×(W×r) − A(t)) − ∂U/∂r

            Energy
              E = ½ m ṙ·ṙ + m A(t)·r − ½ m (W×r)·(W×r) + U(r)   (L₂ − L₀ by degree in the velocities)
              d/dt E = m Ω[0]′(t) (W[1] r[0] r[1] + W[2] r[0] r[2] − W[0] (r[1]² + r[2]²)) + m Ω[1]′(t) (W[0] r[0] r[1] + W[2] r[1] r[2] − W[1] (r[0]² + r[2]²)) + m Ω[2]′(t) (W[0] r[0] r[2] + W[1] r[1] r[2] − W[2] (r[0]² + r[1]²)) + m A′(t)·r − m Ω′(t)·(r×ṙ)   (−∂L/∂t)

            Momenta
              p_r = m ṙ + m (W×r)

            Hamiltonian
              H = (p_r·p_r)/(2 m) − W·(r×p_r) + m A(t)·r + U(r)

            Hamilton's equations
              ṙ = p_r/m + r×W
              ṗ_r = p_r×W − m A(t) − ∂U/∂r
        "#]],
        expect![[r#"
            \begingroup\allowdisplaybreaks
            \par\medskip\noindent\textbf{Lagrangian}
            \begin{align}
              L &= \tfrac{1}{2} m \mathbf{v} \cdot \mathbf{v} + \tfrac{1}{2} m (\mathbf{W} \times \mathbf{r}) \cdot (\mathbf{W} \times \mathbf{r}) + m \mathbf{v} \cdot (\mathbf{W} \times \mathbf{r}) \nonumber \\*
                &\quad - U(\mathbf{r}) - m \mathbf{r} \cdot \mathbf{A}(t) \label{eq:RotatingFrame-L} \\
              \mathbf{v} &= \dot{\mathbf{r}} \label{eq:RotatingFrame-v} \\
              \mathbf{W} &= \boldsymbol{\Omega}(t) \label{eq:RotatingFrame-W}
            \end{align}
            \par\noindent Indices count from 0, as in the program.
            \par\medskip\noindent\textbf{Equations of motion}
            \begin{align}
              m \ddot{\mathbf{r}} &= m (\mathbf{r} \times \boldsymbol{\Omega}'(t) + 2 (\dot{\mathbf{r}} \times \mathbf{W}) - \mathbf{W} \times (\mathbf{W} \times \mathbf{r}) - \mathbf{A}(t)) - \frac{\partial U}{\partial \mathbf{r}} \label{eq:RotatingFrame-r}
            \end{align}
            \par\medskip\noindent\textbf{Energy}
            \begin{align}
              E &= \tfrac{1}{2} m \dot{\mathbf{r}} \cdot \dot{\mathbf{r}} + m \mathbf{A}(t) \cdot \mathbf{r} - \tfrac{1}{2} m (\mathbf{W} \times \mathbf{r}) \cdot (\mathbf{W} \times \mathbf{r}) \nonumber \\*
                &\quad + U(\mathbf{r}) \quad \text{(}L_2 - L_0\text{ by degree in the velocities)} \label{eq:RotatingFrame-E} \\
              \frac{d}{dt} E &= m \Omega_0'(t) (W_1 r_0 r_1 + W_2 r_0 r_2 - W_0 (r_1^2 + r_2^2)) \nonumber \\*
                &\quad + m \Omega_1'(t) (W_0 r_0 r_1 + W_2 r_1 r_2 - W_1 (r_0^2 + r_2^2)) \nonumber \\*
                &\quad + m \Omega_2'(t) (W_0 r_0 r_2 + W_1 r_1 r_2 - W_2 (r_0^2 + r_1^2)) \nonumber \\*
                &\quad + m \mathbf{A}'(t) \cdot \mathbf{r} - m \boldsymbol{\Omega}'(t) \cdot (\mathbf{r} \times \dot{\mathbf{r}}) \quad \text{(}-\frac{\partial L}{\partial t}\text{)} \label{eq:RotatingFrame-d-dt-E}
            \end{align}
            \par\medskip\noindent\textbf{Momenta}
            \begin{align}
              \mathbf{p}_r &= m \dot{\mathbf{r}} + m (\mathbf{W} \times \mathbf{r}) \label{eq:RotatingFrame-p_r}
            \end{align}
            \par\medskip\noindent\textbf{Hamiltonian}
            \begin{align}
              H &= \frac{\mathbf{p}_r \cdot \mathbf{p}_r}{2 m} - \mathbf{W} \cdot (\mathbf{r} \times \mathbf{p}_r) + m \mathbf{A}(t) \cdot \mathbf{r} + U(\mathbf{r}) \label{eq:RotatingFrame-H}
            \end{align}
            \par\medskip\noindent\textbf{Hamilton's equations}
            \begin{align}
              \dot{\mathbf{r}} &= \frac{\mathbf{p}_r}{m} + \mathbf{r} \times \mathbf{W} \label{eq:RotatingFrame-r-dot} \\
              \dot{\mathbf{p}}_r &= \mathbf{p}_r \times \mathbf{W} - m \mathbf{A}(t) - \frac{\partial U}{\partial \mathbf{r}} \label{eq:RotatingFrame-p-dot_r}
            \end{align}
            \endgroup
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
              L = ½ ȧ·ȧ + ½ |ḃ|² + ½ ṡ² − pair(|a − b|) − f(a, s) − f([s, 1], s) − Σ(i = 0 … 2) p[i][0]
              p[0] = a
              p[i = 1 … 2] = p[i − 1] + b/i
              Q_a = −k ȧ

            Constraints
              meet: ([a[0], a[1], 0]×[b[0], b[1], 0])[2] = 0   (holonomic)

            Equations of motion
              a[0]: ä[0] = pair′(|a − b|) (b[0] − a[0])/|a − b| − k ȧ[0] − 3 − (∂f/∂r[0])(a, s) + λ_meet b[1]
              a[1]: ä[1] = pair′(|a − b|) (b[1] − a[1])/|a − b| − k ȧ[1] − (∂f/∂r[1])(a, s) − λ_meet b[0]
              b[0]: b̈[0] = pair′(|a − b|) (a[0] − b[0])/|a − b| − 5/2 − λ_meet a[1]
              b[1]: b̈[1] = pair′(|a − b|) (a[1] − b[1])/|a − b| + λ_meet a[0]
              s:    s̈ = −(∂f/∂s)(a, s) − (∂f/∂s)([s, 1], s) − (∂f/∂r[0])([s, 1], s)

            Constraint forces
              λ_meet = (2 ȧ[1] ḃ[0] + k (b[1] ȧ[0] − b[0] ȧ[1]) + 3 b[1] + b[1] (∂f/∂r[0])(a, s) − 2 ȧ[0] ḃ[1] − 5/2 a[1] − b[0] (∂f/∂r[1])(a, s))/(a·a + b·b)
              R_a[0] = λ_meet b[1]
              R_a[1] = −λ_meet b[0]
              R_b[0] = −λ_meet a[1]
              R_b[1] = λ_meet a[0]

            Energy
              E = ½ ȧ·ȧ + ½ ḃ·ḃ + ½ ṡ² + a[0] + p[1][0] + p[2][0] + pair(|a − b|) + f(a, s) + f([s, 1], s)   (T + U if U is a[0] + p[1][0] + p[2][0] + pair(|a − b|) + f(a, s) + f([s, 1], s))
              d/dt E = −k ȧ·ȧ   (Q·q̇)

            Momenta
              p_a = ȧ
              p_b = ḃ
              p_s = ṡ

            Hamiltonian
              H = ½ p_a·p_a + ½ p_b·p_b + ½ p_s² + a[0] + p[1][0] + p[2][0] + pair(|a − b|) + f(a, s) + f([s, 1], s)

            Hamilton's equations
              ȧ = p_a
              ḃ = p_b
              ṡ = p_s
              ṗ_a[0] = pair′(|a − b|) (b[0] − a[0])/|a − b| − k p_a[0] − 3 − (∂f/∂r[0])(a, s) + λ_meet b[1]
              ṗ_a[1] = pair′(|a − b|) (b[1] − a[1])/|a − b| − k p_a[1] − (∂f/∂r[1])(a, s) − λ_meet b[0]
              ṗ_b[0] = pair′(|a − b|) (a[0] − b[0])/|a − b| − 5/2 − λ_meet a[1]
              ṗ_b[1] = pair′(|a − b|) (a[1] − b[1])/|a − b| + λ_meet a[0]
              ṗ_s = −(∂f/∂s)(a, s) − (∂f/∂s)([s, 1], s) − (∂f/∂r[0])([s, 1], s)
        "#]],
        expect![[r#"
            \begingroup\allowdisplaybreaks
            \par\medskip\noindent\textbf{Lagrangian}
            \begin{align}
              L &= \tfrac{1}{2} \dot{\mathbf{a}} \cdot \dot{\mathbf{a}} + \tfrac{1}{2} \lvert \dot{\mathbf{b}} \rvert^2 + \tfrac{1}{2} \dot s^2 - \mathit{pair}(\lvert \mathbf{a} - \mathbf{b} \rvert) - f(\mathbf{a}, s) \nonumber \\*
                &\quad - f([s, 1], s) - \sum_{i = 0}^{2} p_{i, 0} \label{eq:Everything-L} \\
              \mathbf{p}_0 &= \mathbf{a} \label{eq:Everything-p-0} \\
              \mathbf{p}_{i = 1 \ldots 2} &= \mathbf{p}_{i - 1} + \frac{\mathbf{b}}{i} \label{eq:Everything-p-i-1-2} \\
              \mathbf{Q}_a &= -k \dot{\mathbf{a}} \label{eq:Everything-Q_a}
            \end{align}
            \par\noindent Indices count from 0, as in the program.
            \par\medskip\noindent\textbf{Constraints}
            \begin{align}
              ([a_0, a_1, 0] \times [b_0, b_1, 0])_2 &= 0 \quad \text{(holonomic)} \label{eq:Everything-meet}
            \end{align}
            \par\medskip\noindent\textbf{Equations of motion}
            \begin{align}
              \ddot a_0 &= \frac{\mathit{pair}'(\lvert \mathbf{a} - \mathbf{b} \rvert) (b_0 - a_0)}{\lvert \mathbf{a} - \mathbf{b} \rvert} - k \dot a_0 - 3 - \left( \frac{\partial f}{\partial r_0} \right)(\mathbf{a}, s) \nonumber \\*
                &\quad + \lambda_{\mathrm{meet}} b_1 \label{eq:Everything-a-0} \\
              \ddot a_1 &= \frac{\mathit{pair}'(\lvert \mathbf{a} - \mathbf{b} \rvert) (b_1 - a_1)}{\lvert \mathbf{a} - \mathbf{b} \rvert} - k \dot a_1 - \left( \frac{\partial f}{\partial r_1} \right)(\mathbf{a}, s) \nonumber \\*
                &\quad - \lambda_{\mathrm{meet}} b_0 \label{eq:Everything-a-1} \\
              \ddot b_0 &= \frac{\mathit{pair}'(\lvert \mathbf{a} - \mathbf{b} \rvert) (a_0 - b_0)}{\lvert \mathbf{a} - \mathbf{b} \rvert} - \tfrac{5}{2} - \lambda_{\mathrm{meet}} a_1 \label{eq:Everything-b-0} \\
              \ddot b_1 &= \frac{\mathit{pair}'(\lvert \mathbf{a} - \mathbf{b} \rvert) (a_1 - b_1)}{\lvert \mathbf{a} - \mathbf{b} \rvert} + \lambda_{\mathrm{meet}} a_0 \label{eq:Everything-b-1} \\
              \ddot s &= -\left( \frac{\partial f}{\partial s} \right)(\mathbf{a}, s) - \left( \frac{\partial f}{\partial s} \right)([s, 1], s) - \left( \frac{\partial f}{\partial r_0} \right)([s, 1], s) \label{eq:Everything-s}
            \end{align}
            \par\medskip\noindent\textbf{Constraint forces}
            \begin{align}
              \lambda_{\mathrm{meet}} &= \frac{1}{\mathbf{a} \cdot \mathbf{a} + \mathbf{b} \cdot \mathbf{b}} \bigl(2 \dot a_1 \dot b_0 + k (b_1 \dot a_0 - b_0 \dot a_1) + 3 b_1 \nonumber \\*
                &\quad + b_1 \left( \frac{\partial f}{\partial r_0} \right)(\mathbf{a}, s) - 2 \dot a_0 \dot b_1 - \tfrac{5}{2} a_1 \nonumber \\*
                &\quad - b_0 \left( \frac{\partial f}{\partial r_1} \right)(\mathbf{a}, s)\bigr) \label{eq:Everything-lambda_meet} \\
              R_{a, 0} &= \lambda_{\mathrm{meet}} b_1 \label{eq:Everything-R_a-0} \\
              R_{a, 1} &= -\lambda_{\mathrm{meet}} b_0 \label{eq:Everything-R_a-1} \\
              R_{b, 0} &= -\lambda_{\mathrm{meet}} a_1 \label{eq:Everything-R_b-0} \\
              R_{b, 1} &= \lambda_{\mathrm{meet}} a_0 \label{eq:Everything-R_b-1}
            \end{align}
            \par\medskip\noindent\textbf{Energy}
            \begin{align}
              E &= \tfrac{1}{2} \dot{\mathbf{a}} \cdot \dot{\mathbf{a}} + \tfrac{1}{2} \dot{\mathbf{b}} \cdot \dot{\mathbf{b}} + \tfrac{1}{2} \dot s^2 + a_0 + p_{1, 0} + p_{2, 0} \nonumber \\*
                &\quad + \mathit{pair}(\lvert \mathbf{a} - \mathbf{b} \rvert) + f(\mathbf{a}, s) + f([s, 1], s) \quad \text{(}T + U\text{ if }U\text{ is }a_0 \nonumber \\*
                &\quad + p_{1, 0} + p_{2, 0} + \mathit{pair}(\lvert \mathbf{a} - \mathbf{b} \rvert) + f(\mathbf{a}, s) + f([s, 1], s)\text{)} \label{eq:Everything-E} \\
              \frac{d}{dt} E &= -k \dot{\mathbf{a}} \cdot \dot{\mathbf{a}} \quad \text{(}Q \cdot \dot q\text{)} \label{eq:Everything-d-dt-E}
            \end{align}
            \par\medskip\noindent\textbf{Momenta}
            \begin{align}
              \mathbf{p}_a &= \dot{\mathbf{a}} \label{eq:Everything-p_a} \\
              \mathbf{p}_b &= \dot{\mathbf{b}} \label{eq:Everything-p_b} \\
              p_s &= \dot s \label{eq:Everything-p_s}
            \end{align}
            \par\medskip\noindent\textbf{Hamiltonian}
            \begin{align}
              H &= \tfrac{1}{2} \mathbf{p}_a \cdot \mathbf{p}_a + \tfrac{1}{2} \mathbf{p}_b \cdot \mathbf{p}_b + \tfrac{1}{2} p_s^2 + a_0 + p_{1, 0} + p_{2, 0} \nonumber \\*
                &\quad + \mathit{pair}(\lvert \mathbf{a} - \mathbf{b} \rvert) + f(\mathbf{a}, s) + f([s, 1], s) \label{eq:Everything-H}
            \end{align}
            \par\medskip\noindent\textbf{Hamilton's equations}
            \begin{align}
              \dot{\mathbf{a}} &= \mathbf{p}_a \label{eq:Everything-a-dot} \\
              \dot{\mathbf{b}} &= \mathbf{p}_b \label{eq:Everything-b-dot} \\
              \dot s &= p_s \label{eq:Everything-s-dot} \\
              \dot p_{a, 0} &= \frac{\mathit{pair}'(\lvert \mathbf{a} - \mathbf{b} \rvert) (b_0 - a_0)}{\lvert \mathbf{a} - \mathbf{b} \rvert} - k p_{a, 0} - 3 \nonumber \\*
                &\quad - \left( \frac{\partial f}{\partial r_0} \right)(\mathbf{a}, s) + \lambda_{\mathrm{meet}} b_1 \label{eq:Everything-p-dot_a-0} \\
              \dot p_{a, 1} &= \frac{\mathit{pair}'(\lvert \mathbf{a} - \mathbf{b} \rvert) (b_1 - a_1)}{\lvert \mathbf{a} - \mathbf{b} \rvert} - k p_{a, 1} - \left( \frac{\partial f}{\partial r_1} \right)(\mathbf{a}, s) \nonumber \\*
                &\quad - \lambda_{\mathrm{meet}} b_0 \label{eq:Everything-p-dot_a-1} \\
              \dot p_{b, 0} &= \frac{\mathit{pair}'(\lvert \mathbf{a} - \mathbf{b} \rvert) (a_0 - b_0)}{\lvert \mathbf{a} - \mathbf{b} \rvert} - \tfrac{5}{2} - \lambda_{\mathrm{meet}} a_1 \label{eq:Everything-p-dot_b-0} \\
              \dot p_{b, 1} &= \frac{\mathit{pair}'(\lvert \mathbf{a} - \mathbf{b} \rvert) (a_1 - b_1)}{\lvert \mathbf{a} - \mathbf{b} \rvert} + \lambda_{\mathrm{meet}} a_0 \label{eq:Everything-p-dot_b-1} \\
              \dot p_s &= -\left( \frac{\partial f}{\partial s} \right)(\mathbf{a}, s) - \left( \frac{\partial f}{\partial s} \right)([s, 1], s) - \left( \frac{\partial f}{\partial r_0} \right)([s, 1], s) \label{eq:Everything-p-dot_s}
            \end{align}
            \endgroup
        "#]],
    );
}
