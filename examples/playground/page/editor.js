// The text, its errors, and the numbers that belong to its names.

/// Underlines the tokens at fault, and lists what is wrong with them.
function showFaults(text, faults) {
  const marks = faults.filter(({ length }) => length).toSorted((a, b) => a.start - b.start);
  let [html, at] = ["", 0];
  for (const { start, length } of marks) {
    if (start < at) continue;
    html += escaped(text.slice(at, start)) + `<mark>${escaped(text.slice(start, start + length))}</mark>`;
    at = start + length;
  }
  element("marks").innerHTML = html + escaped(text.slice(at)) + "\n";
  element("faults").replaceChildren(...faults.map(fault => {
    const item = document.createElement("li");
    item.textContent = fault.length ? `${place(text, fault.start)}: ${fault.message}` : fault.message;
    item.addEventListener("click", () => {
      element("text").focus();
      element("text").setSelectionRange(fault.start, fault.start + fault.length);
    });
    return item;
  }));
  scrollMarks();
}

/// Line and column, both from 1.
function place(text, start) {
  const lines = text.slice(0, start).split("\n");
  return `${lines.length}:${[...lines.at(-1)].length + 1}`;
}

function scrollMarks() {
  const { scrollTop, scrollLeft } = element("text");
  Object.assign(element("marks"), { scrollTop, scrollLeft });
}

function numberInput(value, name, changed) {
  const input = Object.assign(document.createElement("input"), { type: "number", step: "any", value });
  input.setAttribute("aria-label", name);
  input.addEventListener("input", () => {
    if (input.value !== "" && Number.isFinite(+input.value)) changed(+input.value);
  });
  return input;
}

/// A parameter: its name, its value, and a slider from a tenth of it to three times as much.
function parameterRow(name, value, changed) {
  const label = document.createElement("label");
  label.innerHTML = `<span>${pretty(name)}</span>`;
  const slider = Object.assign(document.createElement("input"), { type: "range" });
  slider.setAttribute("aria-label", `${name}, slider`);
  const range = value => {
    const ends = value === 0 ? [-1, 1] : [value / 10, 3 * value].toSorted((a, b) => a - b);
    Object.assign(slider, { min: ends[0], max: ends[1], step: (ends[1] - ends[0]) / 200, value });
  };
  const number = numberInput(value, name, value => {
    range(value);
    changed(value);
  });
  range(value);
  slider.addEventListener("input", () => {
    number.value = +(+slider.value).toPrecision(4);
    changed(+number.value);
  });
  label.append(number, slider);
  return label;
}

/// A coordinate: its name, its value and its velocity at the start.
function startRow(name, [q, v], changed) {
  const label = document.createElement("label");
  label.innerHTML = `<span>${pretty(name)}</span>`;
  const now = [q, v];
  const inputs = now.map((value, k) => numberInput(value, k ? `velocity of ${name}` : name, value => {
    now[k] = value;
    changed([...now]);
  }));
  label.append(...inputs);
  return label;
}
