#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tows a block over a settled bed: ratio of pull to weight for several nose slopes.

    python/examples/towed_block.py [FOLDER] [SEEDS] [PICTURE]      # default: out/towed_block, 3 seeds, no picture

The block slides on sand with a friction far below that of the sand itself. The rest of the pull is ploughing: the nose
displaces sand. A flatter nose ploughs less.
"""
from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # if the package is not installed
import grouser  # noqa: E402

LENGTH, WIDTH, HEIGHT, MASS = 0.12, 0.12, 0.06, 2.0  # block [m], [kg]
NOSE = 0.03  # nose height above the sole [m]
SLOPES = (90, 40, 20, 10)  # nose slope [deg]; 90: blunt face
FRICTION, SAND_FRICTION = 0.2, 0.5  # block on sand, sand on sand [-]
SPEED, START = 0.2, 0.25  # [m/s], [s]
GRAVITY = 9.81  # [m/s2]


def shapes_of(slope: float) -> list[dict]:
    """Boxes in the block's frame: the block and, for a slope below 90 degrees, a ramp ahead of the sole that rises to
    the nose height, and a vertical face above it."""
    block = {"kind": "box", "size": [LENGTH, WIDTH, HEIGHT]}
    if slope == 90:
        return [block]
    angle, thickness = math.radians(slope), 0.01
    reach, bottom = NOSE / math.tan(angle), -HEIGHT / 2
    middle = numpy.array([LENGTH / 2 + reach / 2, 0, bottom + NOSE / 2])
    middle += thickness / 2 * numpy.array([-math.sin(angle), 0, math.cos(angle)])
    return [block, {"kind": "box", "size": [NOSE / math.sin(angle), WIDTH, thickness], "position": middle.tolist(),
                    "axis": [0, 1, 0], "angle": -slope},
            {"kind": "box", "size": [thickness, WIDTH, HEIGHT - NOSE],
             "position": [LENGTH / 2 + reach - thickness / 2, 0, NOSE / 2]}]


def scene_of(slope: float, seed: int, way: float) -> grouser.Scene:
    """A carriage on a rail tows the block, which slides freely up and down; the carriage mass has no effect."""
    scene = grouser.Scene(name="towed_block")
    scene["run"] = {"duration": START + way / SPEED, "output_interval": 0.01, "frame_interval": 0.5, "seed": seed}
    scene["material.sand"] = {"density": 2600, "stiffness": 2e4, "restitution": 0.3, "friction": SAND_FRICTION,
                              "rolling_friction": 0.1}
    scene["material.block"] = {"stiffness": 2e4, "restitution": 0.3, "friction": FRICTION}
    scene["terrain"] = {"heightmap": "heightmaps/flat.png", "size": [way + 0.42, 0.3], "height_range": [0, 0],
                        "material": "sand", "grain_radius": 0.006, "depth": 0.06}
    scene["mechanism"] = {"above_bed": 0.001}
    place = [LENGTH / 2 + 0.06, 0, HEIGHT / 2]
    scene.add("body", name="carriage", mass=1, box=[0.02, 0.02, 0.02], position=[place[0], 0, 0.2])
    scene.add("body", name="block", mass=MASS, box=[LENGTH, WIDTH, HEIGHT], position=place, material="block",
              shape=shapes_of(slope))
    scene.add("joint", name="rail", type="prismatic", bodies=["world", "carriage"], point=[place[0], 0, 0.2],
              axis=[1, 0, 0])
    scene.add("joint", name="guide", type="prismatic", bodies=["carriage", "block"], point=place, axis=[0, 0, 1])
    scene.add("drive", name="tow", joint="rail", imposes="speed", time=[0, START, START + 0.1], values=[0, 0, SPEED])
    scene["output"] = {"plots": False, "picture": False}
    return scene


def pull_of(run: grouser.Run, way: float) -> float:
    """Mean ratio of pull to weight over the second half of the travel [-]."""
    force = run["bodies.block.contact_force"]["x"].between(START + 0.5 * way / SPEED, START + way / SPEED)
    return -float(numpy.mean(force.value)) / (MASS * GRAVITY)


def main(folder: str = "out/towed_block", seeds: int = 3, picture: str = "", slopes=SLOPES, way: float = 0.25) -> dict:
    """[slope] ratios of pull to weight for all seeds."""
    pulls: dict[float, list[float]] = {}
    for slope in slopes:
        for seed in range(1, int(seeds) + 1):
            with scene_of(slope, seed, way).run(Path(folder) / f"{slope}_{seed}", force=True) as run:
                pulls.setdefault(slope, []).append(pull_of(run, way))
        values = numpy.array(pulls[slope])
        print(f"nose of {slope} degrees: pull {values.mean():.3f} of the weight, {values.min():.3f} to "
              f"{values.max():.3f}; friction {FRICTION}, ploughing {values.mean() - FRICTION:.3f}", flush=True)
    if picture:
        draw(pulls, picture)
    return pulls


def draw(pulls: dict[float, list[float]], picture: str) -> None:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(5, 3.6))
    for slope, values in pulls.items():
        axes.plot([slope] * len(values), values, ".", color="tab:blue", alpha=0.5)
    axes.plot(list(pulls), [numpy.mean(v) for v in pulls.values()], "o-", color="tab:blue", label="on a bed of sand")
    axes.axhline(FRICTION, color="k", label="friction of block on sand")
    axes.set(xlabel="slope of the nose [deg]", ylabel="pull / weight [-]", ylim=(0, None))
    axes.legend()
    figure.tight_layout()
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
