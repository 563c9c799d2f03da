// The text that the derive writes, set as formulas: letters slanted, words and functions upright.

const WORD = /(\p{L}\p{M}*)((?:\p{L}\p{M}*|_[\p{L}\p{N}]+)*)((?:\[[^[\]]*\])*)|[&<>]/gu;
/// Of more rows than that only the first are seen at once.
const ROWS = 12;

/// Indices, after an underscore or in brackets, stand below.
function formula(text) {
  return text.replace(WORD, (all, letter, rest, indices) => {
    if (!letter) return escaped(all);
    const isWord = rest && !rest.startsWith("_");
    const below = [...(isWord ? [] : rest.split("_").slice(1)), ...[...indices.matchAll(/\[(.*?)\]/g)].map(([, index]) => index)];
    return (isWord ? letter + rest : `<i>${letter}</i>`) + (below.length ? `<sub>${below.join(" ")}</sub>` : "");
  });
}

/// A label, an equation and a remark, each of which may be missing but the equation.
function row(line) {
  const [, label, rest] = line.trim().match(/^(?:((?:[^:=([]|\[[^\]]*\])+):\s+)?(.*)$/u);
  const [, equation, remark] = rest.match(/^(.*?)(?:\s{3}\((.*)\))?$/u);
  const part = (kind, html) => (html ? `<span class="${kind}">${html}</span>` : "");
  return `<div class="row">${part("label", label && formula(label))}${part("equation", formula(equation))}${part("remark", remark && escaped(remark))}</div>`;
}

/// A heading is a line that is not indented; the first line is the name of the system.
function formulas(text) {
  const sections = [];
  for (const line of text.split("\n").slice(1).filter(line => line.trim())) {
    if (line.startsWith(" ")) sections.at(-1).rows.push(row(line));
    else sections.push({ heading: `<h4>${escaped(line)}</h4>`, rows: [] });
  }
  return sections.map(({ heading, rows }) => {
    const [first, rest] = [rows.slice(0, ROWS), rows.slice(ROWS)];
    const more = rest.length ? `<details><summary>${rest.length} more</summary>${rest.join("")}</details>` : "";
    return heading + first.join("") + more;
  }).join("");
}
