#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Report page (HTML) of a folder with the results of a run, a sweep, a check, events, a calibration or a soil test:

    report.py FOLDER PAGE.html [--figures FILE.json] [--frames N] [--grains N] [--film FILE] [--program FILE]

Called by `grouser report`, with the figures of a run (runs/campaigns/sweeps/run_figures) in FILE.json and the path of
the program. Exit status: 0; 2: no results, damaged results or a wrong option; 3: missing package; 4: the page cannot be
written; 130: interrupted. The last line states the reason.
"""
import argparse
import contextlib
import json
import os
import signal
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
# The Python package: in the checkout, next to the installed program, or in Debian's dist-packages.
sys.path[1:1] = [str(HERE.parent / "plots"), str(HERE.parents[1] / "python"),
                 str(HERE.parents[1].parent.parent / "lib/python3/dist-packages")]
sys.dont_write_bytecode = True
import packages

WRONG, NOT_WRITTEN, INTERRUPTED = 2, 4, 130
KINDS = (("check.json", "check"), ("events.json", "series of events"), ("calibration.json", "calibration"),
         ("soil.json", "soil test"), ("summary.csv", "sweep"), ("results.h5", "run"))


def kind_of(folder):
    """Kind of results in a folder, by its main file; None if the folder has no main file."""
    return next((kind for file, kind in KINDS if (folder / file).is_file()), None)


def instead(folder):
    """Advice for a folder without results: subfolders with results, or the expected files."""
    try:
        there = sorted(inner for inner in folder.iterdir() if inner.is_dir() and kind_of(inner))
    except OSError as error:
        return f"it cannot be read: {error.strerror}"
    if (folder / "manifest.json").is_file():
        return "results.h5 of this run is missing; run it again or restore the file from a copy"
    if there:
        more = f" and {len(there) - 3} more" if len(there) > 3 else ""
        return (f"use a subfolder: {', '.join(str(inner) for inner in there[:3])}{more} (the page of a sweep, "
                "check, set of events or soil test requires that its tables have been written)")
    return f"expected one of {', '.join(file for file, _ in KINDS)}"


def contents(folder, kind, options):
    import calibration_page
    import check_page
    import events_page
    import run_page
    import soil_page
    import sweep_page
    write = {"check": check_page.page, "soil test": soil_page.page, "sweep": sweep_page.page, "run": run_page.page,
             "series of events": events_page.page, "calibration": calibration_page.page}
    return write[kind](folder, options)


def end(status, message):
    print(message)
    sys.exit(status)


def put(text, file):
    """Writes the page to a temporary file and renames it, so that no reader sees a partial page."""
    fresh = file.with_name(file.name + ".part")
    try:
        fresh.write_text(text, encoding="utf-8", errors="replace")  # file names may not be UTF-8
        os.replace(fresh, file)
    except OSError as error:
        end(NOT_WRITTEN, f"{file}: cannot be written: {error.strerror}")
    finally:
        with contextlib.suppress(OSError):
            fresh.unlink()


def check_places(options):
    """Checks the options before any file is read."""
    import run_page
    if not options.page.parent.is_dir():
        end(WRONG, f"--out {options.page}: folder {options.page.parent} does not exist; create it or choose another")
    if options.film and not run_page.is_film(options.film):
        end(WRONG, f"--film {options.film}: not a film for browsers ({', '.join(run_page.FILMS)}); make one with "
                   "grouser render --film drive.mp4")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("page", type=Path)
    parser.add_argument("--figures", type=Path)
    parser.add_argument("--film", type=Path)
    parser.add_argument("--program")
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--grains", type=int, default=40000)
    sys.stdout.reconfigure(errors="surrogateescape")  # file names that are not UTF-8
    make(parser.parse_args())


def make(options):
    packages.require("numpy", "h5py")
    try:
        import grouser
    except ImportError:
        end(packages.MISSING, "the Python package grouser, installed with the program, is missing; set PYTHONPATH to "
                              "the folder that contains it")
    check_places(options)
    import page
    try:
        kind = kind_of(options.folder)
    except OSError as error:
        end(WRONG, f"{options.folder}: cannot be read: {error.strerror}; correct this, or choose another folder")
    if kind is None:
        end(WRONG, f"{options.folder}: contains no results; {instead(options.folder)}")
    try:
        options.figures = json.loads(options.figures.read_text(encoding="utf-8")) if options.figures else {}
        text = contents(options.folder, kind, options).html()
    except grouser.FileError as error:
        end(WRONG, str(error).replace("\n", " "))
    except FileNotFoundError as error:
        end(packages.MISSING if str(error.filename).startswith(str(page.DEBIAN)) else WRONG, f"{error.filename}: {error.strerror}")
    except KeyError as error:
        end(WRONG, f"{options.folder}: damaged {kind}, or written by another version: {error} is missing")
    except OSError as error:
        end(WRONG, f"{options.folder}: unreadable {kind}: {' '.join(str(error).split())}")
    except (ValueError, RuntimeError, IndexError, TypeError, AttributeError):
        end(WRONG, f"{options.folder}: damaged {kind}, or written by another version; run it again")
    put(text, options.page)
    print(f"report    {options.page}, {options.page.stat().st_size / 1e6:.1f} MB; open it in a browser")


def interrupt(*_):
    raise KeyboardInterrupt


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, interrupt)  # forwarded by the program
    try:
        main()
    except KeyboardInterrupt:
        end(INTERRUPTED, "interrupted; no report was written")
