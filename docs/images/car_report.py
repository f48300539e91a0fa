"""Draw docs/images/car_report.png: ``python docs/images/car_report.py``.

The step steer in the report of the packaged car that drives. Needs Playwright and Chromium.
"""

import shutil
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from kintrafo.vehicle import cli
from PIL import Image
from playwright.sync_api import sync_playwright

WIDE, HIGH = 1300, 900
# Part of the manoeuvre that is over.
SHOWN = 0.3


def main() -> None:
    """Write the picture."""
    target = Path(__file__).with_suffix(".png")
    with TemporaryDirectory() as folder, sync_playwright() as driver:
        page_file = Path(folder) / "car.html"
        sys.argv = ["kintrafo", "report", "driving_car", str(page_file)]
        cli.run()
        browser = driver.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox"]
        )
        page = browser.new_page(viewport={"width": WIDE, "height": HIGH})
        page.goto(page_file.as_uri())
        player = page.locator("[data-player]").nth(1)
        last = int(player.locator("input.time").get_attribute("max") or 0)
        player.locator("input.time").fill(str(round(SHOWN * last)))
        player.locator("input.time").blur()
        heading = page.get_by_text("Step steer, 80 km/h")
        heading.evaluate("heading => window.scrollTo(0, heading.offsetTop - 16)")
        page.screenshot(path=target)
        browser.close()
    with Image.open(target) as picture:
        small = picture.convert("RGB").quantize(128)
    small.save(target, optimize=True)


if __name__ == "__main__":
    main()
