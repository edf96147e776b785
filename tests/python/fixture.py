# SPDX-License-Identifier: BSD-3-Clause
"""A temporary folder per test, a small scene, and the package of the checkout."""
import os
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "python/examples")]

#: A grain that falls.
MINIMAL = {"version": 1, "run": {"duration": 0.01, "time_step": 1e-4, "output_interval": 0.005},
           "material": {"glass": {"stiffness": 1e4}}, "output": {"plots": False, "picture": False},
           "plane": [{"material": "glass"}], "grain": [{"position": [0, 0, 0.1], "radius": 0.01, "material": "glass"}]}


class FolderTest(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = Path(kept.name)
        was = os.getcwd()
        self.addCleanup(os.chdir, was)
        os.chdir(self.folder)
