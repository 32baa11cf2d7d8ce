# SPDX-License-Identifier: Apache-2.0
"""MQTT: connections to a broker, and a broker of one's own on the loopback."""
