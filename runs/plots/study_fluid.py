# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the fluid study: study_fluid.py FLUID.csv FILE.png

Two panels per case: errors over particle spacing and over wall time; tolerances as dashed lines.
"""
import drawing

COLOURS = ("tab:blue", "tab:orange", "tab:green")


def draw(path):
    cases = {}
    for row in drawing.rows(path):
        error = max(float(row["error [-]"]), 1e-12)
        point = float(row["spacing [m]"]), float(row["wall time [s]"]), error, float(row["bar [-]"])
        cases.setdefault(row["case"], {}).setdefault(row["quantity"], []).append(point)
    rows = (len(cases) + 1) // 2
    figure = drawing.Figure(figsize=(11, 2.2 * rows + 0.4), layout="constrained")
    panels = figure.subplots(rows, 4, squeeze=False).reshape(-1, 2)
    for pair, (case, quantities) in zip(panels, cases.items()):
        for colour, (quantity, points) in zip(COLOURS, quantities.items()):
            spacing, seconds, error, bar = zip(*points)
            for axis, x in zip(pair, (spacing, seconds)):
                axis.loglog(x, error, color=colour, marker="o", markersize=3, linewidth=1, label=quantity)
                if bar[0] > 0:
                    axis.axhline(bar[0], color=colour, linewidth=0.6, linestyle="--")
        for axis, label in zip(pair, ("spacing [m]", "wall time [s]")):
            axis.set_xlabel(label, fontsize=8)
            axis.set_ylabel("relative error [-]", fontsize=8)
            axis.tick_params(labelsize=7)
            axis.minorticks_off()
        pair[0].set_xticks(spacing, [f"{x:g}" for x in spacing])
        pair[0].set_title(case, fontsize=9)
        pair[0].legend(fontsize=6)
    for pair in panels[len(cases):]:
        for axis in pair:
            axis.remove()
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, dpi=80)
