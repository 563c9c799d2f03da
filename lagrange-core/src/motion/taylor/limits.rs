//! Chosen constants of Taylor's method.

/// Minus the natural logarithm of the ratio of the step length to the radius of convergence.
///
/// 2 takes the least work if each order costs as much as all before it (Jorba and Zou, 3.1), 1 if all orders cost the
/// same. A smaller value is best if a step has a cost of its own. Here the code that the derive emits takes most of the
/// time of an order. Between 1.25 and 1.5 all measured systems take about the same time, 10 to 25 % less than with 2:
/// pendulums of 2 to 10 links, on a rod and in a plane, 5 and 50 rods, Kepler's ellipse, Hénon and Heiles, 2,000 double
/// pendulums at 10⁻⁹ to 10⁻¹⁵.
pub(super) const STEP: f64 = 1.4;

/// Number of coefficients that determine the step length: after a symmetric start only every fourth may be nonzero.
pub(crate) const LAST: usize = 5;

/// Margin in the test whether the last coefficients have underflowed, in bits per order. They may have if the known
/// coefficients fall nearly as fast per order as coefficients that reach the smallest number at the highest order. The
/// unit of a polynomial has to stay: in another one its states are rounded.
pub(super) const UNDERFLOW: f64 = 8.0;

/// Ratio of a step to the step before below which the series may be rounding errors of nearly dependent constraints. The
/// radius of convergence of a motion falls by at most a quarter in a step, e^−[`STEP`] of it. With 1, regular motions
/// on rods are truncated too, and lose digits.
pub(super) const COLLAPSE: f64 = 0.5;

/// Largest defect of a step due to round-off, in units of ε of the velocities, where no pivot is small. In steps of
/// pendulums of one to ten links, on a rod and in space, Kepler's ellipses, Hénon and Heiles it is at most 100. A larger
/// defect is compared with the change of the equations at neighbouring states. Of smooth motions, pulses and steps of
/// potentials the numbers of evaluations are the same within 0.3 % up to 256. With 1,024, motions across kinks of roots
/// take 4 % fewer evaluations, and are less accurate.
pub(super) const ROUND_OFF: f64 = 64.0;

/// Largest defect of a step across a kink of a user-supplied function or a singular pose: a multiple of the tolerance,
/// or a fraction of the velocities, whichever is larger. The defect at
/// a kink is the jump of the accelerations times the step, and steps shrink until it is allowed. With 4,096 tolerances
/// motions across such kinks take 7 to 17 % more evaluations for half of the error. With 4·10⁻¹¹ of the velocities 7 %
/// fewer motions cross singular poses.
pub(super) const JUMP: [f64; 2] = [1e4, 1e-10];

/// Largest number of samples within a step. Each costs an evaluation of the equations, about a thirtieth of a step.
pub(super) const MOST: usize = 128;

/// Largest ratio of the distance between samples in one step to that in the step before, until a step has [`MOST`]
/// samples.
pub(super) const WIDER: f64 = 2.0;

/// Largest ratio of successive step lengths. The radius of convergence of an analytic motion grows by at most a quarter
/// in a step; only steps after a short one, such as to the end of a control period, grow by more.
pub(super) const GROWTH: f64 = 10.0;

/// Number of samples within every step with user-supplied functions, whose kinks and jumps no series contains. They
/// detect a force that acts in a quarter of the step.
pub(super) const AT_FUNCTIONS: usize = 3;

/// Change of the argument of a steep function, or of the logarithm of a power, beyond which its series may miss the
/// function: over 8, an exponential grows by a factor of three thousand. Each such change takes one sample. With 16,
/// one potential step of 1,200 is stepped over.
pub(super) const STEEP: f64 = 8.0;

/// Number of sums in a group: as many numbers as a SIMD register of 256 bits. The derive pads to a multiple of it.
pub(super) const WIDTH: usize = 4;
