/* Numbers with their first and second derivatives by the time, and frames that move by them. */
#ifndef JETS_H
#define JETS_H

typedef long double Real;
typedef struct {
    Real x, v, a;
} Jet;

Jet constant(Real x);
Jet plus(Jet s, Jet t);
Jet minus(Jet s, Jet t);
Jet times(Jet s, Jet t);

/* `turn` (columns one after another) takes its axes to the fixed ones, along which its origin is `at`. */
typedef struct {
    Jet turn[9], at[3];
} Frame;

Frame ground(void);
/* Along the fixed axes, of a point by its components in the frame. */
void point(const Frame *frame, const Jet *r, Jet *result);
void fixed_point(const Frame *frame, const double *r, Jet *result);
/* Steps to another frame, each in the axes that are reached. */
void move(Frame *frame, const Jet *r);
void translate(Frame *frame, const double *r);
void turn_about(Frame *frame, char axis, Jet angle);
void turn_by(Frame *frame, const double *rotation);
/* (w, x, y, z), of length 1 */
void turn_by_quaternion(Frame *frame, const Jet *q);

#endif
