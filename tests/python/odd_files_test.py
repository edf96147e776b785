#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Unusual and damaged input files: each causes one clear error (exit code 2), a note, or the right result.

A case is a function that returns the files to write and the expectation on `grouser run scene.toml`."""
import os
import struct
import subprocess
import tempfile
import unittest
import zlib
from pathlib import Path

from fixture import ROOT

PROGRAM = os.environ.get("GROUSER_PROGRAM", str(ROOT / "build/bin/grouser"))

GROUND = """version = 1
[run]
duration = 1e-4
time_step = 1e-5
[material.m]
stiffness = 1e5
[[grain]]
position = [0.5, 0, 0.6]
radius = 0.01
material = "m"
{more}
[output]
plots = false
picture = false
frames = false
"""
MAP = GROUND.format(more="""[terrain]
kind = "rigid"
heightmap = "map.png"
size = [1.0, 0.5]
height_range = [0, 0.1]
material = "m"
""")
MESH = GROUND.format(more="""[[mesh]]
file = "{file}"
material = "m"
name = "thing"
{keys}
""")
GRAINS = """version = 1
[run]
duration = 1e-4
time_step = 1e-5
[material.m]
stiffness = 1e5
[[grains]]
form = "file"
file = "grains.txt"
material = "m"
[output]
plots = false
picture = false
frames = false
"""


# Pictures ------------------------------------------------------------------------------------------------------------

def chunk(kind, data, crc=None):
    code = zlib.crc32(kind + data) if crc is None else crc
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", code)


def png(columns=4, rows=3, bits=16, colour=0, raw=None, extra=b"", idat_crc=None, ihdr_crc=None, end=True, tail=b"",
        spoil=None, interlace=0, compressed=None):
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[colour]
    if raw is None:
        wide = (columns * bits * channels + 7) // 8
        raw = b"".join(b"\0" + bytes((40 * (c + r)) % 256 for c in range(wide)) for r in range(rows))
    packed = zlib.compress(raw) if compressed is None else compressed
    if spoil == "adler":
        packed = packed[:-1] + bytes([packed[-1] ^ 255])
    header = struct.pack(">IIBBBBB", columns, rows, bits, colour, 0, 0, interlace)
    out = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header, ihdr_crc) + extra + chunk(b"IDAT", packed, idat_crc)
    return out + (chunk(b"IEND", b"") if end else b"") + tail


def picture(data, expected, scene=MAP):
    return {"scene.toml": scene, "map.png": data}, expected


# Meshes --------------------------------------------------------------------------------------------------------------

CUBE = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
CUBE_FACES = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]


def obj(vertices=None, faces=None, scale=0.1, newline="\n", head="", joint=" "):
    lines = [head] if head else []
    for v in CUBE if vertices is None else vertices:
        lines.append("v " + joint.join(repr(c * scale) for c in v))
    for f in CUBE_FACES if faces is None else faces:
        lines.append("f " + " ".join(str(k) for k in f))
    return newline.join(lines) + newline


def triangles(vertices=CUBE, faces=CUBE_FACES, scale=0.1):
    for f in faces:
        for k in range(1, len(f) - 1):
            yield [tuple(scale * c for c in vertices[f[j] - 1]) for j in (0, k, k + 1)]


def stl(head=b"binary", cut=0, count=None, spoil=None):
    body = b""
    tris = list(triangles())
    for t in tris:
        body += struct.pack("<3f", 0, 0, 0) + b"".join(struct.pack("<3f", *v) for v in t) + b"\0\0"
    data = head.ljust(80, b"\0") + struct.pack("<I", len(tris) if count is None else count) + body
    return data[:len(data) - cut] if cut else data


def ascii_stl(cut=False):
    lines = ["solid a"]
    for t in triangles():
        lines += ["facet normal 0 0 0", "outer loop"] + ["vertex %g %g %g" % v for v in t] + ["endloop", "endfacet"]
    if not cut:
        lines.append("endsolid a")
    return "\n".join(lines[:-4] if cut else lines) + "\n"


def ply(form="ascii", indices=None, vertices=None, cut=0):
    faces = [tuple(k - 1 for k in f) for f in CUBE_FACES] if indices is None else indices
    points = [tuple(0.1 * c for c in v) for v in CUBE] if vertices is None else vertices
    head = (f"ply\nformat {form} 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\n"
            f"property float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    if form == "ascii":
        lines = [" ".join(map(repr, p)) for p in points] + [" ".join(map(str, (len(f), *f))) for f in faces]
        data = (head + "\n".join(lines) + "\n").encode()
    else:
        data = head.encode() + b"".join(struct.pack("<3f", *p) for p in points)
        data += b"".join(struct.pack(f"<B{len(f)}i", len(f), *f) for f in faces)
    return data[:len(data) - cut]


BAD_INDEX = [tuple(k - 1 for k in f) for f in CUBE_FACES[:-1]] + [(1, 3, 8, 5)]
SHORT_VERTEX = [tuple(0.1 * c for c in v) for v in CUBE[:-1]] + [(0.1, 0.1)]


def mesh(data, expected, file="thing.obj", keys="sphere_radius = 0.02"):
    return {"scene.toml": MESH.format(file=file, keys=keys), file: data}, expected


def grains(text, expected):
    return {"scene.toml": GRAINS, "grains.txt": text}, expected


def table(section, expected):
    return {"scene.toml": MAP.replace("[output]", section + "\n[output]"), "map.png": png()}, expected


MOTOR = """version = 1
[run]
duration = 1e-3
time_step = 1e-5
gravity = [0, 0, 0]
[[body]]
name = "wheel"
mass = 1.0
inertia = [1.0, 1.0, 1.0]
[[joint]]
name = "axle"
type = "revolute"
bodies = ["world", "wheel"]
point = [0, 0, 0]
axis = [0, 0, 1]
[[drive]]
name = "motor"
joint = "axle"
{keys}
[output]
plots = false
picture = false
frames = false
"""
DRIVEN = """version = 1
[run]
duration = 1e-3
[material.ground]
stiffness = 1e7
[terrain]
kind = "rigid"
heightmap = "heightmaps/flat.png"
size = [8.0, 4.0]
height_range = [0, 0]
material = "ground"
[vehicle]
spec = "car.toml"
sphere_radius = 0.03
[driver]
{driver}
"""
VEHICLE = (ROOT / "assets/vehicles/light_tracked.toml").read_text().replace("../meshes", str(ROOT / "assets/meshes"))


def motor(keys, expected):
    return {"scene.toml": MOTOR.format(keys=keys)}, expected


def vehicle(spec, expected, driver="sprocket_speed = 1"):
    return {"scene.toml": DRIVEN.format(driver=driver), "car.toml": spec}, expected


def changed(was, now):
    assert was in VEHICLE, was
    return VEHICLE.replace(was, now, 1)


class Error(list):
    """Expects exit code 2 and one line that contains all of these texts."""


class Note(list):
    """Expects exit code 0 and a note that contains all of these texts."""


class Right(list):
    """Expects exit code 0, and all of these texts in the output of `grouser plan`."""


def flipped():
    return [tuple(reversed(f)) for f in CUBE_FACES]


def shells(offset, scale=1.0, faces=CUBE_FACES):
    more = [tuple(offset[a] + scale * v[a] for a in range(3)) for v in CUBE]
    return CUBE + more, CUBE_FACES + [tuple(k + 8 for k in f) for f in faces]


L_SHAPE = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]


def prism(outline, height=1.0):
    n = len(outline)
    v = [(x, y, 0) for x, y in outline] + [(x, y, height) for x, y in outline]
    f = [tuple(range(n, 0, -1)), tuple(range(n + 1, 2 * n + 1))]
    f += [(k + 1, (k + 1) % n + 1, (k + 1) % n + n + 1, k + n + 1) for k in range(n)]
    return v, f


# Only the complete cube, with all faces in place, is converted to these spheres.
CUBE_CUT = Right(["thing: 92 spheres"])
# Mesh errors suggest a remedy.
REMEDY = "export|repair|close|flip|correct|give it|write|remove|make all"

CASES = {
    # height-maps
    "map 16 bit": picture(png(), Right()),
    "map 8 bit": picture(png(bits=8), Right()),
    "map colour": picture(png(bits=8, colour=2), Note(["luminance"])),
    "map colour of equal channels": picture(
        png(bits=8, colour=2, raw=b"".join(b"\0" + bytes(20 * (k // 3) for k in range(12)) for _ in range(3))),
        Right()),
    "map with alpha": picture(png(bits=8, colour=6), Note(["luminance"])),
    "map grey with alpha": picture(png(bits=8, colour=4), Note(["alpha"])),
    "map 16 bit colour": picture(png(bits=16, colour=2), Note(["luminance"])),
    "map 1 bit": picture(png(columns=8, bits=1), Right()),
    "map palette": picture(png(bits=8, colour=3, raw=b"\0\0\1\2\1" * 3, extra=chunk(b"PLTE", bytes(range(9)))),
                           Note(["luminance"])),
    "map without palette": picture(png(bits=8, colour=3, raw=b"\0\0\1\2\1" * 3), Error(["map.png"])),
    "map wrong CRC of data": picture(png(idat_crc=1), Error(["map.png", "damaged"])),
    "map wrong CRC of header": picture(png(ihdr_crc=1), Error(["map.png", "damaged"])),
    "map wrong adler": picture(png(spoil="adler"), Error(["map.png", "damaged"])),
    "map without end": picture(png(end=False), Error(["map.png", "truncated"])),
    "map with bytes behind its end": picture(png(tail=b"more"), Right()),
    "map data too short": picture(png(raw=b"\0" * 9), Error(["map.png"])),
    "map filter of no kind": picture(png(bits=8, raw=b"\7\1\2\3\4" * 3), Error(["map.png"])),
    "map not deflated": picture(png(compressed=b"plain bytes"), Error(["map.png"])),
    "map gif": picture(b"GIF89a\2\0\2\0\x80\0\0" + b"\0" * 30, Error(["map.png"])),
    "map bmp": picture(b"BM" + b"\0" * 60, Error(["map.png"])),
    "map pgm": picture(b"P5 4 3 255\n" + bytes(12), Error(["map.png"])),
    "map jpeg cut short": picture(b"\xff\xd8\xff\xe0\0\x10JFIF\0\1\1", Error(["map.png"])),
    "map text chunk of wrong CRC": picture(png(extra=chunk(b"tEXt", b"Title\0a", 5)), Error(["map.png", "damaged"])),
    "map unknown critical chunk": picture(png(extra=chunk(b"ABCD", b"xx")), Error(["map.png"])),
    "map range reversed": picture(png(), Error(["height_range"]), MAP.replace("[0, 0.1]", "[0.1, 0]")),
    "map range nan": picture(png(), Error(["height_range"]), MAP.replace("[0, 0.1]", "[0, nan]")),
    "map range huge": picture(png(), Error(["scene.toml"]), MAP.replace("[0, 0.1]", "[0, 1e9]")),
    "map size zero": picture(png(), Error(["size"]), MAP.replace("[1.0, 0.5]", "[1.0, 0]")),
    # meshes
    "mesh right": mesh(obj(), CUBE_CUT),
    "mesh CRLF": mesh(obj(newline="\r\n"), CUBE_CUT),
    "mesh BOM": mesh("\ufeff" + obj(head="# cube"), CUBE_CUT),
    "mesh empty": mesh("", Error(["thing.obj"])),
    "mesh of points": mesh(obj(faces=[]), Error(["thing.obj"])),
    "mesh of lines": mesh(obj(faces=[]) + "l 1 2 3\n", Error(["thing.obj"])),
    "mesh index beyond": mesh(obj(faces=CUBE_FACES[:-1] + [(2, 4, 9, 6)]), Error(["thing.obj"])),
    "mesh index zero": mesh(obj(faces=CUBE_FACES[:-1] + [(0, 4, 8, 6)]), Error(["thing.obj"])),
    "mesh negative indices": mesh(obj(faces=[tuple(k - 9 for k in f) for f in CUBE_FACES]), CUBE_CUT),
    "mesh nan": mesh(obj(vertices=[(float("nan"), 0, 0)] + CUBE[1:]), Error(["thing.obj"])),
    "mesh inf": mesh(obj(vertices=[(float("inf"), 0, 0)] + CUBE[1:]), Error(["thing.obj"])),
    "mesh decimal commas": mesh(obj().replace("0.1", "0,1"), CUBE_CUT),  # the reader treats these faces as points
    "mesh a coordinate missing": mesh(obj().replace("v 0.1 0.1 0.1", "v 0.1 0.1"), Error(["thing.obj:8", "2 of"])),
    "mesh a coordinate missing and a vertex to spare": mesh(
        obj().replace("v 0.1 0.1 0.1", "v 0.1 0.1\nv 0 0 0.2"), Error(["thing.obj:8", "2 of its 3"])),
    "mesh of weights": mesh(obj().replace("v 0.1 0.1 0.1", "v 0.1 0.1 0.1 2"), Error(["thing.obj:8", "weight"])),
    "mesh of colours": mesh(obj().replace("v 0.1 0.1 0.1", "v 0.1 0.1 0.1 1 0 0"), CUBE_CUT),
    "mesh words for numbers": mesh(obj().replace("v 0.1 0.1 0.1", "v a b c"), Error(["thing.obj"])),
    "mesh without its lid": mesh(obj(faces=CUBE_FACES[:-1]), Error(["thing.obj", "open"])),
    "mesh inside out": mesh(obj(faces=flipped()), Error(["thing.obj", "flip the faces"])),
    "mesh one face turned": mesh(obj(faces=CUBE_FACES[:-1] + [tuple(reversed(CUBE_FACES[-1]))]),
                                 Error(["thing.obj", "make all faces point outwards"])),
    "mesh a face twice": mesh(obj(faces=CUBE_FACES + [CUBE_FACES[0]]), Note(["2 repeated faces were removed"])),
    "mesh degenerate triangle": mesh(obj(faces=CUBE_FACES + [(1, 2, 2)]), CUBE_CUT),
    "mesh two shells": mesh(obj(*shells((3, 0, 0))), Right(["thing: 184 spheres"])),
    "mesh hollow": mesh(obj(*shells((.25, .25, .25), .5, flipped())), Right(["thing: 182 spheres"])),
    "mesh shells across": mesh(obj(*shells((.5, .5, .5))), Right(["thing: 137 spheres"])),  # union of both shells
    "mesh concave polygon": mesh(obj(*prism(L_SHAPE)), Right(["thing: 245 spheres"])),
    "mesh stl": mesh(stl(), CUBE_CUT, "thing.stl"),
    "mesh stl that says solid": mesh(stl(b"solid exported"), CUBE_CUT, "thing.stl"),
    "mesh stl cut short": mesh(stl(cut=60), Error(["thing.stl"]), "thing.stl"),
    "mesh stl of more triangles": mesh(stl(count=40), Error(["thing.stl"]), "thing.stl"),
    "mesh stl text": mesh(ascii_stl(), CUBE_CUT, "thing.stl"),
    "mesh stl word for a number": mesh(ascii_stl().replace("vertex 0.1", "vertex abc", 1),
                                       Error(["thing.stl", '..."', "export it again"]), "thing.stl"),
    "mesh stl text cut short": mesh(ascii_stl(True), Error(["thing.stl"]), "thing.stl"),
    "mesh ply": mesh(ply(), CUBE_CUT, "thing.ply"),
    "mesh ply binary": mesh(ply("binary_little_endian"), CUBE_CUT, "thing.ply"),
    "mesh ply cut short": mesh(ply(cut=40), Error(["thing.ply", "close the holes"]), "thing.ply"),
    "mesh ply binary cut in a face": mesh(ply("binary_little_endian", cut=17), Error(["thing.ply"]), "thing.ply"),
    "mesh ply binary cut by a byte": mesh(ply("binary_little_endian", cut=1), Error(["thing.ply"]), "thing.ply"),
    "mesh ply binary cut in its vertices": mesh(ply("binary_little_endian", cut=130), Error(["thing.ply"]),
                                                "thing.ply"),
    "mesh ply cut in its header": mesh(ply()[:60], Error(["thing.ply", "end_header", "export it again"]), "thing.ply"),
    "mesh ply index beyond": mesh(ply(indices=BAD_INDEX), Error(["thing.ply", "face 6", "export it again"]),
                                  "thing.ply"),
    "mesh ply binary index beyond": mesh(ply("binary_little_endian", BAD_INDEX),
                                         Error(["thing.ply", "face 6", "export it again"]), "thing.ply"),
    "mesh ply a coordinate missing": mesh(ply(vertices=SHORT_VERTEX),
                                          Error(["thing.ply:17", "2 numbers", "correct the line"]), "thing.ply"),
    "mesh OBJ in capitals": mesh(obj(), CUBE_CUT, "thing.OBJ"),
    "mesh OBJ in capitals, a coordinate missing": mesh(
        obj().replace("v 0.1 0.1 0.1", "v 0.1 0.1\nv 0 0 0.2"), Error(["thing.OBJ:8", "2 of its 3"]), "thing.OBJ"),
    "mesh number that begins with a point": mesh(obj().replace("v 0.1 0.1 0.1", "v .1 0.1 0.1"),
                                                 Error(["thing.obj:8", "write 0.1"])),
    "mesh of five numbers": mesh(obj().replace("v 0.1 0.1 0.1", "v 0.1 0.1 0.1 1 0"), Error(["thing.obj:8", "5 num"])),
    "mesh indented": mesh(obj().replace("v 0.1 0.1 0.1", " v 0.1 0.1 0.1"), Error(["thing.obj:8", "indented"])),
    "mesh upper case": mesh(obj().replace("v 0.1 0.1 0.1", "V 0.1 0.1 0.1"), Error(["thing.obj:8", "upper case"])),
    "mesh CR": mesh(obj(newline="\r"), Error(["thing.obj:1", "save the file with Unix"])),
    "mesh in millimetres": mesh(obj(scale=1e5), Error(["scene.toml"]), keys=""),
    "mesh no thickness": mesh("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", Error(["thing.obj"])),
    "mesh of unknown format": mesh("hello", Error(["thing.xyz"]), "thing.xyz"),
    # grains
    "grains commas": grains("0,0,0.1,0.01\n0.1,0,0.1,0.01\n", Right()),
    "grains blanks": grains("0 0 0.1 0.01\n0.1\t0 0.1 0.01\n", Right()),
    "grains BOM": grains("\ufeff0,0,0.1,0.01\n", Right()),
    "grains CRLF": grains("0,0,0.1,0.01\r\n0.1,0,0.1,0.01\r\n", Right()),
    "grains comment": grains("# x,y,z,r\n0,0,0.1,0.01\n", Right()),
    "grains empty field": grains("0.1,0.2,0.3,0.01,,,,1,2,3\n", Error(["grains.txt:1"])),
    "grains trailing comma": grains("0,0,0.1,0.01,\n", Error(["grains.txt:1"])),
    "grains leading comma": grains(",0,0.1,0.01\n", Error(["grains.txt:1"])),
    "grains too few": grains("0,0,0.1\n", Error(["grains.txt:1"])),
    "grains too many": grains("0,0,0.1,0.01" + ",1" * 9 + "\n", Error(["grains.txt:1"])),
    "grains other width": grains("0,0,0.1,0.01\n0.1,0,0.1,0.01,1,2,3\n",
                                 Error(["grains.txt:2", "7 numbers", "use the same number in all lines"])),
    "grains in quotes": grains('"0","0","0.1","0.01"\n', Error(["grains.txt:1", "remove them"])),
    "grains header in quotes": grains('"x","y","z","r"\n0,0,0.1,0.01\n', Right()),
    "grains long word": grains("0,0,0.1," + "a" * 500 + "\n", Error(["grains.txt:1", "= " + "a" * 40 + " [m]"])),
    "grains decimal commas": grains("0,0;0,0;0,1;0,01\n", Error(["grains.txt:1"])),
    "grains nan": grains("0,0,nan,0.01\n", Error(["grains.txt:1"])),
    "grains inf": grains("inf,0,0.1,0.01\n", Error(["grains.txt:1"])),
    "grains of no radius": grains("0,0,0.1,0\n", Error(["grains.txt:1"])),
    "grains of negative radius": grains("0,0,0.1,-0.01\n", Error(["grains.txt:1"])),
    "grains of words": grains("a,b,c,d\n", Error(["grains.txt:1"])),
    "grains header": grains("x,y,z,r\n0,0,0.1,0.01\n", Right()),
    "grains header of another order": grains("r,x,y,z\n0.01,0,0,0.1\n", Error(["grains.txt:1"])),
    "grains header in mm": grains("x [mm],y [mm],z [mm],r [mm]\n0,0,100,10\n", Error(["grains.txt:1", "mm"])),
    "grains hexadecimal": grains("0x1,0,0.1,0.01\n", Error(["grains.txt:1"])),
    "grains with a unit": grains("0,0,0.1,10mm\n", Error(["grains.txt:1"])),
    "grains empty": grains("", Error(["grains.txt"])),
    "grains of comments": grains("# nothing\n\n", Error(["grains.txt"])),
    "grains binary": grains(b"\0\1\2\3" * 20, Error(["grains.txt", "not plain text"])),
    "grains utf16": grains("0,0,0.1,0.01\n".encode("utf-16"), Error(["grains.txt"])),
    "grains twice": grains("0,0,0.1,0.01\n0,0,0.1,0.01\n", Error(["overlap"])),
    # tables
    "table right": motor("time = [0, 1, 2]\nvalues = [0, 1, 0]", Right()),
    "table a jump": motor("time = [0, 1, 1]\nvalues = [0, 1, 0]", Right()),
    "table other lengths": motor("time = [0, 1, 2]\nvalues = [0, 1]", Error(["scene.toml:", "values"])),
    "table backwards": motor("time = [0, 2, 1]\nvalues = [0, 1, 0]", Error(["scene.toml:", "time"])),
    "table three times at once": motor("time = [0, 1, 1, 1]\nvalues = [0, 1, 2, 0]", Error(["scene.toml:", "time"])),
    "table nan": motor("time = [0, 1, 2]\nvalues = [0, nan, 0]", Error(["scene.toml:", "values"])),
    "table inf": motor("time = [0, 1, inf]\nvalues = [0, 1, 0]", Error(["scene.toml:", "time"])),
    "table before the start": motor("time = [-1, 1, 2]\nvalues = [0, 1, 0]", Error(["scene.toml:", "time"])),
    "table empty": motor("time = []\nvalues = []", Error(["scene.toml:"])),
    "table words": motor('time = ["0", "1"]\nvalues = [0, 1]', Error(["scene.toml:", "time"])),
    "table nested": motor("time = [[0, 1]]\nvalues = [[0, 1]]", Error(["scene.toml:", "time"])),
    "table without times": motor("values = [0, 1]", Error(["scene.toml:", "time"])),
    "table too quick": motor("imposes = \"position\"\ntime = [0, 1e-9]\nvalues = [0, 1]", Error(["scene.toml:"])),
    "table and value": motor("value = 1\ntime = [0, 1]\nvalues = [0, 1]", Right()),
    "driver table other lengths": vehicle(VEHICLE, Error(["scene.toml:"]),
                                          "[driver.table]\ntime = [0, 1]\nleft = [0, 1]\nright = [0]"),
    "driver table too fast": vehicle(VEHICLE, Error(["scene.toml:", "left"]),
                                     "[driver.table]\ntime = [0, 1]\nleft = [0, 1000]\nright = [0, 1]"),
    "driver speed and torque": vehicle(VEHICLE, Error(["scene.toml:"]), "sprocket_speed = 1\ntorque = 100"),
    # vehicle files
    "vehicle empty": vehicle("", Error(["car.toml"])),
    "vehicle binary": vehicle(b"\0\1\2" * 50, Error(["car.toml"])),
    "vehicle cut short": vehicle(VEHICLE[:len(VEHICLE) // 2], Error(["car.toml"])),
    "vehicle of another version": vehicle(changed("version = 1", "version = 9"), Error(["car.toml:", "version"])),
    "vehicle key misspelt": vehicle(changed("pad_bottom", "pad_botom"), Error(["car.toml:", "pad_bottom"])),
    "vehicle section misspelt": vehicle(changed("[sprocket]", "[sproket]"), Error(["car.toml:", "sprocket"])),
    "vehicle half a shoe": vehicle(changed("count = 46", "count = 46.5"), Error(["car.toml:", "count"])),
    "vehicle of no shoes": vehicle(changed("count = 46", "count = 0"), Error(["car.toml:", "count"])),
    "vehicle of 45 shoes": vehicle(changed("count = 46", "count = 45"), Error(["car.toml"])),
    "vehicle of 460 shoes": vehicle(changed("count = 46", "count = 460"), Error(["car.toml"])),
    "vehicle pitch in mm": vehicle(changed("pitch = 0.154", "pitch = 154"), Error(["car.toml"])),
    "vehicle without teeth": vehicle(changed("teeth = 10", "teeth = 0"), Error(["car.toml:", "teeth"])),
    "vehicle of 12 teeth": vehicle(changed("teeth = 10", "teeth = 12"), Error(["car.toml"])),
    "vehicle wheels through each other": vehicle(changed("spacing = 0.4458", "spacing = 0.1"), Error(["car.toml"])),
    "vehicle wheels of no size": vehicle(changed("radius = 0.19", "radius = 0"), Error(["car.toml:", "radius"])),
    "vehicle mass nan": vehicle(changed("mass = 3700.0", "mass = nan"), Error(["car.toml:", "mass"])),
    "vehicle inertia that no body has": vehicle(changed("[2050.0, 4000.0, 4220.0]", "[1.0, 1.0, 4220.0]"),
                                                Error(["car.toml:", "inertia"])),
    "vehicle inertia of two numbers": vehicle(changed("[2050.0, 4000.0, 4220.0]", "[1.0, 1.0]"),
                                              Error(["car.toml:", "inertia"])),
    "vehicle damping negative": vehicle(changed("pin_damping = 5.0", "pin_damping = -5.0"),
                                        Error(["car.toml:", "pin_damping"])),
    "vehicle mesh missing": vehicle(changed("shoe.obj", "shoes.obj"), Error(["shoes.obj"])),
    "vehicle mesh of another part": vehicle(changed('"shoe.obj"', '"sprocket.obj"'), Error(["sprocket.obj"])),
    "vehicle grousers up": vehicle(changed("pad_bottom = -0.040", "pad_bottom = 0.040"), Error(["car.toml"])),
    # scene text
    "scene utf16": ({"scene.toml": MAP.encode("utf-16"), "map.png": png()}, Error(["scene.toml"])),
    "scene BOM": ({"scene.toml": "\ufeff" + MAP, "map.png": png()}, Right()),
    "scene key twice": ({"scene.toml": MAP.replace("stiffness = 1e5", "stiffness = 1e5\nstiffness = 1e5")},
                        Error(["scene.toml:"])),
    "scene decimal comma": ({"scene.toml": MAP.replace("duration = 1e-4", "duration = 0,1")}, Error(["scene.toml:"])),
    "scene text for a number": ({"scene.toml": MAP.replace("duration = 1e-4", 'duration = "1"')}, Error(["duration"])),
}


class OddFiles(unittest.TestCase):
    def run_case(self, files, plans):
        with tempfile.TemporaryDirectory() as kept:
            folder = Path(kept)
            for name, data in files.items():
                (folder / name).write_bytes(data if isinstance(data, bytes) else data.encode())
            call = {"cwd": folder, "text": True, "capture_output": True, "timeout": 60,
                    "env": {**os.environ, "GROUSER_CACHE": str(folder / "cache")}}
            planned = subprocess.run([PROGRAM, "plan", "scene.toml"], **call).stdout if plans else ""
            done = subprocess.run([PROGRAM, "run", "scene.toml", "--out", "out"], **call)
            left = sorted(p.name for p in folder.iterdir() if p.name not in files and p.name != "cache")
        return done, left, planned

    def test_each(self):
        for name, (files, expected) in CASES.items():
            with self.subTest(name):
                done, left, planned = self.run_case(files, isinstance(expected, Right) and expected)
                said = done.stdout + done.stderr + planned
                if isinstance(expected, Error):
                    self.assertEqual(done.returncode, 2, said)
                    self.assertEqual(left, [], "left behind")
                    self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
                    said = done.stderr
                    if name.startswith("mesh") and "thing" in said:
                        self.assertRegex(said, REMEDY)
                else:
                    self.assertEqual(done.returncode, 0, said)
                for word in expected:
                    self.assertIn(word, said)


if __name__ == "__main__":
    unittest.main()
