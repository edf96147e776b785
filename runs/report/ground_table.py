# SPDX-License-Identifier: BSD-3-Clause
"""Differences between kinds of ground or contact methods, on the page of a comparison (`grouser compare`)."""
import json

from grouser.series import counted
from page import esc, facts, figure_with_bar, folded, number, table

UNSHOWN = ("steady from", "teeth passed", "integration error", "impulse residual")


def section(folder):
    """HTML; empty if the folder contains no comparison."""
    file = folder / "compare.json"
    if not file.is_file():
        return ""
    with open(file, encoding="utf-8") as stream:
        compared = json.load(stream)
    variants = [g["variant"] for g in compared["variants"]]
    rows = [row for row in compared["rows"] if not row["figure"].startswith(UNSHOWN)
            and any(mean["mean"] is not None for mean in row["means"])]
    told = facts([(g["variant"], f"{esc(g['ended'])} of {esc(counted(g['runs'], 'run'))} finished, "
                                f"{number(g['wall_time_s'], 's')} for the steps of a run, "
                                f"{number(g['wall_time_per_second'], 's')} per simulated second")
                  for g in compared["variants"] if g["wall_time_s"] is not None])
    means = table(["figure", *variants], [[esc(row["figure"]), *(cell(mean["mean"], mean["half_width"]) for mean in row["means"])]
                                         for row in rows],
                  "Means over the steady part, \u00b1 half width of the 95 % interval over the seeds (if several).",
                  numeric=range(1, 1 + len(variants)))
    pairs = [[esc(row["figure"]), f"{esc(d['to'])} \u2212 {esc(d['from'])}", cell(d["change"], d["half_width"]), esc(d["verdict"])]
             for row in rows for d in row["differences"]]
    words = (f"Equal: the 95 % interval is within {compared['bar_percent']:g} % of the larger mean; differs: "
             "the interval is outside; inconclusive: otherwise.")
    return told + means + folded("Differences", table(["figure", "variants", "difference", "verdict"], pairs, words, numeric=(2,)),
                                 opened=True)


def cell(value, half):
    return "\u2013" if value is None else figure_with_bar(value, half or None)
