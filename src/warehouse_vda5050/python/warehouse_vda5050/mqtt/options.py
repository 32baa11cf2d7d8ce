# SPDX-License-Identifier: Apache-2.0
"""Arguments of programs by which they find a broker."""

import argparse

from warehouse_vda5050.mqtt.settings import BrokerSettings, read_settings


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds the arguments."""
    add = parser.add_argument
    add("--broker", default="localhost:1883", help="HOST:PORT of the MQTT broker")
    add("--tls", default="", help="true, or the file of a certificate authority")
    add("--user", default="", help="name to log in with")
    add("--password-file", default="", help="file with the password")


def settings_of(options: argparse.Namespace) -> BrokerSettings:
    """Returns the broker that arguments name. Raises BrokerError."""
    return read_settings(options.broker, options.tls, options.user, options.password_file)
