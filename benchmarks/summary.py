"""All rows in one: the table of ratios, as text, as ratios.json and as the picture ratios.png.

It reads what the rows have written; ``./run bench`` runs it after them.
"""

from __future__ import annotations

from pathlib import Path

import bench

ROWS = ("forward", "inverse", "orders", "plans", "startup", "memory")
GREEN, RED, GREY = "#2a7f4f", "#c0392b", "#b8c4ce"
ON_WHITE = {"va": "center", "bbox": {"color": "white", "pad": 0.8}}
LEFT, RIGHT = 3e-6, 1e2  # of the axis of ratios


def all_lines():
    """The lines of all rows that have been run."""
    lines = []
    for row in ROWS:
        result = bench.read(row)
        if result is None:
            print(f"{row}: not run yet (./run bench {row})")
            continue
        lines += [bench.Line(**line) for line in result["lines"]]
    return lines


def ratios(line):
    """Name -> the project's figure by a peer's; the best peer's is of the same rounds."""
    found = {name: line.ours / value for name, value in line.peers.items()}
    if line.best:
        found[line.best] = line.ratio
    return dict(sorted(found.items(), key=lambda item: -item[1]))


def label_of(line, name):
    """A peer's name, and what is wrong with its answers."""
    above = line.more.get("above_shortest", {})
    longer = above.get(name, 0.0) - above.get(bench.OURS, 0.0)
    return f"{name}, path {longer:.1%} longer" if longer > 1e-9 else name


def draw(lines, path):
    """One bar a peer on a logarithmic axis: to the left, the project takes less than it."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot as plt

    alone = [line for line in lines if not line.peers]
    columns = halves([line for line in lines if line.peers])
    tall = max(sum(map(height, columns[0])), sum(map(height, columns[1])) + 1.8 * len(alone))
    figure, axes = plt.subplots(1, 2, figsize=(14, 0.24 * tall + 1.2))
    for ax, column in zip(axes, columns):
        ax.set(xscale="log", xlim=(LEFT, RIGHT), ylim=(tall, -1), yticks=[])
        y = 0.0
        for line in column:
            draw_line(ax, line, y)
            y += height(line)
        if column is columns[-1]:
            for line in alone:
                write_title(ax, line, y, f"{line.work}: {bench.shown(line.ours, line.unit)}")
                y += 1.8
        ax.set_xlabel("project / peer: left of 1, the project is the faster")
        ax.axvline(1.0, color="black", lw=0.8)
        ax.grid(axis="x", color="0.9", lw=0.6)
        ax.set_axisbelow(True)
        for side in ("left", "top", "right"):
            ax.spines[side].set_visible(False)
    figure.suptitle(
        "youbot_kinematics beside its peers: time by theirs, medians of rounds in turn\n"
        "green: the peer that counts, goal reached; red: goal missed; dashes: the goal, if a ratio",
        fontsize=10,
    )
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    print(f"written: {path}")


def height(line):
    """How many rows of the picture a line takes: its title, its bars, and a gap."""
    return len(line.peers) + 1.8


def halves(lines):
    """The lines in two columns of about one height."""
    whole, first = sum(map(height, lines)), []
    while lines and sum(map(height, first)) + height(lines[0]) / 2 < whole / 2:
        first.append(lines.pop(0))
    return first, lines


def write_title(ax, line, y, title):
    verdict = f"{line.goal}: {'reached' if line.reached else 'MISSED'}"
    ax.text(LEFT, y, title, weight="bold", va="center", fontsize=9)
    ax.text(RIGHT, y, verdict, color=colour_of(line), ha="right", fontsize=8, **ON_WHITE)


def colour_of(line):
    return GREEN if line.reached else RED


def draw_line(ax, line, top):
    write_title(ax, line, top, line.work)
    found = ratios(line)
    for y, (name, ratio) in enumerate(found.items(), start=1):
        y += top
        counts = name == line.best
        ax.barh(y, ratio - 1.0, left=1.0, height=0.72, color=colour_of(line) if counts else GREY)
        weight = "bold" if counts else "normal"
        ax.text(LEFT, y, f"  {label_of(line, name)}", va="center", fontsize=8, weight=weight)
        side = "left" if ratio > 1 else "right"
        at = ratio * (1.08 if ratio > 1 else 1 / 1.08)
        label = f"{ratio:.2g}" if ratio < 10 else f"{ratio:.0f}"
        ax.text(at, y, label, ha=side, fontsize=8, weight=weight, **ON_WHITE)
    if line.most:
        ends = [top + 0.5, top + len(found) + 0.5]
        ax.plot([line.most] * 2, ends, color="black", lw=1.2, ls=(0, (3, 2)))


def main():
    lines = all_lines()
    print()
    if not lines:
        return
    bench.show_lines(lines)
    missed = sum(not line.reached for line in lines)
    print(f"{len(lines) - missed} of {len(lines)} goals reached")
    table = {
        line.work: {
            "project": line.ours,
            "peers": line.peers,
            "unit": line.unit,
            "best_peer": line.best,
            "ratio": line.ratio,
            "goal": line.goal,
            "reached": line.reached,
            "note": line.note,
        }
        for line in lines
    }
    bench.write("ratios", {"rows": table})
    draw(lines, Path(bench.RESULTS or ".") / "ratios.png")


if __name__ == "__main__":
    main()
