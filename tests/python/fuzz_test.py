"""Arguments of all kinds, by a fixed seed: functions answer or raise, and the interpreter lives."""
import inspect
import random

import numpy as np
import scene

import textplane as tp

CALLS = 10000
NAN, INF = float("nan"), float("inf")
HUGE = np.full((4, 2), 1e308)


def values(rng):
    """An argument, good or bad."""
    shape = rng.choice([(3,), (2,), (0,), (6,), (3, 3), (4, 4), (4, 2), (5, 3), (5, 2), (0, 3), (16, 16), (1, 1), (2, 3, 4)])
    dtype = rng.choice([np.float64, np.float32, np.uint8, np.int64, np.complex128, object, ">f8", "U3", bool])
    array = np.array(rng.choices([0, 1, -1, 2, 100], k=int(np.prod(shape)))).reshape(shape).astype(dtype)
    return rng.choice([
        array, array[::-1], array.T, np.asfortranarray(array), array[..., ::2],
        np.full(shape, rng.choice([NAN, INF, -INF, 1e300, 1e-300, 0.0])),
        None, "", "ok", b"", 0, -1, 1, 2**31, 2**64, -(2**63), 0.5, NAN, INF, True, [], {}, (), [1, 2, 3], [[1], [2, 3]],
        object(), int, scene.CAMERA, scene.PATCH, scene.PYRAMID, scene.T_T_H, scene.GUESS, scene.THETA, scene.QUAD,
        scene.HOST, scene.TARGET, scene.HOST[:40, :50], scene.HOST[:, 3:200], scene.HOST[::2], HUGE, tp.SE3(),
        np.full((4, 4), NAN), np.eye(4), [(scene.PYRAMID, scene.T_T_H)], [tp.PoseText(scene.PATCH, scene.THETA)],
        [scene.QUAD], tp.Status.ok, tp.PoseOptions(), tp.Window(scene.CAMERA), tp.Pinhole(1e-300, 1e300, 0, 1e300),
    ])


def callables():
    out = [getattr(tp, name) for name in dir(tp) if not name.startswith("_")]
    out = [item for item in out if callable(item) and not inspect.ismodule(item)]
    for cls in [item for item in out if inspect.isclass(item)]:
        out += [getattr(cls, name) for name in dir(cls) if not name.startswith("_") and callable(getattr(cls, name))]
    return out


def good_arguments(rng):
    """What align_pose() and its like take, with one of them replaced."""
    arguments = [scene.PATCH, scene.THETA, scene.GUESS, scene.PYRAMID, scene.CAMERA]
    arguments[rng.randrange(5)] = values(rng)
    return arguments


def test_any_arguments():
    rng = random.Random(1)
    functions = callables()
    solvers = [tp.align_pose, tp.align_plane, tp.linearise_pose, tp.residuals, tp.search_pose, tp.evaluate]
    answered = raised = 0
    for i in range(CALLS):
        if i % 3 == 0:
            function, arguments = rng.choice(solvers), good_arguments(rng)
        else:
            function, arguments = rng.choice(functions), [values(rng) for _ in range(rng.randrange(8))]
        try:
            function(*arguments)
            answered += 1
        except (TypeError, ValueError, IndexError, AttributeError, KeyError, OverflowError, RuntimeError, MemoryError):
            raised += 1
    assert answered > CALLS // 50 and raised > CALLS // 10


def test_options_of_any_value():
    rng = random.Random(2)
    classes = [tp.PoseOptions, tp.SolveOptions, tp.SelectOptions, tp.PhotometricOptions, tp.KltOptions, tp.PlaneOptions,
               tp.SearchOptions, tp.WindowOptions, tp.Robust]
    numbers = [0, -1, 1, 2, 7, 100, 2**31 - 1, -(2**31), NAN, INF, 1e300, -1e300, 1e-300, True]
    for _ in range(3000):
        options = rng.choice(classes)()
        for name in rng.sample([n for n in dir(options) if not n.startswith("_")], 1):
            # How long it takes is the caller's choice; the test has other things to do.
            value = rng.choice(numbers[:6] if "iterations" in name or name == "radius" else numbers)
            try:
                setattr(options, name, value)
            except (TypeError, ValueError):
                continue
        if isinstance(options, tp.PoseOptions):
            tp.align_pose(scene.PATCH, scene.THETA, scene.GUESS, scene.PYRAMID, scene.CAMERA, options)
        elif isinstance(options, tp.PlaneOptions):
            tp.align_plane(scene.PATCH, scene.THETA, scene.T_T_H, scene.PYRAMID, scene.CAMERA, options)
        elif isinstance(options, tp.PhotometricOptions):
            tp.linearise_pose(scene.PATCH, scene.THETA, scene.GUESS, scene.PYRAMID, scene.CAMERA, options=options)
        elif isinstance(options, tp.KltOptions):
            tp.track_klt(scene.HOST, scene.PYRAMID, np.array([[300, 200]], np.float32), options=options)
        elif isinstance(options, tp.SelectOptions):
            tp.make_patch(scene.HOST, scene.CAMERA, scene.QUAD, options)
        elif isinstance(options, tp.SearchOptions):
            tp.search_pose(scene.PATCH, scene.THETA, scene.GUESS, scene.PYRAMID, scene.CAMERA, options)


def test_results_outlive_what_they_view():
    def level():
        return tp.Pyramid(scene.HOST).level(1)

    def positions():
        return tp.make_patch(scene.HOST, scene.CAMERA, scene.QUAD).x(1)

    pixels, x = level(), positions()
    for _ in range(50):
        tp.Pyramid(scene.TARGET)
        tp.make_patch(scene.TARGET, scene.CAMERA, scene.QUAD)
    assert (pixels == tp.Pyramid(scene.HOST).level(1)).all()
    assert x.tobytes() == scene.PATCH.x(1).tobytes()
