# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the study of plates: study_plates.py PLATES.csv RUNS_FOLDER FILE.png

Force over sinkage, a thin line a run, a colour a case; strips to the left, circular plates to the right.
"""
import pathlib
import re

import drawing

ORDER = ("base", "rough", "deep", "wide", "old", "circular")


def draw(table, runs):
    files = sorted(pathlib.Path(runs).glob("*_seed*.csv"))
    if not files:
        return None
    figure = drawing.Figure(figsize=(8, 3.4))
    left, right = figure.subplots(1, 2)
    named = set()
    for file in files:
        name = re.match(r"(.+)_seed.+", file.stem).group(1)
        rows = drawing.numbers(file)
        axis = right if name == "circular" else left
        axis.plot([1e3 * row["sinkage [m]"] for row in rows], [row["force [N]"] for row in rows], linewidth=0.5,
                  color=f"C{ORDER.index(name)}" if name in ORDER else "black",
                  label=None if name in named else name)
        named.add(name)
    for axis in (left, right):
        axis.set_xlabel("sinkage [mm]")
        axis.set_ylabel("force [N]")
        if axis.get_legend_handles_labels()[0]:
            axis.legend(fontsize=7)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, files=2)
