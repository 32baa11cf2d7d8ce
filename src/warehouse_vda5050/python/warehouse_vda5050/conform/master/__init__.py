# SPDX-License-Identifier: Apache-2.0
"""Plays vehicles towards a master of any maker, and judges what it sends by the specification.

stage          what a case has in its hands: vehicles, all messages, waiting for the master
actor          a vehicle on that stage: our own vehicle core with its own connection and will
open_floor     nodes anywhere, for its robot, which drives by a formula (`formula_driver`)
channel        how its messages travel: plainly, twice, late, swapped or not at all
facts          what holds of a vehicle, and since when: each order is judged by that
orders         orders in their context: what the vehicle had of them before
wire           the connections of the stage; `broker_wire` are those to an MQTT broker
form           the fields that orders and instant actions must have
runner         tries one case after another; `command` is the program
cases/         all of them, one file a subject
"""
