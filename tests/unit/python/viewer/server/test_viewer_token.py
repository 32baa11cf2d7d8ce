# SPDX-License-Identifier: Apache-2.0
"""The token comes from a file that no other user can read, or from the environment."""

import os

import pytest

from warehouse_viewer.server import token

SECRET = "0123456789abcdef"


def file_with(tmp_path, text, mode=0o600):
    path = tmp_path / "token"
    path.write_text(text)
    path.chmod(mode)
    return str(path)


def test_of_a_file(tmp_path):
    path = file_with(tmp_path, f"{SECRET}\n")
    assert token.find(path, environment={"WAREHOUSE_TOKEN": "another one"}) == (SECRET, path)


def test_of_the_environment(tmp_path):
    environment = {"WAREHOUSE_TOKEN": SECRET, "ROS_HOME": str(tmp_path)}
    secret, where = token.find(needed=True, environment=environment)
    assert secret == SECRET
    assert "WAREHOUSE_TOKEN" in where
    assert not list(tmp_path.iterdir())


def test_none_is_needed_on_this_machine_alone(tmp_path):
    assert token.find(environment={"ROS_HOME": str(tmp_path)}) == ("", "")


def test_one_that_is_needed_is_made_once_for_its_owner_alone(tmp_path):
    environment = {"ROS_HOME": str(tmp_path)}
    secret, where = token.find(needed=True, environment=environment)
    assert len(secret) >= 32
    assert os.stat(where).st_mode & 0o777 == 0o600
    assert token.find(needed=True, environment=environment) == (secret, where)


@pytest.mark.parametrize(
    ("text", "mode", "why"),
    [
        (SECRET, 0o640, "can be read by others: chmod 600"),
        (SECRET, 0o604, "can be read by others: chmod 600"),
        ("", 0o600, "8 to 500"),
        ("short", 0o600, "8 to 500"),
        ("with a blank", 0o600, "8 to 500"),
        ("x" * 501, 0o600, "8 to 500"),
    ],
)
def test_a_bad_file_is_refused_by_its_name(tmp_path, text, mode, why):
    path = file_with(tmp_path, text, mode)
    with pytest.raises(token.TokenError, match=why) as error:
        token.find(path)
    assert path in str(error.value)


@pytest.mark.parametrize("path", ["/nowhere/token", "/dev/null", "/tmp"])
def test_what_is_no_file_is_refused(path):
    with pytest.raises(token.TokenError, match=path):
        token.find(path)
