/* The equations of bodies in loops: the forces that accelerations take do no work in motions that the joints allow
 * but what the forces do that act, and those of the constraints. */
#include "loops.h"
#include <math.h>
#include <string.h>

static void pose_at(const Mechanism *of, const double *p, const double *q, const double *v, Pose *pose) {
    Jet jets[MOST_COORDINATES];
    for (int k = 0; k < of->coordinates; k++) jets[k] = (Jet){q[k], v[k], 0};
    pose->bodies = pose->constraints = 0;
    of->pose(p, jets, pose);
}

/* What moves where coordinate k alone does, at the rate 1. */
static void poses_by_rates(const Mechanism *of, const double *p, const double *q, Pose *poses) {
    for (int k = 0; k < of->coordinates; k++) {
        double unit[MOST_COORDINATES] = {0};
        unit[k] = 1;
        pose_at(of, p, q, unit, &poses[k]);
    }
}

/* The vector of R' R^T, or of R'' R^T: an angular velocity; an angular acceleration. */
static void spin(const Body *body, int second, Real *result) {
    const Jet *turn = body->frame.turn;
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        result[k] = 0;
        for (int e = 0; e < 9; e += 3) {
            Real up = second ? turn[e + j].a : turn[e + j].v, down = second ? turn[e + i].a : turn[e + i].v;
            result[k] += (up * turn[e + i].x - down * turn[e + j].x) / 2;
        }
    }
}

/* I omega along the fixed axes. */
static void angular_momentum(const Body *body, const Real *omega, Real *result) {
    const Jet *turn = body->frame.turn;
    Real own[3] = {0};
    memset(result, 0, 3 * sizeof *result);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) own[i] += body->inertia[3 * i + j] * turn[3 * j + k].x * omega[k];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) result[k] += turn[3 * i + k].x * own[i];
}

/* The force and the torque that such accelerations of a body take: m a and I alpha + omega x I omega. */
static void load(const Body *body, const Real *a, const Real *alpha, const Real *omega, Real *result) {
    Real momentum[3];
    angular_momentum(body, alpha, result + 3);
    angular_momentum(body, omega, momentum);
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        result[k] = *body->m * a[k];
        result[3 + k] += omega[i] * momentum[j] - omega[j] * momentum[i];
    }
}

/* Of a load in a motion. */
static Real power(const Body *motion, const Real *load) {
    Real omega[3], sum = 0;
    spin(motion, 0, omega);
    for (int k = 0; k < 3; k++) sum += motion->centre[k].v * load[k] + omega[k] * load[3 + k];
    return sum;
}

void solve_loops(const Mechanism *of, const double *p, const double *q, const double *v, Real *result) {
    static Pose by[MOST_COORDINATES], along;
    static Real m[UNKNOWNS][UNKNOWNS + 1];
    static const Real STILL[3];
    int n = of->coordinates, count = n + of->constraints;
    Real force[MOST_COORDINATES] = {0}, g = of->forces(p, force);
    poses_by_rates(of, p, q, by);
    pose_at(of, p, q, v, &along);
    for (int i = 0; i < count; i++)
        for (int j = 0; j <= count; j++) m[i][j] = 0;
    for (int i = 0; i < n; i++) m[i][count] = force[i];
    for (int b = 0; b < along.bodies; b++) {
        Real bias[6], unit[6], omega[3], alpha[3], a[3];
        spin(&along.body[b], 0, omega);
        spin(&along.body[b], 1, alpha);
        for (int k = 0; k < 3; k++) a[k] = along.body[b].centre[k].a + (k == 2 ? g : 0);
        load(&along.body[b], a, alpha, omega, bias);
        for (int j = 0; j < n; j++) {
            spin(&by[j].body[b], 0, alpha);
            for (int k = 0; k < 3; k++) a[k] = by[j].body[b].centre[k].v;
            load(&along.body[b], a, alpha, STILL, unit);
            for (int i = 0; i < n; i++) m[i][j] += power(&by[i].body[b], unit);
            m[j][count] -= power(&by[j].body[b], bias);
        }
    }
    for (int c = n; c < count; c++) {
        for (int j = 0; j < n; j++) m[c][j] = by[j].constraint[c - n].v, m[j][c] = -m[c][j];
        m[c][count] = -along.constraint[c - n].a;
    }
    eliminate(count, m, result);
}

/* x -= F^T (F F^T)^-1 r; the largest change. */
static Real project(const Mechanism *of, const Pose *by, const Real *r, double *x) {
    static Real m[UNKNOWNS][UNKNOWNS + 1];
    Real multipliers[UNKNOWNS], largest = 0;
    int count = of->constraints;
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < count; j++) {
            m[i][j] = 0;
            for (int k = 0; k < of->coordinates; k++) m[i][j] += by[k].constraint[i].v * by[k].constraint[j].v;
        }
        m[i][count] = r[i];
    }
    eliminate(count, m, multipliers);
    for (int k = 0; k < of->coordinates; k++) {
        Real change = 0;
        for (int i = 0; i < count; i++) change += by[k].constraint[i].v * multipliers[i];
        x[k] -= change;
        largest = fmaxl(largest, isfinite(change) ? fabsl(change) : INFINITY);
    }
    return largest;
}

int close_loops(const Mechanism *of, const double *p, double *q, double *v) {
    static Pose by[MOST_COORDINATES], along;
    Real residual[MOST_CONSTRAINTS], change = 0;
    for (int step = 0; step < 30; step++) {
        poses_by_rates(of, p, q, by);
        pose_at(of, p, q, v, &along);
        for (int c = 0; c < of->constraints; c++) residual[c] = along.constraint[c].x;
        change = project(of, by, residual, q);
    }
    poses_by_rates(of, p, q, by);
    pose_at(of, p, q, v, &along);
    for (int c = 0; c < of->constraints; c++) residual[c] = along.constraint[c].v;
    Real slowed = project(of, by, residual, v);
    return change < 1e-14 && slowed < 10;
}
