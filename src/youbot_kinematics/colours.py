"""The colours of pictures, of the page and of RViz, and what each stands for.

They are Okabe and Ito's, which colour-blind people can tell apart
(https://jfly.uni-koeln.de/color/).
"""

from __future__ import annotations

BLACK, GREY, SHADE = "#000000", "#999999", "#e8e8e8"
BLUE, ORANGE, GREEN, VERMILLION = "#0072B2", "#E69F00", "#009E73", "#D55E00"
SKY, PURPLE = "#56B4E9", "#CC79A7"

#: Why the tool moves as it does, by the kind of a ``trajectory.Segment``.
KIND_COLOURS = {
    "line": BLUE,
    "approach": GREEN,
    "reconfiguration": VERMILLION,
    "detour": PURPLE,
}


def rgb(colour: str) -> tuple[float, float, float]:
    """Red, green and blue, each 0 to 1, of a colour such as ``"#E69F00"``."""
    red, green, blue = (int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return red, green, blue
