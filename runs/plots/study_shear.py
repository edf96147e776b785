# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the study of shear: study_shear.py SHEAR.csv FILE.png

Shear over normal force and rise of the lid over the displacement, a line a sample, a colour a load.
Exit status: 0, 3 where a Python package is missing; its last line then says which.
"""
import csv
import pathlib
import sys

try:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib.figure import Figure
except ImportError as missing:
    packages = {"matplotlib": "python3-matplotlib", "numpy": "python3-numpy"}
    name = (missing.name or "").split(".")[0]
    print(f"the Python package {name} is missing; install {packages.get(name, name)}")
    sys.exit(3)

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import series


def main(arguments):
    if len(arguments) != 2:
        print(__doc__)
        return 2
    matplotlib.rcParams.update(series.STYLE)
    with open(arguments[0], newline="", encoding="utf-8") as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    samples = {}
    for row in rows:
        samples.setdefault((row["stress [Pa]"], row["seed"]), []).append(row)
    stresses = sorted({stress for stress, seed in samples})
    figure = Figure(figsize=(8, 3.4))
    left, right = figure.subplots(1, 2)
    for (stress, seed), lines in samples.items():
        colour = f"C{stresses.index(stress)}"
        label = f"{stress:g} Pa" if seed == 1 else None
        way = [1e3 * row["displacement [m]"] for row in lines]
        ratio = [row["shear force [N]"] / row["normal force [N]"] for row in lines]
        smooth = [sum(ratio[max(0, k - 4):k + 1]) / len(ratio[max(0, k - 4):k + 1]) for k in range(len(ratio))]
        left.plot(way, smooth, color=colour, linewidth=0.8, label=label)
        right.plot(way, [1e3 * (row["lid [m]"] - lines[0]["lid [m]"]) for row in lines], color=colour, linewidth=0.8)
    left.set_ylabel("shear / normal force [-]")
    left.legend(fontsize=7)
    right.set_ylabel("rise of the lid [mm]")
    for axis in (left, right):
        axis.set_xlabel("displacement [mm]")
    figure.savefig(arguments[1], dpi=90)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
