#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""How far the trials of trials.csv are off under every plate, how much beds scatter, and by which power of the diameter
measured and simulated pressures grow.

    trials.py
"""
import csv
import pathlib

import numpy

STUDENT = {2: 12.706, 4: 3.182}  # 97.5 % quantile of as many beds


def read():
    """{parameters and beds: rows}"""
    trials = {}
    with open(pathlib.Path(__file__).with_name("trials.csv"), encoding="utf-8") as file:
        for text in csv.DictReader(file):
            row = {key: float(value) for key, value in text.items()}
            key = (row["friction"], row["rolling friction"], row["depth [mm]"], int(row["beds"]))
            trials.setdefault(key, []).append(row)
    return trials


def power(rows, sinkage, column):
    at = {row["diameter [mm]"]: row[column] for row in rows if row["sinkage [mm]"] == sinkage}
    return numpy.polyfit(numpy.log(list(at)), numpy.log(list(at.values())), 1)[0]


def main():
    for (friction, rolling, depth, beds), rows in read().items():
        off = {diameter: 100 * numpy.mean([row["simulated [kPa]"] / row["measured [kPa]"] - 1 for row in rows
                                           if row["diameter [mm]"] == diameter]) for diameter in (60, 80, 100)}
        near = sum(abs(row["simulated [kPa]"] - row["measured [kPa]"]) <= 2 * row["deviation [kPa]"] for row in rows)
        scatter = [row["half width [kPa]"] * beds**0.5 / STUDENT[beds] / row["simulated [kPa]"] for row in rows]
        powers = [power(rows, sinkage, "simulated [kPa]") for sinkage in (5, 10, 15)]
        print(f"friction {friction:g}, rolling friction {rolling:g}, {depth:g} mm, {beds} beds: "
              f"misfit {rows[0]['misfit']:.2f}, {near} of {len(rows)} within two deviations; "
              f"{off[60]:+.0f} %, {off[80]:+.0f} %, {off[100]:+.0f} % under 60, 80 and 100 mm; beds scatter by {100 * numpy.sqrt(numpy.mean(numpy.square(scatter))):.0f} %; powers of the "
              f"diameter at 5, 10 and 15 mm {powers[0]:.1f}, {powers[1]:.1f} and {powers[2]:.1f}")
    powers = [power(rows, sinkage, "measured [kPa]") for sinkage in (5, 10, 15)]
    print(f"measured powers {powers[0]:.1f}, {powers[1]:.1f} and {powers[2]:.1f}")


if __name__ == "__main__":
    main()
