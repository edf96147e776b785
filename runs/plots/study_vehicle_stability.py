# SPDX-License-Identifier: BSD-3-Clause
"""Stability maps of a vehicle: study_vehicle_stability.py VEHICLE.csv LIMITS.csv FILE.png

One panel per map. Points: sound (blue), stopped by a guard for the right (orange square) or a wrong cause (purple
diamond), silently wrong (red cross), scattering like neighbouring steps (green triangle), wrong with a warning about
impacts (olive triangle), rejected before the run (grey x). Lines: predicted limits. Logarithmic axes show 0 at their
left end.
"""
import itertools
import math
import textwrap

import drawing

VERDICTS = {"sound": dict(color="tab:blue", marker="o"), "stopped": dict(color="tab:orange", marker="s"),
            "refused": dict(color="tab:gray", marker="x"), "wrong cause": dict(color="tab:purple", marker="D"),
            "scatters": dict(color="tab:green", marker="^"), "warned": dict(color="tab:olive", marker="v"),
            "silently wrong": dict(color="red", marker="X", s=90)}
STYLES = ("-", "--", ":", "-.")


def panel(axis, of, limits, styles):
    for verdict, style in VERDICTS.items():
        places = [(float(row["x"]), float(row["y"])) for row in of if row["verdict"] == verdict]
        if places:
            axis.scatter(*zip(*places), **{"s": 30, "zorder": 3, **style}, label=verdict)
    for line in dict.fromkeys(row["line"] for row in limits):
        along = [(float(row["x"]), float(row["y"])) for row in limits if row["line"] == line]
        axis.plot(*zip(*along), color="black", linestyle=styles[line], linewidth=1, label=line)
    if limits and limits[0]["logarithmic x"] == "1":
        axis.set_xscale("log")
    if limits and limits[0]["logarithmic y"] == "1":
        axis.set_yscale("log")
    axis.set_title(textwrap.fill(limits[0]["title"] if limits else of[0]["map"], 42), fontsize=9)
    axis.set_xlabel(textwrap.fill(of[0]["x axis"], 40), fontsize=8)
    axis.set_ylabel(textwrap.fill(of[0]["y axis"], 36), fontsize=8)
    axis.tick_params(which="both", labelsize=7)


def draw(*paths):
    points, limits = (list(drawing.rows(path)) for path in paths)
    names = list(dict.fromkeys(row["map"] for row in points))
    if not names:
        return None
    columns = math.ceil(math.sqrt(len(names) + 1))
    rows = -(-(len(names) + 1) // columns)
    figure = drawing.Figure(figsize=(3.4 * columns, 3.1 * rows))
    styles = dict(zip(dict.fromkeys(row["line"] for row in limits), itertools.cycle(STYLES)))
    axes = figure.subplots(rows, columns, squeeze=False).flatten()
    for axis, name in zip(axes, names):
        panel(axis, [r for r in points if r["map"] == name], [r for r in limits if r["map"] == name], styles)
    for axis in axes[len(names):]:
        axis.set_axis_off()
    seen = {label: line for axis in axes for line, label in zip(*axis.get_legend_handles_labels())}
    axes[len(names)].legend(seen.values(), seen.keys(), fontsize=7, loc="center")
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, files=2, dpi=80)
