// Curves against time, drawn anew in every frame.

/// Ticks at 1, 2 or 5 times a power of ten.
function ticks(low, high, count) {
  const step = nice(((high - low) / count) * 2.2);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push(k * step);
  return { found, digits };
}

/// From the least to the largest value, with a margin; at least as wide as said.
function bounds(curves, least) {
  let [low, high] = [Infinity, -Infinity];
  for (const { values } of curves) {
    for (const value of values) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  if (!(low <= high)) [low, high] = [0, 0];
  const [middle, half] = [(low + high) / 2, Math.max((high - low) / 2, least)];
  return [middle - 1.12 * half, middle + 1.12 * half];
}

function drawPlot(canvas, { times, curves, now, window, least, axis }, paints) {
  const { pen, width, height } = fit(canvas);
  const [left, right, top, bottom] = [58, 10, 8, 22];
  const [low, high] = bounds(curves, least);
  // Small and large numbers have a power of ten in common, which stands above.
  const largest = Math.max(Math.abs(low), Math.abs(high));
  const power = largest < 1e-2 || largest >= 1e4 ? Math.floor(Math.log10(largest)) : 0;
  const x = t => left + ((t - window[0]) / (window[1] - window[0])) * (width - left - right);
  const y = value => top + ((high - value) / (high - low)) * (height - top - bottom);
  pen.font = "12px system-ui, 'DejaVu Sans', sans-serif";
  pen.fillStyle = rgba(paints.soft);
  pen.textBaseline = "middle";
  pen.textAlign = "right";
  const rows = ticks(low / 10 ** power, high / 10 ** power, (height - top - bottom) / 22);
  for (const value of rows.found) {
    const at = y(value * 10 ** power);
    stroke(pen, [[left, at], [width - right, at]], 1, rgba(paints.edge));
    pen.fillText(fixed(value, rows.digits), left - 6, at);
  }
  pen.textAlign = "center";
  const columns = ticks(window[0], window[1], (width - left - right) / 45);
  // The name of the axis stands at its end, where no number does then.
  const end = width - right - pen.measureText(axis).width - 16;
  for (const t of columns.found) if (x(t) < end) pen.fillText(fixed(t, columns.digits), x(t), height - 9);
  pen.textAlign = "right";
  pen.fillText(axis, width - right, height - 9);
  pen.save();
  pen.beginPath();
  pen.rect(left, 0, width - left - right, height - bottom + 2);
  pen.clip();
  for (const { values, paint } of curves) {
    pen.beginPath();
    values.forEach((value, k) => pen.lineTo(x(times[k]), y(value)));
    pen.lineWidth = 1.8;
    pen.strokeStyle = rgba(paints[paint]);
    pen.stroke();
  }
  pen.restore();
  stroke(pen, [[x(now), top], [x(now), height - bottom]], 1, rgba(paints.soft, 0.7));
  return power;
}
