"""CasADi: bodies in loops in SX, all parameters symbolic, solved symbolically, written as C.

usage: with_casadi_loops.py four_bar|stewart lagrangian|newton degree|loops OUTPUT.c

The mass matrix and the forces come from the Lagrangian by CasADi's algorithmic differentiation, or from the accelerations
of the bodies, J^T I J and J^T w with Jacobians by CasADi (d'Alembert's principle; Kane and Levinson, Dynamics, 4.11). With
the constraints they are solved by CasADi's sparse L D L^T, in the order of least degree that it finds while it generates,
or loop by loop. Prints what the C function takes, as JSON. q, v and p are as in the harness.
"""

import sys
import time
from dataclasses import dataclass

import casadi as ca
from casadi_source import generate, report
from casadi_space import Fields, about, cross


@dataclass
class Frame:
    """`turn` takes its axes to the fixed ones, along which `at` is. Along its own: velocity and angular velocity, and the
    accelerations that it has where those of the coordinates are zero, with that of gravity upwards."""

    turn: ca.SX
    at: ca.SX
    velocity: ca.SX
    rate: ca.SX
    linear: ca.SX
    angular: ca.SX

    def moved(self, r, speed=None):
        speed = ca.SX(3, 1) if speed is None else speed
        return Frame(
            self.turn,
            self.at + self.turn @ r,
            self.velocity + ca.cross(self.rate, r) + speed,
            self.rate,
            self.linear
            + ca.cross(self.angular, r)
            + ca.cross(self.rate, ca.cross(self.rate, r))
            + 2 * ca.cross(self.rate, speed),
            self.angular,
        )

    def turned(self, by, spin=None):
        spin = ca.SX(3, 1) if spin is None else spin
        rate = by.T @ self.rate + spin
        angular = by.T @ self.angular + ca.cross(rate, spin)
        return Frame(self.turn @ by, self.at, by.T @ self.velocity, rate, by.T @ self.linear, angular)

    def turned_about(self, axis, angle, speed):
        spin = ca.SX(3, 1)
        spin["xyz".index(axis)] = speed
        return self.turned(about(axis, angle), spin)


def ground(g):
    zero = ca.SX(3, 1)
    return Frame(ca.SX.eye(3), zero, zero, zero, ca.vertcat(0, 0, g), zero)


@dataclass
class Body:
    m: ca.SX
    centre: ca.SX
    inertia: ca.SX

    @classmethod
    def of(cls, fields):
        m, centre, inertia = fields.take(1), fields.take(3), fields.take(3, 3)
        return cls(m, centre, ca.triu2symm(ca.triu(inertia)))


def of_quaternion(q):
    """Of a unit quaternion (w, x, y, z)."""
    arm = cross(q[1:])
    return ca.SX.eye(3) + 2 * (q[0] * arm + arm @ arm)


def own_rate(q, v):
    """2 q̄ q̇"""
    return 2 * (q[0] * v[1:] - v[0] * q[1:] - ca.cross(q[1:], v[1:]))


def four_bar(fields, q, v):
    """Frames with their bodies, constraints, g, forces."""
    p1, p3 = fields.each(2, 3, 3)
    l1, l2, l3, l4 = fields.each(4, 3)
    bodies = [Body.of(fields) for _ in range(3)]
    g, torque = fields.take(1), fields.take(1)
    crank = ground(g).turned(p1).turned_about("z", q[0], v[0])
    coupler = crank.moved(l1)
    for k, axis in enumerate("zyx"):
        coupler = coupler.turned_about(axis, q[1 + k], v[1 + k])
    rocker = ground(g).moved(l3).turned(p3).turned_about("z", q[4], v[4])
    ball = coupler.moved(l2).at - rocker.moved(l4).at
    return list(zip([crank, coupler, rocker], bodies)), ball, g, ca.vertcat(torque, ca.SX(4, 1))


def stewart(fields, q, v):
    top = Body.of(fields)
    base, anchor = fields.each(6, 3), fields.each(6, 3)
    cylinder, piston = Body.of(fields), Body.of(fields)
    g, push = fields.take(1), fields.take(6)
    plate = ground(g).moved(q[:3], v[:3]).turned(of_quaternion(q[3:7]), own_rate(q[3:7], v[3:7]))
    bodies, balls = [(plate, top)], []
    for k in range(6):
        leg = ground(g).moved(base[k]).turned_about("x", q[7 + k], v[7 + k]).turned_about("y", q[13 + k], v[13 + k])
        tip = leg.moved(ca.vertcat(0, 0, q[19 + k]), ca.vertcat(0, 0, v[19 + k]))
        bodies += [(leg, cylinder), (tip, piston)]
        balls.append(tip.at - plate.moved(anchor[k]).at)
    unit = ca.dot(q[3:7], q[3:7]) - 1
    return bodies, ca.vertcat(*balls, unit), g, ca.vertcat(ca.SX(19, 1), push)


def by_lagrangian(bodies, g, q, v):
    lagrangian = ca.SX(0)
    for frame, body in bodies:
        centre = frame.moved(body.centre)
        spin = ca.dot(frame.rate, body.inertia @ frame.rate)
        lagrangian += (body.m * ca.dot(centre.velocity, centre.velocity) + spin) / 2 - body.m * g * centre.at[2]
    momenta = ca.gradient(lagrangian, v)
    return ca.jacobian(momenta, v), ca.gradient(lagrangian, q) - ca.jtimes(momenta, q, v)


def by_newton(bodies, g, q, v):
    mass, forcing = ca.SX(q.numel(), q.numel()), ca.SX(q.numel(), 1)
    for frame, body in bodies:
        centre, turning = frame.moved(body.centre), body.inertia @ frame.rate
        along, around = ca.jacobian(centre.velocity, v), ca.jacobian(frame.rate, v)
        torque = body.inertia @ frame.angular + ca.cross(frame.rate, turning)
        mass += body.m * (along.T @ along) + around.T @ (body.inertia @ around)
        forcing -= body.m * (along.T @ centre.linear) + around.T @ torque
    return ca.triu2symm(ca.triu(mass)), forcing


SYSTEMS = {"four_bar": (four_bar, 5), "stewart": (stewart, 25)}
FORMS = {"lagrangian": by_lagrangian, "newton": by_newton}


def order(system):
    """Coordinates, then multipliers, of a loop after the other, and what they have in common last."""
    if system == "four_bar":
        return list(range(8))
    legs = [[7 + k, 13 + k, 19 + k, *range(25 + 3 * k, 28 + 3 * k)] for k in range(6)]
    return [k for leg in legs for k in leg] + [*range(7), 43]


def main():
    system, form, how, output = sys.argv[1:]
    start = time.perf_counter()
    state, n = SYSTEMS[system]
    fields, q, v = Fields(), ca.SX.sym("q", n), ca.SX.sym("v", n)
    bodies, constraints, g, force = state(fields, q, v)
    mass, forcing = FORMS[form](bodies, g, q, v)
    forcing += force
    jacobian = ca.sparsify(ca.jacobian(constraints, q))
    bias = ca.jtimes(ca.jtimes(constraints, q, v), q, v)
    if system == "stewart":
        # The mass matrix alone is singular along the quaternion; its constraint says what the acceleration is there.
        unit = jacobian[18, :]
        mass, forcing = mass + unit.T @ unit, forcing - unit.T * bias[18]
    m = constraints.numel()
    matrix = ca.sparsify(ca.blockcat([[mass, -jacobian.T], [-jacobian, ca.SX(m, m)]]))
    right = ca.vertcat(forcing, bias)
    if how == "degree":
        solution = ca.ldl_solve(right, *ca.ldl(matrix))
    else:
        places = order(system)
        back = [places.index(k) for k in range(n + m)]
        solution = ca.ldl_solve(right[places], *ca.ldl(matrix[places, places], False))[back]
    function = ca.Function(
        "evaluate", [q, v, ca.vertcat(*fields.all)], [ca.densify(solution[:n]), ca.densify(solution[n:])], {"cse": True}
    )
    generate(function, output)
    report(function, start)


main()
