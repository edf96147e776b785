#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Series of the Python package: arithmetic with half widths, rows, names and units."""
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
        with self.assertRaisesRegex(KeyError, "no column 'z'; named columns: x, y"):
            series["z"]


class Printed(unittest.TestCase):
    def test_in_one_line(self):
        rows = numpy.arange(0, 101) / 100
        for one, text in (
                (grouser.Series(rows**2, "m", "", "way", rows),
                 "way [m]: 101 rows from 0 to 1 s, first 0, last 1, min 0, mean 0.335, max 1"),
                (grouser.Series(numpy.where(rows < 0.5, numpy.nan, 1.0), "-", "", "slip", rows),
                 "slip [-]: 101 rows from 0 to 1 s, first nan, last 1, min 1, mean 1, max 1, 50 of 101 are NaN"),
                (grouser.Series(numpy.zeros((101, 3)), "m", "", "place", rows, None, ("x", "y", "z")),
                 "place [m]: 101 rows from 0 to 1 s, x 0 to 0, y 0 to 0, z 0 to 0"),
                (grouser.Series(numpy.zeros((1, 46)), "N", "", "tension", rows[:1]),
                 "tension [N]: 1 row from 0 to 0 s of 46 columns, 0 to 0"),
                (grouser.Series(numpy.array([[1.0, numpy.nan], [-2.0, numpy.nan]]), "N", "", "force", rows[:2], None, ("x", "y")),
                 "force [N]: 2 rows from 0 to 0.01 s, x -2 to 1, y no finite value, 2 of 4 are NaN"),
                (grouser.Series(rows[:0], "m", "", "way", rows[:0]), "way [m]: 0 rows"),
                (grouser.Quantity(numpy.array(3.25), "m", "", "radius"), "radius [m]: 3.25"),
                (grouser.Quantity(numpy.arange(5.0), "m", "", "depth"), "depth [m]: [5], 0 to 4"),
                (barred([1.0, 2.0, 4.0], [1.0] * 3, [1.0] * 3, [1.0] * 3),
                 "error [J]: 3 rows from 0 to 0.2 s, first 1, last 4, min 1, mean 2.333, max 4")):
            self.assertEqual((str(one), repr(one)), (text, text))

    def test_with_no_more_digits_than_the_interval_allows(self):
        for value, half, text in ((0.27056, 4e-12, "z = 0.27056 m"), (0.27056, 0.0, "z = 0.27056 m"),
                                  (0.0673, 0.0103, "z = 0.067 +- 0.010 m"), (1234567.0, 21000.0, "z = (1.235 +- 0.021)e6 m"),
                                  (0.5, numpy.nan, "z = 0.5 +- ? m"), (numpy.nan, numpy.nan, "z = nan m"),
                                  (-0.0004, 0.0031, "z = -0.0004 +- 0.0031 m (inconclusive)"), (0.0, 3e-4, "z = (0.0 +- 3.0)e-4 m (inconclusive)")):
            one = grouser.Estimate(value, half, "m", "z")
            self.assertEqual((str(one), repr(one)), (text, text))
        self.assertEqual(str(grouser.Estimate(0.25, 0.01, "-", "slip")), "slip = 0.250 +- 0.010")

    def test_without_the_arrays_of_what_holds_several(self):
        surface = grouser.Surface(TIME, TIME, numpy.zeros((3, 3)), "bilinear")
        self.assertEqual(repr(surface), "<Surface x: array [3], y: array [3], height: array [3, 3], "
                                        "interpolation: 'bilinear', final_height: None>")


class Doubt(FolderTest):
    def test_of_an_estimate_whose_interval_is_wider_than_itself(self):
        for value, half, doubtful in ((-47, 12155, True), (-47, 46, False), (0.0, 0.0, False), (1, float("inf"), False),
                                      (float("nan"), float("nan"), False)):
            estimate = grouser.series.Estimate(value, half, "N m", "torque")
            self.assertIs(bool(estimate.inconclusive), doubtful, str(estimate))
            self.assertEqual("(inconclusive)" in str(estimate), doubtful)

    def test_of_runs_and_means_of_a_sweep(self):
        about = "run,k,status,message,inconclusive,wall time [s],steps,simulated time [s],slip [-],state hash"
        (self.folder / "summary.csv").write_text(f"{about}\nk=1,1,incomplete,never drove,see message,1,1,1,0.2,x\n"
                                                 "k=2,2,finished,,,1,1,1,0.1,y\n")
        (self.folder / "intervals.csv").write_text(
            "k,figure,seeds,mean,half width,difference to the first,half width of the difference,inconclusive\n"
            "1,slip [-],2,0.2,0.1,0,0,never drove\n2,slip [-],2,0.1,0.05,0,0,\n")
        sweep = grouser.open_sweep(self.folder)
        self.assertEqual([run.status for run in sweep.runs], ["incomplete", "finished"])
        self.assertEqual([run.inconclusive for run in sweep.runs], ["never drove", ""])
        self.assertEqual(list(sweep.units), ["slip"])
        self.assertTrue(str(sweep).endswith("2 runs over k; incomplete: k=1>"), str(sweep))
        self.assertEqual(str(sweep["slip"]), "slip [-]: [2], 0.1 to 0.2, inconclusive: k=1")
        self.assertEqual([mean.inconclusive for mean in sweep.means["slip"]], ["never drove", ""])


    def test_of_the_figures_that_are_named_alone(self):
        (self.folder / "summary.csv").write_text(
            "run,k,status,message,inconclusive,wall time [s],steps,simulated time [s],slip [-],drawbar pull [N],state hash\n"
            'k=1,1,finished,,"direction of motion changes: gross traction, drawbar pull, motion resistance",1,1,1,0.2,30,x\n')
        run, = grouser.open_sweep(self.folder).runs
        self.assertEqual([bool(run.doubt(figure)) for figure in ("slip", "drawbar pull")], [False, True])


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
