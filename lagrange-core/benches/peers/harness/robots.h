/* Bodies in space that hang together by joints. */
#ifndef ROBOTS_H
#define ROBOTS_H

enum { BODIES_AT_MOST = 31, SPEEDS_AT_MOST = BODIES_AT_MOST + 5, UNKNOWNS = 44 };
typedef long double Real;

/* A link whose joint stands at `at` in the axes of the link before, turned by `place` (columns one after another). */
typedef struct {
    char axis;
    int parent;
    double place[9], at[3], m, centre[3], inertia[9], tau;
} Link;

typedef struct {
    int count;
    double g;
    Link links[BODIES_AT_MOST];
} Robot;

/* Position and orientation (x, y, z, w) of a free base, then the angles. */
int positions(const Robot *robot);
/* Velocity and angular velocity of a free base in its own axes, then those of the angles. */
int speeds(const Robot *robot);

/* The forces and torques at the joints that accelerations take, g being the constant of gravity. */
void joint_forces(const Robot *robot, const Real *q, const Real *v, const Real *a, Real g, Real *result);
/* The matrix by which the derivatives of the speeds give them, by columns. */
void joint_mass(const Robot *robot, const Real *q, Real m[][UNKNOWNS + 1]);
/* The derivatives of the speeds, by Newton's and Euler's equations. */
void newton_euler(const Robot *robot, const Real *q, const Real *v, Real *a);

void widen(const double *x, int count, Real *result);
/* By columns. */
void random_rotation(double *r);
/* Principal moments of about `size`, in any axes. */
void random_inertia(double *inertia, double size);

#endif
