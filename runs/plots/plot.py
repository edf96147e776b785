# SPDX-License-Identifier: BSD-3-Clause
"""Plots of a run: plot.py RESULTS.h5 FOLDER NAME...   with NAME of shoe_heights, sinkage, drive, ledger,
mechanism.

Exit status: 0 (a plot whose quantities the results lack is left out), 3 where a Python package is missing; its last line
then says which to install.
"""
import pathlib
import sys

try:
    import h5py
    import matplotlib
    import numpy

    matplotlib.use("Agg")
except ImportError as missing:
    packages = {"h5py": "python3-h5py", "matplotlib": "python3-matplotlib", "numpy": "python3-numpy"}
    name = (missing.name or "").split(".")[0]
    print(f"the Python package {name} is missing; install {packages.get(name, name)}")
    sys.exit(3)

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import drive
import ledger
import mechanism
import series
import shoes

PLOTS = {"shoe_heights": shoes.heights, "sinkage": shoes.sinkage, "drive": drive.plot, "ledger": ledger.plot,
         "mechanism": mechanism.plot}


def main(arguments):
    if len(arguments) < 3 or any(name not in PLOTS for name in arguments[2:]):
        print(__doc__)
        return 2
    matplotlib.rcParams.update(series.STYLE)
    folder = pathlib.Path(arguments[1])
    with h5py.File(arguments[0], "r") as file:
        run = series.Run(file)
        for name in arguments[2:]:
            figure = PLOTS[name](run)
            if figure is not None:
                figure.savefig(folder / f"{name}.png", dpi=150)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
