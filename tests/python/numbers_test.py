"""The same numbers as C++ to the bit: what numbers.cpp prints, in its order."""
import os
import subprocess

import numpy as np
import pytest
import scene

import textplane as tp

LEAST = 2000  # numbers to compare


def rows():
    """A name and its numbers, in the order of numbers.cpp."""
    yield "T_t_h.R", scene.T_T_H.R
    yield "T_t_h.t", scene.T_T_H.t
    yield "log", scene.T_T_H.log()
    yield "adjoint", scene.T_T_H.adjoint()
    yield "plane_homography", tp.plane_homography(scene.THETA, scene.T_T_H)
    yield "reanchor_plane", tp.reanchor_plane(scene.THETA, scene.T_T_H)
    host = scene.CAMERA.unproject(scene.QUAD)
    target = np.ones((4, 3))
    for i, m in enumerate(host):
        target[i, :2] = tp.warp_point(scene.THETA, scene.T_T_H, m).value
        target[i, 0] += 1e-4 * (i + 1)
    fit = tp.plane_from_matches(host, target, scene.T_T_H)
    yield "plane_from_matches", fit.value
    yield "plane_from_matches", fit.covariance
    yield "plane_from_matches", [fit.condition, fit.sigma]
    for level in range(scene.PATCH.levels):
        for values in "x", "y", "intensity", "gx", "gy":
            yield "patch", getattr(scene.PATCH, values)(level)
    yield from solves()


def solves():
    fit = tp.align_pose(scene.PATCH, scene.THETA, scene.GUESS, scene.PYRAMID, scene.CAMERA)
    yield "align_pose.R", fit.T_t_h.R
    yield "align_pose.t", fit.T_t_h.t
    yield "align_pose.information", fit.information
    yield "align_pose", [fit.cost, fit.zncc, fit.visible_pixels, fit.iterations]
    plane = tp.align_plane(scene.PATCH, [0.04, -0.08, 0.49], scene.T_T_H, scene.PYRAMID, scene.CAMERA)
    yield "align_plane", plane.theta
    yield "align_plane.covariance", plane.covariance
    yield "align_plane", [plane.cost, plane.zncc, plane.residual_variance, plane.iterations]
    arguments = scene.PATCH, scene.THETA, scene.GUESS, scene.PYRAMID, scene.CAMERA
    for name in "linearise_pose", "linearise_plane", "linearise_pose_plane":
        yield from equations(name, getattr(tp, name)(*arguments, level=1))
    T_w_h = scene.ERROR
    yield from equations("linearise_host_target_plane", tp.linearise_host_target_plane(
        scene.PATCH, scene.THETA, T_w_h, T_w_h @ scene.GUESS.inverse(), scene.PYRAMID, scene.CAMERA, level=1))
    out = tp.residuals(*arguments, level=1)
    yield "residuals", out.r
    yield "residuals", out.J


def equations(name, out):
    yield name, out.H
    yield name, out.b
    yield name, [out.cost, out.error, out.zncc, out.visible, out.mean, out.s]


def test_numbers_are_those_of_cpp():
    program = os.environ.get("TEXTPLANE_NUMBERS")
    if not program:
        pytest.skip("TEXTPLANE_NUMBERS does not name the program")
    lines = subprocess.run([program], capture_output=True, text=True, check=True).stdout.splitlines()
    ours = list(rows())
    assert [line.split()[0] for line in lines] == [name for name, _ in ours]
    compared = 0
    for line, (name, values) in zip(lines, ours):
        expected = np.array([float.fromhex(word) for word in line.split()[1:]])
        values = np.asarray(values, np.float64).ravel()
        assert values.tobytes() == expected.tobytes(), name
        compared += values.size
    assert compared > LEAST
    print(f"{compared} numbers are equal")
