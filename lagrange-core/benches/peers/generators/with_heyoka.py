"""heyoka: `lagrangian` and a compiled function `cfunc`, whose object code for this CPU is linked behind a C wrapper.

usage: with_heyoka.py N BATCH OUTPUT.o OUTPUT.c

With a BATCH of more than one it evaluates eight systems side by side, so many at a time. Prints what the function
takes, as JSON.
"""

import json
import sys
import time

import heyoka as hy

SYSTEMS = 8
# heyoka's function takes q and v in one array, which is how the harness has them.
SCALAR = """void cfunc(double *, const double *, const double *, const double *);
void accelerations(const double *q, const double *v, const double *p, double *a, double *lambda) {{
    const double time = 0;
    cfunc(a, q, p, &time);
}}
"""
LANES = """#include <stddef.h>
void cfunc(double *, const double *, const double *, const double *, size_t);
void accelerations(const double *q, const double *v, const double *p, double *a, double *lambda) {{
    const double time[{batch}] = {{0}};
    for (int k = 0; k < {systems}; k += {batch}) cfunc(a + k, q + k, p + k, time, {systems});
}}
"""


def planar(n):
    """The Lagrangian of n links in angles, with its coordinates and velocities."""
    q = [hy.make_vars(f"q{i}") for i in range(n)]
    v = [hy.make_vars(f"v{i}") for i in range(n)]
    m, l, g = [hy.par[i] for i in range(n)], [hy.par[n + i] for i in range(n)], hy.par[2 * n]
    y = vx = vy = lagrangian = 0.0
    for i in range(n):
        y = y - l[i] * hy.cos(q[i])
        vx = vx + l[i] * hy.cos(q[i]) * v[i]
        vy = vy + l[i] * hy.sin(q[i]) * v[i]
        lagrangian = lagrangian + m[i] * (vx**2 + vy**2) * 0.5 - m[i] * g * y
    return lagrangian, q, v


def main():
    n, batch = int(sys.argv[1]), int(sys.argv[2])
    hy.llvm_state.set_diskcache_enabled(False)
    start = time.perf_counter()
    lagrangian, q, v = planar(n)
    right = hy.lagrangian(lagrangian, q, v)
    function = hy.cfunc([value for _, value in right[n:]], q + v, batch_size=batch)
    seconds = time.perf_counter() - start
    # The states are: one system, one with a stride, and a batch with a stride.
    code = function.llvm_states[2 if batch > 1 else 0].object_code
    with open(sys.argv[3], "wb") as file:
        file.write(code)
    with open(sys.argv[4], "w") as file:
        file.write((LANES if batch > 1 else SCALAR).format(systems=SYSTEMS, batch=batch))
    steps = [str(step) for step in function.dc[2 * n : -n]]
    functions = sum("sin(" in step or "cos(" in step for step in steps)
    operations = sum(any(sign in step for sign in "+-*/(") for step in steps) - functions
    print(json.dumps({"operations": operations, "functions": functions, "seconds": seconds}))


main()
