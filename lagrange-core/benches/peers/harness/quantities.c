/* What else is asked of an arm than its accelerations: the forces at the joints that accelerations take, the mass matrix, the
 * Jacobian of a point of the last link (p: after the fields of the arm), and the derivatives of the accelerations by angles,
 * their rates and the forces at the joints. Matrices by columns, one after another in a; symmetric ones may leave out what
 * is below the diagonal. The references are Newton's and Euler's equations from link to link, differences of the eighth
 * order, and poses with their derivatives, all in long double. */
#include "jets.h"
#include "systems.h"
#include <math.h>
#include <string.h>

enum { JOINTS = 6, POINT = JOINTS * 25 + 7 };
typedef long double Columns[JOINTS][JOINTS];

static double *accelerations_of(Inputs *in, int s) { return q_of(in, s) + 2 * JOINTS; }

/* The arm of the accelerations. Angles are such that the steps of differences add nothing to their digits. */
static void prepare(Inputs *in) {
    ARM.prepare(in);
    for (int k = 0; k < 3; k++) in->p[POINT + k] = uniform(-0.3, 0.3);
    for (int s = 0; s < STATES; s++) {
        double *q = q_of(in, s), *own = q + OWN;
        for (int k = 0; k < 2 * JOINTS; k++) q[k] = ldexp(rint(ldexp(q[k], 36)), -36);
        for (int k = 0; k < JOINTS; k++) accelerations_of(in, s)[k] = uniform(-5, 5);
        memcpy(own, q, 3 * JOINTS * sizeof *q);
    }
}

/* Without forces of its own. */
static void prepare_inverse(Inputs *in) {
    prepare(in);
    for (int k = 0; k < JOINTS; k++) in->p[POINT - JOINTS + k] = in->robot.links[k].tau = 0;
}

/* The largest difference beside the largest number, in the columns or above their diagonals. */
static double part(int rows, int columns, const double *x, const long double *exact, int upper) {
    long double scale = 0, largest = 0;
    for (int j = 0; j < columns; j++)
        for (int i = 0; i < (upper ? j + 1 : rows); i++) {
            int k = j * rows + i;
            scale = fmaxl(scale, fabsl(exact[k]));
            largest = fmaxl(largest, isfinite(x[k]) ? fabsl(x[k] - exact[k]) : INFINITY);
        }
    return largest / scale;
}

static double error_inverse(Inputs *in, int s, const double *a, const double *lambda) {
    (void)lambda;
    long double exact[JOINTS], wanted[JOINTS];
    for (int k = 0; k < JOINTS; k++) wanted[k] = accelerations_of(in, s)[k];
    joint_forces(&in->robot, q_of(in, s), v_of(in, s), wanted, in->robot.g, exact);
    return part(JOINTS, 1, a, exact, 0);
}

static double error_mass(Inputs *in, int s, const double *a, const double *lambda) {
    (void)lambda;
    static const double REST[JOINTS];
    Columns exact;
    for (int k = 0; k < JOINTS; k++) {
        long double unit[JOINTS] = {0};
        unit[k] = 1;
        joint_forces(&in->robot, q_of(in, s), REST, unit, 0, exact[k]);
    }
    return part(JOINTS, JOINTS, a, exact[0], 1);
}

static double error_jacobian(Inputs *in, int s, const double *a, const double *lambda) {
    (void)lambda;
    long double exact[JOINTS][3];
    for (int k = 0; k < JOINTS; k++) {
        Frame frame = ground();
        Jet at[3];
        for (int j = 0; j < JOINTS; j++) {
            const Link *link = &in->robot.links[j];
            translate(&frame, link->at);
            turn_by(&frame, link->place);
            turn_about(&frame, link->axis, (Jet){q_of(in, s)[j], j == k, 0});
        }
        fixed_point(&frame, in->p + POINT, at);
        for (int e = 0; e < 3; e++) exact[k][e] = at[e].v;
    }
    return part(3, JOINTS, a, exact[0], 0);
}

/* By the number at x, which is put back. */
static void difference(const Inputs *in, const double *q, double *x, double step, long double *column) {
    static const long double WEIGHTS[4] = {4 / 5.0L, -1 / 5.0L, 4 / 105.0L, -1 / 280.0L};
    long double up[JOINTS], down[JOINTS];
    double start = *x;
    memset(column, 0, JOINTS * sizeof *column);
    for (int k = 0; k < 4; k++) {
        *x = start + (k + 1) * step;
        newton_euler(&in->robot, q, q + JOINTS, up);
        *x = start - (k + 1) * step;
        newton_euler(&in->robot, q, q + JOINTS, down);
        for (int i = 0; i < JOINTS; i++) column[i] += WEIGHTS[k] * (up[i] - down[i]) / step;
    }
    *x = start;
}

static double error_derivatives(Inputs *in, int s, const double *a, const double *lambda) {
    (void)lambda;
    const double step = ldexp(1, -9);
    double q[2 * JOINTS], largest = 0;
    Columns exact[3];
    memcpy(q, q_of(in, s), sizeof q);
    for (int k = 0; k < JOINTS; k++) {
        difference(in, q, q + k, step, exact[0][k]);
        difference(in, q, q + JOINTS + k, step, exact[1][k]);
        /* They are linear in it. */
        difference(in, q, &in->robot.links[k].tau, 1, exact[2][k]);
    }
    for (int b = 0; b < 3; b++)
        largest = fmax(largest, part(JOINTS, JOINTS, a + b * JOINTS * JOINTS, exact[b][0], b == 2));
    return largest;
}

const System ARM_INVERSE = {"arm_inverse", prepare_inverse, error_inverse};
const System ARM_MASS = {"arm_mass", prepare, error_mass};
const System ARM_JACOBIAN = {"arm_jacobian", prepare, error_jacobian};
const System ARM_DERIVATIVES = {"arm_derivatives", prepare, error_derivatives};
