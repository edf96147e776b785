# SPDX-License-Identifier: BSD-3-Clause
"""Plots of a run: plot.py RESULTS.h5 FOLDER NAME...   NAME: one of shoe_heights, sinkage, surface, bed, drive,
ledger, mechanism, figure. Omits plots if the results lack the data.
"""
import pathlib

import packages

packages.require("numpy", "matplotlib", "h5py")
import h5py

import bed
import drawing
import drive
import figure
import ledger
import mechanism
import series
import shoes
import surface

PLOTS = {"shoe_heights": shoes.heights, "sinkage": shoes.sinkage, "surface": surface.plot, "bed": bed.plot,
         "drive": drive.plot, "ledger": ledger.plot, "mechanism": mechanism.plot, "figure": figure.plot}


def main():
    results, folder, *names = drawing.words(__doc__, lambda given: len(given) > 2 and all(name in PLOTS for name in given[2:]))
    with h5py.File(results, "r") as file:
        run = series.Run(file)
        for name in names:
            drawn = PLOTS[name](run)
            if drawn is not None:
                if run.text("soil_contact") not in ("", "all"):
                    drawn.text(0.995, 0.995, f"soil contact: track {run.text('soil_contact')} only", fontsize=7, ha="right", va="top")
                drawing.save(drawn, pathlib.Path(folder) / f"{name}.png", dpi=150)


if __name__ == "__main__":
    main()
