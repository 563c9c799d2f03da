/* Bodies that joints close to loops, and their equations by d'Alembert's principle in long double. Nothing is
 * differentiated by hand: all poses are computed along q + v t + a t^2/2 with their derivatives at t = 0. */
#ifndef LOOPS_H
#define LOOPS_H

#include "jets.h"
#include "systems.h"

enum { MOST_BODIES = 13, MOST_COORDINATES = 25, MOST_CONSTRAINTS = 19 };

typedef struct {
    Frame frame;
    Jet centre[3];
    const double *m, *inertia;
} Body;

/* Bodies, and numbers that have to be zero. */
typedef struct {
    int bodies, constraints;
    Body body[MOST_BODIES];
    Jet constraint[MOST_CONSTRAINTS];
} Pose;

typedef struct {
    int coordinates, constraints;
    void (*pose)(const double *p, const Jet *q, Pose *pose);
    /* The constant of gravity, and the force on each coordinate. */
    Real (*forces)(const double *p, Real *force);
} Mechanism;

/* Accelerations, then multipliers: M a - F^T lambda = h, F a = -gamma. */
void solve_loops(const Mechanism *of, const double *p, const double *q, const double *v, Real *result);
/* Puts a state onto the constraints by Newton's method; whether that leads somewhere near. */
int close_loops(const Mechanism *of, const double *p, double *q, double *v);

#endif
