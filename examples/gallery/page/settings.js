// What is set stands in the link: `#double-pendulum?theta_1=2.5&speed=0.5`.

/// The system and what is set of it, of a link.
function fromLink(hash, cards) {
  const [key, query = ""] = decodeURIComponent(hash.replace(/^#/, "")).split("?");
  const given = new URLSearchParams(query);
  const number = name => (given.has(name) && Number.isFinite(+given.get(name)) ? +given.get(name) : undefined);
  const card = cards.find(card => card.key === key) ?? cards[0];
  const within = (value, { low, high }) => Math.min(high, Math.max(low, value));
  const values = card.knobs.map(knob => within(number(knob.name) ?? knob.value, knob));
  return { card, values, at: number("at"), speed: number("speed"), forces: given.get("forces") !== "no" };
}

/// What differs from how it is at first.
function toLink({ card, values, speed, forces, playing, t }) {
  const given = new URLSearchParams();
  card.knobs.forEach((knob, k) => {
    if (values[k] !== knob.value) given.set(knob.name, String(+values[k].toPrecision(6)));
  });
  if (speed !== 1) given.set("speed", String(speed));
  if (!forces) given.set("forces", "no");
  if (!playing) given.set("at", t.toFixed(3));
  const query = given.toString();
  return `#${card.key}${query ? "?" + query : ""}`;
}

/// A slider with its name, what it is, and its value.
function slider(knob, changed) {
  const label = document.createElement("label");
  const step = nice((knob.high - knob.low) / 150);
  const shown = (String(knob.value).split(".")[1] ?? "").length;
  const digits = Math.max(shown, -Math.floor(Math.log10(step) + 1e-9));
  label.innerHTML = `<span><span class="name">${pretty(knob.name)}</span> <span class="meaning">${escaped(knob.meaning)}</span></span><output></output>
    <input type="range" name="${knob.name}" min="${knob.low}" max="${knob.high}" step="any">`;
  const [input, output] = [label.querySelector("input"), label.querySelector("output")];
  const show = value => {
    input.value = value;
    output.textContent = `${fixed(value, digits)} ${knob.unit}`.trim();
  };
  input.addEventListener("input", () => {
    const value = Math.min(knob.high, Math.max(knob.low, Math.round(input.value / step) * step));
    show(value);
    changed(+value.toPrecision(12));
  });
  // A range without steps would move by a hundredth of what is left to it.
  input.addEventListener("keydown", event => {
    const way = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
    if (!way) return;
    event.preventDefault();
    input.value = +input.value + way * step;
    input.dispatchEvent(new Event("input"));
  });
  return { label, show };
}
