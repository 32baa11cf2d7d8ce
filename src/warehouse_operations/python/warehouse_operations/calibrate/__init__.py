# SPDX-License-Identifier: Apache-2.0
"""Calibration: what a recording says of robots, stations, batteries and failures.

`recording` is what all sources become: tracks of robots, actions, service times. `bag`, `messages`
(VDA 5050) and `shift_database` read one source each. `motion`, `battery`, `breakdowns` and
`service` find parameters; `estimates` has the statistics. `realism_file` writes a file that
`realism:=` and layouts take; `program` is the command.
"""
