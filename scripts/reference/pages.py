# SPDX-License-Identifier: Apache-2.0
"""Pages of the repository, copied for Sphinx, with links mended that lead out of doc/."""

import os
import re
import shutil
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# Pages outside of doc/ that belong to the documentation, and where.
MIRRORED = {
    "SECURITY.md": "explanation/security.md",
    "CONTRIBUTING.md": "explanation/contributing.md",
    "src/kiva_plugin_cpp/src/README.md": "explanation/rooms-world.md",
    "src/warehouse_fleet/src/README.md": "explanation/rooms-planner.md",
    "src/warehouse_viewer/web/js/README.md": "explanation/rooms-pages.md",
    "bench/README.md": "explanation/benchmarks.md",
    "CHANGELOG.rst": "reference/changelog.rst",
}
LINK = re.compile(r"(?<!\w)(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s#]*)(#[^)\s]*)?\)")
FENCE = re.compile(r"^(```|~~~)", re.M)


class Mirror:
    """A folder of Sphinx's sources. What does not change keeps its time: Sphinx skips it."""

    def __init__(self, folder: Path) -> None:
        self._folder, self._written = folder / "doc", set()
        self._root = folder
        self._folder.mkdir(parents=True, exist_ok=True)

    def take_tree(self) -> None:
        """Copies doc/ and the mirrored pages."""
        for file in (ROOT / "doc").rglob("*"):
            if file.is_file() and "__pycache__" not in file.parts:
                self._take(file, str(file.relative_to(ROOT / "doc")))
        for name, page in MIRRORED.items():
            self._take(ROOT / name, page)

    def _take(self, file, page):
        if file.suffix == ".md":
            text = with_drawings(file.read_text(), self._drawing)
            self.write(page, relinked(text, file.parent, page, self._download))
        else:
            self._put(page, file.read_bytes())

    def _download(self, file):
        """Copies a file of the repository beside the pages; returns its path in doc/."""
        page = f"files/{file.relative_to(ROOT)}"
        self._put(page, file.read_bytes())
        return page

    def _drawing(self, number, dot):
        """Has graphviz draw a graph; returns the picture's path in doc/."""
        page = f"drawings/{number}.svg"
        drawn = subprocess.run(
            ["dot", "-Tsvg"], input=dot.encode(), check=True, capture_output=True
        )
        self._put(page, drawn.stdout)
        return page

    def write(self, page: str, text: str) -> None:
        """Writes a page."""
        self._put(page, text.encode())

    def copy(self, file: Path, page: str) -> None:
        """Copies a file of the repository."""
        self._put(page, file.read_bytes())

    def _put(self, page, data):
        path = self._folder / page
        self._written.add(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_bytes() != data:
            path.write_bytes(data)

    def end(self) -> None:
        """Removes what an earlier build wrote and this one has not."""
        kept = self._written | {self._folder / "doxygen.log"}
        for path in self._folder.rglob("*"):
            if (
                path.is_file()
                and path not in kept
                and "xml" not in path.relative_to(self._folder).parts
            ):
                path.unlink()
        for path in sorted(self._folder.rglob("*"), reverse=True):
            if path.is_dir() and not any(path.iterdir()):
                shutil.rmtree(path)


def relinked(text, folder, page, download):
    """Returns a page's text whose links are right where the page will stand.

    `folder` is where its links start from, `page` its place below doc/. A link to a file that is no
    page leads to a copy of the file, one to a folder becomes the folder's name.
    """

    def mend(match):
        bang, words, target, anchor = match[1], match[2], match[3], match[4] or ""
        words = LINK.sub(mend, words)
        if not target or re.match(r"[a-z]+:", target) or target.startswith("/"):
            return f"{bang}[{words}]({target}{anchor})"
        to = Path(os.path.normpath(folder / target))
        if not to.exists():
            return match[0]  # Sphinx tells that the page is missing
        name = str(to.relative_to(ROOT))
        if to.is_dir():
            return f"{words} (`{name}/`)" if name not in words else f"`{name}/`"
        if name in MIRRORED:
            place = MIRRORED[name]
        elif name.startswith("doc/"):
            place = name[4:]
        elif name == "README.md":
            place = "index.md"
        else:
            place, anchor = download(to), ""
        return f"{bang}[{words}]({os.path.relpath(place, Path(page).parent)}{anchor})"

    parts = re.split(r"(^(?:```|~~~).*?^(?:```|~~~)[^\n]*$)", text, flags=re.M | re.S)
    return "".join(part if i % 2 else LINK.sub(mend, part) for i, part in enumerate(parts))


def with_drawings(text, draw):
    """Returns a page's text with a picture in place of each block of mermaid or dot."""
    blocks = iter(range(1000))
    kept = re.sub(r"\W+", "-", text.splitlines()[0]).strip("-").lower() if text else ""

    def replaced(match):
        dot = match[2] if match[1] == "dot" else dot_of(match[2])
        name = f"{kept}-{next(blocks)}"
        return f"![A drawing](/{draw(name, dot)})"

    return re.sub(r"^```(mermaid|dot)\n(.*?)^```$", replaced, text, flags=re.M | re.S)


def dot_of(mermaid):
    """Returns a graph of mermaid's (`a["text"]`, `a --> b`) in graphviz's language."""
    lines = [
        'digraph { rankdir=BT; bgcolor=transparent; node [shape=box, style="rounded,filled", '
        'fillcolor="#e8eef7", fontname="sans-serif"];'
    ]
    for line in mermaid.splitlines()[1:]:
        for name, label in re.findall(r"(\w+)\[\"?([^\]\"]+)\"?\]", line):
            lines.append(f'{name} [label="{label.replace(", ", chr(92) + "n")}"];')
        ends = [re.sub(r"\[.*?\]", "", end).strip() for end in line.split("-->")]
        lines += [f"{a} -> {b};" for a, b in zip(ends, ends[1:])]
    return "\n".join([*lines, "}"])
