#[coordinates(r: [2, 3], q: [2, 4])]
#[frame(body[i in 0..2]: translate(r[i]), rotate(q[i]))]
#[define(d[i in 0..2, j in 0..i] = norm(r[i] - r[j]))]
#[define(a[i in 0..2] = b[i] + m)] #[define(b[i in 0..2] = sum(j in 0..i, a[j]))]
#[lagrangian(sum(i in 0..2, kinetic(body[i], m, [0, 0, 0], identity(3)) + sum(j in 0..i, a[i]/d[i][j])))]
#[force(r[k in 0..2, 1]: -r_dot[k][0])]
#[power(i in 0..2, vector(body[i], r[1]), velocity(body[i]))]
#[observable(turning[i in 0..2] = angular_velocity(body[i]))]
struct Bodies { m: f64 }
