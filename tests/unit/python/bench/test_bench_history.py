# SPDX-License-Identifier: Apache-2.0
"""The benchmarks' history: what a run is compared with, and the tables made of it."""

import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from paths import ROOT

BENCH = ROOT / "bench"
sys.path.insert(0, str(BENCH))

import figures  # noqa: E402
import history  # noqa: E402
import readme  # noqa: E402
import table  # noqa: E402


def fleet(robot, arrays):
    """Returns a figure as fleet_bench and array_bench print it, by CPU."""
    rows = (("default", robot), ("arrays, 121 rays", arrays))
    return [
        {"engine": e, "robots": 1000, "lasers": True, "rtf": r / 2, "rtf_cpu": r, "read": True}
        for e, r in rows
    ]


class BenchHistoryTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.file = self.folder / "history.jsonl"

    def append(self, commit, parts):
        with mock.patch("history.commit", return_value=commit):
            history.History(self.file).append(parts, load=0.5)

    def test_a_run_is_compared_by_ratios_to_the_arrays_of_the_same_run(self):
        self.append("a1", {"fleet": figures.of("fleet", fleet(40, 20), arrays=20)})
        past = history.History(self.file)
        # A machine of half the speed: nothing is slower. Then a world of half the speed.
        halved = {"fleet": figures.of("fleet", fleet(20, 10), arrays=10)}
        self.assertIn("2.00 at a1", table.of_run(halved, past))
        self.assertNotIn("slower", table.of_run(halved, past))
        slower = {"fleet": figures.of("fleet", fleet(20, 20), arrays=20)}
        self.assertIn("2.0 x slower now", table.of_run(slower, past))

    def test_times_are_compared_the_other_way_round(self):
        start = {"stands_s": 4.0, "stands_cpu_s": 3.0, "import_s": 0.1, "import_cpu_s": 0.1}
        start |= {"create_s": 2.0, "create_cpu_s": 1.5, "create_gb": 0.3}
        self.append("a1", {"start": figures.of("start", start, arrays=20)})
        past = history.History(self.file)
        later = {"start": figures.of("start", start | {"import_s": 0.2}, arrays=20)}
        rows = table.of_run(later, past).splitlines()
        slower = [row for row in rows if "slower" in row]
        self.assertEqual(len(slower), 1)
        self.assertIn("| import kiva_plugin_cpp ", slower[0])
        self.assertIn("**not met**", slower[0])

    def test_each_figure_is_the_newest_that_was_measured(self):
        self.append("a1", {"fleet": figures.of("fleet", fleet(40, 20), arrays=20)})
        self.append("b2", {"fleet": figures.of("fleet", fleet(44, 20)[:1], arrays=20)})
        newest = history.History(self.file).newest("fleet")
        self.assertEqual(newest["default, N = 1,000"][0].value, 44)
        self.assertEqual(newest["arrays, 121 rays, N = 1,000"][1]["commit"], "a1")

    def test_tables_stand_between_marks_and_prose_stays(self):
        page = self.folder / "README.md"
        page.write_text("By hand.\n\n<!-- figures: fleet -->\nold\n<!-- end -->\n\nMore.\n")
        self.append("a1", {"fleet": figures.of("fleet", fleet(40, 20), arrays=20)})
        for _ in range(2):  # the second time changes nothing
            readme.update(history.History(self.file), page)
            text = page.read_text()
            self.assertTrue(text.startswith("By hand.\n") and text.endswith("\nMore.\n"))
            self.assertEqual(text.count("| default, N = 1,000 "), 1)
            self.assertNotIn("old", text)

    def test_a_part_without_a_place_is_an_error(self):
        page = self.folder / "README.md"
        page.write_text("No marks.\n")
        self.append("a1", {"fleet": figures.of("fleet", fleet(40, 20), arrays=20)})
        with self.assertRaisesRegex(ValueError, "no block for fleet"):
            readme.update(history.History(self.file), page)

    def test_every_part_has_a_place_in_the_page(self):
        blocks = {part for _, part, _ in readme.BLOCK.findall(readme.FILE.read_text())}
        self.assertEqual(blocks, set(figures.OF_PART))


if __name__ == "__main__":
    unittest.main()
