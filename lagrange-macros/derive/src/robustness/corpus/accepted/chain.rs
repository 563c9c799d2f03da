#[coordinates(theta: [3])]
#[define(n = 3)]
#[define(x[0] = sin(theta[0]))]
#[define(x[i in 1..n] = x[i - 1] + l*sin(theta[i]))]
#[lagrangian(sum(i in 0..n, der(x[i])^2/2 + theta_dot[i]^2) + sum(i in 0..n, atan2(theta[i], pi)))]
#[constraint(rod[i in 0..2]: theta[i] = theta[i + 1])]
#[observable(pulls = [lambda(rod)[0], lambda(rod[1])])]
struct Chain<T> { l: T }
