# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the feature cost study: study_features.py FEATURES.csv FILE.png

Added time per grain and step of each feature, with interval, and added memory per grain.
"""
import drawing


def draw(path):
    rows = [row for row in drawing.rows(path) if row["feature"] != "vehicle"][::-1]
    if not rows:
        return None
    figure = drawing.Figure(figsize=(9, 0.8 + 0.28 * len(rows)))
    left, right = figure.subplots(1, 2, sharey=True)
    places = range(len(rows))
    colours = ["0.6" if row["verdict"] else "tab:blue" for row in rows]
    left.barh(places, [100 * float(row["relative [-]"]) for row in rows], color=colours,
              xerr=[100 * float(row["half width [-]"]) for row in rows], capsize=2)
    left.set_xlabel("added time per grain and step [%]")
    right.barh(places, [float(row["bytes with"]) - float(row["bytes without"]) for row in rows], color=colours)
    right.set_xlabel("added memory [bytes per grain]")
    left.set_yticks(places, [row["feature"] for row in rows])
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw)
