/* A spatial four-bar and a Stewart platform, closed by joints of balls. q, v, p and the constraints are as the structs of
 * ours have them. */
#include "loops.h"
#include <math.h>

/* Mass, centre and inertia stand one after another. */
static void add_body(Pose *pose, const Frame *frame, const double *p) {
    Body *body = &pose->body[pose->bodies++];
    *body = (Body){.frame = *frame, .m = p, .inertia = p + 4};
    fixed_point(frame, p + 1, body->centre);
}

static void add_ball(Pose *pose, const Frame *frame, const double *r, const Frame *other, const double *s) {
    Jet here[3], there[3];
    fixed_point(frame, r, here);
    fixed_point(other, s, there);
    for (int k = 0; k < 3; k++) pose->constraint[pose->constraints++] = minus(here[k], there[k]);
}

/* p = p1, p3 | l1, l2, l3, l4 | m1, c1, i1 | m2, c2, i2 | m3, c3, i3 | g, torque; q = a, b[3], c */
static void four_bar_pose(const double *p, const Jet *q, Pose *pose) {
    const double *l = p + 18, *bodies = p + 30;
    Frame crank = ground(), coupler, rocker = ground();
    turn_by(&crank, p);
    turn_about(&crank, 'z', q[0]);
    coupler = crank;
    translate(&coupler, l);
    for (int k = 0; k < 3; k++) turn_about(&coupler, 'z' - k, q[1 + k]);
    translate(&rocker, l + 6);
    turn_by(&rocker, p + 9);
    turn_about(&rocker, 'z', q[4]);
    add_body(pose, &crank, bodies);
    add_body(pose, &coupler, bodies + 13);
    add_body(pose, &rocker, bodies + 26);
    add_ball(pose, &coupler, l + 3, &rocker, l + 9);
}

static Real four_bar_forces(const double *p, Real *force) {
    force[0] = p[70];
    return p[69];
}

/* p = m, c, i of the plate | base[6], anchor[6] | of a cylinder | of a piston | g, push[6];
 * q = r[3], q[4], yaw[6], pitch[6], s[6] */
static void stewart_pose(const double *p, const Jet *q, Pose *pose) {
    static const double TIP[3];
    const double *base = p + 13, *anchor = p + 31, *bodies = p + 49;
    Frame plate = ground();
    move(&plate, q);
    turn_by_quaternion(&plate, q + 3);
    add_body(pose, &plate, p);
    for (int k = 0; k < 6; k++) {
        Jet along[3] = {constant(0), constant(0), q[19 + k]};
        Frame leg = ground();
        translate(&leg, base + 3 * k);
        turn_about(&leg, 'x', q[7 + k]);
        turn_about(&leg, 'y', q[13 + k]);
        add_body(pose, &leg, bodies);
        move(&leg, along);
        add_body(pose, &leg, bodies + 13);
        add_ball(pose, &leg, TIP, &plate, anchor + 3 * k);
    }
    Jet unit = constant(-1);
    for (int k = 3; k < 7; k++) unit = plus(unit, times(q[k], q[k]));
    pose->constraint[pose->constraints++] = unit;
}

static Real stewart_forces(const double *p, Real *force) {
    for (int k = 0; k < 6; k++) force[19 + k] = p[76 + k];
    return p[75];
}

static const Mechanism FOUR_BAR_LOOP = {5, 3, four_bar_pose, four_bar_forces};
static const Mechanism STEWART_LOOPS = {25, 19, stewart_pose, stewart_forces};

static double *random_body(double *p, double m) {
    *p = m * uniform(0.8, 1.2);
    for (int k = 1; k < 4; k++) p[k] = uniform(-0.1, 0.1);
    random_inertia(p + 4, 0.03 * m);
    return p + 13;
}

static void prepare_four_bar(Inputs *in) {
    static const double LENGTHS[4] = {0.3, 0.8, 0.6, 0.7};
    in->coordinates = 5;
    double *p = in->p;
    for (int k = 0; k < 18; k += 9) random_rotation(p + k);
    for (int k = 0; k < 12; k++) p[18 + k] = (k % 3 == 0 ? LENGTHS[k / 3] : 0) + uniform(-0.1, 0.1);
    p += 30;
    for (int k = 0; k < 3; k++) p = random_body(p, 1);
    p[0] = 9.81;
    p[1] = 2;
    for (int s = 0; s < STATES; s++) {
        double *q = q_of(in, s), *v = v_of(in, s);
        do {
            for (int k = 0; k < 5; k++) q[k] = uniform(-1.5, 1.5), v[k] = uniform(-2, 2);
            /* Where pitch is near a right angle, angles are no coordinates. */
        } while (!close_loops(&FOUR_BAR_LOOP, in->p, q, v) || fabs(q[2]) > 1.2);
    }
}

/* Six points around a circle, in pairs. */
static double *hexagon(double *p, double radius, double first) {
    for (int k = 0; k < 6; k++, p += 3) {
        double angle = (k / 2 * 120 + (k % 2 ? 60 - first : first)) * acos(-1) / 180;
        p[0] = radius * cos(angle) + uniform(-0.03, 0.03);
        p[1] = radius * sin(angle) + uniform(-0.03, 0.03);
        p[2] = uniform(-0.03, 0.03);
    }
    return p;
}

static void prepare_stewart(Inputs *in) {
    in->coordinates = 25;
    double *p = hexagon(hexagon(random_body(in->p, 20), 0.6, -25), 0.4, 20);
    p = random_body(random_body(p, 1.5), 1);
    *p++ = 9.81;
    for (int k = 0; k < 6; k++) p[k] = uniform(0, 100);
    for (int s = 0; s < STATES; s++) {
        double *q = q_of(in, s), *v = v_of(in, s);
        do {
            for (int k = 0; k < 25; k++) q[k] = uniform(-0.1, 0.1), v[k] = uniform(-1, 1);
            for (int k = 19; k < 25; k++) q[k] += 0.75;
            q[2] += 0.75;
            q[3] += 1;
        } while (!close_loops(&STEWART_LOOPS, in->p, q, v));
    }
}

/* The largest difference beside the largest number. */
static double part(int count, const double *x, const Real *exact) {
    Real scale = 0, largest = 0;
    for (int k = 0; k < count; k++) {
        scale = fmaxl(scale, fabsl(exact[k]));
        largest = fmaxl(largest, isfinite(x[k]) ? fabsl(x[k] - exact[k]) : INFINITY);
    }
    return largest / scale;
}

static double error(const Mechanism *of, Inputs *in, int s, const double *a, const double *lambda) {
    Real exact[UNKNOWNS];
    int n = of->coordinates;
    solve_loops(of, in->p, q_of(in, s), v_of(in, s), exact);
    /* What a quaternion's own multiplier is, is a matter of what is understood by one of another length. */
    return fmax(part(n, a, exact), part(of->constraints / 3 * 3, lambda, exact + n));
}

static double error_four_bar(Inputs *in, int s, const double *a, const double *lambda) {
    return error(&FOUR_BAR_LOOP, in, s, a, lambda);
}
static double error_stewart(Inputs *in, int s, const double *a, const double *lambda) {
    return error(&STEWART_LOOPS, in, s, a, lambda);
}

const System FOUR_BAR = {"four_bar", prepare_four_bar, error_four_bar};
const System STEWART = {"stewart", prepare_stewart, error_stewart};
