#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The job runs/slurm.sh without SLURM: launcher, time for the last checkpoint, requeued jobs."""
import json
import os
import re
import shutil
import signal
import subprocess
import time
import unittest

from fixture import MINIMAL, ROOT, FolderTest

from grouser.toml import document_text

PROGRAM = os.environ.get("GROUSER_PROGRAM", str(ROOT / "build/bin/grouser"))
#: Records its call. After SIGUSR1, it needs a second for its checkpoint.
LAUNCHER = """#!/bin/bash
printf '%s\\n' "$0 $*" "OMP_NUM_THREADS=$OMP_NUM_THREADS" >call
trap 'echo USR1 >>signals; sleep 1; echo saved >>signals; exit 138' USR1
trap 'echo TERM >>signals; exit 1' TERM
for ((k = 0; k < ${SECONDS_OF_RUN:-0} * 10; k++)); do sleep 0.1; done
"""


class Job(FolderTest):
    def setUp(self):
        super().setUp()
        (self.folder / "scene.toml").write_text(document_text(MINIMAL))
        for name in ("mpirun", "srun", "scontrol"):
            text = LAUNCHER if name != "scontrol" else '#!/bin/bash\necho "$*" >scontrol.txt\n'
            (self.folder / name).write_text(text)
            (self.folder / name).chmod(0o755)

    def start(self, *words, fake=True, **environment):
        given = {key: value for key, value in os.environ.items() if not key.startswith(("SLURM_", "GROUSER_"))}
        given |= {"SLURM_NTASKS": "2", "SLURM_NTASKS_PER_NODE": "2", "SLURM_CPUS_PER_TASK": "1", "SLURM_JOB_ID": "7",
                  "GROUSER": PROGRAM, "GROUSER_CACHE": "", "OMPI_ALLOW_RUN_AS_ROOT": "1",
                  "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
                  "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe"} | environment
        if fake:
            given["PATH"] = f"{self.folder}:{given['PATH']}"
        return subprocess.Popen(["bash", ROOT / "runs/slurm.sh", *words], env=given, text=True, stderr=subprocess.PIPE,
                                stdout=subprocess.PIPE)

    def run_job(self, *words, **environment):
        job = self.start(*words, **environment)
        out, errors = job.communicate(timeout=60)
        return job.returncode, out, errors

    def call(self):
        return (self.folder / "call").read_text().split("\n")

    def test_starts_one_rank_per_task_and_leaves_the_device_to_the_scene(self):
        code, _, errors = self.run_job("scene.toml", "--set", "run.duration=0.02", SLURM_CPUS_PER_TASK="8")
        self.assertEqual(code, 0, errors)
        line, threads, *_ = self.call()
        self.assertTrue(line.endswith(f"mpirun -np 2 --map-by ppr:2:node:PE=8 {PROGRAM} run scene.toml --set "
                                      "run.duration=0.02"), line)
        self.assertEqual(threads, "OMP_NUM_THREADS=8")
        code, _, errors = self.run_job("scene.toml", GROUSER_LAUNCHER="srun")
        self.assertEqual(code, 0, errors)
        self.assertIn("srun --mpi=pmix --kill-on-bad-exit=1 --cpus-per-task=1 ", self.call()[0])

    def test_time_for_the_checkpoint_follows_from_its_size(self):
        # 60,000 grains of 250 bytes: 15 MB. The settings of the command count.
        bed = MINIMAL | {"terrain": {"kind": "granular", "heightmap": "heightmaps/flat.png", "size": [2.0, 2.0],
                                     "material": "glass", "grain_radius": 0.01, "layers": 10, "arrangement": "lattice",
                                     "height_range": [0, 0.1]}}
        del bed["grain"], bed["plane"]
        (self.folder / "bed.toml").write_text(document_text(bed))
        plan = subprocess.run([PROGRAM, "plan", "bed.toml", "--json", "plan.json"], capture_output=True, text=True)
        self.assertEqual(plan.returncode, 0, plan.stderr)
        size = json.loads((self.folder / "plan.json").read_text())["checkpoint_bytes"]
        self.assertGreater(size, 10_000_000)
        def seconds(*words, **environment):
            end = int(time.time()) + 100_000
            code, _, errors = self.run_job("bed.toml", *words, SLURM_JOB_END_TIME=str(end), **environment)
            self.assertEqual(code, 0, errors)
            return int(re.search(r", (\d+) s before the time limit", errors)[1]) - 30
        self.assertEqual(seconds(GROUSER_DISK_MBPS="1"), 60 + size // 1_000_000)
        self.assertEqual(seconds(), 60)
        self.assertLess(seconds("--set=terrain.layers=1", GROUSER_DISK_MBPS="1"), 60 + size // 3_000_000)
        self.assertLess(seconds("--set", "terrain.layers=1", GROUSER_DISK_MBPS="1"), 60 + size // 3_000_000)
        self.assertEqual(seconds(GROUSER_STOP_SECONDS="900"), 900)
        _, _, errors = self.run_job("bed.toml", GROUSER_STOP_SECONDS="900")
        self.assertRegex(errors, r"WARNING: the time limit is unknown.* sbatch --signal=B:USR1@930")

    def test_stops_before_the_time_limit_and_requeues(self):
        soon = str(int(time.time()) + 33)
        code, _, errors = self.run_job("scene.toml", SLURM_JOB_END_TIME=soon, GROUSER_STOP_SECONDS="1",
                                       SECONDS_OF_RUN="30", GROUSER_REQUEUE="1")
        self.assertEqual((self.folder / "signals").read_text(), "USR1\nsaved\n", errors)
        self.assertRegex(errors, "stops in [12] s, 31 s before the time limit")
        self.assertEqual(code, 124)
        self.assertEqual((self.folder / "scontrol.txt").read_text(), "requeue 7\n")
        code, _, errors = self.run_job("scene.toml", SLURM_JOB_END_TIME=str(int(time.time()) + 20))
        self.assertEqual(code, 2)
        self.assertIn("the last checkpoint needs 90 s before the time limit; raise --time", errors)

    def test_a_signal_of_slurm_waits_for_the_checkpoint(self):
        for given in (signal.SIGTERM, signal.SIGUSR1):
            for name in ("call", "signals"):
                (self.folder / name).unlink(missing_ok=True)
            job = self.start("scene.toml", SECONDS_OF_RUN="30")
            while not (self.folder / "call").exists():
                time.sleep(0.05)
            time.sleep(0.2)
            job.send_signal(given)
            job.communicate(timeout=30)
            self.assertEqual((self.folder / "signals").read_text(), "USR1\nsaved\n")
            self.assertEqual(job.returncode, 138)
            self.assertFalse((self.folder / "scontrol.txt").exists())

    def test_the_signal_before_the_time_limit_requeues(self):
        """SLURM's own signal can precede the timer of the script; a user's signal long before the limit stops the job."""
        for left, requeued in ((200, True), (2000, False)):
            for name in ("call", "signals"):
                (self.folder / name).unlink(missing_ok=True)
            job = self.start("scene.toml", SECONDS_OF_RUN="30", GROUSER_REQUEUE="1", GROUSER_STOP_SECONDS="1",
                             SLURM_JOB_END_TIME=str(int(time.time()) + left))
            while not (self.folder / "call").exists():
                time.sleep(0.05)
            time.sleep(0.2)
            job.send_signal(signal.SIGUSR1)
            _, errors = job.communicate(timeout=30)
            self.assertEqual((self.folder / "signals").read_text(), "USR1\nsaved\n", errors)
            self.assertEqual(job.returncode, 138)
            self.assertEqual((self.folder / "scontrol.txt").exists(), requeued)
            (self.folder / "scontrol.txt").unlink(missing_ok=True)

    def test_a_requeued_job_continues(self):
        for words, out in (((), "out/scene"), (("--out", "a"), "a"), (("--out=b",), "b"), (("--output", "c"), "c"),
                           (("--set", 'output.folder="d"'), "d"), (("--set=output.folder=e",), "e")):
            self.run_job("scene.toml", *words)
            self.assertTrue(self.call()[0].endswith(" ".join(("scene.toml", *words))))
            self.run_job("scene.toml", *words, SLURM_RESTART_COUNT="1")
            self.assertNotRegex(self.call()[0], "--force|--resume")  # it never started
            (self.folder / out).mkdir(parents=True)
            (self.folder / out / "manifest.json").write_text('{\n  "status": "running",\n  "slurm_job": "7",\n}\n')
            self.run_job("scene.toml", *words, SLURM_RESTART_COUNT="1")
            self.assertTrue(self.call()[0].endswith(" --force"), self.call()[0])
            (self.folder / out / "checkpoint.h5").touch()
            self.run_job("scene.toml", *words, SLURM_RESTART_COUNT="1")
            self.assertTrue(self.call()[0].endswith(" --resume"), self.call()[0])
            self.run_job("scene.toml", *words, "--resume", SLURM_RESTART_COUNT="1")
            self.assertEqual(self.call()[0].count("--resume"), 1)

    def test_a_requeued_job_leaves_the_results_of_another_run(self):
        text = (self.folder / "scene.toml").read_text()
        (self.folder / "scene.toml").write_text(text.replace("[output]", '[output]\nfolder = "kept"'))
        folder = self.folder / "kept"
        for manifest in (None, "", "{}", '{\n  "slurm_job": "17",\n}\n', '{\n  "slurm_job": "other 7",\n}\n'):
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir()
            (folder / "checkpoint.h5").touch()
            if manifest is not None:
                (folder / "manifest.json").write_text(manifest)
            _, _, errors = self.run_job("scene.toml", SLURM_RESTART_COUNT="1")
            self.assertNotRegex(self.call()[0], "--force|--resume")
            self.assertIn("WARNING: kept contains no results of this job 7; it is left unchanged", errors)
        self.run_job("scene.toml", SLURM_RESTART_COUNT="1", SLURM_CLUSTER_NAME="other")
        self.assertTrue(self.call()[0].endswith(" --resume"), self.call()[0])
        (self.folder / "mpirun").unlink()  # the program itself refuses such a folder
        (folder / "manifest.json").write_text("{}")
        code, out, errors = self.run_job("scene.toml", SLURM_RESTART_COUNT="1", fake=False)
        self.assertNotEqual(code, 0)
        self.assertIn("kept: the folder is not empty", out + errors)

    def test_wrong_values_are_named(self):
        for name, value in (("GROUSER_DISK_MBPS", "0"), ("GROUSER_STOP_SECONDS", "5m"), ("GROUSER_LAUNCHER", "ibrun")):
            code, _, errors = self.run_job("scene.toml", **{name: value})
            self.assertEqual(code, 2, name)
            self.assertIn(f"runs/slurm.sh: {name} = '{value}' must be", errors)
            self.assertFalse((self.folder / "call").exists())

    def test_two_ranks_stop_with_a_checkpoint_and_resume(self):
        words = ("scene.toml", *(f"--set={setting}" for setting in ("run.duration=1000", "output.frames=false")))
        code, out, errors = self.run_job(*words, fake=False, GROUSER_STOP_SECONDS="5",
                                         SLURM_JOB_END_TIME=str(int(time.time()) + 40))
        self.assertEqual(code, 124, out + errors)
        self.assertIn("stopped by SIGUSR1", errors)
        self.assertTrue((self.folder / "out/scene/checkpoint.h5").exists(), out + errors)
        code, out, errors = self.run_job(*words, fake=False, SLURM_RESTART_COUNT="1", GROUSER_STOP_SECONDS="5",
                                         SLURM_JOB_END_TIME=str(int(time.time()) + 40))
        self.assertEqual(code, 124, out + errors)
        self.assertRegex(out, r"resumed +at step [1-9]")


if __name__ == "__main__":
    unittest.main()
