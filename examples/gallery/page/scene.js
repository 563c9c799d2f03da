// Draws the numbers of a scene: kind, paint, size, the number of points, and these, again and again.

const PAINTS = ["body", "other", "fixed", "guide", "constraint", "force", "momentum"];
/// The height of what is below the scene.
const STRIP = 28;
const [LINE, TRAIL, BALL, DOT, FACE, ARROW, RING] = [0, 1, 2, 3, 4, 5, 6];

/// The colours of the page as numbers, since gradients need their parts.
function colours() {
  const probe = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  const style = getComputedStyle(document.documentElement);
  const read = name => {
    const span = document.createElement("span");
    span.style.color = `var(--${name})`;
    document.body.append(span);
    probe.fillStyle = getComputedStyle(span).color;
    span.remove();
    probe.fillRect(0, 0, 1, 1);
    return [...probe.getImageData(0, 0, 1, 1).data.slice(0, 3)];
  };
  const names = [...PAINTS, "ink", "soft", "edge", "panel"];
  return Object.fromEntries(names.map(name => [name, read(name)]));
}

function rgba([r, g, b], alpha = 1) {
  return `rgba(${r},${g},${b},${alpha})`;
}

function mixed(a, b, part) {
  return a.map((x, i) => Math.round(x + (b[i] - x) * part));
}

/// The canvas as large as it is seen, in pixels of the screen; its size in those of the page.
function fit(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
  }
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  return { pen, width, height };
}

/// From space to the canvas: x and y there, and how near a point is.
function camera([cx, cy, cz, radius, , azimuth, elevation], turned, width, height) {
  const scale = (0.5 * Math.min(width, height)) / radius;
  if (azimuth === undefined) {
    return { scale, flat: true, see: (x, y) => [width / 2 + (x - cx) * scale, height / 2 - (y - cy) * scale, 0] };
  }
  const [az, el] = [azimuth + turned[0], Math.max(-1.5, Math.min(1.5, elevation + turned[1]))];
  const [sa, ca, se, ce] = [Math.sin(az), Math.cos(az), Math.sin(el), Math.cos(el)];
  const see = (x, y, z) => {
    [x, y, z] = [x - cx, y - cy, z - cz];
    const near = (x * ca + y * sa) * ce + z * se;
    const zoom = scale / (1 - near / (6 * radius));
    return [width / 2 + (y * ca - x * sa) * zoom, height / 2 - (z * ce - (x * ca + y * sa) * se) * zoom, near];
  };
  return { scale, flat: false, see };
}

function things(numbers, see) {
  const found = [];
  for (let i = 0; i < numbers.length; ) {
    const [kind, paint, size, count] = numbers.subarray(i, i + 4);
    const points = [];
    let near = 0;
    for (let k = 0, at = i + 4; k < count; k++, at += 3) {
      const point = see(numbers[at], numbers[at + 1], numbers[at + 2]);
      near += point[2] / count;
      points.push(point);
    }
    found.push({ kind, paint: PAINTS[paint], size, points, near });
    i += 4 + 3 * count;
  }
  return found;
}

/// What lies behind first; trails and guides before all, arrows over all.
function ordered(found, flat) {
  const layer = ({ kind, paint }) => (kind === ARROW ? 3 : paint === "guide" ? 0 : kind === TRAIL ? (flat ? 1 : 2) : 2);
  const rank = (a, b) => layer(a) - layer(b) || (flat ? 0 : a.near - b.near);
  return found.sort(rank);
}

function drawScene(canvas, numbers, view, turned, paints, hasUnits) {
  const { pen, width, height } = fit(canvas);
  const high = height - STRIP;
  const { scale, flat, see } = camera(view, turned, width, high);
  const thick = Math.max(0.6, Math.min(1.5, Math.min(width, high) / 480));
  pen.save();
  pen.beginPath();
  pen.rect(0, 0, width, high);
  pen.clip();
  if (flat) drawGrid(pen, view, scale, width, high, paints);
  pen.lineCap = pen.lineJoin = "round";
  const arrows = new Set();
  for (const thing of ordered(things(numbers, see), flat)) {
    const { kind, paint, size, points } = thing;
    const colour = paints[paint];
    if (kind === LINE) stroke(pen, points, size * thick, rgba(colour, paint === "guide" ? 0.45 : 1));
    else if (kind === TRAIL) drawTrail(pen, points, size * thick, colour);
    else if (kind === FACE) drawFace(pen, points, colour, paint, flat, paints);
    else if (kind === DOT) disc(pen, points[0], (size * thick) / 2, rgba(colour));
    else if (kind === BALL) drawBall(pen, points[0], size * scale, colour, paint);
    else if (kind === RING) drawRing(pen, points, size * thick, rgba(mixed(colour, paints.panel, 0.15), 0.8));
    else if (kind === ARROW && drawArrow(pen, points, size * thick, rgba(colour))) arrows.add(paint);
  }
  pen.restore();
  drawScales(pen, view, scale, [width, height], arrows, paints, hasUnits ? " N" : "");
}

function path(pen, points) {
  pen.beginPath();
  for (const [x, y] of points) pen.lineTo(x, y);
}

function stroke(pen, points, width, style) {
  path(pen, points);
  pen.lineWidth = width;
  pen.strokeStyle = style;
  pen.stroke();
}

function disc(pen, [x, y], radius, style) {
  pen.beginPath();
  pen.arc(x, y, Math.max(radius, 1), 0, 2 * Math.PI);
  pen.fillStyle = style;
  pen.fill();
}

/// The older the fainter; round, by parabolas between the middles of its lines.
function drawTrail(pen, points, width, colour) {
  const parts = 24;
  const middle = k => [0, 1].map(i => (points[Math.max(k - 1, 0)][i] + points[k][i]) / 2);
  pen.lineWidth = width;
  for (let part = 0; part < parts; part++) {
    const [from, to] = [part, part + 1].map(end => Math.round((end * (points.length - 1)) / parts));
    pen.beginPath();
    pen.moveTo(...middle(from));
    for (let k = from; k < to; k++) pen.quadraticCurveTo(points[k][0], points[k][1], ...middle(k + 1));
    if (part === parts - 1) pen.lineTo(...points[points.length - 1]);
    pen.strokeStyle = rgba(colour, 0.05 + (0.75 * (part + 1)) / parts);
    pen.stroke();
  }
}

function drawBall(pen, [x, y], radius, colour, paint) {
  radius = Math.max(radius, 2);
  const light = pen.createRadialGradient(x - 0.35 * radius, y - 0.4 * radius, 0.1 * radius, x, y, radius);
  light.addColorStop(0, rgba(mixed(colour, [255, 255, 255], 0.55)));
  light.addColorStop(0.6, rgba(colour));
  light.addColorStop(1, rgba(mixed(colour, [0, 0, 0], 0.3)));
  disc(pen, [x, y], radius, light);
}

/// Faces that are seen edge on are darker.
function drawFace(pen, points, colour, paint, flat, paints) {
  const third = points.length / 3;
  const [a, b, c] = [0, 1, 2].map(k => points[Math.floor(k * third)]);
  const across = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  const size = Math.hypot(b[0] - a[0], b[1] - a[1]) * Math.hypot(c[0] - a[0], c[1] - a[1]) || 1;
  const dark = flat ? 0 : 0.35 * (1 - Math.min(1, Math.abs(across) / size));
  path(pen, points);
  pen.closePath();
  pen.fillStyle = paint === "guide" ? rgba(colour, 0.13) : rgba(mixed(colour, [0, 0, 0], dark), flat ? 0.85 : 0.92);
  pen.fill();
  if (paint !== "guide") stroke(pen, [...points, points[0]], 1, rgba(mixed(colour, paints.ink, 0.4), 0.8));
}

/// The part of a circle that is nearer than its middle.
function drawRing(pen, [centre, ...points], width, style) {
  for (let k = 1; k < points.length; k++) {
    if (points[k][2] > centre[2] && points[k - 1][2] > centre[2]) stroke(pen, [points[k - 1], points[k]], width, style);
  }
}

/// Whether it was long enough to be seen.
function drawArrow(pen, [[ax, ay], [bx, by]], width, style) {
  const length = Math.hypot(bx - ax, by - ay);
  if (!(length > 2)) return false;
  const [ux, uy] = [(bx - ax) / length, (by - ay) / length];
  const head = Math.min(4.2 * width, 0.45 * length);
  const [hx, hy] = [bx - ux * head, by - uy * head];
  stroke(pen, [[ax, ay], [hx, hy]], width, style);
  path(pen, [[bx, by], [hx - uy * head * 0.45, hy + ux * head * 0.45], [hx + uy * head * 0.45, hy - ux * head * 0.45]]);
  pen.closePath();
  pen.fillStyle = style;
  pen.fill();
  return true;
}

function drawGrid(pen, [cx, cy], scale, width, height, paints) {
  const unit = nice((2.2 * 80) / scale);
  const lines = (centre, size, draw) => {
    const [from, to] = [-1, 1].map(side => Math.floor((centre + (side * size) / 2 / scale) / unit));
    for (let k = from; k <= to + 1; k++) draw((k * unit - centre) * scale);
  };
  const style = rgba(paints.guide, 0.14);
  lines(cx, width, x => stroke(pen, [[width / 2 + x, 0], [width / 2 + x, height]], 1, style));
  lines(cy, height, y => stroke(pen, [[0, height / 2 - y], [width, height / 2 - y]], 1, style));
}

/// How long the arrow of a force is, below the scene.
function drawScales(pen, [, , , radius, force], scale, [width, height], arrows, paints, unit) {
  const newton = (scale * radius) / force;
  const amount = nice((0.15 * width) / newton);
  const names = { constraint: "constraint force", force: arrows.has("constraint") ? "other force" : "force" };
  let [x, y] = [14, height - STRIP / 2];
  pen.font = "13px system-ui, 'DejaVu Sans', sans-serif";
  [pen.textBaseline, pen.textAlign] = ["middle", "left"];
  for (const paint of ["constraint", "force"].filter(paint => arrows.has(paint))) {
    const length = amount * newton;
    const text = `${names[paint]} ${+amount.toPrecision(2)}${unit}`;
    drawArrow(pen, [[x, y], [x + length, y]], 2.5, rgba(paints[paint]));
    pen.fillStyle = rgba(paints.ink);
    pen.fillText(text, x + length + 8, y);
    x += length + pen.measureText(text).width + 28;
  }
}
