# SPDX-License-Identifier: BSD-3-Clause
"""What goes wrong, as exceptions."""
from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any


class GrouserError(RuntimeError):
    """A call of the program that did not end with 0. `str()` is the program's own message."""

    def __init__(self, message: str, exit_code: int, command: list[str], output: str):
        super().__init__(message)
        self.exit_code = exit_code  #: of the program: docs/commands.md lists them; negative: killed by that signal
        self.command = command  #: its words
        self.output = output  #: what it had printed by then


class InputError(GrouserError):
    """Exit code 2: a scene, an option or a file is wrong; the message names file, line, key, range and remedy."""


class SimulationError(GrouserError):
    """Exit code 3: the run became unsound, or its results could not be written."""


class DeviceError(GrouserError):
    """Exit code 4: the device failed, or the machine has no memory or process left."""


class StoppedError(GrouserError):
    """Exit codes 129, 130 and 143: stopped by SIGHUP, SIGINT or SIGTERM; `resume=True` goes on."""


KINDS: dict[int, type[GrouserError]] = {2: InputError, 3: SimulationError, 4: DeviceError, 129: StoppedError,
                                        130: StoppedError, 143: StoppedError}


def briefly(function: Callable[..., Any]) -> Callable[..., Any]:
    """What it raises is shown as raised here: the frames inside this package tell a reader nothing."""
    @wraps(function)
    def called(*given: Any, **options: Any) -> Any:
        try:
            return function(*given, **options)
        except (GrouserError, FileError, KeyError) as error:
            raise error.with_traceback(None) from error.__cause__
    return called


class FileError(ValueError):
    """A file or folder that is not what it was opened as."""
