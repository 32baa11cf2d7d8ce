# SPDX-License-Identifier: Apache-2.0
"""Calls of services are published with the node that called, before they are answered."""

import rospy
import yaml
from fake_ros import FakeRos

from warehouse_client.command_services import CALLS, CommandServices
from warehouse_msgs.msg import OrderLine
from warehouse_msgs.srv import SubmitOrderRequest, Tow, TowRequest


class Ros(FakeRos):
    """Keeps services by name, too."""

    def __init__(self):
        super().__init__()
        self.services = {}

    def Service(self, name, kind, take):  # noqa: N802 (rospy's name)
        self.services[name] = take


def called(request, name="/desk"):
    """The Command that tells of a request, with the answer to it."""
    ros = Ros()
    CommandServices(ros).serve("warehouse/tow", Tow, lambda asked: ("answer", asked))
    if name:
        request._connection_header = {"callerid": name}
    answer = ros.services["warehouse/tow"](request)
    assert answer == ("answer", request)
    (command,) = ros.publishers[CALLS].sent
    return command


def test_a_call_has_the_name_of_its_node_and_the_fields_of_its_request():
    command = called(TowRequest(kiva_id=3))
    assert (command.topic, command.sender) == ("/warehouse/tow", "/desk")
    assert yaml.safe_load(command.fields)["kiva_id"] == 3


def test_a_caller_without_a_name_has_none():
    assert called(TowRequest(kiva_id=3), name="").sender == ""


def test_texts_with_signs_of_yaml_and_messages_in_messages_come_through():
    lines = [OrderLine(sku="sku: 'a'\n- b", quantity=2)]
    command = called(SubmitOrderRequest(lines=lines, due=rospy.Duration(90), reference="Öl #1"))
    fields = yaml.safe_load(command.fields)
    assert (fields["lines"][0]["sku"], fields["lines"][0]["quantity"]) == ("sku: 'a'\n- b", 2)
    assert (fields["due"], fields["reference"]) == (90.0, "Öl #1")


def test_a_long_text_is_cut():
    fields = yaml.safe_load(called(SubmitOrderRequest(reference="x" * 5000)).fields)
    assert fields["reference"] == "x" * 200 + "… (5000 characters)"
