"""No leak: memory after a hundred thousand calls is what it was after a thousand, and objects have their references."""
import resource
import sys

import numpy as np
import pytest
import scene

import textplane as tp

CALLS = 100_000
ROOM = 4 << 20  # bytes that the allocators of C and Python may have kept


def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * resource.getpagesize()


def one_of_everything(i):
    tp.plane_homography(scene.THETA, scene.T_T_H)
    tp.linearise_pose(scene.PATCH, scene.THETA, scene.GUESS, scene.PYRAMID, scene.CAMERA, level=2).H  # noqa: B018
    if i % 10 == 0:
        scene.PYRAMID.level(1)
        scene.PATCH.x(0)
        tp.Pyramid(scene.HOST[:40, :50]).level(0)
        with pytest.raises(ValueError):
            tp.plane_normal([1, 2])
        with pytest.raises(tp.Failure):
            tp.plane_from_points(np.zeros((0, 3)), raise_on_failure=True)
    if i % 100 == 0:
        fit = tp.align_pose(scene.PATCH, scene.THETA, scene.GUESS, scene.PYRAMID, scene.CAMERA)
        repr(fit)
        tp.make_patch(scene.PYRAMID, scene.CAMERA, scene.QUAD)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="/proc tells the memory")
def test_memory_does_not_grow():
    for i in range(2000):
        one_of_everything(i)
    before = resident()
    references = [sys.getrefcount(item) for item in (scene.PATCH, scene.PYRAMID, scene.CAMERA, scene.THETA, scene.HOST)]
    for i in range(CALLS):
        one_of_everything(i)
    assert resident() - before < ROOM
    assert references == [sys.getrefcount(item)
                          for item in (scene.PATCH, scene.PYRAMID, scene.CAMERA, scene.THETA, scene.HOST)]
