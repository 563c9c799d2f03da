"""The tables as Markdown, and the bars with what was reached."""

from dataclasses import dataclass, field

from timing import Ratio


@dataclass
class Bar:
    """What was to be reached, and what was."""

    what: str
    reached: float
    limit: float
    beside: str = ""
    at_least: bool = False

    @property
    def passes(self):
        return self.reached >= self.limit if self.at_least else self.reached <= self.limit

    def line(self):
        sign, verdict = "≥" if self.at_least else "≤", "pass" if self.passes else "**fail**"
        return f"| {self.what} | {self.reached:.3g}{self.beside} | {sign} {self.limit:g} | {verdict} |"


@dataclass
class Section:
    """One row of the comparison: text, tables, bars, and what is missing."""

    title: str
    parts: list = field(default_factory=list)
    bars: list = field(default_factory=list)
    missing: list = field(default_factory=list)

    def table(self, caption, head, rows):
        lines = [f"**{caption}**", "", line(head), line(["---"] + ["---:"] * (len(head) - 1)), *map(line, rows)]
        self.parts.append("\n".join(lines))

    def text(self, words):
        self.parts.append(words)

    def markdown(self):
        parts = [f"## {self.title}", *self.parts]
        if self.bars:
            head = ["| bar | reached | limit | |", "|---|---:|---:|---|"]
            parts.append("\n".join(head + [bar.line() for bar in self.bars]))
        for name, reason in dict.fromkeys(self.missing):
            parts.append(f"Missing: {name}: {reason}.")
        return "\n\n".join(parts)


def line(cells):
    return "| " + " | ".join(map(str, cells)) + " |"


def number(value):
    return f"{value:.0f}" if value >= 100 else f"{value:.1f}"


def against(one, other):
    """A cell: nanoseconds, and how much longer `one` takes than what the cell is about."""
    return number(other.least) if one is other else f"{number(other.least)} · {Ratio.of(one, other)}"


def comparison(section, caption, columns):
    """A table with an implementation a line; `columns` maps a heading to its timings, ours first."""
    names = list(dict.fromkeys(timing.name for timings in columns.values() for timing in timings))

    def cell(name, timings):
        return next((against(timings[0], one) for one in timings if one.name == name), "–")

    section.table(
        caption, ["", *columns], [[name, *(cell(name, timings) for timings in columns.values())] for name in names]
    )


def fastest(timings, kinds, names=None):
    """The one with the least time among those of a kind, or of some names."""
    chosen = [one for one in timings if one.implementation.kind in kinds and (names is None or one.name in names)]
    return min(chosen, key=lambda one: one.least, default=None)


def bar(section, what, timings, other, limit):
    """Ours, which is first, takes at most `limit` times as long as another."""
    if other is None:
        section.text(f"{what}: nothing to compare with.")
        return
    ratio = Ratio.of(timings[0], other)
    section.bars.append(Bar(f"{what}: {other.name}", ratio.least, limit, f" ({ratio.median:.3g})"))
