#!/usr/bin/env python3
"""Builds the documentation site and looks at it: every link, and each page in Chromium at two widths, light and dark.

usage: docs_site_test.py ROOT FOLDER [--screenshots DIR]

ROOT is the repository; the site goes to FOLDER. Exit code 77 where a program that it needs is missing.
"""
import argparse
import html.parser
import pathlib
import subprocess
import sys
import urllib.parse

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from browser import Browser, check, chromium, skip  # noqa: E402

FUNCTIONS = ["align_pose", "refine_pose", "refine_plane", "make_patch", "plane_from_matches", "solve_window",
             "evaluate_batch", "track_klt", "undistort"]
REFERENCE = ["index", "functions", "annotated", "files", "namespaces", "namespacetextplane",
             "namespacetextplane_1_1reference", "namespacetextplane_1_1simd", "structtextplane_1_1SE3",
             "se3_8hpp", "se3_8hpp_source"]
PHONE, DESKTOP = (390, 844), (1440, 1000)


class Page(html.parser.HTMLParser):
    """The anchors of a page and what it links to."""

    def __init__(self, path):
        super().__init__()
        self.anchors, self.links = set(), []
        self.feed(path.read_text())

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.anchors.update(filter(None, (values.get("id"), values.get("name") if tag == "a" else None)))
        self.links += filter(None, (values.get("href"), values.get("src")))


def build(root, folder):
    result = subprocess.run([str(root / "docs/build"), str(folder)], capture_output=True, text=True)
    if result.returncode == 2:
        skip(result.stderr.strip())
    check(result.returncode == 0, f"docs/build fails:\n{result.stdout}{result.stderr}")
    warnings = (folder / "reference.log").read_text().splitlines()
    unresolved = [line for line in warnings if "could not be resolved" in line]
    check(not unresolved, "unresolved in the reference:\n" + "\n".join(unresolved))


def test_links(folder):
    pages = {path.resolve(): Page(path) for path in folder.rglob("*.html") if "reference_" not in path.name}
    check(len(pages) > 100, f"only {len(pages)} pages")
    dead, count = [], 0
    for path, page in pages.items():
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or link.startswith("javascript:"):
                continue
            count += 1
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            anchor = urllib.parse.unquote(parts.fragment)
            if not target.is_file() or (anchor and target in pages and anchor not in pages[target].anchors):
                dead.append(f"{path.relative_to(folder.resolve())}: {link}")
    check(not dead, f"{len(dead)} dead links of {count}:\n" + "\n".join(sorted(set(dead))[:50]))
    print(f"ok: {count} links of {len(pages)} pages")


def test_navigation(root, folder):
    """Every page is found in the list of pages, on every page."""
    sources = [*root.glob("*.md"), *(root / "docs").glob("*.md")]
    for path in (folder / "index.html", folder / "docs/concepts.html", folder / "reference/index.html"):
        links = {(path.parent / link.split("#")[0]).resolve() for link in Page(path).links}
        for source in sources:
            name = source.relative_to(root).with_suffix(".html")
            name = name.with_name("index.html") if name.name == "README.html" else name
            check((folder / name).resolve() in links, f"{path} does not lead to {name}")
    print(f"ok: {len(sources)} pages in the bar")


def lightness(browser):
    return browser.run("""(() => { const pen = document.createElement('canvas').getContext('2d');
      return ['backgroundColor', 'color'].map((what) => { pen.fillStyle = getComputedStyle(document.body)[what];
        pen.fillRect(0, 0, 1, 1);
        return pen.getImageData(0, 0, 1, 1).data.slice(0, 3).reduce((a, b) => a + b) / 765; }); })()""")


def test_page(browser, path, screenshots):
    """No overflow, formulas set in KaTeX's fonts, light and dark."""
    browser.open(path, *PHONE, settle=0)
    for width, height in (PHONE, DESKTOP):
        browser.show(width, height)
        shown = browser.run("document.documentElement.scrollWidth")
        check(shown <= width, f"{path} is {shown} px wide on a screen of {width}")
        formulas, missing = browser.run("""document.fonts.ready.then(() => [...document.querySelectorAll('span.math')])
          .then((all) => [all.length, all.filter((m) => !m.querySelector('.katex')).length])""")
        check(not missing, f"{missing} of {formulas} formulas in {path} are not set")
        if formulas:
            fonts = browser.run("[...document.fonts].filter((f) => f.status === 'loaded').map((f) => f.family)")
            check(any("KaTeX" in font for font in fonts), f"the fonts of the formulas in {path} are missing")
            errors = browser.run("document.querySelectorAll('.katex-error').length")
            check(not errors, f"{errors} formulas in {path} have errors")
        for dark in (False, True):
            browser.show(width, height, dark)
            back, text = lightness(browser)
            right = back < 0.3 and text > 0.7 if dark else back > 0.9 and text < 0.3
            check(right, f"{path}: dark {dark}, lightness of background and text {back}, {text}")
            if screenshots:
                name = f"{path.parent.name}_{path.stem}-{width}-{'dark' if dark else 'light'}.png"
                browser.screenshot(screenshots / name, tallest=3 * height)
    check(not browser.troubles, f"{path}: the browser complains: {browser.troubles}")
    return formulas


def test_menu(browser, folder):
    """On a phone the list of pages opens by the button of the bar."""
    visible = "getComputedStyle(document.querySelector('nav.pages')).display !== 'none'"
    browser.open(folder / "index.html", *PHONE, settle=0)
    check(not browser.run(visible), "on a phone the list of pages covers the page")
    browser.run("document.querySelector('.menu').click()")
    check(browser.run(visible), "on a phone the button does not open the list of pages")
    print("ok: menu")


def test_search(browser, folder):
    others = [(start, FUNCTIONS[0]) for start in ("docs/concepts.html", "reference/annotated.html")]
    for start, name in [("index.html", name) for name in FUNCTIONS] + others:
        browser.open(folder / start, *DESKTOP, settle=0)
        browser.key("/")
        browser.call("Input.insertText", text=name)
        browser.until("!document.getElementById('found').hidden", "the search shows nothing")
        label = browser.run("document.querySelector('#found a.chosen')?.firstChild.textContent")
        check(label and label.split("::")[-1] == name, f"the search for {name} finds {label}")
        browser.key("Enter")
        browser.until("location.hash.length > 1 && document.readyState === 'complete'", f"{name} leads nowhere")
        place = browser.run("document.getElementById(location.hash.slice(1))?.nextElementSibling?.textContent")
        check(place and name in place, f"the search for {name} leads to {place}")
    check(not browser.troubles, f"the browser complains: {browser.troubles}")
    print(f"ok: search finds {len(FUNCTIONS)} functions")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--screenshots", type=pathlib.Path)
    arguments = parser.parse_args()
    program, folder = chromium(), arguments.folder
    if arguments.screenshots:
        arguments.screenshots.mkdir(parents=True, exist_ok=True)
    build(arguments.root, folder)
    test_links(folder)
    test_navigation(arguments.root, folder)
    with Browser(program) as browser:
        pages = sorted(folder.glob("*.html")) + sorted((folder / "docs").glob("*.html"))
        pages = [page for page in pages if not page.name.startswith("reference_")]
        pages += [folder / f"reference/{name}.html" for name in REFERENCE]
        pages += sorted((folder / "files").rglob("*.html"))[:3]
        formulas = sum(test_page(browser, page, arguments.screenshots) for page in pages)
        check(formulas > 10, "the pages have no formulas")
        print(f"ok: {len(pages)} pages, {formulas} formulas")
        test_menu(browser, folder)
        test_search(browser, folder)


if __name__ == "__main__":
    main()
