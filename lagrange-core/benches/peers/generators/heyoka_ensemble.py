"""heyoka: many double pendulums from rest to T = 10 by its Taylor method, on batches, on one thread.

usage: heyoka_ensemble.py BATCH TOLERANCE STARTS ENDS

The protocol is that of ours, see `ensemble.rs`. The equations are in closed form, which is faster than those that
`heyoka.lagrangian` gives. BATCH 1 is the scalar integrator, `exact` that in extended precision, to its round-off.
"""

import json
import sys
import time

import heyoka as hy
import numpy as np

END, GRAVITY = 10.0, 9.81


def equations():
    """Two equal links of length and mass 1."""
    a, b, u, v = hy.make_vars("a", "b", "u", "v")
    g, s, c = hy.par[0], hy.sin(a - b), hy.cos(a - b)
    f, h, r = -(v * v * s + 2.0 * g * hy.sin(a)), u * u * s - g * hy.sin(b), 1.0 + s * s
    return [(a, u), (b, v), (u, (f - c * h) / r), (v, (2.0 * h - c * f) / r)]


def integrator(batch, tolerance):
    if batch == "exact":
        number = np.longdouble
        return hy.taylor_adaptive(equations(), [number(0.0)] * 4, pars=[number(GRAVITY)], fp_type=number)
    if batch == 1:
        return hy.taylor_adaptive(equations(), [0.0] * 4, pars=[GRAVITY], tol=tolerance)
    parameters = np.full((1, batch), GRAVITY)
    return hy.taylor_adaptive_batch(equations(), np.zeros((4, batch)), pars=parameters, tol=tolerance)


def run(taylor, batch, starts):
    """The last states, a column each."""
    states, width, number = starts.copy(), batch, float
    if batch == "exact":
        width, number = 1, np.longdouble
    for k in range(0, states.shape[1], width):
        part = slice(k, k + width) if width > 1 else k
        if width > 1:
            taylor.set_time(0.0)
        else:
            taylor.time = number(0.0)
        taylor.state[:] = states[:, part]
        taylor.propagate_until(number(END))
        states[:, part] = taylor.state
    return states


def main():
    batch = sys.argv[1] if sys.argv[1] == "exact" else int(sys.argv[1])
    tolerance, starts, ends = float(sys.argv[2]), sys.argv[3], sys.argv[4]
    hy.llvm_state.set_diskcache_enabled(False)
    angles = np.fromfile(starts).reshape(-1, 2).T
    initial = np.vstack([angles, np.zeros_like(angles)])
    taylor, states = integrator(batch, tolerance), None
    for _ in sys.stdin:
        begun = time.perf_counter()
        states = run(taylor, batch, initial)
        print(json.dumps({"seconds": time.perf_counter() - begun}), flush=True)
    np.ascontiguousarray(states.T).tofile(ends)


main()
