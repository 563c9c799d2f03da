"""SciPy's Radau on the equations and the Jacobian of our library, called as C.

scipy_radau.py LIBRARY SYSTEM TOLERANCE TIME START ENDS

Each line on the standard input asks for one run, which answers with what it took as a line of JSON; at its end the last state is
written to ENDS.
"""

import ctypes
import json
import sys
import time

import numpy as np
from scipy.integrate import Radau
from scipy.integrate._ivp import radau

library, system, tolerance, end, start, ends = sys.argv[1:]
start, end, tolerance = np.fromfile(start), float(end), float(tolerance)
library = ctypes.CDLL(library)
rates, jacobian = (getattr(library, f"{system}_{what}") for what in ("rates", "jacobian"))
for function in (rates, jacobian):
    function.argtypes, function.restype = [ctypes.c_double, ctypes.c_void_p, ctypes.c_void_p], None


def of(function, *shape):
    def call(t, y):
        y, out = np.ascontiguousarray(y), np.empty(shape)
        function(t, y.ctypes.data, out.ctypes.data)
        return out

    return call


attempts = 0
solve = radau.solve_collocation_system


def counted(*arguments):
    global attempts
    attempts += 1
    return solve(*arguments)


radau.solve_collocation_system = counted
f, jac = of(rates, start.size), of(jacobian, start.size, start.size)
for _ in sys.stdin:
    attempts, steps, begun = 0, 0, time.perf_counter()
    solver = Radau(f, 0.0, start, end, rtol=tolerance, atol=tolerance, jac=jac)
    while solver.status == "running":
        if message := solver.step():
            sys.exit(message)
        steps += 1
    spent = {"seconds": time.perf_counter() - begun, "steps": steps, "rejected": attempts - steps}
    print(json.dumps(spent | {"evaluations": solver.nfev}), flush=True)
solver.y.tofile(ends)
