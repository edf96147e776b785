#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Reference solutions of mechanisms without a closed form in elementary functions; requires python3-scipy.

    top_free.csv, top_flip.csv   the directions of the first two principal axes, by DOP853 (Hairer, Norsett and Wanner) at a
                                 tolerance of 3e-14 from Euler's equations with the attitude's quaternion
    andrews.csv                  point F, by DOP853 at 3e-14 from the equations of the IVP test set in minimal form with
                                 index 1, positions and velocities projected onto the constraints at each row
"""
import math
import pathlib
import sys

import numpy
from scipy.integrate import solve_ivp

HERE = pathlib.Path(__file__).resolve().parent


def write(name, columns, rows):
    with open(HERE / name, "w", encoding="utf-8") as file:
        file.write(",".join(columns) + "\n")
        for row in rows:
            file.write(",".join(f"{x:.14g}" for x in row) + "\n")


def top(name, spin, end, count):
    inertia = numpy.array([1.0, 2.0, 3.0])

    def rate(_, y):
        w, q = y[:3], y[3:]
        dw = -numpy.cross(w, inertia * w) / inertia
        dq = .5 * numpy.array([-q[1:] @ w, *(q[0] * w + numpy.cross(q[1:], w))])
        return numpy.concatenate([dw, dq])

    times = numpy.linspace(0, end, count + 1)
    y, rows = numpy.array([*spin, 1.0, 0, 0, 0]), []
    for before, now in zip(numpy.concatenate([[0], times]), times):
        if now > before:
            y = solve_ivp(rate, (before, now), y, method="DOP853", rtol=3e-14, atol=1e-15).y[:, -1]
            y[3:] /= numpy.linalg.norm(y[3:])
        w, x, u, v = y[3:]
        rows.append((now, 1 - 2 * (u * u + v * v), 2 * (x * u + w * v), 2 * (x * v - w * u),
                     2 * (x * u - w * v), 1 - 2 * (x * x + v * v), 2 * (u * v + w * x)))
    write(name, ("time [s]", "x.x", "x.y", "x.z", "y.x", "y.y", "y.z"), rows)
    return y


def andrews():
    m1, m2, m3, m4, m5, m6, m7 = .04325, .00365, .02373, .00706, .07050, .00706, .05498
    i1, i2, i3, i4, i5, i6, i7 = 2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5
    xa, ya, xb, yb, xc, yc, c0, l0, mom = -.06934, -.00227, -.03635, .03273, .014, .072, 4530., .07785, .033
    d, da, e, ea, rr, ra = .028, .0115, .02, .01421, .007, 9.2e-4
    ss, sa, sb, sc, sd, ta, tb, u, ua, ub, zf, zt, fa = .035, .01874, .01043, .018, .02, .02308, .00916, .04, .01228, .00449, .02, .04, .01421
    sin, cos = numpy.sin, numpy.cos
    # Each centre of mass and each closure point is a sum of arms r (cos, sin)(sum of angles + phase).
    B, T, G, P, D, O, E = range(7)

    def arm(length, *angles, phase=0.0):
        return length, angles, phase

    def polar(x, y, *angles):
        return arm(math.hypot(x, y), *angles, phase=math.atan2(y, x))

    crank = [arm(rr, B)]
    bodies = [(m1, i1, [arm(ra, B)], (B,)), (m2, i2, crank + [arm(-da, B, T)], (B, T)), (m3, i3, [polar(sb, -sa, G)], (G,)),
              (m4, i4, [arm(zt, D), polar(0, -(e - ea), P, D)], (P, D)), (m5, i5, [polar(-tb, -ta, D)], (D,)),
              (m6, i6, [polar(0, -u, E), arm(zf - fa, O, E)], (O, E)), (m7, i7, [polar(-ub, -ua, E)], (E,))]
    tip = crank + [arm(-d, B, T)]
    minus = lambda arms: [(-r, a, p) for r, a, p in arms]
    loops = [(tip + minus([polar(0, -ss, G)]), (-xb, -yb)), (tip + minus([arm(zt, D), polar(0, -e, P, D)]), (-xa, -ya)),
             (tip + minus([polar(0, -u, E), arm(zf, O, E)]), (-xa, -ya))]
    spring = [polar(sd, -sc, G)]

    def place(arms, q):
        """Sum of arms, its Jacobian, and the velocity part of its second derivative."""
        p, J = numpy.zeros(2), numpy.zeros((2, 7))
        for r, angles, phase in arms:
            a = sum(q[k] for k in angles) + phase
            p += r * numpy.array([cos(a), sin(a)])
            for k in angles:
                J[:, k] += r * numpy.array([-sin(a), cos(a)])
        return p, J

    def bend(arms, q, v):
        return -sum((r * sum(v[k] for k in angles) ** 2 * numpy.array([cos(sum(q[k] for k in angles) + phase), sin(sum(q[k] for k in angles) + phase)])
                     for r, angles, phase in arms), numpy.zeros(2))

    def acceleration(q, v):
        M, f = numpy.zeros((7, 7)), numpy.zeros(7)
        for m, I, arms, angles in bodies:
            _, J = place(arms, q)
            turn = numpy.zeros(7)
            turn[list(angles)] = 1
            M += m * J.T @ J + I * numpy.outer(turn, turn)
            f -= m * J.T @ bend(arms, q, v)
        p, J = place(spring, q)
        away = p + numpy.array([xb - xc, yb - yc])
        length = numpy.linalg.norm(away)
        f -= c0 * (length - l0) / length * J.T @ away
        f[B] += mom
        C = numpy.concatenate([place(arms, q)[1] for arms, _ in loops])
        rest = numpy.concatenate([bend(arms, q, v) for arms, _ in loops])
        K = numpy.block([[M, C.T], [C, numpy.zeros((6, 6))]])
        return numpy.linalg.solve(K, numpy.concatenate([f, -rest]))[:7]

    def project(q, v):
        for _ in range(10):
            gap = numpy.concatenate([place(arms, q)[0] + numpy.array(offset) for arms, offset in loops])
            C = numpy.concatenate([place(arms, q)[1] for arms, _ in loops])
            q = q - numpy.linalg.lstsq(C, gap, rcond=None)[0]
        C = numpy.concatenate([place(arms, q)[1] for arms, _ in loops])
        return q, v - numpy.linalg.lstsq(C, C @ v, rcond=None)[0]

    q = numpy.array([-.0617138900142764496, 0, .455279819163070380, .222668390165885885, .487364979543842550, -.222668390165885885,
                     1.23054744454982119])
    v, rows, step = numpy.zeros(7), [(0.0, rr * cos(q[0]), rr * sin(q[0]))], .05 / 200
    for k in range(200):
        s = solve_ivp(lambda t, y: numpy.concatenate([y[7:], acceleration(y[:7], y[7:])]), (0, step), numpy.concatenate([q, v]),
                      method="DOP853", rtol=3e-14, atol=1e-14)
        q, v = project(s.y[:7, -1], s.y[7:, -1])
        rows.append(((k + 1) * step, rr * cos(q[0]), rr * sin(q[0])))
    write("andrews.csv", ("time [s]", "F.x", "F.y"), rows)
    return q


def main():
    for name, spin in (("top_free.csv", (1, 1, 1)), ("top_flip.csv", (.01, 5, .01))):
        y = top(name, spin, 20, 200)
        w, x, u, v = y[3:]
        turn = numpy.array([[1 - 2 * (u * u + v * v), 2 * (x * u - w * v), 2 * (x * v + w * u)],
                            [2 * (x * u + w * v), 1 - 2 * (x * x + v * v), 2 * (u * v - w * x)],
                            [2 * (x * v - w * u), 2 * (u * v + w * x), 1 - 2 * (x * x + u * u)]])
        inertia = numpy.array([1, 2, 3])
        print(name, "angular momentum in the world off by", numpy.abs(turn @ (inertia * y[:3]) - inertia * spin).max())
    print("andrews.csv: angles at 0.05 s", andrews(), "(literature value of the crank angle: 33.8258677669525)")


if __name__ == "__main__":
    sys.exit(main())
