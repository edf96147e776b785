#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The report of a run on deformable soil."""
import json
import unittest
from pathlib import Path

import numpy
from fixture import ROOT
from report_pages import PageTest

import grouser


PRESS = """version = 1
[run]
duration = 1.0
output_interval = 0.05
[terrain]
kind = "scm"
material = "soil"
heightmap = "heightmaps/flat.png"
size = [4, 2]
height_range = [0, 0]
[material.soil]
friction = 0.5
[scm]
n = 1
k_c = 0
k_phi = 1.5e6
c = 1000
phi = 30
K = 0.02
largest_sinkage = 0.04
[[body]]
name = "plate"
material = "soil"
mass = 10
inertia = [1, 1, 1]
position = [2, 0, 0.025]
[[body.shape]]
kind = "box"
size = [0.3, 0.2, 0.05]
[[body.shape]]
kind = "box"
size = [0.3, 0.2, 0.05]
[[joint]]
name = "rail"
type = "prismatic"
bodies = ["world", "plate"]
point = [2, 0, 0]
axis = [0, 0, -1]
[[drive]]
name = "press"
joint = "rail"
value = 0.05
"""


class DeformableSoil(PageTest):
    def test_a_run_on_deformable_soil(self):
        grouser.call(["run", str(ROOT / "runs/scenes/scm_drive.toml"), "--out", "soil", "--set", "run.duration=1.2", "--set",
                      "output.picture=false"])
        self.opened("soil")
        shown = self.numbers()
        with grouser.open_run("soil") as run:
            weight = 9.81 * float(run.constants["vehicle.mass"])
            for name in ("elastic_pressure", "compaction", "shear"):
                self.assertEqual(shown[f"soil energy soil_{name}"], run[f"ledger.soil_{name}"].value[-1])
            frame = run.frames[-1]
            self.assertAlmostEqual(frame.soil("sinkage").max(), run.constants["terrain.soil.sinkage"].value.max(), places=6)
            self.assertRaises(KeyError, frame.soil, "depth")
        carried = shown["left normal force"] + shown["right normal force"]
        self.assertLess(abs(carried / weight - 1), 0.1, "the tracks carry the vehicle, but for its swing")
        for side in ("left", "right"):
            self.assertGreater(shown[f"{side} mean maximum pressure"], shown[f"{side} mean pressure"])
            self.assertLessEqual(shown[f"{side} mean maximum pressure"], shown[f"{side} maximum"])
        titles = self.browser.value("report.plots.map(p => p.entry.title)")
        for title in ("Rut across", "Rut along", "Pressure under the tracks", "Energies of deformable soil"):
            self.assertIn(title, titles)
        self.ruts_are_in_the_view()
        self.assertTrue(self.browser.value("[...document.images].every(i => i.complete && i.naturalWidth > 0)"))

    def test_bodies_without_a_vehicle(self):
        """Two equal boxes as one body press as one box; maps, a picture and the section of the report."""
        Path("press.toml").write_text(PRESS)
        grouser.call(["run", "press.toml", "--out", "press"])
        self.assertTrue(Path("press/surface.png").exists())
        with grouser.open_run("press") as run:
            sinkage = run.constants["terrain.soil.sinkage"].value
            self.assertNotIn("terrain.soil.section_sinkage", run.constants)
            self.assertAlmostEqual(float(sinkage.max()), 0.05, delta=0.001)
            force = float(run["bodies.plate.contact_force"].value[-1][2])
        self.assertAlmostEqual(force / (1.5e6 * 0.05 * 0.06), 1, delta=0.02)
        self.assertIn("more than scm.largest_sinkage, 0.04 m", json.loads(Path("press/manifest.json").read_text())["soil_warning"])
        self.opened("press")
        self.assertTrue(self.browser.value("[...document.images].every(i => i.complete && i.naturalWidth > 0)"))
        self.assertIn("Map of the ruts", self.browser.value("document.body.innerText"))

    def ruts_are_in_the_view(self):
        """The surface at the end and in an earlier frame, to half a unit of 16 bits and the rounding of single precision."""
        value = self.browser.value
        drawn = "Array.from(report.space.soil.geometry.attributes.position.array)"
        middle, unit = numpy.array(value("report.space.data.middle")), value("report.space.soil.unit")
        with grouser.open_run("soil") as run:
            self.assertGreater(run.frames[-1].soil("sinkage").max(), 100 * unit)
            for k in (-1, len(run.frames) // 2):
                value(f"report.space.show({k % len(run.frames)})")
                surface = numpy.array(value(drawn)).reshape(-1, 3) + middle
                place = dict(zip(map(tuple, surface[:, :2].round(3).tolist()), surface[:, 2]))
                position = run.frames[k].soil("position").astype(float)
                height = [place[tuple(node)] for node in position[:, :2].round(3).tolist()]
                self.assertLess(numpy.abs(height - position[:, 2]).max(), 0.51 * unit + 1e-6)
        self.assertEqual(value("report.space.scene.children.filter(c => c.isMesh && c.material.vertexColors).length"), 1)


if __name__ == "__main__":
    unittest.main()
