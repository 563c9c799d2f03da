//! Vectors and matrices of f64, and linear equations solved by elimination.

pub(super) type Vector = [f64; 3];
/// Rows of a 3 × 3 matrix.
pub(super) type Matrix = [Vector; 3];

pub(super) const UNIT: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

pub(super) fn dot(v: Vector, w: Vector) -> f64 {
    v[0] * w[0] + v[1] * w[1] + v[2] * w[2]
}

pub(super) fn cross(v: Vector, w: Vector) -> Vector {
    [v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]]
}

pub(super) fn scaled(c: f64, v: Vector) -> Vector {
    v.map(|x| c * x)
}

pub(super) fn sum<const K: usize>(vectors: [Vector; K]) -> Vector {
    std::array::from_fn(|i| vectors.iter().map(|vector| vector[i]).sum())
}

pub(super) fn difference(v: Vector, w: Vector) -> Vector {
    sum([v, scaled(-1.0, w)])
}

pub(super) fn norm(v: Vector) -> f64 {
    dot(v, v).sqrt()
}

pub(super) fn unit(v: Vector) -> Vector {
    scaled(1.0 / norm(v), v)
}

pub(super) fn times(m: Matrix, v: Vector) -> Vector {
    m.map(|row| dot(row, v))
}

pub(super) fn transposed(m: Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| m[j][i]))
}

pub(super) fn product(m: Matrix, n: Matrix) -> Matrix {
    let columns = transposed(n);
    m.map(|row| columns.map(|column| dot(row, column)))
}

/// S with S w = v × w.
pub(super) fn skew([x, y, z]: Vector) -> Matrix {
    [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]
}

/// Rotation about a unit axis n: v cos φ + n × v sin φ + n (n·v)(1 − cos φ) (Rodrigues).
pub(super) fn turn(axis: Vector, angle: f64) -> Matrix {
    let (sin, cos) = angle.sin_cos();
    let turned = |v: Vector| {
        let along = scaled(dot(axis, v) * (1.0 - cos), axis);
        sum([scaled(cos, v), scaled(sin, cross(axis, v)), along])
    };
    transposed(UNIT.map(turned))
}

/// Hamilton product of quaternions (w, x, y, z).
pub(super) fn quaternion_product([a, p @ ..]: [f64; 4], [b, q @ ..]: [f64; 4]) -> [f64; 4] {
    let [x, y, z] = sum([scaled(a, q), scaled(b, p), cross(p, q)]);
    [a * b - dot(p, q), x, y, z]
}

/// The rotation v ↦ q v q̄ by a quaternion of length 1.
pub(super) fn turn_by(q: [f64; 4]) -> Matrix {
    let [w, x, y, z] = q;
    let turned = |[a, b, c]: Vector| {
        let [_, v @ ..] = quaternion_product(quaternion_product(q, [0.0, a, b, c]), [w, -x, -y, -z]);
        v
    };
    transposed(UNIT.map(turned))
}

/// Solves A x = b by Gaussian elimination with partial pivoting, after dividing each row by its largest entry.
/// Returns x and the smallest pivot.
pub(super) fn solved(mut rows: Vec<Vec<f64>>, mut right: Vec<f64>) -> (Vec<f64>, f64) {
    let n = right.len();
    for (row, b) in rows.iter_mut().zip(&mut right) {
        let scale = row.iter().fold(0.0_f64, |scale, x| scale.max(x.abs()));
        row.iter_mut().for_each(|x| *x /= scale);
        *b /= scale;
    }
    let mut least = f64::INFINITY;
    for k in 0..n {
        let largest = (k..n).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs())).unwrap_or(k);
        rows.swap(k, largest);
        right.swap(k, largest);
        least = least.min(rows[k][k].abs());
        let (above, below) = rows.split_at_mut(k + 1);
        let (pivot_row, pivot_right) = (&above[k], right[k]);
        for (row, b) in below.iter_mut().zip(&mut right[k + 1..]).filter(|(row, _)| row[k] != 0.0) {
            let factor = row[k] / pivot_row[k];
            row[k..].iter_mut().zip(&pivot_row[k..]).for_each(|(x, y)| *x -= factor * y);
            *b -= factor * pivot_right;
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| rows[k][j] * right[j]).sum();
        right[k] = (right[k] - known) / rows[k][k];
    }
    (right, least)
}
