# SPDX-License-Identifier: BSD-3-Clause
"""Mobility map: map.py MAP.json FILE.png

Go or no-go of an event over its levels and the values of a key. Cells: mean speed / commanded speed. Band: limit
between go and no-go. Dashed line: bound by the closed form.
"""
import json
import math

import drawing

MARKS = {"go": ("o", "#1d3d26"), "partly": ("D", "#7a5200"), "no-go": ("x", "#b23a48")}
SPEED = "speed [m/s]"


def numbers(words):
    """Values as numbers, or None if any is not numeric."""
    try:
        return [float(word) for word in words]
    except ValueError:
        return None


def edges(centres):
    """Cell edges midway between the centres."""
    middles = [(a + b) / 2 for a, b in zip(centres, centres[1:])]
    return [2 * centres[0] - middles[0], *middles, 2 * centres[-1] - middles[-1]]


def speed(row, commanded):
    means = [f["mean"] for f in row["figures"] if f["name"] == SPEED]
    return means[0] / commanded if means and commanded > 0 else math.nan


def column_of(column):
    """Rows of a column by increasing level."""
    return sorted(column["rows"], key=lambda row: row["level"])


def band(column, levels):
    """Hardest go and easiest no-go, or the ends of the levels, which are sorted from easiest to hardest."""
    limit = column["limits"][0] if column["limits"] else {"go": None, "no_go": None}
    if limit["go"] is None and limit["no_go"] is None:
        return math.nan, math.nan
    low = levels[0] if limit["go"] is None else limit["go"]
    return low, levels[-1] if limit["no_go"] is None else limit["no_go"]


def draw(path):
    with open(path, encoding="utf-8") as file:
        results = json.load(file)
    columns = results["columns"]
    values = numbers([column["value"] for column in columns])
    order = sorted(range(len(columns)), key=lambda i: values[i]) if values else range(len(columns))
    columns = [columns[i] for i in order]
    places = sorted(values) if values else list(range(len(columns)))
    levels = [row["level"] for row in column_of(columns[0])]
    figure = drawing.Figure(figsize=(8.0, 5.5))
    axis = figure.subplots()
    axis.grid(False)
    shares = [[speed(column_of(column)[i], column["speed_m_s"]) for column in columns] for i in range(len(levels))]
    cells = axis.pcolormesh(edges(places), edges(levels), shares, cmap="YlGn", vmin=0, vmax=1)
    figure.colorbar(cells, ax=axis, label="speed / commanded speed [-]")
    for place, column in zip(places, columns):
        for row in column_of(column):
            mark, colour = MARKS.get(row["verdict"].split(" ")[0], ("", "#888888"))
            axis.plot(place, row["level"], mark, color=colour, markersize=8, markeredgewidth=2)
            if not mark:
                axis.text(place, row["level"], row["verdict"], ha="center", va="center", fontsize=7)
    easiest_first = [row["level"] for row in columns[0]["rows"]]
    bands = [band(column, easiest_first) for column in columns]
    axis.fill_between(places, [low for low, _ in bands], [high for _, high in bands], color="#3060a0", alpha=0.25,
                      label="limit between go and no-go")
    axis.plot(places, [(low + high) / 2 for low, high in bands], color="#3060a0")
    blocks = [column["limits"][0]["blocks"] if column["limits"] else None for column in columns]
    if any(block is not None for block in blocks):
        axis.plot(places, [math.nan if block is None else block for block in blocks], "--", color="black",
                  label="bound (closed form)")
    for verdict, (mark, colour) in MARKS.items():
        if any(row["verdict"].startswith(verdict) for column in columns for row in column["rows"]):
            axis.plot([], [], mark, color=colour, markeredgewidth=2, label=verdict)
    axis.set_ylim(edges(levels)[0], max([edges(levels)[-1], *(1.05 * b for b in blocks if b is not None)]))
    margin = 0.04 * (places[-1] - places[0])
    axis.set_xlim(places[0] - margin, places[-1] + margin)
    axis.set_xlabel(results["key"])
    axis.set_ylabel(results["level_is"])
    if not values:
        axis.set_xticks(places, [column["value"] for column in columns])
    drawing.legend_above(axis, columns=5)
    figure.suptitle(f"{results['title']}: {results['vehicle']} on {results['soil']}, ground {results['ground']}, "
                    f"commit {results['commit']}", fontsize=9)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, dpi=110)
