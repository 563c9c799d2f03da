/* The free base of bodies in space; `turns`, 3 or 4, is by how many coordinates it turns. */
#ifndef FREE_BASE_H
#define FREE_BASE_H

#include "robots.h"

/* A unit quaternion (w, x, y, z). */
void random_quaternion(double *q);
/* Its matrix by columns. */
void rotation_matrix(const Real *q, Real *r);

void random_base(int turns, double *q, double *v);
/* Positions and speeds as other tools take them. */
void own_base(int turns, const Real *q, const Real *v, Real *own_q, Real *own_v);
/* The derivatives of these speeds, from accelerations of the coordinates. */
void own_base_rate(int turns, const Real *q, const Real *v, const Real *a, const Real *own_v, Real *own_a);
/* How far a quaternion's acceleration is from keeping |q| = 1. */
Real drift(const Real *q, const Real *v, const Real *a);

#endif
