# SPDX-License-Identifier: BSD-3-Clause
"""Exceptions."""
from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any


class GrouserError(RuntimeError):
    """The program exited with a code other than 0. `str(error)` is the message of the program."""

    def __init__(self, message: str, exit_code: int, command: list[str], output: str):
        super().__init__(message)
        self.exit_code = exit_code  #: see docs/commands.md; -n if signal n killed the program
        self.command = command  #: list of arguments
        self.output = output  #: standard output of the program


class InputError(GrouserError):
    """Exit code 2: a scene, an option or a file is invalid; the message names file, line, key, range and remedy."""


class SimulationError(GrouserError):
    """Exit code 3: the simulation became invalid, or its results could not be written."""


class DeviceError(GrouserError):
    """Exit code 4: the device failed, or the machine is out of memory or processes."""


class StoppedError(GrouserError):
    """Exit codes 129, 130, 138 and 143: SIGHUP, SIGINT, SIGUSR1 or SIGTERM stopped the program; `resume=True` continues
    the run."""


KINDS: dict[int, type[GrouserError]] = {2: InputError, 3: SimulationError, 4: DeviceError, 129: StoppedError,
                                        130: StoppedError, 138: StoppedError, 143: StoppedError}


def briefly(function: Callable[..., Any]) -> Callable[..., Any]:
    """Decorator that removes the frames of this package from the tracebacks of its exceptions."""
    @wraps(function)
    def called(*given: Any, **options: Any) -> Any:
        try:
            return function(*given, **options)
        except (GrouserError, FileError, KeyError) as error:
            raise error.with_traceback(None) from error.__cause__
    return called


class FileError(ValueError):
    """A file or folder is missing, unreadable, damaged, or not of the expected kind."""
