"""The system through Python: on a rendered room it does what the program does."""
import pathlib
import sqlite3

import numpy as np
import pytest

import textplane as tp

pytest.importorskip("textplane._slam")
from textplane import slam, stage  # noqa: E402

FRAMES = 60
SIZE = 320, 240


@pytest.fixture(scope="module")
def room(tmp_path_factory):
    folder = str(tmp_path_factory.mktemp("room"))
    stage.render(folder, frames=FRAMES, width=SIZE[0], height=SIZE[1])
    return folder


@pytest.fixture(scope="module")
def ran(room, tmp_path_factory):
    return slam.run(room, str(tmp_path_factory.mktemp("out")))


def frames(room):
    """Time, image, and detections as Python has them."""
    for line in (pathlib.Path(room) / "images.txt").read_text().splitlines():
        if line.startswith("#"):
            continue
        timestamp, path = line.split()
        rows = [row.split(",", 8) for row in
                (pathlib.Path(room) / "detections" / (pathlib.Path(path).stem + ".txt")).read_text().splitlines()]
        quads = [np.array([float(x) for x in row[:8]]).reshape(4, 2) for row in rows]
        yield float(timestamp), slam.load_image(str(pathlib.Path(room) / path)), (quads, None, [row[8] for row in rows])


def camera(room):
    values = dict(line.split(": ") for line in (pathlib.Path(room) / "camera.yaml").read_text().splitlines()
                  if line.startswith("Camera.") and ": " in line)
    numbers = [float(values[f"Camera.{key}"]) for key in ("fx", "fy", "cx", "cy")]
    lens = [float(values.get(f"Camera.{key}", 0)) for key in ("k1", "k2", "p1", "p2", "k3")]
    return tp.Camera("radial_tangential", numbers + lens) if any(lens) else tp.Pinhole(*numbers)


def tum(path):
    return np.loadtxt(path, ndmin=2)


def test_run_maps_the_room(ran):
    assert not ran.error and ran.frames == FRAMES and ran.tracked > 0.9 * FRAMES
    assert ran.texts >= 2 and ran.ate is not None and ran.ate < 0.02
    assert pathlib.Path(ran.report).exists() and "<iframe" in ran._repr_html_()


def test_system_computes_what_the_program_does(room, ran, tmp_path):
    system = slam.System(camera(room), *SIZE)
    for timestamp, image, detections in frames(room):
        result = system.process(image, timestamp, detections)
    assert result.state == slam.FrameState.tracked and result.T_w_c is not None and result.index == FRAMES - 1
    assert "<pre>" in system._repr_html_() and not system.finished
    out = str(tmp_path / "out")
    system.save(out)
    for name in "trajectory.txt", "trajectory_live.txt", "keyframes.txt", "text_map.json", "text_map.ply":
        assert (pathlib.Path(out) / name).read_bytes() == (pathlib.Path(ran.output) / name).read_bytes(), name
    times, poses = system.trajectory
    expected = tum(pathlib.Path(out) / "trajectory.txt")
    assert np.allclose(times, expected[:, 0]) and np.allclose(poses[:, :3, 3], expected[:, 1:4], atol=1e-11)
    assert len(system.texts) == ran.texts and system.points.shape == (ran.points, 3)
    text = system.texts[0]
    assert text.corners.shape == (4, 3) and abs(np.linalg.norm(text.normal) - 1) < 1e-12 and text.word
    assert "<iframe" in system._repr_html_()
    with pytest.raises(ValueError, match="the run has ended"):
        system.process(image, timestamp + 1)


@pytest.fixture(scope="module")
def mapped(room, tmp_path_factory):
    """A map's file, and the texts in it."""
    path = str(tmp_path_factory.mktemp("map") / "room.db")
    system = slam.System(camera(room), *SIZE)
    for shown in frames(room):
        system.process(shown[1], shown[0], shown[2])
    assert not system.in_map and system.save_map(path) == "" and system.finished
    return path, {text.id: text for text in system.texts}


def test_frames_are_found_in_a_saved_map(room, mapped, tmp_path):
    path, texts = mapped
    before = pathlib.Path(path).read_bytes()
    system = slam.System(map=path, localise=True)
    results = [system.process(image, timestamp, seen) for timestamp, image, seen in frames(room)]
    assert system.in_map and {text.id for text in system.texts} == set(texts)
    first = next(r for r in results if r.state == slam.FrameState.tracked)
    assert first.found_by == "texts" and results[-1].found_by == "tracking" and 0 < first.position_sigma < 0.02
    _, poses = system.trajectory
    system.save(str(tmp_path / "out"))
    lines = (tmp_path / "out" / "localisation.csv").read_text().splitlines()
    assert len(lines) == FRAMES + 1 and all(r.state == slam.FrameState.tracked for r in results[5:])
    assert len(poses) >= FRAMES - 5 and pathlib.Path(path).read_bytes() == before
    with pytest.raises(ValueError, match="only localises"):
        system.save_map(path)


def test_a_session_goes_on_in_a_saved_map(room, mapped, tmp_path):
    path, texts = mapped
    grown = tmp_path / "grown.db"
    grown.write_bytes(pathlib.Path(path).read_bytes())
    system = slam.System(camera(room), *SIZE, map=str(grown))
    for timestamp, image, seen in frames(room):
        system.process(image, timestamp, seen)
    assert system.in_map and system.save_map() == ""
    for text in system.texts:
        if text.id in texts:
            assert np.abs(text.corners - texts[text.id].corners).max() < 0.02
    database = sqlite3.connect(grown)
    assert database.execute("select revision from map").fetchone() == (2,)
    assert database.execute("select count(*) from sessions").fetchone() == (2,)
    with pytest.raises(RuntimeError, match="its camera is not that"):
        slam.System(tp.Pinhole(100, 100, 160, 120), *SIZE, map=str(grown))
    with pytest.raises(RuntimeError, match="no map of textslam"):
        slam.System(map=str(pathlib.Path(room) / "camera.yaml"))


def test_what_has_no_map_saves_none(room, tmp_path):
    with pytest.raises(ValueError, match="camera: expected one"):
        slam.System()
    with pytest.raises(ValueError, match="localise: expected a map"):
        slam.System(camera(room), *SIZE, localise=True)
    system = slam.System(camera(room), *SIZE)
    with pytest.raises(ValueError, match="expected a path"):
        system.save_map()
    with pytest.raises(ValueError, match="no map of two key frames"):
        system.save_map(str(tmp_path / "none.db"))
    assert not (tmp_path / "none.db").exists()


def test_a_detector_is_a_callable(room, tmp_path):
    seen = [detections for _, _, detections in frames(room)]
    calls = iter(seen)
    ran = slam.run(room, str(tmp_path / "out"), detector=lambda image: next(calls), report=False)
    assert not ran.error and ran.texts >= 2 and next(calls, None) is None


def test_a_detector_that_raises_ends_the_run_and_loses_nothing(room, tmp_path):
    def broken(image):
        assert image.dtype == np.uint8 and image.shape == (SIZE[1], SIZE[0])
        broken.calls += 1
        if broken.calls > 40:
            raise KeyError("out of ideas")
        return []

    broken.calls = 0
    ran = slam.run(room, str(tmp_path / "out"), detector=broken)
    assert "the detector raised" in ran.error and "out of ideas" in ran.error
    assert len(tum(tmp_path / "out" / "trajectory.txt")) > 20
    wrong = slam.run(room, str(tmp_path / "other"), detector=lambda image: [[1, 2, 3]])
    assert "quads: expected numbers of shape (4, 2)" in wrong.error


def test_bad_input_is_refused(room, tmp_path):
    with pytest.raises(RuntimeError, match="nowhere"):
        slam.run(str(tmp_path / "nowhere"), str(tmp_path / "out"))
    with pytest.raises(ValueError, match='mode: expected "text"'):
        slam.run(room, str(tmp_path / "out"), mode="fast")
    system = slam.System(camera(room), *SIZE, parameters={"corner_cell": 20})
    with pytest.raises(ValueError, match='there is no "speed"'):
        slam.System(camera(room), *SIZE, parameters={"speed": 2})
    with pytest.raises(TypeError, match='"corner_cell"'):
        slam.System(camera(room), *SIZE, parameters={"corner_cell": "many"})
    image = np.zeros((SIZE[1], SIZE[0]), np.uint8)
    with pytest.raises(ValueError, match="expected 320 x 240"):
        system.process(image[:100], 0.0)
    assert system.process(image, 1.0).state == slam.FrameState.waiting
    with pytest.raises(ValueError, match="timestamp"):
        system.process(image, 1.0)
    with pytest.raises(ValueError, match="one length"):
        system.process(image, 2.0, ([np.zeros((4, 2))], [1.0, 2.0], None))
