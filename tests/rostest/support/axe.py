# SPDX-License-Identifier: Apache-2.0
"""What axe, the checker of accessibility, finds on a page; see scripts/axe.

`self.assertEqual(axe.findings(self.page), [])` is all that a page's test has to say.
"""

import unittest
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
LIBRARY = ".venv/lib/python3*/site-packages/axe_playwright_python/axe.min.js"
RUN = """const [only, done] = arguments;
axe.run(only || document).then(({ violations }) => done(violations.flatMap((rule) =>
  rule.nodes.map((node) => `${rule.id}: ${node.target.join(' ')}: ${node.failureSummary}`))),
  (error) => done([String(error)]));"""


@cache
def library() -> str:
    """Returns the JavaScript of axe; skips the test where it is not installed."""
    libraries = sorted(ROOT.glob(LIBRARY))
    if not libraries:
        raise unittest.SkipTest("axe is not installed: scripts/axe does it")
    return libraries[-1].read_text(encoding="utf-8")


def is_there() -> bool:
    """Returns whether axe is installed: for a test that does more than look at its page."""
    return bool(sorted(ROOT.glob(LIBRARY)))


def findings(page, only=None, themes=("dark", "light")) -> list[str]:
    """Returns a sentence for each fault of a Browser's page, dark and light.

    only: a CSS selector; what is outside of it is not looked at.
    """
    if not page.driver.execute_script("return Boolean(window.axe)"):
        page.driver.execute_script(library())
    try:
        return [f"{theme}: {fault}" for theme in themes for fault in _seen_in(page, theme, only)]
    finally:
        page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})


def _seen_in(page, theme, only):
    page.wear(theme)
    return page.driver.execute_async_script(RUN, only)
