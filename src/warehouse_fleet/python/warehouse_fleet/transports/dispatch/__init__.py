# SPDX-License-Identifier: Apache-2.0
"""The phases of a dispatcher, in the order in which Transports.advance() runs them each tick:

    recover   transports of robots that are lost or broken, units found without a transport
    carry     lifts, arrivals, releases: each transport goes on to its next step
    admit     units are lifted for stations that have room
    charge    robots go to a charging place (warehouse_fleet.transports.charging)
    assign    robots for open transports
    park      robots without work leave the streets

Each phase is a function over a Transports, which holds the book, the map of units and the robots.
"""
