"""Tables of `examples/ensemble_tables.rs`, read by polars (Parquet) and pandas (JSON lines): the same numbers to the bit, and those of springs.

with_polars.py COUNT FOLDER
"""

import json
import sys

import numpy as np
import pandas as pd
import polars as pl

COUNT, FOLDER = int(sys.argv[1]), sys.argv[2]
ENERGY, SLOWNESS = "energy", '1/v, "slowness"'

members = pl.read_parquet(f"{FOLDER}/parquet/*.parquet").sort("member")
assert members["member"].equals(pl.Series("member", range(COUNT)))


def long(column):
    """One row for each entry of a list, with the member's number and parameters."""
    lists = members.select("member", "parameters", column).filter(pl.col(column).list.len() > 0)
    table = lists.explode(column).unnest(column, "parameters")
    return table.unnest("state") if "state" in table.columns else table


def from_json(column):
    """The same from JSON lines, where infinities are texts."""
    with open(f"{FOLDER}/json.jsonl") as lines:
        entries = [entry | entry.pop("state", {}) | {"member": row["member"]} for row in map(json.loads, lines) for entry in row[column]]
    return pd.DataFrame(entries)


def same(column):
    parquet, lines = long(column), from_json(column)
    names = list(lines.columns)
    for name in names:
        one, other = parquet[name].to_numpy(), lines[name].to_numpy()
        assert len(one) == len(other)
        bits = one.view(np.int64) == other.astype(one.dtype).view(np.int64) if one.dtype == float else one == other
        assert bits.all(), f"{column}.{name}"
    print(f"{column}: {len(parquet)} of {', '.join(names)} are the same to the bit")
    return parquet


samples = same("samples")
omega = samples["k"].sqrt()
x, v = (omega * samples["t"]).cos(), -omega * (omega * samples["t"]).sin()
off = max((samples["x"] - x).abs().max(), ((samples["x_dot"] - v) / omega).abs().max())
energy_off = ((samples[ENERGY] - samples["k"] / 2) / samples["k"]).abs().max()
assert samples[SLOWNESS].equals(1 / samples["x_dot"], null_equal=True) and samples[SLOWNESS].is_infinite().any()
crossings = same("crossings")
zeros = crossings.filter(event="zero")
zero = (zeros["count"] - 0.5) * np.pi / zeros["k"].sqrt()
zero_off = (zeros["t"] - zero).abs().max()
assert (zeros["rising"] == (zeros["count"] % 2 == 0)).all()
ends = crossings.filter(event='end, "early"')
end_off = (ends["t"] - 0.01 * (ends["member"] % 100)).abs().max()
print(f"off by {off:.1e} in x and v/ω, {energy_off:.1e} of k in energy, {zero_off:.1e} and {end_off:.1e} in times of events")
assert off < 1e-7 and energy_off < 1e-7 and zero_off < 1e-7 and end_off < 1e-12
# As many samples as the motion is long.
counts = members.filter(pl.col("end").is_not_null()).select(
    pl.col("samples").list.len().alias("count"), pl.col("end").struct.field("t").alias("t")
)
expected = np.floor(np.nextafter(counts["t"].to_numpy() / 0.1, np.inf)) + 1
assert (counts["count"].to_numpy() == expected).all()
assert members.filter(pl.col("end").is_null())["samples"].list.len().sum() == 0
