# SPDX-License-Identifier: BSD-3-Clause
"""Grains and parts of a run over time for the 3-D view: a selection of frames and grains if there are many, positions
as 16-bit integers, each shape once."""
import math
from types import SimpleNamespace

import numpy

import damage
import grouser
import page as pages
from grouser.series import counted

PLACES = 12e6  # maximum number of grain positions, and of soil heights, in all frames of a run: most of the page
LARGEST = 10e6  # page size up to which another run is added [bytes]; e-mail accepts 15 MB
CODES = 65535  # number of codes of a coordinate; the last code marks absent grains


def chosen_frames(count, most):
    return numpy.unique(numpy.linspace(0, count - 1, min(count, most)).round().astype(int))


def at_surface(position, radius):
    """[n] Whether each grain is near the top of its column, two diameters wide, or at a side of the bed."""
    width = 4 * float(numpy.median(radius))
    low, high = position.min(axis=0), position.max(axis=0)
    cell = numpy.floor((position[:, :2] - low[:2]) / width).astype(int)
    columns = cell[:, 0] * (cell[:, 1].max() + 1) + cell[:, 1]
    top = numpy.full(columns.max() + 1, -numpy.inf)
    numpy.maximum.at(top, columns, position[:, 2])
    side = ((position[:, :2] < low[:2] + width / 2) | (position[:, :2] > high[:2] - width / 2)).any(axis=1)
    return (position[:, 2] > top[columns] - width / 2) | side


def chosen_grains(first, last, most):
    """Ids of the grains to draw: those at the surface in the first frame and all that enter later, then those that
    moved most."""
    ids = numpy.union1d(first.id, last.id)
    if len(ids) <= most:
        return ids
    score = numpy.zeros(len(ids))
    score[~numpy.isin(ids, first.id)] = 2  # entered later
    both, in_first, in_last = numpy.intersect1d(first.id, last.id, return_indices=True)
    moved = numpy.linalg.norm(last.position[in_last] - first.position[in_first], axis=1)
    score[numpy.searchsorted(ids, both)] = moved / (moved.max() or 1)
    surface = at_surface(first.position, first.radius)
    score[numpy.searchsorted(ids, first.id[surface])] += 1
    return numpy.sort(ids[numpy.argsort(-score, kind="stable")[:most]])


def whole_grains(frame):
    """Grains of a frame with finite position, radius and speed, and the number of other grains."""
    if not len(frame):
        return SimpleNamespace(id=numpy.empty(0, int), position=numpy.empty((0, 3)), radius=numpy.empty(0),
                               speed=numpy.empty(0), lost=0)
    read = {"id": frame.id, "position": frame.position, "radius": frame.radius, "speed": frame.grains("speed")}
    there = numpy.isfinite(read["position"]).all(axis=1) & numpy.isfinite(read["radius"]) & numpy.isfinite(read["speed"])
    return SimpleNamespace(**{name: values[there] for name, values in read.items()}, lost=int((~there).sum()))


def grains_of(made, frames, picked, most, most_places):
    """Positions, speeds and radii of the grains in the selected frames; total and selected number; largest number of
    invalid grains in a frame. None if there are no grains."""
    first, last = whole_grains(frames[picked[0]]), whole_grains(frames[picked[-1]])
    total, lost = len(numpy.union1d(first.id, last.id)), 0
    if total == 0:
        return None, 0, 0, max(first.lost, last.lost)
    ids = chosen_grains(first, last, min(most, int(most_places / len(picked))))
    places = numpy.full((len(picked), len(ids), 3), numpy.nan)
    speed = numpy.zeros((len(picked), len(ids)))
    radius = numpy.zeros(len(ids))
    for k, index in enumerate(picked):
        frame = whole_grains(frames[index])
        lost = max(lost, frame.lost)
        at = numpy.searchsorted(ids, frame.id)
        here = (at < len(ids)) & (ids[numpy.minimum(at, len(ids) - 1)] == frame.id)
        places[k, at[here]] = frame.position[here]
        speed[k, at[here]] = frame.speed[here]
        radius[at[here]] = frame.radius[here]
    return {"places": places, "speed": speed, "radius": radius}, total, len(ids), lost


def shapes_of(frames):
    """Distinct meshes of the parts: [(vertices in the body frame, triangles, [parts])]."""
    if not frames.parts:
        return []
    mesh, poses = frames[0].parts, frames[0].poses
    shapes = {}
    for part in range(len(poses)):
        triangles = mesh.triangles[mesh.part == part]
        if len(triangles) == 0:
            continue
        used, inner = numpy.unique(triangles, return_inverse=True)
        local = (mesh.vertices[used] - poses[part, :3]) @ grouser.rotation(poses[part, 3:])
        inner = inner.reshape(-1, 3)
        key = (len(used), len(inner), inner.tobytes())
        for vertices, _, parts in shapes.setdefault(key, []):
            if numpy.abs(vertices - local).max() < 1e-4 * numpy.abs(local).max():
                parts.append(part)
                break
        else:
            shapes[key].append((local, inner, [part]))
    return [shape for same in shapes.values() for shape in same]


def is_before_grains(corners, places):
    """Whether a part with these corners would hide the grains: its bounding box contains a tenth of them (drum,
    container), or the part is a wall: thin along x or y, and at least half as long and as high as the bed."""
    low, high = corners.min(axis=0), corners.max(axis=0)
    if numpy.mean(((places > low) & (places < high)).all(axis=1)) > 0.1:
        return True
    size, reach = high - low, numpy.ptp(places, axis=0)
    return any(size[a] < 0.02 * size.max() and size[1 - a] > 0.5 * reach[1 - a] and size[2] > 0.5 * reach[2]
               for a in (0, 1))


def is_steep(mesh):
    """Whether each triangle belongs to a wall."""
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    normal = numpy.cross(b - a, c - a)
    return numpy.abs(normal[:, 2]) < 0.3 * numpy.linalg.norm(normal, axis=1)


def hiding_parts(frames, places):
    """Indices of the parts that would hide the grains."""
    if places is None:
        return set()
    mesh, seen = frames[0].parts, places[numpy.isfinite(places).all(axis=1)]
    return {part for part in range(len(frames[0].poses)) if len(seen) and (mesh.part == part).any()
            and is_before_grains(mesh.vertices[numpy.unique(mesh.triangles[mesh.part == part])], seen)}


def box_of(places, corners, ground):
    """Bounding box of grains, parts and ground."""
    clouds = [cloud.reshape(-1, 3) for cloud in (places, corners, ground) if cloud is not None and cloud.size]
    points = numpy.concatenate(clouds)
    points = points[numpy.isfinite(points).all(axis=1)]
    return points.min(axis=0), points.max(axis=0)


def differences(codes):
    """Each frame as the difference from the previous frame, modulo 65536: zeros where nothing moves compress well."""
    codes[1:] = codes[1:] - codes[:-1]
    return codes


def add_grains(made, name, drawn, middle, data):
    places, radius = drawn["places"] - middle, drawn["radius"]
    low = numpy.nanmin(places, axis=(0, 1))
    unit = numpy.maximum(numpy.nanmax(places, axis=(0, 1)) - low, 1e-9) / (CODES - 1)
    there = numpy.isfinite(places)
    codes = numpy.full(places.shape, CODES, dtype=numpy.uint16)
    codes[there] = ((places - low) / unit).round()[there].astype(numpy.uint16)
    codes = differences(codes.transpose(0, 2, 1).copy())
    fastest = float(drawn["speed"].max())
    moved = numpy.linalg.norm(drawn["places"] - drawn["places"][0], axis=2)
    most_moved = float(numpy.nanquantile(moved, 0.99)) if numpy.isfinite(moved).any() else 0.0
    heights = drawn["places"][..., 2]
    data["grains"] = {
        "places": made.array(f"{name}.places", codes), "low": low.tolist(), "unit": unit.tolist(),
        "radius": made.array(f"{name}.radius", radius.astype(numpy.float32)),
        "speed": made.array(f"{name}.speed", (drawn["speed"] / (fastest or 1) * 255).round().astype(numpy.uint8)),
        "fastest": fastest,
        "ranges": {"height": [float(numpy.nanmin(heights)), float(numpy.nanmax(heights))],
                   "speed": [0.0, float(numpy.quantile(drawn["speed"], 0.995)) or fastest or 1.0],
                   **({"moved": [0.0, most_moved or 1.0]} if len(places) > 1 else {})},
        "units": {"height": "m", "speed": "m/s", "moved": "m"}}


def nodes_of(vertices):
    """One number for the x and y of each vertex."""
    return numpy.ascontiguousarray(vertices[:, :2], dtype=numpy.float32).view(numpy.complex64)[:, 0]


def soil_of(frames, picked, most):
    """Surface of deformable soil: vertices [v, 3] and triangles [t, 3] of the last frame, and heights [1 + frames, v]
    [m]: the undisturbed surface, then at most `most` heights of every `stride`-th frame up to the last. A vertex that
    an earlier frame lacks was undisturbed there. None without deformable soil."""
    if not len(frames.parts):
        return None
    last = frames[picked[-1]]
    try:
        vertices, triangles = last.soil("position"), last.soil("triangles")
    except KeyError:
        return None
    stride = max(1, math.ceil(len(picked) * len(vertices) / most))
    kept = picked[::-stride][::-1]
    heights = numpy.tile(vertices[:, 2] + last.soil("sinkage"), (1 + len(kept), 1))
    nodes = nodes_of(vertices)
    order = numpy.argsort(nodes)
    for row, k in zip(heights[1:], kept):
        position = frames[k].soil("position")
        found = numpy.searchsorted(nodes, nodes_of(position), sorter=order)
        at = order[numpy.minimum(found, len(nodes) - 1)]
        here = nodes[at] == nodes_of(position)
        row[at[here]] = position[here, 2]
    return SimpleNamespace(vertices=vertices, triangles=triangles, heights=heights, stride=stride)


def add_soil(made, name, soil, middle, data):
    low, high = float(soil.heights.min()), float(soil.heights.max())
    unit = (high - low) / CODES or 1.0
    codes = differences(((soil.heights - low) / unit).round().astype(numpy.uint16))
    data["soil"] = {"vertices": made.array(f"{name}.soil", (soil.vertices - middle).astype(numpy.float32)),
                    "triangles": made.array(f"{name}.soil_corners", soil.triangles.astype(numpy.uint32)),
                    "heights": made.array(f"{name}.heights", codes), "low": low - float(middle[2]), "unit": unit,
                    "stride": soil.stride}
    if soil.stride > 1:
        data["words"] += f" The surface of the soil changes only once in {soil.stride} frames."


class AtEnd:
    """Grains of the checkpoint as the only frame of a run without frames."""
    parts, ground, poses = [], None, None

    def __init__(self, run):
        bed = run.bed()
        self.position, self.radius, self.id = bed.position, bed.radius, numpy.arange(len(bed))
        self.speed = numpy.linalg.norm(bed.velocity, axis=1)
        self.time = run.time[-1:]

    def __getitem__(self, _):
        return self

    def __len__(self):
        return 1 if self.id is None else len(self.id)

    def grains(self, name):
        return getattr(self, name)


def frames_of(run):
    """Source of the 3-D view of a run, number of its frames, and a description; (None, 0, "") without frames."""
    if run.frames is not None and len(run.frames):
        return run.frames, len(run.frames), f"of {counted(len(run.frames), 'frame')}"
    try:
        still = AtEnd(run)
    except (grouser.FileError, OSError, KeyError, ValueError):
        return None, 0, ""
    if not len(still) or not len(still.time):
        return None, 0, ""
    return still, 1, f"frame, from the checkpoint: {damage.without_frames(run)}; parts not shown"


def data_of(made, run, place, options, places):
    """Adds the data of a run's 3-D view to the page; None if there is nothing to draw."""
    frames, count, words = frames_of(run)
    if frames is None:
        return None
    picked = chosen_frames(count, options.frames)
    drawn, total, left, lost = grains_of(made, frames, picked, options.grains, places)
    shapes = shapes_of(frames)
    soil = soil_of(frames, picked, places)
    ground = None if soil else frames.ground
    poses = numpy.array([frames[k].poses for k in picked]) if shapes else None
    if drawn is None and poses is None:
        return None
    corners = None if poses is None else numpy.concatenate([frames[k].parts.vertices for k in (picked[0], picked[-1])])
    low, high = box_of(None if drawn is None else drawn["places"], corners,
                       soil.vertices if soil else None if ground is None else ground.vertices)
    reach = 0.0 if drawn is None else float(drawn["radius"].max())  # the box contains the centres of grains only
    low, high = low - reach, high + reach
    middle = 0.5 * (low + high)
    name = f"space{place}"
    data = {"name": run.folder.name, "time": made.array(f"{name}.time", frames.time[picked]), "middle": middle.tolist(),
            "names": frames.parts, "box": [(low - middle).tolist(), (high - middle).tolist()], "shapes": [],
            "words": words_of(len(picked), words, left, total, lost)}
    if drawn is not None:
        add_grains(made, name, drawn, middle, data)
    if poses is not None:
        poses[:, :, :3] -= middle
        data["poses"] = made.array(f"{name}.poses", poses.astype(numpy.float32))
        hiding = hiding_parts(frames, None if drawn is None else drawn["places"][0])
        for k, (vertices, triangles, parts) in enumerate(shapes):
            data["shapes"].append({"vertices": made.array(f"{name}.shape{k}", vertices.astype(numpy.float32)),
                                   "triangles": made.array(f"{name}.corners{k}", triangles.astype(numpy.uint32)),
                                   "parts": parts, "clear": any(part in hiding for part in parts)})
    if soil:
        add_soil(made, name, soil, middle, data)
    if ground is not None:
        vertices = made.array(f"{name}.ground", (ground.vertices - middle).astype(numpy.float32))
        steep = is_steep(ground) & (drawn is not None)
        data["grounds"] = [{"vertices": vertices, "clear": clear,
                            "triangles": made.array(f"{name}.ground{int(clear)}", triangles.astype(numpy.uint32))}
                           for clear, triangles in ((False, ground.triangles[~steep]), (True, ground.triangles[steep]))
                           if len(triangles)]
    return data


def words_of(shown, frames, count, total, lost):
    words = f"{shown} {frames}"
    if total:
        left_out = "" if count == total else " (priority: grains at the surface and sides, then grains that moved most)"
        words += f"; {count} of {total} grains{left_out}; positions rounded to 1/65534 of the bed size"
    if lost:
        words += f"; up to {lost} grains of a frame omitted: position, radius or speed is not finite"
    return words + "."


def section(made, runs, options):
    """HTML of the 3-D view of one or several runs; adds their data to the page up to a size limit. The reason if no
    run can be shown; "" if --frames is 0. FileError on the page of a run with damaged frames."""
    if options.frames == 0:
        return ""
    spaces, largest, left = [], 0, 0
    for place, run in enumerate(runs):
        before = made.bytes()
        if spaces and before + largest > LARGEST:
            left += 1
            continue
        try:
            data = data_of(made, run, place, options, PLACES if len(runs) == 1 else PLACES / 4)
        except (grouser.FileError, OSError, KeyError, RuntimeError) as error:  # the others are raised by h5py
            fault = error if isinstance(error, grouser.FileError) else damage.damaged(run.folder / "frames.h5")
            if made.kind == "run":
                raise fault from error
            damage.warn(made, {run.folder.name: str(fault)}, " This run is not in the 3-D view.")
            continue
        if data:
            spaces.append(data)
            largest = max(largest, made.bytes() - before)
    if not spaces:
        why = damage.without_frames(runs[0])
        return f"<p>No 3-D view: {pages.esc(why)}.</p>" if why else ""
    made.need(pages.SPACE)
    made.data["spaces"] = spaces
    return frame_html(spaces, left, any("grains" in s for s in spaces), any("chassis" in s["names"] for s in spaces))


def frame_html(spaces, left, grains, vehicle):
    moves = any("grains" in s and "moved" in s["grains"]["ranges"] for s in spaces)
    moved = '<option value="moved">displacement since the first frame [m]</option>' if moves else ""
    colours = f"""<label>Colour of grains <select id="space-colour">{moved}
<option value="speed">speed [m/s]</option><option value="height"{"" if moves else " selected"}>height z [m]</option></select></label>
<span class="scale"><span id="space-low"></span><canvas id="space-scale" width="192" height="16" role="img"
 aria-label="colour scale"></canvas><span id="space-high"></span></span>""" if grains else ""
    follow = '<label><input type="checkbox" id="space-follow"> follow the vehicle</label>' if vehicle else ""
    several = ""
    if len(spaces) > 1:
        names = "".join(f"<option>{pages.esc(s['name'])}</option>" for s in spaces)
        more = f" {left} more omitted to limit the size of the page." if left else ""
        several = (f'<div class="controls"><label>Run <select id="space-run">{names}</select></label>'
                   f'<span>{counted(len(spaces), "run")} to choose from.{more}</span></div>')
    return f"""<figure>{several}<div class="space" id="space"><canvas id="space-canvas" tabindex="0" role="application"
 aria-label="3-D view of grains and parts" aria-describedby="space-keys"></canvas>
<div class="label" id="space-time" aria-live="off"></div></div>
<div class="controls"><button id="space-back" aria-label="previous frame">&#9664;&#xfe0e;</button>
<button id="space-play">Play</button><button id="space-on" aria-label="next frame">&#9654;&#xfe0e;</button>
<input type="range" id="space-frame" min="0" max="0" value="0" aria-label="frame">
<button id="space-home">Reset view</button>{follow}</div>
<div class="controls">{colours}</div>
<figcaption><span id="space-words"></span> The white bar shows the scale. <span id="space-keys" class="keys">Drag: rotate,
wheel: zoom, right button: pan. Keys, with the view in focus: <kbd>Space</kbd> play and pause, <kbd>,</kbd>
<kbd>.</kbd> step, <kbd>Home</kbd> <kbd>End</kbd> first and last frame, arrows rotate, <kbd>+</kbd> <kbd>&minus;</kbd>
zoom, <kbd>0</kbd> reset.</span></figcaption></figure>"""
