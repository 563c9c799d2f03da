"""CasADi: the Lagrangian in SX, differentiated by its algorithmic differentiation, solved symbolically, written as C.

usage: with_casadi.py planar|chain|spherical N ldl|schur|kkt OUTPUT.c

Prints what the C function takes, as JSON. q, v and p are as in the harness.
"""

import sys
import time

import casadi as ca
from casadi_source import generate, report


def planar(n, p):
    """Lagrangian and constraints of n links in angles."""
    q, v = ca.SX.sym("q", n), ca.SX.sym("v", n)
    m, l, g = p[:n], p[n : 2 * n], p[2 * n]
    y = vx = vy = lagrangian = ca.SX(0)
    for i in range(n):
        y = y - l[i] * ca.cos(q[i])
        vx = vx + l[i] * ca.cos(q[i]) * v[i]
        vy = vy + l[i] * ca.sin(q[i]) * v[i]
        lagrangian += m[i] * (vx**2 + vy**2) / 2 - m[i] * g * y
    return q, v, lagrangian, ca.SX(0, 1)


def rods(n, dimension, p):
    """Lagrangian and constraints of n masses on rods in Cartesian coordinates."""
    q, v = ca.SX.sym("q", dimension * n), ca.SX.sym("v", dimension * n)
    m, l, g = p[:n], p[n : 2 * n], p[2 * n]
    lagrangian, constraints = ca.SX(0), []
    for i in range(n):
        position, velocity = q[i::n], v[i::n]
        link = position - q[i - 1 :: n] if i else position
        lagrangian += m[i] * ca.dot(velocity, velocity) / 2 - m[i] * g * position[dimension - 1]
        constraints.append((ca.dot(link, link) - l[i] ** 2) / 2)
    return q, v, lagrangian, ca.vertcat(*constraints)


def solve(matrix, right):
    """By L D L^T, whose fill-reducing order CasADi finds while it generates."""
    return ca.ldl_solve(right, *ca.ldl(matrix))


def equations(q, v, lagrangian, constraints, how):
    """Accelerations and multipliers: M a = h + J^T lambda, J a = -dJ/dt v."""
    momenta = ca.gradient(lagrangian, v)
    mass = ca.jacobian(momenta, v)
    forcing = ca.gradient(lagrangian, q) - ca.jtimes(momenta, q, v)
    if how == "ldl":
        return solve(mass, forcing), ca.SX(0, 1)
    jacobian = ca.jacobian(constraints, q)
    bias = ca.jtimes(ca.jtimes(constraints, q, v), q, v)
    if how == "schur":
        inverse = ca.sparsify(ca.solve(mass, ca.SX.eye(q.numel())))
        multipliers = solve(jacobian @ inverse @ jacobian.T, -bias - jacobian @ (inverse @ forcing))
        return inverse @ (forcing + jacobian.T @ multipliers), multipliers
    m = constraints.numel()
    matrix = ca.blockcat([[mass, -jacobian.T], [-jacobian, ca.SX(m, m)]])
    solution = solve(matrix, ca.vertcat(forcing, bias))
    return solution[: q.numel()], solution[q.numel() :]


def main():
    system, n, how, output = sys.argv[1], int(sys.argv[2]), sys.argv[3], sys.argv[4]
    start = time.perf_counter()
    p = ca.SX.sym("p", 2 * n + 1)
    stated = planar(n, p) if system == "planar" else rods(n, 3 if system == "spherical" else 2, p)
    a, multipliers = (ca.densify(result) for result in equations(*stated, how))
    function = ca.Function("evaluate", [stated[0], stated[1], p], [a, multipliers], {"cse": True})
    generate(function, output)
    report(function, start)


main()
