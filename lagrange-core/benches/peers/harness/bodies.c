/* Three bodies under gravity in space: instead of accelerations the forces dL/dq, and the energy as the multiplier.
 * p = m[0..3], the constant of gravitation. The reference is Newton's law in long double. */
#include "systems.h"
#include <math.h>

static void prepare(Inputs *in) {
    in->coordinates = 9;
    for (int k = 0; k < 4; k++) in->p[k] = uniform(0.5, 1.5);
    for (int s = 0; s < STATES; s++)
        for (int k = 0; k < 9; k++) {
            q_of(in, s)[k] = 2 * (k / 3) + uniform(-0.5, 0.5);
            v_of(in, s)[k] = uniform(-2, 2);
        }
}

static double error(Inputs *in, int s, const double *a, const double *lambda) {
    const double *q = q_of(in, s), *v = v_of(in, s), *m = in->p;
    long double force[9] = {0}, kinetic = 0, potential = 0, scale = 0, largest = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            long double square = 0, difference[3];
            for (int k = 0; k < 3; k++) {
                difference[k] = (long double)q[3 * j + k] - q[3 * i + k];
                square += difference[k] * difference[k];
            }
            if (i == j) continue;
            potential -= m[3] * m[i] * m[j] / sqrtl(square) / 2;
            for (int k = 0; k < 3; k++) force[3 * i + k] += m[3] * m[i] * m[j] * difference[k] / (square * sqrtl(square));
        }
    for (int k = 0; k < 9; k++) {
        kinetic += m[k / 3] * (long double)v[k] * v[k] / 2;
        scale = fmaxl(scale, fabsl(force[k]));
        largest = fmaxl(largest, isfinite(a[k]) ? fabsl(a[k] - force[k]) : INFINITY);
    }
    return fmaxl(largest / scale, fabsl(lambda[0] - kinetic - potential) / (kinetic - potential));
}

const System BODIES = {"bodies", prepare, error};
