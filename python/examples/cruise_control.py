#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Cruise control: a PI controller holds the hull's speed on a slope of 0.2 by setting the sprocket speeds.

    python/examples/cruise_control.py [FOLDER]       # results; default: out/cruise_control

Every 10 ms the controller reads the hull's speed and sets the sprockets. The run is recorded with its control inputs:
`grouser run --replay FOLDER` repeats it without this program, to the same state hash. Fails if the mean speed of the
last 0.5 s is off the goal by more than 2 %.
"""
from __future__ import annotations

import math
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))  # if the package is not installed
import grouser  # noqa: E402

GOAL = 0.5  # [m/s]
SLOPE = 0.2  # [-]
GAIN, INTEGRAL = 0.5, 3.0  # controller gains: [-], [1/s]
EVERY = 0.01  # [s]


def scene_on_slope(duration: float) -> grouser.Scene:
    """Rigid ground; tilted gravity models the slope."""
    scene = grouser.Scene.read(ROOT / "runs/scenes/rigid_control.toml")
    angle = math.atan(SLOPE)
    scene["run.gravity"] = [-9.81 * math.sin(angle), 0.0, -9.81 * math.cos(angle)]
    scene["run.duration"] = duration
    scene["vehicle.sphere_radius"] = 0.03  # coarse, for speed
    scene["output.plots"] = False
    return scene


def main(folder: str = "out/cruise_control", duration: float = 2.6) -> float:
    with grouser.Simulation(scene_on_slope(duration), folder, overwrite=True) as sim:
        integral, late = 0.0, []
        while sim.time < duration:
            speed = sim.vehicle.speed
            if sim.vehicle.drive_start is not None and sim.time > sim.vehicle.drive_start:
                integral += (GOAL - speed) * EVERY
            wanted = GOAL + GAIN * (GOAL - speed) + INTEGRAL * integral  # track speed [m/s]
            sim.set_sprocket_speed(wanted / sim.pitch_radius)
            sim.step_for(EVERY)
            if sim.time > duration - 0.5:
                late.append(sim.vehicle.speed)
        mean = sum(late) / len(late)
        print(f"mean speed of the last 0.5 s: {mean:.4f} m/s, goal {GOAL} m/s; state hash {sim.hash()}")
    if abs(mean - GOAL) > 0.02 * GOAL:
        raise SystemExit(f"the controller missed its goal by {100 * (mean / GOAL - 1):.1f} %")
    return mean


if __name__ == "__main__":
    main(*sys.argv[1:2])
