"""A sweep as SVG: ATE and angle error over the swept value, one line a mode; a cross at the top marks a failed run."""
import math
from html import escape

WIDTH, HEIGHT = 420, 260  # of a panel
LEFT, RIGHT, TOP, BOTTOM = 58, 14, 30, 44
COLOURS = {"text": "#1f5fbf", "points": "#8a8a8a", "loose": "#d9731a"}
DASHES = {"loose": ' stroke-dasharray="7 6"'}  # loose and points have the same poses: both lines show


def decades(values):
    """The powers of ten around the values, at least one decade."""
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    return low, max(high, low + 1)


class Panel:
    """x linear, y logarithmic. lines: {mode: [(x, y or None)]}; None is a failed run."""

    def __init__(self, left, title, lines):
        self.left, self.title, self.lines = left, title, lines
        self.xs = sorted({x for line in lines.values() for x, _ in line})
        ys = [y for line in lines.values() for _, y in line if y is not None and y > 0]
        self.low, self.high = decades(ys) if ys else (0, 1)

    def x(self, value):
        span = self.xs[-1] - self.xs[0] or 1
        return self.left + LEFT + (value - self.xs[0]) / span * (WIDTH - LEFT - RIGHT)

    def y(self, value):
        share = (math.log10(max(value, 10.0**self.low)) - self.low) / (self.high - self.low)
        return HEIGHT - BOTTOM - share * (HEIGHT - TOP - BOTTOM)

    def draw(self):
        out = [f'<text x="{self.left + LEFT}" y="18" font-weight="bold">{escape(self.title)}</text>']
        for decade in range(self.low, self.high + 1):
            y = self.y(10.0**decade)
            out.append(f'<path d="M{self.x(self.xs[0]):.1f} {y:.1f}H{self.x(self.xs[-1]):.1f}" stroke="#ddd"/>')
            out.append(f'<text x="{self.left + LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{10.0**decade:g}</text>')
        for value in self.xs:
            x = self.x(value)
            out.append(f'<path d="M{x:.1f} {HEIGHT - BOTTOM}v4" stroke="#444"/>')
            out.append(f'<text x="{x:.1f}" y="{HEIGHT - BOTTOM + 17}" text-anchor="middle">{value:g}</text>')
        for mode, line in self.lines.items():
            out += self.draw_line(mode, line)
        return out

    def draw_line(self, mode, line):
        colour, out, pen = COLOURS[mode], [], ""
        for x, y in line:
            if y is None:
                cross = f"M{self.x(x) - 4:.1f} {TOP - 4}l8 8m0 -8l-8 8"
                out.append(f'<path d="{cross}" stroke="{colour}" stroke-width="2"/>')
                pen += " "
                continue
            pen += ("L" if pen and pen[-1] != " " else "M") + f"{self.x(x):.1f} {self.y(y):.1f}"
            out.append(f'<circle cx="{self.x(x):.1f}" cy="{self.y(y):.1f}" r="3" fill="{colour}"/>')
        if pen.strip():
            style = f'fill="none" stroke="{colour}" stroke-width="2"{DASHES.get(mode, "")}'
            out.insert(0, f'<path d="{pen.strip()}" {style}/>')
        return out


def plot(x_label, panels):
    """panels: [(title, lines)], side by side."""
    drawn = [Panel(i * WIDTH, title, lines) for i, (title, lines) in enumerate(panels)]
    width = WIDTH * len(drawn)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {HEIGHT}" font-family="sans-serif" '
           'font-size="12">']
    out.append(f'<rect width="{width}" height="{HEIGHT}" fill="white"/>')
    for panel in drawn:
        out += panel.draw()
        middle = panel.left + (WIDTH + LEFT) / 2
        out.append(f'<text x="{middle:.0f}" y="{HEIGHT - 8}" text-anchor="middle">{escape(x_label)}</text>')
    for i, (mode, colour) in enumerate(COLOURS.items()):
        x = width - RIGHT - 56 * (len(COLOURS) - i)
        out.append(f'<rect x="{x}" y="9" width="10" height="10" fill="{colour}"/>'
                   f'<text x="{x + 14}" y="18">{mode}</text>')
    return "\n".join(out + ["</svg>"]) + "\n"
