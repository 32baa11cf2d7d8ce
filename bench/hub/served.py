# SPDX-License-Identifier: Apache-2.0
"""A hub that is measured, its memory, and what it leaves behind."""

import os
import socket
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tests" / "assistant"))

from served_hub import ServedHub, children, until  # noqa: E402, F401 (for the programs)

ASSISTANT = ROOT / ".venv" / "assistant" / "bin" / "python"


def memory(process):
    """Returns (pss, rss) of a process [MB]: with shared pages by their part, and in full."""
    sizes = {}
    for line in Path(f"/proc/{process}/smaps_rollup").read_text().splitlines():
        name, _, size = line.partition(":")
        if size.endswith("kB"):
            sizes[name] = int(size.split()[0]) / 1000
    return sizes["Pss"], sizes["Rss"]


def hub_processes(hub):
    """Returns {name: process} of a hub and its assistant."""
    out = {"hub": hub.process.pid}
    for process in descendants(hub.process.pid):
        words = Path(f"/proc/{process}/cmdline").read_text().split("\0")
        if "warehouse_assistant" in words:
            out["assistant"] = process
        elif any(word.endswith("/hub") for word in words[:3]):
            out["hub"] = process
    return out


def memories(hub):
    """Returns {name: (pss, rss)} of a hub and its assistant [MB]."""
    return {name: memory(process) for name, process in hub_processes(hub).items()}


def cpu(root):
    """Returns the processor time of a process and those below it, ended ones included [s]."""
    total = 0
    for process in (root, *descendants(root)):
        try:
            fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue  # it has ended, and counts for the process that started it
        total += sum(map(int, fields[11:15]))
    return total / os.sysconf("SC_CLK_TCK")


def print_memories(when, rows):
    for name, (pss, rss) in rows.items():
        print(f"memory {when}: {name} {pss:.0f} MB (rss {rss:.0f} MB)")
    total = sum(pss for pss, _ in rows.values())
    print(f"memory {when}: together {total:.0f} MB (rss {sum(r for _, r in rows.values()):.0f} MB)")
    return total


def descendants(root):
    """Returns the processes below a process."""
    out = []
    for child in children(root):
        out += [child, *descendants(child)]
    return out


def answers(url):
    """Whether the server at an address accepts connections."""
    host, port = url.removeprefix("http://").split(":")
    try:
        socket.create_connection((host, int(port)), 1).close()
    except OSError:
        return False
    return True


def waited(condition, patience=120.0, step=0.01):
    """Returns the seconds until a condition holds. Raises TimeoutError."""
    begin = time.monotonic()
    while not condition():
        if time.monotonic() - begin > patience:
            raise TimeoutError(f"not within {patience:g} s")
        time.sleep(step)
    return time.monotonic() - begin
