# SPDX-License-Identifier: Apache-2.0
"""Damage to messages on their way, and lists of mutants that do it, or whose code is wrong."""

import json

from warehouse_vda5050.topics import Kind


def of_json(function, *endings):
    """Returns damage(sent, memory) to messages whose topics end so: function(value, memory) changes
    `value`, and returns False for a message that is lost."""

    def damage(sent, memory):
        if not sent.topic.endswith(endings):
            return sent
        value = json.loads(sent.payload)
        if function(value, memory) is False:
            return None
        return sent._replace(payload=json.dumps(value).encode())

    return damage


class Additions:
    """Adds mutants, each made by make(name, rule, damage, patches=…), to a dictionary by name.
    `usual` is how topics end whose messages json_of() damages where nothing else is said."""

    def __init__(self, mutants, make, usual=""):
        self._mutants, self._make, self._usual = mutants, make, usual

    def patched(self, name, rule, *patches):
        """Adds a mutant of the code."""
        self._mutants[name] = self._make(name, rule, patches=list(patches))

    def message(self, name, rule, kind=""):
        """Returns a decorator that adds a mutant which damages messages of a kind."""

        def add(function):
            def damage(sent, memory):
                return function(sent, memory) if sent.topic.endswith(_ending(kind)) else sent

            self._mutants[name] = self._make(name, rule, damage)
            return function

        return add

    def json_of(self, name, rule, *kinds):
        """Returns a decorator that adds a mutant which damages the JSON of messages, by a function
        as of_json() takes it."""
        endings = [_ending(kind) for kind in kinds or (self._usual,)]

        def add(function):
            self._mutants[name] = self._make(name, rule, of_json(function, *endings))
            return function

        return add


def _ending(kind):
    """How the topics of a Kind end, or any text."""
    return f"/{kind.value}" if isinstance(kind, Kind) else kind
