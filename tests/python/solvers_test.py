"""Solvers and geometry through Python find what is true."""
import pickle
import threading

import numpy as np
import pytest
import scene

import textplane as tp

CORNERS = 0.2  # px: the target is the host sampled bilinearly, which moves edges by a tenth of a pixel
PLANE = 0.01  # 1/m, likewise, with a baseline of 3 % of the distance


def off(T):
    """Corners of the quad in the target, px off the truth."""
    seen = [tp.project_quad(scene.QUAD, scene.CAMERA, scene.THETA, pose, scene.CAMERA) for pose in (T, scene.T_T_H)]
    return np.linalg.norm(seen[0] - seen[1], axis=1).max()


def test_align_pose():
    assert off(scene.GUESS) > 2
    fit = tp.align_pose(scene.PATCH, scene.THETA, scene.GUESS, scene.PYRAMID, scene.CAMERA)
    assert fit.ok and fit.zncc > 0.98 and off(fit.T_t_h) < CORNERS
    assert fit.information.shape == (6, 6)
    as_image = tp.align_pose(scene.PATCH, scene.THETA, scene.GUESS.matrix(), scene.TARGET, scene.CAMERA)
    assert np.abs(as_image.T_t_h.matrix() - fit.T_t_h.matrix()).max() < 1e-12


def test_refine_pose_with_texts_and_points():
    text = tp.PoseText(scene.PATCH, scene.THETA)
    points = np.array(tp.quad_points(scene.QUAD, scene.CAMERA, scene.THETA))
    pixels = scene.CAMERA.project(scene.T_T_H @ points)
    fit = tp.refine_pose([text], scene.PYRAMID, scene.CAMERA, scene.GUESS, points, pixels)
    assert fit.ok and fit.texts == 1 and fit.inlier_points == 4 and off(fit.T_t_w) < CORNERS
    assert fit.text_zncc.shape == (1,) and fit.point_chi2.shape == (4,)
    only_points = tp.refine_pose([], scene.PYRAMID, scene.CAMERA, scene.GUESS, points, pixels)
    assert off(only_points.T_t_w) < 1e-3


def test_search_pose_and_candidates():
    found = tp.search_pose(scene.PATCH, scene.THETA, scene.GUESS, scene.PYRAMID, scene.CAMERA)
    zncc, status = tp.zncc_candidates(scene.PATCH, scene.THETA, [scene.GUESS, scene.T_T_H], scene.PYRAMID, scene.CAMERA)
    assert status == tp.Status.ok and zncc[1] > zncc[0] and found.zncc > zncc[0]


def test_refine_plane():
    start = np.array([0.0, -0.05, 0.48])
    targets = [(scene.PYRAMID, scene.T_T_H)]
    fit = tp.refine_plane(scene.PATCH, start, targets, scene.CAMERA)
    assert fit.ok and np.abs(fit.theta - scene.THETA).max() < PLANE
    assert np.linalg.eigvalsh(fit.covariance).min() > 0


def test_options_change_the_result():
    options = tp.PoseOptions(coarsest_level=0, solve=tp.SolveOptions(max_iterations=1))
    fit = tp.align_pose(scene.PATCH, scene.THETA, scene.GUESS, scene.PYRAMID, scene.CAMERA, options)
    assert fit.iterations == 1 and fit.status == tp.Status.iteration_limit
    assert "coarsest_level=0" in repr(options)


def test_a_step_by_the_normal_equations_is_that_of_the_residuals():
    arguments = scene.PATCH, scene.THETA, scene.GUESS, scene.PYRAMID, scene.CAMERA
    options = tp.PhotometricOptions(robust=tp.Robust(kind=tp.RobustKind.l2), precise=True)
    sums = tp.linearise_pose_plane(*arguments, options=options)
    out = tp.residuals(*arguments, options=options)
    assert sums.visible == out.visible == out.mask.sum()
    assert np.allclose(out.J.T @ out.J, sums.H, rtol=1e-9, atol=1e-9 * np.abs(sums.H).max())
    assert np.allclose(out.J.T @ out.r, sums.b, rtol=1e-9, atol=1e-9 * np.abs(sums.b).max())
    assert tp.evaluate(*arguments, options=options).cost == pytest.approx(sums.cost, rel=1e-12)


def test_planes():
    theta = tp.plane_from_normal([0, 0, -1], 2.0)
    assert theta == pytest.approx([0, 0, 0.5])
    assert tp.plane_distance(theta) == 2.0 and tp.plane_normal(theta) == pytest.approx([0, 0, -1])
    assert tp.from_negated([0, 0, -0.5]) == pytest.approx(theta)
    assert tp.plane_point(theta, [0.1, 0, 1]) == pytest.approx([0.2, 0, 2])
    points = np.array([[0.0, 0, 2], [1, 0, 2], [0, 1, 2], [1, 1, 2]])
    assert tp.plane_from_points(points).value == pytest.approx(theta)
    rays = np.ascontiguousarray(points / points[:, 2:])
    assert tp.plane_from_inverse_depths(rays, np.full(4, 0.5)).value == pytest.approx(theta)
    world = tp.triangulate([tp.SE3(), tp.SE3(t=[-1, 0, 0])], np.array([[0.0, 0, 1], [-0.5, 0, 1]]))
    assert world.value == pytest.approx([0, 0, 2])


def test_poses():
    T = scene.T_T_H
    assert tp.SE3.exp(T.log()).matrix() == pytest.approx(T.matrix(), abs=1e-12)
    assert (T @ T.inverse()).matrix() == pytest.approx(np.eye(4), abs=1e-12)
    assert tp.SE3(T.matrix()).t == pytest.approx(T.t)
    assert T @ [1, 2, 3] == pytest.approx(T.R @ [1, 2, 3] + T.t)
    assert pickle.loads(pickle.dumps(T)).matrix().tobytes() == T.matrix().tobytes()


def test_cameras():
    fisheye = tp.Camera("kannala_brandt", [190, 190, 254, 256, 0.003, 0.001, -0.002, 0.0002])
    pixels = np.array([[254.0, 256], [300, 200]])
    rays = fisheye.unproject(pixels)
    assert fisheye.project(rays) == pytest.approx(pixels, abs=1e-6)
    assert np.isnan(scene.CAMERA.project([0, 0, -1])).all()
    assert fisheye.model == "kannala_brandt" and fisheye.pinhole().model == "pinhole"
    assert scene.CAMERA.at_level(1).parameters == pytest.approx([250, 250, 159.5, 119.5])


def test_threads_run_side_by_side():
    results = [None] * 4

    def work(i):
        for _ in range(20):
            results[i] = tp.align_pose(scene.PATCH, scene.THETA, scene.GUESS, scene.PYRAMID, scene.CAMERA)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len({result.T_t_h.matrix().tobytes() for result in results}) == 1
