"""Arguments that do not fit: an exception says which, what was expected and what came."""
import numpy as np
import pytest
import scene

import textplane as tp

RAYS = np.ones((5, 3))


@pytest.mark.parametrize("call, error, words", [
    (lambda: tp.Pyramid(scene.HOST.astype(np.float32)), ValueError, ["image", "uint8", "float32"]),
    (lambda: tp.Pyramid(scene.HOST[:, ::2]), ValueError, ["image", "side by side", "strides"]),
    (lambda: tp.Pyramid(scene.HOST[::-1]), ValueError, ["image", "rows in order"]),
    (lambda: tp.Pyramid(scene.HOST[0]), ValueError, ["(height, width)", "(640,)"]),
    (lambda: tp.Pyramid(scene.HOST[:0]), ValueError, ["(0, 640)"]),
    (lambda: tp.Pyramid("image.png"), TypeError, ["image", "type str"]),
    (lambda: tp.Pyramid(scene.HOST, 9), ValueError, ["levels", "1 to 8"]),
    (lambda: tp.plane_from_points(RAYS.astype(np.float32)), ValueError, ["p: ", "float64", "float32"]),
    (lambda: tp.plane_from_points(np.ones((3, 5)).T), ValueError, ["C-contiguous", "(5, 3)"]),
    (lambda: tp.plane_from_points(RAYS[:, :2]), ValueError, ["(n, 3)", "(5, 2)"]),
    (lambda: tp.plane_from_points(RAYS.tolist()), TypeError, ["p: ", "type list"]),
    (lambda: tp.plane_from_matches(RAYS, RAYS[:4], tp.SE3()), ValueError, ["host_m", "target_m", "5", "4"]),
    (lambda: tp.plane_normal([1, 2]), ValueError, ["theta", "3 numbers", "(2,)"]),
    (lambda: tp.plane_normal(np.array([1j, 0, 1])), ValueError, ["theta", "complex128"]),
    (lambda: tp.plane_normal("abc"), TypeError, ["theta", "type str"]),
    (lambda: tp.plane_normal(None), TypeError, ["theta", "None"]),
    (lambda: tp.plane_homography([0, 0, 1], np.eye(3)), ValueError, ["T_t_h", "(4, 4)", "(3, 3)"]),
    (lambda: tp.plane_homography([0, 0, 1], 2 * np.eye(4)[:3]), ValueError, ["T_t_h", "rotation"]),
    (lambda: tp.quad_area([[0, 0], [1, 0], [1, 1]]), ValueError, ["quad", "(4, 2)", "(3, 2)"]),
    (lambda: tp.make_patch(scene.HOST, None, scene.QUAD), TypeError, ["camera", "textplane.Camera", "None"]),
    (lambda: tp.make_patch(scene.HOST, scene.CAMERA, scene.QUAD, {}), TypeError, ["options", "SelectOptions", "dict"]),
    (lambda: tp.Camera("pinhole", [1, 2, 3]), ValueError, ["pinhole", "3 parameters", "kannala_brandt"]),
    (lambda: tp.PoseOptions(speed=1), TypeError, ["PoseOptions", "speed"]),
    (lambda: tp.warp_patch(scene.HOST, np.eye(3), (0, 5)), ValueError, ["shape"]),
    (lambda: tp.warp_patch(scene.HOST, np.eye(3), (5, 5), mask=np.zeros((4, 5), np.uint8)), ValueError, ["mask"]),
])
def test_says_what_was_expected(call, error, words):
    with pytest.raises(error) as caught:
        call()
    for word in words:
        assert word in str(caught.value)


def test_an_array_of_another_device_is_refused():
    class OnDevice:
        __cuda_array_interface__ = {"shape": (480, 640), "typestr": "|u1", "data": (0, False), "version": 3}

    with pytest.raises(TypeError, match="image: expected .* got an object of type OnDevice"):
        tp.Pyramid(OnDevice())


def test_rows_may_have_gaps():
    wide = np.zeros((480, 700), np.uint8)
    wide[:, 30:670] = scene.HOST
    patch = tp.make_patch(wide[:, 30:670], scene.CAMERA, scene.QUAD)
    assert patch.intensity().tobytes() == scene.PATCH.intensity().tobytes()


def test_output_is_written_in_place():
    out = np.full((480, 700), 7, np.uint8)
    result, inside, status = tp.warp_patch(scene.HOST, np.eye(3), out[:, :640])
    assert np.shares_memory(result, out) and inside == 640 * 480 and status == tp.Status.ok
    assert (out[:, :640] == scene.HOST).all() and (out[:, 640:] == 7).all()
    out.flags.writeable = False
    with pytest.raises(ValueError, match="out: expected an array that may be written to"):
        tp.warp_patch(scene.HOST, np.eye(3), out)


def test_views_of_results_are_in_place_and_read_only():
    level = scene.PYRAMID.level(1)
    assert level.shape == (240, 320) and level.base is scene.PYRAMID and not level.flags.writeable
    x = scene.PATCH.x(1)
    assert x.base is scene.PATCH and not x.flags.writeable
    with pytest.raises(IndexError):
        scene.PYRAMID.level(4)


def test_a_failure_is_a_value_unless_an_exception_is_asked_for():
    far = tp.SE3(np.eye(3), [1e3, 0, 0])
    arguments = scene.PATCH, scene.THETA, far, scene.PYRAMID, scene.CAMERA
    fit = tp.align_pose(*arguments)
    assert fit.status == tp.Status.out_of_view and not fit.ok and "out_of_view" in repr(fit)
    with pytest.raises(tp.Failure, match="align_pose: out_of_view") as caught:
        tp.align_pose(*arguments, raise_on_failure=True)
    assert caught.value.status == tp.Status.out_of_view
    assert isinstance(caught.value.result, tp.PoseAlignment)


def test_what_is_not_finite_has_a_status():
    fit = tp.align_pose(scene.PATCH, [0, float("nan"), 1], scene.T_T_H, scene.PYRAMID, scene.CAMERA)
    assert fit.status == tp.Status.non_finite
