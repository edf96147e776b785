#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The examples run, and their results agree with known values."""
import csv
import unittest

import numpy
from fixture import FolderTest

import boulder_drops
import bouncing_grain
import cruise_control
import environment
import error_bars
import hello_world
import live_plot
import plate_stress
import slip_control
import towed_block
import track_sinkage

import grouser  # noqa: E402

GRAVITY = 9.81  # [m/s2]


class BouncingGrain(FolderTest):
    def test_measures_the_restitution_that_was_asked_for(self):
        measured = bouncing_grain.main(str(self.folder))
        self.assertEqual(len(measured), 3)
        impact = (2 * GRAVITY * bouncing_grain.HEIGHT) ** 0.5  # [m/s]
        # Speeds are from frames 1 ms apart: each may differ from the impact speed by g dt.
        tolerance = 2 * GRAVITY * 1e-3 / impact
        for asked, found in measured.items():
            self.assertAlmostEqual(found, asked, delta=tolerance)


class PlateStress(unittest.TestCase):
    """The full runs take minutes; docs/reports.md shows their figure."""

    def test_compares_with_the_tabulated_influence_of_a_square(self):
        self.assertAlmostEqual(float(plate_stress.below_corner(1.0, 1.0, 1.0)), 0.1752, 4)  # Newmark's table
        self.assertAlmostEqual(4 * float(plate_stress.below_corner(0.5, 0.5, 1.0)), 0.3361, 4)
        self.assertAlmostEqual(plate_stress.boussinesq(1e-3), 1, delta=0.02)

    def test_puts_a_cell_grid_under_the_plate(self):
        output = plate_stress.scene_of(1)["output"]
        for axis, middle in enumerate((plate_stress.SIDE / 2, 0)):
            low, high = output["fields_low"][axis], output["fields_high"][axis]
            self.assertAlmostEqual((low + high) / 2, middle)
            self.assertAlmostEqual((high - low) / plate_stress.CELL % 2, 1)


class BoulderDrops(unittest.TestCase):
    """The runs take minutes: docs/mechanisms.md#example-scenes has the figure."""

    def test_finds_the_exponent_of_depths_that_follow_the_experiments(self):
        heights = numpy.array(boulder_drops.DROP_HEIGHTS)
        depths = numpy.full((len(heights), 3), 0.1)
        for _ in range(50):
            depths = boulder_drops.expected(heights[:, None], depths, 0.6)
        slope, bar = boulder_drops.exponent(heights, depths)
        self.assertAlmostEqual(slope, 1 / 3, 9)
        self.assertLess(bar, 1e-6)
        scatter = 1 + 0.05 * numpy.random.default_rng(1).standard_normal(depths.shape)
        slope, bar = boulder_drops.exponent(heights, depths * scatter)
        self.assertLess(abs(slope - 1 / 3), bar)
        self.assertLess(bar, 0.1)

    def test_takes_the_quantile_of_student(self):
        for free, quantile in ((5, 2.571), (13, 2.160), (100, 1.984)):  # tables
            self.assertAlmostEqual(boulder_drops.student(free) / quantile, 1, delta=0.01)


class TowedBlock(unittest.TestCase):
    """The runs take minutes: docs/mechanisms.md#example-scenes has the figure."""

    def test_puts_the_nose_ahead_of_the_sole(self):
        self.assertEqual(len(towed_block.shapes_of(90)), 1)
        for slope in towed_block.SLOPES[1:]:
            along = numpy.array([numpy.cos(numpy.radians(slope)), numpy.sin(numpy.radians(slope))])
            block, ramp, face = towed_block.shapes_of(slope)
            below = numpy.array(ramp["position"])[[0, 2]] + ramp["size"][2] / 2 * numpy.array([along[1], -along[0]])
            sole = numpy.array([block["size"][0], -block["size"][2]]) / 2
            numpy.testing.assert_allclose(below - ramp["size"][0] / 2 * along, sole, atol=1e-12)
            self.assertEqual(ramp["angle"], -slope)  # about y, which turns x towards -z
            self.assertAlmostEqual(face["position"][2] - face["size"][2] / 2, sole[1] + towed_block.NOSE)
            self.assertAlmostEqual(face["position"][0] + face["size"][0] / 2, sole[0] + towed_block.NOSE * along[0] / along[1])


class TrackSinkage(FolderTest):
    def test_reads_what_the_program_wrote_as_text_too(self):
        run = track_sinkage.main(str(self.folder / "drive"))
        means = track_sinkage.sinkage_by_shoe(run)
        with open(self.folder / "drive/sinkage.csv", newline="") as file:
            rows = list(csv.reader(file))
        heading = next(row for row in rows if any("left" in cell for cell in row))
        body = [row for row in rows[rows.index(heading) + 1:]]
        for side in ("left", "right"):
            columns = [k for k, cell in enumerate(heading) if side in cell]
            self.assertEqual(len(columns), len(means[side]))
            table = numpy.array([[float(row[k] or "nan") for k in columns] for row in body])
            carried = numpy.isfinite(table).any(axis=0)
            self.assertGreater(carried.sum(), 4)
            self.assertTrue((carried == numpy.isfinite(means[side])).all())
            # The text output has six digits.
            numpy.testing.assert_allclose(means[side][carried], numpy.nanmean(table[:, carried], axis=0), rtol=1e-5,
                                          atol=1e-6)

        # Shoe positions agree between frames and series: the lowest point of the plate is within one shoe.
        heights = run.by_shoe("pad_height")["left"]
        places = run.frames.part("left shoe 0")
        for time in (0.0, 0.3):
            self.assertLess(abs(heights.at(time)[0] - places["z"].at(time)), 0.15)
        self.assertAlmostEqual(run.surface.x[-1] - run.surface.x[0], 4.2, delta=0.2)
        # The vehicle has compressed the bed below its tracks; a depth of less than a grain is not a rut.
        rise = run.surface.final_height - run.surface.height
        self.assertEqual(rise.shape, (len(run.surface.y), len(run.surface.x)))
        self.assertLess(rise.min(), -0.01)

        # The final checkpoint and the last frame contain the same grains; frames are in single precision.
        bed, last = run.bed(), run.frames[-1]
        order = numpy.argsort(last.id)
        self.assertEqual(len(bed), len(last))
        numpy.testing.assert_allclose(bed.position, last.position[order], atol=3e-7)
        numpy.testing.assert_allclose(bed.radius, last.radius[order], rtol=1e-6)
        self.assertLess(bed.position.min(), 0, "coordinates of both signs are read")
        self.assertGreater(bed.fixed.sum(), 0, "the floor is of fixed grains")
        self.assertAlmostEqual(float(bed.structure["porosity"]), float(run.constants["terrain.bed.porosity"]), 12)
        run.close()


class ErrorBars(FolderTest):
    def test_agree_between_sweep_and_check(self):
        sweep, check, bed = error_bars.main(str(self.folder))
        self.assertEqual(len(sweep.runs), 6)
        self.assertTrue(all(run.status == "finished" for run in sweep.runs))
        force = sweep["ground force z"]
        self.assertEqual(force.unit, "N")
        self.assertEqual(force.value.shape, (6,))
        # The mean printed by the sweep equals the mean over its runs, and over the series in their files.
        first = sweep.means["ground force z"][0]
        self.assertAlmostEqual(first.mean.value, numpy.mean(force.value[:3]), places=6)
        with sweep.runs[0].open() as run:
            series = run["surfaces.ground.force"]["z"].between(0.1, 0.2)
            self.assertAlmostEqual(float(numpy.mean(series.value)), force.value[0], places=6)
        # Friction 0.5 is not in the sweep, but the weight is the same; the total bar is at least the bar of the seeds.
        figure = check["ground force z"]
        self.assertGreaterEqual(figure.bar.half_width, figure.by_seeds.half_width)
        self.assertEqual(set(figure.errors), {"step"})
        bars = check.series["ledger.kinetic"]
        self.assertEqual(bars.value.shape, bars.bar.shape)
        self.assertGreater(numpy.nanmax(bars.bar), 0)
        self.assertGreater(check.costs["base"]["wall_s"], 0)
        self.assertIn("depth", check.not_run)
        self.assertEqual(len(bed), 40)
        self.assertGreater(bed.position[:, 2].min(), 0.5 * 0.01, "no grain lies below the ground")


class Controllers(FolderTest):
    """Each example fails with its own error message if it misses its target."""

    def test_cruise_control_holds_its_speed_up_the_slope_and_is_replayed(self):
        self.assertAlmostEqual(cruise_control.main(str(self.folder / "held")), cruise_control.GOAL, delta=0.01)
        said = grouser.call(["run", "--replay", str(self.folder / "held")])
        self.assertIn("same state hash", said)

    def test_slip_control_finds_the_pull(self):
        slip, pull = slip_control.main(0.1)
        self.assertAlmostEqual(slip, 0.1, delta=0.01)
        self.assertGreater(pull, 0.1)

    def test_the_event_loop_logs_plots_and_stops(self):
        rows = live_plot.main(str(self.folder / "live"))
        self.assertGreater(rows[-1][1], live_plot.WAY)
        self.assertTrue((self.folder / "live/log.csv").is_file())
        self.assertTrue((self.folder / "live/live.png").is_file())

    def test_the_environment_rewards_the_rule(self):
        random, ruled = environment.main(limit=20)
        self.assertGreater(ruled, random)

    def test_hello_world_prints_the_hash_that_it_reached(self):
        scene = grouser.Scene.read(hello_world.ROOT / "runs/scenes/rigid_control.toml")
        scene["vehicle.sphere_radius"] = 0.03
        scene.write(self.folder / "coarse.toml")
        self.assertRegex(hello_world.main(str(self.folder / "coarse.toml")), "^[0-9a-f]{16}$")


if __name__ == "__main__":
    unittest.main()
