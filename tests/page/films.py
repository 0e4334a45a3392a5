"""Films and the camera in the page: what ffmpeg encodes of the rendered room."""
import shutil
import subprocess

from page_support import FRAMES, READY, Browser, check, chromium, finish, give, judge, shoot, told


def encode(sequence, out, *options):
    command = ["ffmpeg", "-loglevel", "error", "-y", "-framerate", "30", "-i", sequence / "images/%06d.png", *options, out]
    subprocess.run([str(c) for c in command], check=True)
    return out


def test_video(args, browser, folder):
    if not shutil.which("ffmpeg"):
        return None
    encode(args.sequence, folder / "room.mp4", "-c:v", "libx264", "-crf", "12", "-pix_fmt", "yuv420p")
    for name in ("camera.yaml", "groundtruth.txt", "truth"):
        (shutil.copytree if name == "truth" else shutil.copy)(args.sequence / name, folder / name)
    browser.open(args.page / "index.html", ready=READY)
    give(browser, "folder", [folder])
    message, _ = finish(browser, "video")
    ate = judge("video", message)
    h264 = "-frames:v", "60", "-c:v", "libx264", "-crf", "12", "-pix_fmt", "yuv420p"
    short = {
        "WebM": encode(args.sequence, folder / "room.webm", "-frames:v", "60", "-c:v", "libvpx", "-b:v", "4M", "-pix_fmt", "yuv420p"),
        "MP4 in fragments": encode(args.sequence, folder / "fragments.mp4", *h264, "-g", "20", "-movflags", "frag_keyframe+empty_moov"),
        "MP4 with default bases": encode(args.sequence, folder / "bases.mp4", *h264, "-g", "20", "-movflags",
                                         "frag_every_frame+empty_moov+default_base_moof+omit_tfhd_offset"),
    }
    cut = folder / "cut.mp4"
    cut.write_bytes(short["MP4 in fragments"].read_bytes()[:-2000])
    short["MP4 in fragments, cut off"] = cut
    for what, film in short.items():
        browser.open(args.page / "index.html", ready=READY)
        give(browser, "files", [film, args.sequence / "camera.yaml"])
        message, _ = finish(browser, what)
        told(what, message)
        check(message["frames"] == 60 or film == cut and 40 <= message["frames"] < 60, f"{what}: {message['frames']} of 60 frames came")
    test_calibration(args, browser, folder / "room.mp4")
    return ate


def test_calibration(args, browser, film):
    """A video and nothing else."""
    browser.open(args.page / "index.html", ready=READY)
    browser.run("document.getElementById('calibrate').click()")
    give(browser, "files", [film])
    message, _ = finish(browser, "a video alone")
    told("a video alone", message)
    found = message["metrics"]["calibration"]
    check(found["determined"] and abs(found["parameters"]["fx"] / 525 - 1) < 0.01, f"the camera is not found: {found}")
    check(message["metrics"]["tracked"] == FRAMES, "a video alone is not tracked")
    check(browser.run("page.results.files.has('camera.yaml')"), "the camera cannot be saved")


def test_camera(args, folder):
    """A camera that shows the room's frames, over and over."""
    if not shutil.which("ffmpeg"):
        return None
    film = encode(args.sequence, folder / "room.mjpeg", "-c:v", "mjpeg", "-q:v", "2", "-pix_fmt", "yuvj420p")
    flags = ["--use-fake-ui-for-media-stream", "--use-fake-device-for-media-stream", f"--use-file-for-fake-video-capture={film}"]
    with Browser(chromium(), flags) as browser:
        for way in ("camera", "camera by way of a video"):
            browser.open(args.page / "index.html", ready=READY)
            if way != "camera":
                browser.run("(() => { self.MediaStreamTrackProcessor = undefined; })()")
            browser.run("(() => { document.getElementById('fov').value = 62.7; document.getElementById('open-camera').click(); })()")
            browser.until("page.live.newest && page.live.newest.seen.frame >= 100", "the camera's frames do not come")
            shoot(args, browser, way.replace(" ", "_"))
            browser.run("document.getElementById('stop').click()")
            message, _ = finish(browser, way)
            told(way, message)
            print(f"{way}: {message['dropped'] + message['missed']} frames left out as the system was busy")
            check(message["frames"] >= 100 and message["metrics"]["tracked"] > 50, "the camera's frames are not tracked")
            check(browser.run("page.results.files.has('report.html')"), "there is no report of the camera")
            check(not browser.troubles, f"troubles: {browser.troubles}")
    return message["metrics"]["tracked"]
