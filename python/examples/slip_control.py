#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Slip control: adjusts the hitch force until the tracks reach a given slip.

    python/examples/slip_control.py [SLIP]       # default: 0.1

The sprockets turn at a fixed speed. Every 10 ms the controller reads the slip of both tracks and sets the force of the
hitch. Prints drawbar pull / weight; fails if the mean slip of the last 0.5 s differs from the goal by more than 10 %.
"""
from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))  # if the package is not installed
import grouser  # noqa: E402

SPEED = 3.0  # sprocket speed [rad/s]
RATE = 12.0  # integral gain of the force, in vehicle weights per second and unit slip [1/s]
EVERY, DURATION = 0.01, 3.0  # [s]


def pulling_scene() -> grouser.Scene:
    scene = grouser.Scene.read(ROOT / "runs/scenes/rigid_control.toml")
    scene["run.duration"] = DURATION
    scene["vehicle.sphere_radius"] = 0.03  # coarse, for speed
    scene["driver.sprocket_speed"] = SPEED
    scene["hitch"] = {"kind": "force", "force": 0.0}
    return scene


def main(goal: float = 0.1) -> tuple[float, float]:
    """Mean slip and pull / weight over the last 0.5 s."""
    goal = float(goal)
    with grouser.Simulation(pulling_scene()) as sim:
        weight = 9.81 * sim.vehicle_mass
        force, slips, pulls = 0.0, [], []
        while sim.time < DURATION:
            now = sim.vehicle
            if now.drive_start is not None and sim.time > now.drive_start + 0.3:
                slip = 0.5 * (now.left.slip + now.right.slip)
                force = max(0.0, force + RATE * weight * (goal - slip) * EVERY)
                sim.set_hitch_force(force)
                if sim.time > DURATION - 0.5:
                    slips.append(slip)
                    pulls.append(now.drawbar_pull)
            sim.step_for(EVERY)
    slip, pull = sum(slips) / len(slips), sum(pulls) / len(pulls) / weight
    print(f"slip {slip:.4f}, goal {goal}; drawbar pull {pull:.3f} of the weight")
    if abs(slip - goal) > 0.1 * goal:
        raise SystemExit("the controller missed its goal")
    return slip, pull


if __name__ == "__main__":
    main(*sys.argv[1:2])
