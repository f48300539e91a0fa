"""A real browser: how a test opens a report in it, moves what moves, and reads what is shown."""

import re
import shutil
import time
from contextlib import contextmanager

import numpy as np
import pytest

CHROMIUM = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
)
needs_chromium = [
    pytest.mark.browser,
    pytest.mark.skipif(
        CHROMIUM is None, reason="Chromium is not installed (apt-get install chromium)"
    ),
]
QUIET = [
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
# WebGL drawn by the processor, so that it is there on every machine
SOFTWARE_GL = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
DESKTOP = {"width": 1440, "height": 900}
PHONE = {"width": 390, "height": 844}


@contextmanager
def running(driver, *arguments):
    """Run a browser with some arguments, without a network of its own."""
    with driver.launch(executable_path=CHROMIUM, args=[*QUIET, *arguments]) as launched:
        yield launched


class Watched:
    """A page, its errors, and its requests."""

    def __init__(self, browser, report, **context):
        self.context = browser.new_context(**{"viewport": DESKTOP, **context})
        self.page = self.context.new_page()
        self.complaints, self.requests = [], []
        self.page.on("console", lambda message: self.complaints.append(message.text))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.goto(report.as_uri())
        assert self.page.locator("#view").count(), self.complaints

    def state(self):
        return self.page.evaluate("kintrafo.state()")

    def start_again(self):
        """Put back what a person can move."""
        self.page.set_viewport_size(DESKTOP)
        self.page.emulate_media(color_scheme="light", media="screen")
        self.page.mouse.move(0, 0)
        self.page.locator("#speed").select_option("0.1")
        self.page.evaluate(START_AGAIN)
        self.complaints.clear()


START_AGAIN = """() => {
    kintrafo.pause();
    kintrafo.set({ time: 0 });
    kintrafo.set({ travel: 0, rack: 0 });
    kintrafo.look("corner");
    document.activeElement.blur();
    window.scrollTo(0, 0);
}"""


def slide(page, slider, millimetres):
    """Move a slider as a person would: its value, and the event of letting it."""
    page.locator(slider).fill(str(millimetres))


def show(page, curve):
    """Scroll to a chart and return its parts; charts out of sight are not drawn."""
    figure = page.locator(f'figure[data-curve="{curve}"]')
    figure.scroll_into_view_if_needed()
    figure.locator(".marker").wait_for(state="visible")
    return figure


def until(condition, seconds=20.0):
    """Wait for the scripts of the page; its security policy forbids waiting inside of it."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.02)


def pixels(figure):
    return figure.locator("canvas").evaluate("canvas => canvas.toDataURL()")


def number(text):
    return float(re.match(r"[\u2212+]?[\d.]+", text).group().replace("\u2212", "-"))


def luminance(colour):
    """Relative luminance of an sRGB colour, by the formula of WCAG 2."""
    values = np.array([float(v) for v in re.findall(r"[\d.]+", colour)[:3]]) / 255.0
    linear = np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])
