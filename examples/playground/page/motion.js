// The points that move, and the plots.

/// Names of points: a vector `p[0]`, `p[1]`, or a pair `x1`, `y1`, with a third number in space. For each, the indices of its numbers.
function pointsOf(names) {
  const index = name => names.indexOf(name);
  return names.flatMap((name, k) => {
    const vector = name.match(/^(.*)\[0\]$/);
    const pair = name.match(/^x(.*)$/);
    const rest = vector ? ["[1]", "[2]", "[3]"].map(end => index(vector[1] + end)) : pair ? ["y", "z"].map(letter => index(letter + pair[1])) : [];
    // Four numbers are a quaternion.
    return rest[0] >= 0 && !(rest[2] >= 0) ? [[k, rest[0], ...(rest[1] >= 0 ? [rest[1]] : [])]] : [];
  });
}

/// Points at each frame, as seen: in space from a little above.
function trackPoints(run, { observables, coordinates }) {
  const own = pointsOf(observables);
  const [points, numbers, width] = own.length ? [own, run.observables, observables.length] : [pointsOf(coordinates), run.states, 2 * coordinates.length];
  const [sine, cosine, up] = [Math.sin(0.5), Math.cos(0.5), 0.3];
  const see = ([x, y, z]) => (z === undefined ? [x, y] : [x * cosine - y * sine, z * Math.cos(up) + (x * sine + y * cosine) * Math.sin(up)]);
  return run.times.length ? Array.from(run.times, (_, frame) => points.map(point => see(point.map(k => numbers[frame * width + k])))) : [];
}

/// Middle and radius of what the points and the origin reach.
function viewOf(track) {
  const all = [[0, 0], ...track.flat().filter(point => point.every(Number.isFinite))];
  const ends = [0, 1].map(k => all.reduce(([low, high], point) => [Math.min(low, point[k]), Math.max(high, point[k])], [0, 0]));
  const [x, y] = ends.map(([low, high]) => (low + high) / 2);
  return { x, y, radius: 0.6 * Math.max(...ends.map(([low, high]) => high - low), 1e-9) };
}

function drawPoints(canvas, { track, view }, frame, joined, paints) {
  const { pen, width, height } = fit(canvas);
  pen.font = "14px system-ui, 'DejaVu Sans', sans-serif";
  pen.fillStyle = rgba(paints.soft);
  if (!track?.[0]?.length) {
    pen.textAlign = "center";
    pen.fillText("Observables name points to be seen:", width / 2, height / 2 - 12);
    return pen.fillText("#[observable(p = [x, y])]", width / 2, height / 2 + 12);
  }
  const scale = Math.min(width, height) / 2 / view.radius;
  const see = ([x, y]) => [width / 2 + (x - view.x) * scale, height / 2 - (y - view.y) * scale];
  const origin = see([0, 0]);
  stroke(pen, [[origin[0] - 6, origin[1]], [origin[0] + 6, origin[1]]], 1.5, rgba(paints.guide));
  stroke(pen, [[origin[0], origin[1] - 6], [origin[0], origin[1] + 6]], 1.5, rgba(paints.guide));
  const now = track[frame].map(see);
  now.forEach((_, k) => stroke(pen, track.slice(Math.max(0, frame - 90), frame + 1).map(points => see(points[k])), 1.5, rgba(paints[PAINTS[k % 2]], 0.4)));
  if (joined) stroke(pen, [origin, ...now], 2.5, rgba(paints.fixed));
  now.forEach((point, k) => disc(pen, point, 8, rgba(paints[PAINTS[k % 2]])));
}

const COLOURS = ["body", "other", "force", "constraint", "momentum", "soft"];

/// Curves of a list of quantities, stored frame by frame.
function curvesOf(names, numbers, offset = 0, width = names.length) {
  const frames = names.length ? Math.floor(numbers.length / width) : 0;
  return names.slice(0, COLOURS.length).map((name, k) => ({
    name, paint: COLOURS[k], values: Array.from({ length: frames }, (_, frame) => numbers[frame * width + offset + k]),
  }));
}

const change = curve => ({ ...curve, values: curve.values.map(value => value - curve.values[0]) });

/// What is plotted of a motion: coordinates against time, one against its velocity, energy, changes of what is conserved, multipliers.
function plotsOf(run, { coordinates, conserved, constraints }, chosen) {
  const width = 2 * coordinates.length;
  const of = k => Array.from(run.times, (_, frame) => run.states[frame * width + k]);
  const plots = [
    { title: "Coordinates", curves: curvesOf(coordinates, run.states, 0, width) },
    { title: "Phase plane", phase: true, axis: coordinates[chosen], times: of(chosen), curves: [{ name: `${coordinates[chosen]}_dot`, paint: "body", values: of(chosen + coordinates.length) }] },
    { title: "Energy", curves: [{ name: "E", paint: "ink", values: run.energies }] },
    { title: "Conserved: change", curves: curvesOf(conserved, run.conserved).map(change) },
    { title: "Multipliers λ", curves: curvesOf(constraints, run.multipliers) },
  ];
  return plots.filter(({ curves }) => curves.length).map(plot => ({ times: run.times, axis: "t", ...plot }));
}

/// A figure for each plot; that of the phase plane lets one choose the coordinate.
function layFigures(plots, coordinates, chosen, choose) {
  element("plots").replaceChildren(...plots.map(plot => {
    const figure = document.createElement("figure");
    const keys = plot.curves.map(({ name, paint }) => `<span class="key" style="--paint: var(--${paint})">${pretty(name)}</span>`);
    figure.innerHTML = `<figcaption><b>${plot.title}<span class="scale"></span></b>${keys.join("")}</figcaption><canvas></canvas>`;
    if (plot.phase && coordinates.length > 1) {
      const select = document.createElement("select");
      select.setAttribute("aria-label", "Coordinate of the phase plane");
      coordinates.forEach((name, k) => select.add(new Option(name, k, false, k === chosen)));
      select.addEventListener("input", () => choose(+select.value));
      figure.firstChild.append(select);
    }
    Object.assign(plot, { canvas: figure.querySelector("canvas"), scale: figure.querySelector(".scale") });
    return figure;
  }));
}

function drawFigures(plots, frame, paints) {
  for (const plot of plots) {
    const { canvas, scale, times, curves, axis } = plot;
    const finite = Array.from(times).filter(Number.isFinite);
    const [low, high] = [finite.reduce((a, b) => Math.min(a, b), Infinity), finite.reduce((a, b) => Math.max(a, b), -Infinity)];
    const window = high > low ? [low, high] : [low - 1, low + 1];
    const largest = curves.flatMap(({ values }) => Array.from(values, Math.abs)).filter(Number.isFinite).reduce((a, b) => Math.max(a, b), 0);
    const least = Math.max(1e-3 * (plot.title.startsWith("Conserved") ? 0 : largest), 1e-15);
    const power = drawPlot(canvas, { times, curves, now: times[frame], window, least, axis: axis === "t" ? "t" : axis.replace(/_/g, " ") }, paints);
    scale.textContent = power ? ` · 10${superscript(power)}` : "";
  }
}
