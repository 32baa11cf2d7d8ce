# SPDX-License-Identifier: Apache-2.0
"""The vehicle's side of VDA 5050 without ROS and MQTT: messages and reports in, states out."""

from warehouse_vda5050.vehicle.settings import VehicleSettings
from warehouse_vda5050.vehicle.vehicle import Vehicle

__all__ = ["Vehicle", "VehicleSettings"]
