const _: () = {
    use ::lagrange_core as __lagrange;
    #[automatically_derived]
    #[allow(clippy::all, clippy::pedantic, clippy::nursery, unused_parens)]
    impl __lagrange::System for Pendulum {
        type Scalar = f64;
        type Length = <Self as __lagrange::Lagrangian>::N;
        type M = __lagrange::nalgebra::Const<0usize>;
        type Field = __lagrange::motion::LagrangianVectorField;
        #[inline(always)]
        fn length(&self) -> Self::Length {
            __lagrange::nalgebra::Const
        }
        #[inline]
        fn accelerations(
            &self,
            t: Self::Scalar,
            q: &__lagrange::generic::ViewOf<Self::Scalar, Self::Length>,
            v: &__lagrange::generic::ViewOf<Self::Scalar, Self::Length>,
            a: &mut __lagrange::generic::ViewOf<Self::Scalar, Self::Length>,
        ) {
            __lagrange::generated::write_accelerations(self, t, [q, v], a);
        }
    }
    #[automatically_derived]
    #[allow(clippy::all, clippy::pedantic, clippy::nursery, unused_parens)]
    impl __lagrange::Lagrangian for Pendulum {
        type Factor = [f64; 2usize];
        type N = __lagrange::nalgebra::Const<1usize>;
        const NAME: &'static str = "Pendulum";
        const COORDINATES: &'static [&'static str] = &["theta"];
        const CONSTRAINTS: &'static [&'static str] = &[];
        const CONSTRAINT_KINDS: &'static [__lagrange::ConstraintKind] = &[];
        const CONSTRAINT_CLASSES: &'static [__lagrange::facts::Classification] = &[];
        const INTEGRALS: ::core::option::Option<__lagrange::facts::Integrals> = ::core::option::Option::Some(__lagrange::facts::Integrals {
            count: 0usize,
            of: 0usize,
            evidence: __lagrange::facts::Evidence::Proved,
        });
        const MOMENTA_ARE_LINEAR: bool = true;
        const OBSERVABLES: &'static [&'static str] = &[];
        const DIGEST: u32 = 3945749694u32;
        const FACTS: __lagrange::facts::Facts = __lagrange::facts::Facts {
            cyclic: &[],
            conserved: &[
                __lagrange::facts::Conserved {
                    name: "energy",
                    evidence: __lagrange::facts::Evidence::Proved,
                },
            ],
            energy_is_conserved: ::core::option::Option::Some(
                __lagrange::facts::Evidence::Proved,
            ),
            energy_form: __lagrange::facts::EnergyForm::Even(
                __lagrange::facts::Evidence::Proved,
            ),
            total_derivatives: &[],
            linear_part: __lagrange::facts::LinearPart::Absent,
        };
        const EQUATIONS: __lagrange::facts::Equations = Self::equations();
        ///7 operations (+ − × ÷ √), 1 elementary function. Of every kind: 10 as derived, then 8 factors taken out.
        #[inline]
        #[allow(unused_variables)]
        fn lagrangian(&self, state: &__lagrange::State<f64, 1usize>) -> f64 {
            let [theta] = state.q.data.0[0];
            let [theta_dot] = state.v.data.0[0];
            let m = self.m;
            let l = self.l;
            let g = self.g;
            let r6 = __lagrange::Scalar::cos(theta);
            let r13 = m * (l * ((0.5 * (l * (theta_dot * theta_dot))) + (g * r6)));
            r13
        }
        ///7 operations (+ − × ÷ √), 1 elementary function. Of every kind: 10 as derived, then 8 factors taken out.
        #[inline]
        #[allow(unused_variables)]
        fn energy(&self, state: &__lagrange::State<f64, 1usize>) -> f64 {
            let [theta] = state.q.data.0[0];
            let [theta_dot] = state.v.data.0[0];
            let m = self.m;
            let l = self.l;
            let g = self.g;
            let r6 = __lagrange::Scalar::cos(theta);
            let r13 = m * (l * ((0.5 * (l * (theta_dot * theta_dot))) - (g * r6)));
            r13
        }
        ///0 operations (+ − × ÷ √), 0 elementary functions.
        #[inline]
        #[allow(unused_variables)]
        fn energy_rate(
            &self,
            state: &__lagrange::State<f64, 1usize>,
            multipliers: &__lagrange::nalgebra::SVector<f64, 0usize>,
        ) -> f64 {
            0.0
        }
        ///3 operations (+ − × ÷ √), 0 elementary functions.
        #[inline]
        #[allow(unused_variables)]
        fn momentum(
            &self,
            state: &__lagrange::State<f64, 1usize>,
        ) -> __lagrange::nalgebra::SVector<f64, 1usize> {
            let [theta_dot] = state.v.data.0[0];
            let m = self.m;
            let l = self.l;
            __lagrange::generated::vector([((theta_dot * m) * (l * l))])
        }
        ///4 operations (+ − × ÷ √), 1 elementary function.
        #[inline]
        #[allow(unused_variables)]
        fn momentum_rate(
            &self,
            state: &__lagrange::State<f64, 1usize>,
        ) -> __lagrange::nalgebra::SVector<f64, 1usize> {
            let [theta] = state.q.data.0[0];
            let m = self.m;
            let l = self.l;
            let g = self.g;
            let r4 = __lagrange::Scalar::sin(theta);
            __lagrange::generated::vector([(-(r4 * (g * (m * l))))])
        }
        ///2 operations (+ − × ÷ √), 0 elementary functions.
        #[inline]
        #[allow(unused_variables)]
        fn mass_matrix(
            &self,
            state: &__lagrange::State<f64, 1usize>,
        ) -> __lagrange::nalgebra::SMatrix<f64, 1usize, 1usize> {
            let m = self.m;
            let l = self.l;
            __lagrange::generated::matrix([[(m * (l * l))]])
        }
        ///4 operations (+ − × ÷ √), 1 elementary function.
        #[inline]
        #[allow(unused_variables)]
        fn forcing(
            &self,
            state: &__lagrange::State<f64, 1usize>,
        ) -> __lagrange::nalgebra::SVector<f64, 1usize> {
            let [theta] = state.q.data.0[0];
            let m = self.m;
            let l = self.l;
            let g = self.g;
            let r4 = __lagrange::Scalar::sin(theta);
            __lagrange::generated::vector([(-(r4 * (g * (m * l))))])
        }
        ///0 operations (+ − × ÷ √), 0 elementary functions.
        #[inline]
        #[allow(unused_variables)]
        fn constraint_residual(
            &self,
            state: &__lagrange::State<f64, 1usize>,
        ) -> __lagrange::nalgebra::SVector<f64, 0usize> {
            __lagrange::generated::vector([])
        }
        ///0 operations (+ − × ÷ √), 0 elementary functions.
        #[inline]
        #[allow(unused_variables)]
        fn constraint_rate(
            &self,
            state: &__lagrange::State<f64, 1usize>,
        ) -> __lagrange::nalgebra::SVector<f64, 0usize> {
            __lagrange::generated::vector([])
        }
        ///0 operations (+ − × ÷ √), 0 elementary functions.
        #[inline]
        #[allow(unused_variables)]
        fn residual_magnitude(
            &self,
            state: &__lagrange::State<f64, 1usize>,
        ) -> __lagrange::nalgebra::SVector<f64, 0usize> {
            __lagrange::generated::vector([])
        }
        ///0 operations (+ − × ÷ √), 0 elementary functions.
        #[inline]
        #[allow(unused_variables)]
        fn rate_magnitude(
            &self,
            state: &__lagrange::State<f64, 1usize>,
        ) -> __lagrange::nalgebra::SVector<f64, 0usize> {
            __lagrange::generated::vector([])
        }
        ///0 operations (+ − × ÷ √), 0 elementary functions.
        #[inline]
        #[allow(unused_variables)]
        fn constraint_jacobian(
            &self,
            state: &__lagrange::State<f64, 1usize>,
        ) -> __lagrange::nalgebra::SMatrix<f64, 0usize, 1usize> {
            __lagrange::generated::matrix([[]])
        }
        ///0 operations (+ − × ÷ √), 0 elementary functions.
        #[inline]
        #[allow(unused_variables)]
        fn constraint_bias(
            &self,
            state: &__lagrange::State<f64, 1usize>,
        ) -> __lagrange::nalgebra::SVector<f64, 0usize> {
            __lagrange::generated::vector([])
        }
        ///0 operations (+ − × ÷ √), 0 elementary functions.
        #[inline]
        #[allow(unused_variables)]
        fn constraint_force(
            &self,
            state: &__lagrange::State<f64, 1usize>,
            multipliers: &__lagrange::nalgebra::SVector<f64, 0usize>,
        ) -> __lagrange::nalgebra::SVector<f64, 1usize> {
            __lagrange::generated::vector([0.0])
        }
        ///5 operations (+ − × ÷ √), 1 elementary function. Of every kind: 8 as derived, then 6 factors taken out.
        #[inline]
        #[allow(unused_variables)]
        fn inverse_dynamics(
            &self,
            state: &__lagrange::State<f64, 1usize>,
            accelerations: &__lagrange::nalgebra::SVector<f64, 1usize>,
            multipliers: &__lagrange::nalgebra::SVector<f64, 0usize>,
        ) -> __lagrange::nalgebra::SVector<f64, 1usize> {
            let [theta] = state.q.data.0[0];
            let [theta_ddot] = accelerations.data.0[0];
            let m = self.m;
            let l = self.l;
            let g = self.g;
            let r5 = __lagrange::Scalar::sin(theta);
            __lagrange::generated::vector([(m * (l * ((theta_ddot * l) + (g * r5))))])
        }
        ///9 operations (+ − × ÷ √), 1 elementary function. One product fused with a sum. Reordered: at most 2 results wait for their last use, before 3.
        #[inline]
        #[allow(unused_variables)]
        fn accelerations_unchecked(
            &self,
            state: &__lagrange::State<f64, 1usize>,
        ) -> __lagrange::Solution<f64, 1usize, 0usize> {
            let [theta] = state.q.data.0[0];
            let m = self.m;
            let l = self.l;
            let g = self.g;
            let r4 = __lagrange::Scalar::sin(theta);
            let r6 = m * (l * l);
            __lagrange::Solution {
                accelerations: __lagrange::generated::vector([(-((g * r4) / l))]),
                multipliers: __lagrange::generated::vector([]),
                pivot: (__lagrange::Scalar::multiply_add(0.0, (r6 + (1.0 / r6)), 1.0)),
                rank: 0usize,
            }
        }
        ///6 operations (+ − × ÷ √), 0 elementary functions. One product fused with a sum.
        #[inline]
        #[allow(unused_variables)]
        fn factor(&self, state: &__lagrange::State<f64, 1usize>) -> Self::Factor {
            let m = self.m;
            let l = self.l;
            let r3 = m * (l * l);
            let r5 = 1.0 / r3;
            [(__lagrange::Scalar::multiply_add(0.0, (r3 + r5), 1.0)), r5]
        }
        ///1 operation (+ − × ÷ √), 0 elementary functions.
        #[inline]
        #[allow(unused_variables)]
        fn solve_with<__S: __lagrange::Broadcast<f64>>(
            &self,
            factor: &Self::Factor,
            forcing: &__lagrange::nalgebra::SVector<__S, 1usize>,
            bias: &__lagrange::nalgebra::SVector<__S, 0usize>,
        ) -> __lagrange::Solution<__S, 1usize, 0usize> {
            let [forcing_theta] = forcing.data.0[0];
            let factor_0 = __S::of(factor[0]);
            let factor_1 = __S::of(factor[1]);
            __lagrange::Solution {
                accelerations: __lagrange::generated::vector([
                    (factor_1 * forcing_theta),
                ]),
                multipliers: __lagrange::generated::vector([]),
                pivot: factor_0,
                rank: 0usize,
            }
        }
        #[allow(unused_variables)]
        fn observable(
            &self,
            index: usize,
            state: &__lagrange::State<f64, 1usize>,
            solution: &__lagrange::Solution<f64, 1usize, 0usize>,
        ) -> ::core::option::Option<f64> {
            match index {
                _ => ::core::option::Option::None,
            }
        }
        #[allow(unused_variables)]
        fn conserved(
            &self,
            index: usize,
            state: &__lagrange::State<f64, 1usize>,
        ) -> ::core::option::Option<f64> {
            match index {
                0usize => {
                    ::core::option::Option::Some(
                        __lagrange::Lagrangian::energy(self, state),
                    )
                }
                _ => ::core::option::Option::None,
            }
        }
        #[allow(unused_variables)]
        fn visit_parameters(
            &self,
            visit: &mut dyn ::core::ops::FnMut(&'static str, f64),
        ) {
            visit("m", self.m);
            visit("l", self.l);
            visit("g", self.g);
        }
    }
    /**<div class="equations" style="overflow-x:auto">
<h5>Lagrangian</h5>
<div style="display:grid;grid-template-columns:auto minmax(0,1fr);gap:.5em .25em;align-items:baseline">
<div style="text-align:right"><math displaystyle="true"><mi>L</mi></math></div><div style="padding-left:1em;text-indent:-1em"><math displaystyle="true"><mo form="infix">=</mo><mfrac displaystyle="false"><mn>1</mn><mn>2</mn></mfrac><mo>⁢</mo><mi>m</mi><mo>⁢</mo><msup><mi>l</mi><mn>2</mn></msup><mo>⁢</mo><msup><mover accent="true"><mi>θ</mi><mo>˙</mo></mover><mn>2</mn></msup></math><wbr/><math displaystyle="true"><mo form="infix">+</mo><mi>m</mi><mo>⁢</mo><mi>g</mi><mo>⁢</mo><mi>l</mi><mo>⁢</mo><mspace width=".17em"></mspace><mi>cos</mi><mo>⁡</mo><mspace width=".17em"></mspace><mi>θ</mi></math></div>
</div>
<h5>Equations of motion</h5>
<div style="display:grid;grid-template-columns:auto minmax(0,1fr);gap:.5em .25em;align-items:baseline">
<div style="text-align:right"><math displaystyle="true"><mi>l</mi><mo>⁢</mo><mover accent="true"><mi>θ</mi><mo>¨</mo></mover></math></div><div style="padding-left:1em;text-indent:-1em"><math displaystyle="true"><mo form="infix">=</mo><mo form="prefix">−</mo><mi>g</mi><mo>⁢</mo><mspace width=".17em"></mspace><mi>sin</mi><mo>⁡</mo><mspace width=".17em"></mspace><mi>θ</mi></math></div>
</div>
<h5>Conserved</h5>
<div style="display:grid;grid-template-columns:auto minmax(0,1fr);gap:.5em .25em;align-items:baseline">
<div style="text-align:right"><math displaystyle="true"><mi>E</mi></math></div><div style="padding-left:1em;text-indent:-1em"><math displaystyle="true"><mo form="infix">=</mo><mfrac displaystyle="false"><mn>1</mn><mn>2</mn></mfrac><mo>⁢</mo><mi>m</mi><mo>⁢</mo><msup><mi>l</mi><mn>2</mn></msup><mo>⁢</mo><msup><mover accent="true"><mi>θ</mi><mo>˙</mo></mover><mn>2</mn></msup></math><wbr/><math displaystyle="true"><mo form="infix">−</mo><mi>m</mi><mo>⁢</mo><mi>g</mi><mo>⁢</mo><mi>l</mi><mo>⁢</mo><mspace width=".17em"></mspace><mi>cos</mi><mo>⁡</mo><mspace width=".17em"></mspace><mi>θ</mi></math><span style="display:inline-block;text-indent:0;opacity:.75;margin-left:1em">(<math displaystyle="true"><mi>T</mi></math><wbr/><math displaystyle="true"><mo form="infix">+</mo><mi>U</mi></math> if <math displaystyle="true"><mi>U</mi></math> is <math displaystyle="true"><mo form="prefix">−</mo><mi>m</mi><mo>⁢</mo><mi>g</mi><mo>⁢</mo><mi>l</mi><mo>⁢</mo><mspace width=".17em"></mspace><mi>cos</mi><mo>⁡</mo><mspace width=".17em"></mspace><mi>θ</mi></math>)</span></div>
</div>
<h5>Momenta</h5>
<div style="display:grid;grid-template-columns:auto minmax(0,1fr);gap:.5em .25em;align-items:baseline">
<div style="text-align:right"><math displaystyle="true"><msub><mi>p</mi><mi>θ</mi></msub></math></div><div style="padding-left:1em;text-indent:-1em"><math displaystyle="true"><mo form="infix">=</mo><mi>m</mi><mo>⁢</mo><msup><mi>l</mi><mn>2</mn></msup><mo>⁢</mo><mover accent="true"><mi>θ</mi><mo>˙</mo></mover></math></div>
</div>
<h5>Hamiltonian</h5>
<div style="display:grid;grid-template-columns:auto minmax(0,1fr);gap:.5em .25em;align-items:baseline">
<div style="text-align:right"><math displaystyle="true"><mi>H</mi></math></div><div style="padding-left:1em;text-indent:-1em"><math displaystyle="true"><mo form="infix">=</mo><mfrac><msubsup><mi>p</mi><mi>θ</mi><mn>2</mn></msubsup><mrow><mn>2</mn><mo>⁢</mo><mi>m</mi><mo>⁢</mo><msup><mi>l</mi><mn>2</mn></msup></mrow></mfrac></math><wbr/><math displaystyle="true"><mo form="infix">−</mo><mi>m</mi><mo>⁢</mo><mi>g</mi><mo>⁢</mo><mi>l</mi><mo>⁢</mo><mspace width=".17em"></mspace><mi>cos</mi><mo>⁡</mo><mspace width=".17em"></mspace><mi>θ</mi></math></div>
</div>
<h5>Hamilton's equations</h5>
<div style="display:grid;grid-template-columns:auto minmax(0,1fr);gap:.5em .25em;align-items:baseline">
<div style="text-align:right"><math displaystyle="true"><mover accent="true"><mi>θ</mi><mo>˙</mo></mover></math></div><div style="padding-left:1em;text-indent:-1em"><math displaystyle="true"><mo form="infix">=</mo><mfrac><msub><mi>p</mi><mi>θ</mi></msub><mrow><mi>m</mi><mo>⁢</mo><msup><mi>l</mi><mn>2</mn></msup></mrow></mfrac></math></div>
<div style="text-align:right"><math displaystyle="true"><msub><mover accent="true"><mi>p</mi><mo>˙</mo></mover><mi>θ</mi></msub></math></div><div style="padding-left:1em;text-indent:-1em"><math displaystyle="true"><mo form="infix">=</mo><mo form="prefix">−</mo><mi>m</mi><mo>⁢</mo><mi>g</mi><mo>⁢</mo><mi>l</mi><mo>⁢</mo><mspace width=".17em"></mspace><mi>sin</mi><mo>⁡</mo><mspace width=".17em"></mspace><mi>θ</mi></math></div>
</div>
</div>
*/
    #[automatically_derived]
    #[allow(
        clippy::all,
        clippy::pedantic,
        clippy::nursery,
        unused_parens,
        dead_code,
        non_snake_case
    )]
    impl Pendulum {
        /** The system and its equations of motion, to be read.

```text
Pendulum

Lagrangian
  L = ½ m l² θ̇² + m g l cos θ

Equations of motion
  θ: l θ̈ = −g sin θ

Conserved
  E = ½ m l² θ̇² − m g l cos θ   (T + U if U is −m g l cos θ)

Momenta
  p_θ = m l² θ̇

Hamiltonian
  H = p_θ²/(2 m l²) − m g l cos θ

Hamilton's equations
  θ̇ = p_θ/(m l²)
  ṗ_θ = −m g l sin θ
```*/
        const fn equations() -> __lagrange::facts::Equations {
            __lagrange::generated::equations(
                [[
                    "Pendulum\n\nLagrangian\n  L = ½ m l² θ\u{307}² + m g l cos θ\n\nEquations of motion\n  θ: l θ\u{308} = −g sin θ\n\nConserved\n  E = ½ m l² θ\u{307}² − m g l cos θ   (T + U if U is −m g l cos θ)\n\nMomenta\n  p_θ = m l² θ\u{307}\n\nHamiltonian\n  H = p_θ²/(2 m l²) − m g l cos θ\n\nHamilton's equations\n  θ\u{307} = p_θ/(m l²)\n  ṗ_θ = −m g l sin θ\n",
                    "\\begingroup\\allowdisplaybreaks\n\\par\\medskip\\noindent\\textbf{Lagrangian}\n\\begin{align}\n  L &= \\tfrac{1}{2} m l^2 \\dot\\theta^2 + m g l \\cos \\theta \\label{eq:Pendulum-L}\n\\end{align}\n\\par\\medskip\\noindent\\textbf{Equations of motion}\n\\begin{align}\n  l \\ddot\\theta &= -g \\sin \\theta \\label{eq:Pendulum-theta}\n\\end{align}\n\\par\\medskip\\noindent\\textbf{Conserved}\n\\begin{align}\n  E &= \\tfrac{1}{2} m l^2 \\dot\\theta^2 - m g l \\cos \\theta \\quad \\text{(}T + U\\text{ if }U\\text{ is }-m g l \\cos \\theta\\text{)} \\label{eq:Pendulum-E}\n\\end{align}\n\\par\\medskip\\noindent\\textbf{Momenta}\n\\begin{align}\n  p_\\theta &= m l^2 \\dot\\theta \\label{eq:Pendulum-p_theta}\n\\end{align}\n\\par\\medskip\\noindent\\textbf{Hamiltonian}\n\\begin{align}\n  H &= \\frac{p_\\theta^2}{2 m l^2} - m g l \\cos \\theta \\label{eq:Pendulum-H}\n\\end{align}\n\\par\\medskip\\noindent\\textbf{Hamilton's equations}\n\\begin{align}\n  \\dot\\theta &= \\frac{p_\\theta}{m l^2} \\label{eq:Pendulum-theta-dot} \\\\\n  \\dot p_\\theta &= -m g l \\sin \\theta \\label{eq:Pendulum-p-dot_theta}\n\\end{align}\n\\endgroup\n",
                    "<div class=\"equations\" style=\"overflow-x:auto\">\n<h5>Lagrangian</h5>\n<div style=\"display:grid;grid-template-columns:auto minmax(0,1fr);gap:.5em .25em;align-items:baseline\">\n<div style=\"text-align:right\"><math displaystyle=\"true\"><mi>L</mi></math></div><div style=\"padding-left:1em;text-indent:-1em\"><math displaystyle=\"true\"><mo form=\"infix\">=</mo><mfrac displaystyle=\"false\"><mn>1</mn><mn>2</mn></mfrac><mo>\u{2062}</mo><mi>m</mi><mo>\u{2062}</mo><msup><mi>l</mi><mn>2</mn></msup><mo>\u{2062}</mo><msup><mover accent=\"true\"><mi>θ</mi><mo>˙</mo></mover><mn>2</mn></msup></math><wbr/><math displaystyle=\"true\"><mo form=\"infix\">+</mo><mi>m</mi><mo>\u{2062}</mo><mi>g</mi><mo>\u{2062}</mo><mi>l</mi><mo>\u{2062}</mo><mspace width=\".17em\"></mspace><mi>cos</mi><mo>\u{2061}</mo><mspace width=\".17em\"></mspace><mi>θ</mi></math></div>\n</div>\n<h5>Equations of motion</h5>\n<div style=\"display:grid;grid-template-columns:auto minmax(0,1fr);gap:.5em .25em;align-items:baseline\">\n<div style=\"text-align:right\"><math displaystyle=\"true\"><mi>l</mi><mo>\u{2062}</mo><mover accent=\"true\"><mi>θ</mi><mo>¨</mo></mover></math></div><div style=\"padding-left:1em;text-indent:-1em\"><math displaystyle=\"true\"><mo form=\"infix\">=</mo><mo form=\"prefix\">−</mo><mi>g</mi><mo>\u{2062}</mo><mspace width=\".17em\"></mspace><mi>sin</mi><mo>\u{2061}</mo><mspace width=\".17em\"></mspace><mi>θ</mi></math></div>\n</div>\n<h5>Conserved</h5>\n<div style=\"display:grid;grid-template-columns:auto minmax(0,1fr);gap:.5em .25em;align-items:baseline\">\n<div style=\"text-align:right\"><math displaystyle=\"true\"><mi>E</mi></math></div><div style=\"padding-left:1em;text-indent:-1em\"><math displaystyle=\"true\"><mo form=\"infix\">=</mo><mfrac displaystyle=\"false\"><mn>1</mn><mn>2</mn></mfrac><mo>\u{2062}</mo><mi>m</mi><mo>\u{2062}</mo><msup><mi>l</mi><mn>2</mn></msup><mo>\u{2062}</mo><msup><mover accent=\"true\"><mi>θ</mi><mo>˙</mo></mover><mn>2</mn></msup></math><wbr/><math displaystyle=\"true\"><mo form=\"infix\">−</mo><mi>m</mi><mo>\u{2062}</mo><mi>g</mi><mo>\u{2062}</mo><mi>l</mi><mo>\u{2062}</mo><mspace width=\".17em\"></mspace><mi>cos</mi><mo>\u{2061}</mo><mspace width=\".17em\"></mspace><mi>θ</mi></math><span style=\"display:inline-block;text-indent:0;opacity:.75;margin-left:1em\">(<math displaystyle=\"true\"><mi>T</mi></math><wbr/><math displaystyle=\"true\"><mo form=\"infix\">+</mo><mi>U</mi></math> if <math displaystyle=\"true\"><mi>U</mi></math> is <math displaystyle=\"true\"><mo form=\"prefix\">−</mo><mi>m</mi><mo>\u{2062}</mo><mi>g</mi><mo>\u{2062}</mo><mi>l</mi><mo>\u{2062}</mo><mspace width=\".17em\"></mspace><mi>cos</mi><mo>\u{2061}</mo><mspace width=\".17em\"></mspace><mi>θ</mi></math>)</span></div>\n</div>\n<h5>Momenta</h5>\n<div style=\"display:grid;grid-template-columns:auto minmax(0,1fr);gap:.5em .25em;align-items:baseline\">\n<div style=\"text-align:right\"><math displaystyle=\"true\"><msub><mi>p</mi><mi>θ</mi></msub></math></div><div style=\"padding-left:1em;text-indent:-1em\"><math displaystyle=\"true\"><mo form=\"infix\">=</mo><mi>m</mi><mo>\u{2062}</mo><msup><mi>l</mi><mn>2</mn></msup><mo>\u{2062}</mo><mover accent=\"true\"><mi>θ</mi><mo>˙</mo></mover></math></div>\n</div>\n<h5>Hamiltonian</h5>\n<div style=\"display:grid;grid-template-columns:auto minmax(0,1fr);gap:.5em .25em;align-items:baseline\">\n<div style=\"text-align:right\"><math displaystyle=\"true\"><mi>H</mi></math></div><div style=\"padding-left:1em;text-indent:-1em\"><math displaystyle=\"true\"><mo form=\"infix\">=</mo><mfrac><msubsup><mi>p</mi><mi>θ</mi><mn>2</mn></msubsup><mrow><mn>2</mn><mo>\u{2062}</mo><mi>m</mi><mo>\u{2062}</mo><msup><mi>l</mi><mn>2</mn></msup></mrow></mfrac></math><wbr/><math displaystyle=\"true\"><mo form=\"infix\">−</mo><mi>m</mi><mo>\u{2062}</mo><mi>g</mi><mo>\u{2062}</mo><mi>l</mi><mo>\u{2062}</mo><mspace width=\".17em\"></mspace><mi>cos</mi><mo>\u{2061}</mo><mspace width=\".17em\"></mspace><mi>θ</mi></math></div>\n</div>\n<h5>Hamilton's equations</h5>\n<div style=\"display:grid;grid-template-columns:auto minmax(0,1fr);gap:.5em .25em;align-items:baseline\">\n<div style=\"text-align:right\"><math displaystyle=\"true\"><mover accent=\"true\"><mi>θ</mi><mo>˙</mo></mover></math></div><div style=\"padding-left:1em;text-indent:-1em\"><math displaystyle=\"true\"><mo form=\"infix\">=</mo><mfrac><msub><mi>p</mi><mi>θ</mi></msub><mrow><mi>m</mi><mo>\u{2062}</mo><msup><mi>l</mi><mn>2</mn></msup></mrow></mfrac></math></div>\n<div style=\"text-align:right\"><math displaystyle=\"true\"><msub><mover accent=\"true\"><mi>p</mi><mo>˙</mo></mover><mi>θ</mi></msub></math></div><div style=\"padding-left:1em;text-indent:-1em\"><math displaystyle=\"true\"><mo form=\"infix\">=</mo><mo form=\"prefix\">−</mo><mi>m</mi><mo>\u{2062}</mo><mi>g</mi><mo>\u{2062}</mo><mi>l</mi><mo>\u{2062}</mo><mspace width=\".17em\"></mspace><mi>sin</mi><mo>\u{2061}</mo><mspace width=\".17em\"></mspace><mi>θ</mi></math></div>\n</div>\n</div>\n",
                ]; 3],
            )
        }
    }
    #[automatically_derived]
    impl __lagrange::structure::ConstantMassMatrix for Pendulum {}
    #[automatically_derived]
    impl __lagrange::structure::VelocityFreeForces for Pendulum {}
    #[automatically_derived]
    impl __lagrange::structure::HolonomicConstraints for Pendulum {}
    #[automatically_derived]
    impl __lagrange::structure::Unconstrained for Pendulum {}
};
const _: () = {
    use ::lagrange_core as __lagrange;
    #[automatically_derived]
    #[allow(clippy::all, clippy::pedantic, clippy::nursery, unused_parens)]
    impl __lagrange::StateDerivatives for Pendulum {
        type Slopes = [f64; 1usize];
        const STATE_ARGUMENTS: ::core::option::Option<&'static [usize]> = ::core::option::Option::Some(
            &[1usize],
        );
        ///3 operations (+ − × ÷ √), 1 elementary function.
        #[inline]
        #[allow(unused_variables)]
        fn residual_slopes(
            &self,
            state: &__lagrange::State<f64, 1usize>,
            solution: &__lagrange::Solution<f64, 1usize, 0usize>,
        ) -> Self::Slopes {
            let (accelerations, multipliers) = (
                &solution.accelerations,
                &solution.multipliers,
            );
            let [theta] = state.q.data.0[0];
            let m = self.m;
            let l = self.l;
            let g = self.g;
            let r4 = __lagrange::Scalar::cos(theta);
            [(r4 * (g * (m * l)))]
        }
        ///1 operation (+ − × ÷ √), 0 elementary functions.
        #[inline]
        #[allow(unused_variables)]
        fn residual_change_with<__S: __lagrange::Broadcast<f64>>(
            &self,
            slopes: &Self::Slopes,
            direction: &__lagrange::Direction<__S, 1usize>,
        ) -> __lagrange::ResidualChange<__S, 1usize, 0usize> {
            let d_theta = direction.q.data.0[0][0];
            let s0 = __S::of(slopes[0]);
            __lagrange::ResidualChange {
                motion: __lagrange::generated::vector([(d_theta * s0)]),
                acceleration: __lagrange::generated::vector([]),
                rate: __lagrange::generated::vector([]),
                position: __lagrange::generated::vector([]),
            }
        }
    }
    #[automatically_derived]
    #[allow(clippy::all, clippy::pedantic, clippy::nursery, unused_parens)]
    impl __lagrange::Linearized for Pendulum {
        type P = __lagrange::nalgebra::Const<3usize>;
        type ParameterSlopes = [f64; 7usize];
        const PARAMETERS: &'static [&'static str] = &["m", "l", "g"];
        fn parameters(&self) -> __lagrange::nalgebra::SVector<f64, 3usize> {
            __lagrange::generated::vector([self.m, self.l, self.g])
        }
        #[allow(unused_variables, unreachable_code)]
        fn set_parameter(&mut self, index: usize, value: f64) -> bool {
            match index {
                0usize => {
                    self.m = value;
                }
                1usize => {
                    self.l = value;
                }
                2usize => {
                    self.g = value;
                }
                _ => return false,
            }
            true
        }
        ///3 operations (+ − × ÷ √), 1 elementary function.
        #[inline]
        #[allow(unused_variables)]
        fn residual_slopes_by_parameters(
            &self,
            state: &__lagrange::State<f64, 1usize>,
            solution: &__lagrange::Solution<f64, 1usize, 0usize>,
        ) -> Self::ParameterSlopes {
            let (accelerations, multipliers) = (
                &solution.accelerations,
                &solution.multipliers,
            );
            let [theta] = state.q.data.0[0];
            let [theta_ddot] = accelerations.data.0[0];
            let m = self.m;
            let l = self.l;
            let g = self.g;
            let r5 = __lagrange::Scalar::sin(theta);
            [(m * 2.0), l, g, m, theta_ddot, r5, (r5 * (m * g))]
        }
        ///12 operations (+ − × ÷ √), 0 elementary functions. 4 products fused with sums.
        #[inline]
        #[allow(unused_variables)]
        fn residual_change_by_parameters_with<__S: __lagrange::Broadcast<f64>>(
            &self,
            slopes: &Self::ParameterSlopes,
            rates: &__lagrange::nalgebra::SVector<__S, 3usize>,
        ) -> __lagrange::ResidualChange<__S, 1usize, 0usize> {
            let d_m = rates.data.0[0][0];
            let d_l = rates.data.0[0][1];
            let d_g = rates.data.0[0][2];
            let s0 = __S::of(slopes[0]);
            let s1 = __S::of(slopes[1]);
            let s2 = __S::of(slopes[2]);
            let s3 = __S::of(slopes[3]);
            let s4 = __S::of(slopes[4]);
            let s5 = __S::of(slopes[5]);
            let s6 = __S::of(slopes[6]);
            __lagrange::ResidualChange {
                motion: __lagrange::generated::vector([
                    (__lagrange::Scalar::multiply_add(
                        s1,
                        (__lagrange::Scalar::multiply_add(
                            (__lagrange::Scalar::multiply_add(d_g, s3, (d_m * s2))),
                            s5,
                            ((__lagrange::Scalar::multiply_add(d_m, s1, (d_l * s0)))
                                * s4),
                        )),
                        (d_l * s6),
                    )),
                ]),
                acceleration: __lagrange::generated::vector([]),
                rate: __lagrange::generated::vector([]),
                position: __lagrange::generated::vector([]),
            }
        }
    }
};
const _: () = {
    use ::lagrange_core as __lagrange;
    #[automatically_derived]
    #[allow(clippy::all, clippy::pedantic, clippy::nursery, unused_parens)]
    impl __lagrange::TaylorSeries for Pendulum {
        type SeriesSlopes = [f64; 3usize];
        type Sums = [f64; 4usize];
        type SeriesTerms = [f64; 2usize];
        ///3 operations (+ − × ÷ √), 2 elementary functions.
        #[inline]
        #[allow(unused_variables)]
        fn series_slopes(
            &self,
            state: &__lagrange::State<f64, 1usize>,
            solution: &__lagrange::Solution<f64, 1usize, 0usize>,
        ) -> Self::SeriesSlopes {
            let (accelerations, multipliers) = (
                &solution.accelerations,
                &solution.multipliers,
            );
            let [theta] = state.q.data.0[0];
            let m = self.m;
            let l = self.l;
            let g = self.g;
            let (r4, r5) = __lagrange::Scalar::sin_cos(theta);
            [r5, r4, (-(m * (l * g)))]
        }
        ///8 operations (+ − × ÷ √), 0 elementary functions. 2 products fused with sums. Reordered: at most 1 results wait for their last use, before 2.
        #[inline]
        #[allow(unused_variables)]
        fn series_right_hand_sides(
            &self,
            slopes: &Self::SeriesSlopes,
            sums: &Self::Sums,
            order: &[f64; 4],
            direction: &__lagrange::Direction<f64, 1usize>,
        ) -> (
            (
                __lagrange::nalgebra::SVector<f64, 1usize>,
                __lagrange::nalgebra::SVector<f64, 0usize>,
            ),
            Self::SeriesTerms,
        ) {
            let d_theta = direction.q.data.0[0][0];
            let s0 = slopes[0];
            let s1 = slopes[1];
            let s2 = slopes[2];
            let sum0 = sums[0];
            let sum1 = sums[1];
            let reciprocal_k = order[1];
            let r8 = __lagrange::Scalar::multiply_add(
                d_theta,
                s0,
                (sum0 * reciprocal_k),
            );
            (
                (
                    __lagrange::generated::vector([(r8 * s2)]),
                    __lagrange::generated::vector([]),
                ),
                [
                    (-(__lagrange::Scalar::multiply_add(
                        d_theta,
                        s1,
                        (reciprocal_k * sum1),
                    ))),
                    r8,
                ],
            )
        }
        ///1 operation (+ − × ÷ √), 0 elementary functions.
        #[inline]
        #[allow(unused_variables)]
        fn series_factors(
            &self,
            slopes: &Self::SeriesSlopes,
            terms: &Self::SeriesTerms,
            order: &[f64; 4],
            direction: &__lagrange::Direction<f64, 1usize>,
            accelerations: &__lagrange::nalgebra::SVector<f64, 1usize>,
            multipliers: &__lagrange::nalgebra::SVector<f64, 0usize>,
        ) -> [Self::Sums; 2] {
            let d_theta = direction.q.data.0[0][0];
            let k = order[0];
            let term0 = terms[0];
            let term1 = terms[1];
            let r3 = d_theta * k;
            [[r3, r3, 0.0, 0.0], [term0, term1, 0.0, 0.0]]
        }
    }
};
