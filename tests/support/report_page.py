"""What tests do with a report of textslam in a Browser: mouse, search, layers, and what the 3D view shows."""
import json

READY = "window.report !== undefined"


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


def search_for(browser, word):
    browser.run(f"(() => {{ const s = document.getElementById('search'); s.value = {json.dumps(word)}; s.dispatchEvent(new Event('input')); }})()")


def switch(browser, layer):
    """Clicks the checkbox below the 3D view whose name begins so."""
    browser.run(f"[...document.querySelectorAll('#layers label')].find((l) => l.textContent.startsWith({json.dumps(layer)})).click()")


def rest(browser):
    """Waits until the page scrolls no further."""
    browser.run("""new Promise((done) => { let last = -1, same = 0; const look = () => {
      same = scrollY === last ? same + 1 : 0; last = scrollY;
      if (same > 10) done(true); else requestAnimationFrame(look); }; look(); })""")
