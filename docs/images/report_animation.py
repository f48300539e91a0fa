"""Draw docs/images/report.gif and others: ``python docs/images/report_animation.py``.

Reports in Chromium: two as they open, and that of the packaged push-rod suspension, whose wheel
moves through its travel, then the rack through its own, and curves follow. Needs Chromium, and
Playwright of the extra ``dev``.
"""

import io
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import kintrafo
import numpy as np
from PIL import Image
from playwright.sync_api import Page, sync_playwright

PICTURE = Path(__file__).with_name("report.gif")
SIZE = {"width": 1120, "height": 640}
SHOWN = (840, 480)
STILLS = {
    "reference_car": ("report.png", 1000),
    "double_wishbone_car": ("double_wishbone.png", 900),
}
FRAMES = 22
MILLISECONDS = 90
# No service of the browser asks anything of the network; WebGL is drawn by the processor.
OPTIONS = [
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
]


def positions() -> list[tuple[str, float]]:
    """Return which slider has which value [mm] in each frame."""
    waves = np.sin(np.linspace(0.0, 2.0 * np.pi, FRAMES, endpoint=False))
    travel = [("#travel", float(60.0 * wave)) for wave in waves]
    return travel + [("#rack", float(40.0 * wave)) for wave in waves]


@contextmanager
def opened(car: str, **size: int) -> Iterator[Page]:
    """Open the report of a packaged suspension in a window of some size."""
    with TemporaryDirectory() as folder, sync_playwright() as running:
        report = kintrafo.report.write(kintrafo.Model(car), Path(folder) / "report.html")
        browser = running.chromium.launch(
            executable_path=shutil.which("chromium") or shutil.which("google-chrome"), args=OPTIONS
        )
        page = browser.new_page(viewport=size, color_scheme="light")
        page.goto(report.as_uri())
        yield page
        browser.close()


def frames() -> list[Image.Image]:
    """Return pictures of the report in all positions."""
    shots = []
    with opened("push_rod_car", **SIZE) as page:
        page.locator('figure[data-curve="camber"]').scroll_into_view_if_needed()
        page.evaluate(
            """document.querySelector('figure[data-curve="camber"]')
            .scrollIntoView({ block: "start" })"""
        )
        for slider, value in positions():
            page.locator(slider).fill(f"{value:.0f}")
            page.wait_for_timeout(150)
            shot = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
            shots.append(shot.resize(SHOWN, Image.Resampling.LANCZOS))
    return shots


def palette_of(shot: Image.Image) -> Image.Image:
    """Return the most frequent colours that differ by 8 of 256 levels; bright ones count more."""
    colours, counts = np.unique(np.asarray(shot).reshape(-1, 3), axis=0, return_counts=True)
    weights = counts * (1 + np.ptp(colours.astype(int), axis=1))
    colours = colours[np.argsort(-weights, kind="stable")]
    _, first = np.unique(colours // 8, axis=0, return_index=True)
    palette = Image.new("P", (1, 1))
    palette.putpalette(colours[np.sort(first)[:256]].tobytes())
    return palette


def main() -> None:
    """Write the pictures."""
    for car, (name, height) in STILLS.items():
        with opened(car, width=1440, height=height) as page:
            page.wait_for_timeout(1000)
            page.screenshot(path=PICTURE.with_name(name))
    shots = frames()
    palette = palette_of(shots[0])
    pictures = [shot.quantize(palette=palette, dither=Image.Dither.NONE) for shot in shots]
    pictures[0].save(
        PICTURE, save_all=True, append_images=pictures[1:], duration=MILLISECONDS, loop=0
    )


if __name__ == "__main__":
    main()
