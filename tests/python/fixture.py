# SPDX-License-Identifier: BSD-3-Clause
"""A folder that is gone after each test, and the package from the checkout."""
import os
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "python/examples")]


class FolderTest(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = Path(kept.name)
        was = os.getcwd()
        self.addCleanup(os.chdir, was)
        os.chdir(self.folder)
