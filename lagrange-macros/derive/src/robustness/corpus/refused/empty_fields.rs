#[coordinates(x, r: [0], s: [2, 0])]
#[define(e[i in 2..2] = i)]
#[lagrangian(x_dot^2 + a[0] + b*b + c[1..1] + x^e + dot(r, r) + f(x) + d*d)]
#[function(f(s): [0] = x)]
#[parameter(g: [0] {m, c: [0]})]
struct EmptyFields { a: [f64; 0], b: [[f64; 0]; 3], c: [[f64; 3]; 0], d: [Matrix3<f64>; 0], g: [G; 0] }
