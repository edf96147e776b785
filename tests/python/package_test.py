#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The Python package: scenes as text, calls and their errors, invalid files."""
import ast
import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
import tomllib
import traceback
import unittest

import numpy
from fixture import MINIMAL, ROOT, FolderTest

import grouser
from grouser.bed import metres_of
from grouser.toml import document_text


class Toml(unittest.TestCase):
    def test_reads_back_as_it_was_written(self):
        documents = [tomllib.loads(file.read_text()) for folder in ("runs/scenes", "runs/mechanisms", "tests/scenes")
                     for file in sorted((ROOT / folder).glob("*.toml"))]
        self.assertGreater(len(documents), 30)
        documents.append({"a b": {"c|d": {"text": 'say "\\" \n\t\x7f ä', "x": 1e-300, "y": -0.1, "z": [[1, 2.5], []]}},
                          "one": {"table": [{"deep": {"er": True}}, {"in": [{"side": {}}]}]}, "nothing": {}})
        for document in documents:
            self.assertEqual(tomllib.loads(document_text(document)), document)

    def test_takes_numbers_of_numpy_and_refuses_what_is_none(self):
        text = document_text({"a": numpy.float64(0.1), "b": numpy.arange(3), "c": numpy.bool_(True), "d": float("inf")})
        self.assertEqual(tomllib.loads(text), {"a": 0.1, "b": [0, 1, 2], "c": True, "d": float("inf")})
        for wrong in (object(), b"abc"):
            with self.assertRaises(TypeError):
                document_text({"a": wrong})


class Types(unittest.TestCase):
    """The package declares types (py.typed). They agree with the extension module and with its own code."""

    def test_types_have_the_names_of_the_extension_module(self):
        from grouser.simulation import _core
        module = _core()
        types = ast.parse((ROOT / "python/grouser/_core.pyi").read_text())
        found = next(node for node in types.body if isinstance(node, ast.ClassDef))
        listed = {node.name for node in found.body if isinstance(node, ast.FunctionDef)} - {"__init__"}
        self.assertEqual(listed, {name for name in vars(module.Simulation) if not name.startswith("_")})
        self.assertEqual((type(module.version), type(module.commit)), (str, str))

    def test_all_functions_have_annotations_that_mypy_accepts(self):
        for file in (ROOT / "python/grouser").glob("*.py"):
            for node in ast.walk(ast.parse(file.read_text())):
                if isinstance(node, ast.FunctionDef) and node.name != "__init__":
                    given = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
                    missing = [one.arg for one in given if one.annotation is None and one.arg not in ("self", "cls")]
                    self.assertFalse(missing, f"{file.name}:{node.lineno}")
                    self.assertIsNotNone(node.returns, f"{file.name}:{node.lineno}")
        if shutil.which("mypy"):
            done = subprocess.run(["mypy", "--ignore-missing-imports", "--disallow-untyped-defs", "--cache-dir=/dev/null",
                                   "grouser"], cwd=ROOT / "python", capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stdout)


class Scenes(FolderTest):
    def test_keys_are_set_found_and_taken_out(self):
        scene = grouser.Scene()
        scene['contact."clay|loam".friction'] = 0.4
        self.assertEqual(scene.document["contact"], {"clay|loam": {"friction": 0.4}})
        self.assertEqual(scene['contact."clay|loam".friction'], 0.4)
        self.assertNotIn("run.duration", scene)
        with self.assertRaises(KeyError):
            scene["run.duration"]
        other = scene.copy()
        other["run.duration"] = 1.0
        self.assertNotIn("run", scene)
        del other["run.duration"]
        self.assertNotIn("run.duration", other)
        scene.add("plane", material="clay")
        scene["plane"][0]["material"] = "loam"
        with self.assertRaises(KeyError):
            scene["plane.material"] = "clay"
        self.assertEqual(grouser.Scene.read(scene.write("deep/s.toml")).document, scene.document)

    def test_what_is_no_key_and_no_section_is_told(self):
        scene = grouser.Scene(MINIMAL)
        for wrong in ("run duration", "", "a = 1\nb"):
            self.assertNotIn(wrong, scene)
            with self.assertRaisesRegex(KeyError, "is not a key"):
                scene[wrong] = 1
        with self.assertRaisesRegex(KeyError, r"run\.duration\.x: run\.duration is not a section, but 0\.01"):
            scene["run.duration.x"] = 1
        with self.assertRaisesRegex(KeyError, r"run\.duration\.x: run\.duration is not a section, but 0\.01"):
            del scene["run.duration.x"]
        with self.assertRaisesRegex(KeyError, r"plane is not a section; change a list by scene\['plane'\]\[0\]"):
            del scene["plane.material"]
        self.assertEqual(scene.document, MINIMAL)

    def test_an_unknown_key_is_refused_where_it_is_set(self):
        scene = grouser.Scene.read(ROOT / "runs/scenes/ball_pit.toml")
        before = scene.copy()
        for key, near in (("driver.sproket_speed", "driver.sprocket_speed"), ("sprocket_speed", "driver.sprocket_speed"),
                          ("run.duraton", "run.duration"), ("material.soil.fricton", "material.soil.friction"),
                          ("materal.soil.friction", "material.soil.friction"), ("driver.tabel.time", "driver.table.time"),
                          ("spec.shoe.pin_dampng", "spec.shoe.pin_damping"),
                          ("vehicle.mass", "vehicle.chassis"), ("vehicle.sprocket_speed", "driver.sprocket_speed")):
            with self.assertRaises(KeyError) as caught:
                scene[key] = 1
            self.assertEqual(caught.exception.args[0], f"{key}: unknown key; did you mean {near}?")
        for wrong in (lambda: scene.add("plane", materal="soil"), lambda: grouser.Scene({"version": 1, "run": {"duraton": 1}}),
                      lambda: scene.__setitem__("boxes", [{"size": [1, 1, 1]}]), lambda: scene.__setitem__("run", 1),
                      lambda: scene.__setitem__("box", [{"size": [1, 1, 1], "materal": "soil"}])):
            self.assertRaises(KeyError, wrong)
        self.assertEqual(scene.document, before.document)
        scene["spec.shoe.pin_damping"], scene['contact."a|b".friction'] = 10.0, 0.4
        scene["driver.table"] = {"time": [0.0], "left": [1.0], "right": [1.0]}

    def test_all_keys_of_all_scenes_can_be_set(self):
        for folder in ("runs/scenes", "runs/mechanisms", "tests/scenes"):
            for file in sorted((ROOT / folder).glob("*.toml")):
                scene = grouser.Scene.read(file)
                self.assertEqual(grouser.Scene(scene.document).document, scene.document, file)

    def test_a_byte_order_mark_is_taken_and_other_encodings_are_told(self):
        (self.folder / "mark.toml").write_bytes(b"\xef\xbb\xbf" + grouser.Scene(MINIMAL).text().encode())
        self.assertEqual(grouser.Scene.read("mark.toml").document, MINIMAL)
        self.assertIn("grains", grouser.call(["plan", "mark.toml", "--no-probe"]))
        (self.folder / "latin.toml").write_bytes(b"# \xe4\n")
        with self.assertRaisesRegex(grouser.FileError, "^latin.toml: not UTF-8 text"):
            grouser.Scene.read("latin.toml")

    def test_files_that_a_scene_names_are_found_from_its_own_folder(self):
        (self.folder / "mine").mkdir()
        (self.folder / "mine/hills.png").write_bytes((ROOT / "assets/heightmaps/hills.png").read_bytes())
        scene = grouser.Scene.read(ROOT / "tests/scenes/bed.toml")
        scene["terrain.heightmap"] = "hills.png"
        with self.assertRaises(grouser.InputError):
            scene.plan()
        scene.folder = self.folder / "mine"
        self.assertIn("grains", scene.plan())
        self.assertEqual([file.name for file in (self.folder / "mine").iterdir()], ["hills.png"])


class Calls(FolderTest):
    def test_a_wrong_scene_raises_what_the_program_says(self):
        scene = grouser.Scene(MINIMAL)
        scene["material.glass.restitution"] = 1.4
        with self.assertRaises(grouser.InputError) as caught:
            scene.run("bad")
        self.assertEqual(caught.exception.exit_code, 2)
        message = str(caught.exception)
        self.assertRegex(message, r"^scene: material\.glass\.restitution = 1\.4 \[-\] is outside")
        self.assertNotIn("grouser: error", message)
        self.assertEqual(caught.exception.command[1], "run")
        self.assertFalse((self.folder / "bad").exists())

    def test_a_message_names_the_scene_and_no_file_that_was_written_for_it(self):
        scene = grouser.Scene(MINIMAL, name="falling")
        scene["material.glass.restitution"] = 1.4
        grouser.Scene(scene.document).write("falling.toml")
        for one, called in ((scene, "scene falling"), (grouser.Scene.read("falling.toml"), "falling.toml")):
            for call in (one.plan, lambda: one.run("bad"), lambda: one.sweep("bad", {"run.seed": [1, 2]})):
                with self.assertRaises(grouser.InputError) as caught:
                    call()
                self.assertTrue(str(caught.exception).startswith(f"{called}: material.glass.restitution = 1.4 [-]"),
                                str(caught.exception))
                frames = traceback.extract_tb(caught.exception.__traceback__)
                self.assertLessEqual(len(frames), 2, "a traceback that goes through the package")

    def test_a_plan_names_no_file_that_was_written_for_it(self):
        self.assertNotIn(tempfile.gettempdir(), grouser.Scene(MINIMAL, name="falling").plan())

    def test_a_file_of_the_users_is_not_written_over(self):
        (self.folder / "mine.toml").write_text("# my own\n" + grouser.Scene(MINIMAL).text())
        with self.assertRaises(grouser.FileError):
            grouser.Scene.read(self.folder / "mine.toml").run("mine")
        self.assertTrue((self.folder / "mine.toml").read_text().startswith("# my own"))
        (self.folder / "latin.toml").write_bytes(b"# \xe4\n")
        (self.folder / "folder.toml").mkdir()
        for name in ("latin", "folder"):
            with self.assertRaisesRegex(grouser.FileError, f"{name}.toml exists and was not written by this"):
                grouser.Scene(MINIMAL).run(name)

    def test_a_refused_call_leaves_the_scene_of_the_results_that_are_there(self):
        scene, other = grouser.Scene(MINIMAL), grouser.Scene(MINIMAL)
        other["run.duration"] = 0.02
        scene.run("x").close()
        written = (self.folder / "x.toml").read_text()
        for call in (lambda: other.run("x"), lambda: other.sweep("x", {"run.nosuch": [1]}),
                     lambda: other.check("x", axes=["nosuch"])):
            with self.assertRaises(grouser.InputError):
                call()
            self.assertEqual((self.folder / "x.toml").read_text(), written)
        (self.folder / "x.toml").unlink()
        with self.assertRaises(grouser.InputError):
            other.run("x")
        self.assertEqual([file.name for file in self.folder.iterdir()], ["x"])
        other.run("x", force=True).close()
        self.assertIn("duration = 0.02", (self.folder / "x.toml").read_text())
        self.assertEqual(sorted(file.name for file in self.folder.iterdir()), ["x", "x.toml"])

    def test_what_progress_raises_stops_the_run_and_is_raised(self):
        class Enough(Exception):
            pass

        def tell(progress):
            raise Enough(progress.what)

        scene = grouser.Scene(MINIMAL)
        scene["run.duration"] = 1e4
        scene["run.output_interval"] = 1.0
        job = scene.start("long", progress=tell)
        end = time.monotonic() + 20
        while job.running and time.monotonic() < end:
            time.sleep(0.02)
        stopped = not job.running
        job.stop()
        with self.assertRaisesRegex(Enough, "running"):
            job.wait()
        self.assertTrue(stopped)
        self.assertEqual(grouser.open_run("long").status, "stopped")
        self.assertTrue(job.messages)  # lines after the exception, too

    def test_a_text_is_one_value_and_one_axis(self):
        scene = grouser.Scene(MINIMAL)
        sweep = scene.sweep("one", {"material.glass.friction": "0.3", "material.glass.restitution": 0.5})
        self.assertEqual([run.keys for run in sweep.runs],
                         [{"material.glass.friction": "0.3", "material.glass.restitution": "0.5"}])
        self.assertNotIn("step", scene.check("axis", axes="step", seeds=2).not_run)

    def test_an_unsound_run_raises_and_leaves_what_it_has(self):
        scene = grouser.Scene(MINIMAL)
        scene["material.glass.stiffness"] = 60.0
        scene["grain"][0].update(position=[0, 0, 0.0101], velocity=[0, 0, -10.0])
        with self.assertRaises(grouser.SimulationError) as caught:
            scene.run("unsound")
        self.assertEqual(caught.exception.exit_code, 3)
        run = grouser.open_run("unsound")
        self.assertEqual(run.status, "failed")
        self.assertGreaterEqual(len(run.time), 1)

    def test_progress_comes_while_a_run_goes_on_and_a_stopped_one_can_be_resumed(self):
        scene = grouser.Scene(MINIMAL)
        scene["run.duration"] = 1e4
        scene["run.output_interval"] = 1.0
        told = []
        job = scene.start("long", progress=told.append)
        end = time.monotonic() + 60
        while len(told) < 3 and job.running and time.monotonic() < end:
            time.sleep(0.02)
        self.assertTrue(job.running)
        job.stop()
        with self.assertRaises(grouser.StoppedError) as caught:
            job.wait()
        self.assertEqual(caught.exception.exit_code, 128 + signal.SIGTERM)
        self.assertGreaterEqual(len(told), 3)
        fractions = [progress.fraction for progress in told]
        self.assertEqual(fractions, sorted(fractions))
        self.assertEqual(told[0].what, "running")
        stopped = grouser.open_run("long")
        self.assertEqual(stopped.status, "stopped")
        self.assertTrue((self.folder / "long/checkpoint.h5").is_file())
        scene["run.duration"] = float(numpy.ceil(stopped.time[-1])) + 2
        finished = scene.run("long", resume=True)
        self.assertEqual(finished.status, "finished")
        self.assertGreater(finished.time[-1], stopped.time[-1])
        scene["run.duration"] += 2
        branch = scene.run("branch", resume="long/checkpoint.h5")
        self.assertIn("long/checkpoint.h5, step ", branch.manifest["branched_from"])
        self.assertGreater(branch.time[0], finished.time[-1])
        with self.assertRaisesRegex(grouser.InputError, "--from-checkpoint"):
            scene.sweep("branches", {"run.seed": [1, 2]}, from_checkpoint="long/checkpoint.h5")
        with self.assertRaisesRegex(grouser.InputError, "--until rest requires a vehicle"):
            scene.run("rest", until="rest")

    def test_what_was_printed_comes_back(self):
        self.assertRegex(grouser.call(["--version"]), r"^grouser \d+\.\d+\.\d+\n")
        with self.assertRaises(grouser.InputError) as caught:
            grouser.call(["runn"])
        self.assertIn('did you mean "run"', str(caught.exception))
        was = os.environ.pop("GROUSER_PROGRAM", None)
        try:
            os.environ["GROUSER_PROGRAM"] = "/nonexistent/grouser"
            with self.assertRaisesRegex(FileNotFoundError, "/nonexistent/grouser"):
                grouser.call(["--version"])
        finally:
            os.environ.pop("GROUSER_PROGRAM")
            if was is not None:
                os.environ["GROUSER_PROGRAM"] = was


class Files(FolderTest):
    def test_that_are_something_else_are_said_to_be_so(self):
        (self.folder / "results.h5").write_text("no HDF5")
        for name in ("summary.csv", "check.json", "soil.json", "events.json", "calibration.json"):
            (self.folder / name).write_text('{"other": 1}\n')
        openers = (grouser.open_run, grouser.open_sweep, grouser.open_check, grouser.open_soil, grouser.open_bed,
                   grouser.open_events, grouser.open_frames, grouser.open_calibration)
        for opener in openers:
            with self.assertRaises(grouser.FileError, msg=opener.__name__):
                opener(self.folder)
            with self.assertRaises(grouser.FileError, msg=opener.__name__):
                opener(self.folder / "missing")
        for name in ("check.json", "soil.json", "events.json", "calibration.json"):
            (self.folder / name).write_text("[1]")
        (self.folder / "summary.csv").write_bytes(b"run,\xff\xfe\n")
        for opener in openers:
            with self.assertRaises(grouser.FileError, msg=opener.__name__):
                opener(self.folder)

    def test_series_have_times_units_and_columns(self):
        scene = grouser.Scene(MINIMAL)
        scene["run.duration"] = 0.1
        run = scene.run("fall")
        momentum = run["ledger/momentum"]
        self.assertEqual((momentum.name, momentum.unit, momentum.labels), ("ledger.momentum", "N s", ("x", "y", "z")))
        self.assertEqual(momentum.value.shape, (21, 3))
        self.assertTrue(momentum.help)
        mass = 2500 * 4 / 3 * numpy.pi * 0.01**3
        mass *= run.scene["material"]["glass"]["density"] / 2500
        falls = momentum["z"]
        # Symplectic Euler: the velocity after n steps is g n dt to rounding.
        numpy.testing.assert_allclose(falls.value, -mass * 9.81 * falls.time, rtol=1e-6, atol=1e-12)
        self.assertEqual(falls.between(0.02, 0.05).value.shape, (7,))
        self.assertEqual(float(falls.at(0.0501)), float(falls.value[10]))
        for wrong in (lambda: momentum["w"], lambda: falls["x"], lambda: run["ledger"], run.sinkage):
            with self.assertRaises(KeyError):
                wrong()
        self.assertIsNone(run.surface)
        self.assertEqual(run.names("terrain.")[0], "terrain.boundary_contacts")
        self.assertEqual(run.facts["creator"], "grouser")
        self.assertEqual(numpy.mean(falls), numpy.mean(falls.value))

    def test_series_are_scaled_and_added_with_their_units(self):
        time = numpy.array([0.0, 0.1, 0.2])
        def series(values, unit, name):
            return grouser.Series(numpy.array(values), unit, "", name, time, numpy.arange(3))
        left, right = series([1.0, 2.0, 4.0], "m/s", "left"), series([3.0, 2.0, 1.0], "m/s", "right")
        for scaled, values in ((left * 2, [2, 4, 8]), (2 * left, [2, 4, 8]), (left / 4, [0.25, 0.5, 1]),
                               (numpy.float64(2) * left, [2, 4, 8]), (left + right, [4, 4, 5]), (-left, [-1, -2, -4]),
                               (left - right, [-2, 0, 3]), (numpy.array([1, 0, 1]) * left, [1, 0, 4]),
                               (left - grouser.Quantity(numpy.float64(1), "m/s"), [0, 1, 3])):
            self.assertIsInstance(scaled, grouser.Series)
            self.assertEqual((scaled.value.tolist(), scaled.unit), (values, "m/s"), scaled.name)
            self.assertEqual(scaled.between(0.1, 0.2).time.tolist(), [0.1, 0.2])
        self.assertEqual((2 * left + right).name, "left * 2 + right")
        slip = series([0.25, 0.5, 1.0], "-", "slip")
        self.assertEqual((1 - slip).value.tolist(), [0.75, 0.5, 0.0])
        force = series([1.0, 1.0, 1.0], "N", "pull")
        later = grouser.Series(left.value, "m/s", "", "later", time + 1, numpy.arange(3))
        for wrong, words in ((lambda: left + force, r"left \[m/s\] \+ pull \[N\]: the units differ"),
                             (lambda: force - 1.0, r"pull \[N\] - 1.0 \[-\]: the units differ"),
                             (lambda: left * force, r"left \[m/s\] \* pull \[N\].*\.value"),
                             (lambda: left - later, "rows have different times"),
                             (lambda: left * numpy.ones((2, 3)), "shape")):
            with self.assertRaisesRegex(ValueError, words):
                wrong()
        self.assertEqual(numpy.mean(left), numpy.mean([1, 2, 4]))

    def test_what_is_at_a_time_is_near_it(self):
        series = grouser.Series(numpy.arange(4.0), "m", "", "way", numpy.array([0.0, 0.1, 0.2, 0.3]), numpy.arange(4))
        for time, value in ((0.0, 0), (-0.05, 0), (0.16, 2), (0.3, 3), (0.399, 3)):
            self.assertEqual(series.at(time), value)
        for time in (99, -0.2, 0.45, float("nan")):
            with self.assertRaisesRegex(ValueError, r"way: has no rows at \S+ s; times are 0 to 0\.3 s"):
                series.at(time)
        empty = grouser.Series(numpy.zeros(0), "m", "", "way", numpy.zeros(0), numpy.zeros(0))
        with self.assertRaisesRegex(ValueError, "way: has no rows"):
            empty.at(0)

    def test_frames_are_taken_by_number_slice_and_time(self):
        scene = grouser.Scene(MINIMAL)
        scene["run.frame_interval"] = 0.002
        frames = scene.run("fall").frames
        self.assertEqual([frame.time for frame in frames[2:5]], frames.time[2:5].tolist())
        self.assertEqual(len(frames[2:5]), 3)
        self.assertEqual([frame.step for frame in frames[::-2]], frames.step[::-2].tolist())
        self.assertEqual(frames[-1].time, frames.time[-1])
        self.assertEqual(frames.at(frames.time[-1] + 0.001).time, frames.time[-1])
        with self.assertRaisesRegex(ValueError, r"frames\.h5: has no frames at 99 s; times are 0 to 0\.01 s"):
            frames.at(99)
        with self.assertRaisesRegex(IndexError, f"frames.h5: has {len(frames)} frames, 0 to {len(frames) - 1}; "
                                                "no frame 99"):
            frames[99]

    def test_means_of_a_sweep_are_named_as_its_figures(self):
        scene = grouser.Scene(MINIMAL)
        sweep = scene.sweep("heights", {"material.glass.stiffness": [1e4, 2e4]}, seeds=2)
        self.assertEqual(list(sweep.means), list(sweep.units))
        self.assertEqual(set(sweep.means), {name for run in sweep.runs for name in run.figures})
        for name, means in sweep.means.items():
            self.assertNotIn("[", name)
            self.assertEqual([mean.keys for mean in means],
                             [{"material.glass.stiffness": value} for value in ("10000.0", "20000.0")])
            self.assertEqual(means[1].difference.name, f"{name}, difference to the first")
            self.assertEqual({(mean.seeds, mean.mean.unit) for mean in means}, {(2, sweep.units[name])})
            numpy.testing.assert_array_equal(means[0].mean.value, numpy.mean(sweep[name].value[:2]))
        with self.assertRaisesRegex(KeyError, "no means of 'height'; means are .*integration error"):
            sweep.means["height"]
        alone = scene.sweep("one_seed", {"material.glass.stiffness": [1e4, 2e4]})
        self.assertEqual(alone.means, {})
        with self.assertRaisesRegex(KeyError, "no seeds were run"):
            alone.means["integration error"]

    def test_the_version_is_that_of_the_program(self):
        written = re.search(r"^project\(grouser VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.M)[1]
        self.assertEqual(grouser.__version__, written)
        self.assertIn(f"\nversion: {written}\n", (ROOT / "CITATION.cff").read_text())
        self.assertIn(f"\n## {written}", (ROOT / "CHANGELOG.md").read_text())
        self.assertTrue(grouser.call(["--version"]).startswith(f"grouser {written}\n"))

    def test_events_have_rows_limits_and_runs(self):
        grouser.Scene(MINIMAL).run("step=0.2")
        def row(event, level, mean, picture):
            return {"event": event, "title": "up a step", "level": level, "level_is": "height [m]", "verdict": "go",
                    "runs": 1, "why": "5.0 m", "each": [{"run": picture.split("/")[0], "verdict": "go", "why": "5.0 m"}], "picture": picture, "scene": "event_step.toml", "overrides": ["run.seed=1"],
                    "figures": [{"name": "greatest pitch [deg]", "runs": 1, "mean": mean, "half_width": None}]}
        (self.folder / "events.json").write_text(json.dumps({
            "vehicle": "light", "soil": "rigid", "rows": [row("step", 0.2, 11.5, "step=0.2/picture.png"),
                                                          row("turn", None, 1.5, "")],
            "limits": [{"event": "step", "level_is": "height [m]", "go": 0.2, "no_go": None, "reference": "none above",
                        "agrees": True}]}))
        events = grouser.open_events(self.folder)
        self.assertEqual((len(events), events.vehicle, events.soil), (2, "light", "rigid"))
        step, = events["step"]
        pitch = step.figures["greatest pitch"]
        self.assertEqual((step.level, pitch.value, pitch.unit), (0.2, 11.5, "deg"))
        self.assertTrue(numpy.isnan(pitch.half_width) and numpy.isnan(events["turn"][0].level))
        self.assertEqual(step.open().status, "finished")
        self.assertEqual([(run.verdict, run.why, run.folder) for run in step.each],
                         [("go", "5.0 m", self.folder / "step=0.2")])
        self.assertEqual((events.limits["step"].go, events.limits["step"].agrees), (0.2, True))
        with self.assertRaisesRegex(KeyError, "step, turn"):
            events["gap"]
        with self.assertRaises(grouser.FileError):
            events["turn"][0].open()

    def test_positions_of_both_signs_and_all_bits_are_decoded(self):
        whole = [(0, 0, 0), (-1, 1, -2), (2**41 - 1, -2**41, 12345678901), (-2**32, 2**32, -2**32 - 1)]
        words = numpy.array([[c & 0xFFFFFFFF for c in p] + [sum((c >> 32 & 0x3FF) << 10 * k for k, c in enumerate(p))]
                             for p in whole], dtype=numpy.uint32)
        numpy.testing.assert_array_equal(metres_of(words, 0.5), 0.5 * numpy.array(whole))

    def test_kept_beds_are_found_and_opened(self):
        scene = grouser.Scene.read(ROOT / "tests/scenes/bed.toml")
        scene["terrain"].update(size=[0.6, 0.6], layers=2, cache=True, height_range=[0.0, 0.01],
                                settle_kinetic_energy=0.01, settle_time_limit=2.0)
        scene["run.duration"] = 0.001
        scene["output"] = {"plots": False, "picture": False, "frames": False}
        run = scene.run("bed", environment={"GROUSER_CACHE": str(self.folder / "cache")})
        files = grouser.kept_beds(self.folder / "cache")
        self.assertEqual(len(files), 1)
        bed = grouser.open_bed(files[0])
        self.assertEqual(len(bed), len(run.bed()))
        self.assertGreater(float(bed.settled["time"]), 0)
        self.assertEqual(bed.settled["time"].unit, "s")
        self.assertTrue((bed.radius == 0.027).all())
        self.assertAlmostEqual(bed.volume(), len(bed) * 4 / 3 * numpy.pi * 0.027**3)


class SoilTests(FolderTest):
    def test_are_measured_and_opened(self):
        (self.folder / "sand.toml").write_text(
            'version = 1\n[soil]\ntitle = "a trial"\ndescription = "soft"\n[material]\nstiffness = 5e3\n'
            'restitution = 0.3\nfriction = 0.5\n[bed]\ngrain_radius = 0.01\n[[published]]\nquantity = "phi"\n'
            'value = 25\nunit = "deg"\nsource = "a book"\n')
        options = ("--quick --seeds 1 --large-seeds 1 --plate-grains 5 --plate-ratio 1.5 --thickness 4.5 --bin 3 "
                   "--pressure 20000 --inertial-number 0.05 --shear-strain 0.1 --shear-inertial-number 0.05 "
                   "--threads 1 --device cpu --jobs 2 --shear-loads 2000 5000").split()
        told = []
        soil = grouser.measure_soil("sand.toml", "soil", options, progress=told.append)
        self.assertTrue(soil.coarse)
        self.assertEqual(soil.grain_radius, 0.01)
        phi = soil["phi"]
        self.assertEqual((phi.measured.unit, phi.published), ("deg", ((25.0, "a book"),)))
        self.assertTrue(5 < phi.measured.value < 50)
        loads = sorted(curve.load for curve in soil.shear())
        self.assertEqual(loads, [2000.0, 5000.0])
        for curve in soil.shear():
            self.assertEqual(curve.displacement.shape, curve.shear_stress.shape)
            # Residual strength over load: the angle is between the angles of the two samples (and cohesion is small).
            self.assertTrue(0.05 < numpy.median(curve.shear_stress) / curve.load < 1.5)
        plates = {curve.plate: curve for curve in soil.plates()}
        self.assertEqual(set(plates), {"small", "large"})
        self.assertAlmostEqual(plates["large"].breadth / plates["small"].breadth, 1.5)
        self.assertGreaterEqual(plates["small"].pressure.max(), 19000)
        again = grouser.measure_soil("sand.toml", "soil", options)  # opens the finished folder and measures nothing
        self.assertEqual(again["phi"].measured.value, phi.measured.value)
        with self.assertRaises(grouser.InputError):
            grouser.measure_soil("sand.toml", "soil", [*options, "--bin", "4"])


if __name__ == "__main__":
    unittest.main()
