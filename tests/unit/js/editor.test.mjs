// SPDX-License-Identifier: Apache-2.0
// The layout editor's model: what is drawn, taken back, mirrored, repeated, and written as a file.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { copied, mirrored, putIn, repeated, replaced, turned } from '../../../src/warehouse_viewer/web/js/editor/blocks.js';
import { NEXT_STATION } from '../../../src/warehouse_viewer/web/js/editor/characters.js';
import { Drawing } from '../../../src/warehouse_viewer/web/js/editor/drawing.js';
import { History } from '../../../src/warehouse_viewer/web/js/editor/history.js';
import { clicked, drawLane, extended, laneOf } from '../../../src/warehouse_viewer/web/js/editor/lanes.js';
import { stepOf } from '../../../src/warehouse_viewer/web/js/editor/rulers.js';
import { areaCells, lineCells, outlineCells, rectangleCells, straightCells } from '../../../src/warehouse_viewer/web/js/editor/shapes.js';
import { drawingOf, jsonOf, textOf } from '../../../src/warehouse_viewer/web/js/editor/text.js';
import { paint } from '../../../src/warehouse_viewer/web/js/editor/tools.js';
import { View } from '../../../src/warehouse_viewer/web/js/editor/view.js';

/** A drawing of lines, the highest first; its lowest cell is [0, 0]. */
function drawn(...lines) {
  const out = new Drawing();
  lines.toReversed().forEach((line, row) => [...line].forEach((char, column) => {
    if (char !== ' ') out.set(column, row, char);
  }));
  return out;
}

const linesOf = (drawing) => jsonOf(drawing).floor;

test('paper grows where something is drawn, also below zero', () => {
  const drawing = drawn('.');
  assert.ok(drawing.set(-40, -3, 's'));
  assert.ok(drawing.set(50, 60, 'p'));
  assert.deepEqual([drawing.get(0, 0), drawing.get(-40, -3), drawing.get(50, 60)], ['.', 's', 'p']);
  assert.deepEqual(drawing.bounds(), { left: -40, bottom: -3, right: 51, top: 61 });
  assert.equal(drawing.set(5000, 0, '.'), false);
});

test('a brush draws each character, and no floor erases', () => {
  const drawing = new Drawing();
  for (const char of '.><^v-|spc#=x') {
    paint(drawing, [[0, 0]], char);
    assert.equal(drawing.get(0, 0), char);
  }
  paint(drawing, [[0, 0]], ' ');
  assert.equal(drawing.bounds(), null);
});

test('a letter is a station, and there is one of each', () => {
  const drawing = drawn('.....');
  paint(drawing, [[1, 0]], NEXT_STATION);
  paint(drawing, [[3, 0]], NEXT_STATION);
  assert.deepEqual(drawing.stations.map((s) => [s.key, s.name]), [['A', 'pick1'], ['B', 'pick2']]);
  paint(drawing, [[4, 0]], 'A');
  assert.deepEqual(linesOf(drawing), ['...BA']);
  assert.deepEqual(drawing.stations[0].service, [4, 0]);
  paint(drawing, [[3, 0]], 's');
  assert.deepEqual(drawing.stations.map((s) => s.key), ['A']);
});

test('the twenty-seventh station has two letters and no drawn one', () => {
  const drawing = new Drawing();
  for (let i = 0; i < 28; i++) drawing.addStation([i, 0]);
  assert.deepEqual(drawing.stations.slice(-2).map((s) => s.key), ['AA', 'AB']);
  assert.equal(drawing.get(26, 0), '.');
  assert.match(textOf(drawing).text, /AA: {"name":"pick27","kind":"pick","service":\[26,0\]}/);
});

test('what is drawn over a lane cuts it there, as the station sees it', () => {
  const drawing = drawn('.......'), station = drawing.addStation([3, 0]);
  drawLane(drawing, station, 'queue', [[0, 0], [1, 0], [2, 0]]);
  drawLane(drawing, station, 'exit', [[4, 0], [5, 0], [6, 0]]);
  drawing.set(1, 0, '>');
  assert.equal(station.queue.length, 3, 'a street may be part of a lane');
  drawing.set(1, 0, '#');
  drawing.set(5, 0, 's');
  assert.deepEqual([station.queue, station.exit], [[[2, 0]], [[4, 0]]]);
});

test('undo and redo go back and forth, and a new change forgets what was taken back', () => {
  const history = new History();
  let drawing = drawn('.');
  const change = (char) => {
    history.keep(drawing);
    drawing.set(0, 0, char);
  };
  change('s');
  drawing.addStation([2, 0]);
  change('p');
  drawing = history.undo(drawing);
  assert.deepEqual(linesOf(drawing), ['s A']);
  drawing = history.undo(drawing);
  assert.deepEqual([linesOf(drawing), drawing.stations], [['.'], []]);
  assert.equal(history.undo(drawing), undefined);
  drawing = history.redo(drawing);
  drawing = history.redo(drawing);
  assert.deepEqual(linesOf(drawing), ['p A']);
  assert.equal(history.redo(drawing), undefined);
  drawing = history.undo(drawing);
  change('c');
  assert.equal(history.redo(drawing), undefined);
});

test('lines are joined cell by cell, and streets straight', () => {
  const cells = lineCells([0, 0], [3, -2]);
  assert.equal(cells.length, 6);
  cells.slice(1).forEach(([x, y], i) => assert.equal(Math.abs(x - cells[i][0]) + Math.abs(y - cells[i][1]), 1));
  assert.deepEqual(cells.at(-1), [3, -2]);
  assert.deepEqual(straightCells([0, 0], [3, 1]).at(-1), [3, 0]);
  assert.equal(rectangleCells([2, 2], [0, 0]).length, 9);
  assert.equal(outlineCells([0, 0], [3, 2]).length, 10);
});

test('an area ends at other characters; empty paper has no end', () => {
  const drawing = drawn('####', '#  #', '#  #', '####');
  assert.equal(areaCells(drawing, [1, 1]).length, 4);
  assert.equal(areaCells(drawing, [9, 9]), null);
  assert.equal(areaCells(drawing, [0, 0]).length, 12);
});

test('a mirror turns arrows, stations and lanes', () => {
  const drawing = drawn('>^s', 'A.-'), [station] = drawing.stations;
  drawLane(drawing, station, 'exit', [[1, 0]]);
  const all = drawing.bounds();
  replaced(drawing, all, mirrored(copied(drawing, all), 'x'));
  assert.deepEqual(linesOf(drawing), ['s^<', '-.A']);
  assert.deepEqual(drawing.stations.map((s) => [s.key, s.name, s.service, s.exit]), [['A', 'pick1', [2, 0], [[1, 0]]]]);
  replaced(drawing, all, mirrored(copied(drawing, all), 'y'));
  assert.deepEqual(linesOf(drawing), ['-.A', 'sv<']);
  replaced(drawing, all, turned(copied(drawing, all)));
  assert.deepEqual(linesOf(drawing), ['Av', '.>', '|s']);
});

test('a copy has stations of its own with their lanes', () => {
  const drawing = drawn('..A..');
  drawLane(drawing, drawing.stations[0], 'queue', [[0, 0], [1, 0]]);
  putIn(drawing, copied(drawing, drawing.bounds()), [0, 2]);
  assert.deepEqual(linesOf(drawing), ['..B..', '     ', '..A..']);
  assert.deepEqual(drawing.stations[1], { ...drawing.stations[0], key: 'B', name: 'pick2', service: [2, 2], queue: [[0, 2], [1, 2]] });
});

test('a block is repeated with gaps between', () => {
  const drawing = drawn('ss'), rect = repeated(drawing, drawing.bounds(), 3, 2, 1);
  assert.deepEqual(linesOf(drawing), ['ss ss ss', '        ', 'ss ss ss']);
  assert.deepEqual(rect, drawing.bounds());
});

test('a lane is drawn either way, and back', () => {
  const station = { service: [5, 0], queue: [], exit: [] };
  let path = extended([], [1, 0]);
  path = extended(path, [5, 0]);
  assert.deepEqual(laneOf(path, station, 'queue'), [[1, 0], [2, 0], [3, 0], [4, 0]]);
  assert.deepEqual(laneOf(path.toReversed(), station, 'queue'), [[1, 0], [2, 0], [3, 0], [4, 0]]);
  assert.deepEqual(laneOf([[8, 0], [7, 0], [6, 0]], station, 'exit'), [[6, 0], [7, 0], [8, 0]]);
  assert.deepEqual(laneOf([[2, 0], [3, 0], [4, 0]], station, 'queue'), [[2, 0], [3, 0], [4, 0]]);
  assert.deepEqual(extended(path, [2, 0]), [[1, 0], [2, 0]]);
});

test('single clicks draw a lane on its outer end', () => {
  const station = { service: [5, 0], queue: [], exit: [] };
  for (const cell of [[4, 0], [4, 1], [9, 9]]) station.queue = clicked(station, 'queue', cell);
  assert.deepEqual(station.queue, [[4, 1], [4, 0]]);
  assert.deepEqual(clicked(station, 'queue', [4, 1]), [[4, 0]]);
});

test('a lane becomes floor, and leaves the lane of another', () => {
  const drawing = drawn('s....'), [a, b] = [drawing.addStation([4, 0]), drawing.addStation([2, 1])];
  drawLane(drawing, a, 'queue', [[0, 0], [1, 0], [2, 0], [3, 0]]);
  drawLane(drawing, b, 'queue', [[1, 0], [1, 1]]);
  assert.deepEqual(a.queue, [[2, 0], [3, 0]]);
  assert.deepEqual(linesOf(drawing), [' .B  ', '....A']);
});

test('a file says what was drawn, from its lowest cell on, and comes back the same', () => {
  const drawing = drawn('.s.', ' .A');
  const [station] = drawing.stations;
  Object.assign(drawing, { name: 'a "b": #1', robots: [[0, 1]], units: 1, spacing: 0.9, policies: { idle: 'x' } });
  drawing.elevators = [{ name: 'lift', cells: [[0, 1], [2, 1]], seconds: 10 }];
  drawLane(drawing, station, 'queue', [[1, 0]]);
  drawing.set(-2, -1, '.');
  const { text, origin } = textOf(drawing);
  assert.deepEqual(origin, [-2, -1]);
  assert.equal(text, `layout: 1
name: "a \\"b\\": #1"
spacing: 0.9
floor: |2
    .s.
     .A
  .    
stations:
  A: {"name":"pick1","kind":"pick","queue":[[3,1]]}
elevators:
  lift: {"cells":[[2,2],[4,2]],"seconds":10}
storage_units: 1.0
robots: [[2,2]]
items: 4
policies: {"idle":"x"}
`);
  const again = drawingOf(JSON.parse(JSON.stringify(jsonOf(drawing))));
  assert.equal(textOf(again).text, text);
  assert.deepEqual(again.stations[0].service, station.service, 'where it was on the paper');
});

test('counts follow what is drawn', () => {
  const drawing = drawn('ssssssssss', 'pp........');
  assert.deepEqual([drawing.places, drawing.unitCount, drawing.itemCount, drawing.robotCount], [10, 9, 36, 0]);
  drawing.units = [[0, 1], [1, 1]];
  drawing.robots = [[0, 0], [1, 0]];
  drawing.set(0, 1, '.');
  drawing.set(1, 0, '#');
  assert.deepEqual([drawing.unitCount, drawing.robotCount], [1, 1]);
});

test('a hall stays where it is when more is drawn on its left', () => {
  const drawing = drawingOf({ ...jsonOf(drawn('...')), building: 'hall.sdf', at: null });
  assert.deepEqual(jsonOf(drawing).at, [-1, 0]);
  drawing.set(-1, 0, '.');
  assert.deepEqual(jsonOf(drawing).at, [-2, 0]);
});

test('a view finds the cell beneath a point, at any zoom', () => {
  const view = new View();
  view.resize(800, 600);
  view.show({ left: -3, bottom: 2, right: 30, top: 20 });
  for (const factor of [1, 1.7, 0.3]) {
    view.zoom(factor, 100, 500);
    assert.deepEqual(view.cellAt(...view.centreOf([7, 11])), [7, 11]);
  }
  assert.deepEqual([0.3, 1, 3, 7, 18].map(stepOf), [0.5, 1, 5, 10, 20]);
});

test('short cuts of a queue are written, move with it, and go with its cells', () => {
  const drawing = drawn('..A..', '.....');
  const [station] = drawing.stations;
  drawing.setLane(station, 'queue', [[0, 0], [0, 1], [1, 1]]);
  station.short_cuts = [[[2, 0], [2, 1]], [[1, 0], [1, 1]]];
  assert.match(textOf(drawing).text, /"short_cuts":\[\[\[2,0\],\[2,1\]\],\[\[1,0\],\[1,1\]\]\]/);
  assert.deepEqual(drawingOf(jsonOf(drawing)).stations[0].short_cuts, station.short_cuts);
  const block = mirrored(copied(drawing, drawing.bounds()), 'x'), other = drawn('.....', '.....');
  putIn(other, block, [0, 2]);
  assert.deepEqual(other.stations[0].short_cuts, [[[2, 2], [2, 3]], [[3, 2], [3, 3]]]);
  drawing.setLane(station, 'queue', [[1, 1]]);
  assert.deepEqual(station.short_cuts, [[[2, 0], [2, 1]]]);
  paint(drawing, [[4, 1]], 'A');
  assert.deepEqual(drawing.stations[0].short_cuts, []);
});
