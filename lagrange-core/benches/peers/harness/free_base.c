/* A free base: ours states it by its position and a quaternion (w, x, y, z), or three angles about z, y and x one after
 * another, and their rates; other tools take a quaternion (x, y, z, w) and velocities along the axes of the base. */
#include "free_base.h"
#include "systems.h"
#include <math.h>
#include <string.h>

void random_quaternion(double *q) {
    double norm = 0;
    for (int k = 0; k < 4; k++) q[k] = uniform(-1, 1), norm += q[k] * q[k];
    for (int k = 0; k < 4; k++) q[k] /= sqrt(norm);
}

void rotation_matrix(const Real *q, Real *r) {
    Real w = q[0], x = q[1], y = q[2], z = q[3];
    Real columns[9] = {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y),
                         2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x),
                         2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)};
    memcpy(r, columns, sizeof columns);
}

/* The angular velocity of a base in its own axes, from its orientation and the rate of that. */
static void angular_velocity(int turns, const Real *q, const Real *v, Real *omega) {
    if (turns == 4) {
        for (int k = 1; k < 4; k++) {
            int i = k % 3 + 1, j = i % 3 + 1;
            omega[k - 1] = 2 * (q[0] * v[k] - q[k] * v[0] - q[i] * v[j] + q[j] * v[i]);
        }
        return;
    }
    omega[0] = v[2] - sinl(q[1]) * v[0];
    omega[1] = cosl(q[2]) * v[1] + sinl(q[2]) * cosl(q[1]) * v[0];
    omega[2] = cosl(q[2]) * cosl(q[1]) * v[0] - sinl(q[2]) * v[1];
}

/* Its derivative; it is linear in the rates, and the product of the rates of a quaternion has no vector part. */
static void angular_acceleration(int turns, const Real *q, const Real *v, const Real *a, Real *alpha) {
    angular_velocity(turns, q, a, alpha);
    if (turns == 4) return;
    alpha[0] -= cosl(q[1]) * v[1] * v[0];
    alpha[1] += cosl(q[2]) * v[2] * cosl(q[1]) * v[0] - sinl(q[2]) * (v[2] * v[1] + sinl(q[1]) * v[1] * v[0]);
    alpha[2] -= sinl(q[2]) * v[2] * cosl(q[1]) * v[0] + cosl(q[2]) * (v[2] * v[1] + sinl(q[1]) * v[1] * v[0]);
}

/* The quaternion (w, x, y, z) of a base. */
static void orientation(int turns, const Real *q, Real *turn) {
    static const int AXES[3] = {3, 2, 1};
    if (turns == 4) {
        memcpy(turn, q, 4 * sizeof *q);
        return;
    }
    Real product[4] = {1, 0, 0, 0};
    for (int angle = 0; angle < 3; angle++) {
        int k = AXES[angle], i = k % 3 + 1, j = i % 3 + 1;
        Real c = cosl(q[angle] / 2), s = sinl(q[angle] / 2), p[4];
        memcpy(p, product, sizeof p);
        product[0] = c * p[0] - s * p[k];
        product[k] = c * p[k] + s * p[0];
        product[i] = c * p[i] + s * p[j];
        product[j] = c * p[j] - s * p[i];
    }
    memcpy(turn, product, sizeof product);
}

/* x = R^T y */
static void turned_back(const Real *turn, const Real *y, Real *x) {
    Real r[9];
    rotation_matrix(turn, r);
    for (int i = 0; i < 3; i++) x[i] = r[3 * i] * y[0] + r[3 * i + 1] * y[1] + r[3 * i + 2] * y[2];
}

void own_base(int turns, const Real *q, const Real *v, Real *own_q, Real *own_v) {
    Real turn[4];
    orientation(turns, q + 3, turn);
    memcpy(own_q, q, 3 * sizeof *q);
    for (int k = 0; k < 4; k++) own_q[3 + k] = turn[(k + 1) % 4];
    turned_back(turn, v, own_v);
    angular_velocity(turns, q + 3, v + 3, own_v + 3);
}

void own_base_rate(int turns, const Real *q, const Real *v, const Real *a, const Real *own_v,
                   Real *own_a) {
    Real turn[4];
    orientation(turns, q + 3, turn);
    turned_back(turn, a, own_a);
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        own_a[k] -= own_v[3 + i] * own_v[j] - own_v[3 + j] * own_v[i];
    }
    angular_acceleration(turns, q + 3, v + 3, a + 3, own_a + 3);
}

void random_base(int turns, double *q, double *v) {
    for (int k = 0; k < 3; k++) q[k] = uniform(-1, 1), v[k] = uniform(-2, 2);
    for (int k = 3; k < 3 + turns; k++) q[k] = uniform(-1.2, 1.2), v[k] = uniform(-2, 2);
    if (turns == 3) return;
    double along = 0;
    random_quaternion(q + 3);
    for (int k = 3; k < 7; k++) along += q[k] * v[k];
    for (int k = 3; k < 7; k++) v[k] -= along * q[k];
}

Real drift(const Real *q, const Real *v, const Real *a) {
    Real sum = 0;
    for (int k = 0; k < 4; k++) sum += q[k] * a[k] + v[k] * v[k];
    return fabsl(sum);
}
