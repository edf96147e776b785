#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Jobs that were stopped: the command in the message of StoppedError resumes the run."""
import math
import re
import subprocess
import time
import unittest

from fixture import MINIMAL, FolderTest

import grouser


class Stopped(FolderTest):
    def stopped(self, scene, out, **options):
        """Starts a run, stops it after its first progress, and returns the error."""
        told = []
        job = scene.start(out, progress=told.append, **options)
        end = time.monotonic() + 60
        while not told and job.running and time.monotonic() < end:
            time.sleep(0.02)
        job.stop()
        with self.assertRaises(grouser.StoppedError) as caught:
            job.wait()
        return str(caught.exception)

    @staticmethod
    def reached(text):
        """The time at which a run was stopped [s]."""
        return float(re.search(r"stopped by SIGTERM at (\S+) s \(", text)[1])

    def test_the_command_of_a_stopped_run_resumes_it(self):
        """The printed command works in any folder: scene file, inputs beside the scene, results, changed keys."""
        (self.folder / "scenes").mkdir()
        grouser.Scene(MINIMAL).write("scenes/of a grain.toml")
        (self.folder / "scenes/more.csv").write_text("0.1, 0, 0.5, 0.01\n")
        (self.folder / "elsewhere").mkdir()
        scene = grouser.Scene.read("scenes/of a grain.toml")
        scene["run.duration"], scene["run.output_interval"] = 1e4, 1.0
        scene.add("grains", form="file", file="more.csv", material="glass")
        text = self.stopped(scene, "out it/long")
        self.assertIn("; resume with: cd ", text)
        command = text.partition("; resume with: ")[2]
        scene["run.duration"] = math.ceil(self.reached(text)) + 2.0
        scene.write("out it/long.toml")  # so that the rest is short
        done = subprocess.run(["bash", "-c", command], cwd=self.folder / "elsewhere", capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        run = grouser.open_run("out it/long")
        self.assertEqual((run.status, run.scene["run"]["duration"]), ("finished", scene["run.duration"]))
        self.assertEqual(run.scene["grains"][0]["file"], str(self.folder.resolve() / "scenes/more.csv"))
        self.assertEqual(sorted(p.name for p in (self.folder / "elsewhere").iterdir()), [])

    def test_the_command_of_a_stopped_branch_continues_the_branch(self):
        scene = grouser.Scene(MINIMAL)
        scene["run.output_interval"] = 0.001
        scene.run("first")
        scene["run.duration"], scene["run.output_interval"] = 1e4, 1.0
        text = self.stopped(scene, "branch", resume="first/checkpoint.h5")
        command = text.partition("; resume with: ")[2]
        self.assertIn("branch/checkpoint.h5", command)
        reached = self.reached(text)
        scene["run.duration"] = math.ceil(reached) + 2.0
        (self.folder / "branch.toml").unlink()
        scene.write("branch.toml")
        done = subprocess.run(["bash", "-c", command], cwd="/", capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        run = grouser.open_run("branch")
        self.assertEqual(run.status, "finished")
        self.assertIn("first/checkpoint.h5", run.manifest["branched_from"])
        self.assertGreater(run.time[-1], reached)


if __name__ == "__main__":
    unittest.main()
