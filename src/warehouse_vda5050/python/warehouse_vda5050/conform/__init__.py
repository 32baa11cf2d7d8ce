# SPDX-License-Identifier: Apache-2.0
"""Plays the master towards a vehicle of any maker, or vehicles towards a master, and judges what
they do by the specification.

case       a sentence of the specification, and the function that tries it
cases/     all of them, one file a subject
probe      what a case has in its hands: send, wait, demand
log        every message, sent and received; `names` are those of 2.1.0 whatever the version
ground     where the vehicle may drive
broker     the connection to an MQTT broker; `proxy` is one in between that can be cut
runner     tries one case after another; `command` is the program
master/    the other half: vehicles on a stage, and cases for masters
report/    the result as HTML, JUnit XML and lines
"""
