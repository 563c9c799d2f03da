// The equations, as the derive writes them for browsers.

/// Of more rows than that only the first are seen at once.
const ROWS = 12;

function showEquations(place, html) {
  place.innerHTML = html;
  place.querySelectorAll(".equations > div").forEach(fold);
  const headings = [...place.querySelectorAll("h5")];
  element("parts").replaceChildren(...headings.map(linkTo));
  showMotion(headings.find(({ textContent }) => textContent === "Equations of motion"));
}

/// The Lagrangian at the top of the panel, unless the first equation of motion were out of sight then.
function showMotion(heading) {
  const panel = element("equations");
  panel.scrollTop = 0;
  const [bottom, rows] = [panel.getBoundingClientRect().bottom, heading?.nextElementSibling];
  const first = rows?.querySelector("math") ?? rows;
  if (first && first.getBoundingClientRect().bottom + 16 > bottom) panel.scrollBy(0, heading.offsetTop - element("parts").offsetHeight);
}

/// A button that brings a heading to the top of its panel, or of the page where that does not scroll.
function linkTo(heading) {
  const button = Object.assign(document.createElement("button"), { textContent: heading.textContent });
  button.addEventListener("click", () => heading.scrollIntoView({ block: "start" }));
  return button;
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
