#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Series of the Python package: half widths in arithmetic, rows, names and units."""
import unittest

import numpy
from fixture import FolderTest

import grouser
from grouser.series import split_unit

TIME = numpy.array([0.0, 0.1, 0.2])


def barred(values, seeds, step, bar, name="error"):
    arrays = map(numpy.array, (seeds, step, bar))
    return grouser.BarredSeries(numpy.array(values), "J", "", name, TIME, None, (), *arrays)


class Bars(unittest.TestCase):
    def widths(self, series):
        self.assertIsInstance(series, grouser.BarredSeries)
        return [series.by_seeds.tolist(), series.by_step.tolist(), series.bar.tolist()]

    def test_go_with_their_series(self):
        one = barred([1.0, 2.0, 4.0], [1.0, 2.0, 3.0], [0.5, 1.0, 1.5], [2.0, 3.0, 4.0])
        other = barred([1.0, 1.0, 1.0], [4.0, 4.0, 4.0], [2.0, 2.0, 2.0], [8.0, 8.0, 8.0])
        plain = grouser.Series(numpy.ones(3), "J", "", "work", TIME)
        same = [[1.0, 2.0, 3.0], [0.5, 1.0, 1.5], [2.0, 3.0, 4.0]]
        twice = [[2.0, 4.0, 6.0], [1.0, 2.0, 3.0], [4.0, 6.0, 8.0]]
        both = [[5.0, 6.0, 7.0], [2.5, 3.0, 3.5], [10.0, 11.0, 12.0]]
        for made, values, widths in (
                (2 * one, [2, 4, 8], twice), (one * -2, [-2, -4, -8], twice), (one / -0.5, [-2, -4, -8], twice),
                (-one, [-1, -2, -4], same), (one - one, [0, 0, 0], twice), (one + other, [2, 3, 5], both),
                (other - one, [0, -1, -3], both), (one - plain, [0, 1, 3], same), (plain - one, [0, -1, -3], same)):
            self.assertEqual((made.value.tolist(), self.widths(made)), (values, widths), made.name)

    def test_are_those_of_the_rows_that_are_taken(self):
        one = barred([1.0, 2.0, 4.0], [1.0, 2.0, 3.0], [0.5, 1.0, 1.5], [2.0, 3.0, 4.0])
        for made in (one.between(0.1, 1), one[1:]):
            self.assertEqual((made.value.tolist(), made.time.tolist()), ([2, 4], [0.1, 0.2]))
            self.assertEqual(self.widths(made), [[2.0, 3.0], [1.0, 1.5], [3.0, 4.0]])


class Rows(unittest.TestCase):
    def test_are_gone_through_and_sliced(self):
        series = grouser.Series(numpy.arange(6.0).reshape(3, 2), "m", "", "place", TIME, numpy.arange(3), ("x", "y"))
        self.assertEqual([row.tolist() for row in series], [[0, 1], [2, 3], [4, 5]])
        self.assertEqual(list(series["x"]), [0, 2, 4])
        self.assertEqual(series[-1].tolist(), [4, 5])
        taken = series[1:3]
        self.assertEqual((taken.time.tolist(), taken.step.tolist(), taken.name), ([0.1, 0.2], [1, 2], "place"))
        self.assertEqual(taken["y"].value.tolist(), [3, 5])
        with self.assertRaises(IndexError):
            series[3]
        with self.assertRaisesRegex(KeyError, "no column 'z'; it has x, y"):
            series["z"]


class Names(FolderTest):
    def test_of_sums_are_as_they_were_written(self):
        energy = grouser.Series(numpy.ones(3), "J", "", "kinetic", TIME)
        for wrong, words in ((lambda: 1 - energy, r"^1 \[-\] - kinetic \[J\]: the units differ"),
                             (lambda: 1 + energy, r"^1 \[-\] \+ kinetic \[J\]: the units differ"),
                             (lambda: energy - 1, r"^kinetic \[J\] - 1 \[-\]: the units differ")):
            with self.assertRaisesRegex(ValueError, words):
                wrong()
        slip = grouser.Series(numpy.ones(3) / 4, "-", "", "slip", TIME)
        self.assertEqual(((1 - slip).name, (1 - slip).value.tolist()), ("1 - slip", [0.75] * 3))
        self.assertEqual((2 + slip).name, "2 + slip")

    def test_and_units_of_headings(self):
        for heading, split in (("sinkage mean [m]", ("sinkage mean", "m")), ("ratio", ("ratio", "")),
                               ("terrain.max_speed [m/s] at the end", ("terrain.max_speed at the end", "m/s")),
                               ("momentum.x [N s] at the end", ("momentum.x at the end", "N s")), ("a[0]", ("a[0]", ""))):
            self.assertEqual(split_unit(heading), split)


if __name__ == "__main__":
    unittest.main()
