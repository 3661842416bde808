#!/usr/bin/env python3
"""Cost of a look-up against the size of a diagram and the number of diagrams, as SVG.

    build/gonio_bench --benchmark_filter='^((forward|inverse)(_batch)?/[0-9]+/|(sample|pdf)(_batch)?/displacement/outgoing/)' \\
        --benchmark_repetitions=5 --benchmark_enable_random_interleaving=true --benchmark_min_time=0.02 \\
        --benchmark_report_aggregates_only --benchmark_format=json | tools/bench/plot.py > docs/images/cost.svg
"""
import json
import math
import sys

COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7"]
DASHES = ["", "7 4"]


def medians():
    for b in json.load(sys.stdin)["benchmarks"]:
        if b.get("aggregate_name") == "median":
            yield b["run_name"].split("/"), 1e9 / b["items_per_second"]


def panel(x0, title, axis, series, out):
    """series: {name: [(x, ns)]}, drawn on a logarithmic x axis from ns = 0."""
    width, height, top = 380, 260, 60
    xs = sorted({x for points in series.values() for x, _ in points})
    most = max(ns for points in series.values() for _, ns in points)
    step = 10 ** math.floor(math.log10(most / 2))
    step *= next(f for f in (1, 2, 5, 10) if most / (step * f) <= 6)
    most = step * math.ceil(most / step)
    low, high = math.log2(xs[0]), math.log2(xs[-1])
    px = lambda x: x0 + (math.log2(x) - low) / (high - low) * width
    py = lambda ns: top + height - ns / most * height
    out.append(f'<text x="{x0}" y="{top - 18}" font-size="15">{title}</text>')
    for k in range(round(most / step) + 1):
        y = py(k * step)
        out.append(f'<path d="M{x0} {y:.1f}h{width}" stroke="#ddd"/>'
                   f'<text x="{x0 - 8}" y="{y + 4:.1f}" text-anchor="end" fill="#333">{k * step:g}</text>')
    last = -100
    for x in xs:
        if px(x) - last < 44:
            continue
        last = px(x)
        out.append(f'<text x="{last:.1f}" y="{top + height + 18}" text-anchor="middle" fill="#333">{x}</text>')
    out.append(f'<text x="{x0 + width / 2}" y="{top + height + 38}" text-anchor="middle">{axis}</text>')
    for k, (name, points) in enumerate(sorted(series.items())):
        style = f'stroke="{COLOURS[k // 2 % 4]}" stroke-dasharray="{DASHES[k % 2]}"'
        line = " ".join(f"{px(x):.1f},{py(ns):.1f}" for x, ns in sorted(points))
        out.append(f'<polyline points="{line}" fill="none" stroke-width="2" {style}/>')
        y = top + height + 62 + 18 * k
        out.append(f'<path d="M{x0} {y - 4}h34" stroke-width="2" {style}/><text x="{x0 + 42}" y="{y}">{name}</text>')


def main():
    by_size, by_count = {}, {}
    for name, ns in medians():
        kind = name[0].replace("_batch", " (batch)")
        if name[0].startswith(("forward", "inverse")):
            by_size.setdefault(kind, []).append((int(name[1]) * int(name[2]), ns))
        elif len(name) == 4 or name[4] == "4096":
            by_count.setdefault(kind, []).append((int(name[3]), ns))
    out = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 920 470" font-family="sans-serif" font-size="13">',
           '<rect width="920" height="470" fill="white"/>']
    panel(60, "one diagram: ns a look-up", "crossings of a diagram, M N", by_size, out)
    panel(520, "displacement, 33 x 33 lines: ns a look-up", "diagrams of a stack", by_count, out)
    print("\n".join(out + ["</svg>"]))


if __name__ == "__main__":
    main()
