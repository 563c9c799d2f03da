#!/usr/bin/env python3
"""Recomputes the numbers of these tests by Taylor series in mpmath, which share nothing with the library: 17 or more digits, in some minutes.

    python3 tests/orbits/recompute.py [eight] [cycle] [halo] [doublings] [spring] [mathieu]
"""

import itertools
import sys

from mpmath import arg, cos, eig, eigsy, lu_solve, matrix, mp, mpf, nstr, pi, sin


def at(series, h):
    """Values of polynomials, lowest coefficients first."""
    return [mp.polyval(x[::-1], h) for x in series]


def product(a, b, k):
    return sum(a[m] * b[k - m] for m in range(k + 1))


def power(u, w, p, k):
    """Coefficient k of w = u^p, from k u₀ w_k = Σ (p m − k + m) u_m w_{k−m}."""
    if k == 0:
        return u[0] ** p
    return sum((p * m - (k - m)) * u[m] * w[k - m] for m in range(1, k + 1)) / (k * u[0])


def flow(series, y, t, longest):
    n = int(t / longest) + 1
    for _ in range(n):
        y = at(series(y), t / n)
    return y


def newton(residual, u, small, h=mpf("1e-12")):
    u = [mpf(x) for x in u]
    for _ in range(12):
        r = residual(u)
        if max(map(abs, r)) < small:
            return u
        slopes = matrix(len(r), len(u))
        for j in range(len(u)):
            ahead, behind = list(u), list(u)
            ahead[j] += h
            behind[j] -= h
            for i, (x, y) in enumerate(zip(residual(ahead), residual(behind))):
                slopes[i, j] = (x - y) / (2 * h)
        step = lu_solve(slopes, matrix([-x for x in r]))
        u = [x + s for x, s in zip(u, step)]
    raise SystemExit("no convergence")


PAIRS = [(0, 1), (0, 2), (1, 2)]


def three_masses(y, order=34):
    c = [[x] + [mpf(0)] * order for x in y]
    d = [[[mpf(0)] * order for _ in range(2)] for _ in PAIRS]
    u, w = [[[mpf(0)] * order for _ in PAIRS] for _ in range(2)]
    for k in range(order):
        force = [mpf(0)] * 6
        for n, (i, j) in enumerate(PAIRS):
            for a in range(2):
                d[n][a][k] = c[2 * j + a][k] - c[2 * i + a][k]
            u[n][k] = sum(product(d[n][a], d[n][a], k) for a in range(2))
            w[n][k] = power(u[n], w[n], mpf(-3) / 2, k)
            for a in range(2):
                pull = product(d[n][a], w[n], k)
                force[2 * i + a] += pull
                force[2 * j + a] -= pull
        for i in range(6):
            c[i][k + 1] = c[6 + i][k] / (k + 1)
            c[6 + i][k + 1] = force[i] / (k + 1)
    return c


def eight():
    """Figure of eight with x as Chenciner and Montgomery have it, and angles of its multipliers over 2π."""
    mp.dps = 40

    def start(u):
        x, y, vx, vy = u
        return [x, y, -x, -y, mpf(0), mpf(0), vx, vy, vx, vy, -2 * vx, -2 * vy]

    x = mpf("0.97000436")
    guess = [mpf("-0.24308753"), mpf("0.93240737") / 2, mpf("0.86473146") / 2, mpf("6.32591398")]

    def after_a_third(u):
        return flow(three_masses, start([x, *u[:3]]), u[3] / 3, mpf("0.05"))

    # After a third of the period each body is where another was.
    end, begin = after_a_third(guess), start([x, *guess[:3]])

    def apart(order):
        return sum(abs(end[2 * order[i] + a] - begin[2 * i + a]) for i in range(3) for a in range(2))

    order = min(itertools.permutations(range(3)), key=apart)

    def residual(u):
        end, begin = after_a_third(u), start([x, *u[:3]])
        return [end[k + 2 * order[i] + a] - begin[k + 2 * i + a] for k in (0, 6) for i in range(3) for a in range(2)]

    u = newton(residual, guess, mpf("1e-28"))
    print("start", *(nstr(s, 20) for s in [x, *u[:3]]), "period", nstr(u[3], 20))
    once = matrix(12, 12)
    for j in range(12):
        ends = []
        for h in (mpf("1e-13"), mpf("-1e-13")):
            y = start([x, *u[:3]])
            y[j] += h
            ends.append(flow(three_masses, y, u[3], mpf("0.05")))
        for i in range(12):
            once[i, j] = (ends[0][i] - ends[1][i]) / mpf("2e-13")
    for multiplier in eig(once)[0]:
        print("turn", nstr(arg(multiplier) / (2 * pi), 18), "modulus", nstr(abs(multiplier), 18))


def van_der_pol(y, order=30):
    x, v = [[s] + [mpf(0)] * order for s in y]
    square, factor = [mpf(0)] * order, [mpf(0)] * order
    for k in range(order):
        square[k] = product(x, x, k)
        factor[k] = (1 if k == 0 else 0) - square[k]
        x[k + 1] = v[k] / (k + 1)
        v[k + 1] = (product(factor, v, k) - x[k]) / (k + 1)
    return x, v


def cycle():
    """Period of van der Pol's oscillator at μ = 1; half of the cycle is the other half's opposite."""
    mp.dps = 25

    def residual(u):
        x, v = flow(van_der_pol, [u[0], mpf(0)], u[1] / 2, mpf("0.05"))
        return [x + u[0], v]

    u = newton(residual, ["2.00862", "6.66329"], mpf("1e-20"))
    print("period", nstr(u[1], 18), "amplitude", nstr(u[0], 18))


MU = mpf("0.01215058560962404")


def restricted(y, order=26):
    """Planar motion near Earth and Moon, and a deviation from the plane."""
    x, y, vx, vy, z, vz = [[s] + [mpf(0)] * order for s in y]
    s1, s2, w1, w2, f, d1, d2 = [[mpf(0)] * order for _ in range(7)]
    for k in range(order):
        d1[k], d2[k] = (x[k] + MU, x[k] - 1 + MU) if k == 0 else (x[k], x[k])
        s1[k] = product(d1, d1, k) + product(y, y, k)
        s2[k] = product(d2, d2, k) + product(y, y, k)
        w1[k], w2[k] = power(s1, w1, mpf(-3) / 2, k), power(s2, w2, mpf(-3) / 2, k)
        f[k] = (1 - MU) * w1[k] + MU * w2[k]
        ax = 2 * vy[k] + x[k] - (1 - MU) * product(d1, w1, k) - MU * product(d2, w2, k)
        ay = -2 * vx[k] + y[k] - product(f, y, k)
        az = -product(f, z, k)
        for to, of in ((x, vx[k]), (y, vy[k]), (vx, ax), (vy, ay), (z, vz[k]), (vz, az)):
            to[k + 1] = of / (k + 1)
    return x, y, vx, vy, z, vz


def halo():
    """Orbits in the plane that others leave: mirrored in z (halo orbits), or in z's velocity (axial orbits)."""
    mp.dps = 30
    for name, guess, (place, speed, row) in [
        ("halo", ["0.82339", "0.126326", "1.3715"], (1, 0, 5)),
        ("axial", ["0.78157", "0.4432", "1.97500"], (0, 1, 4)),
    ]:

        def residual(u):
            end = flow(restricted, [u[0], mpf(0), mpf(0), u[1], mpf(place), mpf(speed)], u[2], mpf("0.02"))
            return [end[1], end[2], end[row]]

        x, v, half = newton(residual, guess, mpf("1e-22"))
        jacobi = x * x + 2 * (1 - MU) / abs(x + MU) + 2 * MU / abs(x - 1 + MU) - v * v
        print(name, "C", nstr(jacobi, 18), "period", nstr(2 * half, 18))


def pendulum(y, t, force, order=22):
    phi, v, *rest = [[s] + [mpf(0)] * order for s in y]
    rate, natural = 2 * pi, 3 * pi
    s, c = [sin(y[0])] + [mpf(0)] * order, [cos(y[0])] + [mpf(0)] * order
    for k in range(order):
        if k:
            s[k] = sum(m * phi[m] * c[k - m] for m in range(1, k + 1)) / k
            c[k] = -sum(m * phi[m] * s[k - m] for m in range(1, k + 1)) / k
        drive = force * natural**2 * rate**k * cos(rate * t + k * pi / 2) / mp.factorial(k)
        phi[k + 1] = v[k] / (k + 1)
        v[k + 1] = (drive - natural / 2 * v[k] - natural**2 * s[k]) / (k + 1)
        for a, b in (rest[:2], rest[2:]):
            a[k + 1] = b[k] / (k + 1)
            b[k + 1] = (-natural / 2 * b[k] - natural**2 * product(c, a, k)) / (k + 1)
    return [phi, v, *rest]


def doublings():
    """Forces at which the driven pendulum doubles its period: the orbit closes, and det(M + 1) = 0."""
    mp.dps = 25
    steps = 40
    for turns, guess in [
        (1, ["-0.22147", "18.46936", "1.06637"]),
        (2, ["-0.0988100", "17.832616", "1.0793139"]),
        (4, ["-0.111070763", "17.951416904", "1.082084384"]),
        (8, ["-0.11695202846", "18.00038915796", "1.0826783527"]),
        (16, ["-0.118277821777", "18.011053641549", "1.08280559115"]),
    ]:

        def residual(u):
            y = [u[0], u[1], mpf(1), mpf(0), mpf(0), mpf(1)]
            for k in range(turns * steps):
                y = at(pendulum(y, mpf(k % steps) / steps, u[2]), mpf(1) / steps)
            return [y[0] - u[0], y[1] - u[1], (y[2] + 1) * (y[5] + 1) - y[3] * y[4]]

        print(turns, "gamma", nstr(newton(residual, guess, mpf("1e-17"))[2], 18), flush=True)


def spring_pendulum(y, order=30):
    """Unit mass on a spring of stiffness 60 and length 0.8, g = 9.81; y points up."""
    x, z, vx, vz = [[s] + [mpf(0)] * order for s in y]
    u, w = [[mpf(0)] * order for _ in range(2)]
    for k in range(order):
        u[k] = product(x, x, k) + product(z, z, k)
        w[k] = power(u, w, mpf(-1) / 2, k)
        ax = 48 * product(x, w, k) - 60 * x[k]
        az = 48 * product(z, w, k) - 60 * z[k] - (mpf("9.81") if k == 0 else 0)
        for to, of in ((x, vx[k]), (z, vz[k]), (vx, ax), (vz, az)):
            to[k + 1] = of / (k + 1)
    return x, z, vx, vz


def spring():
    """Energies between which the swing of a spring pendulum is unstable, where a deviation closes.

    The swing starts at rest and after a quarter of the period crosses x = 0 with ż = 0. A deviation at rest along the line of
    constant potential, or of the velocity across the motion, is then opposite or equal to its mirror image, up to the motion's own
    direction.
    """
    mp.dps = 45
    h = mpf("1e-15")

    def force(x, z):
        part = 48 / mp.sqrt(x * x + z * z) - 60
        return part * x, part * z - mpf("9.81")

    def opposite(end, change):
        return change[1]

    def equal(end, change):
        return change[0] * force(*end[:2])[1] - change[3] * end[2]

    for name, guess, condition in [
        ("rest", ["0.60687", "-0.62378", "0.559469"], opposite),
        ("velocity", ["0.60927", "-0.62066", "0.56004"], equal),
    ]:

        def residual(u):
            x, z, quarter = u
            fx, fz = force(x, z)
            deviation = [-fz, fx, 0, 0] if name == "rest" else [0, 0, -fz, fx]
            ends = [
                flow(spring_pendulum, [s + by * d for s, d in zip([x, z, 0, 0], deviation)], quarter, mpf("0.05"))
                for by in (0, h, -h)
            ]
            change = [(a - b) / (2 * h) for a, b in zip(*ends[1:])]
            return [ends[0][0], ends[0][3], condition(ends[0], change)]

        x, z, quarter = newton(residual, guess, mpf("1e-20"))
        energy = 30 * (mp.sqrt(x * x + z * z) - mpf("0.8")) ** 2 + mpf("9.81") * z
        print(name, "E", nstr(energy, 18), "period", nstr(4 * quarter, 18))


def mathieu():
    """Characteristic values of Mathieu's equation at q = 0.3, from the matrices of the Fourier coefficients."""
    mp.dps = 25
    q, n = mpf("0.3"), 25

    def lowest(harmonics, corner=0, first=1):
        a = matrix(n, n)
        for i, k in enumerate(harmonics):
            a[i, i] = mpf(k) ** 2
        for i in range(n - 1):
            a[i, i + 1] = a[i + 1, i] = q
        a[0, 0] += corner
        a[0, 1] = a[1, 0] = first * q
        return sorted(eigsy(a, eigvals_only=True))

    odd, even = range(1, 2 * n, 2), range(0, 2 * n, 2)
    b1, b3 = lowest(odd, -q)[:2]
    a1, a3 = lowest(odd, q)[:2]
    b2, a2 = lowest(range(2, 2 * n + 2, 2))[0], lowest(even, first=mp.sqrt(2))[1]
    print(", ".join(nstr(x, 18) for x in (b1, a1, b2, a2, b3, a3)))


if __name__ == "__main__":
    parts = {"eight": eight, "cycle": cycle, "halo": halo, "doublings": doublings, "spring": spring, "mathieu": mathieu}
    for name in sys.argv[1:] or parts:
        print(f"[{name}]", flush=True)
        parts[name]()
