#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""An event loop that logs a run and plots it live.

    python/examples/live_plot.py [FOLDER]       # default: out/live_plot

Every 20 ms of simulated time it logs distance, speed and slip to FOLDER/log.csv. The plot updates in a window or,
without a display, in FOLDER/live.png (every tenth sample). The sprockets are locked when the vehicle has driven a
quarter of a metre; it then swings on its tracks. Fails if the vehicle does not stay there.
"""
from __future__ import annotations

import csv
import os
import sys
from pathlib import Path

import matplotlib

if not os.environ.get("DISPLAY"):
    matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))  # if the package is not installed
import grouser  # noqa: E402

WAY, EVERY, DURATION = 0.25, 0.02, 2.2  # [m], [s], [s]
COLUMNS = ["time [s]", "distance [m]", "speed [m/s]", "slip [-]"]


class LivePlot:
    """Curves of the log so far."""

    def __init__(self, file: Path):
        self.file, self.shown = file, matplotlib.get_backend().lower() != "agg"
        self.figure, self.axes = plt.subplots(3, 1, sharex=True, figsize=(7, 6), layout="constrained")
        self.curves = [axis.plot([], [])[0] for axis in self.axes]
        for axis, label in zip(self.axes, COLUMNS[1:]):
            axis.set_ylabel(label)
        self.axes[-1].set_xlabel(COLUMNS[0])
        if self.shown:
            plt.show(block=False)

    def draw(self, rows: list[list[float]]) -> None:
        time, *values = zip(*rows)
        for axis, curve, value in zip(self.axes, self.curves, values):
            curve.set_data(time, value)
            axis.relim()
            axis.autoscale_view()
        if self.shown:
            plt.pause(0.001)
        else:
            self.figure.savefig(self.file, dpi=80)


def main(folder: str = "out/live_plot") -> list[list[float]]:
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    scene = grouser.Scene.read(ROOT / "runs/scenes/rigid_control.toml")
    scene["vehicle.sphere_radius"] = 0.03  # coarse, for speed
    scene["driver.sprocket_speed"] = 3.0
    plot, rows, start, stopped = LivePlot(out / "live.png"), [], None, False
    with grouser.Simulation(scene) as sim, open(out / "log.csv", "w", newline="") as file:
        log = csv.writer(file)
        log.writerow(COLUMNS)
        while sim.time < DURATION:
            sim.step_for(EVERY)
            now = sim.vehicle
            start = now.position[0] if start is None else start
            rows.append([sim.time, now.position[0] - start, now.speed, now.left.slip])
            log.writerow(rows[-1])
            if rows[-1][1] > WAY and not stopped:
                stopped = True
                sim.set_sprocket_speed(0.0)
            if len(rows) % 10 == 0 or plot.shown:
                plot.draw(rows)
    plot.draw(rows)
    print(f"stopped at {rows[-1][1]:.3f} m, {abs(rows[-1][2]):.4f} m/s; {out / 'log.csv'}, {plot.file}")
    if not stopped or rows[-1][1] > WAY + 0.1:
        raise SystemExit("the vehicle did not stop")
    return rows


if __name__ == "__main__":
    main(*sys.argv[1:2])
