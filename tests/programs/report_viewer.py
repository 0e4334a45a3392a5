"""Part of report_browser_test.py: the map as it was at a frame, guides, search, plots' values, keys, fingers."""
import json

from browser import check
from report_page import READY, click, clip, colours, middle, rest, search_for, switch

LAYERS = "report.view.layers"
COUNTS = f"[{LAYERS}.points, {LAYERS}.keyframes, {LAYERS}.trajectory, {LAYERS}.truth].map((layer) => layer.count)"


def test_time(browser):
    """Scrubbing builds the map up, and the camera's rays go to the texts in view."""
    last = browser.run("report.data.frames.length - 1")
    browser.run(f"report.playback.select({last})")
    whole, texts = browser.run(COUNTS), browser.run("report.view.shown.length")
    check(texts == browser.run("report.data.texts.length"), "the last frame does not show the whole map")
    middle_counts = None
    for at in (0, last // 2):
        browser.run(f"report.playback.select({at})")
        counts = browser.run(COUNTS)
        check(all(a <= b for a, b in zip(counts, whole)) and counts != whole, f"picture {at} shows {counts} of {whole}")
        check(middle_counts is None or all(a <= b for a, b in zip(middle_counts, counts)), "the map does not grow")
        middle_counts = counts
    frame = browser.run("report.view.frame")
    check(browser.run(f"report.view.shown.every((t) => t.host <= {frame} || t.id === report.view.chosen)"), "texts of later are there")
    check(browser.run(f"report.data.world.point_frames.filter((f) => f <= {frame}).length") == counts[0], "points of later are there")
    seen = browser.run("report.view.in_view.length")
    check(seen > 0 and browser.run(f"[{LAYERS}.rays.count, {LAYERS}.lit.count]") == [8 * seen, 8 * seen], f"{seen} texts are not lit")
    switch(browser, "map so far")
    check(browser.run(COUNTS) == whole, "the whole map cannot be had at a frame")
    switch(browser, "map so far")
    check(browser.run(COUNTS) == counts, "the map so far cannot be had again")
    # Without pictures, as in the page: by the texts' places.
    known = browser.run("report.view.in_view.map((t) => t.id)")
    placed = browser.run("texts_in_view({ ...report.data, frames: [] }, report.view.shown, report.view.frame).map((t) => t.id)")
    check(set(known) & set(placed) and len(set(known) ^ set(placed)) <= 3, f"in view are {known}, not {placed}")
    browser.run(f"report.playback.select({last})")


def test_fly(browser):
    visible = f"""(() => {{ const scene = report.view.scene, draw = scene.draw; let seen;
      scene.draw = (...all) => {{ seen = [{LAYERS}.keyframes, {LAYERS}.camera, {LAYERS}.trajectory].map((l) => l.visible); draw.apply(scene, all); }};
      report.view.draw(); scene.draw = draw; return seen; }})()"""
    check(browser.run(visible) == [True, True, True], "key frames are hidden")
    switch(browser, "fly")
    check(browser.run(visible) == [False, False, True], "flying with the camera does not hide the key frames")
    check(browser.run("document.querySelector('.scale-bar').hidden"), "a bar of one length where everything has another distance")
    switch(browser, "fly")
    check(browser.run(visible) == [True, True, True], "key frames stay hidden")
    drawn = browser.run(f"""(() => {{ const {{ data, view }} = report, one = data.world.keyframes[0];
      view.layers.fill({{ ...data, world: {{ ...data.world, keyframes: Array(500).fill(one) }} }}, 0.1);
      const drawn = {LAYERS}.keyframes.ends.length; view.fill(); return drawn; }})()""")
    check(10 < drawn <= 40, f"of 500 key frames {drawn} are drawn")


def test_guides(browser):
    """The bar is as long as it says, up is up, the grid can be hidden, points have their image's grey."""
    browser.run("(() => { report.view.moved = false; report.view.reset(); report.view.draw(); })()")
    bar = browser.run("(() => { const b = document.querySelector('.scale-bar'); return [b.textContent, b.lastChild.getBoundingClientRect().width]; })()")
    number, unit = bar[0].split(" ", 1)
    metres = float(number) * {"m": 1, "cm": 0.01, "mm": 0.001}[unit]
    px = browser.run(f"""(() => {{ const v = report.view, right = unit(cross(v.direction(), v.up));
      const at = [0, {metres} / v.unit.factor].map((s) => to_clip(v.clip, add(v.target, scaled(right, s)))[0]);
      return (at[1] - at[0]) / 2 * v.box.clientWidth; }})()""")
    check(abs(px - bar[1]) < 1, f"{bar[0]} are {px} px, and the bar has {bar[1]}")
    units = browser.run("[unit_of({}).name, unit_of({ summary: { metric: { texts: 2 } } }).name, unit_of({ summary: { scale: 3 } }).factor]")
    check(units == ["map units", "m", 3], f"units {units}")
    check(browser.run("Number(document.querySelectorAll('.compass line')[3].getAttribute('y2'))") < -10, "up is not up")
    check("unit" in browser.run("document.getElementById('provenance').textContent").lower(), "the unit is not told")
    full = colours(browser, "canvas")
    picture = "(() => { report.view.draw(); return report.view.canvas.toDataURL(); })()"
    before = browser.run(picture)
    switch(browser, "grid")
    check(browser.run(picture) != before, "the grid cannot be hidden")
    switch(browser, "grid")
    check(browser.run(picture) == before and full > 100, "the grid does not come back")
    greys = browser.run(f"""(() => {{ const view = report.view, all = view.scene.layers, before = all.map((l) => l.visible);
      for (const layer of all) layer.visible = layer === {LAYERS}.points;
      view.scene.draw(view.clip, false);
      const to = document.createElement('canvas'); Object.assign(to, {{ width: view.canvas.width, height: view.canvas.height }});
      const pen = to.getContext('2d'); pen.drawImage(view.canvas, 0, 0);
      const px = pen.getImageData(0, 0, to.width, to.height).data, seen = new Set(); let off = 0;
      for (let i = 0; i < px.length; i += 4) {{ seen.add(px[i]); off = Math.max(off, Math.abs(px[i] - px[i + 2])); }}
      all.forEach((layer, i) => {{ layer.visible = before[i]; }}); view.draw();
      return [seen.size, off]; }})()""")
    check(greys[0] > 15 and greys[1] <= 6, f"points have {greys[0]} greys, off by {greys[1]}")


def test_search(browser):
    """As textslam-map query finds words: the same ranks, near misses count."""
    text = "{ id: 7, word: 'Exit north', readings: ['Exit north', 'Ex1t morth'] }"
    for asked, rank in (("exit north", 0), ("exi", 1), ("nor", 2), ("it n", 3), ("1t m", 4), ("exot nerth", 5), ("cafeteria", 6)):
        found = browser.run(f"match_rank({text}, '{asked}', 0.5)")
        check(found == rank, f"{asked} has rank {found}, not {rank}")
    check(browser.run("[word_similarity('abcd', 'abxd'), word_similarity('', ''), word_similarity('ab', 'xy')]") == [0.5, 1, 0], "similarity")
    word = browser.run("report.data.texts.map((t) => t.word).find((w) => /^[A-Z]{5,}$/.test(w))")
    misread = word[:2].lower() + ("x" if word[2] != "X" else "y") + word[3:].lower()
    browser.run("(() => { document.activeElement.blur(); scrollTo(0, document.body.scrollHeight); })()")
    browser.key("/")
    check(browser.run("document.activeElement.id") == "search", "the key / does not lead to the search")
    browser.call("Input.insertText", text=misread)
    hits = browser.run("[...document.querySelectorAll('#hits li span')].map((hit) => hit.textContent)")
    check(word in hits, f"{misread} finds {hits}, not {word}")
    check(browser.run("document.querySelector('#texts tbody td').textContent") == hits[0], "the table has other texts")
    for _ in range(hits.index(word)):
        browser.key("ArrowDown")
    browser.key("Enter")
    check(browser.run("report.data.texts.find((t) => t.id === report.view.chosen).word") == word, "Enter does not choose the hit")
    check(browser.run("document.getElementById('hits').hidden"), "the hits stay open")
    in_sight(browser, "a hit")
    search_for(browser, "")


def in_sight(browser, what):
    browser.until("""(() => { const box = document.getElementById('view').getBoundingClientRect();
      return box.top >= -box.height / 4 && box.bottom <= innerHeight + box.height / 4; })()""", f"{what} does not bring the 3D view into sight")
    rest(browser)


def test_row(browser):
    """A row of the table brings the 3D view into sight, and its text is there though it came later."""
    browser.run("report.playback.select(0)")
    click(browser, "#texts tbody tr:last-child")
    in_sight(browser, "a row")
    check(browser.run("report.view.shown.some((text) => text.id === report.view.chosen)"), "the chosen text is not shown")


def test_values(browser):
    """Plots tell their values under the pointer, all of them, and else those of the frame that is shown."""
    told = "report.plots.map((plot) => plot.values.map((value) => value.textContent))"
    browser.run("report.playback.select_frame(30)")
    points = "report.plots.findIndex((plot) => plot.lines[0].name === 'points')"
    here = browser.run("String(report.data.series.points[30])")
    check(browser.run(f"{told}[{points}][0]") == here, "the values of the frame are not told")
    before = browser.run(told)
    x, y = middle(browser, "#plots svg")
    browser.mouse("mouseMoved", x + 40, y)
    browser.until("document.querySelectorAll('#plots .where').length === report.plots.length", "the pointer's frame is not told")
    frame = browser.run("report.plots[0].pointed")
    check(frame != 30 and browser.run(told) != before, "the values stay where the pointer goes")
    check(browser.run(f"{told}[{points}][0] === String(report.data.series.points[{frame}])"), "another plot does not tell the pointer's frame")
    browser.mouse("mouseMoved", 2, y)
    browser.until(f"JSON.stringify({told}) === {json.dumps(json.dumps(before, separators=(',', ':'), ensure_ascii=False))}",
                  "without the pointer the values are not those of the frame")


def test_keys(browser):
    browser.run("document.activeElement.blur()")
    browser.key("?")
    check(browser.run("document.getElementById('keys').open"), "? does not list the keys")
    listed = browser.run("[...document.querySelectorAll('#keys kbd')].map((key) => key.textContent)")
    check({"?", "/", "Space", "R"} <= set(listed), f"only these keys are listed: {listed}")
    frame = browser.run("report.view.frame")
    browser.key("Home")
    check(browser.run("report.view.frame") == frame, "keys work behind their list")
    browser.run("document.querySelector('#keys button').click()")
    check(not browser.run("document.getElementById('keys').open"), "the list of keys stays open")
    click(browser, "#help")
    check(browser.run("document.getElementById('keys').open"), "the button does not list the keys")
    browser.run("document.getElementById('keys').close()")
    browser.run("document.getElementById('search').focus()")
    browser.key("?")
    check(browser.run("!document.getElementById('keys').open && document.getElementById('search').value === '?'"), "? cannot be searched for")
    search_for(browser, "")


def test_notice(browser):
    """An approximate camera is said at the top."""
    notice = "document.getElementById('notice').hidden ? '' : document.getElementById('notice').textContent"
    check(browser.run(notice) == "", "something is said of a good run")
    browser.run("show_notice({ ...report.data, camera: { ...report.data.camera, approximate_fov_deg: 60 } })")
    check("approximate" in browser.run(notice) and "60\u00b0" in browser.run(notice), "an approximate camera is not said")
    browser.run("show_notice(report.data)")


def test_fingers(browser, page):
    """One finger scrolls the page; after a tap it turns the map, until a tap beside it."""
    browser.open(page, 390, 844, ready=READY)
    browser.call("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=5)
    def touch(kind, *points):
        browser.call("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": a, "y": b, "id": i} for i, (a, b) in enumerate(points)])

    def slide(*ways):
        touch("touchStart", *(way[0] for way in ways))
        for share in (0.2, 0.4, 0.6, 0.8, 1):
            touch("touchMove", *((a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])) for a, b in ways))
        touch("touchEnd")

    x, y = middle(browser, "#view")
    before, scrolled = clip(browser), browser.run("scrollY")
    slide(((x, y), (x, y - 120)))
    browser.until(f"scrollY > {scrolled} + 60", "one finger on the 3D view does not scroll the page")
    check(clip(browser) == before, "a finger that scrolls turns the map")
    check(browser.run("document.querySelector('.touch-hint').textContent"), "it is not said how a finger turns the map")
    rest(browser)
    x, y = middle(browser, "#view")
    scrolled = browser.run("scrollY")
    slide(((x - 30, y), (x - 60, y + 50)), ((x + 30, y), (x + 60, y + 50)))
    check(clip(browser) != before and browser.run("scrollY") == scrolled, "two fingers do not move the map alone")
    before = clip(browser)
    touch("touchStart", (x, y - 120))
    touch("touchEnd")
    browser.until("document.getElementById('view').classList.contains('active')", "a tap does not give the map the finger")
    slide(((x, y), (x + 60, y + 60)))
    check(clip(browser) != before and browser.run("scrollY") == scrolled, "after a tap one finger does not turn the map")
    x, y = middle(browser, ".hint")
    touch("touchStart", (x, y))
    touch("touchEnd")
    browser.until("!document.getElementById('view').classList.contains('active')", "a tap beside the map does not give the page its finger")
    browser.call("Emulation.setTouchEmulationEnabled", enabled=False)


def test_viewer(browser):
    page = browser.run("decodeURIComponent(location.pathname)")
    for test in (test_time, test_fly, test_guides, test_search, test_row, test_values, test_keys, test_notice):
        test(browser)
    test_fingers(browser, page)
