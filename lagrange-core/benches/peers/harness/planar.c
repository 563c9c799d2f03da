/* The planar pendulum of n links in angles from the vertical, and eight double pendulums side by side.
 * p = m[0..n], l[0..n], g. The reference is the dense system of equations in long double:
 *   M_ij = mu_ij l_i l_j cos(q_i - q_j),  h_i = -sum_j mu_ij l_i l_j sin(q_i - q_j) v_j^2 - mu_ii g l_i sin(q_i),
 * mu_ij the mass that hangs below the joints i and j. */
#include "systems.h"
#include <math.h>

enum { SIDE_BY_SIDE = 8 };

void eliminate(int n, long double m[UNKNOWNS][UNKNOWNS + 1], long double *x) {
    for (int c = 0; c < n; c++) {
        int pivot = c;
        for (int r = c; r < n; r++)
            if (fabsl(m[r][c]) > fabsl(m[pivot][c])) pivot = r;
        for (int k = 0; k <= n; k++) {
            long double swap = m[c][k];
            m[c][k] = m[pivot][k];
            m[pivot][k] = swap;
        }
        for (int r = c + 1; r < n; r++) {
            long double factor = m[r][c] / m[c][c];
            for (int k = c; k <= n; k++) m[r][k] -= factor * m[c][k];
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        x[i] = m[i][n];
        for (int k = i + 1; k < n; k++) x[i] -= m[i][k] * x[k];
        x[i] /= m[i][i];
    }
}

static void reference(int n, const double *q, const double *v, const double *p, long double *a) {
    long double m[UNKNOWNS][UNKNOWNS + 1], below[UNKNOWNS + 1] = {0};
    const double *length = p + n;
    for (int i = n - 1; i >= 0; i--) below[i] = below[i + 1] + p[i];
    for (int i = 0; i < n; i++) {
        m[i][n] = -below[i] * p[2 * n] * length[i] * sinl(q[i]);
        for (int j = 0; j < n; j++) {
            long double difference = (long double)q[i] - q[j];
            long double factor = below[i > j ? i : j] * length[i] * length[j];
            m[i][j] = factor * cosl(difference);
            m[i][n] -= factor * sinl(difference) * v[j] * v[j];
        }
    }
    eliminate(n, m, a);
}

static double error_of(int n, const double *q, const double *v, const double *p, const double *a) {
    long double exact[UNKNOWNS], scale = 0, error = 0;
    reference(n, q, v, p, exact);
    for (int i = 0; i < n; i++) {
        scale = fmaxl(scale, fabsl(exact[i]));
        error = fmaxl(error, isfinite(a[i]) ? fabsl(a[i] - exact[i]) : INFINITY);
    }
    return error / scale;
}

static void prepare(Inputs *in) {
    in->coordinates = in->n;
    for (int k = 0; k < 2 * in->n; k++) in->p[k] = uniform(0.5, 1.5);
    in->p[2 * in->n] = 9.81;
    for (int s = 0; s < STATES; s++)
        for (int k = 0; k < in->n; k++) {
            q_of(in, s)[k] = uniform(-3, 3);
            v_of(in, s)[k] = uniform(-2, 2);
        }
}

static double error(Inputs *in, int s, const double *a, const double *lambda) {
    (void)lambda;
    return error_of(in->n, q_of(in, s), v_of(in, s), in->p, a);
}

const System PLANAR = {"planar", prepare, error};

static void prepare_lanes(Inputs *in) {
    in->coordinates = 2 * SIDE_BY_SIDE;
    for (int k = 0; k < 5 * SIDE_BY_SIDE; k++) in->p[k] = k / SIDE_BY_SIDE < 4 ? uniform(0.5, 1.5) : 9.81;
    for (int s = 0; s < STATES; s++)
        for (int k = 0; k < 2 * SIDE_BY_SIDE; k++) {
            q_of(in, s)[k] = uniform(-3, 3);
            v_of(in, s)[k] = uniform(-2, 2);
        }
}

static double error_lanes(Inputs *in, int s, const double *a, const double *lambda) {
    (void)lambda;
    double largest = 0;
    for (int lane = 0; lane < SIDE_BY_SIDE; lane++) {
        double q[2], v[2], p[5], result[2];
        for (int k = 0; k < 5; k++) p[k] = in->p[SIDE_BY_SIDE * k + lane];
        for (int k = 0; k < 2; k++) {
            q[k] = q_of(in, s)[SIDE_BY_SIDE * k + lane];
            v[k] = v_of(in, s)[SIDE_BY_SIDE * k + lane];
            result[k] = a[SIDE_BY_SIDE * k + lane];
        }
        largest = fmax(largest, error_of(2, q, v, p, result));
    }
    return largest;
}

const System LANES = {"lanes", prepare_lanes, error_lanes};
