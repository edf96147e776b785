# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the study of shear angles: study_shear_angle.py SHEAR_ANGLE.csv RUNS_FOLDER FILE.png

Shear over normal stress against the strain, a line a sample, a colour a load; and the porosity of the samples' core.
"""
import pathlib
import re

import drawing


def draw(table, runs):
    files = sorted(pathlib.Path(runs).glob("rolling*_stress*_seed*.csv"))
    if not files:
        return None
    figure = drawing.Figure(figsize=(8, 3.4))
    left, right = figure.subplots(1, 2)
    named = set()
    keys = [re.match(r"rolling(.+)_stress(.+)_seed(.+)", file.stem).groups() for file in files]
    kinds = sorted({(float(rolling), float(stress)) for rolling, stress, seed in keys})
    for file, (rolling, stress, seed) in zip(files, keys):
        kind = (float(rolling), float(stress))
        rows = drawing.numbers(file)[1:]
        colour = f"C{kinds.index(kind) % 10}"
        label = None if kind in named else f"rolling friction {rolling}, {float(stress) / 1e3:g} kPa"
        named.add(kind)
        strain = [row["strain [-]"] for row in rows]
        ratio = [row["shear stress [Pa]"] / row["normal stress [Pa]"] for row in rows]
        left.plot(strain, ratio, color=colour, linewidth=0.6, label=label)
        right.plot(strain, [row["porosity [-]"] for row in rows], color=colour, linewidth=0.6)
    left.set_ylabel("shear / normal stress [-]")
    left.legend(fontsize=6)
    right.set_ylabel("porosity [-]")
    for axis in (left, right):
        axis.set_xlabel("shear strain [-]")
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, files=2)
