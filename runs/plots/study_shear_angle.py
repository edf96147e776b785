# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the friction angle study: study_shear_angle.py SHEAR_ANGLE.csv RUNS_FOLDER FILE.png

Shear stress / normal stress and porosity of the core over strain, one line per sample, one colour per load.
"""
import drawing


def draw(table, folder):
    runs = [((float(rolling), float(stress)), rows[1:])
            for (rolling, stress), rows in drawing.runs(folder, "rolling(.+)_stress(.+)_seed.+")]
    if not runs:
        return None
    figure, (left, right) = drawing.panels(2)
    kinds = sorted({kind for kind, rows in runs})
    for kind, rows in runs:
        rolling, stress = kind
        colour = f"C{kinds.index(kind) % 10}"
        strain = [row["strain [-]"] for row in rows]
        ratio = [row["shear stress [Pa]"] / row["normal stress [Pa]"] for row in rows]
        left.plot(strain, ratio, color=colour, linewidth=0.6,
                  label=f"rolling friction {rolling:g}, {stress / 1e3:g} kPa")
        right.plot(strain, [row["porosity [-]"] for row in rows], color=colour, linewidth=0.6)
    left.set_ylabel("shear / normal stress [-]")
    drawing.legend_above(left, 2, 6)
    right.set_ylabel("porosity [-]")
    for axis in (left, right):
        axis.set_xlabel("shear strain [-]")
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, files=2)
