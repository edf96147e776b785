# SPDX-License-Identifier: BSD-3-Clause
"""Plot of a fit of the soil contact model to virtual tests: scm_fit.py CURVES.csv FILE.png

Pressure over sinkage of each plate and shear stress over displacement of each load: tests thin, fit thick.
"""
import drawing

HEAD = {"plate": ("sinkage [mm]", "pressure [kPa]"), "shear": ("displacement [mm]", "shear stress [kPa]")}


def curves_of(rows):
    """{tests: {test: [(way in mm, measured in kPa, fit in kPa)]}} in the order of the file."""
    curves = {}
    for row in rows:
        curves.setdefault(row["tests"], {}).setdefault(row["test"], []).append(
            (1e3 * float(row["sinkage or displacement [m]"]), 1e-3 * float(row["measured [Pa]"]),
             1e-3 * float(row["fit [Pa]"])))
    return curves


def draw(file):
    rows = drawing.rows(file)
    if not rows:
        return None
    curves = curves_of(rows)
    figure, axes = drawing.panels(2)
    for axis, (kind, (way, stress)) in zip(axes, HEAD.items()):
        for index, name in enumerate(name for name in curves if name.startswith(kind)):
            for points in curves[name].values():
                ways, measured, fit = zip(*points)
                axis.plot(ways, measured, linewidth=0.5, alpha=0.7, color=f"C{index}", label=name)
            longest = max(curves[name].values(), key=lambda points: points[-1][0])
            axis.plot([p[0] for p in longest], [p[2] for p in longest], color=f"C{index}", linewidth=1.8,
                      label=f"{name}, fit")
        axis.set_xlabel(way)
        axis.set_ylabel(stress)
        drawing.legend_above(axis, 2, 10)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, files=1)
