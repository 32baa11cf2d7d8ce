#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The HTTP API tells and does what ROS does, with the same refusals."""

import asyncio
import json
import unittest
import urllib.error
import urllib.request

import rospy
import rostest
import websockets
from node_test import PATIENCE, wait_until
from warehouse_test import place

POSES = 1e-3  # [m]


def ask(path, body=None, **headers):
    """(status, body) of a request to /api/v1; POST where there is a body."""
    url = rospy.get_param("/viewer/address") + "api/v1" + path
    data = None if body is None else json.dumps(body).encode()
    headers = {"content-type": "application/json"} | headers
    request = urllib.request.Request(url, data, headers)
    try:
        with urllib.request.urlopen(request, timeout=PATIENCE) as answer:
            return answer.status, json.load(answer)
    except urllib.error.HTTPError as error:
        return error.code, json.load(error)


def command(robot, name, wait="end", **fields):
    return ask(f"/robots/{robot}/commands?wait={wait}", {"command": name, **fields})


class ViewerApi(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        wait_until(lambda: rospy.has_param("/viewer/address"), "the viewer")
        wait_until(lambda: ask("/warehouse")[1].get("items") == 96, "the small warehouse")
        wait_until(lambda: "create" not in ask("/warehouse")[1]["lacks"], "who builds others")

    def tearDown(self):
        ask("/simulation/resume", {})

    def refused(self, status, text, answer):
        self.assertEqual(answer[0], status, answer)
        self.assertIn(text, str(answer[1]["detail"]))

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
        _, found = ask("/items?storage_unit=storage_unit3")
        self.assertEqual(found["total"], 4)

    def test_what_is_not_there_is_not_found(self):
        for path in ("/robots/99", "/storage_units/99", "/items/9999"):
            self.refused(404, "99", ask(path))
        self.refused(404, "no robot kiva99", command(99, "rot", direction=1))

    def test_a_command_is_done(self):
        status, answer = command(1, "rot", direction=1)
        self.assertEqual((status, answer["outcome"]), (200, "done"))
        self.assertEqual([e["kind"] for e in answer["events"]], ["ACCEPTED", "DONE"])
        _, told = ask(f"/events?model=kiva1&since={answer['events'][0]['id'] - 1}")
        self.assertEqual(told["events"][: len(answer["events"])], answer["events"])

    def test_a_refusal_says_why(self):
        self.refused(409, "outside the floor", command(1, "mov", x=1000, y=0))
        self.refused(409, "off the grid", command(1, "mov", x=0.3, y=0))
        self.refused(409, "does not carry", command(1, "lift", status=0, shelf_id=1))
        self.refused(409, "can't be negative", ask("/warehouse", {"name": "x", "robots": -1}))
        self.refused(409, "is no preset", ask("/warehouse", {"name": "nonsense"}))

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
        large = {"name": "x" * 100000}
        self.refused(413, "larger", ask("/warehouse", large))

    def test_describes_itself(self):
        _, description = ask("/openapi.json")
        self.assertIn("/api/v1/robots/{number}/commands", description["paths"])

    def test_streams_states_and_events_as_json(self):
        asyncio.run(self.stream())

    async def stream(self):
        address = rospy.get_param("/viewer/address").replace("http", "ws")
        async with websockets.connect(f"{address}api/v1/stream?rate=10") as socket:
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
