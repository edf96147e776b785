# SPDX-License-Identifier: BSD-3-Clause
"""Plot of a comparison: compare.py COMPARE.json FILE.png

One panel per figure, with a bar and 95 % interval for each variant (a kind of ground, or a contact method and a multiple
of its step), and the wall time per simulated second.
"""
import json
from pathlib import Path

import drawing

COLOURS = {"rigid": "#8a8d91", "scm": "#b0763a", "granular": "#d8b365", "penalty": "#4c72b0",
           "complementarity": "#c44e52"}
# (name of the figure, label, factor)
PANELS = (
    ("speed [m/s]", "speed [m/s]", 1),
    ("slip [-]", "slip [-]", 1),
    ("sinkage mean [m]", "mean sinkage [mm]", 1000),
    ("drive torque [N m]", "drive torque [kN m]", 1e-3),
    ("motion resistance [N]", "motion resistance [kN]", 1e-3),
    ("drawbar pull [N]", "drawbar pull [kN]", 1e-3),
    ("pitch mean [deg]", "pitch (nose up positive) [deg]", 1),
)


def bars(axis, label, variants, values, halves):
    places = range(len(variants))
    axis.bar(places, [value if value is not None else 0 for value in values], width=0.6,
             color=[COLOURS.get(v.split("_x")[0], "C0") for v in variants])
    for place, value, half in zip(places, values, halves):
        if value is None:
            axis.text(place, 0, "none", ha="center", va="bottom", fontsize=7)
        elif half:
            axis.errorbar(place, value, yerr=half, color="black", capsize=3)
    axis.axhline(0, color="black", linewidth=0.6)
    tilt = {"rotation": 45, "ha": "right"} if len(variants) > 3 else {}
    axis.set_xticks(places, variants, fontsize=8, **tilt)
    axis.set_ylabel(label, fontsize=8)
    axis.tick_params(axis="y", labelsize=7)
    axis.grid(False, axis="x")
    axis.margins(y=0.15)


def draw(path):
    with open(path, encoding="utf-8") as file:
        results = json.load(file)
    variants = [v["variant"] for v in results["variants"]]
    rows = {row["figure"]: row["means"] for row in results["rows"]}
    panels = [(label, factor, rows[name]) for name, label, factor in PANELS
              if any(mean["mean"] is not None for mean in rows.get(name, ()))]
    if not panels:  # no vehicle: forces of the grains on surfaces and meshes
        panels = [(name, 1, means) for name, means in rows.items()
                  if " force " in name and any(mean["mean"] for mean in means)][:7]
    if not panels:
        return None
    columns = 4
    figure = drawing.Figure(figsize=(2.6 * columns, 2.6 * ((len(panels) + columns) // columns)))
    axes = list(figure.subplots((len(panels) + columns) // columns, columns, squeeze=False).flatten())
    for axis, (label, factor, means) in zip(axes, panels):
        bars(axis, label, variants, *([None if mean[key] is None else factor * mean[key] for mean in means]
                                     for key in ("mean", "half_width")))
    bars(axes[len(panels)], "wall time per simulated\nsecond [s]", variants,
         [g["wall_time_per_second"] for g in results["variants"]],
         [None] * len(variants))
    for axis in axes[len(panels) + 1:]:
        axis.set_visible(False)
    figure.suptitle(f"{Path(results['scene']).stem}: means over the steady part", fontsize=9)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, dpi=110)
