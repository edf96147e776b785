# SPDX-License-Identifier: BSD-3-Clause
"""What all plots have in common: their style, the tables they read, and the frame of a script that draws one picture."""
import csv
import pathlib
import re
import sys

import packages

packages.require("numpy", "matplotlib")
import matplotlib
from matplotlib.figure import Figure  # for the scripts, which need no import of their own

matplotlib.use("Agg")
matplotlib.rcParams.update({
    "figure.figsize": (8.0, 5.0),
    "figure.constrained_layout.use": True,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "lines.linewidth": 1.4,
    "legend.frameon": False,
    "font.size": 10,
})

EXIT_STATUS = """Exit status: 0 (also where there is nothing to draw), 2 where the words are wrong, 3 where a Python package is missing;
its last line then says which."""


def rows(path):
    """The rows of a table: [{column: text}]."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def numbers(path):
    """The rows of a table that holds nothing but numbers: [{column: number}]."""
    return [{key: float(value) for key, value in row.items()} for row in rows(path)]


def runs(folder, pattern):
    """Tables of a study's runs, in the order of their names: [(groups of the name, rows)] where it is `pattern`."""
    named = ((re.fullmatch(pattern, file.stem), file) for file in sorted(pathlib.Path(folder).glob("*.csv")))
    return [(match.groups(), numbers(file)) for match, file in named if match]


def panels(count):
    """A figure with so many panels side by side, and these."""
    figure = Figure(figsize=(4 * count, 3.4))
    return figure, figure.subplots(1, count, squeeze=False)[0]


def legend_once(axis, size):
    """A legend that names each label once; none without labels."""
    lines, labels = axis.get_legend_handles_labels()
    if labels:
        once = dict(zip(labels, lines))
        axis.legend(once.values(), once.keys(), fontsize=size)


def words(help_text, right):
    """The words behind the name of the script, where `right(words)`; ends the program with its help where not."""
    given = sys.argv[1:]
    asked = any(word in ("-h", "--help") for word in given)
    if asked or not right(given):
        print(f"{help_text.strip()}\n\n{EXIT_STATUS}")
        sys.exit(0 if asked else 2)
    return given


def main(help_text, draw, files=1, dpi=90):
    """A script that takes the paths of `files` inputs and of the picture: draw(*inputs) gives a figure, or None."""
    *inputs, picture = words(help_text, lambda given: len(given) == files + 1)
    figure = draw(*inputs)
    if figure is not None:
        figure.savefig(picture, dpi=dpi)
