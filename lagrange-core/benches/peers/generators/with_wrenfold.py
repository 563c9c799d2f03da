"""wrenfold: the Lagrangian, its derivatives and, where `unrolled`, L D L^T symbolically; written as Rust.

usage: with_wrenfold.py N unrolled|loops OUTPUT.rs

With `loops` it gives M and h, and L D L^T is by hand. Prints what the function takes, as JSON.
"""

import json
import re
import sys
import time
import typing

import wrenfold
from wrenfold import code_generation, sym

FRAME = """#![allow(unused, non_snake_case)]
pub mod wrenfold_traits {
    pub trait Span2D<const R: usize, const C: usize> {
        type ValueType;
        fn get(&self, r: usize, c: usize) -> Self::ValueType;
    }
    pub trait OutputSpan2D<const R: usize, const C: usize> {
        type ValueType;
        fn set(&mut self, r: usize, c: usize, value: Self::ValueType);
    }
}
use wrenfold_traits::*;
const N: usize = @N@;
pub struct Column<const L: usize>([f64; L]);
pub struct Matrix([[f64; N]; N]);
impl<const L: usize> Span2D<L, 1> for Column<L> {
    type ValueType = f64;
    #[inline(always)]
    fn get(&self, r: usize, _: usize) -> f64 { self.0[r] }
}
impl<const L: usize> OutputSpan2D<L, 1> for Column<L> {
    type ValueType = f64;
    #[inline(always)]
    fn set(&mut self, r: usize, _: usize, value: f64) { self.0[r] = value }
}
impl OutputSpan2D<N, N> for Matrix {
    type ValueType = f64;
    #[inline(always)]
    fn set(&mut self, r: usize, c: usize, value: f64) { self.0[r][c] = value }
}
#[inline(always)]
fn solve(m: &mut [[f64; N]; N], b: &mut [f64; N]) {
    let mut d = [0.0; N];
    for j in 0..N {
        let mut w = [0.0; N];
        let mut pivot = m[j][j];
        for k in 0..j { w[k] = m[j][k] * d[k]; pivot -= m[j][k] * w[k]; }
        d[j] = pivot;
        let r = 1.0 / pivot;
        for i in j + 1..N {
            let mut s = m[i][j];
            for k in 0..j { s -= m[i][k] * w[k]; }
            m[i][j] = s * r;
        }
    }
    for i in 0..N { for k in 0..i { b[i] -= m[i][k] * b[k]; } }
    for i in 0..N { b[i] /= d[i]; }
    for i in (0..N).rev() { for k in i + 1..N { b[i] -= m[k][i] * b[k]; } }
}
#[no_mangle]
pub unsafe extern "C" fn accelerations(q: *const f64, v: *const f64, p: *const f64, a: *mut f64, _: *mut f64) {
    let (q, v) = (&*(q as *const Column<N>), &*(v as *const Column<N>));
    let (p, a) = (&*(p as *const Column<{ 2 * N + 1 }>), &mut *(a as *mut Column<N>));
    @BODY@
}
"""
BODY = {
    "unrolled": "evaluate(q, v, p, a);",
    "loops": "let mut m = Matrix([[0.0; N]; N]); evaluate(q, v, p, &mut m, a); solve(&mut m.0, &mut a.0);",
}


def planar(n, q, v, p):
    """M and h of n links in angles."""
    m, l, g = [p[i] for i in range(n)], [p[n + i] for i in range(n)], p[2 * n]
    vx = vy = y = lagrangian = sym.zero
    for i in range(n):
        y = y - l[i] * sym.cos(q[i])
        vx = vx + l[i] * sym.cos(q[i]) * v[i]
        vy = vy + l[i] * sym.sin(q[i]) * v[i]
        lagrangian = lagrangian + m[i] * (vx**2 + vy**2) / 2 - m[i] * g * y
    momenta = sym.jacobian(sym.vector(lagrangian), v)
    forcing = sym.jacobian(sym.vector(lagrangian), q).T - sym.jacobian(momenta.T, q) * v
    return sym.jacobian(momenta.T, v), forcing


def total(terms):
    return sum(terms, sym.zero)


def solved(n, mass, forcing):
    """L D L^T, one division a pivot."""
    m = [[mass[i, j] for j in range(n)] for i in range(n)]
    b, d, r = [forcing[i] for i in range(n)], [None] * n, [None] * n
    for j in range(n):
        w = [m[j][k] * d[k] for k in range(j)]
        d[j] = m[j][j] - total(m[j][k] * w[k] for k in range(j))
        r[j] = 1 / d[j]
        for i in range(j + 1, n):
            m[i][j] = (m[i][j] - total(m[i][k] * w[k] for k in range(j))) * r[j]
    for i in range(n):
        b[i] = b[i] - total(m[i][k] * b[k] for k in range(i))
    b = [b[i] * r[i] for i in range(n)]
    for i in reversed(range(n)):
        b[i] = b[i] - total(m[k][i] * b[k] for k in range(i + 1, n))
    return sym.vector(*b)


def generate(n, how):
    column = typing.Annotated[sym.MatrixExpr, wrenfold.Shape(rows=n, cols=1)]
    parameters = typing.Annotated[sym.MatrixExpr, wrenfold.Shape(rows=2 * n + 1, cols=1)]

    def evaluate(q: column, v: column, p: parameters):
        mass, forcing = planar(n, q, v, p)
        if how == "unrolled":
            return [code_generation.OutputArg(solved(n, mass, forcing), "a")]
        return [code_generation.OutputArg(mass, "m"), code_generation.OutputArg(forcing, "h")]

    return wrenfold.generate_function(evaluate, wrenfold.RustGenerator())


def main():
    n, how, output = int(sys.argv[1]), sys.argv[2], sys.argv[3]
    start = time.perf_counter()
    code = generate(n, how)
    seconds = time.perf_counter() - start
    with open(output, "w") as file:
        file.write(FRAME.replace("@N@", str(n)).replace("@BODY@", BODY[how]) + code)
    count = {name: int(number) for name, number in re.findall(r"// (\w+): (\d+)", code)}
    calls = count.get("call", 0)
    print(json.dumps({"operations": count["total"] - calls, "functions": calls, "seconds": seconds}))


main()
