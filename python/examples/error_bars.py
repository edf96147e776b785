#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Sweeps a scene over friction and seeds, checks it, compares the error bars, and prints facts about the final bed.

    python/examples/error_bars.py [FOLDER]          # results; default: out/error_bars
"""
from __future__ import annotations

import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # if the package is not installed
import grouser  # noqa: E402


def heap() -> grouser.Scene:
    """A scene in which forty grains fall onto a plane named ground."""
    scene = grouser.Scene(name="heap")
    scene["run"] = {"duration": 0.2, "time_step": 1e-4, "output_interval": 0.01, "seed": 1}
    scene["material.sand"] = {"stiffness": 2e4, "restitution": 0.4, "friction": 0.5}
    scene["output.frames"] = False
    scene["output.plots"] = False
    scene["output.picture"] = False
    scene.add("plane", name="ground", material="sand")
    scene.add("grains", form="random", low=[-0.1, -0.1, 0.02], high=[0.1, 0.1, 0.16], radius=0.01, number=40,
              material="sand")
    return scene


def main(folder: str = "out/error_bars") -> tuple[grouser.Sweep, grouser.Check, grouser.Bed]:
    scene, place = heap(), Path(folder)
    sweep = scene.sweep(place / "sweep", {"material.sand.friction": [0.2, 0.8]}, seeds=3, jobs=2, threads=1)
    for mean in sweep.means["ground force z"]:
        print(f"friction {mean.keys['material.sand.friction']}: {mean.mean} ({mean.seeds} seeds); "
              f"difference to the first {mean.difference.value:.2g} +- {mean.difference.half_width:.2g} "
              f"{mean.difference.unit}")
    check = scene.check(place / "check", axes=["step"], seeds=3, jobs=2, threads=1)
    force = check["ground force z"]
    step = force.errors["step"]
    print(f"unchanged scene: {force.bar}; seeds only +- {force.by_seeds.half_width:.2g} {force.bar.unit}; "
          f"half the step: change {step.change.value:.2g} {step.change.unit}: {step.verdict}")
    bed = sweep.runs[0].open().bed()
    print(f"{len(bed)} grains at the end: highest centre at {numpy.max(bed.position[:, 2]):.3f} m, "
          f"{numpy.mean(bed.contacts):.2f} contacts per grain")
    return sweep, check, bed


if __name__ == "__main__":
    main(*sys.argv[1:])
