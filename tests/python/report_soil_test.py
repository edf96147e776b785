#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The report of a run on deformable soil."""
import unittest

from fixture import ROOT
from report_pages import PageTest

import grouser


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
        self.assertTrue(self.browser.value("[...document.images].every(i => i.complete && i.naturalWidth > 0)"))


if __name__ == "__main__":
    unittest.main()
