"""Draws the figures of reproduced experiments as files with matplotlib (the `figures` extra)."""

from __future__ import annotations

from itertools import cycle
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.backend_bases import FigureCanvasBase
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from ..reproduce.tables import Bars, BoxPlots, DrawStyle, Plot, Reproduction, Statistics

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00")
"""Colours that colour-blind people can distinguish (Okabe and Ito 2008)."""
MARKERS = ("o", "s", "^", "D", "v")
GREY = "0.55"
PANEL_SIZE = 5.4
"""Side of a panel, inches."""
LEAST_HALF_HEIGHT = 0.5
"""Least half of the range of heights that a panel in space shows, m, so that level tracks look level."""
MOST_COLUMNS = 6
"""Largest number of panels side by side."""


def formats() -> list[str]:
    """Return the extensions of the files that can be drawn, without the dot."""
    return sorted(FigureCanvasBase.get_supported_filetypes())


METADATA_KEYS = {"png": "Software", "pdf": "Creator", "svg": "Creator", "eps": "Creator", "ps": "Creator"}
"""Key of the drawing program in the metadata of each format that has such a key."""


def draw(reproduction: Reproduction, path: Path, extension: str) -> None:
    """Draw the panels in rows into a file, in the format of an extension. Raise OSError when that fails."""
    count = max(1, len(reproduction.panels))
    rows = -(-count // MOST_COLUMNS)
    columns = -(-count // rows)
    figure = Figure(figsize=(PANEL_SIZE * columns, PANEL_SIZE * rows), layout="constrained")
    for number, panel in enumerate(reproduction.panels, 1):
        in_space = isinstance(panel, Plot) and any(len(point) > 2 for track in panel.tracks for point in track.points)
        ax = figure.add_subplot(rows, columns, number, projection="3d" if in_space else None)
        if isinstance(panel, BoxPlots):
            _draw_boxes(ax, panel, reproduction)
        elif isinstance(panel, Bars):
            _draw_bars(ax, panel)
        else:
            _draw_plot(ax, panel)
        if in_space:
            _level(ax)
        elif isinstance(panel, Plot) and panel.x_label == "x, m":
            ax.set_aspect("equal", adjustable="datalim")
        ax.set_title(panel.title, fontsize=10)
    figure.suptitle(f"{reproduction.name}, emulated ({reproduction.published['title']})", fontsize=11)
    metadata = {METADATA_KEYS[extension]: "solepath"} if extension in METADATA_KEYS else None
    figure.savefig(path, dpi=120, format=extension, metadata=metadata)


def _draw_boxes(ax: Axes, panel: BoxPlots, reproduction: Reproduction) -> None:
    rows = {row.name: row for row in reproduction.rows}
    box_rows = [rows[name] for name in panel.rows]
    box_positions = range(1, len(box_rows) + 1)
    ax.boxplot(
        [list(row.values) for row in box_rows],
        positions=[k - 0.18 for k in box_positions],
        widths=0.3,
        manage_ticks=False,
        patch_artist=True,
        boxprops={"facecolor": "#a6cee3", "edgecolor": COLOURS[0]},
        medianprops={"color": COLOURS[1], "linewidth": 2},
        flierprops={"marker": "+", "markeredgecolor": COLOURS[0]},
    )
    for k, row in zip(box_positions, box_rows, strict=True):
        _draw_paper_box(ax, k + 0.04, row.paper)
    if panel.target is not None:
        ax.axhline(panel.target, color=GREY, linestyle="--", linewidth=1, zorder=0)
    ax.set_xticks(list(box_positions), [row.name for row in box_rows])
    ax.set_xlim(0.4, len(box_rows) + 0.6)
    ax.set_ylabel(panel.label)
    ours = Rectangle((0, 0), 1, 1, facecolor="#a6cee3", edgecolor=COLOURS[0])
    theirs = Rectangle((0, 0), 1, 1, facecolor="0.9", edgecolor=GREY)
    ax.legend([ours, theirs], ["ours, emulated", "paper: quartiles and median"], fontsize=8)


def _draw_paper_box(ax: Axes, left: float, paper: Statistics) -> None:
    """Draw the paper's box without whiskers, because papers print only quartiles and median."""
    if paper.q1 is None or paper.q3 is None or paper.median is None:
        return
    ax.add_patch(Rectangle((left, paper.q1), 0.3, paper.q3 - paper.q1, facecolor="0.9", edgecolor=GREY))
    ax.plot([left, left + 0.3], [paper.median] * 2, color=GREY, linewidth=2)
    ax.update_datalim([(left, paper.q1), (left + 0.3, paper.q3)])
    ax.autoscale_view()


def _draw_plot(ax: Axes, panel: Plot) -> None:
    styles = cycle(zip(COLOURS, MARKERS, strict=True))
    for track in panel.tracks:
        columns = list(zip(*track.points, strict=True)) or [(), ()]
        if track.style is DrawStyle.TRUTH:
            ax.plot(*columns, color="0.3", linestyle="--", linewidth=1.0, label=track.name)
            continue
        colour, marker = next(styles)
        if track.style is DrawStyle.DOTS:
            ax.scatter(columns[0], columns[1], s=14, color=colour, marker=marker, alpha=0.7, label=track.name)
        else:
            ax.plot(*columns, color=colour, linewidth=1.0, label=track.name)
    for name, x, y in panel.marks:
        ax.plot([x], [y], marker="*", color="black", markersize=9, linestyle="none", zorder=5)
        ax.annotate(name, (x, y), textcoords="offset points", xytext=(6, 6), fontsize=9)
    if panel.limits is not None:
        ax.set_ylim(*panel.limits)
    ax.set_xlabel(panel.x_label)
    ax.set_ylabel(panel.y_label)
    ax.grid(color="0.92")
    ax.set_axisbelow(True)
    ax.legend(fontsize=8, loc="center" if len(panel.marks) > 1 else "best")


def _level(ax: Any) -> None:
    """Show at least twice LEAST_HALF_HEIGHT of heights; matplotlib's axes in space have no types."""
    low, high = ax.get_zlim()
    half = max(0.5 * (high - low), LEAST_HALF_HEIGHT)
    ax.set_zlim(0.5 * (low + high) - half, 0.5 * (low + high) + half)
    ax.set_zlabel("z, m")


def _draw_bars(ax: Axes, panel: Bars) -> None:
    width = 0.8 / max(1, len(panel.series))
    for k, (title, values) in enumerate(panel.series):
        middles = [n + (k - 0.5 * (len(panel.series) - 1)) * width for n in range(len(values))]
        ax.bar(middles, values, width, color=COLOURS[k % len(COLOURS)], label=title)
    ax.set_xticks(list(range(len(panel.names))), list(panel.names), fontsize=7)
    ax.set_ylabel(panel.label)
    ax.legend(fontsize=8, loc="lower right")
