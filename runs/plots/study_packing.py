# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the packing study: study_packing.py PACKING.csv FILE.png

Solid fraction and coordination over friction, one point per sample, known limits as bands and lines.
"""
import drawing


def draw(path):
    rows = drawing.numbers(path)
    friction = [row["friction [-]"] for row in rows]
    figure = drawing.Figure(figsize=(8, 3.4))
    left, right = figure.subplots(1, 2)
    left.plot(friction, [row["solid fraction [-]"] for row in rows], "o", markersize=3, color="tab:blue")
    left.axhspan(0.634, 0.64, color="tab:green", alpha=0.3, label="random close packing, no friction")
    left.axhspan(0.58, 0.62, color="tab:orange", alpha=0.2, label="poured with friction")
    left.axhline(0.55, color="black", linestyle=":", linewidth=1, label="random loose packing")
    left.set_ylabel("solid fraction [-]")
    right.plot(friction, [row["coordination without rattlers [-]"] for row in rows], "o", markersize=3,
               color="tab:blue", label="without rattlers")
    right.plot(friction, [row["coordination [-]"] for row in rows], "x", markersize=3, color="tab:gray", label="all grains")
    right.axhline(6, color="tab:green", linewidth=1, label="isostatic, no friction")
    right.axhline(4, color="black", linestyle=":", linewidth=1, label="isostatic, infinite friction")
    right.set_ylabel("contacts per grain [-]")
    for axis in (left, right):
        axis.set_xlabel("friction [-]")
        axis.legend(fontsize=7)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw)
