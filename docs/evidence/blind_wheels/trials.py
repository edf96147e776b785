#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the eight trials of trials.csv say: their misfits, and the least misfit of a linear regression over them; and where
the measured plates first bear 100 Pa, and by which power of the diameter their pressure grows.

    trials.py

Both with sinkage from the mean surface of the bed, and from contact at 100 Pa. Misfit: root mean square of
ln(simulated / measured) over the scatter of a test, at least 5 %, and of the angle of repose less 29 over 2 degrees. The
regression is linear in friction, rolling friction and depth; its least misfit is sought on a grid.
"""
import csv
import itertools
import pathlib

import numpy

ZEROS = ("from the mean surface", "from contact")
REPOSE, TOLERANCE, LEAST_SCATTER = 29, 2, 0.05
CENTRE, STEPS = numpy.array([0.41, 0.405, 72]), numpy.array([0.03, 0.065, 5])
GRID = [numpy.linspace(*ends) for ends in ((-2, 3, 21), (-2, 2, 17), (-2.4, 2, 23))]  # in steps


def read():
    """{parameters: (angle of repose, [rows])}"""
    with open(pathlib.Path(__file__).with_name("trials.csv"), encoding="utf-8") as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    trials = {}
    for row in rows:
        parameters = (row["friction"], row["rolling friction"], row["depth [mm]"])
        trials.setdefault(parameters, (row["repose [deg]"], []))[1].append(row)
    return trials


def residuals(trial, zero):
    """ln(simulated / measured) of the mean over the beds over the scatter of a test, a plate and sinkage each; repose."""
    repose, rows = trial
    points = {}
    for row in rows:
        points.setdefault((row["diameter [mm]"], row["sinkage [mm]"]), []).append(row)
    found = []
    for key in sorted(points):
        measured, deviation = points[key][0]["measured [kPa]"], points[key][0]["deviation [kPa]"]
        simulated = numpy.mean([row[f"{zero} [kPa]"] for row in points[key]])
        found.append(numpy.log(simulated / measured) / max(LEAST_SCATTER, deviation / measured))
    return numpy.array([*found, (repose - REPOSE) / TOLERANCE])


def misfit(values):
    return numpy.sqrt(numpy.mean(values**2))


def measured():
    """Where each of the nine tests first bears 100 Pa [mm]."""
    table = pathlib.Path(__file__).parents[3] / "assets" / "soils" / "targets" / "cmu_sand_plates.csv"
    tests = {}
    with open(table, encoding="utf-8") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            tests.setdefault(row["trial"], []).append((float(row["sinkage_mm"]), float(row["pressure_kPa"])))
    contacts = []
    for curve in tests.values():
        last = next(k for k, (_, pressure) in enumerate(curve) if pressure >= 0.1)
        (z, p), (after, more) = curve[max(last, 1) - 1], curve[max(last, 1)]
        contacts.append(z + (after - z) * (0.1 - p) / (more - p))
    return contacts


def main():
    trials = read()
    steps = numpy.array([(numpy.array(parameters) - CENTRE) / STEPS for parameters in trials])
    known = numpy.column_stack([numpy.ones(len(steps)), steps])
    for zero in ZEROS:
        values = numpy.array([residuals(trial, zero) for trial in trials.values()])
        for parameters, found in zip(trials, values):
            print("friction {:g}, rolling friction {:g}, {:g} mm: misfit {:.2f} {}".format(*parameters, misfit(found), zero))
        slopes = numpy.linalg.lstsq(known, values, rcond=None)[0]
        best = min(itertools.product(*GRID), key=lambda at: misfit(numpy.array([1, *at]) @ slopes))
        there, where = numpy.array([1, *best]) @ slopes, CENTRE + STEPS * numpy.array(best)
        print(f"regression {zero}: least misfit {misfit(there):.2f} at friction {where[0]:.3g}, rolling friction "
              f"{where[1]:.3g}, {where[2]:.3g} mm; {numpy.sum(abs(there[:-1]) <= 2)} of {len(there) - 1} pressures within two scatters")
    rows = [row for _, found in trials.values() for row in found]
    heights = [row["contact height [mm]"] for row in rows if row["sinkage [mm]"] == 5]
    porosities = [row["porosity"] for row in rows]
    print(f"contact {min(heights):.1f} to {max(heights):.1f} mm above the mean surface, mean {numpy.mean(heights):.2f} mm of "
          f"{len(heights)} plates; porosity {min(porosities):.3f} to {max(porosities):.3f}")
    first = [row["from the mean surface [kPa]"] / row["measured [kPa]"] - 1 for row in rows if row["sinkage [mm]"] == 5]
    for sinkage in (5, 15):
        pressures = {row["diameter [mm]"]: row["measured [kPa]"] for row in rows if row["sinkage [mm]"] == sinkage}
        power = numpy.polyfit(numpy.log(list(pressures)), numpy.log(list(pressures.values())), 1)[0]
        print(f"measured pressures at {sinkage} mm grow with the diameter to the power {power:.1f}")
    contacts = measured()
    print(f"the tests first bear 100 Pa at {min(contacts):.1f} to {max(contacts):.1f} mm, mean {numpy.mean(contacts):.1f} mm")
    print(f"from the mean surface at 5 mm {100 * min(first):+.0f} to {100 * max(first):+.0f} % off the measured means")


if __name__ == "__main__":
    main()
