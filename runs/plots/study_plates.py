# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the plate sinkage study: study_plates.py PLATES.csv RUNS_FOLDER FILE.png

Force over sinkage, one thin line per run, one colour per case; panels for the strips, the old bed, the circular plates,
and the strips on a fine and a graded bed, if available.
"""
import drawing

PANELS = (("base", "rough", "deep", "wide"), ("old",), ("circular",), ("fine", "graded"))


def draw(table, folder):
    runs = drawing.runs(folder, "(.+)_seed.+")
    drawn = [cases for cases in PANELS if any(name in cases for (name,), _ in runs)]
    if not drawn:
        return None
    figure, axes = drawing.panels(len(drawn))
    for cases, axis in zip(drawn, axes):
        for (name,), rows in runs:
            if name in cases:
                axis.plot([1e3 * row["sinkage [m]"] for row in rows], [row["force [N]"] for row in rows],
                          linewidth=0.5, color=f"C{cases.index(name)}", label=name)
        axis.set_xlabel("sinkage [mm]")
        axis.set_ylabel("force [N]")
        drawing.legend_above(axis, 2, 7)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, files=2)
