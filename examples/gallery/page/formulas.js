// The text that the derive writes, set as formulas: letters slanted, words and functions upright.

const WORD = /(\p{L}\p{M}*)((?:\p{L}\p{M}*|_[\p{L}\p{N}]+)*)|[&<>]/gu;

function formula(text) {
  return text.replace(WORD, (all, letter, rest) => {
    if (!letter) return escaped(all);
    if (rest && !rest.startsWith("_")) return all;
    return `<i>${letter}</i>` + (rest ? `<sub>${rest.slice(1).replace(/_/g, " ")}</sub>` : "");
  });
}

/// A label, an equation and a remark, each of which may be missing but the equation.
function row(line) {
  const [, label, rest] = line.trim().match(/^(?:([^:=(]{1,40}):\s+)?(.*)$/u);
  const [, equation, remark] = rest.match(/^(.*?)(?:\s{3}\((.*)\))?$/u);
  const part = (kind, html) => (html ? `<span class="${kind}">${html}</span>` : "");
  return `<div class="row">${part("label", label && formula(label))}${part("equation", formula(equation))}${part("remark", remark && escaped(remark))}</div>`;
}

/// A heading is a line that is not indented; the first line is the name of the system.
function formulas(text) {
  const lines = text.split("\n").slice(1).filter(line => line.trim());
  return lines.map(line => (line.startsWith(" ") ? row(line) : `<h4>${escaped(line)}</h4>`)).join("");
}
