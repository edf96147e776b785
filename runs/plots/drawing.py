# SPDX-License-Identifier: BSD-3-Clause
"""Common parts of all plots: style, tables, and the frame of a script that draws one picture."""
import csv
import math
import pathlib
import re
import sys

import packages

packages.require("numpy", "matplotlib")
import matplotlib
from matplotlib import ticker
from matplotlib.figure import Figure  # re-exported for the scripts

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
    "text.parse_math": False,  # names and titles of scenes may contain $
})

EXIT_STATUS = """Exit status: 0 (also if there is nothing to draw); 2: wrong arguments; 3: missing Python package, named
on the last line."""


NOTHING = 1e-30  # in SI units: smaller values are drawn as 0
LEAST_SPAN = 1e-9  # range of an axis over its largest value; smaller ranges are rounding


class Ticks(ticker.Formatter):
    """Complete tick labels: no separate offset or power of ten."""

    def __call__(self, value, _=None):
        most = max((abs(v) for v in self.locs), default=abs(value))
        step = min((b - a for a, b in zip(self.locs, self.locs[1:])), default=most) or most
        if abs(value) <= 1e-6 * step:
            return "0"
        power = 0 if 1e-4 <= most < 1e6 else math.floor(math.log10(abs(value)) + 1e-9)
        value, step = value / 10.0**power, step / 10.0**power
        digits = next((d for d in range(12) if abs(step - round(step, d)) < 1e-3 * step), 12)
        text = f"{value:.{digits}f}".replace("-", "\u2212")
        return text if power == 0 else f"{text}e{power}".replace("e-", "e\u2212")


class LogTicks(ticker.LogFormatterSciNotation):
    """Tick labels of a logarithmic axis as plain text: 10\u207b\u00b2 instead of $10^{-2}$."""

    def __call__(self, value, at=None):
        text = re.sub(r"[$]|\\mathdefault|\\times", lambda found: "\u00d7" if "times" in found[0] else "",
                      super().__call__(value, at))
        return re.sub(r"\^\{(.*?)\}", lambda power: power[1].translate(RAISED), text).strip("{}")


RAISED = str.maketrans("0123456789-\u2212", "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079\u207b\u207b")


def save(figure, path, dpi):
    """Writes a picture with readable axes: complete tick labels without mathtext, no linear ranges below rounding."""
    for axes in figure.axes:
        for axis, limits, widen in ((axes.xaxis, axes.get_xlim, axes.set_xlim), (axes.yaxis, axes.get_ylim, axes.set_ylim)):
            for now, change in ((axis.get_major_formatter(), axis.set_major_formatter),
                                (axis.get_minor_formatter(), axis.set_minor_formatter)):
                if type(now) is ticker.LogFormatterSciNotation:
                    change(LogTicks(labelOnlyBase=now.labelOnlyBase, minor_thresholds=now.minor_thresholds))
            if axis.get_scale() != "linear" or not isinstance(axis.get_major_formatter(), ticker.ScalarFormatter):
                continue
            low, high = limits()
            most = max(abs(low), abs(high))
            if most < NOTHING:
                widen(-0.05, 0.05)
            elif abs(high - low) < LEAST_SPAN * most:
                widen(low - 1e-3 * most, high + 1e-3 * most)
            axis.set_major_formatter(Ticks())
    figure.savefig(path, dpi=dpi)


def label(name):
    """A user's name as the label of a curve: matplotlib omits labels that begin with _ from legends."""
    return f"\u200b{name}" if name and name.startswith("_") else name


def legend_above(axes, columns=3, size=8):
    """Adds a legend above the axes with each label once; no legend without labels."""
    lines, labels = axes.get_legend_handles_labels()
    once = dict(zip(labels, lines))
    if once:
        axes.legend(once.values(), once.keys(), loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=columns, fontsize=size)


def legend_below(figure, axes):
    """Adds one legend for all panels, below the panels; no legend without labels."""
    entries = {}
    for one in axes:
        entries.update(zip(*reversed(one.get_legend_handles_labels())))
    if entries:
        columns = max(1, min(len(entries), int(14 * figure.get_figwidth() / max(6, *map(len, entries)))))
        legend = figure.legend(entries.values(), entries.keys(), loc="lower center", ncol=columns, fontsize=8)
        below = 0.2 * math.ceil(len(entries) / columns) / figure.get_figheight()
        legend.set_in_layout(False)
        figure.get_layout_engine().set(rect=(0, below, 1, 1 - below))


def counted(number, one):
    """"1 seed", "3 seeds"."""
    return f"{number} {one}" + ("" if number == 1 else "s")


def repeats(results):
    """Number of runs per level of events: "3 seeds", "8 draws"."""
    return counted(results["draws"], "draw") if results.get("draws") else counted(results["seeds"], "seed")


def rows(path):
    """The rows of a table: [{column: text}]."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def numbers(path):
    """The rows of a numeric table: [{column: number}]."""
    return [{key: float(value) for key, value in row.items()} for row in rows(path)]


def runs(folder, pattern):
    """Tables of those runs of a study that have names matching `pattern`, sorted: [(groups of the match, rows)]."""
    named = ((re.fullmatch(pattern, file.stem), file) for file in sorted(pathlib.Path(folder).glob("*.csv")))
    return [(match.groups(), numbers(file)) for match, file in named if match]


def panels(count):
    """A figure with `count` panels side by side, and the panels."""
    figure = Figure(figsize=(4 * count, 3.4))
    return figure, figure.subplots(1, count, squeeze=False)[0]


def words(help_text, right):
    """The arguments of the script; prints the help and exits unless `right(arguments)`."""
    given = sys.argv[1:]
    asked = any(word in ("-h", "--help") for word in given)
    if asked or not right(given):
        print(f"{help_text.strip()}\n\n{EXIT_STATUS}")
        sys.exit(0 if asked else 2)
    return given


def main(help_text, draw, files=1, dpi=90):
    """A script with the arguments INPUT... PICTURE (`files` inputs); draw(*inputs) returns a figure or None."""
    *inputs, picture = words(help_text, lambda given: len(given) == files + 1)
    figure = draw(*inputs)
    if figure is not None:
        save(figure, picture, dpi)
