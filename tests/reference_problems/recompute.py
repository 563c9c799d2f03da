#!/usr/bin/env python3
"""Reference values of two problems by multiple precision, without code of this project; needs mpmath.

recompute.py bicycle         a state in a turn, its accelerations and multipliers, in a second
recompute.py slider_crank    the flexible slider crank at t = 0.05 and 0.1, in some minutes (gmpy2 makes it faster)
"""

import sys

from mpmath import cos, eye, findroot, lu_solve, matrix, mp, mpf, nstr, pi, sin, sqrt


def show(name, values, digits=20):
    print(f"{name}: [{', '.join(nstr(value, digits) for value in values)}]", flush=True)


# ---- The benchmark bicycle: L and the constraints, differentiated by central differences.


def bicycle():
    mp.dps = 60
    tilt, base, trail, g = pi / 10, mpf("1.02"), mpf("0.08"), mpf("9.81")
    rear, front = mpf("0.3"), mpf("0.35")
    half = lambda xx, yy, zz, xz: matrix([[xx, 0, xz], [0, yy, 0], [xz, 0, zz]])
    masses = [2, 85, 4, 3]
    inertias = [
        half(mpf("0.0603"), mpf("0.12"), mpf("0.0603"), 0),
        half(mpf("9.2"), 11, mpf("2.8"), mpf("2.4")),
        half(mpf("0.05892"), mpf("0.06"), mpf("0.00708"), mpf("-0.00756")),
        half(mpf("0.1405"), mpf("0.28"), mpf("0.1405"), 0),
    ]
    vector = lambda *entries: matrix(list(entries))
    dot = lambda a, b: (a.T * b)[0]
    cross = lambda a, b: vector(
        a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
    )
    z, axis = vector(0, 0, 1), vector(sin(tilt), 0, cos(tilt))
    hub, pivot = vector(0, 0, -rear), vector(base + trail, 0, 0)

    def about(n, angle):
        skew = matrix([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
        return eye(3) + sin(angle) * skew + (1 - cos(angle)) * skew * skew

    def bodies(q):
        """Centres of mass and rotations of rear wheel, body, fork and front wheel; the last two are those of the frame and the fork."""
        x, y, yaw, roll, pitch, steer, turned_rear, turned_front = q
        upright = about(vector(0, 0, 1), yaw) * about(vector(1, 0, 0), roll)
        body = upright * about(vector(0, 1, 0), pitch)
        fork = body * about(axis, steer)
        at_hub = vector(x, y, 0) - rear * (upright * z)
        at_pivot = at_hub + body * (pivot - hub)
        in_fork = lambda p: at_pivot + fork * (p - pivot)
        places = [
            at_hub,
            at_hub + body * (vector(mpf("0.3"), 0, mpf("-0.9")) - hub),
            in_fork(vector(mpf("0.9"), 0, mpf("-0.7"))),
            in_fork(vector(base, 0, -front)),
        ]
        spin = lambda angle: about(vector(0, 1, 0), angle)
        return places, [upright * spin(turned_rear), body, fork, fork * spin(turned_front)], upright, fork

    def along(function, q, v, h=mpf(10) ** -20):
        ahead, back = ([a + s * h * b for a, b in zip(q, v)] for s in (1, -1))
        return (function(ahead) - function(back)) / (2 * h)

    def rates(function, q, v):
        """Derivatives of a list along v, to the fourth order."""
        h = mpf(10) ** -7

        def central(h):
            ahead, back = (function([a + s * h * b for a, b in zip(q, v)]) for s in (1, -1))
            return [(a - b) / (2 * h) for a, b in zip(ahead, back)]

        return [(4 * fine - coarse) / 3 for coarse, fine in zip(central(h), central(h / 2))]

    def velocities(q, v):
        rotations = bodies(q)[1]
        linear = [along(lambda s: bodies(s)[0][i], q, v) for i in range(4)]
        angular = []
        for i in range(4):
            w = along(lambda s: bodies(s)[1][i], q, v) * rotations[i].T
            angular.append(vector(w[2, 1] - w[1, 2], w[0, 2] - w[2, 0], w[1, 0] - w[0, 1]) / 2)
        return linear, angular, rotations

    def kinetic(q, v):
        total = mpf(0)
        for m, inertia, u, w, rotation in zip(masses, inertias, *velocities(q, v)):
            w = rotation.T * w
            total += m * dot(u, u) / 2 + dot(w, inertia * w) / 2
        return total

    def potential(q):
        return -g * sum(m * place[2] for m, place in zip(masses, bodies(q)[0]))

    def touches(q):
        places, _, _, fork = bodies(q)
        return places[3][2] + front * sqrt(1 - (fork * vector(0, 1, 0))[2] ** 2)

    def slips(q, v):
        linear, angular, _ = velocities(q, v)
        _, _, upright, fork = bodies(q)
        axle = fork * vector(0, 1, 0)
        down = (z - axle[2] * axle) / sqrt(1 - axle[2] ** 2)
        behind = linear[0] + rear * cross(angular[0], upright * z)
        before = linear[3] + front * cross(angular[3], down)
        return [behind[0], behind[1], before[0], before[1]]

    n, m = 8, 5
    unit = lambda i: [mpf(k == i) for k in range(n)]
    q = [mpf(x) for x in ("0.3", "-0.2", "0.4", "0.2", "0", "0.3", "0.5", "-0.7")]
    q[4] = findroot(lambda pitch: touches(q[:4] + [pitch] + q[5:]), mpf(0))
    columns = [[along(touches, q, unit(i))] + slips(q, unit(i)) for i in range(n)]
    given = {3: mpf("0.5"), 5: mpf("-0.8"), 6: mpf(-15)}
    rest = [i for i in range(n) if i not in given]
    system = matrix(m, m)
    right = matrix(m, 1)
    for a in range(m):
        for k, i in enumerate(rest):
            system[a, k] = columns[i][a]
        right[a] = -sum(columns[i][a] * rate for i, rate in given.items())
    found = lu_solve(system, right)
    v = [given.get(i) for i in range(n)]
    for k, i in enumerate(rest):
        v[i] = found[k]

    # T is quadratic in the velocities: masses and momenta are exact differences.
    plus = lambda u, w: [a + b for a, b in zip(u, w)]
    own = [kinetic(q, unit(i)) for i in range(n)]
    momenta = lambda s: [kinetic(s, plus(v, unit(i))) - kinetic(s, v) - kinetic(s, unit(i)) for i in range(n)]
    changing = rates(momenta, q, v)
    bias = rates(lambda s: [along(touches, s, v)] + slips(s, v), q, v)
    equations, right = matrix(n + m, n + m), matrix(n + m, 1)
    for i in range(n):
        for j in range(i):
            equations[i, j] = equations[j, i] = kinetic(q, plus(unit(i), unit(j))) - own[i] - own[j]
        equations[i, i] = 2 * own[i]
        for a in range(m):
            equations[i, n + a], equations[n + a, i] = -columns[i][a], columns[i][a]
        right[i] = rates(lambda s: [kinetic(s, v) - potential(s)], q, unit(i))[0] - changing[i]
    for a in range(m):
        right[n + a] = -bias[a]
    solution = lu_solve(equations, right)
    show("q", q)
    show("v", v)
    show("accelerations", solution[:n])
    show("multipliers", solution[n:])
    show("energy", [kinetic(q, v) + potential(q)])


# ---- The flexible slider crank: its published mass matrix and forces, by extrapolated midpoint rules.


def slider_crank(columns=14, steps=800):
    mp.dps = 46
    l1, l2, m2, m3, j1, j2 = (mpf(x) for x in ("0.15", "0.3", "0.151104", "0.075552", "0.002727", "0.0045339259"))
    p, young, side, density, omega = mpf("3.1415927"), mpf("2e11"), mpf("0.008"), mpf(7870), mpf(150)
    volume = side * side * l2
    mass, stiff = density * volume, young * side * side / l2
    mq = [[mass / 2, 0, 0, 0], [0, mass / 2, 0, 0], [0, 0, 8 * mass, mass], [0, 0, mass, 2 * mass]]
    slender = stiff * p**4 * (side / l2) ** 2
    kq = [
        [slender / 24, 0, 0, 0],
        [0, slender * 2 / 3, 0, 0],
        [0, 0, stiff * 16 / 3, -stiff * 8 / 3],
        [0, 0, -stiff * 8 / 3, stiff * 7 / 3],
    ]
    bq = [[mpf(0)] * 4 for _ in range(4)]
    for i, j, x in [(0, 2, -16 / p**3), (0, 3, 8 / p**3 - 1 / p), (1, 3, 1 / (2 * p))]:
        bq[i][j], bq[j][i] = volume * x, -volume * x
    c1, c2 = [0, 0, volume * 2 / 3, volume / 6], [volume * 2 / p, 0, 0, 0]
    c12, c21 = [0, 0, l2 * volume / 3, l2 * volume / 6], [l2 * volume / p, -l2 * volume / (2 * p), 0, 0]
    dot = lambda a, b: sum((x * y for x, y in zip(a, b) if x != 0), mpf(0))
    four = range(4)

    def solve(rows):
        """Gauss's elimination with pivots, of rows that end in the right-hand side."""
        n = len(rows)
        for c in range(n):
            pivot = max(range(c, n), key=lambda r: abs(rows[r][c]))
            rows[c], rows[pivot] = rows[pivot], rows[c]
            for r in range(c + 1, n):
                if rows[r][c] != 0:
                    part = rows[r][c] / rows[c][c]
                    for k in range(c + 1, n + 1):
                        rows[r][k] -= part * rows[c][k]
        x = [mpf(0)] * n
        for r in reversed(range(n)):
            x[r] = (rows[r][n] - sum(rows[r][k] * x[k] for k in range(r + 1, n))) / rows[r][r]
        return x

    def accelerations(x, v):
        """Accelerations of φ₁, φ₂, x₃ and q, and the multipliers."""
        (s1, k1), (s2, k2), q, u = (sin(x[0]), cos(x[0])), (sin(x[1]), cos(x[1])), x[3:], v[3:]
        s, k, v1, v2 = s1 * k2 - k1 * s2, k1 * k2 + s1 * s2, v[0], v[1]
        mass_q = [dot(mq[i], q) for i in four]
        rows = [[mpf(0)] * 11 for _ in range(10)]
        rows[0][0], rows[2][2] = j1 + m2 * l1 * l1, m3
        rows[0][1] = rows[1][0] = l1 * l2 * m2 * k / 2 + density * l1 * (s * dot(c2, q) + k * dot(c1, q))
        rows[1][1] = j2 + dot(q, mass_q) + 2 * density * dot(c12, q)
        for i in four:
            rows[0][3 + i] = rows[3 + i][0] = density * l1 * (k * c2[i] - s * c1[i])
            rows[1][3 + i] = rows[3 + i][1] = density * (c21[i] + sum(q[j] * bq[j][i] for j in four))
            for j in four:
                rows[3 + i][3 + j] = mpf(mq[i][j])
        force = [
            -l1 * l2 * m2 * v2 * v2 * s / 2
            + density * l1 * v2 * v2 * (k * dot(c2, q) - s * dot(c1, q))
            - 2 * density * l1 * v2 * (k * dot(c1, u) + s * dot(c2, u)),
            l1 * l2 * m2 * v1 * v1 * s / 2
            + density * l1 * v1 * v1 * (s * dot(c1, q) - k * dot(c2, q))
            - 2 * density * v2 * dot(c12, u)
            - 2 * v2 * dot(u, mass_q),
            mpf(0),
        ]
        for i in four:
            moved = v2 * v2 * c12[i] + l1 * v1 * v1 * (k * c1[i] + s * c2[i]) + 2 * v2 * dot(bq[i], u)
            force.append(v2 * v2 * mass_q[i] + density * moved - dot(kq[i], q))
        rod = l2 + q[3]
        jacobian = [[l1 * k1, rod * k2, 0, 0, 0, 0, s2], [l1 * s1, rod * s2, 1, 0, 0, 0, -k2], [1] + [0] * 6]
        bias = [
            l1 * s1 * v1 * v1 + rod * s2 * v2 * v2 - 2 * v2 * k2 * u[3],
            -l1 * k1 * v1 * v1 - rod * k2 * v2 * v2 - 2 * v2 * s2 * u[3],
            mpf(0),
        ]
        for i in range(7):
            rows[i][10] = force[i]
            for a in range(3):
                rows[i][7 + a], rows[7 + a][i] = -mpf(jacobian[a][i]), mpf(jacobian[a][i])
        for a in range(3):
            rows[7 + a][10] = bias[a]
        found = solve(rows)
        return found[:7], found[7:]

    def change(y):
        return y[7:] + accelerations(y[:7], y[7:])[0]

    def step(y, length):
        table = []
        for k in range(columns):
            n = 2 * (k + 1)
            h = length / n
            before, now = y, [a + h * b for a, b in zip(y, change(y))]
            for _ in range(n - 1):
                before, now = now, [a + 2 * h * b for a, b in zip(before, change(now))]
            row = [[(a + b + h * c) / 2 for a, b, c in zip(before, now, change(now))]]
            for j in range(k):
                ratio = (mpf(n) / (2 * (k - j))) ** 2 - 1
                row.append([a + (a - b) / ratio for a, b in zip(row[j], table[-1][j])])
            table.append(row)
        return table[-1][-1]

    q3, q4 = mpf("0.103339863e-4"), mpf("0.169327969e-4")
    rates = [mpf(x) for x in ("-0.268938672e-5", "0.444896105", "0.463434311e-2", "-0.178591076e-5", "-0.268938672e-5")]
    y = [mpf(0), mpf(0), l1 + l2 + q4, mpf(0), mpf(0), q3, q4, omega, -l1 * omega / (l2 + q4)] + rates
    for k in range(1, steps + 1):
        y = step(y, mpf("0.1") / steps)
        if k in (steps // 2, steps):
            print("t =", mpf("0.1") * k / steps)
            show("q", y[:7])
            show("v", y[7:])
            show("multipliers", accelerations(y[:7], y[7:])[1])


if __name__ == "__main__":
    {"bicycle": bicycle, "slider_crank": slider_crank}[sys.argv[1]]()
