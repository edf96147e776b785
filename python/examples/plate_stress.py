#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Presses a plate into a settled bed and compares the vertical stress below its middle with Boussinesq's.

    python/examples/plate_stress.py [FOLDER] [SEEDS] [PICTURE]      # default: out/plate_stress, 4 seeds, no picture
"""
from __future__ import annotations

import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # if the package is not installed
import grouser  # noqa: E402

PLATE = 0.12  # edge of the plate [m]
CELL = 0.04  # a third of it, two diameters of the grains [m]
DEPTH, SIDE = 0.3, 0.5  # of the bed [m]


def scene_of(seed: int) -> grouser.Scene:
    """A plate that sinks at 20 mm/s."""
    scene = grouser.Scene(name="plate_stress")
    scene["run"] = {"duration": 0.6, "output_interval": 0.02, "frame_interval": 0.02, "seed": seed}
    scene["material.sand"] = {"density": 2600, "stiffness": 1e5, "restitution": 0.3, "friction": 0.5}
    scene["material.steel"] = {"stiffness": 1e5, "restitution": 0.3, "friction": 0.3}
    scene["terrain"] = {"heightmap": "heightmaps/flat.png", "size": [SIDE, SIDE], "height_range": [0, 0],
                        "material": "sand", "grain_radius": 0.01, "depth": DEPTH}
    scene.add("box", name="plate", position=[SIDE / 2, SIDE / 2, 0], above_bed=0.001, size=[PLATE, PLATE, 0.02],
              velocity=[0, 0, -0.02], material="steel")
    middle, half = SIDE / 2, 5.5 * CELL  # a cell stands below the middle of the plate
    scene["output"] = {"plots": False, "picture": False, "fields_cell": CELL,
                       "fields_low": [middle - half, middle - half, -DEPTH], "fields_high": [middle + half, middle + half, 0.02]}
    return scene


def boussinesq(depth: numpy.ndarray) -> numpy.ndarray:
    """Vertical stress over the pressure below the middle of a square under uniform pressure [-] (Newmark 1935: four
    times that below a corner of a quarter)."""
    m = PLATE / 2 / depth
    a = 2 * m**2 + 1
    return 4 / (2 * numpy.pi) * (m**2 / (numpy.sqrt(a) * (m**2 + 1)) * 2 + numpy.arcsin(m**2 / (m**2 + 1)))


def profile(run: grouser.Run, sinkage: tuple[float, float] = (0.004, 0.011)) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Depth of the cells [m] below the plate, and the vertical stress that the plate adds there over its pressure [-]:
    mean over the frames of these sinkages [m]."""
    stress = run.fields("stress")
    force = run["surfaces.plate.force"]["z"]
    middle = len(stress.x) // 2
    vertical = -stress.value[:, :, middle, middle, 2, 2]
    ratios = [(vertical[k] - vertical[0]) / (force.at(time) / PLATE**2) for k, time in enumerate(stress.time)
              if sinkage[0] <= 0.02 * time - 0.001 <= sinkage[1]]
    return -stress.z[::-1], numpy.mean(ratios, axis=0)[::-1]


def main(folder: str = "out/plate_stress", seeds: int = 4, picture: str = "") -> tuple[numpy.ndarray, numpy.ndarray]:
    """Depths [m], and the profiles of all seeds [seeds, depths]."""
    rows = []
    for seed in range(1, int(seeds) + 1):
        with scene_of(seed).run(Path(folder) / str(seed), force=True) as run:
            depth, ratio = profile(run)
            rows.append(ratio)
    depth, profiles = depth[depth > 0], numpy.array(rows)[:, depth > 0]
    for z, ratio in zip(depth, profiles.T):
        print(f"depth {z / PLATE:.2f} plates: {ratio.mean():.3f} of the pressure, {ratio.min():.3f} to {ratio.max():.3f}; "
              f"Boussinesq {boussinesq(z):.3f}")
    if picture:
        draw(depth, profiles, picture)
    return depth, profiles


def draw(depth: numpy.ndarray, profiles: numpy.ndarray, picture: str) -> None:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(5, 4.2))
    fine = numpy.linspace(0.01, depth.max(), 200)
    axes.plot(boussinesq(fine), fine / PLATE, "k-", label="Boussinesq, uniform pressure on a square")
    axes.plot(profiles.T, numpy.tile(depth / PLATE, (len(profiles), 1)).T, ".", color="tab:blue", alpha=0.5)
    axes.plot(profiles.mean(axis=0), depth / PLATE, "o-", color="tab:blue", label=f"grains, mean of {len(profiles)} beds")
    axes.set(xlabel="vertical stress added below the middle / plate pressure [-]", ylabel="depth / plate width [-]", xlim=(0, None))
    axes.invert_yaxis()
    axes.legend()
    figure.tight_layout()
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
