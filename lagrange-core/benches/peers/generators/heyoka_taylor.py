"""heyoka: one motion by its Taylor method at the tolerance of round-off.

usage: heyoka_taylor.py SYSTEM MODE END START ENDS

SYSTEM is `planar-N`, N links of length and mass 1 in a plane from their Lagrangian by `heyoka.lagrangian`, `double`, two
links with accelerations simplified by hand, or `spherical`, a mass on a string of length 1 with the multiplier put in by hand.
MODE is `unrolled` or `compact`, heyoka's two ways to compile, or `exact`: in long double at a tolerance of 1e-19. START
holds coordinates and velocities as `f64` in the machine's byte order. Each line on the standard input asks for one run, which
answers with the seconds and steps it took as a line of JSON; at its end the last state is written to ENDS.
"""

import json
import sys
import time

import heyoka as hy
import numpy as np

GRAVITY = 9.81


def double(g):
    a, b, u, v = hy.make_vars("a", "b", "u", "v")
    s, c = hy.sin(a - b), hy.cos(a - b)
    f, h, r = -(v * v * s + 2.0 * g * hy.sin(a)), u * u * s - g * hy.sin(b), 1.0 + s * s
    return [(a, u), (b, v), (u, (f - c * h) / r), (v, (2.0 * h - c * f) / r)]


def spherical(g):
    x, y, z, u, v, w = hy.make_vars("x", "y", "z", "u", "v", "w")
    multiplier = g * z - (u * u + v * v + w * w)
    return [(x, u), (y, v), (z, w), (u, multiplier * x), (v, multiplier * y), (w, multiplier * z - g)]


def planar(n, g):
    angles = hy.make_vars(*(f"q{i}" for i in range(n)))
    rates = hy.make_vars(*(f"v{i}" for i in range(n)))
    lagrangian, vx, vy, y = 0.0, 0.0, 0.0, 0.0
    for angle, rate in zip(angles, rates):
        vx, vy, y = vx + hy.cos(angle) * rate, vy + hy.sin(angle) * rate, y - hy.cos(angle)
        lagrangian = lagrangian + 0.5 * (vx**2 + vy**2) - g * y
    return hy.lagrangian(lagrangian, list(angles), list(rates))


def equations(system):
    simple = {"double": double, "spherical": spherical}
    return simple[system](hy.par[0]) if system in simple else planar(int(system.split("-")[1]), hy.par[0])


def main():
    system, mode, end, start, ends = sys.argv[1:]
    number = np.longdouble if mode == "exact" else float
    tolerance = {"tol": np.longdouble("1e-19")} if mode == "exact" else {}
    state = np.fromfile(start).astype(number)
    hy.llvm_state.set_diskcache_enabled(False)
    taylor = hy.taylor_adaptive(
        equations(system),
        list(state),
        pars=[number(GRAVITY)],
        compact_mode=mode != "unrolled",
        fp_type=number,
        **tolerance,
    )
    for _ in sys.stdin:
        taylor.time, taylor.state[:] = number(0), state
        begun = time.perf_counter()
        steps = taylor.propagate_until(number(end))[3]
        print(json.dumps({"seconds": time.perf_counter() - begun, "steps": steps}), flush=True)
    taylor.state.astype(float).tofile(ends)


main()
