/* Bodies in space: arms whose joints are placed arbitrarily or by Denavit and Hartenberg's rules, a quadruped and a
 * humanoid. q, v and p are as the structs of ours have them.
 *
 * So that other tools need not convert, they find positions and speeds in their own terms `OWN` after q and the robot
 * right after p, and leave the derivatives of the speeds `OWN` after a. These are checked against Newton's and Euler's
 * equations, and so are the accelerations of ours, converted. */
#include "free_base.h"
#include "systems.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const struct {
    const char *name, *axes;
    int parents[BODIES_AT_MOST];
} TREES[] = {
#define TREE(name, axes, ...) {#name, axes, {__VA_ARGS__}},
#include "trees.h"
#undef TREE
};

void widen(const double *x, int count, Real *result) {
    for (int k = 0; k < count; k++) result[k] = x[k];
}

static void narrow(const Real *x, int count, double *result) {
    for (int k = 0; k < count; k++) result[k] = x[k];
}

static void narrow_rotation(const double *quaternion, double *r) {
    Real wide[4], turn[9];
    widen(quaternion, 4, wide);
    rotation_matrix(wide, turn);
    narrow(turn, 9, r);
}

void random_rotation(double *r) {
    double q[4];
    random_quaternion(q);
    narrow_rotation(q, r);
}

void random_inertia(double *inertia, double size) {
    double r[9], moments[3];
    random_rotation(r);
    for (int k = 0; k < 3; k++) moments[k] = size * uniform(0.6, 1.1);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j <= i; j++) {
            double sum = 0;
            for (int k = 0; k < 3; k++) sum += r[3 * k + i] * moments[k] * r[3 * k + j];
            inertia[3 * i + j] = inertia[3 * j + i] = sum;
        }
}

static void random_link(Link *link, int is_turned) {
    static const double UNTURNED[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    int is_base = link->axis == 'F';
    memcpy(link->place, UNTURNED, sizeof UNTURNED);
    if (is_turned) random_rotation(link->place);
    for (int k = 0; k < 3; k++) {
        link->at[k] = is_base ? 0 : uniform(-0.3, 0.3);
        link->centre[k] = uniform(-0.15, 0.15);
    }
    link->m = is_base ? 10 : uniform(0.5, 4);
    link->tau = is_base ? 0 : uniform(-5, 5);
    random_inertia(link->inertia, is_base ? 0.3 : 0.03);
}

static void build(Robot *robot, const char *system, int n) {
    char name[32];
    snprintf(name, sizeof name, "%s_%d", system, n);
    robot->g = 9.81;
    for (size_t t = 0; t < sizeof TREES / sizeof *TREES; t++) {
        if (strcmp(TREES[t].name, name)) continue;
        robot->count = strlen(TREES[t].axes);
        for (int k = 0; k < robot->count; k++) {
            robot->links[k].axis = TREES[t].axes[k];
            robot->links[k].parent = TREES[t].parents[k];
            random_link(&robot->links[k], !strcmp(system, "arm"));
        }
    }
}

/* alpha, a and d of each joint instead of its place. */
static double *place_by_rules(Robot *robot, double *p) {
    int n = robot->count;
    for (int k = 0; k < n; k++) {
        Link *link = &robot->links[k];
        double alpha = p[k] = uniform(-3, 3), a = p[n + k] = uniform(-0.3, 0.3), d = p[2 * n + k] = uniform(-0.3, 0.3);
        double turn[4] = {cos(alpha / 2), sin(alpha / 2), 0, 0}, at[3] = {a, -d * sin(alpha), d * cos(alpha)};
        narrow_rotation(turn, link->place);
        memcpy(link->at, at, sizeof at);
    }
    return p + 3 * n;
}

static double *put(double *p, const double *from, int count) {
    memcpy(p, from, count * sizeof *p);
    return p + count;
}

/* The fields of ours, one after another: those of all joints or bodies in turn. */
static void fill(Inputs *in, const char *system) {
    Robot *robot = &in->robot;
    Link *links = robot->links, *end = links + robot->count, *first = links + (links->axis == 'F');
    double *p = in->p;
    if (!strcmp(system, "denavit")) p = place_by_rules(robot, p);
    else {
        for (Link *link = links; link < end && !strcmp(system, "arm"); link++) p = put(p, link->place, 9);
        for (Link *link = first; link < end; link++) p = put(p, link->at, 3);
    }
    for (Link *link = links; link < end; link++) p = put(p, link->centre, 3);
    for (Link *link = links; link < end; link++) p = put(p, link->inertia, 9);
    for (Link *link = links; link < end; link++) p = put(p, &link->m, 1);
    p = put(p, &robot->g, 1);
    in->tau = p - in->p;
    for (Link *link = first; link < end; link++) p = put(p, &link->tau, 1);
}

static int is_free(const Robot *robot) { return robot->links[0].axis == 'F'; }

int turning(const Inputs *in) { return is_free(&in->robot) ? in->coordinates - in->robot.count - 2 : 0; }

/* The coordinates before those of the joints. */
static int base(const Inputs *in) { return is_free(&in->robot) ? 3 + turning(in) : 0; }

void own_state(const Inputs *in, const Real *q, const Real *v, Real *own_q, Real *own_v) {
    int free = is_free(&in->robot), first = base(in), joints = in->robot.count - free;
    if (free) own_base(turning(in), q, v, own_q, own_v);
    memcpy(own_q + 7 * free, q + first, joints * sizeof *q);
    memcpy(own_v + 6 * free, v + first, joints * sizeof *v);
}

void own_rate(const Inputs *in, const Real *q, const Real *v, const Real *a, const Real *own_v, Real *own_a) {
    int free = is_free(&in->robot);
    if (free) own_base_rate(turning(in), q, v, a, own_v, own_a);
    memcpy(own_a + 6 * free, a + base(in), (in->robot.count - free) * sizeof *a);
}

static void prepare(Inputs *in, const char *system, int turns) {
    build(&in->robot, system, in->n);
    fill(in, system);
    int free = is_free(&in->robot), first = free ? 3 + turns : 0, joints = in->robot.count - free;
    in->coordinates = first + joints;
    for (int s = 0; s < STATES; s++) {
        double *q = q_of(in, s), *v = v_of(in, s), *own = q + OWN;
        Real wide[2 * UNKNOWNS], own_q[UNKNOWNS], own_v[UNKNOWNS];
        if (free) random_base(turns, q, v);
        for (int k = 0; k < joints; k++) {
            q[first + k] = uniform(free ? -1.5 : -3, free ? 1.5 : 3);
            v[first + k] = uniform(-2, 2);
        }
        widen(q, 2 * in->coordinates, wide);
        own_state(in, wide, wide + in->coordinates, own_q, own_v);
        narrow(own_q, positions(&in->robot), own);
        narrow(own_v, speeds(&in->robot), own + positions(&in->robot));
    }
}

static double error(Inputs *in, int s, const double *a, const double *lambda) {
    (void)lambda;
    int n = in->coordinates, count = speeds(&in->robot), is_own = isnan(a[0]);
    Real state[2 * UNKNOWNS], found[UNKNOWNS], own_q[UNKNOWNS], own_v[UNKNOWNS], own[UNKNOWNS], exact[UNKNOWNS];
    Real scale = 0, largest = 0;
    widen(q_of(in, s), 2 * n, state);
    own_state(in, state, state + n, own_q, own_v);
    newton_euler(&in->robot, own_q, own_v, exact);
    if (is_own) widen(a + OWN, count, own);
    else {
        widen(a, n, found);
        own_rate(in, state, state + n, found, own_v, own);
        if (turning(in) == 4) largest = drift(state + 3, state + n + 3, found + 3);
    }
    for (int k = 0; k < count; k++) {
        scale = fmaxl(scale, fabsl(exact[k]));
        largest = fmaxl(largest, isfinite(own[k]) ? fabsl(own[k] - exact[k]) : INFINITY);
    }
    return largest / scale;
}

static void prepare_arm(Inputs *in) { prepare(in, "arm", 0); }
static void prepare_denavit(Inputs *in) { prepare(in, "denavit", 0); }
static void prepare_quadruped(Inputs *in) { prepare(in, "quadruped", 4); }
static void prepare_quadruped_angles(Inputs *in) { prepare(in, "quadruped", 3); }
static void prepare_humanoid(Inputs *in) { prepare(in, "humanoid", 4); }

const System ARM = {"arm", prepare_arm, error};
const System DENAVIT = {"denavit", prepare_denavit, error};
const System QUADRUPED = {"quadruped", prepare_quadruped, error};
const System QUADRUPED_ANGLES = {"quadruped_angles", prepare_quadruped_angles, error};
const System HUMANOID = {"humanoid", prepare_humanoid, error};
