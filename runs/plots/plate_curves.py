# SPDX-License-Identifier: BSD-3-Clause
"""Plot of a calibration on plates: plate_curves.py CURVES.csv POINTS.csv FILE.png

Pressure over sinkage of each plate: simulated (one thin line per seed) and measured (mean and standard deviation).
"""
import drawing


def draw_plates(axis, curves, points):
    diameters = sorted({float(row["diameter [m]"]) for row in points})
    for index, diameter in enumerate(diameters):
        colour, lines, means = f"C{index}", {}, {}
        for row in curves:
            if float(row["diameter [m]"]) == diameter:
                lines.setdefault(row["seed"], []).append((1e3 * float(row["sinkage [m]"]), 1e-3 * float(row["pressure [Pa]"])))
        for number, line in enumerate(lines.values()):
            axis.plot(*zip(*line), linewidth=0.6, alpha=0.7, color=colour,
                      label=None if number else f"{1e3 * diameter:.0f} mm, simulated")
        for row in points:
            if float(row["diameter [m]"]) == diameter:
                means[1e3 * float(row["sinkage [m]"])] = [1e-3 * float(row[key]) for key in
                                                          ("measured mean [Pa]", "measured deviation [Pa]")]
        axis.errorbar(list(means), [m[0] for m in means.values()], [m[1] for m in means.values()], fmt="o", markersize=4,
                      capsize=3, color=colour, label=f"{1e3 * diameter:.0f} mm, measured")
    axis.set_xlim(left=0)
    axis.set_ylim(bottom=0)
    axis.set_xlabel("sinkage [mm]")
    axis.set_ylabel("pressure [kPa]")
    drawing.legend_above(axis, 3, 7)


def draw(curves, points):
    figure, axes = drawing.panels(1)
    draw_plates(axes[0], drawing.rows(curves), drawing.rows(points))
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, files=2)
