# SPDX-License-Identifier: Apache-2.0
"""Nodes return free memory to the system."""

import ctypes
import threading

from warehouse_client import heap

PATIENCE = 60.0  # [s, wall]


def test_free_memory_is_returned_again_and_again(monkeypatch):
    returned = threading.Semaphore(0)
    monkeypatch.setattr(heap, "trim", lambda: lambda kept: returned.release())
    heap.keep_trimmed(period=0.001)
    assert all(returned.acquire(timeout=PATIENCE) for _ in range(3))


def test_a_library_without_it_is_left_alone(monkeypatch):
    monkeypatch.setattr(ctypes, "CDLL", lambda name: object())
    before = threading.active_count()
    heap.keep_trimmed()
    assert heap.trim() is None and threading.active_count() == before


def test_the_heap_of_this_machine_can_be_trimmed():
    assert heap.trim()(0) in (0, 1)
