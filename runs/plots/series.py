# SPDX-License-Identifier: BSD-3-Clause
"""Reading a results.h5."""
import numpy

SIDES = ("left", "right")


class Run:
    """The time series of a run. `get` returns None for a missing quantity."""

    def __init__(self, file):
        self._file = file
        self.time = file["series/time"][:]

    def get(self, path):
        if path not in self._file or len(self.time) == 0:
            return None
        item = self._file[path]
        values = item["value"][:] if "value" in item else item[:]
        return values[: len(self.time)] if "value" in item else float(values[0])

    def components(self, path):
        """Names of the components of a vector."""
        names = self._file[path]["value"].attrs.get("labels", [])
        return [name.decode() if isinstance(name, bytes) else str(name) for name in names]

    def text(self, name):
        """An attribute of the run; "" if missing."""
        value = self._file.attrs.get(name, "")
        return value.decode() if isinstance(value, bytes) else str(value)

    def field(self, path):
        """A dataset that is not a series; None if missing."""
        return self._file[path][:] if path in self._file else None

    def names(self, group):
        """Names in a group, such as bodies or joints."""
        return list(self._file[group]) if group in self._file else []

    def shoes(self, name):
        """{side: [rows, shoes]} of a quantity with a value per shoe."""
        tracks = {side: self.get(f"vehicle/{side}/{name}") for side in SIDES}
        return {side: values for side, values in tracks.items() if values is not None}


def finite(values):
    return values is not None and numpy.isfinite(values).any()
