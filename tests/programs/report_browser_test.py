#!/usr/bin/env python3
"""Opens reports of textslam in headless Chromium and uses them: mouse, keyboard, slider, search, themes, a phone's width.

usage: report_browser_test.py FOLDER [--screenshots DIR]

FOLDER holds map.html, a report of a run with a map, and no-map.html, one of a run without (textslam_report_test writes them).
Exit code 77 where there is no Chromium. Talks to it through a pipe, so it needs nothing but Python 3.
"""
import argparse
import base64
import json
import os
import pathlib
import select
import shutil
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
FLAGS = ["--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic",
         "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--disable-dev-shm-usage", "--remote-debugging-pipe"]
WAIT = 120  # s, for something that will come; only how long a failure takes depends on it
SCHEME = "file:", "data:", "about:", "chrome:", "devtools:"


def fail(message):
    print(f"FAILED: {message}")
    sys.exit(1)


def check(condition, message):
    if not condition:
        fail(message)


class Browser:
    """Chromium with one page, by the DevTools protocol: JSON messages that end in a zero byte."""

    def __init__(self, program, flags=()):
        self.profile = tempfile.mkdtemp()
        to_browser, from_browser = os.pipe(), os.pipe()

        def connect():  # Chromium reads from 3 and writes to 4
            read, write = os.dup(to_browser[0]), os.dup(from_browser[1])  # 3 and 4 may be the other's
            os.dup2(read, 3)
            os.dup2(write, 4)

        self.process = subprocess.Popen([program, *FLAGS, *flags, f"--user-data-dir={self.profile}", "about:blank"], preexec_fn=connect,
                                        pass_fds=(3, 4), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser[0])
        os.close(from_browser[1])
        self.write, self.read = to_browser[1], from_browser[0]
        self.buffer, self.number, self.session, self.troubles = b"", 0, None, []
        target = next(t for t in self.call("Target.getTargets")["targetInfos"] if t["type"] == "page")
        self.session = self.call("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.write, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.receive()
            if answer.get("id") == self.number:
                check("error" not in answer, f"{method}: {answer.get('error')}")
                return answer["result"]
            self.note(answer)

    def receive(self):
        while b"\0" not in self.buffer:
            check(select.select([self.read], [], [], WAIT)[0], "Chromium does not answer")
            part = os.read(self.read, 1 << 20)
            check(part, "Chromium ended")
            self.buffer += part
        message, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(message)

    def note(self, event):
        """Errors of the page, and requests that leave it."""
        method, p = event.get("method"), event.get("params", {})
        if method == "Runtime.exceptionThrown":
            details = p["exceptionDetails"]
            self.troubles.append(details.get("exception", {}).get("description", details["text"]))
        elif method == "Runtime.consoleAPICalled" and p["type"] in ("error", "warning", "assert"):
            self.troubles.append(" ".join(str(a.get("value", a.get("description"))) for a in p["args"]))
        elif method == "Log.entryAdded" and p["entry"]["level"] == "error":
            self.troubles.append(p["entry"]["text"])
        elif method == "Network.requestWillBeSent" and not p["request"]["url"].startswith(SCHEME):
            self.troubles.append("request to " + p["request"]["url"])

    def run(self, script):
        result = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        check("exceptionDetails" not in result, f"{script}: {result.get('exceptionDetails')}")
        return result["result"].get("value")

    def until(self, script, what):
        end = time.monotonic() + WAIT
        while not self.run(script):
            check(time.monotonic() < end, f"{what}; troubles: {self.troubles}")
            time.sleep(0.02)

    def open(self, path, width=1440, height=1000, dark=False):
        phone = width < 600
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=2 if phone else 1, mobile=phone)
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.call("Page.navigate", url=pathlib.Path(path).resolve().as_uri())
        self.until("document.readyState === 'complete' && window.report !== undefined", f"{path} does not start")
        # Pictures of the texts and of the frame are there, and drawn.
        self.run("Promise.all([...document.images].map((i) => i.decode()))")
        self.run("new Promise((done) => setTimeout(() => requestAnimationFrame(() => requestAnimationFrame(done)), 200)).then(() => true)")

    def key(self, key, code=None, modifiers=0):
        text = {"text": key} if len(key) == 1 else {}
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, code=code or key, modifiers=modifiers, **text)

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def screenshot(self, path):
        size = self.run("({w: document.documentElement.clientWidth, h: document.documentElement.scrollHeight})")
        shot = self.call("Page.captureScreenshot", captureBeyondViewport=True,
                         clip={"x": 0, "y": 0, "width": size["w"], "height": size["h"], "scale": 1})
        pathlib.Path(path).write_bytes(base64.b64decode(shot["data"]))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        shutil.rmtree(self.profile, ignore_errors=True)


def colours(browser, canvas):
    """How many different colours the canvas shows."""
    return browser.run(f"""(() => {{
      const from = document.getElementById('{canvas}'), to = document.createElement('canvas');
      if ('{canvas}' === 'canvas') report.view.draw();
      to.width = from.width; to.height = from.height;
      const pen = to.getContext('2d');
      pen.drawImage(from, 0, 0);
      return new Set(new Uint32Array(pen.getImageData(0, 0, to.width, to.height).data.buffer)).size;
    }})()""")


def clip(browser):
    """The matrix of the view, once what was asked for is drawn."""
    browser.run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))).then(() => true)")
    return browser.run("[...report.view.clip]")


def middle(browser, selector):
    return browser.run(f"""(() => {{ const e = document.querySelector('{selector}'); e.scrollIntoView({{block: 'center'}});
      const b = e.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; }})()""")


def drag(browser, selector, dx, dy, modifiers=0):
    x, y = middle(browser, selector)
    browser.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1, modifiers=modifiers)
    browser.mouse("mouseMoved", x + dx, y + dy, button="left", buttons=1, modifiers=modifiers)
    browser.mouse("mouseReleased", x + dx, y + dy, button="left", buttons=0, clickCount=1, modifiers=modifiers)


def click(browser, selector):
    drag(browser, selector, 0, 0)


def test_view(browser):
    check(colours(browser, "canvas") > 100, "the 3D view is blank")
    check(browser.run("document.querySelectorAll('#labels span').length") > 0, "no words in the 3D view")
    for what, act in [("drag", lambda: drag(browser, "#view", 90, 30)), ("shift drag", lambda: drag(browser, "#view", 60, 20, 8)),
                      ("wheel", lambda: browser.mouse("mouseWheel", *middle(browser, "#view"), deltaX=0, deltaY=300)),
                      ("left", lambda: browser.key("ArrowLeft")), ("shift up", lambda: browser.key("ArrowUp", modifiers=8)),
                      ("plus", lambda: browser.key("+")), ("R", lambda: browser.key("r"))]:
        browser.run("document.getElementById('view').focus()")
        before = clip(browser)
        act()
        browser.until(f"JSON.stringify([...report.view.clip]) !== '{json.dumps(before, separators=(',', ':'))}'", f"{what} does not move the view")
    before = clip(browser)
    x, y = middle(browser, "#view")
    fingers = lambda d: [{"x": x - d, "y": y, "id": 1}, {"x": x + d, "y": y, "id": 2}]
    browser.call("Input.dispatchTouchEvent", type="touchStart", touchPoints=fingers(40))
    browser.call("Input.dispatchTouchEvent", type="touchMove", touchPoints=fingers(80))
    browser.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
    check(clip(browser) != before, "two fingers do not zoom")


def test_playback(browser):
    frame = lambda: browser.run("report.view.frame")
    picture = "document.getElementById('picture').toDataURL()"
    browser.run("document.activeElement.blur()")
    check(frame() == 0, "it starts at the first frame")
    browser.until("document.getElementById('picture').width > 300", "the frame is not drawn")
    check(colours(browser, "picture") > 30, "the frame is blank")
    before, text = browser.run(picture), browser.run("document.getElementById('frame-text').textContent")
    browser.key("ArrowRight")
    check(frame() == 1, "the right arrow does not go to the next frame")
    browser.run("""(() => { const s = document.getElementById('slider'); s.value = s.max; s.dispatchEvent(new Event('input')); })()""")
    last = browser.run("report.data.frames[report.data.frames.length - 1].frame")
    check(frame() == last, "the slider does not choose the frame")
    browser.until(f"{picture} !== {json.dumps(before)}", "the picture stays the same")
    check(browser.run("document.getElementById('frame-text').textContent") != text, "the text below the frame stays the same")
    browser.key("Home")
    check(frame() == 0, "Home does not go to the first frame")
    click(browser, "#play")
    browser.until("report.view.frame > 1", "it does not play")
    click(browser, "#play")
    # The camera moves in 3D: looking through it, another frame is another view.
    browser.run("[...document.querySelectorAll('#layers label')].find((l) => l.textContent.includes('fly')).click()")
    browser.run("report.playback.select(0)")
    first = clip(browser)
    browser.run(f"report.playback.select_frame({last})")
    check(clip(browser) != first, "the camera stays where it is")
    browser.run("[...document.querySelectorAll('#layers label')].find((l) => l.textContent.includes('fly')).click()")


def test_table(browser):
    rows = "document.querySelectorAll('#texts tbody tr').length"
    words = "[...document.querySelectorAll('#texts tbody tr td:first-child')].map((c) => c.textContent)"
    everything = browser.run("report.data.texts.length")
    check(everything > 2 and browser.run(rows) == everything, "not every text has its row")
    hostile = browser.run("report.data.texts.find((t) => t.word.includes('</script>')).word")
    check(hostile in browser.run(words), "markup in a word is not shown as it is")
    word = next(w for w in browser.run(words) if w != hostile)
    click(browser, "#search")
    browser.call("Input.insertText", text=word.lower())
    shown = browser.run(words)
    check(0 < len(shown) < everything and all(word.lower() in w.lower() for w in shown), f"search for {word} shows {shown}")
    browser.run("(() => { const s = document.getElementById('search'); s.value = 'no such word'; s.dispatchEvent(new Event('input')); })()")
    check(browser.run(rows) == 0, "search for nothing finds something")
    browser.run("(() => { const s = document.getElementById('search'); s.value = ''; s.dispatchEvent(new Event('input')); })()")
    check(browser.run(rows) == everything, "an empty search does not show all")
    zncc = "[...document.querySelectorAll('#texts tbody tr')].map((r) => Number(r.children[5].textContent))"
    for descending in (False, True):
        browser.run("document.querySelectorAll('#texts th button')[5].click()")
        values = browser.run(zncc)
        check(values == sorted(values, reverse=descending), f"not sorted: {values}")
    click(browser, "#texts tbody tr")
    check(browser.run("""(() => { const id = Number(document.querySelector('#texts tr.chosen').dataset.text), v = report.view;
      return v.chosen === id && JSON.stringify(v.target) === JSON.stringify(report.data.texts.find((t) => t.id === id).centre); })()"""),
          "a click on a row does not centre its text")
    browser.run("document.querySelectorAll('#texts tbody tr')[1].focus()")
    browser.key("Enter")
    check(browser.run("report.view.chosen === Number(document.querySelectorAll('#texts tbody tr')[1].dataset.text)"), "Enter does not choose the row")


def test_page(browser):
    check(browser.run("window.broken") is None, "a word was run as markup")
    check(browser.run("document.querySelectorAll('#plots path').length") >= 8, "plots are missing")
    check(browser.run("document.querySelectorAll('.bars div').length") > 0, "no angle errors")
    check(browser.run("document.querySelectorAll('#parameters div').length") > 50, "parameters are missing")
    check("textslam" in browser.run("document.getElementById('command').textContent"), "no command")
    back = "getComputedStyle(document.body).backgroundColor"
    system = browser.run(back)
    seen = []
    for _ in range(3):
        browser.run("document.getElementById('theme').click()")
        seen.append(browser.run(back))
    check(seen[0] != seen[1] and seen[2] == system, f"the theme does not change: {system}, {seen}")


def test_width(browser, width):
    check(browser.run("document.documentElement.scrollWidth") <= width, f"wider than {width} px")
    overlaps = browser.run("""(() => { const boxes = [...document.querySelectorAll('header > *, main > section > *, .panel > *, .bar > *, .tiles > *')]
      .filter((e) => e.offsetParent && getComputedStyle(e).position !== 'absolute').map((e) => [e, e.getBoundingClientRect()]), bad = [];
      for (const [a, p] of boxes) for (const [b, q] of boxes) if (a !== b && a.parentNode === b.parentNode &&
        Math.min(p.right, q.right) - Math.max(p.left, q.left) > 1 && Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top) > 1)
        bad.push((a.id || a.className || a.textContent) + ' and ' + (b.id || b.className || b.textContent));
      return bad; })()""")
    check(not overlaps, f"at {width} px these overlap: {overlaps}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--screenshots", type=pathlib.Path)
    arguments = parser.parse_args()
    program = shutil.which("chromium") or shutil.which("chromium-browser")
    if not program:
        print("skipped: there is no chromium; Debian's package of that name has it")
        sys.exit(SKIPPED)
    with Browser(program) as browser:
        page = arguments.folder / "map.html"
        browser.open(page)
        for test in (test_view, test_playback, test_table, test_page):
            test(browser)
            print(f"ok: {test.__name__}")
        for width in (1440, 390):
            for dark in (False, True):
                browser.open(page, width, 1000 if width > 600 else 844, dark)
                test_width(browser, width)
                if arguments.screenshots:
                    arguments.screenshots.mkdir(parents=True, exist_ok=True)
                    browser.screenshot(arguments.screenshots / f"{width}-{'dark' if dark else 'light'}.png")
        print("ok: widths and themes")
        browser.open(arguments.folder / "no-map.html")
        check(browser.run("!document.getElementById('notice').hidden && document.getElementById('notice').textContent.includes('no map')"),
              "a run without a map does not say so")
        print("ok: no map")
        check(not browser.troubles, f"the browser complains: {browser.troubles}")
    with Browser(program, ["--disable-3d-apis"]) as browser:
        browser.open(page)
        check(browser.run("!document.getElementById('no-webgl').hidden"), "without WebGL the page does not say so")
        browser.key("ArrowRight")
        check(browser.run("report.view.frame") == 1, "without WebGL the playback does not work")
        check(browser.run("document.querySelectorAll('#texts tbody tr').length") > 2, "without WebGL there is no table")
        click(browser, "#texts tbody tr")
        check(not browser.troubles, f"the browser complains: {browser.troubles}")
        print("ok: without WebGL")


if __name__ == "__main__":
    main()
