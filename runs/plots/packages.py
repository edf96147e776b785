# SPDX-License-Identifier: BSD-3-Clause
"""The Python packages that the plots need, from Debian."""
import importlib
import sys

MISSING = 3  # the exit status that says so; the program then shows the last line as it is


def require(*names):
    """Ends the program where one of these packages is missing, and says on its last line what to install."""
    for name in names:
        try:
            importlib.import_module(name)
        except ImportError as missing:
            package = (missing.name or name).split(".")[0]
            print(f"the Python package {package} is missing; install python3-{package}")
            sys.exit(MISSING)
