"""What bodies in space need of CasADi."""

import casadi as ca


class Fields:
    """The parameters in the order of the fields of ours."""

    def __init__(self):
        self.all = []

    def take(self, rows, columns=1):
        taken = ca.SX.sym(f"p{len(self.all)}", rows, columns)
        self.all.append(ca.vec(taken))
        return taken

    def each(self, count, rows, columns=1):
        return [self.take(rows, columns) for _ in range(count)]


def about(axis, angle):
    """A rotation about an axis, with its zeros."""
    k = "xyz".index(axis)
    i, j = (k + 1) % 3, (k + 2) % 3
    turn = ca.SX(3, 3)
    turn[k, k] = 1
    turn[i, i] = turn[j, j] = ca.cos(angle)
    turn[j, i], turn[i, j] = ca.sin(angle), -ca.sin(angle)
    return turn


def cross(u):
    """The matrix of u ×; ca.skew has no structural zeros."""
    matrix = ca.SX(3, 3)
    matrix[0, 1], matrix[0, 2], matrix[1, 2] = -u[2], u[1], -u[0]
    matrix[1, 0], matrix[2, 0], matrix[2, 1] = u[2], -u[1], u[0]
    return matrix
