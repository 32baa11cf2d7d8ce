# SPDX-License-Identifier: Apache-2.0
"""Recordings of what goes through a broker, and their replay.

entry: one message, as a line of JSON. file: many of them, compressed. recorder: takes messages,
judges and writes them, and counts. player: sends them again in their order and at their times.
moments: what vehicles did at any time. record_command, replay_command: the two programs.
"""
