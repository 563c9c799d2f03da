//! Recurrences for the Taylor coefficients of elementary functions, from the differential equations that they
//! satisfy.

use super::coefficients::{Recurrences, SeriesQuantity, Sum};
use crate::codegen::operation::{Operation, Register};
use crate::symbolic::Function;

impl Recurrences {
    pub(super) fn function(&mut self, function: Function, x: SeriesQuantity) -> Option<SeriesQuantity> {
        if self.is_at_rest(x) {
            let x = self.first(x);
            return Some(self.at_rest(Operation::Function(function, x)));
        }
        let one = self.at_rest(Operation::Constant(1.0_f64.to_bits()));
        Some(match function {
            Function::Sin => self.pair([Function::Sin, Function::Cos], x)[0],
            Function::Cos => self.pair([Function::Sin, Function::Cos], x)[1],
            Function::Sinh => self.pair([Function::Sinh, Function::Cosh], x)[0],
            Function::Cosh => self.pair([Function::Sinh, Function::Cosh], x)[1],
            Function::Exp => self.exponential(function, x),
            // z′ = (1 ± z²) x′
            Function::Tan => self.tangent(function, x),
            Function::Tanh => self.tangent(function, x),
            Function::Ln => self.integral(function, x, x, false),
            Function::Atan => {
                let square = self.product(x, x);
                let slope = self.linear(Operation::Add(one, square), |of, [x, y]| of.sum(x, y));
                self.integral(function, x, slope, false)
            }
            Function::Asin | Function::Acos => {
                let square = self.product(x, x);
                let rest = self.linear(Operation::Subtract(one, square), |of, [x, y]| of.difference(x, y));
                let slope = self.root(rest);
                self.integral(function, x, slope, function == Function::Acos)
            }
            Function::Abs | Function::Ramp | Function::Step => return None,
        })
    }

    /// From s′ = c x′ and c′ = ∓s x′: s_k = c₀ x_k + Σ j x_j c_{k−j}/k, and similarly for c_k.
    fn pair(&mut self, [sine, cosine]: [Function; 2], x: SeriesQuantity) -> [SeriesQuantity; 2] {
        if let Some(&known) = self.turns.get(&(sine, x)) {
            return known;
        }
        if sine == Function::Sinh {
            self.note_steep(x);
        }
        let x0 = self.first(x);
        let [s0, c0] = [sine, cosine].map(|function| self.schedule.push(Operation::Function(function, x0)));
        let [s, c] = [s0, c0].map(|first| self.add(first, Some([None; 2])));
        let [with_c, with_s] = [c, s].map(|other| self.weighted_sum(x, other));
        let made = [
            self.moving(s0, [x], |of, [x]| {
                let end = of.times(c0, x);
                of.sum(end, of.known(with_c))
            }),
            self.moving(c0, [x], |of, [x]| {
                let end = of.times(s0, x);
                let sum = of.sum(end, of.known(with_s));
                if sine == Function::Sin { of.negative(sum) } else { sum }
            }),
        ];
        for (quantity, made) in [s, c].into_iter().zip(made) {
            self.quantities[quantity.0] = self.quantities[made.0];
        }
        self.turns.insert((sine, x), [s, c]);
        [s, c]
    }

    /// exp, from z′ = z x′.
    fn exponential(&mut self, function: Function, x: SeriesQuantity) -> SeriesQuantity {
        let x0 = self.first(x);
        let z0 = self.schedule.push(Operation::Function(function, x0));
        self.grown(z0, x)
    }

    /// From z′ = z x′: z_k = z₀ x_k + Σ j x_j z_{k−j}/k
    fn grown(&mut self, z0: Register, x: SeriesQuantity) -> SeriesQuantity {
        self.note_steep(x);
        self.defined(z0, |of, z| {
            let sum = of.weighted_sum(x, z);
            of.moving(z0, [x], |of, [x]| {
                let end = of.times(z0, x);
                of.sum(end, of.known(sum))
            })
        })
    }

    /// tan and tanh, from z′ = d x′ with d = 1 + z² or 1 − z². The derivative d is a series of its own.
    fn tangent(&mut self, function: Function, x: SeriesQuantity) -> SeriesQuantity {
        let x0 = self.first(x);
        let z0 = self.schedule.push(Operation::Function(function, x0));
        let one = self.schedule.constant(1.0);
        let square = self.schedule.push(Operation::Multiply(z0, z0));
        let is_circular = function == Function::Tan;
        if !is_circular {
            self.note_steep(x);
        }
        let slope = if is_circular { Operation::Add(one, square) } else { Operation::Subtract(one, square) };
        let slope = self.schedule.push(slope);
        self.defined(z0, |of, z| {
            let d = of.add(slope, Some([None; 2]));
            let (with_d, of_square) = (of.weighted_sum(x, d), of.product_sum(z, z));
            let made = of.moving(z0, [x], |of, [x]| {
                let end = of.times(slope, x);
                of.sum(end, of.known(with_d))
            });
            let twice = of.schedule.push(Operation::Add(z0, z0));
            let changed = of.moving(slope, [made], |of, [z]| {
                let end = of.times(twice, z);
                let square = of.sum(end, of.known(of_square));
                if is_circular { square } else { of.negative(square) }
            });
            of.quantities[d.0] = of.quantities[changed.0];
            made
        })
    }

    /// From d z′ = ±x′: z_k = (±x_k − Σ j z_j d_{k−j}/k)/d₀
    fn integral(
        &mut self,
        function: Function,
        x: SeriesQuantity,
        d: SeriesQuantity,
        is_falling: bool,
    ) -> SeriesQuantity {
        let [x0, d0] = [x, d].map(|x| self.first(x));
        let z0 = self.schedule.push(Operation::Function(function, x0));
        let over = self.reciprocal(d0);
        self.defined(z0, |of, z| {
            let sum = of.weighted_sum(z, d);
            of.moving(z0, [x], |of, [x]| {
                let x = if is_falling { of.negative(x) } else { x };
                let rest = of.difference(x, of.known(sum));
                of.times(over, rest)
            })
        })
    }

    /// Polar angle z of (x, y), from (x² + y²) z′ = x y′ − y x′.
    pub(super) fn angle_of(&mut self, y: SeriesQuantity, x: SeriesQuantity) -> SeriesQuantity {
        let [y0, x0] = [y, x].map(|x| self.first(x));
        let z0 = self.schedule.push(Operation::Atan2(y0, x0));
        if self.is_at_rest(x) && self.is_at_rest(y) {
            return self.add(z0, None);
        }
        let squares = [x, y].map(|x| self.product(x, x));
        let d = self.linear(Operation::Add(squares[0], squares[1]), |of, [x, y]| of.sum(x, y));
        let d0 = self.first(d);
        let over = self.reciprocal(d0);
        self.defined(z0, |of, z| {
            let [with_x, with_y, with_d] = [(y, x), (x, y), (z, d)].map(|(x, y)| {
                let is_moving = !(of.is_at_rest(x) || of.is_at_rest(y));
                is_moving.then(|| of.weighted_sum(x, y))
            });
            of.moving(z0, [x, y], |of, [x, y]| {
                let (right, left) = (of.times(x0, y), of.times(y0, x));
                let ends = of.difference(right, left);
                let [with_x, with_y, with_d] =
                    [with_x, with_y, with_d].map(|sum| sum.and_then(|sum| of.known(sum)));
                let inner = of.difference(with_x, with_y);
                let both = of.sum(ends, inner);
                let rest = of.difference(both, with_d);
                of.times(over, rest)
            })
        })
    }

    /// z = xᵉ. For a constant e, x z′ = e z x′ gives z_k = (e z₀ x_k + Σ j (e x_j z_{k−j} − z_j x_{k−j})/k)/x₀. For a
    /// varying e, z = exp(e ln x).
    pub(super) fn power(&mut self, x: SeriesQuantity, exponent: SeriesQuantity) -> SeriesQuantity {
        let [x0, e] = [x, exponent].map(|x| self.first(x));
        let z0 = self.schedule.push(Operation::Power(x0, e));
        if !self.is_at_rest(exponent) {
            let logarithm = if self.is_at_rest(x) {
                self.at_rest(Operation::Function(Function::Ln, x0))
            } else {
                self.integral(Function::Ln, x, x, false)
            };
            let product = self.product(exponent, logarithm);
            return self.grown(z0, product);
        }
        if self.is_at_rest(x) {
            return self.add(z0, None);
        }
        self.note_real_power(x, e);
        let over = self.reciprocal(x0);
        let scale = self.schedule.push(Operation::Multiply(e, z0));
        // Treat an exponent that is unknown at compile time as a root: it may be 1/2.
        let is_whole = |e: &Operation<Register>| matches!(e, Operation::Constant(e) if f64::from_bits(*e).fract() == 0.0);
        let is_root = !is_whole(&self.schedule.operations[e.index()]);
        self.defined(z0, |of, z| {
            let [of_x, of_z] = [of.weighted_sum(x, z), of.weighted_sum(z, x)];
            if is_root {
                of.watch(Sum::Weighted(x, z), z0);
            }
            let of_x = of.schedule.push(Operation::Multiply(e, of_x));
            of.moving(z0, [x], |of, [x]| {
                let end = of.times(scale, x);
                let grown = of.sum(end, of.known(of_x));
                let rest = of.difference(grown, of.known(of_z));
                of.times(over, rest)
            })
        })
    }
}
