"""Draw docs/images/report.gif: ``python docs/images/report_animation.py``.

The report of the packaged push-rod suspension in Chromium: its wheel moves through its travel, then
the rack through its own, and curves follow. Needs Chromium, and Playwright of the extra ``dev``.
"""  # noqa: INP001 (a script beside its picture)

import io
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory

import kintrafo
import numpy as np
from PIL import Image
from playwright.sync_api import sync_playwright

PICTURE = Path(__file__).with_name("report.gif")
SIZE = {"width": 1120, "height": 640}
SHOWN = (840, 480)
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


def frames(page_of_report: Path) -> list[Image.Image]:
    """Return pictures of the report in all positions."""
    shots = []
    with sync_playwright() as running:
        browser = running.chromium.launch(
            executable_path=shutil.which("chromium") or shutil.which("google-chrome"), args=OPTIONS
        )
        page = browser.new_page(viewport=SIZE, color_scheme="light")
        page.goto(page_of_report.as_uri())
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
        browser.close()
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
    """Write the picture."""
    with TemporaryDirectory() as folder:
        report = kintrafo.report.write(kintrafo.Model("push_rod_car"), Path(folder) / "report.html")
        shots = frames(report)
    palette = palette_of(shots[0])
    pictures = [shot.quantize(palette=palette, dither=Image.Dither.NONE) for shot in shots]
    pictures[0].save(
        PICTURE, save_all=True, append_images=pictures[1:], duration=MILLISECONDS, loop=0
    )


if __name__ == "__main__":
    main()
