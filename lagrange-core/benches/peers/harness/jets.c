/* Numbers that change, and frames that move by them. */
#include "jets.h"
#include <math.h>
#include <string.h>

Jet constant(Real x) { return (Jet){x, 0, 0}; }
Jet plus(Jet s, Jet t) { return (Jet){s.x + t.x, s.v + t.v, s.a + t.a}; }
Jet minus(Jet s, Jet t) { return (Jet){s.x - t.x, s.v - t.v, s.a - t.a}; }
Jet times(Jet s, Jet t) {
    return (Jet){s.x * t.x, s.v * t.x + s.x * t.v, s.a * t.x + 2 * s.v * t.v + s.x * t.a};
}
Jet sine(Jet s) {
    Real x = sinl(s.x), slope = cosl(s.x);
    return (Jet){x, slope * s.v, slope * s.a - x * s.v * s.v};
}
Jet cosine(Jet s) {
    Real x = cosl(s.x), slope = -sinl(s.x);
    return (Jet){x, slope * s.v, slope * s.a - x * s.v * s.v};
}

Frame ground(void) {
    Frame frame;
    for (int e = 0; e < 9; e++) frame.turn[e] = constant(e % 4 == 0);
    for (int e = 0; e < 3; e++) frame.at[e] = constant(0);
    return frame;
}

void point(const Frame *frame, const Jet *r, Jet *result) {
    for (int i = 0; i < 3; i++) {
        result[i] = frame->at[i];
        for (int j = 0; j < 3; j++) result[i] = plus(result[i], times(frame->turn[3 * j + i], r[j]));
    }
}

void fixed_point(const Frame *frame, const double *r, Jet *result) {
    Jet jets[3] = {constant(r[0]), constant(r[1]), constant(r[2])};
    point(frame, jets, result);
}

void move(Frame *frame, const Jet *r) {
    Jet at[3];
    point(frame, r, at);
    memcpy(frame->at, at, sizeof at);
}

static void turn(Frame *frame, const Jet *by) {
    Frame before = ground();
    memcpy(before.turn, frame->turn, sizeof before.turn);
    for (int column = 0; column < 3; column++) point(&before, by + 3 * column, frame->turn + 3 * column);
}

void turn_about(Frame *frame, char axis, Jet angle) {
    int k = axis - 'x', i = (k + 1) % 3, j = (k + 2) % 3;
    Jet by[9];
    for (int e = 0; e < 9; e++) by[e] = constant(e == 4 * k);
    by[4 * i] = by[4 * j] = cosine(angle);
    by[3 * i + j] = sine(angle);
    by[3 * j + i] = minus(constant(0), by[3 * i + j]);
    turn(frame, by);
}

void turn_by(Frame *frame, const double *rotation) {
    Jet by[9];
    for (int e = 0; e < 9; e++) by[e] = constant(rotation[e]);
    turn(frame, by);
}

/* v -> v + 2 q x (q x v + w v), of the unit vectors. */
void turn_by_quaternion(Frame *frame, const Jet *q) {
    Jet by[9], two = constant(2);
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        Jet w = q[0], x = q[1 + k], y = q[1 + i], z = q[1 + j];
        by[4 * k] = minus(constant(1), times(two, plus(times(y, y), times(z, z))));
        by[3 * k + i] = times(two, plus(times(x, y), times(w, z)));
        by[3 * k + j] = times(two, minus(times(x, z), times(w, y)));
    }
    turn(frame, by);
}

void translate(Frame *frame, const double *r) { fixed_point(frame, r, frame->at); }
