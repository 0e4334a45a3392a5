"""Corners, tracks, windows and text maps through Python."""
import numpy as np
import pytest
import scene

import textplane as tp


def truth_of(points):
    """Where pixels of the host on the plane are in the target."""
    H = tp.pixel_homography(tp.plane_homography(scene.THETA, scene.T_T_H), scene.CAMERA, scene.CAMERA)
    return tp.warp_points(H, np.ascontiguousarray(points, np.float64))


def test_fast_finds_dots():
    image = np.full((80, 100), 30, np.uint8)
    dots = [(30, 20), (69, 20), (50, 57)]
    for x, y in dots:
        image[y, x] = 200
    corners = tp.detect_fast(image, 40)
    assert corners.dtype == np.float32 and [(x, y) for x, y, _ in corners] == dots
    assert (corners[:, 2] == 169).all()
    assert len(tp.detect_fast(image, 170)) == 0
    assert (tp.detect_fast(image, 40, suppress=False)[:, 2] == 0).all()


def test_klt_follows_the_plane():
    pixels, status = tp.select_pixels(scene.HOST, scene.QUAD)
    assert status == tp.Status.ok and pixels.shape[1] == 2
    tracks = tp.track_klt(tp.Pyramid(scene.HOST), scene.PYRAMID, pixels, truth_of(pixels).astype(np.float32) + 1.5)
    errors = np.linalg.norm(tracks.px - truth_of(pixels), axis=1)
    assert tracks.ok.sum() > 100 and np.median(errors[tracks.ok]) < 0.15
    assert tp.Status(int(tracks.status[tracks.ok][0])) in (tp.Status.converged, tp.Status.iteration_limit)
    with pytest.raises(ValueError, match="points and guess: expected one length"):
        tp.track_klt(scene.HOST, scene.PYRAMID, pixels, pixels[:1])


def test_solve_window_finds_pose_points_and_plane():
    window = tp.Window(scene.CAMERA)
    host = window.add_frame(tp.SE3(), fixed=True, image=tp.Pyramid(scene.HOST))
    target = window.add_frame(scene.GUESS.inverse(), image=scene.PYRAMID)
    text = window.add_text(host, scene.PATCH, scene.THETA, fixed=True)
    window.see_text(target, text)
    corners = tp.quad_points(scene.QUAD, scene.CAMERA, scene.THETA)
    for corner in corners:
        point = window.add_point(corner, fixed=True)
        window.see_point(target, point, scene.CAMERA.project(scene.T_T_H @ corner))
    summary = tp.solve_window(window)
    assert summary.ok and summary.final_cost < summary.initial_cost and summary.free_frames == 1
    seen = tp.project_quad(scene.QUAD, scene.CAMERA, scene.THETA, window.pose(target).inverse(), scene.CAMERA)
    assert np.linalg.norm(seen - truth_of(scene.QUAD), axis=1).max() < 0.2  # px, as in solvers_test.py
    assert window.status_of_text(text) == tp.Status.ok and window.zncc(text) > 0.99
    assert window.point(0) == pytest.approx(corners[0]) and window.chi2.shape == (4,) and window.chi2.max() < 1
    assert window.pose(host).matrix().tobytes() == np.eye(4).tobytes()
    with pytest.raises(IndexError, match="frame: the window has no number 2"):
        window.pose(2)


def test_a_window_without_a_gauge_says_so():
    window = tp.Window(scene.CAMERA)
    for pose in tp.SE3(), scene.GUESS.inverse():
        window.add_frame(pose, image=scene.PYRAMID)
    text = window.add_text(0, scene.PATCH, scene.THETA)
    window.see_text(1, text)
    summary = tp.solve_window(window)
    assert summary.status == tp.Status.rank_deficient and summary.gauge_freedom == 7
    with pytest.raises(tp.Failure):
        tp.solve_window(window, raise_on_failure=True)


def views(n):
    """Images of the plane, their poses T_c_w, the quad in each, and points in view."""
    for i in range(n):
        T = tp.SE3.exp(np.array([0.12, -0.04, 0.03, 0.005, -0.02, 0.01]) * i)
        H = tp.pixel_homography(tp.plane_homography_inverse(scene.THETA, T), scene.CAMERA, scene.CAMERA)
        image = tp.warp_patch(scene.HOST, H, (480, 640))[0]
        yield image, T, tp.project_quad(scene.QUAD, scene.CAMERA, scene.THETA, T, scene.CAMERA)


def test_a_text_map_maps_a_text_and_tracks_by_it():
    texts = tp.TextMap(scene.CAMERA)
    rays = scene.CAMERA.unproject(np.stack(np.meshgrid(np.arange(210, 410, 20.0), np.arange(165, 320, 20.0)), -1)
                                  .reshape(-1, 2))
    points = np.array([tp.plane_point(scene.THETA, ray) for ray in rays])
    for i, (image, T, quad) in enumerate(views(8)):
        pixels = scene.CAMERA.project(T @ points)
        status = texts.add_keyframe(i, image, T, [quad], ["EXIT"], pixels, points, list(range(len(points))))
        assert status == tp.Status.ok
    mapped = [text for text in texts.objects() if text.state == tp.TextState.mapped]
    assert len(mapped) == 1 and mapped[0].word == "EXIT" and len(mapped[0].views) >= 4
    truth = tp.quad_points(scene.QUAD, scene.CAMERA, scene.THETA)
    assert np.linalg.norm(texts.corners(mapped[0].id) - truth, axis=1).max() < 0.05
    fit = texts.track(scene.TARGET, scene.GUESS)
    assert fit.ok and fit.refined and fit.texts == 1
    seen = tp.project_quad(scene.QUAD, scene.CAMERA, scene.THETA, fit.T_c_w, scene.CAMERA)
    assert np.linalg.norm(seen - truth_of(scene.QUAD), axis=1).max() < 0.3  # px; the guess is 4 px off
    page = texts._repr_html_()
    assert "<table>" in page and "EXIT" in page and "mapped" in page
    texts.move({0: tp.SE3.exp([0.1, 0, 0, 0, 0, 0])})
    texts.remove_keyframe(7)
    assert texts.add_keyframe(0, scene.HOST, tp.SE3()) == tp.Status.invalid_argument
    assert texts.corners(99) is None
