//! Bobs on rods, one below the other, in Cartesian coordinates.

/// Declares such a chain of a number of rods: `rods!(Rods5 5, Rods10 10)`.
macro_rules! rods {
    ($($name:ident $n:literal),*) => {$(
        #[derive(Lagrangian, Clone, Copy)]
        #[coordinates(x: [$n], y: [$n])]
        #[lagrangian(sum(i in 0..$n, m[i]/2*(x_dot[i]^2 + y_dot[i]^2) - m[i]*g*y[i]))]
        #[constraint(rod[0]: (x[0]^2 + y[0]^2 - l[0]^2)/2 = 0)]
        #[constraint(rod[i in 1..$n]: ((x[i]-x[i-1])^2 + (y[i]-y[i-1])^2 - l[i]^2)/2 = 0)]
        struct $name<T> {
            m: [T; $n],
            l: [T; $n],
            g: T,
        }
    )*};
}
