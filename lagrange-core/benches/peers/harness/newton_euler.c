/* Accelerations of bodies in space, by the dense system of equations: Newton's and Euler's equations from link to link
 * give the forces that accelerations take, one acceleration at a time a column of the matrix (Featherstone, Rigid Body
 * Dynamics Algorithms, chapters 5 and 6). All in long double. */
#include "robots.h"
#include "systems.h"
#include <math.h>
#include <string.h>

typedef struct {
    Real turn[9], rate[3], angular[3], linear[3], force[3], torque[3];
} Motion;

/* x += factor * a × b */
static void add_cross(Real *x, Real factor, const Real *a, const Real *b) {
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        x[k] += factor * (a[i] * b[j] - a[j] * b[i]);
    }
}

/* x += R y, or its transpose; R by columns. */
static void add_turned(Real *x, const Real *turn, const Real *y, int back) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) x[i] += turn[back ? 3 * i + j : 3 * j + i] * y[j];
}

/* x += omega × (omega × r) + alpha × r */
static void add_carried(Real *x, const Motion *motion, const Real *r) {
    Real along[3] = {0};
    add_cross(along, 1, motion->rate, r);
    add_cross(x, 1, motion->rate, along);
    add_cross(x, 1, motion->angular, r);
}

static void quaternion_matrix(const Real *q, Real *turn) {
    Real x = q[0], y = q[1], z = q[2], w = q[3];
    Real columns[9] = {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y),
                       2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x),
                       2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)};
    memcpy(turn, columns, sizeof columns);
}

static void joint_matrix(const Link *link, Real angle, Real *turn) {
    Real about[9] = {0}, place[9];
    int k = link->axis - 'x', i = (k + 1) % 3, j = (k + 2) % 3;
    about[4 * k] = 1;
    about[4 * i] = about[4 * j] = cosl(angle);
    about[3 * i + j] = sinl(angle);
    about[3 * j + i] = -sinl(angle);
    for (int e = 0; e < 9; e++) place[e] = link->place[e], turn[e] = 0;
    for (int column = 0; column < 3; column++) add_turned(turn + 3 * column, place, about + 3 * column, 0);
}

static void copy(Real *to, const double *from) {
    for (int k = 0; k < 3; k++) to[k] = from[k];
}

/* How the base moves: its acceleration is that of the derivatives of its speeds, which are in turning axes. */
static void move_base(Motion *motion, const Real *q, const Real *v, const Real *a, Real g) {
    Real up[3] = {0, 0, g};
    quaternion_matrix(q + 3, motion->turn);
    memcpy(motion->rate, v + 3, sizeof motion->rate);
    memcpy(motion->linear, a, sizeof motion->linear);
    memcpy(motion->angular, a + 3, sizeof motion->angular);
    add_cross(motion->linear, 1, motion->rate, v);
    add_turned(motion->linear, motion->turn, up, 1);
}

static void move_joint(Motion *motion, const Motion *before, const Link *link, Real q, Real v, Real a) {
    Real at[3], start[3], spin[3] = {0};
    joint_matrix(link, q, motion->turn);
    copy(at, link->at);
    memcpy(start, before->linear, sizeof start);
    add_carried(start, before, at);
    add_turned(motion->linear, motion->turn, start, 1);
    add_turned(motion->rate, motion->turn, before->rate, 1);
    add_turned(motion->angular, motion->turn, before->angular, 1);
    spin[link->axis - 'x'] = v;
    add_cross(motion->angular, 1, motion->rate, spin);
    motion->rate[link->axis - 'x'] += v;
    motion->angular[link->axis - 'x'] += a;
}

/* What moves the body so. */
static void load(Motion *motion, const Link *link) {
    Real centre[3], inertia[9], acceleration[3], spin[3] = {0}, force[3];
    copy(centre, link->centre);
    for (int e = 0; e < 9; e++) inertia[e] = link->inertia[e];
    memcpy(acceleration, motion->linear, sizeof acceleration);
    add_carried(acceleration, motion, centre);
    for (int k = 0; k < 3; k++) motion->force[k] += force[k] = link->m * acceleration[k];
    add_cross(motion->torque, 1, centre, force);
    add_turned(motion->torque, inertia, motion->angular, 0);
    add_turned(spin, inertia, motion->rate, 0);
    add_cross(motion->torque, 1, motion->rate, spin);
}

void joint_forces(const Robot *robot, const Real *q, const Real *v, const Real *a, Real g, Real *result) {
    static Motion motions[BODIES_AT_MOST + 1];
    memset(motions, 0, sizeof motions);
    /* The ground is the last of all; it accelerates upwards instead of weight. */
    motions[BODIES_AT_MOST].linear[2] = g;
    int free = robot->links[0].axis == 'F';
    for (int k = 0; k < robot->count; k++) {
        const Link *link = &robot->links[k];
        const Motion *before = &motions[link->parent < 0 ? BODIES_AT_MOST : link->parent];
        if (link->axis == 'F') move_base(&motions[k], q, v, a, g);
        else move_joint(&motions[k], before, link, q[k + 6 * free], v[k + 5 * free], a[k + 5 * free]);
    }
    for (int k = robot->count - 1; k >= 0; k--) {
        const Link *link = &robot->links[k];
        Motion *motion = &motions[k], *before = &motions[link->parent < 0 ? BODIES_AT_MOST : link->parent];
        load(motion, link);
        if (link->axis == 'F') {
            memcpy(result, motion->force, sizeof motion->force);
            memcpy(result + 3, motion->torque, sizeof motion->torque);
            continue;
        }
        Real force[3] = {0}, at[3];
        copy(at, link->at);
        result[k + 5 * free] = motion->torque[link->axis - 'x'];
        add_turned(force, motion->turn, motion->force, 0);
        add_turned(before->torque, motion->turn, motion->torque, 0);
        add_cross(before->torque, 1, at, force);
        for (int e = 0; e < 3; e++) before->force[e] += force[e];
    }
}

int positions(const Robot *robot) { return robot->count + 6 * (robot->links[0].axis == 'F'); }
int speeds(const Robot *robot) { return robot->count + 5 * (robot->links[0].axis == 'F'); }

void joint_mass(const Robot *robot, const Real *q, Real m[][UNKNOWNS + 1]) {
    static const Real REST[SPEEDS_AT_MOST];
    Real unit[SPEEDS_AT_MOST] = {0}, column[SPEEDS_AT_MOST];
    int n = speeds(robot);
    for (int k = 0; k < n; k++) {
        unit[k] = 1;
        joint_forces(robot, q, REST, unit, 0, column);
        for (int i = 0; i < n; i++) m[i][k] = column[i];
        unit[k] = 0;
    }
}

void newton_euler(const Robot *robot, const Real *q, const Real *v, Real *a) {
    static Real m[UNKNOWNS][UNKNOWNS + 1];
    Real rest[SPEEDS_AT_MOST] = {0}, column[SPEEDS_AT_MOST];
    int n = speeds(robot), more = n - robot->count;
    joint_mass(robot, q, m);
    joint_forces(robot, q, v, rest, robot->g, column);
    for (int i = 0; i < n; i++) m[i][n] = (i < more ? 0 : robot->links[i - more].tau) - column[i];
    eliminate(n, m, a);
}
