#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The Python package reports damaged and closed files."""
import json
import unittest

import h5py
from fixture import MINIMAL, FolderTest

import grouser


class Files(FolderTest):
    def test_damaged_json_is_told_with_its_place(self):
        """Messages are one line with file, line, column and remedy; there is no Python traceback."""
        openers = {"check.json": grouser.open_check, "soil.json": grouser.open_soil, "events.json": grouser.open_events,
                   "calibration.json": grouser.open_calibration}
        whole = {"check.json": {"figures": [], "cases": []}, "soil.json": {"soil": "s", "constants": {}},
                 "events.json": {"rows": []}, "calibration.json": {"soil": "s", "trials": [], "targets": []}}
        of_another_kind = {"check.json": {"figures": 1, "cases": []}, "soil.json": {"constants": 1},
                           "events.json": {"rows": [{"event": 3}]}, "calibration.json": {"trials": [1], "targets": 2}}
        cases = [(b'{"figures": [1,\n  2,\n  ,', ":3:3: "), (b"", ":1:1: "), (b'{"rows": "\xff"}', ":1:11: "),
                 (b"[1]", ":1:1: ")]
        for name, opener in openers.items():
            for text, place in cases + [(json.dumps(of_another_kind[name]).encode(), ": ")]:
                (self.folder / name).write_bytes(text)
                with self.assertRaises(grouser.FileError, msg=(name, text)) as caught:
                    opener(self.folder)
                message = str(caught.exception)
                self.assertTrue(message.startswith(f"{self.folder / name}{place}"), message)
                self.assertIn("run it again or restore the file from a copy", message)
                self.assertNotIn("\n", message)
                self.assertNotRegex(message, "Expecting|codec|object|argument|Error|'int'|char ")
            text = json.dumps(whole[name])[:-3]
            (self.folder / name).write_text(text)
            with self.assertRaisesRegex(grouser.FileError, f"{name}:1:{len(text) + 1}: "):
                opener(self.folder)
        run = grouser.Scene(MINIMAL).run("cut")
        whole = run.file.with_name("manifest.json").read_text()
        for text, place in ((whole.replace('"status":', '"status"', 1), r":\d+:\d+: "), (whole[:-3], r":\d+:\d+: "),
                            (whole.replace('"checksum"', '"checksul"'), ": ")):
            run.file.with_name("manifest.json").write_text(text)
            with self.assertRaisesRegex(grouser.FileError, "manifest.json" + place + "cannot be read as the manifest"):
                grouser.open_run("cut").status

    def test_damaged_tables_are_told(self):
        """{file: (opener, text, message)}"""
        about = "run,k,status,message,wall time [s],steps,simulated time [s],way [m]"
        (self.folder / "check.json").write_text('{"figures": [], "cases": []}')
        def check():
            return grouser.open_check(self.folder)
        def means():
            (self.folder / "summary.csv").write_text(f"{about},state hash\n0,1,finished,,1,1,1,1,x\n")
            return grouser.open_sweep(self.folder).means
        for name, opener, text, words in (
                ("check.json", lambda: check().not_run, '{"figures": [], "cases": []}', "'not_asked' is missing"),
                ("series.csv", lambda: check().series, "time [s],a,a both +-\n0,1,2\n", r"'a seeds \+-' is missing"),
                ("series.csv", lambda: check().series, "a,a seeds +-,a step +-,a both +-\n0,1,2,3\n",
                 r"'time \[s\]' is missing"),
                ("summary.csv", lambda: grouser.open_sweep(self.folder), f"{about}\n0,1,finished,,1,1,1,1\n",
                 "'state hash' is missing"),
                ("intervals.csv", means, "k,mean\n1,2\n", "'figure' is missing"),
                ("intervals.csv", means, "figure,k,seeds,mean,half width,difference to the first,half width of the "
                                         "difference\nway [m],1,?,2,3,4,5\n", "a field has the wrong type")):
            (self.folder / name).write_text(text)
            with self.assertRaisesRegex(grouser.FileError, words) as caught:
                opener()
            self.assertTrue(str(caught.exception).startswith(f"{self.folder / name}: "), caught.exception)

    def test_warnings_and_notes_of_the_runs_are_listed(self):
        (self.folder / "summary.csv").write_text(
            "run,k,status,message,wall time [s],steps,simulated time [s],way [m],state hash,commit,warnings and notes\n"
            'a,1,finished,,1,1,1,1,x,c,"note: a bed, 3 m; WARNING: coarse: 2; see log"\nb,2,finished,,1,1,1,1,x,c,\n')
        sweep = grouser.open_sweep(self.folder)
        self.assertEqual([run.notices for run in sweep.runs], [("note: a bed, 3 m", "WARNING: coarse: 2; see log"), ()])
        self.assertEqual(list(sweep.units), ["way"])

    def test_damaged_files_of_a_run_are_told(self):
        run = grouser.Scene(MINIMAL).run("cut")
        run.close()
        for name in ("results.h5", "checkpoint.h5"):
            with self.assertRaisesRegex(grouser.FileError, f"{name}: no frames"):
                grouser.open_frames(self.folder / "cut" / name)
        with h5py.File("cut/checkpoint.h5", "r+") as file:
            del file["grains/position"]
        with self.assertRaisesRegex(grouser.FileError, "checkpoint.h5: cannot be read as .*: 'position' is missing"):
            grouser.open_bed("cut")
        with h5py.File("cut/results.h5", "r+") as file:
            del file["series/ledger/kinetic/value" if "series/ledger" in file else "ledger/kinetic/value"].attrs["unit"]
            file.attrs["scene"] = "version = "
        run = grouser.open_run("cut")
        with self.assertRaisesRegex(grouser.FileError, "results.h5: cannot be read as .*: 'unit' is missing"):
            run["ledger.kinetic"]
        with self.assertRaisesRegex(grouser.FileError, "results.h5: the scene in it cannot be read: "):
            run.scene
        with h5py.File("cut/frames.h5", "r+") as file:
            del file["000000"].attrs["time"]
        with self.assertRaisesRegex(grouser.FileError, "frames.h5: cannot be read as .*: 'time' is missing"):
            run.frames

    def test_a_closed_run_is_told_and_holds_no_file(self):
        run = grouser.Scene(MINIMAL).run("done")
        frames = run.frames
        frame = frames[0]
        run.close()
        run.close()
        for name in ("results.h5", "frames.h5"):
            h5py.File(f"done/{name}", "r+").close()  # HDF5 rejects this while the file is open for reading
        for what, name in ((lambda: run["ledger.kinetic"], "results"), (lambda: run.time, "results"),
                           (lambda: run.constants, "results"), (lambda: run.scene, "results"),
                           (lambda: frame.position, "frames"), (lambda: frames.parts, "frames")):
            with self.assertRaisesRegex(ValueError, f"done/{name}.h5: the file is closed; open it again"):
                what()


if __name__ == "__main__":
    unittest.main()
