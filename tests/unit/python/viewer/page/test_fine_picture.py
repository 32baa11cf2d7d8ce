# SPDX-License-Identifier: Apache-2.0
"""The fine picture of the floor: off where the processor draws, with nothing left of it when it is
switched off, and the same robots, units and colours beneath."""

import subprocess
import sys
from contextlib import contextmanager

import pytest
from paths import ROOT
from rostest_support.browser import browser

VIEWER = ROOT / "src/warehouse_viewer"
PATIENCE = 90.0  # with a machine that has much to do [s, wall]
DRAWN = "page.timeline?.player?.chunk && page.stage.frames > 1"
MATERIALS = (
    "page.actors.crowds.flatMap((crowd) => crowd.layers.map(({ material }) => material.type))"
)
LAYERS = "page.actors.robots.crowd.layers"
RINGS = f"{LAYERS}.indexOf(page.fine.marks.layers[0])"
LOADED = "page.world.scene.robots.filter((_, i) => page.world.loadOf(i) >= 0).length"


@contextmanager
def served():
    recording = VIEWER / "web/recordings/at_work.kiva"
    command = [sys.executable, VIEWER / "nodes/replay", recording, "--port", "0", "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        try:
            yield server.stdout.readline().split("browser: ")[1].split()[0]
        finally:
            server.terminate()


@pytest.fixture(scope="module")
def page():
    with served() as url, browser(PATIENCE) as page:
        page.url = url
        yield page


def test_a_processor_draws_the_plain_picture_and_the_page_says_so(page):
    page.open(page.url)
    page.until(DRAWN)
    page.until("document.getElementById('quality').textContent.startsWith('plain, drawn without')")
    assert page.read("document.getElementById('fine').disabled")
    assert not page.read("Boolean(page.fine)")
    assert not page.read("performance.getEntries().some(({ name }) => name.includes('/js/fine/'))")
    assert not page.read("page.stage.renderer.shadowMap.enabled")


def test_a_card_draws_shadows_rings_walls_and_fog_and_takes_them_away(page):
    page.open("about:blank")
    page.open(f"{page.url}?picture=fine")
    page.until(DRAWN)
    page.until("page.fine?.isOn")
    assert page.read("page.stage.renderer.shadowMap.enabled && page.stage.sun.castShadow")
    assert "MeshStandardMaterial" in page.read(MATERIALS)
    page.until(f"page.actors.robots.crowd.parts[0].copies[{RINGS}]?.drawn >= {LOADED}")
    assert page.read(LOADED) > 0
    page.until("page.stage.scene.fog && page.fine.ground.group.children.length === 5")
    page.click_on("top")
    page.until("page.stage.isAbove && !page.stage.scene.fog")
    page.click_on("fine")
    page.until("!page.fine.isOn")
    assert not page.read("page.stage.renderer.shadowMap.enabled || page.stage.sun.castShadow")
    assert "MeshStandardMaterial" not in page.read(MATERIALS)
    assert not page.read("page.fine.ground.group.visible || page.fine.sunlight.sheet.visible")
    assert page.read(f"{RINGS}") == -1
    page.until("page.stage.floor.material.map === null")
    page.click_on("fine")
    page.until("page.fine.isOn")
    for theme, is_night in (("dark", True), ("light", False)):
        page.wear(theme)
        page.until(f"page.fine.marks.beam.visible === {str(is_night).lower()}")
    assert page.complaints() == []


# How many corners the geometry of units near by has, and of robots; and how many shades boxes have.
CORNERS = """[page.actors.units, page.actors.robots.crowd].map((crowd) => crowd.layers.find(
  ({ levels, place, order }) => levels === 2 && !place && order === 0,
).geometry.attributes.position.count)"""
SHADES = """new Set(page.world.scene.items.map((_, i) => (
  page.actors.items.tint.slice(4 * i, 4 * i + 3).join()))).size"""


def test_a_card_draws_racks_with_beams_bevelled_robots_and_boxes_of_many_shades(page):
    page.until("page.fine?.isOn")
    assert page.read(SHADES) == 8
    racks, robots = page.read(CORNERS)
    detail = page.read("page.actors.units.detail")
    page.click_on("fine")
    page.until("!page.fine.isOn")
    plain_units, plain_robots = page.read(CORNERS)
    boards, box = 4, 36
    assert racks == plain_units + boards * 4 * box + (boards - 1) * 2 * box
    assert robots > 1.3 * plain_robots
    assert page.read("page.actors.units.detail") > detail
    page.click_on("fine")
    page.until("page.fine.isOn")
    assert page.read(CORNERS) == [racks, robots]
    unit = "page.world.placeOf({kind: 'unit', index: 3})"
    page.read(f"page.navigator.visit({unit}) ?? true")
    page.until("page.actors.units.parts.some(({ copies }) => copies[1]?.drawn)")
    assert page.complaints() == []


def test_numbers_are_printed_on_the_units_near_by(page):
    page.until("page.fine?.isOn")
    page.read("page.showAll(false) ?? true")
    page.until("page.fine.numbers.plates.every((plate) => !plate.visible)")
    unit = "page.world.placeOf({kind: 'unit', index: 3})"
    page.read(f"page.navigator.visit({unit}) ?? true")
    page.until("page.fine.numbers.plates.some((plate) => plate.visible)")
    assert page.complaints() == []
