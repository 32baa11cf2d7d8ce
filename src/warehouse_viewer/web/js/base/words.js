// SPDX-License-Identifier: Apache-2.0
// The words for the constants of messages: the same on every page, and those of the API and of the
// events (message_names.py); a test compares them.

import { EventKind, FailureKind, OrderState, RobotMode, State } from './message_enums.js';
import { tr } from '../language/texts.js';

/** An array of the texts of {number: text}. */
const byNumber = (texts) => Object.assign([], texts);

/** What a robot does at a glance, by Activity (activities.py), from what needs no attention to what
 *  needs a person; a `waiting` robot has waited for half a minute, in a station's queue for two
 *  minutes, or stands before an obstacle. */
export const ACTIVITY = [tr`resting`, tr`moving`, tr`working`, tr`waiting`, tr`needs help`];
export const NEEDS_HELP = 4;
export const Activity = { WAITING: 3, NEEDS_HELP };
/** The names of the activities in the API. */
export const ACTIVITY_NAMES = ['RESTING', 'MOVING', 'WORKING', 'WAITING', 'NEEDS_HELP'];
/** The class that gives each its colour; design.css has them. */
export const ACTIVITY_CLASS = ACTIVITY_NAMES.map((name) => name.toLowerCase().replace('_', '-'));
/** What a station does at a glance, by the same activities. */
export const STATION_STATES = {
  RESTING: tr`nothing to do`, MOVING: tr`unit on its way`, WORKING: tr`at work`, WAITING: tr`waits for units`, NEEDS_HELP: tr`needs a person`,
};
/** What a robot does in detail, by State. */
export const STATE = byNumber({
  [State.IDLE]: tr`stands`,
  [State.MOVING_X]: tr`drives`,
  [State.MOVING_Y]: tr`drives`,
  [State.ROTATING]: tr`turns`,
  [State.LIFTING]: tr`lifts`,
  [State.BLOCKED]: tr`stands before an obstacle`,
  [State.WAITING]: tr`waits for its turn`,
  [State.STEERED]: tr`driven by cmd_vel`,
});
/** Who commands a robot. */
export const MODE_WORDS = { [RobotMode.AUTOMATIC]: tr`automatic`, [RobotMode.MANUAL]: tr`manual`, [RobotMode.OUT_OF_SERVICE]: tr`out of service` };
/** What is broken, by bit: an empty battery, then the kinds of failures. */
export const FAILURE = byNumber({
  0: tr`battery empty`,
  [FailureKind.MOTOR]: tr`drive`,
  [FailureKind.LIFT_STUCK]: tr`lift stuck`,
  [FailureKind.LASER_BLIND]: tr`laser blind`,
  [FailureKind.RADIO_LOST]: tr`radio lost`,
  [FailureKind.WHEEL_SLIPS]: tr`wheels slip`,
  6: tr`out of order`,
});
/** What the coordinator has robots do, in the order of a transport; `idle` robots have no transport. */
export const WORK = ['fetching', 'ready', 'lifting', 'bringing', 'waiting', 'storing', 'dropping', 'idle'];
const WORK_TEXTS = {
  fetching: tr`fetching`, ready: tr`ready beneath a unit`, lifting: tr`lifting`, bringing: tr`bringing`, waiting: tr`at a station`,
  storing: tr`storing`, dropping: tr`dropping`, idle: tr`without work`,
};
/** Names that are counted as the API has them. */
const COUNTED = { automatic: tr`automatic`, manual: tr`manual`, out_of_service: tr`out of service` };
/** {name of work: count} as '2 fetching, 1 at a station'. */
export function countedWork(work) {
  return counted(Object.fromEntries(WORK.map((name) => [WORK_TEXTS[name], work[name]])));
}
/** Kinds of events that a person may have to look after. */
export const TROUBLE = [EventKind.REFUSED, EventKind.BLOCKED, EventKind.COLLISION, EventKind.FAILED,
  EventKind.LOST, EventKind.TIPPED, EventKind.FELL];
/** What an event says at a glance, by its kind; `ALARM` and `ALARM_OVER` are the viewer's own. */
export const EVENTS = {
  [EventKind.ACCEPTED]: tr`accepted`, [EventKind.REFUSED]: tr`refused`, [EventKind.DONE]: tr`done`, [EventKind.BLOCKED]: tr`stopped`,
  [EventKind.LIFTED]: tr`lifted`, [EventKind.DROPPED]: tr`put down`, [EventKind.COLLISION]: tr`collision`, [EventKind.SPAWNED]: tr`added`,
  [EventKind.DELETED]: tr`removed`, [EventKind.LOST]: tr`lost`, [EventKind.FAILED]: tr`broken`, [EventKind.REPAIRED]: tr`repaired`,
  [EventKind.TIPPED]: tr`tipped`, [EventKind.FELL]: tr`fell off`, [EventKind.PICKED_UP]: tr`picked up`,
  ALARM: tr`alarm`, ALARM_OVER: tr`alarm over`, ZONE_CLOSED: tr`closed`, ZONE_OPENED: tr`opened`, ZONE_ENDED: tr`opened`,
};
/** The state of an order; `at` precedes the name of its station. */
export const ORDER_STATES = {
  [OrderState.OPEN]: tr`open`,
  [OrderState.ASSIGNED]: tr`at`,
  [OrderState.COMPLETED]: tr`done`,
  [OrderState.CANCELLED]: tr`cancelled`,
};

/** A name of several words, as in out_of_service. */
function spaced(name) {
  return name.replaceAll('_', ' ');
}

/** {name: count} as '2 waiting, 1 out of service'. */
export function counted(counts, none = tr`none`) {
  return Object.entries(counts).filter(([, count]) => count > 0)
    .map(([name, count]) => `${count} ${COUNTED[name] ?? spaced(name)}`).join(', ') || none;
}

/** The name of a thing, or a sentence with names in it, as a person reads it: 'unit 12' is storage_unit12. */
export function shownName(text) {
  return text.replaceAll(/\bstorage_unit(?=\d)/g, 'unit ').replaceAll(/\bitem(?=\d)/g, 'item ').replaceAll(/\bperson(?=\d)/g, 'person ')
    .replaceAll(/\bfollow path (?=\d)/g, 'route ');
}
