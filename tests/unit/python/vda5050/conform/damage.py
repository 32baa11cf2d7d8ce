# SPDX-License-Identifier: Apache-2.0
"""Damage to the JSON of messages on their way."""

import json


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
