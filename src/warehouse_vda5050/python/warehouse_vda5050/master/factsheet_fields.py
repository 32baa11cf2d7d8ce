# SPDX-License-Identifier: Apache-2.0
"""The fields of a vehicle's factsheet that the master reads, and what it makes of each; for the
reference. Names are those of 2.1.0."""

FIELDS = (
    ("typeSpecification.seriesName, agvKinematic, agvClass", "shown to a person"),
    ("typeSpecification.maxLoadMass", "a heavier unit is refused; 0 is no limit"),
    ("typeSpecification.supportedZones", "3.0.0: closed zones of the floor that it is sent"),
    (
        "physicalParameters.speedMax",
        "no maxSpeed is above it; beyond 1.2 times of it, if that is"
        " more than 3 m/s, the vehicle has jumped",
    ),
    ("physicalParameters.accelerationMax, decelerationMax", "checked; plans assume the fleet's"),
    ("physicalParameters.length, width, heightMax", "checked, and compared with a cell"),
    (
        "protocolLimits.maxArrayLens.order.nodes, order.edges",
        "the rest of an order comes in the next update; 0 is no limit",
    ),
    (
        "protocolLimits.maxStringLens.idLen, idNumericalOnly, enumLen, loadIdLen",
        "an order or a zone set with a longer string, or an id that is no number, is refused by"
        " its field; ids of instant actions are made so; 0 is no limit",
    ),
    (
        "protocolLimits.maxStringLens.msgLen",
        "orders have as few nodes as it takes; the rest comes in updates; a longer zone set is"
        " refused",
    ),
    (
        "protocolLimits.maxArrayLens.node.actions, actions.actionsParameters",
        "an order with more is refused",
    ),
    (
        "protocolLimits.maxArrayLens.instantActions",
        "further ones come in the next message",
    ),
    ("protocolLimits.timing.minOrderInterval", "orders keep it"),
    (
        "protocolFeatures.optionalParameters",
        "REQUIRED: maxSpeed and length of edges are sent then;"
        " a path is refused if another field is required",
    ),
    (
        "protocolFeatures.agvActions.actionType, actionScopes",
        "a lift is refused without pick or drop at nodes",
    ),
    (
        "protocolFeatures.agvActions.actionParameters",
        "others than these are not sent; a lift is"
        " refused if one that is not optional (isOptional is false) is given by nothing",
    ),
    (
        "protocolFeatures.agvActions.blockingTypes",
        "a lift is sent as HARD, else SOFT, SINGLE, NONE, whichever is allowed",
    ),
    (
        "loadSpecification.loadSets.loadType",
        "that of the first load set which fits the unit is"
        " sent; one of action_parameters that no load set has is refused",
    ),
    ("loadSpecification.loadSets.maxWeight", "a heavier unit is refused"),
    (
        "loadSpecification.loadSets.loadDimensions",
        "a larger unit is refused, whichever way it is turned",
    ),
    ("loadSpecification.loadSets.agvSpeedLimit", "no maxSpeed is above it while it carries"),
)
