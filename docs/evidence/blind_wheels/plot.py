#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the predicted states of both wheels: plot.py TABLE.csv FILE.png

Left: straight ahead, over the speed of the rim. Right: over the sideslip angle, a line for each speed of the rim. Bars are
95 % confidence intervals of the mean.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[3] / "runs" / "plots"))
import drawing  # noqa: E402

QUANTITIES = ("drawbar pull [N]", "side force [N]", "torque [N m]", "sinkage [mm]")
STYLES = {"smooth": ("o", "-"), "grousers": ("s", "--")}
RIMS = {5: "C0", 10: "C1", 20: "C2"}  # [mm/s]


def line(axis, rows, key, colour, label, style):
    rows = sorted(rows, key=lambda row: float(row[key]))
    axis.errorbar([float(row[key]) for row in rows], [float(row["mean"]) for row in rows],
                  [float(row["half width of 95 %"]) for row in rows], marker=style[0], linestyle=style[1], markersize=4,
                  capsize=3, color=colour, label=label)


def draw(table):
    rows = drawing.rows(table)
    figure = drawing.Figure(figsize=(10, 12))
    axes = figure.subplots(len(QUANTITIES), 2, sharex="col", sharey="row")
    for (left, right), quantity in zip(axes, QUANTITIES):
        for wheel, style in STYLES.items():
            ours = [row for row in rows if row["wheel"] == wheel and row["quantity"] == quantity]
            straight = [row for row in ours if float(row["sideslip [deg]"]) == 0]
            if straight:
                line(left, straight, "rim speed [mm/s]", "k", wheel, style)
            for rim, colour in RIMS.items():
                at_rim = [row for row in ours if float(row["rim speed [mm/s]"]) == rim]
                line(right, at_rim, "sideslip [deg]", colour, f"{wheel}, rim at {rim} mm/s", style)
        left.set_ylabel(quantity)
    axes[1][0].text(0.5, 0.5, "not tabulated straight ahead", ha="center", transform=axes[1][0].transAxes)
    axes[-1][0].set_xscale("symlog", linthresh=5)
    axes[-1][0].set_xticks([0, 3, 5, 10, 20, 40, 100], ["0", "3", "5", "10", "20", "40", "100"])
    axes[-1][0].set_xlabel("speed of the rim [mm/s], towed straight ahead at 10 mm/s")
    axes[-1][1].set_xlabel("sideslip [deg]")
    drawing.legend_above(axes[0][0], 2)
    drawing.legend_above(axes[0][1], 2)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, dpi=110)
