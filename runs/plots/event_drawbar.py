# SPDX-License-Identifier: BSD-3-Clause
"""Drawbar curves of a set of events: event_drawbar.py EVENTS.json FILE.png

Pull, motion resistance, sinkage and drive torque over slip, with 95 % intervals over the seeds; no picture with fewer
than two slips.
"""
import json
import math

import drawing

PANELS = (("drawbar pull [N]", 1e-3, "drawbar pull [kN]"), ("motion resistance [N]", 1e-3, "motion resistance [kN]"),
          ("sinkage mean [m]", 1e3, "mean sinkage [mm]"), ("drive torque [N m]", 1e-3, "drive torque,\nboth sprockets [kN m]"))


def draw(path):
    with open(path, encoding="utf-8") as file:
        results = json.load(file)
    rows = [row for row in results["rows"] if row["event"] == "drawbar" and row["figures"]]
    if len(rows) < 2:
        return None
    figure = drawing.Figure(figsize=(8.0, 6.0))
    for axis, (name, factor, label) in zip(figure.subplots(2, 2, sharex=True).flatten(), PANELS):
        points = sorted((row["level"], f["mean"], f["half_width"]) for row in rows for f in row["figures"]
                        if f["name"] == name)
        if points:
            slips, means, halves = zip(*points)
            bars = [factor * half if half is not None and math.isfinite(half) else math.nan for half in halves]
            axis.errorbar(slips, [factor * mean for mean in means], yerr=bars if any(map(math.isfinite, bars)) else None, marker="o", markersize=4,
                          capsize=3)
        axis.set_ylabel(label)
        axis.set_xlabel("slip [-]")
        axis.set_xlim(left=0)
    figure.suptitle(f"{results['vehicle']} on {results['soil']}, {drawing.repeats(results)}, commit {results['commit']}",
                    fontsize=9)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, dpi=110)
