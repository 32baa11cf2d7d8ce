# SPDX-License-Identifier: Apache-2.0
"""The master's side: vehicles behind a broker as robots of a warehouse, without ROS and MQTT."""
