# SPDX-License-Identifier: Apache-2.0
"""Compares what a page looks like with a picture of before, made by scripts/pages/pictures.

Pictures are small: another Chromium draws letters otherwise, which a quarter of the size forgives;
what is gone, moved or of another colour it still shows.
"""

import io
import os
import unittest
from pathlib import Path

import numpy as np
from PIL import Image

FOLDER = Path(__file__).resolve().parents[2] / "pictures"
FONT = Path("/usr/share/fonts/truetype/inter-vf/Inter-roman.var.ttf")
SIZE, SMALLER = (1024, 640), 4  # of the window [px], and by how much pictures are smaller
NEAR = 24  # of 255: by which a colour may differ
MAY_DIFFER = 0.04  # of the pixels
WRITE = "WRITE_PICTURES"  # a variable of the environment


def compare(page, name, theme="light"):
    """Holds a Browser's page to the picture of that name; skips the test where fonts differ."""
    if not FONT.exists():
        raise unittest.SkipTest(f"pictures were made with {FONT}, which is not installed")
    screenshot, path = picture(page, theme), FOLDER / f"{name}.png"
    if os.environ.get(WRITE):
        FOLDER.mkdir(exist_ok=True)
        screenshot.quantize(64).save(path, optimize=True)
    part = difference(screenshot, Image.open(path).convert("RGB"))
    assert part <= MAY_DIFFER, (
        f"{part:.1%} of {name} differs from {path.name}; if it should: scripts/pages/pictures"
    )


def picture(page, theme):
    """Returns what is seen of a page, from its top, small."""
    width, height = SIZE
    metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
    page.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    page.wear(theme)
    page.driver.execute_async_script(
        "const [done] = arguments; document.fonts.ready.then(() =>"
        " requestAnimationFrame(() => requestAnimationFrame(done)))"
    )
    screenshot = Image.open(io.BytesIO(page.driver.get_screenshot_as_png())).convert("RGB")
    page.be_desktop()
    return screenshot.resize((width // SMALLER, height // SMALLER), Image.Resampling.BOX)


def difference(first, other):
    """Returns the part of the pixels of two pictures that differ."""
    if first.size != other.size:
        return 1.0
    apart = np.abs(np.asarray(first, int) - np.asarray(other, int)).max(axis=2)
    return float((apart > NEAR).mean())
