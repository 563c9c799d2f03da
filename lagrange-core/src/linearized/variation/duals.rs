//! Systems over dual numbers, along which steps of a method are differentiated.

use crate::derivatives::tangent::WideOf;
use crate::error::Error;
use crate::linearized::Linearized;
use crate::linearized::argument::set_parameter;
use crate::number::{Broadcast, Dual, Real, Scalar, Wide};
use crate::system::{Pack, State};
use crate::vector::{PhaseVector, StaticLength, Vector, from_fn, vector};

/// Dual numbers with derivatives along one direction per lane.
pub(super) type Duals<L> = Dual<WideOf<L>>;
/// The system over these dual numbers.
pub(super) type PackedDuals<L> = <L as Pack<Duals<L>>>::Packed;

/// Converts the system to dual numbers whose parameters change at these rates.
pub(super) fn with_rates<L>(
    system: &L,
    rates: Option<&Vector<WideOf<L>, L::P>>,
) -> Result<PackedDuals<L>, Error>
where
    L: Linearized<Scalar: Real> + Pack<Duals<L>>,
    PackedDuals<L>: Linearized<N = L::N, M = L::M, P = L::P, Scalar = Duals<L>>,
{
    let (mut over, values) = (system.pack(), system.parameters());
    let Some(rates) = rates else { return Ok(over) };
    let zero = L::Scalar::constant(0.0);
    for k in 0..<L::P>::COUNT {
        let changes = (0..WideOf::<L>::COUNT).any(|lane| rates[k].lane(lane) != zero);
        let value = Dual { value: WideOf::<L>::of(values[k]), slope: rates[k] };
        if changes {
            set_parameter(&mut over, k, value)?;
        }
    }
    Ok(over)
}

/// A state whose coordinates and velocities change along the variations.
pub(super) fn with_slopes<T: Real<Wide = W>, W: Wide<T>, N: StaticLength>(
    state: &State<T, N>,
    y: &PhaseVector<W, N>,
) -> State<Dual<W>, N> {
    let dual = |value: T, slope| Dual { value: W::of(value), slope };
    State {
        t: dual(state.t, W::constant(0.0)),
        q: vector(from_fn(|i| dual(state.q[i], y[0][i]))),
        v: vector(from_fn(|i| dual(state.v[i], y[1][i]))),
    }
}
