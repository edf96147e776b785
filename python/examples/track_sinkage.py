#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a coarse runs/scenes/ball_pit.toml and reads its results: sinkage by shoe, surface, path of a shoe.

    python/examples/track_sinkage.py [FOLDER]       # results; default: out/track_sinkage

The bed is shallow and coarse and the drive short, to finish within a minute; remove the call of `coarsen()` for the
original scene.
"""
from __future__ import annotations

import sys
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))  # if the package is not installed
import grouser  # noqa: E402


def coarsen(scene: grouser.Scene) -> None:
    """The scene with fewer grains and a drive of 0.3 s."""
    scene["terrain.size"] = [4.2, 2.6]
    scene["terrain.grain_radius"] = 0.05
    scene["terrain.depth"] = 0.2
    del scene["terrain.porosity"]  # too shallow to measure its porosity
    scene["terrain.settle_kinetic_energy"] = 0.01
    scene["vehicle.sphere_radius"] = 0.02
    scene["run.duration"] = 0.3
    scene["run.frame_interval"] = 0.02
    scene["driver"] = {"sprocket_speed": 2.0, "tension_ramp": 0.05, "weight_ramp": 0.1, "drive_ramp": 0.05}
    scene["output.plots"] = False
    scene["output.picture"] = False


def sinkage_by_shoe(run: grouser.Run) -> dict[str, numpy.ndarray]:
    """{side: [shoes] [m]}: mean sinkage while in ground contact; NaN for shoes that never are."""
    means: dict[str, numpy.ndarray] = {}
    for side, series in run.sinkage().items():
        carried = numpy.isfinite(series.value)
        total = numpy.where(carried, series.value, 0).sum(axis=0)
        means[side] = numpy.divide(total, carried.sum(axis=0), where=carried.any(axis=0),
                                   out=numpy.full(total.shape, numpy.nan))
    return means


def main(folder: str = "out/track_sinkage") -> grouser.Run:
    scene = grouser.Scene.read(ROOT / "runs/scenes/ball_pit.toml")
    coarsen(scene)
    run = scene.run(folder, force=True, progress=lambda p: print(p, end="\r", flush=True))
    print(run)
    for side, means in sinkage_by_shoe(run).items():
        shoes = numpy.flatnonzero(numpy.isfinite(means))
        deepest = shoes[numpy.argmax(means[shoes])]
        print(f"{side:5}: {len(shoes)} of {len(means)} shoes in ground contact; mean sinkage "
              f"{1e3 * means[shoes].mean():.0f} mm, deepest shoe {deepest} with {1e3 * means[deepest]:.0f} mm")
    surface = run.surface
    print(f"undisturbed surface: {surface.height.shape[0]} x {surface.height.shape[1]} nodes, "
          f"{surface.height.min():.3f} to {surface.height.max():.3f} m")
    shoe = run.frames.part("left shoe 0")
    way = numpy.linalg.norm(numpy.diff(shoe.value[:, :3], axis=0), axis=1).sum()
    print(f"path length of the first left shoe: {way:.3f} m; {len(run.frames[0])} grains, total mass of the vehicle "
          f"{float(run.constants['vehicle.mass']):.0f} {run.constants['vehicle.mass'].unit}")
    return run


if __name__ == "__main__":
    main(*sys.argv[1:])
