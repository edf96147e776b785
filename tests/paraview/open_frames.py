# SPDX-License-Identifier: BSD-3-Clause
"""Opens frames.xdmf of a run in ParaView, compares it with other output of the run, and renders a picture.

pvpython open_frames.py FOLDER PICTURE. Exit code 1 with a message on any difference.
"""
import csv
import os
import re
import sys

from paraview import simple as pv
from paraview.vtk.util.numpy_support import vtk_to_numpy

folder, picture = sys.argv[1], sys.argv[2]


def check(claim, what):
    if not claim:
        print(f"paraview: {what}", file=sys.stderr, flush=True)
        os._exit(1)  # ParaView's normal exit crashes with an open view


# Create the view before reading data, since the OpenGL context cannot be created later.
view = pv.CreateRenderView(ViewSize=[1200, 700], Background=[1, 1, 1], UseColorPaletteForBackground=0)
view.OrientationAxesVisibility = 0
reader = pv.XDMFReader(FileNames=[f"{folder}/frames.xdmf"])
times = list(reader.TimestepValues)
with open(f"{folder}/timeseries.csv") as file:
    rows = [float(row["time [s]"]) for row in csv.DictReader(file)]
# The run uses the same interval for rows and frames.
check(times == rows, f"frames at {times} s, rows at {rows} s")

printed = open(f"{folder}/../run.txt").read()
grains_in_run = int(re.search(r"^grains +(\d+) of radius", printed, re.M).group(1))
blocks = {}


def collect(data, name):
    if data is None:
        return
    if not data.IsA("vtkMultiBlockDataSet"):
        blocks[name] = data
        return
    for i in range(data.GetNumberOfBlocks()):
        label = data.GetMetaData(i).Get(data.NAME()) if data.HasMetaData(i) else None
        # The reader numbers block names of later steps: "grains[1]".
        collect(data.GetBlock(i), re.sub(r"\[\d+\]$", "", label or name))


from paraview import servermanager  # noqa: E402

speeds = []
for time in times:
    reader.UpdatePipeline(time)
    blocks.clear()
    collect(servermanager.Fetch(reader), "")
    check(set(blocks) - {"ground"} == {"grains", "parts", "fields"}, f"blocks {sorted(blocks)}")
    grains = blocks["grains"]
    check(grains.GetNumberOfPoints() == grains_in_run and grains.GetNumberOfCells() == grains_in_run,
          f"{grains.GetNumberOfPoints()} grains, {grains_in_run} in the run")
    ids = vtk_to_numpy(grains.GetPointData().GetArray("id"))
    check((ids == range(grains_in_run)).all(), "the ids are not 0, 1, 2...")
    radius = vtk_to_numpy(grains.GetPointData().GetArray("radius"))
    check(radius.min() > 0 and abs(radius.min() - 0.038) < 1e-6, f"radius {radius.min()} m")
    speeds.append(float(vtk_to_numpy(grains.GetPointData().GetArray("speed")).max()))
    parts = blocks["parts"]
    number = int(vtk_to_numpy(parts.GetCellData().GetArray("part")).max()) + 1
    # The parts are 2 x (46 shoes, sprocket, idler, 5 wheels, 3 rollers) and the chassis.
    check(number == 113, f"{number} parts")
    low, high = parts.GetBounds()[4:6]
    check(0 < high - low < 2, f"the vehicle extends from {low} to {high} m")
    cells = blocks["fields"].GetCellData()
    porosity = vtk_to_numpy(cells.GetArray("porosity"))
    check(0.2 < porosity.min() < porosity.max() <= 1, f"porosity {porosity.min()} to {porosity.max()}")
    check(cells.GetArray("stress").GetNumberOfComponents() in (6, 9), "the stress is not a tensor")
check(speeds[0] == 0 and speeds[-1] > 0.05, f"maximum grain speeds {speeds} m/s, expected: at rest, then falling")

for name, colour in (("grains", [0.76, 0.62, 0.42]), ("parts", [0.25, 0.3, 0.36])):
    shown = pv.TrivialProducer()
    shown.GetClientSideObject().SetOutput(blocks[name])
    if name == "grains":
        shown = pv.Glyph(Input=shown, GlyphType="Sphere", ScaleArray=["POINTS", "radius"], ScaleFactor=2,
                         GlyphMode="All Points")
    display = pv.Show(shown, view)
    display.ColorArrayName = [None, ""]
    display.DiffuseColor = colour
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [-0.6, -3.9, 3.2], [2.0, 0.0, 0.1], [0, 0, 1]
pv.Render(view)
pv.SaveScreenshot(picture, view)

from paraview.vtk.vtkIOImage import vtkPNGReader  # noqa: E402

png = vtkPNGReader()
png.SetFileName(picture)
png.Update()
pixels = vtk_to_numpy(png.GetOutput().GetPointData().GetScalars())[:, :3].astype(int)
sand = ((pixels[:, 0] - pixels[:, 2]) > 20).mean()
steel = ((pixels.max(axis=1) < 120) & ((pixels[:, 2] - pixels[:, 0]) > 4)).mean()
check(sand > 0.03, f"{100 * sand:.1f} % of the picture: grains")
check(steel > 0.05, f"{100 * steel:.1f} % of the picture: the vehicle")
print(f"paraview: {len(times)} frames of {grains_in_run} grains and {number} parts, as in the run; "
      f"picture with {100 * sand:.0f} % grains, {100 * steel:.0f} % vehicle")
