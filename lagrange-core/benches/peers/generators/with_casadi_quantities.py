"""CasADi: inverse dynamics, mass matrix and derivatives of the accelerations in SX, written as C.

usage: with_casadi_quantities.py arm|quadruped|humanoid N inverse|mass|derivatives OUTPUT.c

Newton's and Euler's equations from link to link and composite bodies (Featherstone, Rigid Body Dynamics Algorithms, chapters 5
and 6); `jacobian` of the former, and `ldl` of the latter. Inputs and outputs are as other tools have them in
harness/quantities.c. Prints what the C function takes, as JSON.
"""

import sys
import time

import casadi as ca
from casadi_source import generate, report
from casadi_space import Fields, cross
from with_casadi_robots import articulated_bodies, bias_force, moved, robot, spatial_inertia, tree, velocity_and_rest


def axis_of(link):
    return 3 + "xyz".index(link.axis)


def back_to_parent(link):
    """The matrix that takes a motion of the link before to this one; its transpose takes forces back."""
    return ca.sparsify(ca.blockcat([[link.turn.T, -(link.turn.T @ cross(link.at))], [ca.SX(3, 3), link.turn.T]]))


def inverse(links, g, v, a):
    """The forces at the joints that accelerations take."""
    free, velocities, accelerations, forces = links[0].axis == "F", [], [], []
    ground = ca.vertcat(0, 0, g, 0, 0, 0)
    for k, link in enumerate(links):
        if link.axis == "F":
            velocity, acceleration = v[:6], a[:6] + ca.vertcat(link.turn.T @ ground[:3], ca.SX(3, 1))
        else:
            before = ca.SX(6, 1) if link.parent < 0 else velocities[link.parent]
            velocity, rest = velocity_and_rest(link, before, v[k + 5 * free])
            acceleration = moved(link, ground if link.parent < 0 else accelerations[link.parent]) + rest
            acceleration[axis_of(link)] += a[k + 5 * free]
        inertia = spatial_inertia(link)
        velocities.append(velocity)
        accelerations.append(acceleration)
        forces.append(inertia @ acceleration + bias_force(inertia, velocity))
    result = []
    for k, link in reversed(list(enumerate(links))):
        result.insert(0, forces[k] if link.axis == "F" else forces[k][axis_of(link)])
        if link.parent >= 0:
            forces[link.parent] += back_to_parent(link).T @ forces[k]
    return ca.vertcat(*result)


def mass(links):
    """The mass matrix above its diagonal."""
    free, inertias = links[0].axis == "F", [spatial_inertia(link) for link in links]
    size = len(links) + 5 * free
    matrix = ca.SX(size, size)
    for k, link in reversed(list(enumerate(links))):
        if link.axis == "F":
            matrix[:6, :6] = ca.triu(inertias[k])
            continue
        force, at = inertias[k][:, axis_of(link)], k
        while links[at].axis != "F":
            matrix[at + 5 * free, k + 5 * free] = force[axis_of(links[at])]
            if links[at].parent < 0:
                break
            force, at = back_to_parent(links[at]).T @ force, links[at].parent
        else:
            matrix[:6, k + 5 * free] = force
        if link.parent >= 0:
            back = back_to_parent(link)
            inertias[link.parent] += ca.triu2symm(ca.triu(back.T @ (inertias[k] @ back)))
    return matrix


def displaced(links, q):
    """Symbols of displacements along the axes of a free base and of the angles, and what turns it."""
    if links[0].axis != "F":
        return q, ca.SX(0, 1)
    turned = ca.SX.sym("turned", 3)
    links[0].turn = links[0].turn @ (ca.SX.eye(3) + cross(turned))
    return ca.vertcat(ca.SX.sym("moved", 3), turned, q[7:]), turned


def derivatives(links, g, q, v, a):
    """Those of the speeds' derivatives by displacements, speeds and forces at the joints, from those of inverse dynamics.

    That is less than half the operations of `jacobian` of the articulated-body algorithm, for the humanoid a quarter.
    """
    accelerations = articulated_bodies(links, g, v)
    factors = ca.ldl(ca.triu2symm(mass(links)))
    moves, turned = displaced(links, q)
    forces = ca.jacobian(inverse(links, g, v, a), ca.vertcat(moves, v))
    if turned.numel():
        forces = ca.substitute(forces, turned, ca.SX.zeros(3))
    units = ca.SX.eye(v.numel())[:, v.numel() - sum(link.axis != "F" for link in links) :]
    return ca.ldl_solve(ca.horzcat(-ca.substitute(forces, a, accelerations), units), *factors)


def main():
    system, n, quantity, output = sys.argv[1:]
    start = time.perf_counter()
    axes, parents = tree(f"{system}_{n}")
    free, fields = axes[0] == "F", Fields()
    q, v = ca.SX.sym("q", len(axes) + 6 * free), ca.SX.sym("v", len(axes) + 5 * free)
    a = ca.SX.sym("a", v.numel())
    links, g = robot(system, axes, parents, fields, q)
    result = {
        "inverse": lambda: inverse(links, g, v, a),
        "mass": lambda: mass(links),
        "derivatives": lambda: derivatives(links, g, q, v, a),
    }[quantity]()
    p = ca.vertcat(*fields.all)
    function = ca.Function("evaluate", [q, v, a, p], [ca.densify(result)], {"cse": True})
    rates, accelerations = q.numel(), q.numel() + v.numel()
    inputs = ("q + OWN", f"q + OWN + {rates}", f"q + OWN + {accelerations}", "p")
    generate(function, output, inputs, outputs=("a + OWN",), header="systems.h")
    report(function, start)


main()
