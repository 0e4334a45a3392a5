"""The scene of numbers.cpp: a textured plane seen by two cameras."""
import numpy as np

import textplane as tp

CAMERA = tp.Pinhole(500, 500, 319.5, 239.5)
THETA = np.array([0.05, -0.1, 0.5])
T_T_H = tp.SE3.exp([0.05, -0.02, 0.03, 0.01, -0.02, 0.03])
ERROR = tp.SE3.exp([0.004, -0.003, 0.004, 0.002, -0.001, 0.003])
GUESS = ERROR @ T_T_H
QUAD = np.array([[200.0, 150], [420, 160], [415, 330], [205, 320]])


def host_image():
    y, x = np.mgrid[:480, :640].astype(np.int64)
    wave = lambda at, period: np.abs(at % period - period // 2)  # noqa: E731
    return (60 + 4 * wave(x, 41) + 3 * wave(y, 37) + 2 * wave(x + 2 * y, 53)).astype(np.uint8)


def target_image(host):
    H = tp.plane_homography_inverse(THETA, T_T_H)
    return tp.warp_patch(host, tp.pixel_homography(H, CAMERA, CAMERA), (480, 640))[0]


HOST = host_image()
TARGET = target_image(HOST)
PATCH = tp.make_patch(HOST, CAMERA, QUAD)
PYRAMID = tp.Pyramid(TARGET)
