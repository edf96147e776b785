#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The 36 states of two wheels: runs them, and makes their table.

    states.py run smooth|grousers OUT [options of `grouser sweep`]
    states.py table OUT_SMOOTH OUT_GROUSERS FILE.csv
    states.py check OUT [options of `grouser sweep`]
    states.py row OUT SIDESLIP RIM
    states.py early OUT FROM TO

A state is a sideslip angle and a speed of the rim, both in the experiment's numbers: it is towed at 10 mm/s there, and
`faster(rim)` times as fast here. Each has three seeds, which are the same three beds in every state. `check` runs one
state of the smooth wheel at half the speed, in a wider bed, and with grains half as large. `row` prints the figures of the
runs of one state, `early` those of all runs between two times [s], with sinkage measured from where the wheel bears 1 % of
its load: for runs that have not ended. `table` prints the standard deviation of a run.
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
ZERO = 0.00289  # [m] height over the bed's mean surface from which the calibration counts the sinkage of plates
LOAD = 24  # [N]
STARTS = 0.6  # [s] the wheel stands until then
PITCH = 2 * math.pi * RADIUS / 20  # [m] from grouser to grouser
RIMS = {0: (0, 3, 5, 8, 10, 12, 20, 40, 100), 15: (5, 10, 20), 30: (5, 10, 20), 45: (5, 10, 20)}  # [mm/s] by [deg]
SEEDS = (1, 2, 3)
SECTION = {"smooth": "cylinder", "grousers": "mesh"}
QUANTITIES = ("drawbar pull [N]", "side force [N]", "torque [N m]", "sinkage [mm]")


def faster(rim):
    """So many times as fast as the experiment, with the rim at 0.2 m/s at most."""
    return 2 if rim > 40 else 5


def travel(sideslip):
    return 0.1 if sideslip == 0 else 0.08  # [m]


def window(sideslip, rim):
    """Travel over which results are averaged [m]: a third of all, as many whole pitches of the rim as fit best. Where a
    pitch takes more than 0.04 m of travel it is a third."""
    pitch = PITCH * 1e3 * TOWED / max(1, rim)
    third = travel(sideslip) / 3
    return max(1, round(third / pitch)) * pitch if pitch < 0.04 else third


def states():
    return [(sideslip, rim) for sideslip, rims in RIMS.items() for rim in rims]


def name(sideslip, rim, seed):
    return f"sideslip{sideslip}_rim{rim}_seed{seed}"


def case(wheel, sideslip, rim, seed, pace=1):
    """Name and keys of a run; `pace`: times its usual speed."""
    fast, section = pace * faster(rim), f"{SECTION[wheel]}.wheel"
    speed, angle = fast * TOWED, math.radians(sideslip)
    velocity = f"[{speed * math.cos(angle):.8f}, {speed * math.sin(angle):.8f}, 0]"
    keys = [f"run.seed={seed}", f"run.duration={STARTS + travel(sideslip) / speed:.4f}",
            f"{section}.velocity={velocity}", f"{section}.spin=[0, {1e-3 * rim * fast / RADIUS:.8f}, 0]",
            f"{section}.position=[0.085, {-0.5 * travel(sideslip) * math.sin(angle):.5f}, 0]"]
    return f"{name(sideslip, rim, seed)}: " + ", ".join(keys)


def run(wheel, out, options):
    scene = Path(__file__).with_name(f"{wheel}.toml")
    words = [os.environ.get("GROUSER_PROGRAM", "grouser"), "sweep", str(scene), "--out", out]
    for key in ("frames", "picture", "plots"):
        words += ["--set", f"output.{key}=false"]
    for state in states():
        for seed in SEEDS:
            words += ["--case", case(wheel, *state, seed)]
    return subprocess.call([*words, *options])


CHECKED = (0, 20)  # sideslip and rim
CHECKS = {"speed": [], "bin": ["terrain.size=[0.72, 0.6]"], "grain": ["terrain.grain_radius=0.001"]}


def check(out, options):
    scene, program = Path(__file__).with_name("smooth.toml"), os.environ.get("GROUSER_PROGRAM", "grouser")
    for name_of_check, keys in CHECKS.items():
        words = [program, "sweep", str(scene), "--out", f"{out}/{name_of_check}",
                 "--case", case("smooth", *CHECKED, 1, 0.5 if name_of_check == "speed" else 1)]
        for key in keys:
            words += ["--set", key]
        if status := subprocess.call([*words, *options]):
            return status
    return 0


def figures(folder, sideslip, rim):
    """Means over the window at the end of the travel, which has to be complete."""
    manifest = json.loads((folder / "manifest.json").read_text())
    with open(folder / "timeseries.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    last = float(rows[-1]["time [s]"])
    moved = [float(rows[k]["surfaces.wheel.position.x [m]"]) for k in (0, -1)]
    travelled = (moved[1] - moved[0]) / math.cos(math.radians(sideslip))
    if manifest["status"] != "finished" or abs(travelled - travel(sideslip)) > 1e-3:
        sys.exit(f"{folder}: {manifest['status']}, {1e3 * travelled:.1f} mm travelled; run it to its end")
    first = last - (last - STARTS) * window(sideslip, rim) / travel(sideslip)
    rows = [row for row in rows if float(row["time [s]"]) > first]

    def mean(column):
        return sum(float(row[f"surfaces.wheel.{column}"]) for row in rows) / len(rows)

    surface = manifest["figures"]["bed_mean_height_m"] + ZERO
    return (mean("force.x [N]"), mean("force.y [N]"), -mean("torque.y [N m]"),
            1e3 * (surface - (mean("position.z [m]") - RADIUS)))


def early(folder, first, last):
    """Means between two times of a run that need not have ended: drawbar pull, torque, sinkage [mm]."""
    with open(folder / "timeseries.csv", encoding="utf-8") as file:
        rows = [{key.removeprefix("surfaces.wheel."): float(row[key]) for key in row} for row in csv.DictReader(file)]
    touched = next(row["position.z [m]"] for row in rows if row["force.z [N]"] > 0.01 * LOAD)
    window = [row for row in rows if first < row["time [s]"] <= last]

    def mean(column):
        return sum(row[column] for row in window) / len(window)

    return mean("force.x [N]"), -mean("torque.y [N m]"), 1e3 * (touched - mean("position.z [m]"))


def student95(freedom):
    """The 97.5 % quantile of Student's distribution for two degrees of freedom or more, within 4 %: from 3 on by three
    terms of its expansion, below 3 by interpolation."""
    if freedom < 3:
        return 4.303 + (3.182 - 4.303) * (max(2, freedom) - 2)
    z, n = 1.959964, freedom
    return z + (z**3 + z) / (4 * n) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * n**2) \
        + (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / (384 * n**3)


def half_width(values):
    """Standard deviation of a run and half width of the 95 % interval of a state's mean, from all states of one kind: rows
    of `values`, a column for each bed.

    The beds are the same in all states, so deviations of a bed from the mean may go along with one another. Two-way
    analysis of variance: mean squares of beds and of the rest; a deviation of a single run has the variance
    (beds + (n - 1) rest) / n of n states, with Satterthwaite's degrees of freedom. All states of a kind are taken to
    scatter alike."""
    n, beds = len(values), len(values[0])
    total = sum(map(sum, values)) / (n * beds)
    of_state = [sum(row) / beds for row in values]
    of_bed = [sum(row[k] for row in values) / n for k in range(beds)]
    by_bed = n * sum((mean - total) ** 2 for mean in of_bed) / (beds - 1)
    rest = sum((values[s][k] - of_state[s] - of_bed[k] + total) ** 2 for s in range(n) for k in range(beds))
    rest /= (n - 1) * (beds - 1)
    shares = (by_bed / n, (n - 1) * rest / n)
    freedom = sum(shares) ** 2 / (shares[0] ** 2 / (beds - 1) + shares[1] ** 2 / ((n - 1) * (beds - 1)))
    deviation = math.sqrt(sum(shares))
    return deviation, student95(freedom) * deviation / math.sqrt(beds)


def table(folders, target):
    rows, commits = [], set()
    for wheel, folder in folders.items():
        runs = {state: [figures(folder / name(*state, seed), *state) for seed in SEEDS] for state in states()}
        commits |= {json.loads((folder / name(*state, seed) / "manifest.json").read_text())["program"]["commit"]
                    for state in states() for seed in SEEDS}
        for straight in (True, False):
            kind = [state for state in states() if (state[0] == 0) == straight]
            for index, quantity in enumerate(QUANTITIES):
                if straight and index == 1:
                    continue
                values = [[found[index] for found in runs[state]] for state in kind]
                deviation, bar = half_width(values)
                print(f"{wheel}, {'straight' if straight else 'with sideslip'}, {quantity}: a run scatters by {deviation:.2g}")
                digits = max(0, 1 - math.floor(math.log10(bar)))
                rows += [(wheel, *state, quantity, f"{sum(v) / len(v):.{digits}f}", f"{bar:.{digits}f}", len(SEEDS),
                          f"states.py run {wheel}", *(f"{x:.{digits + 1}f}" for x in v)) for state, v in zip(kind, values)]
    if len(commits) != 1:
        sys.exit(f"runs of {len(commits)} commits: {', '.join(sorted(commits))}; run them again with one program")
    order = {wheel: k for k, wheel in enumerate(folders)}
    rows.sort(key=lambda row: (order[row[0]], row[1], row[2], QUANTITIES.index(row[3])))
    with open(target, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("wheel", "sideslip [deg]", "rim speed [mm/s]", "quantity", "mean", "half width of 95 %", "seeds",
                         "command", "commit", *(f"seed {seed}" for seed in SEEDS)))
        writer.writerows((*row[:-len(SEEDS)], *commits, *row[-len(SEEDS):]) for row in rows)


def main(words):
    if len(words) >= 3 and words[0] == "run" and words[1] in SECTION:
        return run(words[1], words[2], words[3:])
    if len(words) >= 2 and words[0] == "check":
        return check(words[1], words[2:])
    if len(words) == 4 and words[0] == "table":
        table({"smooth": Path(words[1]), "grousers": Path(words[2])}, words[3])
    elif len(words) == 4 and words[0] == "row":
        state = int(words[2]), int(words[3])
        for folder in sorted(Path(words[1]).glob(f"sideslip{words[2]}_rim{words[3]}_*")):
            print(folder.name, *(f"{q} {v:.4g}" for q, v in zip(QUANTITIES, figures(folder, *state))), sep="  ")
    elif len(words) == 4 and words[0] == "early":
        for folder in sorted(path.parent for path in Path(words[1]).glob("*/timeseries.csv")):
            print(folder.name, "drawbar pull [N] {:.3g}  torque [N m] {:.3g}  sinkage [mm] {:.1f}".format(
                *early(folder, float(words[2]), float(words[3]))), sep="  ")
    else:
        print(__doc__, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
