# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the bed preparation study: study_preparation.py PREPARATION.csv FILE.png

Porosity of the bed over the target porosity, with intervals; contacts per grain over porosity.
"""
import drawing


def draw(path):
    rows = [row for row in drawing.rows(path) if row["porosity [-]"]]
    if not rows:
        return None
    figure = drawing.Figure(figsize=(8, 3.4))
    left, right = figure.subplots(1, 2)
    wanted = [float(row["wanted [-]"]) for row in rows]
    reached = [float(row["porosity [-]"]) for row in rows]
    left.plot(wanted, wanted, color="0.7", linewidth=0.8)
    left.errorbar(wanted, reached, yerr=[float(row["half width of porosity"]) for row in rows], fmt="o", markersize=3, capsize=2)
    left.set_xlabel("target porosity [-]")
    left.set_ylabel("porosity [-]")
    right.plot(reached, [float(row["coordination [-]"]) for row in rows], "o-", markersize=3)
    right.set_xlabel("porosity [-]")
    right.set_ylabel("contacts per grain [-]")
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw)
