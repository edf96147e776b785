# SPDX-License-Identifier: BSD-3-Clause
"""Python packages required by the plots, from Debian."""
import importlib
import sys

MISSING = 3  # exit status; the program prints the last line of the script unchanged


def require(*names):
    """Exits if one of these packages is missing; prints the package to install as last line."""
    for name in names:
        try:
            importlib.import_module(name)
        except ImportError as missing:
            package = (missing.name or name).split(".")[0]
            print(f"the Python package {package} is missing; install python3-{package}")
            sys.exit(MISSING)
