//! Dormand and Prince's pair of orders 5 and 4.

use super::adaptive::Adaptive;
use super::pair::{Pair, TableauRow};

/// The coefficients of the pair 5(4) of Dormand and Prince (1980), with the dense output of order 4
/// (Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, table II.5.2 and II.6).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DormandPrince54;

/// Dormand and Prince's method of order 5(4): cheap steps, for errors of 10⁻³ and forces that are not smooth. It needs
/// many steps for errors below 10⁻⁷.
pub type Dopri5 = Adaptive<DormandPrince54>;

impl Pair for DormandPrince54 {
    const NODES: &'static [f64] = &[0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
    const STAGES: &'static [TableauRow] = &[
        &[(0, 0.2)],
        &[(0, 3.0 / 40.0), (1, 9.0 / 40.0)],
        &[(0, 44.0 / 45.0), (1, -56.0 / 15.0), (2, 32.0 / 9.0)],
        &[(0, 19372.0 / 6561.0), (1, -25360.0 / 2187.0), (2, 64448.0 / 6561.0), (3, -212.0 / 729.0)],
        &[
            (0, 9017.0 / 3168.0),
            (1, -355.0 / 33.0),
            (2, 46732.0 / 5247.0),
            (3, 49.0 / 176.0),
            (4, -5103.0 / 18656.0),
        ],
    ];
    const WEIGHTS: TableauRow = &[
        (0, 35.0 / 384.0),
        (2, 500.0 / 1113.0),
        (3, 125.0 / 192.0),
        (4, -2187.0 / 6784.0),
        (5, 11.0 / 84.0),
    ];
    const ERROR: TableauRow = &[
        (0, 71.0 / 57600.0),
        (2, -71.0 / 16695.0),
        (3, 71.0 / 1920.0),
        (4, -17253.0 / 339200.0),
        (5, 22.0 / 525.0),
        (6, -1.0 / 40.0),
    ];
    const LOWER_ERROR: TableauRow = &[];
    const INTERPOLATION_STAGES: &'static [TableauRow] = &[];
    const INTERPOLATION: &'static [TableauRow] = &[&[
        (0, -12715105075.0 / 11282082432.0),
        (2, 87487479700.0 / 32700410799.0),
        (3, -10690763975.0 / 1880347072.0),
        (4, 701980252875.0 / 199316789632.0),
        (5, -1453857185.0 / 822651844.0),
        (6, 69997945.0 / 29380423.0),
    ]];
    const ORDER: f64 = 5.0;
    const DAMPING: f64 = 0.04;
    const SHRINK: f64 = 0.2;
    const GROWTH: f64 = 10.0;

    type Coefficients<X: Clone + Send + Sync + 'static> = [X; 5];

    fn coefficients<X: Clone + Send + Sync + 'static>(all: X) -> [X; 5] {
        core::array::from_fn(|_| all.clone())
    }
}
