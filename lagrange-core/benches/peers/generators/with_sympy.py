"""SymPy: `LagrangesMethod`, common subexpressions and C; M and h generated, L D L^T by hand, or all of it symbolic.

usage: with_sympy.py N loops|unrolled OUTPUT.c

Prints what the function takes, as JSON; with `loops` that is without the solution.
"""

import json
import sys
import time

import sympy
from sympy.physics.mechanics import LagrangesMethod, dynamicsymbols
from sympy.printing.c import C99CodePrinter

SOLVE = """
static inline void solve(double M[N][N], double *b, double *a) {
    double d[N];
    for (int j = 0; j < N; j++) {
        double w[N], pivot = M[j][j];
        for (int k = 0; k < j; k++) { w[k] = M[j][k] * d[k]; pivot -= M[j][k] * w[k]; }
        d[j] = pivot;
        double r = 1.0 / pivot;
        for (int i = j + 1; i < N; i++) {
            double s = M[i][j];
            for (int k = 0; k < j; k++) s -= M[i][k] * w[k];
            M[i][j] = s * r;
        }
    }
    for (int i = 0; i < N; i++) for (int k = 0; k < i; k++) b[i] -= M[i][k] * b[k];
    for (int i = 0; i < N; i++) b[i] /= d[i];
    for (int i = N - 1; i >= 0; i--) for (int k = i + 1; k < N; k++) b[i] -= M[k][i] * b[k];
    for (int i = 0; i < N; i++) a[i] = b[i];
}
"""


class Printer(C99CodePrinter):
    """Small powers as products, as anyone would write them."""

    def _print_Pow(self, power):
        if power.exp.is_Integer and 2 <= power.exp <= 4:
            return "(" + "*".join([f"({self._print(power.base)})"] * int(power.exp)) + ")"
        return super()._print_Pow(power)


def planar(n):
    """M and h of n links in angles."""
    t, g = sympy.symbols("t g")
    q = dynamicsymbols(f"q:{n}")
    m, l = sympy.symbols(f"m:{n}", positive=True), sympy.symbols(f"l:{n}", positive=True)
    x = y = lagrangian = 0
    for i in range(n):
        x, y = x + l[i] * sympy.sin(q[i]), y - l[i] * sympy.cos(q[i])
        lagrangian += m[i] * (x.diff(t) ** 2 + y.diff(t) ** 2) / 2 - m[i] * g * y
    method = LagrangesMethod(lagrangian, q)
    method.form_lagranges_equations()
    velocities = dict(zip([value.diff(t) for value in q], sympy.symbols(f"V:{n}")))
    coordinates = dict(zip(q, sympy.symbols(f"Q:{n}")))
    return [part.subs(velocities).subs(coordinates) for part in (method.mass_matrix, method.forcing)]


def write(n, results, uses_loops, output):
    printer = Printer()
    shared, reduced = sympy.cse(results.values(), symbols=sympy.numbered_symbols("s"), order="none")
    inputs = "".join(f"const double Q{i}=q[{i}], V{i}=v[{i}], m{i}=p[{i}], l{i}=p[{n + i}];\n" for i in range(n))
    body = "".join(f"const double {name}={printer.doprint(value)};\n" for name, value in shared)
    body += "".join(f"{name}={printer.doprint(value)};\n" for name, value in zip(results, reduced))
    with open(output, "w") as file:
        file.write(f"#include <math.h>\n#define N {n}\n{SOLVE if uses_loops else ''}")
        file.write(
            "void accelerations(const double *q, const double *v, const double *p, double *a, double *lambda) {\n"
        )
        file.write(f"(void)lambda;\n{inputs}const double g=p[{2 * n}];\n")
        file.write("double M[N][N], b[N];\n" + body + "solve(M, b, a);\n}\n" if uses_loops else body + "}\n")
    values = [value for _, value in shared] + list(reduced)
    functions = sum(len(value.atoms(sympy.sin, sympy.cos)) for value in values)
    return int(sum(sympy.count_ops(value) for value in values)) - functions, functions


def main():
    n, how, output = int(sys.argv[1]), sys.argv[2], sys.argv[3]
    start = time.perf_counter()
    mass, forcing = planar(n)
    if how == "unrolled":
        results = {f"a[{i}]": value for i, value in enumerate(mass.LUsolve(forcing))}
    else:
        results = {f"M[{i}][{j}]": mass[i, j] for i in range(n) for j in range(i + 1)}
        results |= {f"b[{i}]": forcing[i] for i in range(n)}
    operations, functions = write(n, results, how == "loops", output)
    print(json.dumps({"operations": operations, "functions": functions, "seconds": time.perf_counter() - start}))


main()
