/* What is evaluated, on what states, and how a result is checked. */
#ifndef SYSTEMS_H
#define SYSTEMS_H

#include "robots.h"

enum { STATES = 64, ENTRIES = 256, RESULTS = 4096, PARAMETERS = 1024, OWN = 128 };

/* Every implementation: q, v and p in, v right after q; accelerations and multipliers (where there are any) out. */
typedef void (*Evaluation)(const double *q, const double *v, const double *p, double *a, double *lambda);

typedef struct {
    int n, coordinates;
    /* Where the forces at the joints stand in p. */
    int tau;
    /* q, then v, of each state. */
    double states[STATES][2 * ENTRIES], p[PARAMETERS];
    Robot robot;
} Inputs;

static inline double *q_of(Inputs *in, long s) { return in->states[s % STATES]; }
static inline double *v_of(Inputs *in, long s) { return in->states[s % STATES] + in->coordinates; }

typedef struct {
    const char *name;
    /* Fills in random states and parameters; all states satisfy the constraints. */
    void (*prepare)(Inputs *);
    /* The largest error of a result at state s, as a fraction of the largest acceleration. */
    double (*error)(Inputs *, int s, const double *a, const double *lambda);
} System;

/* The system of that name, or NULL. */
const System *find_system(const char *name);

/* A random number in [low, high). */
double uniform(double low, double high);

/* Of bodies in space: positions and speeds as other tools take them, from coordinates and their rates, in which the speeds
 * are linear; and the derivatives of these speeds, from accelerations. */
void own_state(const Inputs *in, const Real *q, const Real *v, Real *own_q, Real *own_v);
void own_rate(const Inputs *in, const Real *q, const Real *v, const Real *a, const Real *own_v, Real *own_a);
/* By how many coordinates a free base turns, 0 without one. */
int turning(const Inputs *in);

/* Solves n equations, whose right sides stand after the columns of the matrix, in which nothing is left as it was. */
void eliminate(int n, long double m[UNKNOWNS][UNKNOWNS + 1], long double *x);

extern const System PLANAR, LANES, CHAIN, SPHERICAL, BODIES, ARM, DENAVIT, QUADRUPED, QUADRUPED_ANGLES, HUMANOID, FOUR_BAR,
    STEWART, ARM_JACOBIAN, ARM_INVERSE, ARM_MASS, ARM_DERIVATIVES, QUADRUPED_INVERSE, QUADRUPED_MASS,
    QUADRUPED_DERIVATIVES, HUMANOID_INVERSE, HUMANOID_MASS, HUMANOID_DERIVATIVES;

#endif
