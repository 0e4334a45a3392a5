#!/usr/bin/env python3
"""Derives the library's Jacobians from their definitions with sympy and compares them with the numbers that it prints.

usage: check.py PRINT_JACOBIANS   (the program of print_jacobians.cpp)

Definitions alone go in: q = (R + t theta^T) m, the perturbation T <- Exp(xi) T on its side, and the normalised residual
r = (h - mean h) / |h - mean h| - (I - mean I) / |I - mean I| of bilinearly interpolated intensities.
"""
import json
import subprocess
import sys

import sympy as sp

XI = sp.symbols("v0:3 w0:3")
DTHETA = sp.symbols("d0:3")
ZERO = {symbol: 0 for symbol in XI + DTHETA}
TOLERANCE = 1e-9
HOST = dict(fx=40.0, fy=42.0, cx=11.5, cy=11.25)
TARGET = dict(fx=38.0, fy=41.0, cx=12.25, cy=11.75)


def hat(w):
    return sp.Matrix([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])


def twist():
    """Exp(xi) to first order, which is all that a derivative at zero sees."""
    return sp.eye(3) + hat(XI[3:]), sp.Matrix(XI[:3])


def product(a, b):
    return a[0] * b[0], a[0] * b[1] + a[1]


def inverse(T):
    return T[0].T, -T[0].T * T[1]


def derivative(expression, symbols):
    return sp.Matrix(expression).jacobian(sp.Matrix(symbols)).subs(ZERO)


def log_first_order(T):
    """(v, omega) of a motion near the identity."""
    return [T[1][0], T[1][1], T[1][2], T[0][2, 1], T[0][0, 2], T[0][1, 0]]


class Checker:
    def __init__(self):
        self.count, self.worst, self.failed = 0, 0.0, []

    def compare(self, name, derived, printed):
        derived, printed = sp.Matrix(derived), sp.Matrix(printed)
        scale = max(1.0, max(abs(float(value)) for value in printed))
        worst = max(abs(float(a) - float(b)) for a, b in zip(derived, printed)) / scale
        self.count += len(printed)
        self.worst = max(self.worst, worst)
        if worst > TOLERANCE:
            self.failed.append(f"{name}: differs by {worst:.2e}")


def warp(T, theta, m):
    q = (T[0] + T[1] * theta.T) * m
    return sp.Matrix([q[0] / q[2], q[1] / q[2]])


def check_geometry(state, checker):
    T = sp.Matrix(state["R"]), sp.Matrix(state["t"])
    theta, m = sp.Matrix(state["theta"]), sp.Matrix(state["m"])
    moved, other = product(twist(), T), theta + sp.Matrix(DTHETA)
    checker.compare("warp by pose", derivative(warp(moved, theta, m), XI), state["warp_pose"])
    checker.compare("warp by theta", derivative(warp(T, other, m), DTHETA), state["warp_theta"])

    def reanchored(T, theta):
        """Where every point with theta^T p = 1 has theta'^T (R p + t) = 1."""
        a = T[0] * theta
        return a / (1 + (a.T * T[1])[0])
    checker.compare("plane by theta", derivative(reanchored(T, other), DTHETA), state["reanchor_theta"])
    checker.compare("plane by pose", derivative(reanchored(moved, theta), XI), state["reanchor_pose"])

    T_w_h = sp.Matrix(state["R_w_h"]), sp.Matrix(state["t_w_h"])
    T_w_t = sp.Matrix(state["R_w_t"]), sp.Matrix(state["t_w_t"])
    T_h_t = inverse(product(inverse(T_w_t), T_w_h))
    for side in ("left", "right"):
        def turned(pose):
            return product(twist(), pose) if side == "left" else product(pose, twist())
        for which, motion in (("host", product(inverse(T_w_t), turned(T_w_h))), ("target", product(inverse(turned(T_w_t)), T_w_h))):
            change = [value for value in log_first_order(product(motion, T_h_t))]
            checker.compare(f"{side} {which}", derivative(change, XI), state[f"{side}_{which}"])


def pixel(x, y):
    return (x * x * 3 + y * y * 5 + x * y * 7 + 11 * x) % 251


def bilinear(px):
    """The interpolant of the cell that the point lies in, as a polynomial of its position."""
    x0, y0 = (int(sp.floor(value.subs(ZERO))) for value in px)
    a, b = px[0] - x0, px[1] - y0
    return ((1 - a) * (1 - b) * pixel(x0, y0) + a * (1 - b) * pixel(x0 + 1, y0) + (1 - a) * b * pixel(x0, y0 + 1)
            + a * b * pixel(x0 + 1, y0 + 1))


def normalised(values):
    mean = sum(values) / len(values)
    norm = sp.sqrt(sum((value - mean) ** 2 for value in values))
    return sp.Matrix([(value - mean) / norm for value in values])


def check_residual(state, checker):
    T = product(twist(), (sp.Matrix(state["near_R"]), sp.Matrix(state["near_t"])))
    theta = sp.Matrix(state["theta"]) + sp.Matrix(DTHETA)
    parameters = XI + DTHETA
    intensities = []
    for (x,), (y,) in zip(state["x"], state["y"]):
        m = sp.Matrix([(x - HOST["cx"]) / HOST["fx"], (y - HOST["cy"]) / HOST["fy"], 1])
        u, v = warp(T, theta, m)
        intensities.append(bilinear((TARGET["fx"] * u + TARGET["cx"], TARGET["fy"] * v + TARGET["cy"])))
    values = [value.subs(ZERO) for value in intensities]
    dI = derivative(intensities, parameters)
    symbols = sp.symbols(f"i0:{len(values)}")
    at = dict(zip(symbols, values))
    host = normalised([row[0] for row in state["intensity"]])
    r = host - normalised(symbols).subs(at)
    by_intensity = {
        "exact": -sp.Matrix(normalised(symbols)).jacobian(sp.Matrix(symbols)).subs(at),
        # Mean and norm held: what is left of the derivative is 1 / norm.
        "frozen": -sp.eye(len(values)) / sp.sqrt(sum((value - sum(values) / len(values)) ** 2 for value in values)),
    }
    for name, outer in by_intensity.items():
        J = sp.Matrix((outer * dI).evalf(30))
        checker.compare(f"{name} H", (J.T * J).evalf(), state[f"{name}_H"])
        checker.compare(f"{name} b", (J.T * r).evalf(), state[f"{name}_b"])


def main(program):
    states = json.loads(subprocess.run([program], check=True, capture_output=True, text=True).stdout)
    checker = Checker()
    for state in states:
        check_geometry(state, checker)
        check_residual(state, checker)
    for line in checker.failed:
        print(line)
    print(f"{checker.count} entries of {len(states)} states compared, largest relative difference {checker.worst:.1e}")
    return 1 if checker.failed else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1]))
