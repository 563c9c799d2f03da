/* What else is asked of bodies in space than their accelerations: the forces at the joints that accelerations take, the
 * mass matrix, the derivatives of the accelerations by coordinates, their rates and the forces at the joints, and the
 * Jacobian of a point of an arm's last link (p: after the fields of the arm). Matrices by columns, one after another in a;
 * symmetric ones may leave out what is below the diagonal. After the derivatives ours leaves the accelerations.
 *
 * Other tools find accelerations in their terms after their speeds, and leave derivatives by displacements and speeds
 * along the axes of the base. All are checked along displacements that the coordinates allow, by Newton's and Euler's
 * equations from link to link, and by differences of the eighth order; the Jacobian by poses with their derivatives. */
#include "jets.h"
#include "systems.h"
#include <math.h>
#include <string.h>

static int joints(const Inputs *in) { return in->robot.count - (in->robot.links[0].axis == 'F'); }

/* A state in both terms. */
typedef struct {
    Real q[UNKNOWNS], v[UNKNOWNS], own_q[UNKNOWNS], own_v[UNKNOWNS];
} State;

static State state_at(Inputs *in, int s) {
    State state;
    widen(q_of(in, s), in->coordinates, state.q);
    widen(v_of(in, s), in->coordinates, state.v);
    own_state(in, state.q, state.v, state.own_q, state.own_v);
    return state;
}

static Real dot(int n, const Real *x, const Real *y) {
    Real sum = 0;
    for (int k = 0; k < n; k++) sum += x[k] * y[k];
    return sum;
}

/* Makes q · x + y · z zero where there is a quaternion, by a change of x along it: so that it keeps its length. */
static void keep_length(const Inputs *in, const Real *q, Real *x, const Real *y, const Real *z) {
    if (turning(in) != 4) return;
    Real excess = dot(4, q + 3, x + 3) + dot(4, y + 3, z + 3);
    for (int k = 3; k < 7; k++) x[k] -= excess * q[k];
}

/* The direction of a coordinate, as far as a quaternion allows it. */
static void along(const Inputs *in, const Real *q, int k, Real *direction) {
    static const Real NONE[UNKNOWNS];
    memset(direction, 0, UNKNOWNS * sizeof *direction);
    direction[k] = 1;
    keep_length(in, q, direction, NONE, NONE);
}

/* The speeds of others that rates of the coordinates are. */
static void own_speeds(const Inputs *in, const Real *q, const Real *v, Real *own_v) {
    Real own_q[UNKNOWNS];
    own_state(in, q, v, own_q, own_v);
}

/* Accelerations that keep the length of a quaternion stand after the rates, in the terms of others after their speeds. */
static void prepare(Inputs *in, const System *of) {
    of->prepare(in);
    int n = in->coordinates, count = speeds(&in->robot);
    for (int s = 0; s < STATES; s++) {
        double *a = v_of(in, s) + n, *own_a = q_of(in, s) + OWN + positions(&in->robot) + count;
        Real wide[UNKNOWNS], own[UNKNOWNS];
        State state = state_at(in, s);
        for (int k = 0; k < n; k++) wide[k] = uniform(-5, 5);
        keep_length(in, state.q, wide, state.v, state.v);
        own_rate(in, state.q, state.v, wide, state.own_v, own);
        for (int k = 0; k < n; k++) a[k] = wide[k];
        for (int k = 0; k < count; k++) own_a[k] = own[k];
    }
}

/* Without forces of its own. */
static void prepare_inverse(Inputs *in, const System *of) {
    prepare(in, of);
    for (int k = 0; k < joints(in); k++) in->p[in->tau + k] = 0;
    for (int k = 0; k < in->robot.count; k++) in->robot.links[k].tau = 0;
}

typedef struct {
    Real scale, largest;
} Difference;

static void compare(Difference *difference, Real x, Real exact) {
    difference->scale = fmaxl(difference->scale, fabsl(exact));
    difference->largest = fmaxl(difference->largest, isfinite(x) ? fabsl(x - exact) : INFINITY);
}

static double share(Difference difference) { return difference.largest / difference.scale; }

/* Forces do the same work along all directions in whatever terms. */
static double error_inverse(Inputs *in, int s, const double *a, const double *lambda) {
    (void)lambda;
    int n = in->coordinates, count = speeds(&in->robot);
    Real wanted[UNKNOWNS], own_a[UNKNOWNS], exact[UNKNOWNS], found[UNKNOWNS], direction[UNKNOWNS], own[UNKNOWNS];
    Difference difference = {0};
    State state = state_at(in, s);
    widen(v_of(in, s) + n, n, wanted);
    own_rate(in, state.q, state.v, wanted, state.own_v, own_a);
    joint_forces(&in->robot, state.own_q, state.own_v, own_a, in->robot.g, exact);
    if (isnan(a[0])) {
        for (int k = 0; k < count; k++) compare(&difference, a[OWN + k], exact[k]);
        return share(difference);
    }
    widen(a, n, found);
    for (int k = 0; k < n; k++) {
        along(in, state.q, k, direction);
        own_speeds(in, state.q, direction, own);
        compare(&difference, dot(n, direction, found), dot(count, own, exact));
    }
    return share(difference);
}

/* y = M x, of columns. */
static void times_columns(int n, const double *m, const Real *x, Real *y) {
    memset(y, 0, n * sizeof *y);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) y[i] += m[j * n + i] * x[j];
}

/* Two rates have the same product in whatever terms. */
static double error_mass(Inputs *in, int s, const double *a, const double *lambda) {
    (void)lambda;
    static Real m[UNKNOWNS][UNKNOWNS + 1], directions[UNKNOWNS][UNKNOWNS], own[UNKNOWNS][UNKNOWNS];
    int n = in->coordinates, count = speeds(&in->robot);
    Difference difference = {0};
    State state = state_at(in, s);
    joint_mass(&in->robot, state.own_q, m);
    if (isnan(a[0])) {
        for (int j = 0; j < count; j++)
            for (int i = 0; i <= j; i++) compare(&difference, a[OWN + j * count + i], m[i][j]);
        return share(difference);
    }
    for (int k = 0; k < n; k++) {
        along(in, state.q, k, directions[k]);
        own_speeds(in, state.q, directions[k], own[k]);
    }
    for (int k = 0; k < n; k++) {
        Real found[UNKNOWNS], exact[UNKNOWNS];
        times_columns(n, a, directions[k], found);
        for (int i = 0; i < count; i++) exact[i] = dot(count, m[i], own[k]);
        for (int i = 0; i < n; i++) compare(&difference, dot(n, directions[i], found), dot(count, own[i], exact));
    }
    return share(difference);
}

/* Accelerations that an implementation predicts where the state changes along a direction, in the terms of others. */
typedef struct {
    Inputs *in;
    State start;
    Real dq[UNKNOWNS], dv[UNKNOWNS], a[UNKNOWNS], da[UNKNOWNS];
    int is_own;
} Path;

static State on(const Path *path, Real s) {
    State state;
    int n = path->in->coordinates;
    for (int k = 0; k < n; k++) {
        state.q[k] = path->start.q[k] + s * path->dq[k];
        state.v[k] = path->start.v[k] + s * path->dv[k];
    }
    if (turning(path->in) == 4) {
        Real length = sqrtl(dot(4, state.q + 3, state.q + 3));
        for (int k = 3; k < 7; k++) state.q[k] /= length;
    }
    own_state(path->in, state.q, state.v, state.own_q, state.own_v);
    return state;
}

static void speeds_on(const Path *path, Real s, Real *result) {
    State state = on(path, s);
    memcpy(result, state.own_v, sizeof state.own_v);
}

/* The forces that the predicted accelerations take. */
static void forces_on(const Path *path, Real s, Real *result) {
    Real predicted[UNKNOWNS], own[UNKNOWNS];
    State state = on(path, s);
    for (int k = 0; k < path->in->coordinates; k++) predicted[k] = path->a[k] + s * path->da[k];
    if (!path->is_own) own_rate(path->in, state.q, state.v, predicted, state.own_v, own);
    joint_forces(&path->in->robot, state.own_q, state.own_v, path->is_own ? predicted : own, path->in->robot.g, result);
}

/* At the start of the path. */
static void differentiate(const Path *path, void (*of)(const Path *, Real, Real *), Real *result) {
    static const Real WEIGHTS[4] = {4 / 5.0L, -1 / 5.0L, 4 / 105.0L, -1 / 280.0L};
    const Real step = ldexpl(1, -9);
    Real up[UNKNOWNS], down[UNKNOWNS];
    int count = speeds(&path->in->robot);
    memset(result, 0, UNKNOWNS * sizeof *result);
    for (int k = 0; k < 4; k++) {
        of(path, (k + 1) * step, up);
        of(path, -(k + 1) * step, down);
        for (int i = 0; i < count; i++) result[i] += WEIGHTS[k] * (up[i] - down[i]) / step;
    }
}

/* Adds to the difference the accelerations that these forces at the joints, which should not be there, stand for. */
static void add_excess(const Inputs *in, const Real mass[][UNKNOWNS + 1], const Real *forces, const Real *found,
                       Difference *difference) {
    static Real m[UNKNOWNS][UNKNOWNS + 1];
    Real excess[UNKNOWNS];
    int count = speeds(&in->robot);
    memcpy(m, mass, sizeof m);
    for (int i = 0; i < count; i++) m[i][count] = forces[i];
    eliminate(count, m, excess);
    for (int i = 0; i < count; i++) compare(difference, found[i], found[i] - excess[i]);
}

/* The change of accelerations along the path by the matrices of an implementation. */
static void predict(Path *path, const double *a) {
    Inputs *in = path->in;
    int n = path->is_own ? speeds(&in->robot) : in->coordinates;
    Real displacement[UNKNOWNS], rate[UNKNOWNS], by_rate[UNKNOWNS];
    memcpy(displacement, path->dq, sizeof displacement);
    memcpy(rate, path->dv, sizeof rate);
    if (path->is_own) {
        own_speeds(in, path->start.q, path->dq, displacement);
        differentiate(path, speeds_on, rate);
    }
    times_columns(n, a, displacement, path->da);
    times_columns(n, a + n * n, rate, by_rate);
    for (int k = 0; k < n; k++) path->da[k] += by_rate[k];
}

static Difference along_all(Path *path, const double *a, const Real mass[][UNKNOWNS + 1], int by_rates) {
    Difference difference = {0};
    Real forces[UNKNOWNS], found[UNKNOWNS], start[UNKNOWNS] = {0};
    Inputs *in = path->in;
    for (int k = 0; k < in->coordinates; k++) {
        memset(path->dq, 0, sizeof path->dq);
        along(in, path->start.q, k, by_rates ? path->dv : path->dq);
        if (!by_rates) {
            memset(path->dv, 0, sizeof path->dv);
            keep_length(in, path->start.q, path->dv, path->dq, path->start.v);
        }
        predict(path, a);
        differentiate(path, forces_on, forces);
        memcpy(found, path->da, sizeof found);
        if (!path->is_own) own_rate(in, path->start.q, start, path->da, start, found);
        add_excess(in, mass, forces, found, &difference);
    }
    return difference;
}

/* The accelerations by the force at each joint; they are linear in it. */
static Difference by_forces(const Path *path, const double *columns, const Real mass[][UNKNOWNS + 1]) {
    Difference difference = {0};
    Inputs *in = path->in;
    int n = in->coordinates, count = speeds(&in->robot), first = count - joints(in);
    for (int k = 0; k < joints(in); k++) {
        Real column[UNKNOWNS], own[UNKNOWNS], forces[UNKNOWNS];
        if (path->is_own)
            for (int i = 0; i < count; i++) own[i] = i > first + k ? columns[(i - first) * count + first + k] : columns[k * count + i];
        else {
            widen(columns + k * n, n, column);
            own_speeds(in, path->start.q, column, own);
        }
        for (int i = 0; i < count; i++) forces[i] = dot(count, mass[i], own) - (i == first + k);
        add_excess(in, mass, forces, own, &difference);
    }
    return difference;
}

static double error_derivatives(Inputs *in, int s, const double *a, const double *lambda) {
    (void)lambda;
    static Real mass[UNKNOWNS][UNKNOWNS + 1];
    static Path path;
    path.in = in, path.start = state_at(in, s), path.is_own = isnan(a[0]);
    if (path.is_own) newton_euler(&in->robot, path.start.own_q, path.start.own_v, path.a), a += OWN;
    int n = path.is_own ? speeds(&in->robot) : in->coordinates;
    const double *columns = a + 2 * n * n;
    if (!path.is_own) widen(columns + joints(in) * n, n, path.a);
    joint_mass(&in->robot, path.start.own_q, mass);
    double by_state = fmax(share(along_all(&path, a, mass, 0)), share(along_all(&path, a, mass, 1)));
    return fmax(by_state, share(by_forces(&path, columns, mass)));
}

/* After the parameters of the arm. */
static double *point_of(Inputs *in) { return in->p + in->tau + joints(in); }

static void prepare_jacobian(Inputs *in) {
    ARM.prepare(in);
    for (int k = 0; k < 3; k++) point_of(in)[k] = uniform(-0.3, 0.3);
}

static double error_jacobian(Inputs *in, int s, const double *a, const double *lambda) {
    (void)lambda;
    Difference difference = {0};
    if (isnan(a[0])) a += OWN;
    for (int k = 0; k < in->robot.count; k++) {
        Frame frame = ground();
        Jet at[3];
        for (int j = 0; j < in->robot.count; j++) {
            const Link *link = &in->robot.links[j];
            translate(&frame, link->at);
            turn_by(&frame, link->place);
            turn_about(&frame, link->axis, (Jet){q_of(in, s)[j], j == k, 0});
        }
        fixed_point(&frame, point_of(in), at);
        for (int e = 0; e < 3; e++) compare(&difference, a[3 * k + e], at[e].v);
    }
    return share(difference);
}

const System ARM_JACOBIAN = {"arm_jacobian", prepare_jacobian, error_jacobian};

#define QUANTITIES(SYSTEM, name)                                                                                        \
    static void prepare_##name(Inputs *in) { prepare(in, &SYSTEM); }                                                    \
    static void prepare_##name##_inverse(Inputs *in) { prepare_inverse(in, &SYSTEM); }                                  \
    const System SYSTEM##_INVERSE = {#name "_inverse", prepare_##name##_inverse, error_inverse};                        \
    const System SYSTEM##_MASS = {#name "_mass", prepare_##name, error_mass};                                           \
    const System SYSTEM##_DERIVATIVES = {#name "_derivatives", prepare_##name, error_derivatives};

QUANTITIES(ARM, arm)
QUANTITIES(QUADRUPED, quadruped)
QUANTITIES(HUMANOID, humanoid)
