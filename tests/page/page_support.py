"""What the tests of the page share: files given, a run to its end, and what is asked of it."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import browser as driver  # noqa: E402
from browser import Browser, check, chromium, skip  # noqa: E402, F401

driver.WAIT = 900  # s: a run on a machine that is busy otherwise

READY = "window.page !== undefined"
# mm: three seeds of the room give 0.26 to 0.50 natively with the detector at every frame; a video's coding adds to that.
MOST_ATE = {"folder": 0.6, "network": 0.6, "video": 1.0}
FRAMES = 240


def give(browser, input_id, paths):
    """Chooses files, or a folder, as the dialog would."""
    found = browser.call("Runtime.evaluate", expression=f"document.getElementById('{input_id}')")
    browser.call("DOM.setFileInputFiles", files=[str(p) for p in paths], objectId=found["result"]["objectId"])


def finish(browser, what):
    browser.until("!!page.results.message || !document.getElementById('notice').hidden", f"{what} does not end")
    notice = browser.run("document.getElementById('notice').hidden ? '' : document.getElementById('notice').textContent")
    message = browser.run("""(() => { const { metrics, frames, ms, readings, dropped, table } = page.results.message || {};
      return { metrics, frames, ms, readings, dropped, table, missed: page.run.webcam ? page.run.webcam.missed : 0 }; })()""")
    check(message.get("frames"), f"{what}: {notice}")
    return message, notice


def told(what, message):
    metrics = message["metrics"]
    ate = 1000 * metrics["trajectory"]["ate_rmse"] if "trajectory" in metrics else None
    line = f"{what}: {metrics['tracked']} of {metrics['frames']} frames at {1000 * message['frames'] / message['ms']:.1f} a second"
    print(f"{line}, {metrics['texts']} texts" + (f", ATE {ate:.2f} mm" if ate is not None else ""), flush=True)
    return ate


def judge(what, message):
    ate = told(what, message)
    metrics = message["metrics"]
    check(message["frames"] == metrics["frames"] == FRAMES, f"{what}: {message['frames']} of {FRAMES} frames came")
    check(metrics["tracked"] == FRAMES, f"{what}: {metrics['tracked']} of {FRAMES} frames were tracked")
    check(ate is not None and ate < MOST_ATE[what], f"{what}: ATE {ate} mm")
    check(metrics["text"]["signs_mapped"] >= 0.7 * metrics["text"]["signs_visible"], f"{what}: {metrics['text']}")
    return ate


def shoot(args, browser, name):
    if args.screenshots:
        args.screenshots.mkdir(parents=True, exist_ok=True)
        browser.screenshot(args.screenshots / f"{name}.png", 3000)
