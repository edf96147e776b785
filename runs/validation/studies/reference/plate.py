#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares grouser with LIGGGHTS for the same plate on the same bed with the same contact law, for several seeds.

    runs/validation/studies/reference/plate.py --grouser build/bin/grouser --seeds 16 --out out/plate_reference

For each seed, grouser pours and settles a bed of spheres in a bin. Then both programs read positions and radii of the
grains, and push a plate into this bed at the same speed. Both use linear springs and dashpots, a ratio of tangential to
normal stiffness of 2/7, Coulomb friction, and the same time step. The script compares the mean force on the plate in
slices of depth and over all slices but the first. It keeps finished runs, so that an interrupted call can be repeated.

Requires LIGGGHTS (Debian package `liggghts`, 3.8.0) and the Python packages numpy, h5py and matplotlib of Debian.
"""
import argparse
import concurrent.futures
import csv
import math
import pathlib
import subprocess
import sys
import time

import h5py
import numpy

D = 0.02                     # mean diameter of the grains [m]
SPREAD = 0.25                # half width of the uniform radius distribution / mean radius
DENSITY, STIFFNESS, FRICTION, RESTITUTION = 2500.0, 1e5, 0.5, 0.3
GRAVITY = 9.81
RATIO_T, RATIO_DAMPING = 2 / 7, 0.5  # tangential / normal stiffness, tangential / normal damping
SOLID = 0.58                 # expected solid fraction; determines only the number of grains
REST = 0.6                   # [s] time for pouring; the total duration is twice as long
SLICES = 5                   # number of slices of depth; the first one is excluded (contact with single grains)
BAR = 0.05                   # [-] tolerance of the difference


def student95(freedom):
    """Two-sided 95 % quantile of Student's distribution (table to 30, then Cornish-Fisher)."""
    table = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131,
             2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042]
    return table[freedom - 1] if freedom <= 30 else 1.95996 + 2.3722 / freedom


def interval(values):
    """Mean of the values, and half width of its 95 % interval."""
    values = numpy.asarray(values, float)
    if len(values) < 2:
        return float(values.mean()), math.inf
    return float(values.mean()), student95(len(values) - 1) * float(values.std(ddof=1)) / math.sqrt(len(values))


def damping():
    """gamma [1/s] in F_n = k overlap + gamma m_eff v_n that results in RESTITUTION at the mean mass.

    zeta = -ln e / sqrt(pi^2 + ln^2 e) is valid for attractive dashpots; both programs use the same value.
    """
    mass = DENSITY * math.pi / 6 * D ** 3
    log = math.log(RESTITUTION)
    zeta = -log / math.sqrt(math.pi ** 2 + log ** 2)
    return 2 * zeta * math.sqrt(STIFFNESS / (mass / 2))


class Case:
    """Sizes in metres, converted from options in mean grain diameters."""

    def __init__(self, options):
        self.bin, self.deep, self.plate = options.bin * D, options.deep * D, options.plate * D
        self.speed, self.sinkage = options.speed, options.sinkage * options.plate * D
        self.tall = self.sinkage + 4 * D  # height of the plate, so that no grains reach its top
        smallest = DENSITY * math.pi / 6 * (D * (1 - SPREAD)) ** 3
        contact = math.pi / math.sqrt(STIFFNESS / (smallest / 2) - (damping() / 2) ** 2)
        self.step = float(f"{contact / options.steps:.3g}")
        self.grains = round(SOLID * self.bin ** 2 * self.deep / (math.pi / 6 * D ** 3 * (1 + SPREAD ** 2)))
        self.high = 3 * self.deep  # height of the initial cloud of grains

    def material(self, friction, name):
        return (f"[material.{name}]\ndensity = {DENSITY}\nstiffness = {STIFFNESS}\ndamping = {damping()!r}\n"
                f"friction = {friction}\ntangential_stiffness_ratio = {RATIO_T!r}\n"
                f"tangential_damping_ratio = {RATIO_DAMPING}\n")

    def scene(self, seconds, rows, more, seed):
        sides = "".join(
            f"[[plane]]\nmaterial = \"smooth\"\npoint = [{p[0]}, {p[1]}, 0]\nnormal = [{n[0]}, {n[1]}, 0]\n"
            for p, n in (((0, 0), (1, 0)), ((self.bin, 0), (-1, 0)), ((0, 0), (0, 1)), ((0, self.bin), (0, -1))))
        return (f"version = 1\n[run]\nduration = {seconds!r}\ntime_step = {self.step!r}\nthreads = 1\ndevice = \"cpu\"\n"
                f"seed = {seed}\ngravity = [0, 0, {-GRAVITY}]\noutput_interval = {rows!r}\nframe_interval = {seconds!r}\n"
                f"checkpoint_interval = 0\n[output]\npicture = false\n" + self.material(FRICTION, "grain") +
                self.material(0.0, "smooth") + "[[plane]]\nmaterial = \"grain\"\nname = \"floor\"\n" + sides + more)


def call(words, log):
    begin = time.time()
    with open(log, "w") as out:
        done = subprocess.run(words, stdout=out, stderr=subprocess.STDOUT, check=False)
    if done.returncode != 0:
        sys.exit(f"{words[0]} failed with exit code {done.returncode}; see {log}")
    return time.time() - begin


def pour(case, grouser, folder, seed):
    """Positions and radii of a settled bed [n][4] [m]."""
    bed = folder / "bed.txt"
    if not bed.exists():
        text = case.scene(2 * REST, REST / 4, (
            f"[[grains]]\nform = \"random\"\nlow = [0, 0, 0]\nhigh = [{case.bin}, {case.bin}, {case.high}]\n"
            f"number = {case.grains}\nradius = {0.5 * D * (1 - SPREAD)!r}\nradius_to = {0.5 * D * (1 + SPREAD)!r}\n"
            f"material = \"grain\"\n"), seed)
        (folder / "pour.toml").write_text(text)
        call([grouser, "run", str(folder / "pour.toml"), "--out", str(folder / "pour"), "--force"],
             folder / "pour.log")
        with h5py.File(folder / "pour" / "frames.h5") as file:
            grains = file[[name for name in sorted(file) if name.isdigit()][-1] + "/grains"]
            rows = numpy.c_[grains["position"][:], grains["radius"][:]]
        numpy.savetxt(bed, rows, fmt="%.17g", header="x, y, z, r [m]")
    return numpy.loadtxt(bed)


def press_grouser(case, grouser, folder, top):
    """Sinkage [m] and force [N] of each row."""
    table = folder / "grouser.csv"
    if not table.exists():
        middle = 0.5 * case.bin
        text = case.scene(case.sinkage / case.speed, case.sinkage / case.speed / 1000, (
            f"[[grains]]\nform = \"file\"\nfile = \"bed.txt\"\nmaterial = \"grain\"\n"
            f"[[box]]\nname = \"plate\"\nmaterial = \"grain\"\nposition = [{middle!r}, {middle!r}, {top + 0.5 * case.tall!r}]\n"
            f"size = [{case.plate!r}, {case.plate!r}, {case.tall!r}]\nvelocity = [0, 0, {-case.speed!r}]\n"), 1)
        (folder / "press.toml").write_text(text)
        seconds = call([grouser, "run", str(folder / "press.toml"), "--out", str(folder / "press"), "--force"],
                       folder / "press.log")
        with open(folder / "press" / "timeseries.csv") as file:
            rows = [(top + 0.5 * case.tall - float(row["surfaces.plate.position.z [m]"]),
                     float(row["surfaces.plate.force.z [N]"])) for row in csv.DictReader(file)]
        # Forces are means since the previous row, so that they belong to the middle of this interval.
        rows = [(0.5 * (before[0] + row[0]), row[1]) for before, row in zip(rows, rows[1:])]
        numpy.savetxt(table, rows, delimiter=",", fmt="%.9g", header=f"sinkage [m],force [N]; {seconds:.1f} s")
    return numpy.loadtxt(table, delimiter=",")


def write_plate(path, case, top):
    """Writes the plate as an STL file of twelve triangles."""
    middle, half = 0.5 * case.bin, 0.5 * case.plate
    low = numpy.array([middle - half, middle - half, top])
    high = numpy.array([middle + half, middle + half, top + case.tall])
    corner = [numpy.where([(k >> a) & 1 for a in range(3)], high, low) for k in range(8)]
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    with open(path, "w") as out:
        out.write("solid plate\n")
        for a, b, c, d in sides:
            for triangle in ((a, b, c), (a, c, d)):
                p, q, r = (corner[k] for k in triangle)
                n = numpy.cross(q - p, r - p)
                n /= numpy.linalg.norm(n)
                out.write("facet normal %g %g %g\nouter loop\n" % tuple(n))
                for v in (p, q, r):
                    out.write("vertex %.9g %.9g %.9g\n" % tuple(v))
                out.write("endloop\nendfacet\n")
        out.write("endsolid plate\n")


def liggghts_input(case, top):
    """Input file. Atom types: 1 grains, 2 floor and plate, 3 smooth sides."""
    steps = round(case.sinkage / case.speed / case.step)
    every = max(1, steps // 1000)
    pairs = lambda value: " ".join([repr(value)] * 9)
    friction = " ".join(repr(FRICTION if 3 not in (i, j) else 0.0) for i in (1, 2, 3) for j in (1, 2, 3))
    model = "gran model hooke/stiffness tangential history tangential_damping on limitForce on"
    plane = "wall/gran model hooke/stiffness tangential history primitive type"
    on = "tangential_damping on limitForce on"
    return f"""# written by plate.py
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
read_data bed.data
neighbor {0.15 * D} bin
neigh_modify delay 0
fix kn all property/global kn peratomtypepair 3 {pairs(STIFFNESS)}
fix kt all property/global kt peratomtypepair 3 {pairs(STIFFNESS * RATIO_T)}
fix gn all property/global gamman peratomtypepair 3 {pairs(damping())}
fix gt all property/global gammat peratomtypepair 3 {pairs(damping() * RATIO_DAMPING)}
fix mu all property/global coefficientFriction peratomtypepair 3 {friction}
pair_style {model}
pair_coeff * *
timestep {case.step!r}
fix weight all gravity {GRAVITY} vector 0.0 0.0 -1.0
fix floor all {plane} 2 zplane 0.0 {on}
fix left all {plane} 3 xplane 0.0 {on}
fix right all {plane} 3 xplane {case.bin!r} {on}
fix front all {plane} 3 yplane 0.0 {on}
fix back all {plane} 3 yplane {case.bin!r} {on}
fix plate all mesh/surface/stress file plate.stl type 2
fix press all wall/gran model hooke/stiffness tangential history mesh n_meshes 1 meshes plate {on}
fix move all move/mesh mesh plate linear 0.0 0.0 {-case.speed!r}
fix advance all nve/sphere
variable sinkage equal {case.speed!r}*step*{case.step!r}
variable force equal f_plate[3]
fix mean all ave/time 1 {every} {every} v_sinkage v_force file liggghts.txt
thermo {max(1, steps // 10)}
thermo_style custom step atoms ke v_force
run {steps}
"""


def press_liggghts(case, program, folder, top, bed):
    table = folder / "liggghts.csv"
    if not table.exists():
        write_plate(folder / "plate.stl", case, top)
        with open(folder / "bed.data", "w") as out:
            out.write(f"bed\n\n{len(bed)} atoms\n3 atom types\n\n"
                      f"{-D} {case.bin + D} xlo xhi\n{-D} {case.bin + D} ylo yhi\n{-D} {top + case.tall + 4 * D} zlo zhi\n\nAtoms\n\n")
            for k, (x, y, z, r) in enumerate(bed):
                out.write("%d 1 %.17g %g %.17g %.17g %.17g\n" % (k + 1, 2 * r, DENSITY, x, y, z))
        (folder / "in.plate").write_text(liggghts_input(case, top))
        begin = time.time()
        with open(folder / "liggghts.log", "w") as out:
            done = subprocess.run([program, "-in", "in.plate", "-log", "none"], cwd=folder, stdout=out,
                                  stderr=subprocess.STDOUT, check=False)
        if done.returncode != 0:
            sys.exit(f"{program} failed with exit code {done.returncode}; see {folder / 'liggghts.log'}")
        rows = numpy.loadtxt(folder / "liggghts.txt")[:, 1:]
        numpy.savetxt(table, rows, delimiter=",", fmt="%.9g",
                      header=f"sinkage [m],force [N]; {time.time() - begin:.1f} s")
    return numpy.loadtxt(table, delimiter=",")


def slice_means(rows, sinkage):
    """Mean force in each slice of the depth [N]."""
    edges = numpy.linspace(0, sinkage, SLICES + 1)
    return [float(rows[(rows[:, 0] > a) & (rows[:, 0] <= b), 1].mean()) for a, b in zip(edges[:-1], edges[1:])]


def verdict(mean, half):
    if abs(mean) + half <= BAR:
        return "equal"
    return "differs" if abs(mean) - half > BAR else "inconclusive"


def report(case, results, folder):
    ours, theirs = (numpy.array([r[k] for r in results]) for k in (0, 1))
    lines = ["slice,from [plate],to [plate],grouser [N],half width [N],liggghts [N],half width [N],"
             "difference [-],half width [-],seeds,verdict"]
    share = case.sinkage / case.plate / SLICES
    print(f"\n  {'sinkage / plate':>16} {'grouser [N]':>18} {'LIGGGHTS [N]':>18} {'difference [%]':>18}   5 %")
    groups = [(f"{k * share:.2f} to {(k + 1) * share:.2f}", [k]) for k in range(SLICES)]
    groups.append((f"{share:.2f} to {SLICES * share:.2f}", list(range(1, SLICES))))
    for label, which in groups:
        a, b = ours[:, which].mean(axis=1), theirs[:, which].mean(axis=1)
        mean = a.mean()
        difference, half = interval((b - a) / mean)
        (ma, ha), (mb, hb) = interval(a), interval(b)
        print(f"  {label:>16} {ma:9.1f} +- {ha:5.1f} {mb:9.1f} +- {hb:5.1f} {100 * difference:+9.2f} +- "
              f"{100 * half:4.2f}   {verdict(difference, half)}")
        lines.append(f"{label},{which[0] * share:.3f},{(which[-1] + 1) * share:.3f},{ma:.5g},{ha:.3g},{mb:.5g},{hb:.3g},"
                     f"{difference:.5f},{half:.5f},{len(results)},{verdict(difference, half)}")
    print("  +-: 95 % intervals over the seeds (Student's t); differences are paired by seed")
    (folder / "plate_reference.csv").write_text("\n".join(lines) + "\n")


def draw(folder, tables, case):
    try:
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
    except ImportError:
        return
    figure, axis = pyplot.subplots(figsize=(6, 4))
    for k, (ours, theirs) in enumerate(tables):
        for rows, colour, name in ((ours, "C0", "grouser"), (theirs, "C1", "LIGGGHTS")):
            axis.plot(rows[:, 0] / case.plate, rows[:, 1], color=colour, linewidth=0.5,
                      label=name if k == 0 else None)
    axis.set_xlabel("sinkage / plate [-]")
    axis.set_ylabel("force [N]")
    axis.legend()
    figure.tight_layout()
    figure.savefig(folder / "plate_reference.png", dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--grouser", default="build/bin/grouser")
    parser.add_argument("--liggghts", default="liggghts")
    parser.add_argument("--out", default="out/plate_reference")
    parser.add_argument("--seeds", type=int, default=16)
    parser.add_argument("--bin", type=float, default=16, help="width of the square bin [grain diameters]")
    parser.add_argument("--deep", type=float, default=8, help="depth of the bed [grain diameters]")
    parser.add_argument("--plate", type=float, default=8, help="side length of the square plate [grain diameters]")
    parser.add_argument("--sinkage", type=float, default=0.3, help="final sinkage [side lengths]")
    parser.add_argument("--speed", type=float, default=0.05, help="speed of the plate [m/s]")
    parser.add_argument("--steps", type=float, default=20, help="number of steps per shortest contact")
    parser.add_argument("--jobs", type=int, default=1, help="number of parallel runs of grouser")
    parser.add_argument("--only", choices=["grouser"], help="only run grouser, e.g. where LIGGGHTS is missing; a later "
                        "call, also with a copy of the folder on another machine, does the rest")
    options = parser.parse_args()
    case = Case(options)
    out = pathlib.Path(options.out)
    out.mkdir(parents=True, exist_ok=True)
    print(f"bin {options.bin:g} d wide, bed {options.deep:g} d deep, {case.grains} grains of d = {1e3 * D:g} mm +- "
          f"{100 * SPREAD:g} %; plate {options.plate:g} d, {case.speed} m/s to {case.sinkage:.3f} m; step {case.step} s")
    seeds = range(1, options.seeds + 1)

    def prepare(seed):
        folder = out / f"seed{seed}"
        folder.mkdir(exist_ok=True)
        bed = pour(case, options.grouser, folder, seed)
        near = (abs(bed[:, :2] - case.bin / 2) < case.plate / 2 + D).all(axis=1)
        top = float((bed[near, 2] + bed[near, 3]).max()) + 1e-6
        return folder, bed, top, press_grouser(case, options.grouser, folder, top)

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        prepared = list(pool.map(prepare, seeds))
    if options.only:
        return
    results, tables = [], []
    for seed, (folder, bed, top, ours) in zip(seeds, prepared):
        theirs = press_liggghts(case, options.liggghts, folder, top, bed)
        results.append((slice_means(ours, case.sinkage), slice_means(theirs, case.sinkage)))
        tables.append((ours, theirs))
        a, b = (sum(r[1:]) for r in results[-1])
        print(f"seed {seed}: force in LIGGGHTS / grouser {b / a:.4f}", flush=True)
    report(case, results, out)
    draw(out, tables, case)


if __name__ == "__main__":
    main()
