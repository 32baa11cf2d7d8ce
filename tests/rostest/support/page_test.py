# SPDX-License-Identifier: Apache-2.0
"""What tests of the pages and of the HTTP API share."""

import json
import unittest
import urllib.error
import urllib.request

import rospy
from rostest_support.browser import browser
from rostest_support.node_test import PATIENCE, wait_until


def address():
    """Where the viewer serves, once it does."""
    wait_until(lambda: rospy.has_param("/viewer/address"), "the viewer")
    return rospy.get_param("/viewer/address")


def fetch(path, data=None, method=None, **headers):
    """(status, body) of a request; POST where there are data."""
    headers = {"content-type": "application/json"} | headers
    request = urllib.request.Request(address() + path, data, headers, method=method)
    try:
        with urllib.request.urlopen(request, timeout=PATIENCE) as answer:
            return answer.status, answer.read()
    except urllib.error.HTTPError as error:
        return error.code, error.read()


def ask(path, body=None, method=None, **headers):
    """(status, body) of a request to /api/v1, as JSON; POST where there is a body."""
    data = None if body is None else json.dumps(body).encode()
    status, answer = fetch("api/v1" + path, data, method, **headers)
    return status, json.loads(answer)


class PageTest(unittest.TestCase):
    """One browser for all tests of a class; its console has nothing to complain about."""

    path, ready = "", "page"  # of the page, and what holds once it shows what it should
    is_phone = False

    @classmethod
    def setUpClass(cls):
        cls.page = cls.enterClassContext(browser(PATIENCE))
        if cls.is_phone:
            cls.page.be_phone()
        cls.page.open(address() + cls.path)
        cls.page.until(cls.ready)

    def tearDown(self):
        self.assertEqual(self.page.complaints(), [])
