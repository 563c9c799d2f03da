#!/usr/bin/env python3
"""Recomputes reference motions in 50 decimal digits and writes them as tables: recompute.py FOLDER [NAME …].

The equations of motion are written by hand, from Newton and Euler, and share nothing with the derive. The modified
midpoint rule is extrapolated to order 2K (Gragg, Bulirsch and Stoer; Hairer, Nørsett and Wanner, *Solving Ordinary
Differential Equations I*, II.9). Each motion is integrated twice, with different orders and tolerances; a table states
the largest difference of the two runs, relative to the largest magnitude of each component. It also states the
amplification: the relative change of the last sample over a relative change of 10⁻²⁰ of the start.
"""
import sys
from decimal import Decimal as D, getcontext
from pathlib import Path

import mpmath

mpmath.mp.dps = 50
getcontext().prec = 56
ZERO, ONE, TWO = D(0), D(1), D(2)
PI = D("3.14159265358979323846264338327950288419716939937510582097494459")
# Order and relative tolerance of the two runs.
RUNS = [(18, D("1e-38")), (15, D("1e-33"))]


def sine_and_cosine(angle):
    angle = D(angle) / 64
    sine, cosine, term, k = ZERO, ZERO, ONE, 0
    while abs(term) > D("1e-60"):
        if k % 2:
            sine += term if k % 4 == 1 else -term
        else:
            cosine += term if k % 4 == 0 else -term
        k += 1
        term = term * angle / k
    for _ in range(6):
        sine, cosine = 2 * sine * cosine, cosine * cosine - sine * sine
    return sine, cosine


def midpoint(rate, y, slope, h, n):
    """The modified midpoint rule with n substeps of h/n, n even."""
    step = h / n
    before, now = y, [a + step * b for a, b in zip(y, slope)]
    twice = 2 * step
    for _ in range(n - 1):
        before, now = now, [a + twice * b for a, b in zip(before, rate(now))]
    return now


def step(rate, y, slope, h, order):
    """The extrapolated end of a step, and its difference from the next lower order."""
    column, counts = [], [2 * (j + 1) for j in range(order)]
    for j in range(order):
        row = [midpoint(rate, y, slope, h, counts[j])]
        for k in range(1, j + 1):
            ratio = D(counts[j]) / D(counts[j - k])
            weight = 1 / (ratio * ratio - 1)
            row.append([a + weight * (a - b) for a, b in zip(row[k - 1], column[k - 1])])
        column = row
    return column[-1], column[-2]


def integrate(rate, y, times, order, tolerance):
    """The states at the times. Every component is measured by its largest magnitude so far, or by 10⁻³ of the largest."""
    t, h, states = ZERO, D("0.01"), []
    scale = [abs(a) for a in y]
    for end in times:
        while t < end:
            taken = min(h, end - t)
            slope = rate(y)
            high, low = step(rate, y, slope, taken, order)
            least = max(scale) * D("1e-3")
            error = max(abs(a - b) / max(s, least) for a, b, s in zip(high, low, scale))
            factor = (float(tolerance) / max(float(error), 1e-60)) ** (1 / (2 * order - 1))
            if error <= tolerance:
                y, t = high, t + taken
                scale = [max(abs(a), s) for a, s in zip(y, scale)]
            if error > tolerance or taken == h:
                h = taken * D(min(2.0, max(0.3, 0.8 * factor)))
        states.append(y)
    return states


def relative(ones, others):
    """The largest difference of two lists of samples; a component is measured by its largest magnitude in them."""
    largest = 0
    for part in range(len(ones[0])):
        for i in range(len(ones[0][part])):
            scale = max(abs(one[part][i]) for one in ones)
            off = max(abs(one[part][i] - other[part][i]) for one, other in zip(ones, others))
            largest = max(largest, off / scale if scale else off)
    return largest


def number(x):
    x = +D(x)
    return "0" if abs(x) < D("1e-45") else f"{x:.26g}"


def halves(state):
    n = len(state) // 2
    return state[:n], state[n:], []


class Problem:
    """A motion: `rate` is the derivative of a state and does not depend on time, `start(change)` the initial state with a
    relative change, and `sample(state)` has its coordinates, velocities and multipliers."""

    def __init__(self, text, times, rate, start, sample=halves):
        self.text, self.rate, self.start, self.sample = text, rate, start, sample
        self.times = [ZERO, *map(D, times)]

    def samples(self, change, run):
        states = integrate(self.rate, self.start(change), self.times, *run)
        return [self.sample(state) for state in states]

    def table(self):
        best, other = (self.samples(ZERO, run) for run in RUNS)
        change = D("1e-20")
        amplified = relative(best[-1:], self.samples(change, RUNS[1])[-1:]) / change
        lines = [f"# {line}" for line in self.text.strip().splitlines()]
        agreement = relative(best, other)
        lines.append(f"# Recomputed by recompute.py: two runs differ by {agreement:.0e}; amplification {amplified:.0e}.")
        for t, parts in zip(self.times, best):
            lines.append(f"t {t}")
            for name, part in zip(("q", "v", "lambda"), parts):
                if part:
                    lines.append(" ".join([name, *map(number, part)]))
        return "\n".join(lines) + "\n"


def stretched(start):
    """The start with a relative change: two of three entries away from zero, the others towards it."""
    return lambda change: [a + change * a * (1 if i % 3 else -1) for i, a in enumerate(start)]


def gravity(masses, constant):
    """Accelerations of bodies that attract each other, positions as one list."""

    def rate(state, n=len(masses)):
        dimension = len(state) // (2 * n)
        half = len(state) // 2
        acceleration = [ZERO] * half
        for i in range(n):
            for j in range(i):
                apart = [state[dimension * i + k] - state[dimension * j + k] for k in range(dimension)]
                square = sum(a * a for a in apart)
                cube = constant / (square * square.sqrt())
                for k in range(dimension):
                    acceleration[dimension * i + k] -= masses[j] * cube * apart[k]
                    acceleration[dimension * j + k] += masses[i] * cube * apart[k]
        return state[half:] + acceleration

    return rate


def pleiades():
    x, y = [3, 3, -1, -3, 2, -2, 2], [3, -3, 2, 0, 0, -4, 4]
    u, v = [0, 0, 0, 0, 0, "1.75", "-1.5"], [0, 0, 0, "-1.25", 1, 0, 0]
    start = [D(a) for pair in zip(x, y) for a in pair] + [D(a) for pair in zip(u, v) for a in pair]
    text = "Seven stars in a plane, x and y of each. Hairer, Nørsett and Wanner, Solving ODEs I, II.10."
    return Problem(text, [1, 2, 3], gravity([D(m) for m in range(1, 8)], ONE), stretched(start))


# Hairer, Lubich and Wanner, Geometric Numerical Integration, I.2.4, table 2.2.
PLANETS = """
1.00000597682 0 0 0 0 0 0
0.000954786104043 -3.5023653 -3.8169847 -1.5507963 0.00565429 -0.00412490 -0.00190589
0.000285583733151 9.0755314 -3.0458353 -1.6483708 0.00168318 0.00483525 0.00192462
0.0000437273164546 8.3101420 -16.2901086 -7.2521278 0.00354178 0.00137102 0.00055029
0.0000517759138449 11.4707666 -25.7294829 -10.8169456 0.00288930 0.00114527 0.00039677
1/1.3e8 -15.5387357 -25.2225594 -3.1902382 0.00276725 -0.00170702 -0.00136504
"""


def outer_solar_system(times):
    rows = [line.split() for line in PLANETS.strip().splitlines()]
    masses = [ONE / D("1.3e8") if "/" in row[0] else D(row[0]) for row in rows]
    start = [D(a) for row in rows for a in row[1:4]] + [D(a) for row in rows for a in row[4:7]]
    text = """Sun with the inner planets, Jupiter, Saturn, Uranus, Neptune, Pluto; astronomical units and days.
Hairer, Lubich and Wanner, Geometric Numerical Integration, I.2.4."""
    return Problem(text, times, gravity(masses, D("2.95912208286e-4")), stretched(start))


def toda():
    n = 6

    def rate(state):
        q = state[:n]
        pull = [(q[i] - q[(i + 1) % n]).exp() for i in range(n)]
        return state[n:] + [pull[i - 1] - pull[i] for i in range(n)]

    start = [D(a) for a in ["0.3", "-0.2", "0.5", "0", "-0.4", "0.1", "0.8", "-0.5", "0.2", "0", "-0.9", "0.4"]]
    text = "Toda's lattice, a ring of six, V = Σ exp(q_i − q_{i+1}). M. Toda, J. Phys. Soc. Japan 22 (1967)."
    return Problem(text, [1, 10, 30], rate, stretched(start))


def fermi_pasta_ulam_tsingou(times):
    n, alpha = 31, D("0.25")

    def rate(state):
        q = [ZERO, *state[:n], ZERO]
        stretch = [b - a for a, b in zip(q, q[1:])]
        tension = [s + alpha * s * s for s in stretch]
        return state[n:] + [b - a for a, b in zip(tension, tension[1:])]

    start = [sine_and_cosine(PI * k / (n + 1))[0] for k in range(1, n + 1)] + [ZERO] * n
    text = """31 masses between walls, springs with the potential s²/2 + s³/12, let go from half a sine.
Fermi, Pasta, Ulam and Tsingou, Los Alamos report LA-1940 (1955)."""
    return Problem(text, times, rate, stretched(start))


def stiff_springs():
    m, omega = 3, D(50)

    def rate(state):
        q = [ZERO, *state[: 2 * m], ZERO]
        force = [ZERO] * (2 * m + 2)
        for i in range(m + 1):
            soft = 4 * (q[2 * i + 1] - q[2 * i]) ** 3
            force[2 * i] += soft
            force[2 * i + 1] -= soft
        for i in range(1, m + 1):
            stiff = omega * omega / 2 * (q[2 * i] - q[2 * i - 1])
            force[2 * i - 1] += stiff
            force[2 * i] -= stiff
        return state[2 * m :] + force[1:-1]

    root = TWO.sqrt()
    position = [(ONE - 1 / omega) / root, (ONE + 1 / omega) / root]
    start = position + [ZERO] * 4 + [ZERO, TWO / root] + [ZERO] * 4
    text = """Soft quartic springs alternating with stiff harmonic ones, three of these with ω = 50.
Galgani, Giorgilli, Martinoli and Vanzini, Physica D 59 (1992); Hairer, Lubich and Wanner, I.5.1."""
    return Problem(text, [1, 5, 10], rate, stretched(start))


def fekete(times):
    n, damping = 20, D("0.5")
    rings = [(3, 3, 8, 13), (7, 1, 8, 29), (6, -2, 15, 7), (4, -3, 10, 17)]

    def start(change):
        points = []
        for ring, (count, above, below, shift) in enumerate(rings):
            for k in range(count):
                # The last ring counts from 0, the others from 1.
                turn = (2 * PI * (k + (ring < 3)) / count + PI / shift) * (1 + change)
                (s, c), (up, out) = sine_and_cosine(turn), sine_and_cosine(PI * above / below)
                points += [c * out, s * out, up]
        return points + [ZERO] * (3 * n)

    def forces(state):
        p = state[: 3 * n]
        force = [-damping * a for a in state[3 * n :]]
        for i in range(n):
            x, y, z = p[3 * i : 3 * i + 3]
            for j in range(i):
                u, v, w = x - p[3 * j], y - p[3 * j + 1], z - p[3 * j + 2]
                inverse = 1 / (u * u + v * v + w * w)
                u, v, w = u * inverse, v * inverse, w * inverse
                force[3 * i] += u
                force[3 * i + 1] += v
                force[3 * i + 2] += w
                force[3 * j] -= u
                force[3 * j + 1] -= v
                force[3 * j + 2] -= w
        return force

    def multipliers(state, force):
        """λ of (p·p − 1)/2 = 0: p·p̈ + q·q = 0 with p̈ = f + λ p."""
        p, v, found = state[: 3 * n], state[3 * n :], []
        for i in range(n):
            part = slice(3 * i, 3 * i + 3)
            along = sum(a * f for a, f in zip(p[part], force[part]))
            found.append(-(along + sum(a * a for a in v[part])) / sum(a * a for a in p[part]))
        return found

    def rate(state):
        force = forces(state)
        found = multipliers(state, force)
        return state[3 * n :] + [f + found[i // 3] * a for i, (f, a) in enumerate(zip(force, state[: 3 * n]))]

    def sample(state):
        return state[: 3 * n], state[3 * n :], multipliers(state, forces(state))

    text = """20 points on the unit sphere that repel each other by 1/r, with friction −q̇/2; λ of (p·p − 1)/2 = 0.
Problem of Fekete points of the IVP test set (Bendtsen and Thomsen; Hairer and Wanner)."""
    return Problem(text, times, rate, start, sample)


def kapitza(nu, times):
    a, g, nu = D("0.1"), D("9.81"), D(nu)

    def multiplier(state):
        """λ of x² + (y − s)² − 1 = 0 with s = a cos νt: r̈ = −g e_y + 2λ d, d·r̈ − d_y s̈ + |ḋ|² = 0, d = r − s e_y."""
        x, y, u, v, c, s = state
        dy, rate_y = y - a * c, v + a * nu * s
        bend = -a * nu * nu * c
        return (g * dy + bend * dy - u * u - rate_y * rate_y) / (2 * (x * x + dy * dy))

    def rate(state):
        x, y, u, v, c, s = state
        pull = 2 * multiplier(state)
        return [u, v, pull * x, pull * (y - a * c) - g, -nu * s, nu * c]

    def start(change):
        sine, cosine = sine_and_cosine(D("0.1") * (1 + change))
        return [sine, cosine + a, ZERO, ZERO, ONE, ZERO]

    text = f"""Pendulum of length 1 whose pivot is at y = 0.1 cos {nu}t, let go 0.1 rad from upright, in Cartesian coordinates.
λ of x² + (y − 0.1 cos {nu}t)² − 1 = 0."""
    return Problem(text, times, rate, start, lambda s: (s[:2], s[2:4], [multiplier(s)]))


def foucault():
    g, length, turn = D("9.81"), D(67), D("7.292115e-5")
    sine, cosine = sine_and_cosine(PI * D("48.846222") / 180)
    wy, wz = turn * cosine, turn * sine

    def forces(state):
        x, y, z, u, v, w = state
        # −2 Ω × v − Ω × (Ω × r) − g e_z, Ω = (0, wy, wz).
        along = wy * y + wz * z
        return [
            -2 * (wy * w - wz * v) + turn2 * x,
            -2 * wz * u + turn2 * y - wy * along,
            2 * wy * u + turn2 * z - wz * along - g,
        ]

    turn2 = wy * wy + wz * wz

    def multiplier(state):
        force = forces(state)
        r, v = state[:3], state[3:]
        return -(sum(a * b for a, b in zip(r, force)) + sum(a * a for a in v)) / sum(a * a for a in r)

    def rate(state):
        pull = multiplier(state)
        return state[3:] + [f + pull * a for f, a in zip(forces(state), state[:3])]

    def start(change):
        east = 3 * (1 + change)
        return [east, ZERO, -(length * length - east * east).sqrt(), ZERO, ZERO, ZERO]

    text = """Pendulum of 67 m at 48.846222° north in the frame of an Earth that turns by 7.292115e-5 rad/s, let go 3 m to the
east: x east, y north, z up. λ of (r² − 67²)/2 = 0."""
    return Problem(text, [100, 1000, 3600], rate, start, lambda s: (s[:3], s[3:], [multiplier(s)]))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def solve3(m, b):
    def minor(c):
        return dot(c[0], cross(c[1], c[2]))

    columns = [[row[k] for row in m] for k in range(3)]
    whole = minor(columns)
    return [minor(columns[:k] + [b] + columns[k + 1 :]) / whole for k in range(3)]


def rattleback(spin, times):
    """Newton and Euler in the body's axes. State: R by rows, angular velocity w, centre of mass, γ.

    The contact is at s = −D n/√(n·D n) from the centre of the ellipsoid, n = e, and the centre of mass is h below it.
    """
    a2, b2, c2 = D("0.04"), D("0.0009"), D("0.0004")
    mass, g, h = ONE, D("9.81"), D("0.01")
    inertia = [[D("2e-4"), D("-0.2e-4"), ZERO], [D("-0.2e-4"), D("16e-4"), ZERO], [ZERO, ZERO, D("17e-4")]]

    def contact(e, e_rate):
        """The contact from the centre of mass, and its rate in the body's axes."""
        diagonal = [a2, b2, c2]
        square = dot(e, [d * x for d, x in zip(diagonal, e)])
        root = square.sqrt()
        root_rate = dot(e_rate, [d * x for d, x in zip(diagonal, e)]) / root
        point = [-d * x / root for d, x in zip(diagonal, e)]
        rate = [-d * x / root + d * y * root_rate / square for d, x, y in zip(diagonal, e_rate, e)]
        return [point[0], point[1], point[2] + h], rate

    def accelerations(e, w):
        """ẇ and the force of the ground, both in the body's axes."""
        rho, rho_rate = contact(e, cross(e, w))
        v = cross(rho, w)
        # a = ρ̇ × w + ρ × ẇ + w × v; F = m a + m g e; I ẇ + w × I w = ρ × F.
        known = [x + y + g * z for x, y, z in zip(cross(rho_rate, w), cross(w, v), e)]
        square = dot(rho, rho)
        matrix = [
            [inertia[i][j] + mass * ((square if i == j else ZERO) - rho[i] * rho[j]) for j in range(3)] for i in range(3)
        ]
        spin = [dot(row, w) for row in inertia]
        right = [mass * x - y for x, y in zip(cross(rho, known), cross(w, spin))]
        turned = solve3(matrix, right)
        force = [mass * (x + y) for x, y in zip(known, cross(rho, turned))]
        return turned, force, v

    # R = Rx(α) Ry(β) Rz(γ): its rows and the centre of mass follow from w.
    def rate(state):
        rows = [state[3 * i : 3 * i + 3] for i in range(3)]
        w = state[9:12]
        turned, _, v = accelerations(rows[2], w)
        moved = [dot(row, v) for row in rows]
        return [x for row in rows for x in cross(row, w)] + turned + moved + angle_rates(rows, w)[2:]

    def angle_rates(rows, w):
        """w = (α̇ cβ cγ + β̇ sγ, −α̇ cβ sγ + β̇ cγ, α̇ sβ + γ̇), and the first row of R is (cβ cγ, −cβ sγ, sβ)."""
        [x, y, sine] = rows[0]
        square = x * x + y * y
        along, across = x * w[0] + y * w[1], x * w[1] - y * w[0]
        return [along / square, across / square.sqrt(), w[2] - along / square * sine]

    def sample(state):
        rows = [state[3 * i : 3 * i + 3] for i in range(3)]
        w, place = state[9:12], state[12:15]
        _, force, v = accelerations(rows[2], w)
        f = lambda x: mpmath.mpf(str(x))
        angles = mpmath.atan2(-f(rows[1][2]), f(rows[2][2])), mpmath.asin(f(rows[0][2]))
        angles = [D(mpmath.nstr(x, 48)) for x in angles] + state[15:]
        return place + angles, [dot(row, v) for row in rows] + angle_rates(rows, w), force

    def start(change):
        (sa, ca), (sb, cb) = [sine_and_cosine(PI * D("0.5") / 180 * (1 + change))] * 2
        rows = [[cb, ZERO, sb], [sa * sb, ca, -sa * cb], [-ca * sb, sa, ca * cb]]
        rho, _ = contact(rows[2], [ZERO] * 3)
        return [x for row in rows for x in row] + [ZERO, ZERO, D(spin), ZERO, ZERO, -dot(rows[2], rho), ZERO]

    text = f"""Rattleback, an ellipsoid with half-axes 20, 3 and 2 cm rolling on a plane, SI units, spun at {spin} rad/s about its third
axis, α = β = 0.5°. Parameters: Kane and Levinson, Int. J. Non-Linear Mechanics 17 (1982), without their friction.
Coordinates: centre of mass, then angles of rotations about x, y, z of the body; λ: force of the ground in its axes."""
    return Problem(text, times, rate, start, sample)


PROBLEMS = {
    "pleiades": pleiades,
    "outer_solar_system": lambda: outer_solar_system([1000, 5000, 10000, 100000, 200000]),
    "toda": toda,
    "fput": lambda: fermi_pasta_ulam_tsingou([1, 10, 30, 1000, 10000]),
    "stiff_springs": stiff_springs,
    "fekete": lambda: fekete([1, 3, 20]),
    "kapitza_stands": lambda: kapitza(50, [1, 3]),
    "kapitza_falls": lambda: kapitza(40, [1, 3]),
    "foucault": foucault,
    "rattleback": lambda: rattleback(-5, ["0.5", 1, 3]),
}


def main():
    folder, names = Path(sys.argv[1]), sys.argv[2:] or PROBLEMS
    for name in names:
        (folder / f"{name}.txt").write_text(PROBLEMS[name]().table())


if __name__ == "__main__":
    main()
