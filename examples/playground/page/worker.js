// Runs the derive and the interpreter aside from the page, which ends it where a text takes too long.

let ready, text, reading;

/// The system of a text; the last one is kept.
function read(given) {
  if (given !== text) {
    reading?.free();
    [reading, text] = [new wasm_bindgen.Reading(given), given];
  }
  return reading;
}

const ANSWERS = {
  read({ text }) {
    const found = read(text);
    const faults = found.faults().map(({ message, start, length }) => ({ message, start, length }));
    if (faults.length) return { faults };
    const lists = ["coordinates", "parameters", "observables", "conserved", "constraints"].map(list => [list, found[list]()]);
    const texts = ["name", "mathml", "facts", "unsupported"].map(name => [name, found[name]()]);
    return { faults, ...Object.fromEntries([...lists, ...texts]) };
  },
  run({ text, parameters, q, v, method, end, frames }) {
    const run = read(text).run(parameters, q, v, method, end, frames);
    const { times, states, energies, conserved, observables, multipliers, message } = run;
    run.free();
    return { times, states, energies, conserved, observables, multipliers, message };
  },
  program({ text, parameters, q, v, method, end }) {
    return { program: read(text).program(parameters, q, v, method, end) };
  },
};

onmessage = async ({ data }) => {
  if (data.module) {
    ready = wasm_bindgen({ module_or_path: data.module });
    await ready;
    postMessage({ ready: true });
    return;
  }
  await ready;
  const begun = performance.now();
  try {
    postMessage({ id: data.id, answer: ANSWERS[data.kind](data), took: performance.now() - begun });
  } catch (error) {
    postMessage({ id: data.id, error: String(error) });
  }
};
