# SPDX-License-Identifier: Apache-2.0
"""The secret that clients present: from a file that only its owner can read, or the environment.

Never in a parameter or an argument: every ROS client and every user of the machine reads those.
"""

import os
import re
import secrets
from collections.abc import Mapping
from pathlib import Path

from warehouse_layout.file import user_file

VARIABLE = "WAREHOUSE_TOKEN"


class TokenError(ValueError):
    """No token where one was named, or one that others can read; the message says what helps."""


def default_path(environment: Mapping[str, str] = os.environ) -> Path:
    """Returns where the viewer keeps the token that it makes itself."""
    home = environment.get("ROS_HOME") or Path.home() / ".ros"
    return Path(home) / "warehouse" / "viewer_token"


def find(
    path: str = "", needed: bool = False, environment: Mapping[str, str] = os.environ
) -> tuple[str, str]:
    """Returns (token, where it lies); ("", "") if there is none and none is `needed`.

    The token is in the file `path`, else in the environment. One that is needed but not given is
    made once, and kept for the next time. Raises TokenError.
    """
    if path:
        return read(Path(path)), str(path)
    if environment.get(VARIABLE):
        return _checked(environment[VARIABLE], VARIABLE), f"the environment's {VARIABLE}"
    if not needed:
        return "", ""
    made = default_path(environment)
    _make(made)
    return read(made), str(made)


def read(path: Path) -> str:
    """Returns the token in a file of mode 0600. Raises TokenError."""
    try:
        with user_file.opened(path) as file:
            if os.fstat(file.fileno()).st_mode & 0o077:
                raise TokenError(f"{path} can be read by others: chmod 600 {path}")
            return _checked(file.read(1000).decode("ascii", "replace").strip(), path)
    except OSError as error:
        raise TokenError(f"{path}: {error.strerror}") from error


def _checked(token: str, where: str | Path) -> str:
    if not re.fullmatch(r"[!-~]{8,500}", token):
        raise TokenError(f"{where}: a token of 8 to 500 letters and digits was expected")
    return token


def _make(path: Path) -> None:
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except FileExistsError:
        return
    except OSError as error:
        raise TokenError(f"{path}: {error.strerror}") from error
    with open(file, "w", encoding="ascii") as out:
        out.write(secrets.token_hex(16) + "\n")
