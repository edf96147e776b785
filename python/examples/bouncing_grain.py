#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Builds a scene in Python, runs it, and measures the restitution of a bouncing grain.

    python/examples/bouncing_grain.py [FOLDER]      # results; default: out/bouncing_grain
"""
from __future__ import annotations

import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # if the package is not installed
import grouser  # noqa: E402

RADIUS = 0.01  # [m]
HEIGHT = 0.05  # initial height of the bottom of the grain above the plane [m]


def scene_of(restitution: float) -> grouser.Scene:
    """A glass grain above a glass plane."""
    scene = grouser.Scene(name="bouncing_grain")
    scene["run"] = {"duration": 0.25, "time_step": 1e-5, "output_interval": 1e-3, "frame_interval": 1e-3}
    scene["material.glass"] = {"stiffness": 1e5, "restitution": restitution, "friction": 0.3}
    scene["output.plots"] = False
    scene["output.picture"] = False
    scene.add("plane", material="glass")
    scene.add("grain", position=[0, 0, HEIGHT + RADIUS], radius=RADIUS, material="glass")
    return scene


def rebound(run: grouser.Run) -> float:
    """Ratio of the maximum upward to the maximum downward speed [-]: first impact."""
    velocity = run.frames.grain(0, "velocity")["z"].value  # [frames] [m/s]
    return float(velocity.max() / -velocity.min())


def main(folder: str = "out/bouncing_grain") -> dict[float, float]:
    """{restitution of the scene: measured restitution}"""
    measured: dict[float, float] = {}
    for restitution in (0.3, 0.6, 0.9):
        with scene_of(restitution).run(Path(folder) / f"{restitution}", force=True) as run:
            measured[restitution] = rebound(run)
            balance = run["ledger.integration_error"]
            print(f"restitution {restitution}: measured {measured[restitution]:.4f}; time-integration error "
                  f"{balance.value[-1]:.2e} {balance.unit} of "
                  f"{numpy.max(run['ledger.kinetic'].value):.2e} J")
    return measured


if __name__ == "__main__":
    main(*sys.argv[1:])
