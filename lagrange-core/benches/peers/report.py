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
class Table:
    """Cells of text; `head` has one more at the left, above the names of the rows."""

    caption: str
    head: list
    rows: list

    def markdown(self):
        rule = ["---"] + ["---:"] * (len(self.head) - 1)
        return "\n".join([f"**{self.caption}**", "", *map(line, [self.head, rule, *self.rows])])


@dataclass
class Section:
    """One row of the comparison: text, tables, bars, and what is missing."""

    title: str
    parts: list = field(default_factory=list)
    bars: list = field(default_factory=list)
    missing: list = field(default_factory=list)

    def table(self, caption, head, rows):
        self.parts.append(Table(caption, head, [[str(cell) for cell in cells] for cells in rows]))

    def text(self, words):
        self.parts.append(words)

    def captioned(self, caption):
        """The table of this caption; an empty one where that is missing."""
        tables = (part for part in self.parts if isinstance(part, Table) and part.caption == caption)
        return next(tables, Table(caption, [], []))

    def names(self, caption):
        """Of the rows of a table."""
        return [cells[0] for cells in self.captioned(caption).rows]

    def cell(self, caption, column, name):
        table = self.captioned(caption)
        return next((cells[table.head.index(column)] for cells in table.rows if cells[0] == name), "–")

    def markdown(self):
        parts = [f"## {self.title}", *(part if isinstance(part, str) else part.markdown() for part in self.parts)]
        if self.bars:
            head = ["| bar | reached | limit | |", "|---|---:|---:|---|"]
            parts.append("\n".join(head + [bar.line() for bar in self.bars]))
        for name, reason in dict.fromkeys(map(tuple, self.missing)):
            parts.append(f"Missing: {name}: {reason}.")
        return "\n\n".join(parts)


def line(cells):
    return "| " + " | ".join(cells) + " |"


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
