"use strict";
// How names of programs and numbers are written for people.

const GREEK = Object.fromEntries(
  ("alpha α beta β gamma γ delta δ epsilon ε theta θ kappa κ lambda λ mu μ nu ν phi φ psi ψ omega ω rho ρ sigma σ tau τ " +
    "Omega Ω Gamma Γ Delta Δ Theta Θ Phi Φ Psi Ψ energy E").split(" ").reduce(
    (pairs, word, i, words) => (i % 2 ? pairs : [...pairs, [word, words[i + 1]]]), []));

/// A letter or the name of one, and the digits behind it.
function apart(word) {
  const [, letter, digits] = word.match(/^(.*?)(\d*)$/);
  return digits && (GREEK[letter] || letter.length === 1) ? [letter, digits] : [word];
}

function escaped(text) {
  return text.replace(/[&<>]/g, sign => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;" })[sign]);
}

/// `theta_1` and `theta1` as θ with an index, `no_slip` as two words.
function pretty(name) {
  const [, base, indices] = name.match(/^([^[]*)(.*)$/);
  const [first, ...rest] = base.split("_").flatMap((word, k) => (k === 0 ? apart(word) : [word]));
  const below = [...rest.map(word => GREEK[word] ?? word), ...[...indices.matchAll(/\d+/g)].map(([digit]) => digit)];
  const letter = GREEK[first] ?? first;
  if ([...letter].length === 1) return `<i>${escaped(letter)}</i>` + (below.length ? `<sub>${escaped(below.join(" "))}</sub>` : "");
  return escaped([letter, ...below].join(" "));
}

/// With a real minus sign.
function minus(text) {
  return text.replace(/-/g, "−");
}

/// So many digits after the point, with a real minus sign and no negative zero.
function fixed(value, digits) {
  return minus((Math.abs(value) < 0.5 * 10 ** -digits ? 0 : value).toFixed(digits));
}

function superscript(power) {
  return [...String(power)].map(digit => (digit === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit])).join("");
}

/// 1, 2 or 5 times a power of ten, the largest below.
function nice(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  const lead = value / power;
  return power * (lead >= 5 ? 5 : lead >= 2 ? 2 : 1);
}
