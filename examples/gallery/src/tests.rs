//! Every system by itself: it runs, keeps what it conserves, and obeys its sliders from end to end.

use crate::running::Running;
use crate::systems::{Entry, all};

/// Where the sliders are at first.
fn values(entry: &Entry) -> Vec<f64> {
    entry.knobs.iter().map(|knob| knob.value).collect()
}

fn run(entry: &Entry, values: &[f64], end: f64) -> Box<dyn Running> {
    let set = format!("{} at {values:?}", entry.key);
    let mut running = (entry.open)(values).unwrap_or_else(|error| panic!("{set}: {error}"));
    running.advance(end).unwrap_or_else(|error| panic!("{set}: {error}"));
    running
}

/// All that is seen of a motion.
fn seen(running: &dyn Running, end: f64) -> Vec<f64> {
    let mut seen = running.state(end);
    seen.extend(running.scene(end, true).into_iter().map(f64::from));
    (0..running.quantities().len()).for_each(|quantity| seen.extend(running.series(quantity, 0.0, end)));
    seen
}

#[test]
fn every_system_keeps_what_it_conserves() {
    for entry in all() {
        let running = run(&entry, &values(&entry), 10.0);
        let quantities = running.quantities();
        let series: Vec<_> =
            (0..quantities.len()).map(|quantity| running.series(quantity, 0.0, 10.0)).collect();
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        let energies = quantities.iter().zip(&series).filter(|(quantity, _)| quantity.kind == "energy");
        let energy = energies.map(|(_, values)| largest(values)).fold(0.0, f64::max);
        for (quantity, values) in quantities.iter().zip(&series) {
            assert!(values.iter().all(|value| value.is_finite()), "{} {}", entry.key, quantity.name);
            let is_kept = quantity.kind == "conserved" || quantity.name == "E" && entry.conserves_energy;
            let change: Vec<f64> = values.iter().map(|value| value - values[0]).collect();
            let loss = largest(&change) / energy.max(largest(values));
            assert!(!is_kept || loss < 1e-9, "{} loses {loss:e} of {}", entry.key, quantity.name);
        }
    }
}

#[test]
fn every_slider_changes_something_and_reaches_its_ends() {
    for entry in all() {
        let first = seen(&*run(&entry, &values(&entry), 1.0), 1.0);
        for (index, knob) in entry.knobs.iter().enumerate() {
            for end in knob.range {
                let mut values = values(&entry);
                values[index] = end;
                let moved = seen(&*run(&entry, &values, 1.0), 1.0);
                assert!(end == knob.value || moved != first, "{}: {} changes nothing", entry.key, knob.name);
                assert!(moved.iter().all(|x| x.is_finite()), "{}: {} = {end}", entry.key, knob.name);
            }
        }
    }
}

/// Between two frames the state is as close to the motion as a picture needs.
#[test]
fn what_is_between_frames_is_on_the_way() {
    for entry in all() {
        let step = entry.pace / 60.0;
        let running = run(&entry, &values(&entry), 2.0 * step);
        let [before, between, after] = [0.0, 0.5, 1.0].map(|part| running.state(part * step));
        for i in 0..before.len() {
            let apart = (between[i] - f64::midpoint(before[i], after[i])).abs();
            assert!(
                apart <= 0.2 * (after[i] - before[i]).abs() + 0.02,
                "{}: entry {i} is {apart} off",
                entry.key
            );
        }
    }
}

#[test]
fn every_quantity_has_a_unit_or_none_has() {
    for entry in all() {
        for quantity in run(&entry, &values(&entry), 0.0).quantities() {
            let has_unit = !quantity.unit.is_empty();
            assert_eq!(has_unit, entry.has_units, "{}: {} {}", entry.key, quantity.kind, quantity.name);
        }
    }
}

#[test]
fn links_name_one_system_each() {
    let mut keys: Vec<_> = all().iter().map(|entry| entry.key).collect();
    keys.sort_unstable();
    keys.dedup();
    assert_eq!(keys.len(), all().len());
    assert!(all().iter().all(|entry| {
        entry.knobs.iter().all(|knob| knob.range[0] <= knob.value && knob.value <= knob.range[1])
    }));
}

/// Impacts and friction take energy, and give none.
#[test]
fn contacts_take_energy() {
    for entry in
        all().iter().filter(|entry| ["bouncing-ball", "rocking-block", "woodpecker"].contains(&entry.key))
    {
        let energies = run(entry, &values(entry), 5.0).series(0, 0.0, 5.0);
        let most = energies.iter().fold(0.0_f64, |most, energy| most.max(energy.abs()));
        assert!(
            energies.windows(2).all(|pair| pair[1] <= pair[0] + 1e-9 * most),
            "{} gains energy",
            entry.key
        );
        assert!(energies[energies.len() - 1] < energies[0] - 1e-3 * most, "{} keeps its energy", entry.key);
    }
}
