#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Recomputes the sinkage of each shoe from the poses in frames.h5 and the undisturbed surface in results.h5,
independently of the program, and compares it with the series of the run:

    check_sinkage.py FOLDER [TOLERANCE]

FOLDER: a run with a vehicle and run.frame_interval a multiple of run.output_interval. Prints the largest difference.
Exit code 1 if it exceeds TOLERANCE [m] (default 1e-6), if a shoe outside the track-ground contact length has a
sinkage, or if there is nothing to compare."""
import math
import os
import re
import sys

import h5py
import numpy


def surface_of(results):
    """Height of the undisturbed surface at (x, y), with the interpolation named in the file."""
    group = results["terrain/surface"]
    x, y, height = group["x"][:], group["y"][:], group["height"][:]
    smooth = group["height"].attrs["interpolation"]
    smooth = smooth.decode() if isinstance(smooth, bytes) else smooth
    if smooth == "monotone":
        sys.exit("terrain.interpolation = \"monotone\" is not supported by this script; run the scene with \"smooth\"")
    smooth = smooth == "Catmull-Rom"

    def along(nodes, v):
        """Index of the nearest node below v, and the interpolation weights of four nodes."""
        n, u = len(nodes), (v - nodes[0]) / (nodes[1] - nodes[0])
        if not smooth:
            u = min(max(u, 0.0), n - 1.0)
        i = min(max(int(math.floor(u)), 0), n - 2)
        t = u - i
        if not smooth or u < 0 or u > n - 1:
            return i, [0.0, 1 - t, t, 0.0]
        w = [0.5 * (-t**3 + 2 * t**2 - t), 0.5 * (3 * t**3 - 5 * t**2 + 2), 0.5 * (-3 * t**3 + 4 * t**2 + t),
             0.5 * (t**3 - t**2)]
        if i == 0:  # linear extrapolation beyond the end nodes
            w = [0.0, w[1] + 2 * w[0], w[2] - w[0], w[3]]
        if i == n - 2:
            w = [w[0], w[1] - w[3], w[2] + 2 * w[3], 0.0]
        return i, w

    def at(px, py):
        (i, wx), (j, wy) = along(x, px), along(y, py)
        total = 0.0
        for b in range(4):
            for a in range(4):
                if wx[a] and wy[b]:
                    total += wx[a] * wy[b] * height[j - 1 + b, i - 1 + a]
        return total

    return at


def rotation(q):
    w, x, y, z = q
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def normal_at(surface, x, y, width):
    """Normal of the least-squares plane through 5 x 5 heights in a square of this width around (x, y)."""
    steps = numpy.linspace(-0.5 * width, 0.5 * width, 5)
    rows = [(1.0, dx, dy, surface(x + dx, y + dy)) for dx in steps for dy in steps]
    a = numpy.array(rows)
    _, slope_x, slope_y = numpy.linalg.lstsq(a[:, :3], a[:, 3], rcond=None)[0]
    n = numpy.array([-slope_x, -slope_y, 1.0])
    return n / numpy.linalg.norm(n)


def sinkage_of(pad, surface, width):
    """Distance from the surface down to `pad` along the normal that passes through it."""
    x, y, depth = pad[0], pad[1], math.nan
    for _ in range(40):
        n = normal_at(surface, x, y, width)
        depth = float(numpy.dot(numpy.array([x, y, surface(x, y)]) - pad, n))
        foot = pad + depth * n
        moved, (x, y) = abs(foot[0] - x) + abs(foot[1] - y), foot[:2]
        if moved <= 1e-9:
            break
    return depth


def number(folder, section, key):
    """Value of a key in the vehicle file of the resolved scene."""
    scene = open(os.path.join(folder, "scene.toml"), encoding="utf-8").read()
    spec = re.search(r'^spec = "(.*)"', scene, re.M).group(1)
    text = open(spec, encoding="utf-8").read()
    part = text[text.index("\n[" + section + "]"):]
    return float(re.search(r"^" + key + r"\s*=\s*([-+0-9.eE]+)", part, re.M).group(1))


def main():
    folder, tolerance = sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 1e-6
    results = h5py.File(os.path.join(folder, "results.h5"), "r")
    frames = h5py.File(os.path.join(folder, "frames.h5"), "r")
    names = [n.decode() if isinstance(n, bytes) else n for n in frames["parts/part"].attrs["names"]]
    surface, pitch = surface_of(results), number(folder, "shoe", "pitch")
    middle = numpy.array([0, 0, number(folder, "shoe", "pad_bottom")])
    compared, worst, deepest, failed = 0, 0.0, -math.inf, False
    for key in sorted(k for k in frames if k.isdigit()):
        poses, step = frames[key]["parts/pose"][:], int(frames[key].attrs["step"])
        hull = poses[names.index("chassis")]
        ahead = rotation(hull[3:])[:, 0]
        for side in ("left", "right"):
            series = results["vehicle/" + side + "/sinkage"]
            row = numpy.flatnonzero(results["series/step"][:] == step) if "series/step" in results else \
                numpy.flatnonzero(series["step"][:] == step)
            if not len(row):
                continue
            wheels = [float(numpy.dot(poses[i][:3], ahead)) for i, n in enumerate(names)
                      if n.startswith(side + " road wheel")]
            for shoe, given in enumerate(series["value"][row[0]]):
                pose = poses[names.index("%s shoe %d" % (side, shoe))]
                if math.isnan(given):
                    continue
                place = float(numpy.dot(pose[:3], ahead))
                if not min(wheels) - 1e-9 <= place <= max(wheels) + 1e-9:
                    print("step %d: %s shoe %d has a sinkage outside the ground contact" % (step, side, shoe))
                    failed = True
                here = sinkage_of(pose[:3] + rotation(pose[3:]) @ middle, surface, pitch)
                compared, worst, deepest = compared + 1, max(worst, abs(here - given)), max(deepest, given)
    print("%d values compared, largest difference %.3g m, maximum sinkage %.4g m" % (compared, worst, deepest))
    sys.exit(1 if failed or not compared or not worst <= tolerance else 0)


if __name__ == "__main__":
    main()
