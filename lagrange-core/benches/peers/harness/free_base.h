/* The free base of bodies in space; `turns`, 3 or 4, is by how many coordinates it turns. */
#ifndef FREE_BASE_H
#define FREE_BASE_H

/* A unit quaternion (w, x, y, z). */
void random_quaternion(double *q);
/* Its matrix by columns. */
void rotation_matrix(const double *q, double *r);

void random_base(int turns, double *q, double *v);
/* Positions and speeds as other tools take them. */
void own_base(int turns, const double *q, const double *v, double *own_q, double *own_v);
/* The derivatives of these speeds, from accelerations of the coordinates. */
void own_base_rate(int turns, const double *q, const double *v, const double *a, const double *own_v, double *own_a);
/* How far a quaternion's acceleration is from keeping |q| = 1. */
double drift(const double *q, const double *v, const double *a);

#endif
