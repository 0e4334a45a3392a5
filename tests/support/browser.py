"""Headless Chromium for tests of pages, by the DevTools protocol through a pipe: nothing but Python 3.9 is needed."""
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
FLAGS = ["--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
         "--disable-sync", "--disable-dev-shm-usage", "--remote-debugging-pipe"]
WAIT = 120  # s, for something that will come; only how long a failure takes depends on it
SCHEME = "file:", "data:", "blob:", "about:", "chrome:", "devtools:"


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def chromium():
    """The program; the test is skipped where there is none."""
    program = shutil.which("chromium") or shutil.which("chromium-browser")
    return program or skip("there is no chromium; Debian's package of that name has it")


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

        self.process = subprocess.Popen(
            [program, *FLAGS, *flags, f"--user-data-dir={self.profile}", "about:blank"], preexec_fn=connect,
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
        self.until_true(lambda: self.run(script), what)

    def until_true(self, condition, what):
        end = time.monotonic() + WAIT
        while not condition():
            check(time.monotonic() < end, f"{what}; troubles: {self.troubles}")
            time.sleep(0.02)

    def show(self, width, height, dark=False):
        phone = width < 600
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=2 if phone else 1, mobile=phone)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call("Emulation.setEmulatedMedia", features=[scheme])

    def open(self, path, width=1440, height=1000, dark=False, ready="true", settle=200):
        """Loads a page and waits until the script `ready` is true and all pictures are drawn; then `settle` ms longer."""
        self.show(width, height, dark)
        self.call("Page.navigate", url=pathlib.Path(path).resolve().as_uri())
        self.until(f"document.readyState === 'complete' && ({ready})", f"{path} does not start")
        self.run("Promise.all([...document.images].map((i) => i.decode()))")
        self.run(f"""new Promise((done) => setTimeout(() => requestAnimationFrame(() => requestAnimationFrame(done)),
                 {settle})).then(() => true)""")

    def key(self, key, code=None, modifiers=0):
        text = {"text": key} if len(key) == 1 else {}
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, code=code or key, modifiers=modifiers, **text)

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def screenshot(self, path, tallest=16000):
        """The page from its top, down to `tallest` px."""
        size = self.run("({w: document.documentElement.clientWidth, h: document.documentElement.scrollHeight})")
        shot = self.call("Page.captureScreenshot", captureBeyondViewport=True,
                         clip={"x": 0, "y": 0, "width": size["w"], "height": min(size["h"], tallest), "scale": 1})
        pathlib.Path(path).write_bytes(base64.b64decode(shot["data"]))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        shutil.rmtree(self.profile, ignore_errors=True)
