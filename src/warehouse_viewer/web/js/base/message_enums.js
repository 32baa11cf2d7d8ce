// SPDX-License-Identifier: Apache-2.0
// The constants of messages; written by scripts/message_enums from the messages of warehouse_msgs.
// Numbers where the server sends numbers, names where the API sends names.

/** The status of a robot. */
export const Status = Object.freeze({
  IDLE: 0,
  BUSY: 1,
  BLOCKED: 2,
});

/** The activity of a robot. */
export const State = Object.freeze({
  IDLE: 0,
  MOVING_X: 1,
  MOVING_Y: 2,
  ROTATING: 3,
  LIFTING: 4,
  BLOCKED: 5,
  WAITING: 6, // stands at the last released point of its path
  STEERED: 7, // is driven by /kiva<id>/cmd_vel
});

/** The failures of a robot. */
export const FailureKind = Object.freeze({
  REPAIRED: 0, // nothing is broken in it any more
  MOTOR: 1, // the drive has no torque, and its brakes close: it stands where it can
  LIFT_STUCK: 2, // the tower stands wherever it is
  LASER_BLIND: 3, // no scans, and the robot stands, since it does not see people
  RADIO_LOST: 4, // it hears and reports nothing; it completes the commands that it has
  WHEEL_SLIPS: 5, // less grip: it turns and brakes as that allows
});

/** What a robot is to do with a storage unit. */
export const LiftStatus = Object.freeze({
  DROP: 0,
  CARRY: 1,
});

/** The direction of a turn. */
export const Turn = Object.freeze({
  CLOCKWISE: -1,
  COUNTERCLOCKWISE: 1,
});

/** The kinds of events. */
export const EventKind = Object.freeze({
  ACCEPTED: 'ACCEPTED',
  REFUSED: 'REFUSED',
  DONE: 'DONE',
  BLOCKED: 'BLOCKED',
  LIFTED: 'LIFTED',
  DROPPED: 'DROPPED',
  COLLISION: 'COLLISION',
  SPAWNED: 'SPAWNED',
  DELETED: 'DELETED',
  LOST: 'LOST', // a robot no longer knows where it is, and stops
  FAILED: 'FAILED', // something in a robot is broken
  REPAIRED: 'REPAIRED',
  TIPPED: 'TIPPED', // a storage unit tipped off the robot that carried it
  FELL: 'FELL', // an item fell off its storage unit (other)
  PICKED_UP: 'PICKED_UP', // an item that fell is back on its storage unit (other)
});

/** Which side commands a robot. */
export const RobotMode = Object.freeze({
  AUTOMATIC: 'AUTOMATIC', // the coordinator
  MANUAL: 'MANUAL', // a person; others drive around it
  OUT_OF_SERVICE: 'OUT_OF_SERVICE', // no one; the robot is an obstacle
});

/** The state of an order. */
export const OrderState = Object.freeze({
  OPEN: 'OPEN', // no station has it
  ASSIGNED: 'ASSIGNED',
  COMPLETED: 'COMPLETED',
  CANCELLED: 'CANCELLED',
});

/** Whether a station works by itself or waits for a person. */
export const StationMode = Object.freeze({
  AUTOMATIC: 'AUTOMATIC',
  MANUAL: 'MANUAL', // it waits for /warehouse/confirm_pick
});

/** How a person's task at a station ended. */
export const PickOutcome = Object.freeze({
  DONE: 'DONE', // so many pieces were taken, or a bundle of so many was put in
  SHORT: 'SHORT', // so many pieces are missing; at a picking station 0: the bin is empty
  DAMAGED: 'DAMAGED', // so many pieces are damaged
});
