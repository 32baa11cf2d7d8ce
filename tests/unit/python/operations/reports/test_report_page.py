# SPDX-License-Identifier: Apache-2.0
"""Reports as people get them: in a browser, dark and light, on paper, in a spreadsheet."""

import base64
import io
import re
import shutil
import subprocess
import zipfile

import paths
import pytest
from instance_file import write_instance
from rostest_support import axe, pictures
from rostest_support.browser import browser

from warehouse_layout.drawing import page_font
from warehouse_operations.document import canvas, page, sheets, tokens
from warehouse_operations.reports import report
from warehouse_operations.runs.simulation import Description, simulate

DESIGN = paths.ROOT / "src" / "warehouse_viewer" / "web" / "design.css"
SIZE = paths.ROOT / "src" / "warehouse_operations" / "nodes" / "size"
PATIENCE = 60.0  # with a machine that has much to do [s]


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Two configurations of two seeds."""
    folder = tmp_path_factory.mktemp("runs")
    path = write_instance(folder / "a.xinst", bots=3, picking=2, replenishing=1, rows=3)
    return [
        simulate(
            Description(
                instance=str(path), seconds=900, physics=False, seed=seed, policies={"orders": name}
            ),
            folder / f"{name}-{seed}",
        )[0]
        for name in ("pile-on", "random")
        for seed in (1, 2)
    ]


@pytest.fixture(scope="module", params=["alone", "side-by-side"])
def file(request, runs, tmp_path_factory):
    """A report about one configuration, and one about two."""
    path = tmp_path_factory.mktemp("report") / f"{request.param}.html"
    return report.write(path, runs[:2] if request.param == "alone" else runs)


@pytest.fixture(scope="module")
def chromium():
    with browser(PATIENCE, (1024, 768)) as page_:
        yield page_


def printed(chromium, path):
    """The text of each sheet of a page that is printed."""
    printed_page = chromium.driver.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True})
    path.write_bytes(base64.b64decode(printed_page["data"]))
    text = subprocess.run(["pdftotext", "-layout", path, "-"], capture_output=True, check=True)
    return text.stdout.decode().split("\f")[:-1]


def test_reports_are_for_all_and_look_as_they_did(chromium, file):
    chromium.open(file.as_uri())
    assert axe.findings(chromium) == []
    pictures.compare(chromium, f"report-{file.stem}", "dark")
    for width in (1440, 1024, 390):
        chromium.be_phone(width)
        assert chromium.read("document.documentElement.scrollWidth") <= width
        shown = "[...document.querySelectorAll('svg')].filter((e) => e.checkVisibility()).length"
        assert chromium.read(shown) >= 6
    chromium.be_desktop()
    assert chromium.complaints() == []


def test_a_sizing_report_is_for_all(chromium, tmp_path):
    arguments = (
        "--layout small --orders-per-hour 120 --hours 1 --seeds 2 --late 20% --robots 6 --out"
    )
    subprocess.run([SIZE, *arguments.split(), tmp_path], check=True, capture_output=True)
    chromium.open((tmp_path / "report.html").as_uri())
    assert axe.findings(chromium) == []


def test_the_first_sheet_is_printed_alone_and_no_chart_is_cut(chromium, file, tmp_path):
    if not shutil.which("pdftotext"):
        pytest.skip("pdftotext is missing; poppler-utils has it")
    chromium.open(file.as_uri())
    pages = printed(chromium, tmp_path / "report.pdf")
    assert "Assumptions" in pages[0] and "Warm-up" in pages[0] and "Seeds" in pages[0]
    assert "Figures" not in pages[0] and "Figures" in pages[1]
    assert all(len(text.split()) > 20 for text in pages), "a sheet is empty"
    # What is above a chart and what is below it are on the same sheet.
    sheet = {words: [i for i, text in enumerate(pages) if words in text] for words in ENDS}
    for above, below in ENDS.items():
        below_it = [i for i, text in enumerate(pages) if below in text]
        assert sheet[above] and set(sheet[above]) <= set(below_it), (above, sheet[above], below_it)


ENDS = {
    "Orders done within a time": "minutes from arrival",
    "Share of the robots' time": "% of their time",
    "of each station": "% of the time at work",
}


def test_reports_are_written_in_the_design_of_the_pages():
    rules = DESIGN.read_text()
    dark, light = (
        dict(
            re.findall(r"--([a-z-]+): (#[0-9a-f]{6});", rules.partition(which)[2].partition("}")[0])
        )
        for which in (':root[data-theme="dark"] {', ':root[data-theme="light"] {')
    )
    for ours, theirs in ((tokens.DARK, dark), (tokens.LIGHT, light)):
        assert ours == {name: theirs[name] for name in ours}


def test_a_drawing_follows_the_theme():
    drawn = tokens.themed(f"fill:{tokens.colour('moving')};stroke:{tokens.series(1)};fill:#123456")
    assert drawn == "fill:var(--moving);stroke:var(--series-2);fill:#123456"
    assert tokens.css().count("--series-2:") == 2


def test_letters_at_the_ends_of_lines_do_not_cover_each_other():
    assert canvas.spread([5, 1], 2) == [5, 1]
    assert canvas.spread([1, 1, 1], 2) == [-1, 1, 3]
    assert canvas.spread([10, 1, 2, 2.5], 2) == pytest.approx(
        [10, -0.1666, 1.8333, 3.8333], abs=1e-3
    )


def test_what_is_told_is_no_markup():
    html = page.document(
        "<b>", "<b>", "<b>", page.opening("<b>", "<b>"), page.facts([("<b>", "<i>")])
    )
    assert "<b>" not in html and "<i>" not in html


def test_a_report_without_the_font_is_a_report(monkeypatch, tmp_path):
    monkeypatch.setattr(page_font, "FONT", tmp_path / "no.ttf")
    page_font.face.cache_clear()
    page_font.woff2.cache_clear()
    try:
        assert "@font-face" not in page.document("", "", "", "", "")
    finally:
        page_font.face.cache_clear()
    assert not page_font.FONT.exists()


def test_a_workbook_has_the_figures(runs, file):
    workbook = zipfile.ZipFile(file.with_suffix(".xlsx"))
    names = re.findall(r'<sheet name="(\w+)"', workbook.read("xl/workbook.xml").decode())
    assert names == ["figures", "throughput", "stations", "hours"]
    figures = workbook.read("xl/worksheets/sheet1.xml").decode()
    assert f"<v>{runs[0].kpis['items_picked'] * 4}</v>" in figures  # in a quarter of an hour
    assert sheets.to_xlsx({"a": [["b"], ["=1+1"]]}) == sheets.to_xlsx({"a": [["b"], ["=1+1"]]})
    inside = zipfile.ZipFile(io.BytesIO(sheets.to_xlsx({"a": [["b"], ["=1+1"], ["http://x"]]})))
    assert "<f>" not in inside.read("xl/worksheets/sheet1.xml").decode()
