# SPDX-License-Identifier: Apache-2.0
"""The phases of a dispatcher, in the order in which Transports.advance() runs them each tick:

    reject    transports of robots that can't carry the unit go to others
    recover   transports of robots that are lost or broken, units that robots carry without one
    lift      lifts that have ended: units go to their destinations, or are stored
    arrive    robots that have arrived beneath a unit, at a destination or at a storage place
    depart    units that have been released leave their destinations
    admit     units are lifted for stations that have room
    charge    robots go to a charging place (warehouse_fleet.transports.charging)
    assign    robots for open transports
    park      robots without work go where they are to wait
    clear     robots without work leave the streets

Each phase is a class that is constructed from the collaborators it needs, and has a run().
"""
