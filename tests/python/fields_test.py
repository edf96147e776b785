#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Soil fields of a run: stress in a compressed box compared with its wall forces, shapes, positions, XDMF, and picture
in the report."""
import re
import unittest
import xml.etree.ElementTree as xml

import numpy
from fixture import MINIMAL, FolderTest

import grouser

SIDE = 0.062  # [m] inner width of the box


def pressed_box():
    """Rough grains between five smooth walls and a smooth lid with a load of 20 N."""
    walls = [{"name": name, "normal": normal, "point": position, "material": "smooth"} for name, normal, position in (
        ("floor", [0, 0, 1], [0, 0, 0]), ("left", [1, 0, 0], [0, 0, 0]), ("right", [-1, 0, 0], [SIDE, 0, 0]),
        ("front", [0, 1, 0], [0, 0, 0]), ("back", [0, -1, 0], [0, SIDE, 0]))]
    return grouser.Scene({
        "version": 1, "run": {"duration": 0.6, "time_step": 2e-5, "output_interval": 0.05, "frame_interval": 0.3},
        "material": {"glass": {"stiffness": 1e5, "restitution": 0.2, "friction": 0.4, "density": 2600},
                     "smooth": {"stiffness": 1e5, "restitution": 0.2, "friction": 0.0}},
        "plane": walls,
        "box": [{"name": "lid", "position": [SIDE / 2, SIDE / 2, 0.08], "size": [0.2, 0.2, 0.02], "material": "smooth",
                 "free": "z", "mass": 0.2, "load": -20.0}],
        "grains": [{"form": "lattice", "low": [0, 0, 0], "high": [SIDE, SIDE, 0.066], "radius": 0.005, "spacing": 2.02,
                    "jitter": 0.5, "material": "glass"}],
        "output": {"plots": False, "picture": False, "fields_cell": 0.021, "fields_low": [-0.01, -0.01, -0.01],
                   "fields_high": [0.075, 0.075, 0.08]}})


class FieldsOfTheSoil(FolderTest):
    def test_have_the_mean_stress_that_the_walls_bear(self):
        with pressed_box().run(self.folder / "box") as run:
            stress = run.fields("stress")
            self.assertEqual(stress.value.shape, (3, 4, 4, 4, 3, 3))
            numpy.testing.assert_allclose(stress.time, [0, 0.3, 0.6], atol=1e-9)
            self.assertEqual(stress.unit, "Pa")
            integral = stress.value[-1].sum(axis=(0, 1, 2), dtype=float) * stress.cell_volume

            def force(name, axis):
                return float(run[f"surfaces.{name}.force"][axis].value[-1])
            lid = float(run["surfaces.lid.position"]["z"].value[-1]) - 0.01
            # Sum of wall forces times positions: walls at the origin contribute 0, and the lid has no friction.
            self.assertAlmostEqual(integral[0, 0] / (-force("right", "x") * SIDE), 1, delta=0.01)
            self.assertAlmostEqual(integral[1, 1] / (-force("back", "y") * SIDE), 1, delta=0.01)
            frame = run.frames[-1]
            mass = 2600 * 4 / 3 * numpy.pi * 0.005**3
            weight = -9.81 * mass * float(frame.position[:, 2].sum(dtype=float))
            self.assertAlmostEqual(integral[2, 2] / (-force("lid", "z") * lid + weight), 1, delta=0.01)
            self.assertGreater(force("lid", "z"), 20)
            solid = ((1 - run.fields("porosity").value[-1]).sum() * stress.cell_volume)
            self.assertAlmostEqual(solid / (len(frame) * mass / 2600), 1, delta=1e-5)  # floats, overlap with walls
            self.assert_xdmf_points_to_them(run)

    def assert_xdmf_points_to_them(self, run):
        tree = xml.parse(run.folder / "frames.xdmf")
        grids = [grid for grid in tree.iter("Grid") if grid.get("Name") == "fields"]
        self.assertEqual(len(grids), 3)
        topology = grids[-1].find("Topology")
        self.assertEqual((topology.get("TopologyType"), topology.get("NumberOfElements")), ("3DCoRectMesh", "5 5 5"))
        corner, edge = ([float(v) for v in item.text.split()] for item in grids[-1].find("Geometry"))
        field = run.fields("velocity")
        numpy.testing.assert_allclose(corner, field.origin[::-1])
        numpy.testing.assert_allclose(edge, field.spacing[::-1])
        for attribute in grids[-1].iter("Attribute"):
            item = attribute.find("DataItem")
            name = item.text.split("/")[-1]
            self.assertIn(name, grouser.FIELDS)
            self.assertEqual(item.text.strip(), f"frames.h5:/000002/fields/{name}")
            shape = [4, 4, 4] + {"Scalar": [], "Vector": [3], "Tensor6": [6]}[attribute.get("AttributeType")]
            self.assertEqual([int(n) for n in item.get("Dimensions").split()], shape)

    def test_lie_where_their_grain_is_and_go_on_where_a_run_is_resumed(self):
        scene = grouser.Scene({**MINIMAL, "grain": [{"position": [0.03, 0.05, 0.1], "radius": 0.01, "material": "glass",
                                                     "velocity": [1, 2, 3]}]})
        scene["run.frame_interval"] = 0.005
        scene["output"] = {**MINIMAL["output"], "fields_cell": 0.02, "fields_low": [0, 0, 0], "fields_high": [0.06, 0.08, 0.2]}
        with scene.run(self.folder / "one") as run:
            porosity = run.fields("porosity")
            self.assertEqual(porosity.value.shape[1:], (10, 4, 3))
            numpy.testing.assert_allclose((porosity.x[1], porosity.y[2], porosity.z[4]), (0.03, 0.05, 0.09))
            solid = 1 - porosity.value[0]
            numpy.testing.assert_allclose(solid[4:6, 2, 1], numpy.pi / 12, rtol=1e-6)
            self.assertAlmostEqual(float(solid.sum()), numpy.pi / 6, places=6)
            numpy.testing.assert_allclose(run.fields("velocity").value[0, 4, 2, 1], [1, 2, 3], rtol=1e-6)
            self.assertTrue(numpy.isnan(run.fields("velocity").value[0, 0, 0, 0]).all())
            frames = len(run.frames)
        del scene["output"]["fields_low"], scene["output"]["fields_high"]
        with scene.run(self.folder / "box") as run:
            spans = [run.fields("porosity").value.shape[1:], run.fields("porosity").origin.tolist()]
        scene["run.duration"] = 0.02
        grouser.call(["run", str(scene.write(self.folder / "longer.toml")), "--resume", str(self.folder / "box/checkpoint.h5"),
                      "--out", str(self.folder / "box")])
        with grouser.open_run(self.folder / "box") as run:
            field = run.fields("porosity")
            self.assertGreater(len(run.frames), frames)
            self.assertEqual([field.value.shape[1:], field.origin.tolist()], spans)

    def test_are_asked_for_by_name_and_only_where_there_are_some(self):
        scene = grouser.Scene(MINIMAL)
        with scene.run(self.folder / "none") as run:
            with self.assertRaisesRegex(KeyError, "set output.fields_cell"):
                run.fields("stress")
            with self.assertRaisesRegex(KeyError, "no field 'strain'; fields are stress, strain_rate"):
                run.fields("strain")
            self.assertFalse(run.frames[0].has_fields)

    def test_refuse_cells_that_do_not_fit(self):
        for keys, words in (({"fields_cell": 0.01}, "smaller than the largest grain diameter, 0.02 m"),
                            ({"fields_cell": 0.02, "fields_low": [0, 0, 0]}, "fields_low .*requires fields_high"),
                            ({"fields_cell": 0.02, "fields_low": [0, 0, 0], "fields_high": [1, 0, 1]}, "along y; raise it"),
                            ({"fields_cell": 0.02, "fields_low": [0, 0, 0], "fields_high": [9, 9, 9]},
                             "at most 1e.?0?6 are supported; use"),
                            ({"fields_low": [0, 0, 0], "fields_high": [1, 1, 1]}, "no effect without fields_cell"),
                            ({"fields_cell": 0.02, "frames": False}, "frames = false disables")):
            scene = grouser.Scene({**MINIMAL, "output": {**MINIMAL["output"], **keys}})
            with self.assertRaisesRegex(grouser.InputError, words):
                scene.run(self.folder / "bad")

    def test_are_seen_in_the_report(self):
        scene = pressed_box()
        scene["run.duration"] = 0.002
        scene.run(self.folder / "box").close()
        grouser.call(["report", str(self.folder / "box")])
        page = (self.folder / "box/report.html").read_text(encoding="utf-8")
        for title in ("Mean stress in the soil", "Porosity of the soil", "Speed of the soil"):
            self.assertIn(f'aria-label="{title}"', page)
        self.assertGreater(len(re.findall("<rect", page)), 3 * 9)


if __name__ == "__main__":
    unittest.main()
