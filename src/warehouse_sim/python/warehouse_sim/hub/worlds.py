# SPDX-License-Identifier: Apache-2.0
"""The worlds of a hub: those that come with the package, and those that were saved under a name."""

from contextlib import suppress
from pathlib import Path
from typing import Any

from warehouse_layout.file import files
from warehouse_layout.models import sdf_world
from warehouse_sim.hub.wish import MOST_TEXT, NAME, WishError

SUFFIX = ".sdf"
MOST_SAVED = 200


class Taken(RuntimeError):  # noqa: N818 (an answer)
    """Raised where a world has the name already; says what helps."""


class UnknownWorld(LookupError):  # noqa: N818 (an answer)
    """Raised for the name of no world."""


class Worlds:
    """World files by name. Those in `folder` were saved; it is made with the first of them."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def names(self) -> list[str]:
        """Returns the names of all worlds, saved ones first."""
        return [*self._saved(), *_shipped()]

    def rows(self) -> list[dict[str, Any]]:
        """Returns all worlds as the API lists them."""
        saved = [self._row(name) for name in self._saved()]
        shipped = [{"name": name, "saved": False} for name in _shipped()]
        return [*saved, *shipped]

    def _row(self, name: str) -> dict[str, Any]:
        out: dict[str, Any] = {"name": name, "saved": True}
        with suppress(OSError):
            status = self._path(name).stat()
            out |= {"bytes": status.st_size, "time": round(status.st_mtime)}
        return out

    def resolved(self, text: str) -> str:
        """Returns the path of a saved world for its name, and any other text as it is."""
        return str(self._path(text)) if text in self._saved() else text

    def text(self, name: str) -> str:
        """Returns a world's SDF. Raises UnknownWorld, OSError."""
        if name in self._saved():
            return self._path(name).read_text(encoding="utf-8")
        if name in _shipped():
            return (files.worlds() / f"{name}{SUFFIX}").read_text(encoding="utf-8")
        raise UnknownWorld(f"there is no world '{name[:40]}'")

    def new_path(self, name: object, replaces: object = False) -> Path:
        """Returns the path of a world that is to be saved. Raises WishError, Taken, OSError."""
        if not isinstance(name, str) or not NAME.fullmatch(name):
            reason = "1 to 40 small letters, digits and '-' were expected, a letter or digit first"
            raise WishError("world", reason)
        if not isinstance(replaces, bool):
            raise WishError("replace", "true or false was expected")
        if name in _shipped():
            raise Taken(f"the world '{name}' comes with the warehouse; choose another name")
        saved = self._saved()
        if name in saved and not replaces:
            raise Taken(f"there is a world '{name}' already; another name, or replace: true")
        if name not in saved and len(saved) >= MOST_SAVED:
            raise Taken(f"{MOST_SAVED} worlds are saved; delete some")
        self.folder.mkdir(parents=True, exist_ok=True)
        return self._path(name)

    def save(self, name: object, text: object, replaces: object = False) -> None:
        """Saves an SDF text as a world. Raises WishError, Taken, OSError."""
        path = self.new_path(name, replaces)
        if not isinstance(text, str) or len(text) > 8 * MOST_TEXT:
            raise WishError("text", "the text of an SDF world was expected")
        try:
            sdf_world.parse(text, path)
        except sdf_world.WorldError as error:
            raise WishError("text", str(error).removeprefix(f"{path}: ")) from error
        part = path.with_name(f".{path.name}.part")
        part.write_text(text, encoding="utf-8")
        part.replace(path)

    def delete(self, name: str) -> None:
        """Deletes a saved world. Raises UnknownWorld, Taken for one of the package, OSError."""
        if name in self._saved():
            self._path(name).unlink(missing_ok=True)
        elif name in _shipped():
            raise Taken(f"the world '{name}' comes with the warehouse; it can't be deleted")
        else:
            raise UnknownWorld(f"there is no world '{name[:40]}'")

    def _saved(self) -> list[str]:
        names = sorted(path.stem for path in self.folder.glob(f"*{SUFFIX}"))
        return [name for name in names if NAME.fullmatch(name)]

    def _path(self, name: str) -> Path:
        return self.folder / f"{name}{SUFFIX}"


def _shipped() -> list[str]:
    return sorted(path.stem for path in files.worlds().glob(f"*{SUFFIX}"))
