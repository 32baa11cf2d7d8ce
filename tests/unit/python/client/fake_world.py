# SPDX-License-Identifier: Apache-2.0
"""A world that only keeps names and poses, behind the services of the real one."""

import xml.etree.ElementTree as ElementTree
from types import SimpleNamespace

import rospy
from fake_ros import FakeRos
from geometry_msgs.msg import Pose
from nav_msgs.srv import GetMapResponse

from warehouse_client import tracking
from warehouse_layout.floor import poses
from warehouse_layout.models import models


class FakeWorld(FakeRos):
    """A stand-in for rospy with a world behind it, which refuses to spawn the model `refuses`."""

    ROSException, ServiceException = rospy.ROSException, rospy.ServiceException

    def __init__(self, standing=(), refuses=None, paused=False):
        super().__init__()
        self.standing = dict.fromkeys(standing, Pose())
        self.refuses, self.pause = refuses, paused
        self.spawned_while_running = []
        self.floor_map = GetMapResponse()
        self.floor_map.map.info.resolution = 1.0

    def set_param(self, name, value):
        self.parameters[name] = value

    def has_param(self, name):
        return name in self.parameters

    def delete_param(self, name):
        del self.parameters[name]

    def wait_for_service(self, name, timeout):
        pass

    def ServiceProxy(self, name, kind, persistent):  # noqa: N802 (rospy's name)
        call = getattr(self, name.removeprefix("gazebo/").removeprefix("warehouse/"))
        return _Proxy(call)

    def get_world_properties(self):
        return SimpleNamespace(model_names=list(self.standing), sim_time=42.0)

    def map(self):
        return self.floor_map

    def get_model_state(self, name, frame):
        return SimpleNamespace(success=True, pose=self.standing[name])

    def get_physics_properties(self):
        return SimpleNamespace(pause=self.pause)

    def pause_physics(self):
        self.pause = True

    def unpause_physics(self):
        self.pause = False

    def spawn_sdf_model(self, name, xml, namespace, pose, frame):
        parts = list(ElementTree.fromstring(xml).find("world"))
        names = [part.get("name") or part.findtext("name") for part in parts]
        names = names if len(names) > 1 else [name]
        if not self.standing.keys().isdisjoint(names):
            return _answer("SpawnModel: Failure - entity already exists.")
        if self.refuses in names:
            return _answer(f"{self.refuses} is bad")
        if not self.pause:
            self.spawned_while_running += names
        self.standing |= {n: _pose(p.findtext("pose", "0 0 0 0 0 0")) for n, p in zip(names, parts)}
        return _answer()

    def replace_models(self, kinds, names, documents):
        """Refuses as a whole what stands already, and takes all of `kinds` away after a later
        refusal."""
        read = [list(ElementTree.fromstring(text).find("world")) for text in documents]
        parts = {p.get("name") or p.findtext("name"): p for part in read for p in part}
        left = {n: p for n, p in self.standing.items() if n not in names and not _is_of(kinds, n)}
        if not left.keys().isdisjoint(parts):
            return _replaced("one of that name stands", changed=False)
        self.documents = [len(part) for part in read]
        if not self.pause:
            self.spawned_while_running += parts
        added = {n: _pose(p.findtext("pose", "0 0 0 0 0 0")) for n, p in parts.items()}
        if self.refuses in added:
            kept = {n: pose for n, pose in added.items() if not _is_of(kinds, n)}
            self.standing = left | kept
            return _replaced(f"{self.refuses} is bad", changed=True)
        self.standing = left | added
        return _replaced()

    def delete_model(self, name):
        if name not in self.standing:
            return _answer("DeleteModel: model does not exist")
        del self.standing[name]
        if models.kind_and_number(name)[0] == "storage_unit":
            self.standing = {
                n: p for n, p in self.standing.items() if models.kind_and_number(n)[0] != "item"
            }
        return _answer()


def _is_of(kinds, name):
    return models.kind_and_number(name)[0] in kinds


def _pose(text):
    x, y, z, _, _, yaw = map(float, text.split())
    pose = tracking.message(poses.planar(x, y, yaw))
    pose.position.z = z
    return pose


class _Proxy:
    def __init__(self, call):
        self._call = call

    def __call__(self, *args):
        return self._call(*args)

    def close(self):
        self._call = None


def _answer(error=""):
    return SimpleNamespace(success=not error, status_message=error)


def _replaced(error="", changed=True):
    return SimpleNamespace(success=not error, changed=changed, message=error)
