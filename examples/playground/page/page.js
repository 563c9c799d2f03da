// The page: what is typed and set, and what follows from it.

const element = id => document.getElementById(id);
/// Samples of a motion.
const FRAMES = 901;

/// What a link holds is `set`; all else follows from it.
const page = {
  set: { text: "", parameters: {}, start: {}, method: "Dop853", end: 10, joined: true },
  found: null, run: null, track: null, view: null, plots: [], chosen: 0, frame: 0, playing: true, paints: null, since: 0, took: null,
};

function fromHash() {
  const hash = decodeURIComponent(location.hash.slice(1));
  const known = SYSTEMS.find(({ key }) => key === hash);
  if (known) return known.set;
  try {
    return { ...SYSTEMS[0].set, ...JSON.parse(hash) };
  } catch {
    return SYSTEMS[0].set;
  }
}

function keepHash() {
  history.replaceState(null, "", `#${encodeURIComponent(JSON.stringify(page.set))}`);
}

/// Everything anew, from what is set.
function open(set) {
  page.set = structuredClone(set);
  const { text, method, end, joined } = page.set;
  element("text").value = text;
  Object.assign(element("method"), { value: method });
  Object.assign(element("end"), { value: end });
  element("joined").checked = joined;
  const known = SYSTEMS.findIndex(({ set }) => set.text === text);
  element("systems").selectedIndex = known + 1;
  return read();
}

/// Derives the text, and moves it.
async function read() {
  const { text } = page.set;
  const begun = performance.now();
  try {
    const found = await ask("read", { text });
    if (!found || text !== page.set.text) return;
    element("loading")?.remove();
    showFaults(text, found.faults);
    // What was derived last stays while there are errors.
    element("equations").style.opacity = element("stage").style.opacity = found.faults.length ? 0.45 : 1;
    if (found.faults.length) return;
    page.found = found;
    showEquations(element("formulas"), found.mathml);
    element("facts").textContent = found.facts.trim();
    page.took = performance.now() - begun;
    layNumbers();
    await move();
  } catch (error) {
    element("loading")?.remove();
    showFaults(text, [{ message: error.message, start: 0, length: 0 }]);
  }
}

/// Rows for the numbers of all names; a name keeps its number while others come and go.
function layNumbers() {
  const { set, found } = page;
  const changed = (list, name) => value => {
    set[list][name] = value;
    move();
  };
  found.parameters.forEach(name => (set.parameters[name] ??= name === "g" ? 9.81 : 1));
  found.coordinates.forEach((name, k) => (set.start[name] ??= [+(1 - 0.3 * k).toFixed(1), 0]));
  page.chosen = Math.min(page.chosen, found.coordinates.length - 1);
  element("parameters").replaceChildren(...found.parameters.map(name => parameterRow(name, set.parameters[name], changed("parameters", name))));
  element("start").replaceChildren(...found.coordinates.map(name => startRow(name, set.start[name], changed("start", name))));
}

/// What the worker is told of the numbers.
function settings() {
  const { set, found } = page;
  const start = found.coordinates.map(name => set.start[name]);
  return {
    text: set.text, method: set.method, end: set.end, frames: FRAMES,
    parameters: found.parameters.map(name => set.parameters[name]), q: start.map(([q]) => q), v: start.map(([, v]) => v),
  };
}

async function move() {
  keepHash();
  const { found } = page;
  if (found.unsupported) {
    Object.assign(page, { run: null, track: null, plots: [] });
    element("plots").replaceChildren();
    say(`It is derived, and does not move here: ${found.unsupported}.`);
    return paint();
  }
  try {
    const run = await ask("run", settings());
    if (!run || found !== page.found) return;
    const track = trackPoints(run, found);
    Object.assign(page, { run, track, view: viewOf(track), frame: Math.min(page.frame, run.times.length - 1) });
    say(run.message);
    layPlots();
  } catch (error) {
    say(error.message);
  }
  paint();
}

function layPlots() {
  const { run, found, chosen } = page;
  page.plots = plotsOf(run, found, chosen);
  layFigures(page.plots, found.coordinates, chosen, coordinate => {
    page.chosen = coordinate;
    layPlots();
    paint();
  });
}

function say(text) {
  element("message").textContent = text;
}

function paint() {
  const { run, frame, paints, set, plots } = page;
  drawPoints(element("scene"), page, frame, set.joined, paints);
  if (!run) return;
  drawFigures(plots, frame, paints);
  element("time").value = frame / (run.times.length - 1);
  element("clock").textContent = `t = ${fixed(run.times[frame], 2)}`;
}

/// Time goes by as on a clock, and begins anew at its end.
function tick(now) {
  const { run, playing, since } = page;
  if (run && playing && run.times.length > 1) {
    const span = run.times.at(-1) - run.times[0];
    const passed = Math.min(0.1, (now - since) / 1000);
    page.place = ((page.place ?? 0) + passed / Math.max(span, 1e-9)) % 1;
    page.frame = Math.round(page.place * (run.times.length - 1));
    paint();
  }
  page.since = now;
  requestAnimationFrame(tick);
}

function play(isOn) {
  page.playing = isOn;
  element("play").textContent = isOn ? "❚❚" : "▶";
}

async function showProgram() {
  const { program } = await ask("program", settings());
  element("program").querySelector("pre").textContent = program;
  element("program").showModal();
}

function listen() {
  let clock;
  element("text").addEventListener("input", ({ target }) => {
    page.set.text = target.value;
    showFaults(target.value, []);
    clearTimeout(clock);
    clock = setTimeout(read, 30);
  });
  element("text").addEventListener("scroll", scrollMarks);
  element("systems").addEventListener("input", ({ target }) => target.selectedIndex && open(SYSTEMS[target.selectedIndex - 1].set));
  element("method").addEventListener("input", ({ target }) => ((page.set.method = target.value), move()));
  element("end").addEventListener("input", ({ target }) => +target.value > 0 && ((page.set.end = +target.value), move()));
  element("joined").addEventListener("input", ({ target }) => ((page.set.joined = target.checked), keepHash(), paint()));
  element("play").addEventListener("click", () => play(!page.playing));
  element("time").addEventListener("input", ({ target }) => {
    play(false);
    page.place = +target.value;
    page.frame = Math.round(page.place * ((page.run?.times.length ?? 1) - 1));
    paint();
  });
  element("rust").addEventListener("click", showProgram);
  element("copy").addEventListener("click", () => navigator.clipboard.writeText(element("program").querySelector("pre").textContent));
  element("close").addEventListener("click", () => element("program").close());
  element("link").addEventListener("click", () => navigator.clipboard.writeText(location.href));
  addEventListener("hashchange", () => open(fromHash()));
  addEventListener("resize", paint);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => ((page.paints = colours()), paint()));
}

async function begin() {
  page.paints = colours();
  element("systems").append(new Option("of my own"), ...SYSTEMS.map(({ title }) => new Option(title)));
  play(!matchMedia("(prefers-reduced-motion: reduce)").matches);
  listen();
  await loadWorker();
  await open(fromHash());
  requestAnimationFrame(tick);
}

begin();
