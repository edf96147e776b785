#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The light vehicle by both contact methods: means of finished runs with 95 % intervals over seeds, as a table.

    docs/evidence/complementarity.py SERIES... -- SERIES...

SERIES: timeseries.csv of one run a seed, penalty contacts before the --, complementarity contacts behind it. Means are
taken from 1.6 s on.
"""
import csv
import math
import statistics
import sys

T95 = {2: 12.706, 3: 4.303, 4: 3.182, 5: 2.776}  # Student's t, by number of seeds
FIGURES = {
    "vehicle.position.z": ("height of the hull [mm]", 1e3),
    "vehicle.pitch_angle": ("pitch angle [mrad]", 1e3),
    "vehicle.position.x": ("distance along x [m]", 1),
    "vehicle.left.slip": ("slip, left [-]", 1),
    "vehicle.left.drive_torque": ("torque of the left sprocket [N m]", 1),
    "vehicle.right.drive_torque": ("torque of the right sprocket [N m]", 1),
}


def series(path):
    with open(path, encoding="utf-8") as file:
        return [{name.split(" [")[0]: value for name, value in row.items()} for row in csv.DictReader(file)]


def interval(values):
    """Mean with its half width; only the mean without scatter, or of a number of seeds that T95 lacks; "" for NaN."""
    if not all(math.isfinite(value) for value in values):
        return ""
    half = T95[len(values)] * statistics.stdev(values) / len(values) ** 0.5 if len(values) in T95 else 0
    return f"{statistics.mean(values):.4g}" + (f" +- {half:.2g}" if half > 0 else "")


def main():
    words = sys.argv[1:]
    if "--" not in words:
        sys.exit(__doc__)
    cut = words.index("--")
    penalty, solved = ([series(path) for path in paths] for paths in (words[:cut], words[cut + 1:]))
    print("| figure | penalty | complementarity |\n|---|---|---|")
    for column, (text, scale) in FIGURES.items():
        cells = []
        for runs in (penalty, solved):
            means = [statistics.mean(scale * float(row[column]) for row in run if float(row["time"]) >= 1.6)
                     for run in runs]
            cells.append(interval(means))
        print(f"| {text} | {cells[0]} | {cells[1]} |")
    last = [run[-1] for run in solved]
    total = {name: sum(float(row[f"solver.{name}"]) for row in last) for name in ("all_iterations", "missed_steps")}
    steps = sum(int(row["step"]) for row in last)
    worst = max(float(row["solver.worst_residual"]) for row in last)
    print(f"{total['all_iterations'] / steps:.1f} iterations a step; {total['missed_steps']:.0f} of {steps} steps miss "
          f"run.residual, by {worst:.2g} m/s at most")


if __name__ == "__main__":
    main()
