# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the impact study: study_impact.py IMPACT.csv FILE.png

Maximum error over CPU time per collision: rows for the plane and for two grains, one column per quantity, one line per
law and precision; 10, 1 and 0.1 % as dashed lines.
"""
import drawing

QUANTITIES = ("restitution", "duration", "overlap")
TITLES = {"restitution": "restitution, absolute error", "duration": "duration, relative error",
          "overlap": "overlap, relative error"}
COLOURS = {"linear free": "tab:blue", "linear clamped": "tab:orange", "Hertz free": "tab:green", "Hertz clamped": "tab:red"}


def wanted(law, damping):
    return law.startswith("Hertz") or damping in ("0", "0.2")


def draw(path):
    lines = {}
    for row in drawing.rows(path):
        surface, law, kind = row["case"].split(", ")
        if not wanted(law, kind.split()[1]) or not float(row["CPU time of a collision [us]"]):
            continue
        for quantity in QUANTITIES:
            error = row[f"{quantity} worst error [-]"]
            if error and error != "-" and float(error) > 0:
                key = (surface, quantity, law, kind, row["precision"])
                lines.setdefault(key, []).append((float(row["CPU time of a collision [us]"]), float(error)))
    figure = drawing.Figure(figsize=(9.8, 5.8))
    panels = figure.subplots(2, 3, sharey="col")
    for (surface, quantity, law, kind, precision), points in lines.items():
        axis = panels[0 if surface == "plane" else 1][QUANTITIES.index(quantity)]
        elastic = kind.split()[1] == "0"
        axis.loglog(*zip(*points), color=COLOURS[law], linestyle=":" if elastic else "-", linewidth=1,
                    marker="o" if precision == "single" else "x", markersize=3,
                    label=f"{law}, {kind}" if precision == "single" else None)
    for row, surface in zip(panels, ("sphere on plane", "two spheres")):
        for axis, quantity in zip(row, QUANTITIES):
            axis.set_title(f"{surface}, {TITLES[quantity]}", fontsize=9)
            axis.tick_params(labelsize=7)
            axis.minorticks_off()
            axis.grid(False)
            for level in (1e-1, 1e-2, 1e-3):
                axis.axhline(level, color="black", linewidth=0.5, linestyle="--")
    panels[0][0].legend(fontsize=6)
    figure.supxlabel("CPU time per collision [us], one core; circles: single, crosses: double precision", fontsize=9)
    figure.supylabel("maximum error over the phase of first contact [-]", fontsize=9)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, dpi=58)
