#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Generates long scene files of mechanisms: make_mechanisms.py NAME [NUMBER...] [FILE]

    fourbar N          N four-bar linkages in a row: 2 N + 1 rods of 1 m and 1 kg (IFToMM benchmark, problem A02)
    andrews            Andrews' squeezing mechanism (IFToMM benchmark, problem A03; IVP test set)
    ring N SPIN        a ring of N track links spinning about its centre [rad/s]
    chain N TIP        a hanging chain of N links of 0.15 m and 1 kg with a mass at its end [kg]
    bennett            Bennett's linkage, overconstrained but movable
    strand N SAG       a strand of N track links between two rollers 0.667 m apart, sagging by SAG [m]

Without FILE, prints the scene to the terminal. These commands generated the files in runs/mechanisms:
    for m in 'fourbar 2' 'fourbar 40' andrews 'ring 46 10' 'chain 100 1e6' 'strand 12 0.01'; do ...; done
"""
import math
import sys

G = 9.81


def number(x):
    return repr(float(x)) if x != int(x) or abs(x) > 1e15 else repr(int(x))


def vector(*xs):
    return "[" + ", ".join(number(x) for x in xs) + "]"


def head(text, **run):
    lines = [f"# {line}".rstrip() for line in text.strip().splitlines()]
    lines += ["version = 1", "", "[run]"] + [f"{key} = {value}" for key, value in run.items()]
    return "\n".join(lines) + "\n"


def section(kind, **keys):
    return f"\n[[{kind}]]\n" + "".join(f"{key} = {value}\n" for key, value in keys.items())


def text(word):
    return f'"{word}"'


def names(*words):
    return "[" + ", ".join(text(w) for w in words) + "]"


def rod(name, x, y, along, vx):
    """A uniform rod of 1 m and 1 kg in the plane, along x or y."""
    thin, wide = 1e-4, 1 / 12
    inertia = (thin, wide, wide) if along == "x" else (wide, thin, wide)
    return section("body", name=text(name), mass=1, inertia=vector(*inertia), position=vector(x, y, 0),
                   velocity=vector(vx, 0, 0), **({"spin": vector(0, 0, -1)} if along == "y" else {}))


def fourbar(n):
    n = int(n)
    out = head(f"{n} four-bar linkages in a row: {2 * n + 1} uniform rods of 1 m and 1 kg, all joints revolute, started upright with\n"
               "the couplers at 1 m/s (IFToMM benchmark, problem A02). Every half turn all rods are\n"
               "aligned and the constraints lose rank.",
               duration=20 if n <= 40 else 10, time_step="1e-3", gravity=vector(0, -G, 0), output_interval=0.05, frame_interval=0.05)
    out += "\n[output]\nrecord = " + names("upright 0", "coupler 0", "foot 0") + "\n" if n > 2 else ""
    for i in range(n + 1):
        out += rod(f"upright {i}", i, 0.5, "y", 0.5)
    for i in range(n):
        out += rod(f"coupler {i}", i + 0.5, 1, "x", 1)
    axis = vector(0, 0, 1)
    for i in range(n + 1):
        out += section("joint", name=text(f"foot {i}"), bodies=names("world", f"upright {i}"), point=vector(i, 0, 0), axis=axis)
    for i in range(n):
        out += section("joint", name=text(f"left {i}"), bodies=names(f"upright {i}", f"coupler {i}"), point=vector(i, 1, 0), axis=axis)
        out += section("joint", name=text(f"right {i}"), bodies=names(f"coupler {i}", f"upright {i + 1}"), point=vector(i + 1, 1, 0),
                       axis=axis)
    return out


def andrews():
    """Constants and initial state of the IVP test set, with absolute and relative angles."""
    m = (.04325, .00365, .02373, .00706, .07050, .00706, .05498)
    inertia = (2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5)
    xa, ya, xb, yb, xc, yc, c0 = -.06934, -.00227, -.03635, .03273, .014, .072, 4530
    d, da, e, ea = .028, .0115, .02, .01421
    rr, ra, l0 = .007, 9.2e-4, .07785
    ss, sa, sb, sc, sd = .035, .01874, .01043, .018, .02
    ta, tb, u, ua, ub = .02308, .00916, .04, .01228, .00449
    zf, zt, fa, mom = .02, .04, .01421, .033
    be, th, ga, ph, de, om, ep = (-.0617138900142764496, 0, .455279819163070380, .222668390165885885, .487364979543842550,
                                  -.222668390165885885, 1.23054744454982119)
    sin, cos = math.sin, math.cos
    # Centres of mass of the seven bodies.
    centre = [
        (ra * cos(be), ra * sin(be)),
        (rr * cos(be) - da * cos(be + th), rr * sin(be) - da * sin(be + th)),
        (xb + sa * sin(ga) + sb * cos(ga), yb - sa * cos(ga) + sb * sin(ga)),
        (xa + zt * cos(de) + (e - ea) * sin(ph + de), ya + zt * sin(de) - (e - ea) * cos(ph + de)),
        (xa + ta * sin(de) - tb * cos(de), ya - ta * cos(de) - tb * sin(de)),
        (xa + u * sin(ep) + (zf - fa) * cos(om + ep), ya - u * cos(ep) + (zf - fa) * sin(om + ep)),
        (xa + ua * sin(ep) - ub * cos(ep), ya - ua * cos(ep) - ub * sin(ep)),
    ]
    F = (rr * cos(be), rr * sin(be))
    E = (rr * cos(be) - d * cos(be + th), rr * sin(be) - d * sin(be + th))
    G_ = (xa + zt * cos(de), ya + zt * sin(de))
    H = (xa + u * sin(ep), ya - u * cos(ep))
    D = (xb + sc * sin(ga) + sd * cos(ga), yb - sc * cos(ga) + sd * sin(ga))
    out = head("Andrews' squeezing mechanism: seven bodies in a plane, driven by a constant torque on the crank K1 against a spring\n"
               "(IFToMM benchmark, problem A03; constants of the IVP test set). No gravity; at rest at the start. All bodies are\n"
               "parallel to the axes at the start: only their centres and joints matter.",
               duration=.05, time_step="1e-5", gravity=vector(0, 0, 0), output_interval=2.5e-4, frame_interval=2.5e-4)
    for i in range(7):
        I = inertia[i]
        out += section("body", name=text(f"K{i + 1}"), mass=m[i], inertia=vector(I, I, I), position=vector(*centre[i], 0))
    pins = [("O", "world", "K1", (0, 0)), ("F", "K1", "K2", F), ("E3", "K2", "K3", E), ("E4", "K2", "K4", E), ("E6", "K2", "K6", E),
            ("B", "world", "K3", (xb, yb)), ("G", "K4", "K5", G_), ("A5", "world", "K5", (xa, ya)), ("H", "K6", "K7", H),
            ("A7", "world", "K7", (xa, ya))]
    for name, a, b, p in pins:
        out += section("joint", name=text(name), bodies=names(a, b), point=vector(*p, 0), axis=vector(0, 0, 1))
    out += section("spring", name=text("spring"), bodies=names("world", "K3"), point_a=vector(xc, yc, 0),
                   point_b=vector(D[0] - centre[2][0], D[1] - centre[2][1], 0), stiffness=c0, free_position=l0)
    out += section("drive", name=text("motor"), joint=text("O"), imposes=text("torque"), value=mom)
    return out


def ring(n, spin):
    n, spin = int(n), float(spin)
    pitch, mass = .154, 18.02
    R = pitch / (2 * math.sin(math.pi / n))
    apothem = R * math.cos(math.pi / n)
    T = mass * spin ** 2 * R * math.cos(math.pi / n) / (2 * math.sin(math.pi / n))
    out = head(f"A free ring of {n} track links on hinges, spinning about y at {spin:g} rad/s without gravity. It stays a regular\n"
               f"polygon; the force in each hinge is {T:.6f} N. One hinge is spherical, one universal: with revolute hinges only,\n"
               "the ring would be overconstrained.",
               duration=10, time_step="1e-3", gravity=vector(0, 0, 0), output_interval=.02, frame_interval=.05)
    out += "\n[output]\nrecord = " + names("link 0", f"link {n // 2}", "pin 0", f"pin {n // 4}") + "\n"
    for i in range(n):
        a = 2 * math.pi * (i + .5) / n
        p = (apothem * math.sin(a), 0, apothem * math.cos(a))
        v = (spin * p[2], 0, -spin * p[0])
        out += section("body", name=text(f"link {i}"), mass=mass, inertia=vector(.22, .04, .25), box=vector(.15, .38, .06), position=vector(*p),
                       axis=vector(0, 1, 0), angle=number(360 * (i + .5) / n), velocity=vector(*v), spin=vector(0, spin, 0))
    for i in range(n):
        a = 2 * math.pi * (i + 1) / n
        p = vector(R * math.sin(a), 0, R * math.cos(a))
        kind = {n // 3: {"type": text("spherical")},
                2 * n // 3: {"type": text("universal"), "axis": vector(0, 1, 0), "second_axis": vector(math.cos(a), 0, -math.sin(a))}}
        out += section("joint", name=text(f"pin {i}"), bodies=names(f"link {i}", f"link {(i + 1) % n}"), point=p,
                       **kind.get(i, {"axis": vector(0, 1, 0)}))
    return out


def chain(n, tip):
    n, tip = int(n), float(tip)
    length, mass = .15, 1
    out = head(f"A hanging chain of {n} links with {tip:g} kg at its end, {tip / mass:g} times a link's mass. At rest, the force in the pin above\n"
               f"link i is (({n} - i) {mass} kg + {tip:g} kg) g, in the first pin {(n * mass + tip) * G:.6g} N. The time step is small enough that\n"
               "transverse oscillations of the links do not grow.",
               duration=1, time_step=f"{min(1e-3, .05 / math.sqrt(n + tip / mass)):.1g}", gravity=vector(0, 0, -G), output_interval=.01, frame_interval=.1)
    out += "\n[output]\nrecord = " + names("link 0", "tip", "pin 0", f"pin {n // 2}", "tip pin") + "\n"
    for i in range(n):
        out += section("body", name=text(f"link {i}"), mass=mass, inertia=vector(.002, .002, .0002), position=vector(0, 0, -(i + .5) * length))
    out += section("body", name=text("tip"), mass=number(tip), point="true", position=vector(0, 0, -n * length))
    for i in range(n):
        out += section("joint", name=text(f"pin {i}"), bodies=names("world" if i == 0 else f"link {i - 1}", f"link {i}"),
                       point=vector(0, 0, -i * length), axis=vector(0, 1, 0))
    out += section("joint", name=text("tip pin"), type=text("spherical"), bodies=names(f"link {n - 1}", "tip"),
                   point=vector(0, 0, -n * length))
    return out


def strand(n, sag):
    """Links at rest between two points: the horizontal force H is equal in all pins, the vertical force decreases by
    the weight of one link per pin; each link has the direction of the force at its middle. The span determines H."""
    n, sag = int(n), float(sag)
    span, mass = .667, 18.02 * .667 / (.154 * n)
    # For a given H, the shape is a discrete catenary of links of length p. Span and sag determine p and H.
    def shape(p, H):
        pins = [(-span / 2, 0.0)]
        for i in range(n):
            V = mass * G * (i + .5 - n / 2)
            f = math.hypot(H, V)
            pins.append((pins[-1][0] + p * H / f, pins[-1][1] + p * V / f))
        return pins
    H = 1147.9 * span ** 2 / (8 * sag)
    for _ in range(200):
        p = span / sum(H / math.hypot(H, mass * G * (i + .5 - n / 2)) for i in range(n))
        H *= -min(y for _, y in shape(p, H)) / sag
    pins = shape(p, H)
    out = head(f"A strand of {n} track links at rest between two rollers {span} m apart, with a sag of {sag * 1e3:g} mm. The horizontal force\n"
               f"in every pin is {H:.9g} N (a discrete catenary; lambda g L^2 / (8 sag) = {1147.9 * span ** 2 / (8 * sag):.6g} N).",
               duration=.5, time_step="1e-4", gravity=vector(0, 0, -G), output_interval=.005, frame_interval=.05)
    for i in range(n):
        (x0, z0), (x1, z1) = pins[i], pins[i + 1]
        out += section("body", name=text(f"link {i}"), mass=number(mass), inertia=vector(.02, .004, .022),
                       position=vector((x0 + x1) / 2, 0, (z0 + z1) / 2), axis=vector(0, 1, 0), angle=number(-math.degrees(math.atan2(z1 - z0, x1 - x0))))
    for i in range(n + 1):
        a, b = ("world" if i == 0 else f"link {i - 1}"), ("world" if i == n else f"link {i}")
        kind = {"axis": vector(0, 1, 0)} if i % n else {"type": text("spherical")}
        out += section("joint", name=text(f"pin {i}"), bodies=names(a, b), point=vector(pins[i][0], 0, pins[i][1]), **kind)
    return out


def bennett():
    """Link lengths a, b, a, b and twists alpha, beta with sin(alpha) / a = sin(beta) / b; the other turns follow from
    the first: tan(t1 / 2) tan(t2 / 2) = sin((beta + alpha) / 2) / sin((beta - alpha) / 2)."""
    a, alpha, beta = 1.0, math.radians(30), math.radians(70)
    b = a * math.sin(beta) / math.sin(alpha)
    t1 = math.radians(60)
    t2 = 2 * math.atan(math.sin((beta + alpha) / 2) / math.sin((beta - alpha) / 2) / math.tan(t1 / 2))
    turns, links = (t1, t2, -t1, -t2), ((a, alpha), (b, beta), (a, alpha), (b, beta))
    # Denavit and Hartenberg: turn about z, then along x by the link, then twist about x.
    x, z, y, p = (1, 0, 0), (0, 0, 1), (0, 1, 0), (0, 0, 0)
    mix = lambda u, c, v, s: tuple(c * i + s * j for i, j in zip(u, v))
    pins = []
    for t, (length, twist) in zip(turns, links):
        pins.append((p, z))
        x, y = mix(x, math.cos(t), y, math.sin(t)), mix(y, math.cos(t), x, -math.sin(t))
        p = mix(p, 1, x, length)
        y, z = mix(y, math.cos(twist), z, math.sin(twist)), mix(z, math.cos(twist), y, -math.sin(twist))
    gap = max(abs(i - j) for u, v in ((p, pins[0][0]), (z, pins[0][1])) for i, j in zip(u, v))
    assert gap < 1e-12, gap
    out = head("Bennett's linkage: four links on four hinges with skew axes. It has 4 x 5 constraint rows for 3 x 6 degrees of\n"
               "freedom, three more than a movable mechanism should have, but one degree of freedom remains.",
               duration=5, time_step="1e-3", gravity=vector(0, 0, -G), output_interval=.01)
    for i in range(1, 4):
        (p0, _), (p1, _) = pins[i], pins[(i + 1) % 4]
        out += section("body", name=text(f"link {i}"), mass=1, inertia=vector(.1, .12, .14), position=vector(*mix(p0, .5, p1, .5)))
    for i in range(4):
        ends = ("world" if i == 0 else f"link {i}"), ("world" if i == 1 else f"link {(i + 3) % 4}")
        out += section("joint", name=text(f"pin {i}"), bodies=names(*reversed(ends)), point=vector(*pins[i][0]), axis=vector(*pins[i][1]))
    return out


MAKERS = {"bennett": (bennett, 0), "fourbar": (fourbar, 1), "andrews": (andrews, 0), "ring": (ring, 2), "chain": (chain, 2), "strand": (strand, 2)}


def main(words):
    maker, count = MAKERS.get(words[0] if words else "", (None, 0))
    if maker is None or not count <= len(words) - 1 <= count + 1:
        print(__doc__)
        return 2
    scene = maker(*words[1:1 + count])
    if len(words) - 1 > count:
        with open(words[-1], "w", encoding="utf-8") as file:
            file.write(scene)
    else:
        print(scene, end="")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
