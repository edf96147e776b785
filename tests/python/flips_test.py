#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A flipped bit in a file of a run: commands either give the same results as with the whole file, or refuse the file
with one error and exit code 2. GROUSER_FLIPS: number of flips per file."""
import hashlib
import os
import random
import resource
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy
from fixture import ROOT

import grouser

FLIPS = int(os.environ.get("GROUSER_FLIPS", "12"))
VEHICLE = """version = 1
[run]
duration = 0.004
time_step = 1e-4
output_interval = 0.0005
frame_interval = 0.002
[material.ground]
stiffness = 1e7
restitution = 0.3
friction = 0.8
[terrain]
material = "ground"
heightmap = "heightmaps/flat.png"
size = [6.0, 2.6]
height_range = [0.0, 0.4]
kind = "rigid"
[vehicle]
spec = "vehicles/light_tracked.toml"
sphere_radius = 0.05
[driver]
sprocket_speed = 1.0
[output]
plots = false
picture = false
"""
GRAINS = """version = 1
[run]
duration = 0.02
time_step = 1e-4
output_interval = 0.002
frame_interval = 0.005
[material.sand]
stiffness = 1e5
restitution = 0.2
friction = 0.5
[terrain]
heightmap = "heightmaps/flat.png"
size = [0.3, 0.3]
height_range = [0, 0]
material = "sand"
grain_radius = 0.02
depth = 0.06
[[mesh]]
name = "wheel"
file = "meshes/road_wheel.obj"
scale = 0.2
position = [0, 0, 0]
above_bed = 0.01
free = "z"
mass = 2
material = "sand"
[output]
plots = false
picture = false
"""


def digest_of_run(folder):
    """Hash of all numbers and texts that the Python package reads from the folder of a run."""
    found = hashlib.sha256()

    def add(*values):
        for value in values:
            found.update(value.tobytes() if isinstance(value, numpy.ndarray) else repr(value).encode())
    with grouser.open_run(folder) as run:
        for name in run:
            series = run[name]
            add(name, series.value, series.unit, series.help, series.labels)
        for name, constant in run.constants.items():
            add(name, constant.value, constant.unit, constant.help)
        add(run.time, run.step, run.scene, run.facts, run.manifest)
        add(*vars(run.surface).values()) if run.surface else None
        frames = run.frames
        add(frames.time, frames.step, frames.parts)
        add(*vars(frames.ground).values()) if frames.ground else None
        for frame in frames:
            add(frame.poses)
            for name in grouser.UNITS if len(frame) else ():
                try:
                    add(name, frame.grains(name))
                except KeyError:
                    add(name)
            add(*vars(frame.parts).values()) if frames.parts else None
    return found.hexdigest()


def call(*words, cache="", program=None):
    return subprocess.run([str(program or grouser.find_program()), *map(str, words)], capture_output=True, text=True,
                          timeout=300, env={**os.environ, "GROUSER_CACHE": str(cache)})


def in_child(work):
    """Calls a function in a copy of this process, since a damaged file may crash the HDF5 library; (exit code, text)."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        try:
            text, code = work(), 0
        except grouser.FileError as error:
            text, code = str(error), 2
        except BaseException as error:  # noqa: B902 - the test then fails with this text
            text, code = f"{type(error).__name__}: {error}", 1
        os.write(writer, text.encode()[:4000])
        os._exit(code)
    os.close(writer)
    with os.fdopen(reader, "rb") as told:
        text = told.read().decode()
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), text


class Flips(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        kept = tempfile.TemporaryDirectory()
        cls.addClassCleanup(kept.cleanup)
        cls.folder = Path(kept.name)
        for name, scene in (("drive", VEHICLE), ("fall", GRAINS)):
            (cls.folder / f"{name}.toml").write_text(scene)
            cls.run_half(name, cls.folder / name)

    @classmethod
    def scene_of(cls, folder):
        return cls.folder / f"{folder.name.partition('_')[0]}.toml"

    @classmethod
    def run_half(cls, name, folder):
        done = call("run", cls.folder / f"{name}.toml", "--out", folder, "--steps", 20, cache=cls.folder / "cache")
        assert done.returncode == 0, done.stderr

    def result(self, command, folder):
        """(exit code, results or error) of a command; the results do not depend on the path of the folder."""
        out = folder.parent / "result"
        shutil.rmtree(out, ignore_errors=True)
        out.mkdir()
        if command == "open_run":
            return in_child(lambda: digest_of_run(folder))
        if command == "open_bed":
            return in_child(lambda: hashlib.sha256(b"".join(
                value.tobytes() for value in vars(grouser.open_bed(folder)).values()
                if isinstance(value, numpy.ndarray))).hexdigest())
        words = {"render": ("render", folder / "frames.h5", "--out", out, "--size", "64x48"),
                 "sinkage": ("sinkage", folder / "results.h5", "--out", out),
                 "report": ("report", folder, "--out", out / "page.html"),
                 "resume": ("run", self.scene_of(folder), "--out", folder, "--resume"),
                 "run": ("run", self.scene_of(folder), "--out", out / "again", "--steps", 20)}[command]
        done = call(*words, cache=folder.parent / "cache")
        if done.returncode:
            return done.returncode, done.stderr
        if command == "resume":
            return in_child(lambda: self.digest_of_results(folder))
        if command == "run":
            return in_child(lambda: self.digest_of_results(out / "again"))
        made = sorted(file for file in out.rglob("*") if file.suffix in (".png", ".csv", ".html"))
        return 0, "".join(hashlib.sha256(file.read_bytes()).hexdigest() for file in made)

    @staticmethod
    def digest_of_results(folder):
        """Hash of all data in results.h5 and frames.h5, and of the rows in timeseries.csv."""
        found = hashlib.sha256((folder / "timeseries.csv").read_bytes())
        for name in ("results.h5", "frames.h5"):
            def visit(path, item):
                found.update(path.encode())
                if isinstance(item, h5py.Dataset):
                    found.update(item[()].tobytes())
                for key in sorted(item.attrs):
                    found.update(repr(item.attrs[key]).encode())
            with h5py.File(folder / name) as file:
                file.visititems(visit)
        return found.hexdigest()

    def flip(self, name, file, commands, count=FLIPS):
        """Flips bits of a file in the folder `name` of a run, or in the cache. Each command meets the whole file first,
        then the flips in turn."""
        chance = random.Random(f"{name} {file}")
        inner = file if "/" in file else f"{name}/{file}"
        whole = (self.folder / inner).read_bytes()
        refused = 0

        def fresh():
            place = self.folder / "copy"  # pages and results name the path of their folder
            shutil.rmtree(place, ignore_errors=True)
            place.mkdir()
            shutil.copy(self.folder / f"{name}.toml", place)
            for part in (name, "cache"):
                shutil.copytree(self.folder / part, place / part)
            return place
        expected = {}
        for command in commands:
            place = fresh()
            code, expected[command] = self.result(command, place / name)
            self.assertEqual(code, 0, f"{command} with the whole file: {expected[command]}")
        for k in range(count):
            command, bit = commands[k % len(commands)], chance.randrange(8 * len(whole))
            place = fresh()
            damaged = bytearray(whole)
            damaged[bit // 8] ^= 1 << bit % 8
            (place / inner).write_bytes(damaged)
            with self.subTest(command=command, file=inner, byte=bit // 8, bit=bit % 8):
                code, text = self.result(command, place / name)
                if code == 0:
                    self.assertEqual(text, expected[command], "results differ, but there is no error")
                else:
                    refused += 1
                    self.assertEqual(code, 2, text)
                    errors = [line for line in text.splitlines() if not line.startswith("WARNING")]
                    self.assertEqual(len(errors), 1, text)
                    self.assertIn(Path(file).name, errors[0])
        return refused

    def test_results(self):
        self.assertGreater(self.flip("drive", "results.h5", ("open_run", "sinkage", "report", "resume")), FLIPS // 2)

    def test_frames(self):
        for name in ("drive", "fall"):
            self.assertGreater(self.flip(name, "frames.h5", ("open_run", "render", "resume")), FLIPS // 4)

    def test_manifest(self):
        self.flip("drive", "manifest.json", ("open_run", "report"))

    def test_rows(self):
        """Neither the report nor a resumed run reads timeseries.csv."""
        self.assertEqual(self.flip("drive", "timeseries.csv", ("report", "resume"), min(FLIPS, 4)), 0)

    def test_checkpoint(self):
        self.assertGreater(self.flip("fall", "checkpoint.h5", ("resume",), FLIPS // 3 + 1), 0)

    def test_cache(self):
        """Damaged files of the cache are made again."""
        for file in sorted((self.folder / "cache").iterdir()):  # locks are empty
            if file.suffix in (".h5", ".bin"):
                self.assertEqual(self.flip("fall", f"cache/{file.name}", ("run",), FLIPS // 4), 0)


if __name__ == "__main__":
    unittest.main()
