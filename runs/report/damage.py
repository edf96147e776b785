# SPDX-License-Identifier: BSD-3-Clause
"""Runs with missing or damaged files, and with warnings."""
import grouser
from grouser.series import counted
from page import esc

NEEDED = ("results.h5", "manifest.json", "scene.toml")
MOST_LISTED = 10


def open_whole(folder):
    """The run in a folder. FileError if one of its files is missing or unreadable."""
    if not folder.is_dir():
        raise grouser.FileError(f"{folder}: the folder is missing; repeat the run or restore the folder from a copy")
    missing = [name for name in NEEDED if not (folder / name).is_file()]
    if missing:
        raise grouser.FileError(f"{folder}: {' and '.join(missing)} missing; repeat the run or restore the files from "
                                "a copy")
    try:
        grouser.files.read_text(folder / "scene.toml")
    except UnicodeDecodeError as error:
        raise damaged(folder / "scene.toml") from error
    try:
        run = grouser.open_run(folder)
        for name in run:
            run[name]
        run.constants, run.facts, run.scene
    except grouser.FileError:
        raise
    except (OSError, KeyError, RuntimeError, AttributeError, TypeError, ValueError) as error:
        raise damaged(folder / "results.h5") from error
    run.manifest
    try:
        run.frames
    except (OSError, KeyError, RuntimeError) as error:
        raise damaged(folder / "frames.h5") from error
    return run


def damaged(file):
    return grouser.FileError(f"{file}: damaged or incomplete; run it again or restore the file from a copy")


def without_frames(run):
    """Reason why a run has no frames; "" if it has frames."""
    if run.frames is not None and len(run.frames):
        return ""
    if not run.scene.get("output", {}).get("frames", True):
        return "the scene writes no frames (output.frames = false)"
    what = "has no frames" if run.frames is not None else "is missing"
    return f"frames.h5 {what} although the scene writes frames (output.frames = true)"


def fault_of(folder):
    """Message about missing or damaged files of a finished run; "" if all files are intact."""
    try:
        with open_whole(folder) as run:
            why = without_frames(run)
            return why if "although" in why and run.status in ("finished", "incomplete") else ""
    except grouser.FileError as error:
        return " ".join(str(error).replace(f"{folder}/", "").replace(f"{folder}: ", "").split())


def warn(made, faults, words=""):
    """Lists {run: fault} at the top of the page, followed by `words` about the consequences."""
    if not faults:
        return
    told = [f"<li><code>{esc(name)}</code>: {esc(fault)}</li>" for name, fault in list(faults.items())[:MOST_LISTED]]
    more = f"<p>And {len(faults) - MOST_LISTED} more.</p>" if len(faults) > MOST_LISTED else ""
    count = f"{len(faults)} runs have" if len(faults) > 1 else "1 run has"
    made.warnings.append(f"<p>{count} missing or damaged files.{words}</p><ul>{''.join(told)}</ul>{more}")


def add_notices(made, found):
    """Lists the warnings of the runs at the top of the page: [(whether a warning, text, number of runs)]. Returns HTML
    of the notes."""
    lines = [f"{'WARNING' if is_warning else 'note'} in {counted(runs, 'run')}: {esc(text)}" for is_warning, text, runs in found]
    made.warnings.extend(f"<p>{line}</p>" for line in lines if line.startswith("WARNING"))
    return "".join(f"<p>{line}</p>" for line in lines if line.startswith("note"))
