#[coordinates(x, r: [3])]
#[lagrangian(x_dot^2 + dot([[]]*[[]], [[]]*r) + trace([[]]) + r*[[], []])]
#[constraint(c: [[]]*transpose([[]]) = r*[])]
#[observable(o = [[]])]
struct EmptyRows;
