// SPDX-License-Identifier: Apache-2.0
// The words for the constants of messages: the same on every page, and those of the API and of the
// events (message_names.py); a test compares them.

import { EventKind, FailureKind, OrderState, RobotMode, State } from './message_enums.js';

/** An array of the texts of {number: text}. */
const byNumber = (texts) => Object.assign([], texts);

/** What a robot does at a glance, by Activity (activities.py), from what needs no attention to what
 *  needs a person; a `waiting` robot has waited for half a minute, in a station's queue for two
 *  minutes, or stands before an obstacle. */
export const ACTIVITY = ['resting', 'moving', 'working', 'waiting', 'needs help'];
export const NEEDS_HELP = 4;
export const Activity = { WAITING: 3, NEEDS_HELP };
/** The class that gives each its colour; design.css has them. */
export const ACTIVITY_CLASS = ACTIVITY.map((word) => word.replace(' ', '-'));
/** The names of the activities in the API. */
export const ACTIVITY_NAMES = ACTIVITY.map((word) => word.replace(' ', '_').toUpperCase());
/** What a station does at a glance, by the same activities. */
export const STATION_STATES = {
  RESTING: 'nothing to do', MOVING: 'unit on its way', WORKING: 'at work', WAITING: 'waits for units', NEEDS_HELP: 'needs a person',
};
/** What a robot does in detail, by State. */
export const STATE = byNumber({
  [State.IDLE]: 'stands',
  [State.MOVING_X]: 'drives',
  [State.MOVING_Y]: 'drives',
  [State.ROTATING]: 'turns',
  [State.LIFTING]: 'lifts',
  [State.BLOCKED]: 'stands before an obstacle',
  [State.WAITING]: 'waits for its turn',
  [State.STEERED]: 'driven by cmd_vel',
});
/** Who commands a robot. */
export const MODE_WORDS = { [RobotMode.AUTOMATIC]: 'automatic', [RobotMode.MANUAL]: 'manual', [RobotMode.OUT_OF_SERVICE]: 'out of service' };
/** What is broken, by bit: an empty battery, then the kinds of failures. */
export const FAILURE = byNumber({
  0: 'battery empty',
  [FailureKind.MOTOR]: 'drive',
  [FailureKind.LIFT_STUCK]: 'lift stuck',
  [FailureKind.LASER_BLIND]: 'laser blind',
  [FailureKind.RADIO_LOST]: 'radio lost',
  [FailureKind.WHEEL_SLIPS]: 'wheels slip',
  6: 'out of order',
});
/** What the coordinator has robots do, in the order of a transport; `idle` robots have no transport. */
export const WORK = ['fetching', 'ready', 'lifting', 'bringing', 'waiting', 'storing', 'dropping', 'idle'];
/** Those of which the name says too little, or what an activity is called. */
const WORK_TEXTS = { waiting: 'at a station', ready: 'ready beneath a unit', idle: 'without work' };
/** {name of work: count} as '2 fetching, 1 at a station'. */
export function countedWork(work) {
  return counted(Object.fromEntries(WORK.map((name) => [WORK_TEXTS[name] ?? name, work[name]])));
}
/** Kinds of events that a person may have to look after. */
export const TROUBLE = [EventKind.REFUSED, EventKind.BLOCKED, EventKind.COLLISION, EventKind.FAILED,
  EventKind.LOST, EventKind.TIPPED, EventKind.FELL];
/** What an event says at a glance, by its kind; `ALARM` and `ALARM_OVER` are the viewer's own. */
export const EVENTS = {
  [EventKind.ACCEPTED]: 'accepted', [EventKind.REFUSED]: 'refused', [EventKind.DONE]: 'done', [EventKind.BLOCKED]: 'stopped',
  [EventKind.LIFTED]: 'lifted', [EventKind.DROPPED]: 'put down', [EventKind.COLLISION]: 'collision', [EventKind.SPAWNED]: 'added',
  [EventKind.DELETED]: 'removed', [EventKind.LOST]: 'lost', [EventKind.FAILED]: 'broken', [EventKind.REPAIRED]: 'repaired',
  [EventKind.TIPPED]: 'tipped', [EventKind.FELL]: 'fell off', [EventKind.PICKED_UP]: 'picked up',
  ALARM: 'alarm', ALARM_OVER: 'alarm over', ZONE_CLOSED: 'closed', ZONE_OPENED: 'opened', ZONE_ENDED: 'opened',
};
/** The state of an order; `at` precedes the name of its station. */
export const ORDER_STATES = {
  [OrderState.OPEN]: 'open',
  [OrderState.ASSIGNED]: 'at',
  [OrderState.COMPLETED]: 'done',
  [OrderState.CANCELLED]: 'cancelled',
};

/** A name of several words, as in out_of_service. */
function spaced(name) {
  return name.replaceAll('_', ' ');
}

/** {name: count} as '2 waiting, 1 out of service'. */
export function counted(counts, none = 'none') {
  return Object.entries(counts).filter(([, count]) => count > 0)
    .map(([name, count]) => `${count} ${spaced(name)}`).join(', ') || none;
}

/** The name of a thing, or a sentence with names in it, as a person reads it: 'unit 12' is storage_unit12. */
export function shownName(text) {
  return text.replaceAll(/\bstorage_unit(?=\d)/g, 'unit ').replaceAll(/\bitem(?=\d)/g, 'item ').replaceAll(/\bperson(?=\d)/g, 'person ')
    .replaceAll(/\bfollow path (?=\d)/g, 'route ');
}
