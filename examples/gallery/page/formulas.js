// The equations, as the derive writes them for browsers.

/// Of more rows than that only the first are seen at once.
const ROWS = 12;

function showEquations(place, html) {
  place.innerHTML = html;
  place.querySelectorAll(".equations > div").forEach(fold);
}

/// A left side and a right side are a row, and so is what takes the whole width.
function fold(grid) {
  const cells = [...grid.children];
  const begins = cells.filter((cell, k) => cells[k - 1]?.style.textAlign !== "right");
  if (begins.length <= ROWS) return;
  const more = document.createElement("details");
  const rest = grid.cloneNode();
  rest.append(...cells.slice(cells.indexOf(begins[ROWS])));
  more.append(Object.assign(document.createElement("summary"), { textContent: `${begins.length - ROWS} more` }), rest);
  grid.after(more);
}
