# SPDX-License-Identifier: Apache-2.0
"""What the warehouse's own programs are told of its vehicles: the topic /warehouse/vda5050."""

from typing import Any

import rospy

from warehouse_msgs.msg import Vda5050
from warehouse_vda5050.vehicles import Vehicles


class VehiclesTopic:
    """Publishes which robots an outside master drives; latched, sent when something changed."""

    def __init__(self, broker: str) -> None:
        self._broker = broker
        self._told: Any = None
        self._publisher = rospy.Publisher(
            "/warehouse/vda5050", Vda5050, latch=True, queue_size=1
        )

    def tell(self, vehicles: Vehicles) -> None:
        """Publishes if something changed."""
        message = vehicles_message(vehicles, self._broker)
        if message != self._told:
            self._told = message
            self._publisher.publish(message)


def vehicles_message(vehicles: Vehicles, broker: str) -> Vda5050:
    """Returns the message of all vehicles."""
    links = sorted(vehicles.links.items())
    message = Vda5050(broker=broker, direction=Vda5050.VEHICLE)
    message.connection = [
        Vda5050.ONLINE if link.link.connected else Vda5050.CONNECTIONBROKEN for _, link in links
    ]
    for kiva_id, link in links:
        vehicle, order = link.vehicle, link.vehicle.order
        message.kiva_id.append(kiva_id)
        message.manufacturer.append(link.identity.manufacturer)
        message.serial.append(link.identity.serial)
        message.order.append(order.id if order and not vehicle.is_free else "")
        errors = [f"{error.type}: {error.description}" for error in vehicle.told_errors()]
        message.errors.append("\n".join(errors))
        message.driven.append(vehicle.is_taken)
    return message
