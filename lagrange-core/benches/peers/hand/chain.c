/* Masses on rods in Cartesian coordinates by hand, -DN=<masses> -DDIM=<2 or 3>. J M^-1 J^T is tridiagonal for a chain
 * with a diagonal M: solved by Thomas's algorithm in O(N). q = all x, then all y (then z); the last axis points up.
 *   M a = f + J^T lambda,  J a = -dJ/dt v */
void thomas(const double *restrict x, const double *restrict v, const double *restrict p, double *restrict a,
            double *restrict lambda) {
    const double *m = p;
    const double g = p[2 * N];
    double d[DIM][N], inverse[N], C[N], D[N], right[N], diagonal[N], upper[N];
    for (int i = 0; i < N; i++) {
        double square = 0;
        inverse[i] = 1.0 / m[i];
        for (int k = 0; k < DIM; k++) {
            double w = v[k * N + i] - (i ? v[k * N + i - 1] : 0);
            d[k][i] = x[k * N + i] - (i ? x[k * N + i - 1] : 0);
            square += w * w;
        }
        right[i] = (i ? 0 : g * d[DIM - 1][0]) - square;
    }
    for (int i = 0; i < N; i++) {
        double s = 0, c = 0;
        for (int k = 0; k < DIM; k++) {
            s += d[k][i] * d[k][i];
            if (i + 1 < N) c += d[k][i] * d[k][i + 1];
        }
        diagonal[i] = s * (inverse[i] + (i ? inverse[i - 1] : 0));
        upper[i] = -c * inverse[i];
    }
    for (int i = 0; i < N; i++) {
        double e = diagonal[i], r = right[i];
        if (i) {
            e -= upper[i - 1] * C[i - 1];
            r -= upper[i - 1] * D[i - 1];
        }
        double q = 1.0 / e;
        C[i] = upper[i] * q;
        D[i] = r * q;
    }
    lambda[N - 1] = D[N - 1];
    for (int i = N - 2; i >= 0; i--) lambda[i] = D[i] - C[i] * lambda[i + 1];
    for (int k = 0; k < DIM; k++)
        for (int i = 0; i < N; i++)
            a[k * N + i] = inverse[i] * (lambda[i] * d[k][i] - (i + 1 < N ? lambda[i + 1] * d[k][i + 1] : 0)) -
                           (k == DIM - 1 ? g : 0);
}
