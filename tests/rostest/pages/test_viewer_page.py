#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The page in the browser shows the warehouse and commands it."""

import csv
import io
import json
import math
import os
import tempfile
import time

import rospy
import rostest
from PIL import Image
from rostest_support import axe
from rostest_support.browser import SETTLES
from rostest_support.node_test import PATIENCE, Robot, wait_until
from rostest_support.page_test import PageTest
from rostest_support.warehouse_test import delete, model_file, place, pose, spawn
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

ROBOTS, UNITS, ITEMS = 4, 24, 96
FLOOR = (-10.5, 10.5, -6.5, 7.5)

STANDS = """(({{ robots, units, items }}) => robots.length === {robots} && units.length === {units}
  && items.length === {items})(page.world.scene)"""

# A free cell [x, y] over which a storage unit is drawn and no robot stands behind it, or null.
HIDDEN_CELL = """(() => {
  const [x0, x1, y0, y1] = page.stage.bounds;
  for (let x = Math.ceil(x0); x < x1; ++x) for (let y = Math.ceil(y0); y < y1; ++y) {
    const at = page.stage.pixelOf(x, y, 0);
    const hit = page.picker.pick(...at);
    if (page.picker.pick(...at, ['robot', 'scenery'])) continue;
    if (hit?.kind === 'unit' && page.world.unitAt([x, y]) < 0) return [x, y];
  }
  return null;
})()"""

# Until what was to be drawn is, and the display could have shown more.
TURNS = """const [done] = arguments, { pace } = window.page.stage;
  const frame = (then) => requestAnimationFrame(then);
  pace.rest.then(() => frame(() => frame(() => frame(done))))"""

# What can be tapped but is smaller than a finger's 44 px, or has nothing to read.
SMALL = """[...document.querySelectorAll('button, a, select, input, .row, .events li, .track')]
  .filter((e) => e.checkVisibility() && e.type !== 'checkbox' && !e.closest('dialog'))
  .filter((e) => {
    const { width, height } = e.getBoundingClientRect();
    return width < 44 || height < 44 || !(e.textContent.trim() || e.title || e.ariaLabel);
  }).map((e) => `${e.id || e.className || e.textContent} ${e.offsetWidth} x ${e.offsetHeight}`)"""

# How the floor is looked at: about the vertical [rad], and from how far [m].
TURNED = "page.stage.controls.getAzimuthalAngle()"
AWAY = "page.stage.camera.position.distanceTo(page.stage.controls.target)"


# How many bytes differ, by more than shadows in another order do, between the picture as it is
# drawn, upon the backdrop, and the whole drawn at once; and how many colours it has.
BACKDROP = """(() => {
  const { stage } = page, { renderer, scene, camera, backdrop } = stage, gl = renderer.getContext();
  const { width, height } = renderer.domElement;
  const pixels = (draw) => {
    draw();
    const out = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, out);
    return out;
  };
  const drawn = pixels(() => stage.render(performance.now()));
  backdrop.copy.visible = false;
  camera.layers.enable(1);
  const whole = pixels(() => renderer.render(scene, camera));
  backdrop.copy.visible = true;
  return [drawn.filter((byte, i) => i % 4 < 3 && Math.abs(byte - whole[i]) > 8).length,
    new Set(new Uint32Array(drawn.buffer)).size];
})()"""


# A colour of the design, and that of an element's ground.
COLOURS = """(() => {{
  const probe = document.body.appendChild(document.createElement('i'));
  probe.style.backgroundColor = '{}';
  const shown = [probe, document.getElementById('{}')]
    .map((e) => getComputedStyle(e).backgroundColor);
  probe.remove();
  return shown;
}})()"""
# A server that answers, and says nothing.
SILENT = """window.WebSocket = class extends EventTarget {
  static OPEN = 1;
  constructor() {
    super();
    Object.assign(this, { isSilent: true, readyState: 1 });
    setTimeout(() => this.dispatchEvent(new Event('open')));
  }
  send() {}
  close() {}
};"""
SILENT_FILTERS = ["all", "needs", "help", "waiting", "working", "moving", "resting"]


class ViewerPage(PageTest):
    ready = f"page.world.scene.robots.length === {ROBOTS} && page.stage.frames > 2"

    def tearDown(self):
        # A search flies to what it finds: the next test clicks where all is seen.
        self.page.read("[page.select(null), page.showAll(false)]")
        super().tearDown()

    def drawn(self, robot):
        """[x, y] of a robot in the picture."""
        return self.page.read(f"[...page.world.shown.slice({3 * (robot - 1)}, {3 * robot - 1})]")

    def test_shows_what_stands_there(self):
        scene = self.page.read("page.world.scene")
        self.assertEqual((len(scene["units"]), len(scene["items"])), (UNITS, ITEMS))
        for robot in range(1, ROBOTS + 1):
            for drawn, real in zip(self.drawn(robot), place(f"kiva{robot}")):
                self.assertAlmostEqual(drawn, real, places=3)
        self.assertEqual(self.page.read("page.list.rows.length"), ROBOTS)

    def test_a_processor_that_draws_gets_time_for_other_things(self):
        self.page.until("page.stage.pace.cost > 0")
        self.page.until("page.stage.pace.gap >= Math.min(500, 1.4 * page.stage.pace.cost)")
        self.page.until("page.connection.gap > 0")  # it wants no more updates than it shows

    def test_nothing_is_drawn_where_nothing_changes(self):
        self.page.click_on("pause")
        self.until_link("paused")
        before, frames, end = -1, 0, time.monotonic() + PATIENCE
        while frames != before:
            self.assertLess(time.monotonic(), end, "it is drawn again and again")
            before = self.page.read("page.stage.frames")
            self.page.driver.execute_async_script(TURNS)
            frames = self.page.read("page.stage.frames")
        self.page.click_on("pause")
        self.until_link("live")

    def test_is_not_blank(self):
        picture = Image.open(io.BytesIO(self.page.driver.get_screenshot_as_png()))
        middle = picture.convert("RGB").crop((290, 70, 990, 540))
        self.assertGreater(len(middle.getcolors(maxcolors=middle.width * middle.height)), 100)

    def test_upon_the_backdrop_the_picture_is_the_same(self):
        differ, colours = self.page.read(BACKDROP)
        self.assertLess(differ, 30)
        self.assertGreater(colours, 100)

    def test_a_click_selects_and_another_sends(self):
        x, y, _ = place("kiva1")
        shown = f"Math.hypot(page.world.shown[0] - {x}, page.world.shown[1] - {y}) < 0.01"
        self.page.until(shown)  # it is drawn where it stands
        self.page.click(x, y, 0.4)
        self.page.until("page.selected === 'kiva1'")
        # Off its street's end, where nothing stands between the camera and the floor.
        self.page.click(x, -6, 0.0)
        wait_until(lambda: abs(place("kiva1")[1] + 6) < 1e-3, "kiva1 at y = -6")
        self.page.until("document.getElementById('answer').dataset.kind === 'done'")
        self.page.until("Math.abs(page.world.shown[1] + 6) < 0.001")

    def test_says_why_a_command_is_refused(self):
        self.page.read("page.select('kiva2')")
        self.page.read("page.details.go(1000, 0, [640, 300]) && true")
        self.page.until("document.getElementById('answer').dataset.kind === 'refused'")
        self.assertIn("outside the floor", self.page.text("answer"))
        self.assertIn("outside the floor", self.page.text("tip"))

    def test_a_key_turns_the_selected_robot(self):
        self.page.read("page.select('kiva3')")
        before = self.page.read("page.world.pose[8]")
        self.page.type("q")
        self.page.until(f"Math.abs(Math.sin(page.world.pose[8] - {before}) - 1) < 0.001")

    def test_buttons_that_can_not_be_pressed_say_why(self):
        self.page.read("page.select('kiva2')")
        why = "document.getElementById('why')"
        self.page.until(f"{why}.checkVisibility()")
        self.assertIn("Drop: it carries no storage unit.", self.page.text("why"))
        self.page.read("(location.hash = 't=0.5', 0)")
        past = "Left, Right, Carry, Drop, Remove: the time line shows the past"
        self.page.until(f"{why}.textContent.startsWith('{past}')")
        self.page.click_on("replay-live")
        self.until_link("live")

    def test_a_robot_stopped_by_an_obstacle_needs_help(self):
        x, y, _ = place("kiva4")
        Robot(4).do("mov", x=x, y=4.0)
        spawn("person1", model_file("person"), pose(x + 2, 4.0))
        self.page.until("page.world.scene.scenery.includes('person1')")
        self.page.read("page.details.order('kiva4', 'movx', {distance: 4}) && true")
        self.page.until("page.world.activity[3] === 4")
        first = "document.querySelector('#robots .row')"
        self.page.until(f"{first}.textContent.startsWith('needs helpkiva4')")
        delete("person1")
        self.page.until("!page.world.scene.scenery.includes('person1')")
        Robot(4).do("movx", distance=1.0)
        self.page.until("page.world.activity[3] !== 4")

    # --- keys, one by one
    def test_a_person_types_into_the_search(self):
        self.page.type("unit 12" + Keys.ENTER, "search")
        self.assertEqual(self.page.read("document.getElementById('search').value"), "unit 12")
        self.page.until("page.selected === 'storage_unit12'")
        self.page.type(Keys.BACKSPACE * 7 + "kiva2" + Keys.ENTER)
        self.page.until("page.selected === 'kiva2'")
        self.page.type(Keys.BACKSPACE * 5 + Keys.ESCAPE)
        self.page.until(f"page.list.rows.length === {ROBOTS}")

    def test_the_search_finds_stations_and_selects_nothing_that_is_not_there(self):
        self.page.type("pick2" + Keys.ENTER, "search")
        self.page.until("page.selected === 'pick2' && page.details.thing.kind === 'station'")
        self.page.until("!page.navigator.flight && page.overlays.ring.visible")
        self.assertIn("no shift is running", self.page.text("facts"))
        self.page.type(Keys.ESCAPE)
        self.page.until("page.selected === null")
        self.page.type("pick77" + Keys.ENTER, "search")
        self.page.read("page.list.showPieces('pick77', new Map())")
        self.page.type(Keys.ENTER)
        self.assertEqual(self.page.read("page.selected"), None)
        self.page.type(Keys.ESCAPE)

    def test_a_click_on_a_sign_selects_its_station(self):
        self.page.read("page.showAll(false)")
        signs = "[...document.querySelectorAll('#labels .sign:not([hidden])')]"
        self.page.until(f"{signs}.some((s) => s.textContent === 'pick1')")
        box = f"{signs}.find((s) => s.textContent === 'pick1').getBoundingClientRect().toJSON()"
        time.sleep(SETTLES)
        sign = self.page.read(box)
        self.page.click_at(sign["x"] + sign["width"] / 2, sign["y"] + sign["height"] / 2)
        self.page.until("page.selected === 'pick1'")

    def test_space_pauses_whatever_was_clicked_before(self):
        self.page.click_on("trails")
        self.page.until("page.trails?.isOn")
        self.page.type(Keys.SPACE)
        self.until_link("paused")
        self.assertTrue(self.page.read("page.trails?.isOn"))
        self.page.read("page.drawers.open('log-panel')")
        self.page.click_on("trouble")
        self.page.type(Keys.SPACE)
        self.until_link("live")
        self.page.click_on("trails")

    def test_space_presses_what_the_tab_key_reached(self):
        self.page.click_on("search")
        self.page.type(Keys.TAB * 2)
        self.assertEqual(self.page.read("document.activeElement.dataset.filter"), "4")
        self.page.type(Keys.SPACE)
        self.page.until("page.list.filter === '4'")
        self.page.read("page.list.setFilter('')")
        self.page.read("document.activeElement.blur()")

    def test_the_picture_goes_by_keys(self):
        self.page.read("page.stage.canvas.focus()")
        chosen = set()
        for key in (Keys.ARROW_RIGHT, Keys.ARROW_LEFT, Keys.ARROW_UP, Keys.ARROW_DOWN):
            self.page.type([key])
            chosen.add(self.page.read("page.selected"))
            self.assertIn(self.page.read("page.selected"), self.page.text("spoken"))
        self.assertGreater(len(chosen), 1)
        self.page.until("page.overlays.ring.visible")
        # While its panel grows, the picture moves aside so that the robot isn't covered.
        self.page.until("performance.now() - page.chosenAt > 2000")
        self.page.type(Keys.ENTER)
        self.page.until("!page.navigator.flight")
        centre = "page.stage.controls.target.distanceTo(page.overlays.ring.position)"
        self.page.until(f"{centre} < 0.5")
        self.page.type("h")

    def test_above_lies_as_all_does(self):
        for view in ("h", "t"):
            self.page.type(view)
            left, right = self.page.pixel(*FLOOR[:1], 0), self.page.pixel(FLOOR[1], 0)
            low, high = self.page.pixel(0, FLOOR[2]), self.page.pixel(0, FLOOR[3])
            self.assertTrue(left[0] < right[0] and high[1] < low[1], view)
        self.assertTrue(self.page.read("page.stage.camera.isOrthographicCamera"))
        x, y, _ = place("kiva2")
        self.page.click(x, y, 0.4)
        self.page.until("page.selected === 'kiva2'")
        self.page.type("h")

    def test_drawers_are_as_one_left_them(self):
        self.page.read("page.drawers.open('log-panel')")
        self.page.type("1")
        self.page.until("!page.drawers.isOpen('list-panel')")
        self.page.read("location.reload()")
        self.page.until(self.ready)
        self.assertTrue(self.page.read("page.drawers.isOpen('log-panel')"))
        self.assertFalse(self.page.read("page.drawers.isOpen('list-panel')"))
        self.page.type("14")
        self.page.until("page.drawers.isOpen('list-panel') && !page.drawers.isOpen('log-panel')")

    def test_the_floor_follows_the_theme_of_the_system(self):
        self.page.read("localStorage.removeItem('theme')")
        command = "Emulation.setEmulatedMedia"
        self.addCleanup(self.page.driver.execute_cdp_cmd, command, {"features": []})
        background = "page.stage.scene.background.getHex()"
        themes = []
        for theme in ("dark", "light", "dark"):
            feature = {"name": "prefers-color-scheme", "value": theme}
            self.page.driver.execute_cdp_cmd(command, {"features": [feature]})
            self.page.until(f"document.documentElement.dataset.theme === '{theme}'")
            self.page.until(f"{background} !== {themes[-1] if themes else -1}")
            themes.append(self.page.read(background))
        self.assertEqual(themes[0], themes[2])

    def test_axe_finds_nothing(self):
        self.page.read("[page.select('kiva1'), page.drawers.open('log-panel')]")
        self.assertEqual(axe.findings(self.page), [])

    # --- clicks
    def test_an_aisle_behind_units_can_be_clicked(self):
        # Straight behind a row of units, as seen from the default view.
        hidden = self.page.until(HIDDEN_CELL)  # units may still be on their way to the page
        self.page.read("page.select('kiva1')")
        self.page.click(*hidden)
        self.page.until("!document.getElementById('answer').hidden")
        self.assertEqual(self.page.read("page.selected"), "kiva1")
        x, y = hidden
        wait_until(lambda: math.dist(place("kiva1")[:2], hidden) < 1e-3, f"kiva1 at {x}, {y}")
        self.page.until("document.getElementById('answer').dataset.kind === 'done'")

    def test_a_click_beside_the_floor_keeps_the_selection(self):
        self.page.read("page.select('kiva2')")
        self.page.click(*self.page.read("[page.stage.bounds[0] - 1, page.stage.bounds[3] + 2]"))
        self.assertEqual(self.page.read("page.selected"), "kiva2")

    def test_the_selected_is_named_and_the_near_have_numbers(self):
        self.page.read("page.select('kiva2')")
        labels = (
            "[...document.querySelectorAll('#labels span:not([hidden])')].map(s => s.textContent)"
        )
        self.page.read("page.showAll(false)")
        names = ["kiva2", "pick1", "pick2", "replenish1"]
        self.page.until(f"{names}.every((name) => {labels}.includes(name))")
        # The others, wherever tests before this one have sent them, as far as they are seen large.
        self.assertLessEqual({*self.page.read(labels)} - {*names}, {"1", "3", "4"})

    # --- the simulation
    def until_link(self, state):
        self.page.until(f"document.getElementById('link').dataset.state === '{state}'")

    def test_the_past_is_seen_while_the_simulation_goes_on(self):
        self.page.until("!document.getElementById('timeline').hidden")
        then, before = self.page.read("page.world.stamp"), self.drawn(2)
        Robot(2).do("movx", distance=-1.0)
        self.page.until(f"Math.abs(page.world.shown[3] - {before[0] - 1}) < 0.01")
        # Back by the keyboard, as far as the moment before.
        self.page.driver.find_element("id", "replay-track").send_keys(Keys.ARROW_LEFT)
        self.page.until("document.body.classList.contains('replaying')")
        self.page.read(f"(location.hash = 't={then}', 1)")
        self.page.until(f"Math.abs(page.world.shown[3] - {before[0]}) < 0.01")
        self.assertEqual(self.page.read("page.timeline.player.time"), then)
        self.assertIn(
            "back to Live first", self.page.read("document.getElementById('pause').title")
        )
        self.assertAlmostEqual(place("kiva2")[0], before[0] - 1, places=3)
        self.page.click_on("replay-play")
        self.page.until(f"page.world.stamp > {then} + 0.5")
        self.page.click_on("replay-live")
        self.until_link("live")
        self.page.until(f"Math.abs(page.world.shown[3] - {before[0] - 1}) < 0.01")
        self.page.until("!document.getElementById('pause').disabled")
        Robot(2).do("movx", distance=1.0)

    def test_a_link_holds_the_moment_the_selection_and_the_camera(self):
        self.page.until("page.timeline.track.end - page.timeline.track.begin > 5")
        self.page.read("page.find('kiva2')")
        self.page.until("!page.navigator.flight")
        target = "page.stage.controls.target.toArray()"
        camera, then = self.page.read(target), self.page.read("page.world.stamp - 1")
        self.page.read("(page.tip.say = () => {}, navigator.clipboard.writeText = undefined, 0)")
        self.page.click_on("replay-copy")
        self.page.until("location.hash.includes('&see=kiva2&from=')")
        link = self.page.read("location.href")
        self.page.open("about:blank")
        self.page.open(link)
        self.page.until(
            "page.selected === 'kiva2' && document.body.classList.contains('replaying')"
        )
        self.page.until(f"{target}.every((n, i) => Math.abs(n - {camera}[i]) < 0.02)")
        self.assertGreaterEqual(self.page.read("page.timeline.player.time"), then)
        self.page.click_on("replay-live")
        self.until_link("live")

    def test_a_mark_is_meant_by_a_click_beside_it(self):
        self.page.until("page.timeline.track.end - page.timeline.track.begin > 10")
        track = "page.timeline.track"
        # Between two looks for new marks, which come every ten seconds.
        self.page.read(
            f"({track}.setMarks([{{time: ({track}.begin + {track}.end) / 2, kind: 'ALARM',"
            " model: 'kiva1', text: ''}]), page.timeline.refresh = () => {}, 0)"
        )
        box = self.page.read(f"{track}.marks.firstChild.getBoundingClientRect().toJSON()")
        mark = self.page.read(f"Number({track}.marks.firstChild.dataset.time)")
        self.page.click_at(box["x"] + box["width"] / 2 + 9, box["y"] + 20)
        self.page.until("document.body.classList.contains('replaying')")
        self.page.until(
            f"Math.abs(page.timeline.player.time - Math.max({track}.begin, {mark} - 1)) < 0.2"
        )
        self.page.click_on("replay-live")
        self.until_link("live")
        self.page.read("location.reload()")
        self.page.until(self.ready)

    def test_pauses(self):
        self.page.click_on("pause")
        self.until_link("paused")
        self.page.click_on("pause")
        self.until_link("live")

    def test_a_status_may_come_before_the_answer_to_its_click(self):
        self.page.read(
            "(window.isAnswered = false, window.sent = window.fetch,"
            " window.fetch = async (...request) => {"
            " const answer = await window.sent(...request);"
            " await new Promise((done) => setTimeout(done, 1500));"
            " window.isAnswered = true; return answer; },"
            # As if the answer to another click had come just now.
            " page.bar.clicks.note('paused', page.bar.clicks.begin('paused'), false), 0)"
        )
        self.page.click_on("pause")
        self.until_link("paused")
        self.assertFalse(self.page.read("window.isAnswered"))
        self.page.until("window.isAnswered")
        self.page.read("(window.fetch = window.sent, 0)")
        self.page.click_on("pause")
        self.until_link("live")

    def test_what_is_sent_while_time_stands_still_says_so(self):
        self.page.click_on("pause")
        self.until_link("paused")
        self.page.read("page.select('kiva3')")
        self.page.type("q")
        self.page.until(
            "document.getElementById('answer').textContent.includes('simulation is paused')"
        )
        self.page.click_on("pause")
        self.page.until("document.getElementById('answer').dataset.kind === 'done'")

    def test_reset_asks_and_can_be_undone(self):
        x, y, _ = place("kiva2")
        Robot(2).do("movx", distance=-1.0)
        self.page.click_on("reset")
        self.page.until("document.getElementById('question').open")
        self.page.type(Keys.ESCAPE)
        self.page.until("!document.getElementById('question').open")
        self.assertAlmostEqual(place("kiva2")[0], x - 1, places=3)
        self.page.click_on("reset")
        self.page.until("document.getElementById('question').open")
        # What can't be meant by a key in haste: red, and Cancel has the focus.
        self.assertEqual(self.page.read("document.activeElement.id"), "question-no")
        red = self.page.read(COLOURS.format("var(--needs-help)", "question-yes"))
        self.assertEqual(red[0], red[1])
        self.page.click_on("question-yes")
        wait_until(lambda: math.dist(place("kiva2")[:2], (x, y)) < 1e-3, "a reset")
        self.page.until("!document.getElementById('notice').hidden")
        self.page.driver.find_element("css selector", "#notice button").click()
        wait_until(lambda: math.dist(place("kiva2")[:2], (x - 1, y)) < 1e-3, "the reset undone")
        Robot(2).do("movx", distance=1.0)

    def test_undo_is_offered_only_where_it_works(self):
        # The world keeps no checkpoints of its own here.
        self.page.until("document.getElementById('undo').disabled")
        self.assertIn("autosave", self.page.read("document.getElementById('undo').title"))

    def test_steps(self):
        self.page.click_on("pause")
        self.until_link("paused")
        before = self.page.read("page.world.stamp")
        self.page.click_on("step")
        self.page.until(f"page.world.stamp > {before} + 0.05")
        self.page.click_on("pause")
        self.until_link("live")

    def test_goes_back_to_a_checkpoint(self):
        robot, tip = Robot(3), "document.getElementById('tip').textContent"
        self.page.read("document.getElementById('checkpoint').click()")
        self.page.until(f"{tip} === 'checkpoint saved'")
        x = place("kiva3")[0]
        robot.do("movx", distance=1.0)
        self.page.until(f"Math.abs(page.world.shown[6] - {x + 1}) < 0.01")
        self.page.read("document.getElementById('restore').click()")
        self.page.until(f"Math.abs(page.world.shown[6] - {x}) < 0.01")

    def test_shows_scan_and_path_of_the_selected(self):
        self.page.read("page.select('kiva2')")
        self.page.click_on("scan")
        self.page.until("page.overlays.fan.visible")
        # From where the laser is mounted.
        mount = self.page.read("page.scans.get(2).mount")
        for reported, real in zip(mount, (0.38, 0.0, 0.2, 0.0)):
            self.assertAlmostEqual(reported, real, places=5)
        self.page.click_on("scan")
        self.assertFalse(self.page.read("page.overlays.fan.visible"))

    # --- what stands there
    def test_a_robot_comes_where_it_is_clicked_and_goes(self):
        self.page.click_on("add")
        self.page.click(2, -4)
        self.page.until(f"page.world.scene.robots.length === {ROBOTS + 1}")
        self.assertEqual(place(f"kiva{ROBOTS + 1}")[:2], (2, -4))
        self.page.read(f"page.select('kiva{ROBOTS + 1}')")
        self.page.click_on("remove")
        self.page.until("document.getElementById('question').open")
        self.page.click_on("question-yes")
        self.page.until(f"page.world.scene.robots.length === {ROBOTS}")

    def test_a_person_comes_where_it_is_clicked_and_walks(self):
        self.page.click_on("add-person")
        self.page.click(2, -4)
        self.page.until("page.world.scene.scenery.includes('person1')")
        self.addCleanup(delete, "person1")
        self.assertEqual(place("person1")[:2], (2, -4))
        self.page.read("page.select('person1')")
        self.page.click(2, -6, 0.0)
        wait_until(lambda: abs(place("person1")[1] + 6) < 1e-3, "person1 at y = -6")
        self.page.until("page.world.placeOf(page.details.thing)[1] < -5.9")

    def test_builds_a_warehouse(self):
        self.build("custom", robots=3, shelves=10, items=20)
        self.page.until(STANDS.format(robots=3, units=10, items=20))
        self.page.until("document.getElementById('warehouse').textContent === 'mine'")
        self.build("small")
        self.page.until(STANDS.format(robots=ROBOTS, units=UNITS, items=ITEMS))

    def test_the_dialog_begins_with_what_stands_here_and_says_what_is_lost(self):
        self.open_builder()
        self.page.until("document.getElementById('size').value === 'small'")
        self.assertTrue(self.page.read("document.getElementById('plan-loss').hidden"))
        self.page.driver.find_element("css selector", "#plan .answers button").click()
        self.page.until("!document.getElementById('builder').open")
        # As with a robot more, and a fleet at work.
        self.page.read(
            "(page.builder.present = () =>"
            " ({robots: 5, shelves: 24, items: 96, isWorking: true}), 0)"
        )
        self.open_builder()
        self.page.until("document.getElementById('own-robots').value === '5'")
        self.page.until("document.getElementById('size').value === ''")
        self.assertIn("5 robots are at work here", self.page.text("plan-loss"))
        self.page.driver.find_element("css selector", "#plan .answers button").click()
        self.page.read("(page.builder.present = () => page.present(), 0)")

    def test_the_dialog_says_why_a_warehouse_can_not_be_built(self):
        self.build("custom", robots=3, shelves=0, items=20)
        answer_text = "document.getElementById('plan-answer').textContent"
        self.page.until(f"{answer_text} === '20 items, but no shelves to lay them on'")
        self.assertTrue(self.page.read("document.getElementById('builder').open"))
        self.assertIn("at most 20,000", self.page.text("counts"))
        Select(self.page.driver.find_element("id", "size")).select_by_visible_text("medium")
        self.page.until("document.getElementById('own-shelves').value === '160'")
        self.page.driver.find_element("css selector", "#plan .answers button").click()
        self.page.until("!document.getElementById('builder').open")

    def open_builder(self):
        self.page.click_on("build")
        self.page.until("document.getElementById('builder').open")

    def build(self, size, **counts):
        self.open_builder()
        Select(self.page.driver.find_element("id", "size")).select_by_visible_text(size)
        for name, count in counts.items():
            self.page.type(Keys.BACKSPACE * 4 + str(count), f"own-{name}")
        self.page.driver.find_element("css selector", "#plan .danger").click()

    # --- the log as a file
    def test_saves_the_events(self):
        Robot(3).do("rot", direction=1)
        with tempfile.TemporaryDirectory() as folder:
            where = {"behavior": "allow", "downloadPath": folder}
            self.page.driver.execute_cdp_cmd("Page.setDownloadBehavior", where)
            self.page.read("page.drawers.open('log-panel')")
            for link in self.page.driver.find_elements("css selector", "a[download]"):
                link.click()
            files = [os.path.join(folder, f"events.{kind}") for kind in ("csv", "json")]
            wait_until(lambda: all(map(os.path.exists, files)), "both files")
            with open(files[0], newline="") as table:
                rows = list(csv.DictReader(table))
            with open(files[1]) as text:
                events = json.load(text)["events"]
        self.assertEqual([int(row["id"]) for row in rows], [event["id"] for event in events])
        self.assertIn(("kiva3", "DONE"), [(row["model"], row["kind"]) for row in rows])


class Loading(PageTest):
    """The page of a server that answers and has not sent its warehouse yet."""

    ready = "page.world.scene.robots.length > 0"

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        command, script = "Page.addScriptToEvaluateOnNewDocument", {"source": SILENT}
        added = cls.page.driver.execute_cdp_cmd(command, script)
        cls.page.read("location.reload()")
        cls.page.until("page.connection.socket.isSilent")
        cls.page.driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", added)

    def test_nothing_is_said_that_is_not_known(self):
        self.page.until("document.getElementById('link').textContent === 'loading …'")
        self.assertEqual(self.page.text("filters").split(), SILENT_FILTERS)
        speed = "document.getElementById('speed').selectedOptions[0].textContent"
        self.assertEqual(self.page.read(speed), "–")
        self.assertIn("loading", self.page.read("document.getElementById('pause').title"))


class Phone(PageTest):
    """The same in a small window that is tapped at."""

    ready, is_phone = ViewerPage.ready, True

    def test_a_tap_on_a_robot_opens_what_is_known_of_it(self):
        self.page.tap(*self.page.pixel(*place("kiva3")[:2], 0.3))
        self.page.until("page.selected === 'kiva3'")
        self.page.until("document.getElementById('details-panel').classList.contains('open')")
        self.page.tap_until("close", "page.selected === null")

    def test_everything_is_as_large_as_a_finger_and_has_a_name(self):
        self.page.read("page.select('kiva1')")
        for drawer in ("details-panel", "list-panel", "log-panel", "view-panel"):
            self.page.read(f"page.drawers.open('{drawer}') ?? true")
            small = self.page.read(SMALL)
            self.assertEqual(small, [], drawer)
        self.page.read("page.select(null)")

    def test_fingers_turn_the_floor_spread_it_and_push_it(self):
        """One turns, two that part bring it near, two side by side push; none of it is a tap."""
        self.page.read("page.showAll(false)")
        before = self.view()
        self.page.swipe([(150, 400), (190, 400), (230, 400)])
        self.page.until(f"Math.abs({TURNED} - {before['turned']}) > 0.1")
        left, right = [(150, 400), (110, 400), (70, 400)], [(240, 400), (280, 400), (320, 400)]
        self.page.swipe(left, right)
        self.page.until(f"{AWAY} < 0.7 * {before['away']}")
        x, y = self.view()["target"]
        self.page.swipe([(150, 400), (150, 450)], [(240, 400), (240, 450)])
        target = "page.stage.controls.target"
        self.page.until(f"Math.hypot({target}.x - {x}, {target}.y - {y}) > 0.5")
        self.assertEqual(self.page.read("page.selected"), None)
        self.page.read("page.showAll(false)")

    def view(self):
        return self.page.read(f"""{{turned: {TURNED}, away: {AWAY},
            target: page.stage.controls.target.toArray().slice(0, 2)}}""")

    def test_the_time_line_follows_a_finger(self):
        self.page.until("page.timeline.track.end - page.timeline.track.begin > 5")
        track = self.page.read(
            "document.getElementById('replay-track').getBoundingClientRect().toJSON()"
        )
        at = lambda part: (track["left"] + part * track["width"], track["y"] + 22)  # noqa: E731
        self.page.swipe([at(0.9), at(0.6), at(0.25)])
        self.page.until("document.body.classList.contains('replaying')")
        part = "(({begin, end}) => (page.timeline.player.time - begin) / (end - begin))"
        self.page.until(f"Math.abs({part}(page.timeline.track) - 0.25) < 0.05")
        self.page.until("document.querySelector('#replay-track .at').hidden")
        self.page.tap_until("replay-live", "!document.body.classList.contains('replaying')")

    def test_reset_lies_apart_from_undo(self):
        undo, reset = (
            self.page.read(f"document.getElementById('{i}').getBoundingClientRect().toJSON()")
            for i in ("undo", "reset")
        )
        self.assertGreaterEqual(reset["left"] - undo["right"], 8)

    def test_the_floor_fills_the_width(self):
        corners = [(x, y) for x in FLOOR[:2] for y in FLOOR[2:]]
        across = [self.page.pixel(*corner)[0] for corner in corners]
        self.assertGreater(max(across) - min(across), 0.85 * 390)
        self.assertTrue(all(0 <= x <= 390 for x in across))


if __name__ == "__main__":
    rospy.init_node("test_viewer_page")
    rostest.rosrun("warehouse_tests", "viewer_page", __name__)
