#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Input that is not a regular file."""
import os
import socket
import subprocess
import unittest
from pathlib import Path

from fixture import FolderTest
from odd_files_test import DRIVEN, GRAINS, GROUND, MAP, MESH, PROGRAM

import grouser


class SpecialFiles(FolderTest):
    """FIFOs, devices, sockets, folders, loops of links and files of the kernel as input: one error, and no command
    waits for a writer."""

    def special(self):
        os.mkfifo("fifo")
        os.symlink("fifo", "to_fifo")
        os.symlink("loop", "loop")
        os.mkdir("directory")
        with socket.socket(socket.AF_UNIX) as listener:
            listener.bind("socket")
        return {"fifo": "is a FIFO", "to_fifo": "is a FIFO", "loop": "is a link that leads back to itself",
                "socket": "is a socket", "directory": "is a folder", "/dev/zero": "is a device",
                "/proc/self/mem": "is a file of the kernel"}

    def refused(self, words, file, kind):
        done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=20, stdin=subprocess.DEVNULL,
                              env={**os.environ, "GROUSER_CACHE": ""})
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn(f"{file} {kind}" if "/proc" not in file and file != "mem" else kind, done.stderr)
        self.assertIn("(a regular file is required)", done.stderr)

    def test_commands(self):
        scenes = {"heightmap": MAP.replace("map.png", "@"), "grains": GRAINS.replace("grains.txt", "@"),
                  "vehicle": DRIVEN.format(driver="sprocket_speed = 1").replace("car.toml", "@"),
                  "soil": MAP.replace("stiffness = 1e5", 'soil = "./@"'),
                  "mesh": MESH.format(file="@", keys="sphere_radius = 0.02")}
        calls = [("run", "@"), ("plan", "@"), ("sweep", "@", "--set", "run.seed=1,2"), ("check", "@"),
                 ("compare", "@", "--grounds", "rigid,granular"), ("render", "@"), ("sinkage", "@"), ("hash", "@"), ("spheres", "@", "--radius", "0.02"),
                 ("soil", "--calibrate", "@"), ("run", "plain.toml", "--resume", "@")]
        Path("plain.toml").write_text(GROUND.format(more=""))
        for file, kind in self.special().items():
            for words in calls:
                if file == "directory" and words[0] in ("render", "sinkage", "hash"):
                    continue  # the folder of a run
                with self.subTest(words=words, file=file):
                    self.refused([file if word == "@" else word for word in words], file, kind)
            for name, text in scenes.items():
                with self.subTest(scene=name, file=file):
                    # The name of a soil is a path if it contains a slash.
                    word = "./@" if file[0] == "/" and name == "soil" else "@"
                    Path("scene.toml").write_text(text.replace(word, file))
                    self.refused(["run", "scene.toml"], file.rpartition("/")[2], kind)
        self.assertFalse(Path("out").exists())

    def test_material_library(self):
        os.mkfifo("fifo")
        Path("mesh.obj").write_text("# a tetrahedron\nmtllib fifo\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                    "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        Path("scene.toml").write_text(MESH.format(file="mesh.obj", keys="sphere_radius = 0.02"))
        self.refused(["run", "scene.toml"], "mesh.obj:2: the material library fifo", "is a FIFO")

    def test_soil_of_a_material_without_section(self):
        os.mkdir("soils")
        os.mkfifo("soils/mud.toml")
        text = GROUND.format(more="")
        for scene in (text.replace('material = "m"', 'material = "mud"'), MAP.replace("stiffness = 1e5", 'soil = "mud"')):
            Path("scene.toml").write_text(scene)
            self.refused(["plan", "scene.toml"], "mud.toml", "is a FIFO")

    def test_python(self):
        kinds = self.special()
        del kinds["loop"]  # OSError of the system
        for file, kind in kinds.items():
            for reader in (grouser.files.read_csv, lambda path: grouser.files.read_json(path, "events"),
                           grouser.files.open_file, grouser.Scene.read):
                with self.subTest(file=file), self.assertRaisesRegex(grouser.FileError, f"{file} {kind} .a regular file"):
                    reader(Path(file))

    def test_a_redirected_scene_is_read(self):
        Path("scene.toml").write_text(GROUND.format(more=""))
        with open("scene.toml") as scene:
            done = subprocess.run([PROGRAM, "run", "/dev/stdin", "--out", "out"], stdin=scene, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
