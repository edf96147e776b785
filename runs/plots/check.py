# SPDX-License-Identifier: BSD-3-Clause
"""Plot of a check: check.py CHECK.json COSTS.json FILE.png

Error over the wall time of a run, for up to six figures: time steps with their error bars as a line, other axes as
changes with 95 % intervals. Failed and rejected runs are crosses at the upper edge, at their expected run time. Lines
at 10, 5 and 1 %.
"""
import json
import math
import pathlib

import drawing

DOUBTFUL = {"markerfacecolor": "none"}
AXES = {"depth": ("s", "C1"), "width": ("D", "C2"), "floor": ("v", "C3"), "grain_size": ("^", "C4"),
        "spheres": ("P", "C5"), "precision": ("*", "C6"), "node_spacing": ("h", "C7"), "parameter": ("X", "C8")}
MOST = 6
LEAST = 5e-3  # relative error; smaller errors are drawn at the lower edge


def share(number, value):
    return None if number is None or not value else abs(number) / abs(value)


def is_doubtful(figure):
    """Whether a figure is marked inconclusive; values that are 0 in all runs are certain."""
    return bool(figure.get("inconclusive")) and not figure["value"] == figure["bar"] == 0


def ticks_between(low, high, most=5):
    """Ticks of a logarithmic axis with room for their labels: 1, 2, 5 or 1 per decade, or few evenly spaced ones."""
    for digits in ((1, 2, 5), (1,)):
        places = [digit * 10.0**power for power in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
                  for digit in digits if low <= digit * 10.0**power <= high]
        if 2 <= len(places) <= most:
            return places
    if len(places) > most:
        return places[::math.ceil(len(places) / most)]
    return [float(f"{low * (high / low)**share:.2g}") for share in (0.1, 0.5, 0.9)]


def panel(axis, figure, check, costs):
    value, doubtful = figure["value"], is_doubtful(figure)
    incomplete = {case["name"] for case in check["cases"] if case["status"] == "incomplete"}
    cost = {case["name"]: case for case in costs["cases"]}
    base = cost["base"]["wall_s"]
    steps = [(cost[name]["wall_s"], share(bar, value), name)
             for name, bar in zip(check["step_cases"], figure["bar_of_step"]) if share(bar, value)]
    steps.sort()
    if steps:
        axis.plot([s[0] for s in steps], [s[1] for s in steps], "o-", color="C0", label="time step, with error bar",
                  markevery=[not doubtful and name not in incomplete for _, _, name in steps])
        for wall, error, name in steps:
            if doubtful or name in incomplete:
                axis.plot([wall], [error], "o", color="C0", **DOUBTFUL)
            axis.annotate(name.replace("step_", "").replace("_", " "), (wall, error), fontsize=7,
                          textcoords="offset points", xytext=(4, 4))
    of_axis = {case["axis"]: case["name"] for case in check["cases"]}
    for error in figure["errors"]:
        if error["axis"] not in AXES or error["change"] is None:
            continue
        marker, colour = AXES[error["axis"]]
        size, half = share(error["change"], value), share(error["half_width"], value)
        wall = cost[of_axis[error["axis"]]]["wall_s"]
        look = DOUBTFUL if doubtful or of_axis[error["axis"]] in incomplete else {}
        if wall is None or not size:
            continue
        low = max(size - (half or 0), min(LEAST, size))
        axis.errorbar([wall], [size], yerr=[[size - low], [half or 0]], marker=marker,
                      color=colour, capsize=3, linestyle="none", label=error["axis"].replace("_", " "), **look)
    for case in check["cases"]:
        if case["status"] in ("failed", "refused"):
            axis.plot([base * cost[case["name"]]["expected_over_base"]], [0.97], "x", color="red", markersize=9,
                      transform=axis.get_xaxis_transform(), clip_on=False)
            axis.annotate(f"{case['name'].replace('step_', '').replace('_', ' ')}\n{case['status']}",
                          (base * cost[case["name"]]["expected_over_base"], 0.93), color="red", fontsize=7, ha="center",
                          va="top", xycoords=axis.get_xaxis_transform())
    half = figure["seeds_half_width"]
    if check["seeds_matter"] and half is not None and share(half, value):
        axis.axhline(share(half, value), color="0.4", linestyle="--", linewidth=0.8,
                     label=f"seeds ({figure['seeds']})")
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.margins(x=0.2)
    axis.set_ylim(bottom=LEAST, top=max(0.15, 1.6 * axis.get_ylim()[1]))
    for percent in (10, 5, 1):
        axis.axhline(percent / 100, color="0.75", linewidth=0.8, zorder=0)
        axis.annotate(f"{percent} %", (1, percent / 100), fontsize=6, color="0.5", ha="right", va="bottom",
                      xycoords=axis.get_yaxis_transform())
    axis.set_xticks(ticks_between(*axis.get_xlim()))
    axis.xaxis.set_major_formatter(lambda wall, _: f"{wall:g}")
    axis.xaxis.set_minor_formatter(lambda wall, _: "")
    axis.tick_params(axis="x", which="both", labelsize=7)
    axis.set_title(figure["name"] + (" (inconclusive)" if doubtful else ""), fontsize=9)
    axis.grid(True, which="major", color="0.93")


def draw(check_path, costs_path):
    with open(check_path) as file:
        check = json.load(file)
    with open(costs_path) as file:
        costs = json.load(file)
    if costs["cases"][0]["wall_s"] is None:
        return None
    figures = [f for f in check["figures"] if f.get("headline") and f["value"] and (
        any(f["bar_of_step"]) or any(e["axis"] in AXES and e["change"] for e in f["errors"]))][:MOST]
    if not figures:
        return None
    columns = min(3, len(figures))
    rows = math.ceil(len(figures) / columns)
    figure = drawing.Figure(figsize=(4.3 * columns, 3.6 * rows + 0.8))
    panels = figure.subplots(rows, columns, squeeze=False).flatten()
    for axis, one in zip(panels, figures):
        panel(axis, one, check, costs)
    for axis in panels[len(figures):]:
        axis.set_visible(False)
    for row in range(rows):
        panels[row * columns].set_ylabel("error / value [-]")
    for axis in panels[:len(figures)][-columns:]:
        axis.set_xlabel("wall time of a run [s]")
    doubts = "; open: inconclusive or incomplete" if any(map(is_doubtful, figures)) or any(
        case["status"] == "incomplete" for case in check["cases"]) else ""
    figure.suptitle(f"{pathlib.PurePath(check['scene']).name}: error against run time{doubts}", fontsize=10)
    drawing.legend_below(figure, panels[:len(figures)])
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, files=2, dpi=110)
