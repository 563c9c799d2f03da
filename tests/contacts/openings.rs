//! Contacts that open where their force comes to zero slowly: the gap begins without rate and without acceleration.
//!
//! A failure says the number of its case.

use lagrange_core::contact::{Contact, Transition};
use lagrange_core::{Method, prelude::*};

use lagrange_random::{Random, cases};

/// A block on a floor and a spring, under a weight of 1 and a load that lifts it: a pulse in time, or a bump in space that it
/// crosses at the speed 1.
#[derive(Clone, Debug, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - k*(y - height)^2/2 - (1 - lift)*(y - height))]
#[define(lift = pulse*exp(-((t - t0)/width)^2) + bump*exp(-((x - t0)/width)^2))]
#[force(x: (height - y)*lift_x)]
#[define(lift_x = -2*(x - t0)/width^2*bump*exp(-((x - t0)/width)^2))]
#[contact(floor: y - height >= 0)]
struct Lifted {
    k: f64,
    pulse: f64,
    bump: f64,
    t0: f64,
    width: f64,
    height: f64,
    floor: Contact,
}

/// Nodes and weights of Gauss and Legendre with 10 points on [−1, 1], the positive half.
const GAUSS: [[f64; 2]; 5] = [
    [0.148_874_338_981_631_22, 0.295_524_224_714_752_87],
    [0.433_395_394_129_247_2, 0.269_266_719_309_996_35],
    [0.679_409_568_299_024_4, 0.219_086_362_515_982_04],
    [0.865_063_366_688_984_5, 0.149_451_349_150_580_6],
    [0.973_906_528_517_171_7, 0.066_671_344_308_688_14],
];

impl Lifted {
    fn any(random: &mut Random) -> Self {
        let peak = random.between(1.05, 1.6);
        let in_time = random.below(2) == 0;
        Self {
            k: [0.0, 0.1, 1.0, random.between(0.0, 4.0)][random.below(4)],
            pulse: if in_time { peak } else { 0.0 },
            bump: if in_time { 0.0 } else { peak },
            t0: random.between(1.0, 4.0),
            width: random.size(0.05, 1.0),
            height: [0.0, random.size(0.01, 100.0)][random.below(2)],
            floor: Contact::Closed,
        }
    }

    /// Time at which the load is the weight.
    fn opens(&self) -> f64 {
        self.t0 - self.width * (self.pulse + self.bump).ln().sqrt()
    }

    /// Gap at the time t by the convolution ∫ sin(ω(t − s))/ω f(s) ds of the load.
    fn rise(&self, t: f64) -> f64 {
        let (start, omega) = (self.opens(), self.k.sqrt());
        let panels = ((t - start) / (0.25 * self.width)).ceil().max(1.0);
        let half = (t - start) / panels / 2.0;
        let response = |s: f64| if omega == 0.0 { t - s } else { (omega * (t - s)).sin() / omega };
        let load = |s: f64| (self.pulse + self.bump) * (-((s - self.t0) / self.width).powi(2)).exp() - 1.0;
        let f = |s: f64| response(s) * load(s);
        let panel = |k: f64| {
            let middle = start + (2.0 * k + 1.0) * half;
            GAUSS.iter().map(|[x, w]| w * half * (f(middle - x * half) + f(middle + x * half))).sum::<f64>()
        };
        (0..panels as usize).map(|k| panel(k as f64)).sum()
    }

    /// Time at which the height is zero again.
    fn lands(&self) -> f64 {
        let mut low = self.t0;
        while self.rise(low + 0.02 * self.width) > 0.0 {
            low += 0.02 * self.width;
        }
        let mut high = low + 0.02 * self.width;
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            if self.rise(middle) > 0.0 { low = middle } else { high = middle }
        }
        high
    }
}

/// Transitions and number of legs.
type Found = Result<(Vec<Transition<f64>>, usize), String>;

fn moved(block: &Lifted, end: f64, method: impl Method<Lifted>) -> Found {
    let motion = block.motion(State::new([0.0, block.height], [1.0, 0.0])).by(method).with_contacts();
    let path = motion.towards(end).map_err(|error| error.to_string())?;
    match path.ending().is_failure() {
        true => Err(path.ending().to_string()),
        false => Ok((path.transitions().to_vec(), path.legs().len())),
    }
}

/// Motions by all methods, none of whose steps passes over the load; with the name of each, and the errors of its landings, in
/// tolerances of the gap: twice as much as the most of 20,000 motions. Those of `Radau` are of its dense output, of the order of its
/// stages; its steps end within a tolerance.
fn all(block: &Lifted, end: f64, tolerance: f64) -> [(&'static str, f64, Found); 6] {
    let step = block.width / 2.0;
    let radau = Radau::with_tolerance(tolerance).max_step(step);
    let (dop853, dopri5) = (Dop853::with_tolerance(tolerance), Dopri5::with_tolerance(tolerance));
    [
        ("Radau", 2000.0, moved(block, end, radau)),
        ("Radau of order 9", 2000.0, moved(block, end, radau.stages::<5>())),
        ("Radau of order 13", 2000.0, moved(block, end, radau.stages::<7>())),
        ("Dop853", 20.0, moved(block, end, dop853.max_step(step))),
        ("Dopri5", 20.0, moved(block, end, dopri5.max_step(step))),
        ("Taylor", 20.0, moved(block, end, Taylor::with_tolerance(tolerance).max_step(step))),
    ]
}

/// The block opens, hits the floor and stays there, in three legs and at the right times; else what it does.
fn fault(block: &Lifted, (found, most): (&Found, f64), tolerance: f64) -> Option<String> {
    let (transitions, legs) = match found {
        Err(ending) => return Some(ending.clone()),
        Ok(found) => found,
    };
    let [
        Transition::Opens { time: opens, .. },
        Transition::Impact { time: lands, .. },
        Transition::Closes { .. },
    ] = transitions[..]
    else {
        return Some(format!("{transitions:?}"));
    };
    let rise = block.rise(lands);
    let allowed = most * tolerance * (1.0 + block.height);
    let is_right =
        (opens - block.opens()).abs() < 1e-13 * (1.0 + opens) && rise.abs() < allowed && *legs == 3;
    (!is_right).then(|| format!("{legs} legs, opens at {opens}, not {}, lands at {lands}, not {}, with a gap of {rise:e}, not below {allowed:e}", block.opens(), block.lands()))
}

#[test]
fn a_contact_opens_once_whatever_the_method() {
    for k in 0..cases([10, 40, 10_000]) as u64 {
        let mut random = Random(k.wrapping_mul(0x5851_f42d_4c95_7f2d));
        let (block, tolerance) = (Lifted::any(&mut random), random.size(1e-12, 1e-6));
        for (name, most, found) in all(&block, block.lands() + 0.5, tolerance) {
            let fault = fault(&block, (&found, most), tolerance);
            assert!(fault.is_none(), "{k}, {name}, {tolerance:e}: {}; {block:?}", fault.unwrap());
        }
    }
}

/// A floor that falls away from a body at rest, y + t³ (t²/20 − 3.4 t/12 + 0.4), meets it again at 8/3: within a first step, too,
/// where the gap is accelerated apart again.
#[test]
fn a_gap_that_closes_again_within_the_first_step() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(y)]
    #[lagrangian(m/2 * y_dot^2)]
    #[contact(floor: y + t^3*(t^2/20 - 3.4*t/12 + 0.4) >= 0)]
    struct Floor {
        m: f64,
        floor: Contact,
    }
    for step in [0.5, 2.0, 3.1] {
        let system = Floor { m: 1.0, floor: Contact::Closed };
        let motion = system.motion(State::at_rest([0.0])).by(RungeKutta4::with_step(step));
        let path = motion.with_contacts().to(5.0).unwrap();
        let impact = path.transitions().iter().find(|of| matches!(of, Transition::Impact { .. }));
        let time = impact.map(Transition::time).unwrap();
        assert!((time - 8.0 / 3.0).abs() < 1e-9, "{step}: {time}");
        assert!(
            (path.end().state().q[0] - 0.737_448_559_670_77).abs() < 1e-9,
            "{step}: {}",
            path.end().state().q[0]
        );
    }
}
