#!/usr/bin/env python3
"""Opens reports of textslam in headless Chromium and uses them: mouse, keyboard, slider, search, themes, a phone's width.

usage: report_browser_test.py FOLDER [--screenshots DIR]

FOLDER holds map.html, a report of a run with a map, no-map.html, one of a run without (textslam_report_test writes them), and
sessions.html, one of a map file with two sessions (textslam_sessions_test).
Exit code 77 where there is no Chromium. Talks to it through a pipe, so it needs nothing but Python 3.
"""
import argparse
import json
import pathlib
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, str(next(p for p in pathlib.Path(__file__).parents if p.name == "tests") / "support"))
from browser import Browser, check, chromium  # noqa: E402
from report_page import READY, click, clip, colours, drag, middle, search_for, switch  # noqa: E402
from report_viewer import test_viewer  # noqa: E402


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
    check(frame() == browser.run("report.data.frames[report.data.frames.length - 1].frame"), "it does not start with the whole map")
    browser.until(f"{picture}.length > 5000", "the frame is not drawn")
    browser.run("report.playback.select(0)")
    browser.until("document.getElementById('picture').width > 300", "the frame is not drawn")
    check(colours(browser, "picture") > 30, "the frame is blank")
    # Under each picture stand the texts that it shows, and one is no plural.
    for at in range(browser.run("report.data.frames.length")):
        browser.run(f"report.playback.select({at})")
        shown = browser.run(f"report.data.frames[{at}].texts.length")
        caption = browser.run("document.getElementById('frame-text').textContent")
        if "before the map" not in caption or shown:
            check(f", {shown} text{'' if shown == 1 else 's'}" in caption.split(";")[0] + ";", f"{shown} texts are drawn: {caption}")
        check(", 1 texts" not in caption and ", 1 points" not in caption, caption)
    browser.run("report.playback.select(0)")
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
    switch(browser, "fly")
    browser.run("report.playback.select(0)")
    first = clip(browser)
    browser.run(f"report.playback.select_frame({last})")
    check(clip(browser) != first, "the camera stays where it is")
    switch(browser, "fly")


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
    check(len(shown) < everything and shown[0] == word, f"search for {word} shows {shown}")
    search_for(browser, "no such word, however it is read")
    check(browser.run(rows) == 0, "search for nothing finds something")
    search_for(browser, "")
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


def test_sessions(browser):
    """Of a map file: each session has its row, its colour and its layer, and goes when that is switched off."""
    rows = browser.run("document.querySelectorAll('#sessions tr').length")
    check(rows == 3, f"{rows} rows for two sessions and their head")
    swatch = "[...document.querySelectorAll('#sessions i')].map((i) => getComputedStyle(i).backgroundColor)"
    check(len(set(browser.run(swatch))) == 2, "the sessions have no colours of their own")
    last = browser.run("report.data.frames.length - 1")
    caption = "document.getElementById('frame-text').textContent"
    for at, session in ((0, 1), (last, 2)):
        browser.run(f"report.playback.select({at})")
        check(f"session {session}" in browser.run(caption), f"key frame {at}: {browser.run(caption)}")
    layers = "report.view.layers.sessions.map((layer) => layer.count)"
    check(min(browser.run(layers)) > 0, "a session is not drawn")
    browser.run("report.playback.select(0)")
    check(browser.run(layers)[1] == 0, "a session is drawn before it began")
    browser.run(f"report.playback.select({last})")
    for at, session in enumerate((1, 2)):
        for shown in (False, True):
            switch(browser, f"session {session}")
            check(browser.run(f"report.view.layers.sessions[{at}].visible") is shown, f"session {session} cannot be switched off and on")
    check(browser.run("document.querySelectorAll('#plots path').length") >= 4, "plots are missing")
    check(browser.run("document.getElementById('count').textContent").endswith("texts"), "no texts")


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
    program = chromium()
    with Browser(program) as browser:
        page = arguments.folder / "map.html"
        browser.open(page, ready=READY)
        for test in (test_view, test_playback, test_table, test_page, test_viewer):
            test(browser)
            print(f"ok: {test.__name__}")
        for width in (1440, 390):
            for dark in (False, True):
                browser.open(page, width, 1000 if width > 600 else 844, dark, READY)
                test_width(browser, width)
                if arguments.screenshots:
                    arguments.screenshots.mkdir(parents=True, exist_ok=True)
                    browser.screenshot(arguments.screenshots / f"{width}-{'dark' if dark else 'light'}.png")
        print("ok: widths and themes")
        browser.open(arguments.folder / "no-map.html", ready=READY)
        check(browser.run("!document.getElementById('notice').hidden && document.getElementById('notice').textContent.includes('no map')"),
              "a run without a map does not say so")
        print("ok: no map")
        for width, dark in ((1440, False), (390, True)):
            browser.open(arguments.folder / "sessions.html", width, 1000 if width > 600 else 844, dark, READY)
            test_width(browser, width)
            if arguments.screenshots:
                browser.screenshot(arguments.screenshots / f"sessions-{width}.png")
        test_sessions(browser)
        print("ok: sessions")
        check(not browser.troubles, f"the browser complains: {browser.troubles}")
    with Browser(program, ["--disable-3d-apis"]) as browser:
        browser.open(page, ready=READY)
        check(browser.run("!document.getElementById('no-webgl').hidden"), "without WebGL the page does not say so")
        browser.key("Home")
        browser.key("ArrowRight")
        check(browser.run("report.view.frame") == 1, "without WebGL the playback does not work")
        check(browser.run("document.querySelectorAll('#texts tbody tr').length") > 2, "without WebGL there is no table")
        click(browser, "#texts tbody tr")
        check(not browser.troubles, f"the browser complains: {browser.troubles}")
        print("ok: without WebGL")


if __name__ == "__main__":
    main()
