#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The HTTP API tells and does what ROS does, with the same refusals."""

import asyncio
import csv
import io
import json
import unittest

import rosgraph
import rospy
import rostest
import websockets
from rostest_support.node_test import PATIENCE, wait_until
from rostest_support.page_test import address, ask, fetch
from rostest_support.warehouse_test import place

from warehouse_client.commands import COMMANDS
from warehouse_msgs.msg import Rotate

POSES = 1e-3  # [m]


def command(robot, name, wait="end", **fields):
    return ask(f"/robots/{robot}/commands?wait={wait}", {"command": name, **fields})


class ViewerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        wait_until(lambda: ask("/warehouse")[1].get("items") == 96, "the small warehouse")
        wait_until(lambda: "create" not in ask("/warehouse")[1]["lacks"], "who builds others")

    def tearDown(self):
        ask("/simulation/resume", {})

    def refused(self, status, text, answer):
        self.assertEqual(answer[0], status, answer)
        self.assertIn(text, str(answer[1]["detail"]))


class WhoCommanded(ViewerTest):
    def test_the_world_alone_listens_for_commands(self):
        """A client that waits for one connection has that to the world."""
        _, listeners, _ = rosgraph.Master(rospy.get_name()).getSystemState()
        for name in COMMANDS:
            topic = rospy.resolve_name(name)
            self.assertEqual(dict(listeners)[topic], [rospy.resolve_name("gazebo")], topic)

    def test_a_command_over_a_topic_has_the_name_of_its_node(self):
        rotate = rospy.Publisher("rot", Rotate, queue_size=1)
        wait_until(rotate.get_num_connections, "the world")
        rotate.publish(Rotate.COUNTERCLOCKWISE, 1)

        def rows():
            return csv.DictReader(io.StringIO(fetch("api/v1/commands.csv")[1].decode()))

        def mine():
            return [row for row in rows() if row["by"] == rospy.get_name()]

        wait_until(mine, "the journal to have the command")
        row = mine()[0]
        self.assertEqual((row["method"], row["path"], row["status"]), ("TOPIC", "/rot", "0"))
        self.assertEqual(json.loads(row["body"])["kiva_id"], 1)
        self.assertEqual(command(2, "rot", direction=1)[1]["outcome"], "done")
        self.assertFalse([row for row in rows() if row["by"] == "/viewer"])


class ChangingWhatStands(ViewerTest):
    def setUp(self):
        self.assertEqual(ask("/warehouse", {"name": "small"})[0], 200)

    tearDownClass = classmethod(lambda cls: ask("/warehouse", {"name": "small"}))

    def test_once_a_warehouse_stands_all_reads_show_it(self):
        for _ in range(3):
            self.assertEqual(command(1, "movy", distance=-1)[1]["outcome"], "done")
            self.shows({"name": "own", "robots": 2, "items": 9, "shelves": 3, "id": 7}, 2, 3, 9)
            self.shows({"name": "small"}, 4, 24, 96)

    def test_also_where_time_stands_still(self):
        ask("/simulation/pause", {})
        command(1, "rot", "answer&timeout=0.01", direction=1)
        for _ in range(3):
            self.shows({"name": "own", "robots": 3}, 3, 0, 0)
            self.shows({"name": "small"}, 4, 24, 96)
        self.shows({"name": "empty"}, 0, 0, 0)

    def shows(self, expected, robots, units, items):
        self.assertEqual(ask("/warehouse", expected)[0], 200)
        listed = ask("/robots")[1]["robots"]
        lists = (len(listed), ask("/storage_units")[1]["total"], ask("/items")[1]["total"])
        self.assertEqual(lists, (robots, units, items))
        warehouse = ask("/warehouse")[1]
        counts = [warehouse[kind] for kind in ("robots", "storage_units", "items")]
        self.assertEqual((warehouse["name"], *counts), (expected["name"], robots, units, items))
        for robot in listed:
            at = place(robot["name"])
            self.assertEqual((robot["x"], robot["y"]), at[:2])

    def test_robots_come_and_go(self):
        home = ask("/robots/1")[1]
        status, robot = ask("/robots", {"x": -1, "y": -4, "heading": 1.5708})
        self.assertEqual((status, robot["name"]), (201, "kiva5"))
        self.assertEqual(place("kiva5")[:2], (-1, -4))
        self.assertAlmostEqual(robot["yaw"], 1.5708, places=3)
        self.assertEqual(ask("/robots")[1]["total"], 5)
        self.assertEqual(command(5, "movx", distance=1)[1]["outcome"], "done")
        self.assertEqual(ask("/robots/1", method="DELETE")[0], 200)
        self.refused(404, "kiva1", ask("/robots/1"))
        self.refused(404, "kiva1", ask("/robots/1", method="DELETE"))
        _, robot = ask("/robots", {"x": home["x"], "y": home["y"]})
        self.assertEqual((robot["name"], robot["x"], robot["y"]), ("kiva1", home["x"], home["y"]))

    def test_no_robot_stands_where_none_can(self):
        robot, belt = ask("/robots/2")[1], place("conveyor_belt1")
        for x, y, reason in (
            (robot["x"], robot["y"], "is taken by kiva2"),
            (round(belt[0] + 0.1), belt[1], "that no robot can pass"),
            (0.5, 0, "off the grid"),
            (1e6, 0, "outside the floor"),
        ):
            self.refused(409, reason, ask("/robots", {"x": x, "y": y}))
        self.refused(409, "quarter turns", ask("/robots", {"x": -1, "y": -4, "heading": 1}))
        self.assertEqual(ask("/robots", {"x": 0})[0], 422)
        self.assertEqual(ask("/robots")[1]["total"], 4)

    def test_who_carries_stays(self):
        unit = ask("/storage_units/1")[1]
        at = {"x": round(unit["pose"]["x"]), "y": round(unit["pose"]["y"])}
        _, robot = ask("/robots", at)
        self.assertEqual(command(5, "lift", status=1, shelf_id=1)[1]["outcome"], "done")
        self.refused(409, "kiva5 carries", ask("/robots/5", method="DELETE"))
        self.assertEqual(command(5, "lift", status=0)[1]["outcome"], "done")
        self.assertEqual(ask("/robots/5", method="DELETE")[0], 200)


class ViewerApi(ViewerTest):
    def test_tells_what_stands_there(self):
        status, warehouse = ask("/warehouse")
        counts = [warehouse[kind] for kind in ("robots", "storage_units", "items", "belts")]
        self.assertEqual((status, counts), (200, [4, 24, 96, 2]))
        self.assertEqual((warehouse["name"], warehouse["paused"]), ("small", False))

    def test_tells_where_each_is(self):
        _, answer = ask("/robots?limit=2&offset=1")
        self.assertEqual((answer["total"], len(answer["robots"])), (4, 2))
        for robot in answer["robots"]:
            x, y, _ = place(robot["name"])
            self.assertAlmostEqual(robot["x"], x, delta=POSES)
            self.assertAlmostEqual(robot["y"], y, delta=POSES)
        for path, name in (("/storage_units/7", "storage_unit7"), ("/items/3", "item3")):
            _, thing = ask(path)
            self.assertEqual(thing["name"], name)
            for axis, real in zip("xyz", place(name)):
                self.assertAlmostEqual(thing["pose"][axis], real, delta=POSES)
        _, answer = ask("/items?storage_unit=storage_unit3")
        self.assertEqual(answer["total"], 4)

    def test_what_is_not_there_is_not_found(self):
        for path in ("/robots/99", "/storage_units/99", "/items/9999"):
            self.refused(404, "99", ask(path))
        self.refused(404, "no robot kiva99", command(99, "rot", direction=1))

    def test_a_command_is_done(self):
        status, answer = command(1, "rot", direction=1)
        self.assertEqual((status, answer["outcome"]), (200, "done"))
        self.assertEqual([e["kind"] for e in answer["events"]], ["ACCEPTED", "DONE"])
        self.assertEqual(len({e["command"] for e in answer["events"]} - {0}), 1)
        wait_until(lambda: ask("/robots/1")[1]["last_end"] == "DONE", "how it ended")
        _, page_of_events = ask(f"/events?model=kiva1&since={answer['events'][0]['id'] - 1}")
        self.assertEqual(page_of_events["events"][: len(answer["events"])], answer["events"])

    def test_a_refusal_says_why(self):
        self.refused(409, "outside the floor", command(1, "mov", x=1000, y=0))
        self.refused(409, "off the grid", command(1, "mov", x=0.3, y=0))
        self.refused(409, "does not carry", command(1, "lift", status=0, shelf_id=1))
        self.refused(409, "can't be negative", ask("/warehouse", {"name": "x", "robots": -1}))
        self.refused(409, "is not a preset", ask("/warehouse", {"name": "nonsense"}))

    def test_what_is_no_command_is_refused(self):
        self.assertEqual(command(1, "jump")[0], 422)
        self.assertEqual(command(1, {})[0], 422)
        self.assertEqual(command(1, "mov", x="far", y=0)[0], 422)
        self.assertEqual(command(1, "movx", distance=float("nan"))[0], 422)
        self.assertEqual(command(1, "movx", distance=1, speed=2)[0], 422)

    def test_pauses_and_goes_on(self):
        self.assertEqual(ask("/simulation/pause", {})[0], 200)
        self.assertTrue(ask("/warehouse")[1]["paused"])
        status, answer = ask("/robots/2/commands?timeout=0.2", {"command": "rot", "direction": 1})
        self.assertEqual((status, answer["outcome"]), (202, "pending"))
        self.assertEqual(ask("/simulation/resume", {})[0], 200)
        self.assertFalse(ask("/warehouse")[1]["paused"])

    def test_what_the_engine_lacks_is_refused_with_the_reason(self):
        bodies = {"step": {}, "undo": {"seconds": 1}, "speed": {"factor": 1}}
        bodies |= {"checkpoint": {"name": "a"}, "restore": {"name": "a"}}
        lacks = ask("/warehouse")[1]["lacks"]
        for action in bodies.keys() & lacks.keys():
            self.refused(409, lacks[action], ask(f"/simulation/{action}", bodies[action]))

    def test_steps_and_goes_back(self):
        ask("/simulation/pause", {})
        began = ask("/warehouse")[1]["time"]
        self.assertEqual(ask("/simulation/checkpoint", {"name": "here"})[0], 200)
        self.assertEqual(ask("/simulation/step", {"steps": 500})[0], 200)
        wait_until(lambda: ask("/warehouse")[1]["time"] >= began + 0.4, "half a second more")
        self.assertEqual(ask("/simulation/restore", {"name": "here"})[0], 200)
        self.refused(409, "no checkpoint 'there'", ask("/simulation/restore", {"name": "there"}))
        self.refused(409, "", ask("/simulation/undo", {"seconds": 1000}))
        self.assertEqual(ask("/simulation/restore", {"name": "/etc/passwd"})[0], 422)

    def test_changes_speed(self):
        self.assertEqual(ask("/simulation/speed", {"factor": 2})[0], 200)
        self.assertAlmostEqual(ask("/warehouse")[1]["target_factor"], 2)
        self.assertEqual(ask("/simulation/speed", {"factor": 5})[0], 200)

    def test_foreign_pages_are_refused(self):
        self.refused(403, "foreign", ask("/robots", origin="http://evil.example"))
        self.refused(403, "token", ask("/robots", host="evil.example"))
        self.refused(413, "larger", ask("/robots", {"name": "x" * 100_000}))

    def test_describes_itself(self):
        for path in ("openapi.json", "api/v1/openapi.json"):
            status, description = fetch(path)
            self.assertEqual(status, 200)
            self.assertIn("/api/v1/robots/{number}/commands", json.loads(description)["paths"])

    def test_waits_for_the_end_as_long_as_it_takes(self):
        self.assertEqual(ask("/simulation/speed", {"factor": 0.2})[0], 200)
        status, answer = command(4, "rot", "end&timeout=0.1", direction=1)
        self.assertEqual((status, answer["outcome"]), (202, "accepted"))
        last = "/events?model=kiva4&limit=1"
        wait_until(lambda: ask(last)[1]["events"][0]["kind"] == "DONE", "the end of the turn")
        self.assertEqual(ask("/simulation/speed", {"factor": 0.15})[0], 200)
        status, answer = command(4, "movy", distance=1)  # in some thirteen seconds
        self.assertEqual(ask("/simulation/speed", {"factor": 5})[0], 200)
        self.assertEqual((status, answer["outcome"]), (200, "done"))

    def test_a_body_that_says_nothing_may_be_left_out(self):
        self.assertEqual(fetch("api/v1/simulation/reset", b"")[0], 200)
        self.assertEqual(fetch("api/v1/simulation/reset", b'{"time_to": 1}')[0], 422)
        ask("/simulation/pause", {})
        self.assertEqual(fetch("api/v1/simulation/step", b"")[0], 200)

    def test_exports_events(self):
        command(2, "rot", direction=-1)
        _, text = fetch("api/v1/events.csv")
        rows = list(csv.DictReader(io.StringIO(text.decode())))
        last = [row for row in rows if row["model"] == "kiva2"][-1]
        self.assertEqual(last["kind"], "DONE")
        newest = ask("/events?model=kiva2&limit=1")[1]["events"][-1]
        self.assertEqual({name: str(value) for name, value in newest.items()}, last)

    def test_streams_states_and_events_as_json(self):
        asyncio.run(self.stream())

    async def stream(self):
        there = address().replace("http", "ws")
        async with websockets.connect(f"{there}api/v1/stream?rate=10") as socket:
            first = json.loads(await asyncio.wait_for(socket.recv(), PATIENCE))
            self.assertEqual(
                [r["name"] for r in first["robots"]], [f"kiva{i}" for i in range(1, 5)]
            )
            doing = asyncio.create_task(asyncio.to_thread(command, 3, "rot", direction=-1))
            kinds, turned = [], False
            while not (turned and "DONE" in kinds):
                message = json.loads(await asyncio.wait_for(socket.recv(), PATIENCE))
                if message["type"] == "events":
                    kinds += [e["kind"] for e in message["events"] if e["model"] == "kiva3"]
                else:
                    turned |= "kiva3" in [r["name"] for r in message["robots"]]
            await doing


if __name__ == "__main__":
    rospy.init_node("test_viewer_api")
    rostest.rosrun("warehouse_tests", "viewer_api", __name__)
