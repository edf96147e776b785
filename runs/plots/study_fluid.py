# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the study of the fluid: study_fluid.py FLUID.csv FILE.png

A column a case: errors against the spacing above, against the wall time below; bars as dashed lines.
"""
import drawing

COLOURS = ("tab:blue", "tab:orange", "tab:green")


def draw(path):
    cases = {}
    for row in drawing.rows(path):
        error = max(float(row["error [-]"]), 1e-12)
        point = float(row["spacing [m]"]), float(row["wall time [s]"]), error, float(row["bar [-]"])
        cases.setdefault(row["case"], {}).setdefault(row["quantity"], []).append(point)
    figure = drawing.Figure(figsize=(max(4, 2.6 * len(cases)), 5.2))
    panels = figure.subplots(2, len(cases), squeeze=False)
    for column, (case, quantities) in zip(panels.T, cases.items()):
        for colour, (quantity, points) in zip(COLOURS, quantities.items()):
            spacing, seconds, error, bar = zip(*points)
            for axis, x in zip(column, (spacing, seconds)):
                axis.loglog(x, error, color=colour, marker="o", markersize=3, linewidth=1, label=quantity)
                if bar[0] > 0:
                    axis.axhline(bar[0], color=colour, linewidth=0.6, linestyle="--")
                axis.tick_params(labelsize=7)
        column[0].set_title(case, fontsize=9)
        column[0].legend(fontsize=6)
        column[0].set_xlabel("spacing [m]", fontsize=8)
        column[1].set_xlabel("wall time [s]", fontsize=8)
    panels[0][0].set_ylabel("relative error [-]", fontsize=8)
    panels[1][0].set_ylabel("relative error [-]", fontsize=8)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, dpi=80)
