#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Lift and draught of a box in water, by smoothing length: runs runs/scenes/floating_box.toml and prints a table.

    docs/evidence/fluid_bodies.py [PROGRAM]     default: build/bin/grouser; some 8 minutes on two cores

Fixed: the lift of the box, held upright and half under water, beyond the weight of the water that its bottom lies below
the level, in spacings of depth; one value for each quarter of the run. Free: how far its centre lies above the level,
in spacings, in the second half.
"""
import csv
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
SPACING, WIDTH, WEIGHT = 0.025, 0.2, 1000 * 9.81  # [m], [m], [N/m3]


def rows(program, folder, *changes):
    words = [program, "run", ROOT / "runs/scenes/floating_box.toml", "--out", folder, "--force"]
    for change in (f"fluid.spacing={SPACING}", "output.frames=false", *changes):
        words += ["--set", change]
    subprocess.run([str(w) for w in words], check=True, stdout=subprocess.DEVNULL)
    with open(Path(folder) / "timeseries.csv", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def mean(part, name):
    column = next(k for k in part[0] if k.split(" [")[0] == name)
    return sum(float(row[column]) for row in part) / len(part)


def level(part):
    return 0.5 * (mean(part, "fluid.probes.left") + mean(part, "fluid.probes.right"))


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/bin/grouser"
    with tempfile.TemporaryDirectory() as folder:
        for smoothing in (1.3, 1.5):
            smooth = f"fluid.smoothing={smoothing}"
            fixed = rows(program, folder, smooth, "body.0.fixed=true", "body.0.position=[0,0,0.5]", "run.duration=2")
            excess = []
            for k in range(4):
                part = fixed[k * len(fixed) // 4:(k + 1) * len(fixed) // 4]
                depth = mean(part, "fluid.bodies.box.force.z") / (WEIGHT * WIDTH)
                excess.append((depth - (level(part) - 0.4)) / SPACING)
            free = rows(program, folder, smooth)
            rest = free[len(free) // 2:]
            above = (mean(rest, "bodies.box.position.z") - level(rest)) / SPACING
            print(f"smoothing {smoothing}: fixed, lift in excess {' '.join(f'{e:.3f}' for e in excess)}; "
                  f"free, too high by {above:.3f} spacings", flush=True)


if __name__ == "__main__":
    main()
