# SPDX-License-Identifier: BSD-3-Clause
"""The energy ledger: changes since the first step of the run, and the time-integration error."""
import drawing
import series

TERMS = (
    ("drive_work", "drive work", "black"),
    ("kinetic", "kinetic", "tab:blue"),
    ("potential", "potential", "tab:green"),
    ("elastic", "elastic", "tab:orange"),
    ("dissipated", "dissipated", "tab:red"),
)


def plot(run):
    terms = [(run.get(f"ledger/{name}"), label, colour) for name, label, colour in TERMS]
    terms = [term for term in terms if series.finite(term[0])]
    if not terms:
        return None
    figure = drawing.Figure(figsize=(8.0, 6.5))
    energy, rest = figure.subplots(2, 1, sharex=True, gridspec_kw={"height_ratios": [2, 1]})
    for values, label, colour in terms:
        energy.plot(run.time, values, color=colour, label=label)
    energy.set_ylabel("energy change since the first step [J]")
    drawing.legend_above(energy, 5)
    error = run.get("ledger/integration_error")
    if series.finite(error):
        rest.plot(run.time, error, color="tab:purple")
    rest.set_ylabel("integration error [J]")
    rest.set_xlabel("time [s]")
    return figure
