/* The planar pendulum by hand, -DN=<links>. p = m[0..N], l[0..N], g; absolute angles. */
#include <math.h>

/* The mass matrix, M_ij = mu_max(i,j) l_i l_j cos(q_i - q_j), with one sine and cosine an angle; L D L^T in place,
 * one division a row. */
void dense(const double *restrict q, const double *restrict v, const double *restrict p, double *restrict a,
           double *restrict lambda) {
    (void)lambda;
    const double *m = p, *l = p + N;
    const double g = p[2 * N];
    double ls[N], lc[N], mu[N], M[N][N], b[N], r[N];
    for (int i = 0; i < N; i++) {
        ls[i] = l[i] * sin(q[i]);
        lc[i] = l[i] * cos(q[i]);
    }
    mu[N - 1] = m[N - 1];
    for (int i = N - 2; i >= 0; i--) mu[i] = mu[i + 1] + m[i];
    for (int i = 0; i < N; i++) b[i] = -mu[i] * g * ls[i];
    for (int i = 0; i < N; i++) {
        M[i][i] = mu[i] * l[i] * l[i];
        for (int j = 0; j < i; j++) {
            M[i][j] = mu[i] * (lc[i] * lc[j] + ls[i] * ls[j]);
            double s = mu[i] * (ls[i] * lc[j] - lc[i] * ls[j]);
            b[i] -= s * v[j] * v[j];
            b[j] += s * v[i] * v[i];
        }
    }
    double d[N];
    for (int j = 0; j < N; j++) {
        double w[N], pivot = M[j][j];
        for (int k = 0; k < j; k++) {
            w[k] = M[j][k] * d[k];
            pivot -= M[j][k] * w[k];
        }
        d[j] = pivot;
        r[j] = 1.0 / pivot;
        for (int i = j + 1; i < N; i++) {
            double s = M[i][j];
            for (int k = 0; k < j; k++) s -= M[i][k] * w[k];
            M[i][j] = s * r[j];
        }
    }
    for (int i = 0; i < N; i++)
        for (int k = 0; k < i; k++) b[i] -= M[i][k] * b[k];
    for (int i = N - 1; i >= 0; i--) {
        b[i] *= r[i];
        for (int k = i + 1; k < N; k++) b[i] -= M[k][i] * b[k];
    }
    for (int i = 0; i < N; i++) a[i] = b[i];
}

/* O(N): the tensions T of the links solve a tridiagonal system (Thomas), the angular accelerations follow from them.
 * With e along a link and t across it: a_i - a_(i-1) = l_i qdd_i t_i - l_i v_i^2 e_i, e = (sin, -cos), t = (cos, sin). */
void linear(const double *restrict q, const double *restrict v, const double *restrict p, double *restrict a,
            double *restrict lambda) {
    (void)lambda;
    const double *m = p, *l = p + N;
    const double g = p[2 * N];
    double s[N], c[N], inverse[N], T[N + 1], D[N], upper[N], ce[N], se[N];
    for (int i = 0; i < N; i++) {
        s[i] = sin(q[i]);
        c[i] = cos(q[i]);
        inverse[i] = 1.0 / m[i];
    }
    for (int i = 1; i < N; i++) {
        ce[i] = c[i] * c[i - 1] + s[i] * s[i - 1];
        se[i] = s[i] * c[i - 1] - c[i] * s[i - 1];
    }
    for (int i = 0; i < N; i++) {
        double diagonal = inverse[i] + (i ? inverse[i - 1] : 0.0);
        double right = l[i] * v[i] * v[i] + (i ? 0.0 : g * c[0]);
        if (i) {
            double lower = -ce[i] * inverse[i - 1];
            diagonal -= lower * upper[i - 1];
            right -= lower * D[i - 1];
        }
        double r = 1.0 / diagonal;
        upper[i] = i + 1 < N ? -ce[i + 1] * inverse[i] * r : 0.0;
        D[i] = right * r;
    }
    T[N] = 0;
    for (int i = N - 1; i >= 0; i--) T[i] = D[i] - upper[i] * T[i + 1];
    for (int i = 0; i < N; i++) {
        double x = i ? -inverse[i - 1] * T[i - 1] * se[i] : -g * s[0];
        if (i + 1 < N) x += inverse[i] * T[i + 1] * se[i + 1];
        a[i] = x / l[i];
    }
}

#if N == 2
/* Two links in closed form: the sine and cosine of the difference, two sines, Cramer's rule with one division. */
void closed(const double *restrict q, const double *restrict v, const double *restrict p, double *restrict a,
            double *restrict lambda) {
    (void)lambda;
    const double m1 = p[0], m2 = p[1], l1 = p[2], l2 = p[3], g = p[4], M = m1 + m2;
    const double d = q[0] - q[1], s = sin(d), c = cos(d), w1 = v[0] * v[0], w2 = v[1] * v[1];
    const double f1 = -(m2 * l2 * w2 * s + M * g * sin(q[0])), f2 = l1 * w1 * s - g * sin(q[1]);
    const double r = 1.0 / (l1 * l2 * (m1 + m2 * s * s));
    a[0] = l2 * (f1 - m2 * c * f2) * r;
    a[1] = l1 * (M * f2 - c * f1) * r;
}
#endif
