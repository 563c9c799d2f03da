"""CasADi: the articulated-body algorithm in SX, all parameters symbolic, written as C.

usage: with_casadi_robots.py arm|denavit|quadruped|humanoid N OUTPUT.c

Featherstone, Rigid Body Dynamics Algorithms, chapter 7, in the axes of the links; a spatial vector is linear, then
angular. Prints what the C function takes, as JSON. q and v are as other tools have them in harness/robots.c, p as ours.
"""

import re
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import casadi as ca
from casadi_space import Fields, about, cross
from casadi_source import generate, report

HERE = Path(__file__).resolve().parent
TREE = r'TREE\({}, "(\w+)",\s*([-\d,\s]+)\)'


@dataclass
class Link:
    """`turn` takes the axes of the link to those of the one before, in which `at` is."""

    axis: str
    parent: int
    turn: ca.SX
    at: ca.SX
    m: ca.SX
    centre: ca.SX
    inertia: ca.SX
    tau: ca.SX


def tree(name):
    """Axes and parents of the joints, from the harness."""
    axes, parents = re.search(TREE.format(name), (HERE.parent / "harness" / "trees.h").read_text()).groups()
    return axes, [int(parent) for parent in parents.split(",")]


def placements(system, fields, joints):
    """How each joint stands on the link before: the turn, None where there is none, and the place."""
    if system == "denavit":
        alpha, a, d = (fields.take(joints) for _ in range(3))
        turns = [about("x", alpha[k]) for k in range(joints)]
        return turns, [ca.vertcat(a[k], -d[k] * ca.sin(alpha[k]), d[k] * ca.cos(alpha[k])) for k in range(joints)]
    turns = fields.each(joints, 3, 3) if system == "arm" else [None] * joints
    return turns, fields.each(joints, 3)


def robot(system, axes, parents, fields, q):
    """The links, the constant of gravity."""
    bodies, free = len(axes), axes[0] == "F"
    turns, places = placements(system, fields, bodies - free)
    if free:
        turns, places = [None, *turns], [None, *places]
    centres, inertias = fields.each(bodies, 3), fields.each(bodies, 3, 3)
    m, g, tau = fields.take(bodies), fields.take(1), fields.take(bodies - free)
    links = []
    for k, axis in enumerate(axes):
        turn = of_quaternion(q[3:7]) if axis == "F" else about(axis, q[k + 6 * free])
        turn = turn if turns[k] is None else turns[k] @ turn
        symmetric = ca.triu2symm(ca.triu(inertias[k]))
        links.append(Link(axis, parents[k], turn, places[k], m[k], centres[k], symmetric, tau[k - free]))
    return links, g


def of_quaternion(q):
    x, y, z, w = (q[k] for k in range(4))
    return ca.blockcat(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def moved(link, motion):
    """A motion of the link before, in the axes and at the origin of this one."""
    linear, angular = motion[:3], motion[3:]
    return ca.vertcat(link.turn.T @ (linear + ca.cross(angular, link.at)), link.turn.T @ angular)


def spatial_inertia(link):
    arm = cross(link.centre)
    about_origin = link.inertia - link.m * (arm @ arm)
    return ca.sparsify(ca.blockcat([[link.m * ca.SX.eye(3), -link.m * arm], [link.m * arm, about_origin]]))


def velocity_and_rest(link, before, v):
    """The velocity of a link, and what its acceleration has beside those of the joint and of the link before."""
    start, spin = moved(link, before), ca.SX(3, 1)
    spin["xyz".index(link.axis)] = v
    return start + ca.vertcat(ca.SX(3, 1), spin), ca.vertcat(ca.cross(start[:3], spin), ca.cross(start[3:], spin))


def bias_force(inertia, velocity):
    """velocity ×* momentum"""
    momentum, linear, angular = inertia @ velocity, velocity[:3], velocity[3:]
    torque = ca.cross(angular, momentum[3:]) + ca.cross(linear, momentum[:3])
    return ca.vertcat(ca.cross(angular, momentum[:3]), torque)


def articulated_bodies(links, g, v):
    """The derivatives of the speeds v."""
    free = links[0].axis == "F"
    velocity, rest, inertia, bias = [], [], [], []
    for k, link in enumerate(links):
        if link.axis == "F":
            velocity.append(v[:6])
            rest.append(ca.SX(6, 1))
        else:
            before = ca.SX(6, 1) if link.parent < 0 else velocity[link.parent]
            here, beside = velocity_and_rest(link, before, v[k + 5 * free])
            velocity.append(here)
            rest.append(beside)
        inertia.append(spatial_inertia(link))
        bias.append(bias_force(inertia[k], velocity[k]))
    column, left = inwards(links, inertia, bias, rest)
    return outwards(links, g, inertia, bias, rest, column, left)


def inwards(links, inertia, bias, rest):
    """From the tips to the base: adds to every link what hangs on it; the columns of the joints and the forces left."""
    column, left = {}, {}
    for k, link in reversed(list(enumerate(links))):
        if link.axis == "F":
            continue
        axis = 3 + "xyz".index(link.axis)
        column[k], left[k] = inertia[k][:, axis], link.tau - bias[k][axis]
        if link.parent < 0:
            continue
        hanging = inertia[k] - column[k] @ column[k].T / column[k][axis]
        force = bias[k] + hanging @ rest[k] + column[k] * (left[k] / column[k][axis])
        back = ca.sparsify(ca.blockcat([[link.turn.T, -(link.turn.T @ cross(link.at))], [ca.SX(3, 3), link.turn.T]]))
        inertia[link.parent] += ca.triu2symm(ca.triu(back.T @ (hanging @ back)))
        bias[link.parent] += back.T @ force
    return column, left


def outwards(links, g, inertia, bias, rest, column, left):
    acceleration, result = [], []
    for k, link in enumerate(links):
        if link.axis == "F":
            acceleration.append(ca.ldl_solve(-bias[k], *ca.ldl(inertia[k])))
            weight = link.turn.T @ ca.vertcat(0, 0, -g)
            result.append(acceleration[k] + ca.vertcat(weight, ca.SX(3, 1)))
            continue
        axis = 3 + "xyz".index(link.axis)
        ground = ca.vertcat(0, 0, g, 0, 0, 0)
        start = moved(link, ground if link.parent < 0 else acceleration[link.parent]) + rest[k]
        result.append((left[k] - ca.dot(column[k], start)) / column[k][axis])
        start[axis] += result[k]
        acceleration.append(start)
    return ca.vertcat(*result)


def main():
    system, n, output = sys.argv[1], sys.argv[2], sys.argv[3]
    start = time.perf_counter()
    axes, parents = tree(f"{system}_{n}")
    free, fields = axes[0] == "F", Fields()
    q, v = ca.SX.sym("q", len(axes) + 6 * free), ca.SX.sym("v", len(axes) + 5 * free)
    links, g = robot(system, axes, parents, fields, q)
    a = articulated_bodies(links, g, v)
    p = ca.vertcat(*fields.all)
    function = ca.Function("evaluate", [q, v, p], [ca.densify(a)], {"cse": True})
    inputs = ("q + OWN", f"q + OWN + {q.numel()}", "p")
    generate(function, output, inputs, outputs=("a + OWN",), header="systems.h")
    report(function, start)


if __name__ == "__main__":
    main()
