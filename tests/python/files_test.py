#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""docs/files.md lists exactly the contents of result files, with type, shape, unit and help."""
import re
import unittest

import h5py
from fixture import MINIMAL, ROOT, FolderTest

import grouser
from grouser.files import text_of

KINDS = {"results.h5": "results.h5", "frames.h5": "frames.h5", "checkpoint.h5": "checkpoint.h5 and cached beds"}
#: Only in runs with several ranks, or with a vehicle in water, which take a minute to start.
RARE = {"/FRAME/partition/AXIS", "/@bed_warnings", "/@energy_warning", "/@soil_warning"} | {
    f"/fluid/vehicle/{part}/{load}/value" for part in ("hull", "SIDE_track") for load in ("force", "torque")}
QUIET = {"plots": False, "picture": False}


def documented() -> dict[str, dict[str, tuple[str, str, str, str]]]:
    """{file: {path: (type, shape, unit, help)}}"""
    sections = re.split(r"^## ", (ROOT / "docs/files.md").read_text(), flags=re.M)[1:]
    tables = {section.split("\n", 1)[0]: section for section in sections}
    return {file: {row[0]: tuple(row[1:]) for row in
                   re.findall(r"^\| `(.+?)` \| (.*?) \| (.*?) \| (.*?) \| (.*?) \|$", tables[title], flags=re.M)}
            for file, title in KINDS.items()}


def pattern(path: str) -> re.Pattern[str]:
    words = {"SIDE": "(left|right)", "NAME": "[^/]+", "FRAME": r"\d{6,}", "NUMBER": r"\d+", "AXIS": "[xyz]"}
    return re.compile(re.sub("|".join(words), lambda m: words[m[0]], re.escape(path)))


class FilesOfResults(FolderTest):
    def setUp(self):
        super().setUp()
        self.documented = documented()
        self.patterns = {file: {path: pattern(path) for path in table} for file, table in self.documented.items()}
        self.seen = {file: set() for file in KINDS}

    def row(self, file: str, path: str) -> tuple[str, str, str, str]:
        for name, expression in self.patterns[file].items():
            if expression.fullmatch("/" + path.lstrip("/")):
                self.seen[file].add(name)
                return self.documented[file][name]
        self.fail(f"docs/files.md has no {path} of {file}")

    def look_at(self, file: str, path) -> None:
        with h5py.File(path) as opened:
            for name in opened.attrs:
                self.row(file, f"/@{name}")
            for name in ("step", "time") if file == "results.h5" else ():  # datasets of many names
                self.look_at_item(file, f"series/{name}", opened[f"series/{name}"])
            opened.visititems(lambda name, item: self.look_at_item(file, name, item))

    def look_at_item(self, file: str, name: str, item) -> None:
        own = {"unit", "help", "labels"} if isinstance(item, h5py.Dataset) and file == "results.h5" else set()
        for attribute in set(item.attrs) - own:
            self.row(file, f"{name}@{attribute}")
        if not isinstance(item, h5py.Dataset) or (file == "results.h5" and re.search("/(step|time)$", name)
                                                  and not name.startswith("series/")):
            return
        type_, shape, unit, text = self.row(file, name)
        self.assertEqual(item.dtype.name, type_, name)
        sides = [side.strip() for side in shape.strip("[]").split(",")]
        self.assertEqual(len(sides), len(item.shape), f"{name} has the shape {item.shape}, not {shape}")
        for side, length in zip(sides, item.shape):
            if side.isdigit():
                self.assertEqual(int(side), length, f"{name} has the shape {item.shape}, not {shape}")
        if "unit" in item.attrs:
            self.assertIn(text_of(item.attrs["unit"]), unit.split(" or "), name)
        if "help" in item.attrs:
            self.assertIn(text_of(item.attrs["help"]), text.split("; or "), name)
        elif own and not name.startswith("series/"):
            self.fail(f"{name} has no help")

    def run_and_look(self, scene: grouser.Scene, name: str) -> None:
        scene["output"] = {**scene.document.get("output", {}), **QUIET}
        with scene.run(self.folder / name):
            pass
        for file in KINDS:
            if (self.folder / name / file).is_file():
                self.look_at(file, self.folder / name / file)

    def test_hold_what_is_documented_and_all_of_that(self):
        vehicle = grouser.Scene.read(ROOT / "tests/scenes/coupled.toml")
        vehicle["run.duration"] = 0.04
        vehicle["run.output_interval"] = 0.02
        vehicle["driver"].update(tension_ramp=0.002, weight_ramp=0.002)
        vehicle["terrain.settle_kinetic_energy"] = 0.1
        vehicle["output"] = {**vehicle.document.get("output", {}), "shoe_forces": True, "gear_contacts": True}
        self.run_and_look(vehicle, "vehicle")
        rigid = grouser.Scene.read(ROOT / "tests/scenes/rigid.toml")
        rigid["run.duration"] = 0.002
        rigid["vehicle.sphere_radius"] = 0.04
        rigid["hitch"] = {"kind": "sled", "mass": 100.0, "friction": 0.5}
        self.run_and_look(rigid, "rigid")
        with grouser.Simulation(rigid, self.folder / "steered") as sim:
            sim.set_gravity([0, 0, -9])
            sim.step(5)
        self.look_at("results.h5", self.folder / "steered/results.h5")
        grouser.call(["run", str(self.folder / "rigid.toml"), "--resume", str(self.folder / "rigid/checkpoint.h5"),
                      "--set", "driver.sprocket_speed=1", "--set", "run.duration=0.004",
                      "--out", str(self.folder / "branch")])
        self.look_at("results.h5", self.folder / "branch/results.h5")
        obstacles = grouser.Scene.read(ROOT / "tests/scenes/obstacles.toml")
        obstacles["run.duration"] = 0.002
        self.run_and_look(obstacles, "obstacles")
        soil = grouser.Scene.read(ROOT / "runs/scenes/scm_drive.toml")
        soil["run.duration"] = 0.1
        soil["driver"].update(tension_ramp=0.002, weight_ramp=0.002)
        self.run_and_look(soil, "soil")
        drum = grouser.Scene.read(ROOT / "runs/scenes/drum.toml")
        drum["run"].update(contact="complementarity", duration=0.01)
        self.run_and_look(drum, "drum")
        moving = grouser.Scene.read(ROOT / "tests/scenes/moving.toml")
        moving["run.duration"] = 0.01
        moving["output"] = {"fields_cell": 0.03}
        moving["cylinder"][0]["pivot"] = [0, 0, 0.01]
        self.run_and_look(moving, "moving")
        bodies = grouser.Scene.read(ROOT / "tests/scenes/bodies.toml")
        bodies["run.duration"] = 0.01
        bodies["body"][0]["probe_size"] = [0.1, 0.1, 0.1]
        self.run_and_look(bodies, "bodies")
        water = grouser.Scene.read(ROOT / "runs/scenes/floating_box.toml")
        water["run.duration"] = 0.002
        water["fluid"]["probe"] = [{"name": "wall", "kind": "pressure", "position": [1.0, 0.0, 0.1]}]
        self.run_and_look(water, "water")
        bushing = grouser.Scene.read(ROOT / "runs/mechanisms/andrews.toml")
        bushing["run.duration"] = 0.001
        bushing.add("bushing", name="rubber", bodies=["K1", "K2"], point=[0, 0, 0], stiffness=[1.0, 1.0, 1.0])
        self.run_and_look(bushing, "bushing")
        for name in ("slider_crank", "gears", "joint_cylindrical", "joint_prismatic", "spring_torsion", "fourbar2"):
            mechanism = grouser.Scene.read(ROOT / f"runs/mechanisms/{name}.toml")
            mechanism["run.duration"] = 0.01
            self.run_and_look(mechanism, name)
        self.look_at("checkpoint.h5", self.kept_bed())
        for file, seen in self.seen.items():
            unseen = set(self.documented[file]) - seen - RARE
            self.assertFalse(unseen, f"documented of {file}, but in none of these runs")

    def kept_bed(self):
        scene = grouser.Scene.read(ROOT / "tests/scenes/bed.toml")
        scene["terrain"].update(size=[0.6, 0.6], layers=2, cache=True, floor_grains=True, height_range=[0.0, 0.01],
                                settle_kinetic_energy=0.01, settle_time_limit=2.0)
        scene["run.duration"] = 0.001
        scene["output"] = QUIET
        scene.run("bed", environment={"GROUSER_CACHE": str(self.folder / "cache")}).close()
        self.look_at("frames.h5", self.folder / "bed/frames.h5")
        return grouser.kept_beds(self.folder / "cache")[0]

    def test_a_run_that_is_opened_again_has_its_newest_rows(self):
        """While an earlier Run of the same folder is open, HDF5 would share its state."""
        scene = grouser.Scene(MINIMAL)
        scene["output"] = QUIET
        scene["run.duration"] = 0.1
        scene.run("run").close()
        first = grouser.open_run("run")
        rows = len(first.time)
        scene["run.duration"] = 0.2
        scene.run("run", resume=True).close()
        again = grouser.open_run("run")
        self.assertGreater(len(again.time), rows)
        self.assertEqual(len(again["ledger.kinetic"].value), len(again.time))
        first.close()


if __name__ == "__main__":
    unittest.main()
