#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The 36 states of two wheels: runs them, and makes their table.

    states.py run smooth|grousers OUT [options of `grouser sweep`]
    states.py table OUT_SMOOTH OUT_GROUSERS FILE.csv

A state is a sideslip angle and a speed of the rim, both in the experiment's numbers: it is towed at 10 mm/s there, and
`faster(rim)` times as fast here. Three seeds straight ahead and at a rim speed of 10 mm/s, two otherwise.
"""
import csv
import json
import math
import os
import subprocess
import sys
from pathlib import Path

RADIUS = 0.058  # [m] of the drum
TOWED = 0.010  # [m/s]
CONTACT = 0.0024  # [m] height over the bed's mean surface where the calibration's plates first bear 100 Pa
STARTS = 0.6  # [s] the wheel stands until then
RIMS = {0: (0, 3, 5, 8, 10, 12, 20, 40, 100), 15: (5, 10, 20), 30: (5, 10, 20), 45: (5, 10, 20)}  # [mm/s] by [deg]
SECTION = {"smooth": "cylinder", "grousers": "mesh"}
QUANTITIES = ("drawbar pull [N]", "side force [N]", "torque [N m]", "sinkage [mm]")


def faster(rim):
    """So many times as fast as the experiment, with the rim at 0.2 m/s at most."""
    return 2 if rim > 40 else 5


def travel(sideslip):
    return 0.1 if sideslip == 0 else 0.08  # [m]


def seeds(sideslip, rim):
    return 3 if sideslip == 0 or rim == 10 else 2


def states():
    return [(sideslip, rim, seed) for sideslip, rims in RIMS.items() for rim in rims
            for seed in range(1, seeds(sideslip, rim) + 1)]


def case(wheel, sideslip, rim, seed):
    """Name and keys of a run."""
    speed, angle, section = faster(rim) * TOWED, math.radians(sideslip), f"{SECTION[wheel]}.wheel"
    velocity = f"[{speed * math.cos(angle):.8f}, {speed * math.sin(angle):.8f}, 0]"
    keys = [f"run.seed={seed}", f"run.duration={STARTS + travel(sideslip) / speed:.4f}",
            f"{section}.velocity={velocity}", f"{section}.spin=[0, {1e-3 * rim * faster(rim) / RADIUS:.8f}, 0]",
            f"{section}.position=[0.085, {-0.5 * travel(sideslip) * math.sin(angle):.5f}, 0]"]
    return f"sideslip{sideslip}_rim{rim}_seed{seed}: " + ", ".join(keys)


def run(wheel, out, options):
    scene = Path(__file__).with_name(f"{wheel}.toml")
    words = [os.environ.get("GROUSER_PROGRAM", "grouser"), "sweep", str(scene), "--out", out, "--set", "output.frames=false",
             "--set", "output.picture=false", "--set", "output.plots=false"]
    for state in states():
        words += ["--case", case(wheel, *state)]
    return subprocess.call([*words, *options])


def figures(folder, rim, sideslip):
    """Means over the last third of the travel."""
    surface = json.loads((folder / "manifest.json").read_text())["figures"]["bed_mean_height_m"]
    with open(folder / "timeseries.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    last = float(rows[-1]["time [s]"])
    rows = [row for row in rows if float(row["time [s]"]) > last - travel(sideslip) / (3 * faster(rim) * TOWED)]

    def mean(name):
        return sum(float(row[f"surfaces.wheel.{name}"]) for row in rows) / len(rows)

    return (mean("force.x [N]"), mean("force.y [N]"), -mean("torque.y [N m]"),
            1e3 * (surface + CONTACT - (mean("position.z [m]") - RADIUS)))


def student95(freedom):
    """The 97.5 % quantile of Student's distribution."""
    table = {1: 12.706, 2: 4.303, 3: 3.182, 4: 2.776, 5: 2.571, 6: 2.447, 8: 2.306, 10: 2.228, 15: 2.131, 20: 2.086}
    return next(value for least, value in reversed(table.items()) if freedom >= least)


def half_widths(values):
    """{state: half width of 95 %} of a quantity of one wheel: the variance of a seed is pooled over the states of the same
    kind (straight, with sideslip), since two or three seeds alone do not tell it."""
    found = {}
    for straight in (True, False):
        kind = {state: v for state, v in values.items() if (state[0] == 0) == straight}
        freedom = sum(len(v) - 1 for v in kind.values())
        squares = sum(sum((x - sum(v) / len(v)) ** 2 for x in v) for v in kind.values())
        for state, v in kind.items():
            found[state] = student95(freedom) * math.sqrt(squares / freedom / len(v))
    return found


def table(folders, target):
    rows = []
    for wheel, folder in folders.items():
        runs = {}
        for sideslip, rim, seed in states():
            one = folder / f"sideslip{sideslip}_rim{rim}_seed{seed}"
            runs.setdefault((sideslip, rim), []).append(figures(one, rim, sideslip))
        commit = json.loads((one / "manifest.json").read_text())["commit"]
        for index, quantity in enumerate(QUANTITIES):
            values = {state: [f[index] for f in found] for state, found in runs.items()}
            bars = half_widths(values)
            for (sideslip, rim), found in values.items():
                if index != 1 or sideslip:
                    rows.append((wheel, sideslip, rim, quantity, f"{sum(found) / len(found):.4g}",
                                 f"{bars[sideslip, rim]:.2g}", len(found), f"states.py run {wheel}", commit))
    order = {wheel: k for k, wheel in enumerate(folders)}
    rows.sort(key=lambda row: (order[row[0]], row[1], row[2], QUANTITIES.index(row[3])))
    with open(target, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("wheel", "sideslip [deg]", "rim speed [mm/s]", "quantity", "mean", "half width of 95 %", "seeds",
                         "command", "commit"))
        writer.writerows(rows)


def main(words):
    if len(words) >= 3 and words[0] == "run" and words[1] in SECTION:
        return run(words[1], words[2], words[3:])
    if len(words) == 4 and words[0] == "table":
        table({"smooth": Path(words[1]), "grousers": Path(words[2])}, words[3])
        return 0
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
