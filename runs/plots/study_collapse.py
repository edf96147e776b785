# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the study of collapses: study_collapse.py COLLAPSE.csv FILE.png

Run-out and height of the deposit over the aspect of the column, every column a point, the laws of channels as lines with 15 %.
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
    aspect = [row["aspect [-]"] for row in rows]
    line = [0.2 + 0.05 * k for k in range(int(20 * max(aspect)))]
    laws = {
        "run-out [-]": ("run-out / length before [-]", lambda a: 1.2 * a if a < 2.3 else 1.9 * a ** (2 / 3)),
        "deposit height [-]": ("height at the wall / length before [-]", lambda a: a if a < 1.15 else 0.65 * a**0.4),
    }
    figure = Figure(figsize=(8, 3.4))
    for axis, (key, (label, law)) in zip(figure.subplots(1, 2), laws.items()):
        channel = [law(a) for a in line]
        axis.plot(line, channel, color="black", linewidth=1, label="channels")
        axis.fill_between(line, [0.85 * y for y in channel], [1.15 * y for y in channel], color="black", alpha=0.1)
        axis.plot(aspect, [row[key] for row in rows], "o", markersize=3, color="tab:blue", label="grouser")
        axis.set_xlabel("height / length before [-]")
        axis.set_ylabel(label)
        axis.legend(fontsize=7)
    figure.savefig(arguments[1], dpi=90)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
