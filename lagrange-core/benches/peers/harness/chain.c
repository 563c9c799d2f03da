/* Masses on rods in Cartesian coordinates, each on the one before: a plane chain of n, and one mass in space.
 * q = all x, then all y (then z); the last axis points up; p = m[0..n], l[0..n], g.
 * Constraint i is (|r_i - r_(i-1)|^2 - l_i^2)/2 = 0. Checked are the residuals of both equations, in long double:
 *   M a = f + J^T lambda,  J a = -dJ/dt v. */
#include "systems.h"
#include <math.h>

static long double link(const double *x, int n, int i, int k) {
    return i < n ? x[k * n + i] - (i ? (long double)x[k * n + i - 1] : 0) : 0;
}

static void prepare(Inputs *in, int dimension) {
    int n = in->n;
    in->coordinates = dimension * n;
    for (int k = 0; k < 2 * n; k++) in->p[k] = uniform(0.5, 1.5);
    in->p[2 * n] = 9.81;
    for (int s = 0; s < STATES; s++)
        for (int i = 0; i < n; i++) {
            double l = in->p[n + i], angle = uniform(-3, 3), rate = uniform(-2, 2);
            double tilt = uniform(1, 2), tilt_rate = uniform(0, 1);
            double plane[2][2] = {{sin(angle), -cos(angle)}, {rate * cos(angle), rate * sin(angle)}};
            double space[2][3] = {
                {sin(tilt) * cos(angle), sin(tilt) * sin(angle), -cos(tilt)},
                {tilt_rate * cos(tilt) * cos(angle) - rate * sin(tilt) * sin(angle),
                 tilt_rate * cos(tilt) * sin(angle) + rate * sin(tilt) * cos(angle), tilt_rate * sin(tilt)}};
            for (int k = 0; k < dimension; k++) {
                double *q = q_of(in, s) + k * n + i, *v = v_of(in, s) + k * n + i;
                *q = l * (dimension == 2 ? plane[0][k] : space[0][k]) + (i ? q[-1] : 0);
                *v = l * (dimension == 2 ? plane[1][k] : space[1][k]) + (i ? v[-1] : 0);
            }
        }
}

static double error(Inputs *in, int s, const double *a, const double *lambda, int dimension) {
    int n = in->n;
    const double *q = q_of(in, s), *v = v_of(in, s), *p = in->p;
    long double scale = 0, largest = 0;
    for (int i = 0; i < n; i++) {
        long double constraint = 0;
        for (int k = 0; k < dimension; k++) {
            int up = k == dimension - 1;
            long double rate = link(v, n, i, k);
            constraint += link(q, n, i, k) * link(a, n, i, k) + rate * rate;
            long double force = lambda[i] * link(q, n, i, k);
            if (i + 1 < n) force -= lambda[i + 1] * link(q, n, i + 1, k);
            if (up) force -= p[i] * p[2 * n];
            scale = fmaxl(scale, fabsl(a[k * n + i]));
            largest = fmaxl(largest, fabsl(p[i] * a[k * n + i] - force));
        }
        largest = fmaxl(largest, fabsl(constraint));
    }
    return isfinite(scale) ? largest / scale : INFINITY;
}

static void prepare_chain(Inputs *in) { prepare(in, 2); }
static void prepare_spherical(Inputs *in) { prepare(in, 3); }
static double error_chain(Inputs *in, int s, const double *a, const double *lambda) {
    return error(in, s, a, lambda, 2);
}
static double error_spherical(Inputs *in, int s, const double *a, const double *lambda) {
    return error(in, s, a, lambda, 3);
}

const System CHAIN = {"chain", prepare_chain, error_chain};
const System SPHERICAL = {"spherical", prepare_spherical, error_spherical};
