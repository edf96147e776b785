#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs of dam breaks against measurements: prints errors, and draws curves over the measured ones.

    docs/evidence/dam_breaks.py CASE PICTURE FOLDER...

CASE      spheric2    runs/scenes/spheric2.toml against spheric2.csv
          lobovsky    runs/scenes/dam_break.toml against lobovsky.csv
          koshizuka   docs/evidence/koshizuka_oka.toml against the front of Koshizuka and Oka (1996)
PICTURE   file to write, *.png
FOLDER    results of `grouser run`, one or more, whose names stand in the picture

A level's arrival is the time when it first exceeds 2 cm (spheric2), or 5 % of the initial depth (lobovsky). Impulses are
integrals of the pressure from 0.39 to 0.6 s (P1 to P4) and from 1 to 2.5 s (P5 to P8). Files hold means over 10 ms of
the measurements of Kleefsman et al. (2005), J. Comput. Phys. 206, 363-393, and the levels of Lobovsky et al. (2014), J.
Fluids Struct. 48, 407-434, at every 0.04 of their time.
"""
import csv
import sys
from pathlib import Path

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

HERE = Path(__file__).resolve().parent
GRAVITY, DEPTH = 9.81, 0.3  # [m/s2]; of the column of Lobovsky et al. [m]
# Front of Koshizuka and Oka (1996) for a column of 1 m: time [s], place [m].
FRONT = np.array([(0.092, 1.128), (0.191, 1.244), (0.266, 1.464), (0.322, 1.695), (0.368, 1.903), (0.414, 2.123),
                  (0.447, 2.365), (0.496, 2.584), (0.522, 2.804), (0.565, 3.034), (0.594, 3.219), (0.637, 3.462),
                  (0.669, 3.704), (0.702, 3.9)])


def columns(path):
    """{name without unit: values} of a table."""
    with open(path, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {name.split(" [")[0]: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def arrival(time, values, least):
    above = np.nonzero(values > least)[0]
    return time[above[0]] if len(above) else np.nan


def impulse(time, values, start, end):
    inside = (time >= start) & (time <= end)
    return np.trapz(values[inside], time[inside])


def curves(figure_rows, names, measured, runs, time, label):
    figure, panels = plt.subplots(figure_rows, len(names) // figure_rows, figsize=(11, 2.4 * figure_rows),
                                  layout="constrained", squeeze=False)
    for axis, name in zip(panels.flat, names):
        axis.plot(measured[time], measured[name], color="black", linewidth=1, label="measured")
        for folder, run in runs.items():
            axis.plot(run[time], run[name], linewidth=0.8, label=folder)
        axis.set_title(name, fontsize=9)
        axis.set_xlabel(label, fontsize=8)
        axis.tick_params(labelsize=7)
    panels.flat[0].legend(fontsize=6)
    return figure


def compareLevels(folder, run, measured, time, names, least, depth):
    """Prints rms errors of levels and arrivals; all of `run` is compared."""
    print(f"{folder}: level, rms error [% of the initial depth]; arrival, measured, both in {time}")
    for name in names:
        error = run[name] - np.interp(run[time], measured[time], measured[name])
        print(f"  {name[:2]}  {100 * np.sqrt(np.mean(error**2)) / depth:5.1f}", end="")
        wet = measured[name][0] > least
        print("" if wet else f"  {arrival(run[time], run[name], least):.3f}"
              f"  {arrival(measured[time], measured[name], least):.3f}")


def spheric2(folders):
    measured, time = columns(HERE / "spheric2.csv"), "time"
    levels, pressures = [f"H{k}" for k in range(1, 5)], [f"P{k}" for k in range(1, 9)]
    runs = {}
    for folder in folders:
        series = columns(folder / "timeseries.csv")
        run = runs[folder.name] = {name: series[f"fluid.probes.{name}"] for name in levels + pressures}
        run[time] = series[time]
        early = run[time] <= 2
        compareLevels(folder.name, {name: values[early] for name, values in run.items()}, measured, time, levels, 0.02,
                      0.55)
        print(f"{folder.name}: impulse over the measured [-]; arrival above 300 Pa [s], measured [s]")
        for name in pressures:
            span = (0.39, 0.6) if name < "P5" else (1.0, 2.5)
            share = impulse(run[time], run[name], *span) / impulse(measured[time], measured[name], *span)
            print(f"  {name}  {share:5.2f}  {arrival(run[time], run[name], 300):.3f}"
                  f"  {arrival(measured[time], measured[name], 300):.3f}")
    figure = curves(3, levels + pressures, measured, runs, time, "t [s]")
    for axis in figure.axes[4:]:
        axis.set_ylim(-3000, 13000)
    return figure


def lobovsky(folders):
    measured, time = columns(HERE / "lobovsky.csv"), "t sqrt(g/H)"
    levels = [f"H{k}/H" for k in range(1, 5)]
    runs = {}
    for folder in folders:
        series = columns(folder / "timeseries.csv")
        run = runs[folder.name] = {name: series[f"fluid.probes.{name[:2]}"] / DEPTH for name in levels}
        run[time] = series["time"] * np.sqrt(GRAVITY / DEPTH)
        compareLevels(folder.name, run, measured, time, levels, 0.05, 1)
    figure = curves(1, levels, measured, runs, time, time)
    for axis in figure.axes:
        axis.set_xlim(0, 7)
    return figure


def koshizuka(folders):
    figure, axis = plt.subplots(figsize=(5, 3), layout="constrained")
    axis.plot(*FRONT.T, "ko", markersize=3, label="measured")
    for folder in folders:
        with h5py.File(folder / "frames.h5") as file:
            frames = sorted(name for name in file if name.isdigit())
            time = np.array([file[name].attrs["time"] for name in frames])
            front = np.array([file[f"{name}/fluid/position"][:, 0].max() for name in frames])
        error = np.interp(FRONT[:, 0], time, front) / FRONT[:, 1] - 1
        print(f"{folder.name}: front over the measured - 1 [%]: rms {100 * np.sqrt(np.mean(error**2)):.1f}, "
              f"from {100 * error.min():.1f} to {100 * error.max():.1f}")
        axis.plot(time, front, linewidth=1, label=folder.name)
    axis.set_xlabel("t [s]")
    axis.set_ylabel("front [m]")
    axis.legend(fontsize=7)
    return figure


def main():
    cases = {"spheric2": spheric2, "lobovsky": lobovsky, "koshizuka": koshizuka}
    if len(sys.argv) < 4 or sys.argv[1] not in cases:
        sys.exit(__doc__)
    figure = cases[sys.argv[1]]([Path(word) for word in sys.argv[3:]])
    figure.savefig(sys.argv[2], dpi=110)


if __name__ == "__main__":
    main()
