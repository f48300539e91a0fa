"""Draw docs/images/driving.gif: ``python docs/images/driving.py``.

The packaged car that drives, in the middle of a double lane change: smaller than kintrafo writes
it, with half of the frames.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import kintrafo
from kintrafo.vehicle.plots.motion import animate
from PIL import Image, ImageSequence

SHOWN = slice(44, 116, 2)
MILLISECONDS = 80
WIDE = 480


def main() -> None:
    """Write the picture."""
    found = kintrafo.handling.drive(kintrafo.load("driving_car"), "double_lane_change")
    with TemporaryDirectory() as folder:
        written = animate(found, Path(folder) / "lane.gif")
        with Image.open(written) as whole:
            size = WIDE, round(WIDE * whole.height / whole.width)
            palette = whole.copy()  # its own colours, those of thin lines too
            frames = [frame.convert("RGB") for frame in ImageSequence.Iterator(whole)][SHOWN]
    small = [frame.resize(size, Image.Resampling.LANCZOS) for frame in frames]
    pictures = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in small]
    pictures[0].save(
        Path(__file__).with_suffix(".gif"),
        save_all=True,
        append_images=pictures[1:],
        duration=MILLISECONDS,
        loop=0,
    )


if __name__ == "__main__":
    main()
