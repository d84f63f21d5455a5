"""Plots with error bars as SVG, without libraries."""
import math

COLOURS = ["#1f6fb2", "#d1495b", "#2a9d6f", "#8e5ea2", "#e08e0b", "#4d4d4d"]
LEFT, RIGHT, TOP, BOTTOM = 64, 16, 14, 48


def ticks(low, high, wanted=6):
    raw = (high - low) / wanted
    power = 10 ** math.floor(math.log10(raw))
    step = next(s * power for s in (1, 2, 2.5, 5, 10) if s * power >= raw)
    first = math.ceil(low / step - 1e-9)
    return [round(step * k, 12) for k in range(first, int(math.floor(high / step + 1e-9)) + 1)]


def legend_places(names, width):
    """Left upper corners of the names above a plot, in rows that fit."""
    places, x, row = [], LEFT, 0
    for name in names:
        room = 34 + 7 * len(name)
        if x > LEFT and x + room > width:
            x, row = LEFT, row + 1
        places.append((x, TOP + 17 * row))
        x += room
    return places


def plot(path, series, x_label, y_label, width=620, height=380, y_range=None, lines=True):
    """series: [(name, [(x, y, error), ...]), ...]; horizontal bands: name starting with '='."""
    points = [p for _, rows in series for p in rows]
    xs = [p[0] for p in points]
    ys = [p[1] + s * p[2] for p in points for s in (-1, 1)]
    x0, x1 = min(xs), max(xs)
    pad = 0.04 * (x1 - x0 or 1)
    x0, x1 = x0 - pad, x1 + pad
    y0, y1 = y_range or (min(ys) - 0.06 * (max(ys) - min(ys)), max(ys) + 0.06 * (max(ys) - min(ys)))
    places = legend_places([name for name, _ in series], width)
    top = places[-1][1] + 24  # of the frame
    w, h = width - LEFT - RIGHT, height - top - BOTTOM

    def at(x, y):
        return LEFT + w * (x - x0) / (x1 - x0), top + h * (y1 - y) / (y1 - y0)

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
           'font-family="sans-serif" font-size="12">', f'<rect width="{width}" height="{height}" fill="#fff"/>']
    for y in ticks(y0, y1):
        _, v = at(x0, y)
        out.append(f'<path d="M{LEFT} {v:.1f}h{w}" stroke="#e4e8ec"/>'
                   f'<text x="{LEFT - 7}" y="{v + 4:.1f}" text-anchor="end" fill="#555">{y:g}</text>')
    for x in ticks(x0, x1, 8):
        u, _ = at(x, y0)
        out.append(f'<path d="M{u:.1f} {top + h}v4" stroke="#555"/>'
                   f'<text x="{u:.1f}" y="{top + h + 18}" text-anchor="middle" fill="#555">{x:g}</text>')
    out.append(f'<path d="M{LEFT} {top}v{h}h{w}" fill="none" stroke="#555"/>')
    out.append(f'<text x="{LEFT + w / 2}" y="{height - 8}" text-anchor="middle">{x_label}</text>')
    out.append(f'<text transform="translate(15 {top + h / 2}) rotate(-90)" text-anchor="middle">{y_label}</text>')
    for k, (name, rows) in enumerate(series):
        colour = COLOURS[k % len(COLOURS)]
        if lines and len(rows) > 1:
            out.append('<polyline fill="none" stroke="%s" stroke-width="1.6" points="%s"/>' % (
                colour, " ".join("%.1f,%.1f" % at(p[0], p[1]) for p in rows)))
        for x, y, error in rows:
            u, v = at(x, y)
            _, upper = at(x, y + error)
            _, low = at(x, y - error)
            out.append(f'<path d="M{u:.1f} {upper:.1f}V{low:.1f}M{u - 4:.1f} {upper:.1f}h8M{u - 4:.1f} {low:.1f}h8" '
                       f'stroke="{colour}" stroke-width="1.3"/><circle cx="{u:.1f}" cy="{v:.1f}" r="3" fill="{colour}"/>')
        x, y = places[k]
        out.append(f'<rect x="{x}" y="{y}" width="12" height="10" fill="{colour}"/>'
                   f'<text x="{x + 18}" y="{y + 9}">{name}</text>')
    path.write_text("\n".join(out + ["</svg>\n"]))
