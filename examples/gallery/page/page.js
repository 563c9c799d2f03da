// The page: what is shown, what is set, and what keys and sliders do.

const element = id => document.getElementById(id);
const SPEEDS = [0.125, 0.25, 0.5, 1, 2, 4];
/// Seconds of watching in the plots.
const WINDOW = 12;
const PLOTS = [
  { kind: "energy", title: "Energy", paints: ["ink", "body", "other"] },
  { kind: "conserved", title: "Conserved: change", paints: ["ink", "body", "other", "force", "momentum"] },
  { kind: "multiplier", title: "Multipliers λ", paints: ["constraint", "body", "other", "force", "momentum", "soft"] },
];

/// All there is to know of the page.
const page = {
  cards: [], card: null, values: [], show: null, t: 0, playing: true, speed: 1, forces: true,
  turned: [0, 0], paints: null, sliders: [], plots: [], dirty: true, cost: [],
};

async function unpacked() {
  const bytes = Uint8Array.from(atob(element("wasm").textContent), letter => letter.charCodeAt(0));
  const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(plain).arrayBuffer();
}

/// Plain objects: what the systems say of themselves does not change.
function known(card) {
  const knobs = card.knobs().map(({ name, meaning, unit, low, high, value }) => ({ name, meaning, unit, low, high, value }));
  const { key, title, about, pace, text, mathml, latex, coordinates, has_units: hasUnits, conserves_energy: conservesEnergy } = card;
  return { key, title, about, pace, text, mathml, latex, coordinates, hasUnits, conservesEnergy, knobs, open: values => card.open(values) };
}

function choose({ card, values, at, speed, forces }) {
  const isNew = card !== page.card;
  Object.assign(page, { card, values, speed: SPEEDS.includes(speed) ? speed : page.speed, forces });
  if (isNew) describe();
  page.sliders.forEach((slider, k) => slider.show(values[k]));
  element("speed").value = page.speed;
  element("forces").checked = forces;
  begin();
  const isCalm = matchMedia("(prefers-reduced-motion: reduce)").matches;
  play(at === undefined && !isCalm);
  if (at !== undefined) goTo(at);
}

/// Everything that is of the system and not of its motion.
function describe() {
  const { card } = page;
  page.turned = [0, 0];
  element("title").textContent = card.title;
  element("about").textContent = card.about;
  element("scene").setAttribute("aria-label", `${card.title}, moving`);
  showEquations(element("formulas"), card.mathml);
  element("text").textContent = card.text;
  element("latex").textContent = card.latex;
  for (const link of element("systems").children) link.toggleAttribute("aria-current", link.hash === `#${card.key}`);
  showChosen();
  page.sliders = card.knobs.map((knob, k) => slider(knob, value => set(k, value)));
  element("knobs").replaceChildren(...page.sliders.map(({ label }) => label));
}

/// The system in the middle of the list, as far as that goes; the page stays where it is.
function showChosen() {
  const list = element("systems");
  const [at, frame] = [list.querySelector("[aria-current]"), list].map(one => one?.getBoundingClientRect());
  if (at) list.scrollBy(at.left + at.width / 2 - frame.left - frame.width / 2, at.top + at.height / 2 - frame.top - frame.height / 2);
}

/// From the start, as the sliders are.
function begin() {
  page.show?.free();
  page.show = null;
  page.t = 0;
  try {
    page.show = page.card.open(new Float64Array(page.values));
    say("");
  } catch (error) {
    say(`It cannot start like this: ${error}`);
  }
  element("scene").classList.toggle("turns", page.show?.view(0).length > 5);
  layPlots();
  page.dirty = true;
}

/// A figure for each kind of quantity that there is.
function layPlots() {
  const quantities = (page.show?.quantities() ?? []).map((text, index) => {
    const [kind, name, ...unit] = text.split(" ");
    return { kind, name, unit: unit.join(" "), index, first: page.show.series(index, 0, 0)[0] };
  });
  page.plots = PLOTS.map(plot => ({ ...plot, quantities: quantities.filter(({ kind }) => kind === plot.kind).slice(0, plot.paints.length) }))
    .filter(({ quantities }) => quantities.length);
  element("plots").replaceChildren(...page.plots.map(plot => {
    const figure = document.createElement("figure");
    // A unit that all have stands in the title.
    const units = new Set(plot.quantities.map(({ unit }) => unit));
    const own = unit => (units.size > 1 && unit ? ` in ${unit}` : "");
    const keys = plot.quantities.map(({ name, unit }, k) => `<span class="key" style="--paint: var(--${plot.paints[k]})">${pretty(name)}${own(unit)}</span>`);
    figure.innerHTML = `<figcaption><b>${plot.title}<span class="scale"></span></b>${keys.join("")}</figcaption><canvas></canvas>`;
    Object.assign(plot, { canvas: figure.querySelector("canvas"), scale: figure.querySelector(".scale"), unit: units.size > 1 ? "" : [...units][0] });
    return figure;
  }));
}

function say(text) {
  element("message").textContent = text;
}

function set(index, value) {
  page.values[index] = value;
  const { playing } = page;
  begin();
  play(playing);
}

function play(isOn) {
  page.playing = isOn;
  const shape = isOn ? "M1.5 1h2.4v8H1.5zM6 1h2.4v8H6z" : "M2 .6v8.8L9.4 5z";
  element("play").innerHTML = `<svg viewBox="0 0 10 10"><path d="${shape}"/></svg>`;
  page.dirty = true;
  keepLink();
}

/// As far as the motion gets on the way to a time.
function goTo(t) {
  const { show } = page;
  if (!show) return;
  let last = show.span()[1];
  if (t > last) {
    try {
      show.advance(t);
    } catch (error) {
      say(`Here it ends: ${error}`);
      play(false);
    }
    last = show.span()[1];
    if (!page.playing) t = Math.min(t, last);
  }
  page.t = Math.max(t, show.span()[0]);
  page.dirty = true;
}

let linkTimer;
function keepLink() {
  clearTimeout(linkTimer);
  linkTimer = setTimeout(() => history.replaceState(null, "", toLink(page)), 200);
}

function draw() {
  const { show, t, card } = page;
  if (!show) return;
  drawScene(element("scene"), show.scene(t, page.forces), show.view(t), page.turned, page.paints, card.hasUnits);
  const [first, last] = show.span();
  Object.assign(element("time"), { min: first, max: Math.max(last, first + 1e-9), value: t });
  element("clock").textContent = card.hasUnits ? `${fixed(t, 2)} s` : `t = ${fixed(t, 2)}`;
  const end = Math.max(t, first + WINDOW * card.pace);
  const window = [end - WINDOW * card.pace, end];
  const times = show.times(window[0], Math.min(end, last));
  for (const plot of page.plots) drawFigure(plot, times, window);
}

function drawFigure(plot, times, window) {
  const isChange = plot.kind === "conserved";
  const curves = plot.quantities.map(({ index, first }, k) => {
    const values = page.show.series(index, window[0], window[1]);
    return { values: isChange ? values.map(value => value - first) : values, paint: plot.paints[k] };
  }).reverse();
  const least = isChange ? 1e-15 : 1e-3 * Math.max(...plot.quantities.map(({ first }) => Math.abs(first) || 0), 1e-3);
  const axis = page.card.hasUnits ? "t in s" : "t";
  const power = drawPlot(plot.canvas, { times, curves, now: page.t, window, least, axis }, page.paints);
  const scale = [power ? `10${superscript(power)}` : "", plot.unit].filter(Boolean).join(" ");
  plot.scale.textContent = scale && ` in ${scale}`;
}

let before = 0;
function frame(now) {
  const begun = performance.now();
  if (page.playing && page.show) goTo(page.t + Math.min(now - before, 50) * 1e-3 * page.card.pace * page.speed);
  before = now;
  if (page.dirty) {
    page.dirty = false;
    draw();
    page.cost = [...page.cost.slice(-299), performance.now() - begun];
  }
  requestAnimationFrame(frame);
}

function step(frames) {
  play(false);
  goTo(page.t + (frames * page.card.pace) / 60);
}

function neighbour(by) {
  const { cards, card } = page;
  location.hash = cards[(cards.indexOf(card) + by + cards.length) % cards.length].key;
}

function speedUp(by) {
  page.speed = SPEEDS[Math.max(0, Math.min(SPEEDS.length - 1, SPEEDS.indexOf(page.speed) + by))];
  element("speed").value = page.speed;
  keepLink();
}

function reset() {
  choose({ ...page, values: page.card.knobs.map(({ value }) => value) });
}

function showForces(isOn) {
  element("forces").checked = page.forces = isOn;
  page.dirty = true;
  keepLink();
}

function otherTheme() {
  const { dataset } = document.documentElement;
  const isDark = dataset.theme ? dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  dataset.theme = isDark ? "light" : "dark";
  repaint();
}

function repaint() {
  page.paints = colours();
  page.dirty = true;
}

async function copyLink() {
  const link = location.href.split("#")[0] + toLink(page);
  history.replaceState(null, "", toLink(page));
  const copied = await navigator.clipboard?.writeText(link).then(() => true, () => false);
  element("link").textContent = copied ? "Copied" : "It stands in the address";
  setTimeout(() => (element("link").textContent = "Copy link"), 2000);
}

const KEYS = {
  " ": () => play(!page.playing),
  ArrowLeft: event => step(event.shiftKey ? -30 : -1),
  ArrowRight: event => step(event.shiftKey ? 30 : 1),
  Home: () => goTo(0),
  "+": () => speedUp(1), "=": () => speedUp(1), "-": () => speedUp(-1),
  f: () => showForces(!page.forces),
  n: () => neighbour(1), p: () => neighbour(-1),
  r: reset, l: copyLink, d: otherTheme,
};

function listen() {
  const on = (id, event, action) => element(id).addEventListener(event, action);
  on("start", "click", () => goTo(0));
  on("play", "click", () => play(!page.playing));
  on("time", "input", ({ target }) => {
    play(false);
    goTo(+target.value);
  });
  on("speed", "change", ({ target }) => {
    page.speed = +target.value;
    keepLink();
  });
  on("forces", "change", ({ target }) => showForces(target.checked));
  on("reset", "click", reset);
  on("link", "click", copyLink);
  on("theme", "click", otherTheme);
  document.addEventListener("keydown", event => {
    const { target, key, ctrlKey, metaKey, altKey } = event;
    const moves = key.startsWith("Arrow") || key === "Home";
    const isTaken = target.matches("select") || (target.matches("input") && moves) || (target.matches("button, summary, a") && key === " ");
    if (ctrlKey || metaKey || altKey || isTaken || !KEYS[key]) return;
    event.preventDefault();
    KEYS[key](event);
  });
  window.addEventListener("hashchange", () => choose(fromLink(location.hash, page.cards)));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", repaint);
  new ResizeObserver(() => {
    showChosen();
    page.dirty = true;
  }).observe(document.body);
  turnByDragging(element("scene"));
}

function turnByDragging(canvas) {
  let from = null;
  canvas.addEventListener("pointerdown", event => {
    from = [event.clientX, event.clientY, ...page.turned];
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", event => {
    if (!from) return;
    page.turned = [from[2] - (event.clientX - from[0]) * 0.008, from[3] + (event.clientY - from[1]) * 0.008];
    page.dirty = true;
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => (from = null));
}

async function start() {
  await wasm_bindgen({ module_or_path: await unpacked() });
  page.cards = wasm_bindgen.cards().map(known);
  element("systems").replaceChildren(...page.cards.map(({ key, title }) => {
    const link = document.createElement("a");
    Object.assign(link, { href: `#${key}`, textContent: title });
    return link;
  }));
  element("loading").remove();
  page.paints = colours();
  listen();
  choose(fromLink(location.hash, page.cards));
  requestAnimationFrame(frame);
}

start().catch(error => {
  element("loading")?.remove();
  say(`This browser cannot run it: ${error}`);
  throw error;
});
