# SPDX-License-Identifier: BSD-3-Clause
"""Plot of a series of events: events.py EVENTS.json FILE.png

Verdict of each event and level (go, partly, no-go) with its reason, and the figures of all levels with 95 % intervals
over the seeds.
"""
import json
import math

import drawing

COLOURS = {"go": "#4c956c", "partly": "#e0a030", "no-go": "#b23a48"}
FIGURES = ("speed [m/s]", "slip [-]", "sinkage mean [m]", "motion resistance [N]", "drive torque [N m]")
LABELS = {"sinkage mean [m]": "mean sinkage [m]", "drive torque [N m]": "drive torque,\nboth sprockets [N m]"}


def word(row):
    return row["verdict"].split(" ")[0]


def label(row):
    name = row["event"].replace("_", " ")
    return name if row["level"] is None else f"{name} {row['level']:g}"


def limits(axis, rows):
    """Verdict marks of each level, in the order of the events."""
    for place, row in enumerate(rows):
        axis.barh(place, 1, color=COLOURS.get(word(row), "#bbbbbb"))
        text = axis.text(0.02, place, ": ".join(filter(None, (row["verdict"], row["why"]))), va="center", fontsize=7, color="white",
                         clip_on=True)
        text.set_in_layout(False)  # error messages may be wider than the figure
    axis.set_yticks(range(len(rows)), [label(row) for row in rows], fontsize=7)
    axis.set_xticks([])
    axis.set_xlim(0, 1)
    axis.set_ylim(len(rows) - 0.5, -0.5)
    axis.grid(False)


def figure_of(axis, rows, name):
    found = [(place, f["mean"], f["half_width"]) for place, row in enumerate(rows) for f in row["figures"]
             if f["name"] == name]
    for place, mean, half in found:
        bar = half if half is not None and math.isfinite(half) else None
        axis.errorbar(mean, place, xerr=bar, fmt="o", markersize=4, capsize=3, color="C0")
    axis.set_yticks(range(len(rows)), [""] * len(rows))
    axis.set_ylim(len(rows) - 0.5, -0.5)
    axis.set_xlabel(LABELS.get(name, name), fontsize=8)
    axis.tick_params(axis="x", labelsize=7)
    return bool(found)


def draw(path):
    with open(path, encoding="utf-8") as file:
        results = json.load(file)
    rows = results["rows"]
    if not rows:
        return None
    names = [name for name in FIGURES if any(f["name"] == name for row in rows for f in row["figures"])]
    figure = drawing.Figure(figsize=(5.0 + 2.0 * len(names), 1.2 + 0.26 * len(rows)))
    axes = figure.subplots(1, 1 + len(names), squeeze=False, width_ratios=[2.2] + [1] * len(names))[0]
    limits(axes[0], rows)
    for axis, name in zip(axes[1:], names):
        figure_of(axis, rows, name)
    figure.suptitle(f"{results['vehicle']} on {results['soil']}, {drawing.repeats(results)}, commit {results['commit']}",
                    fontsize=9)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, dpi=110)
