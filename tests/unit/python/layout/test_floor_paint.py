# SPDX-License-Identifier: Apache-2.0
"""What is painted on the floor, told by messages: the same floor plan, shown by all pictures."""

import numpy as np
import pytest
from nav_msgs.msg import OccupancyGrid
from test_floor_plan import same

from kiva_plugin_cpp import World
from warehouse_layout.floor import floor_markings, palette, plan_reader
from warehouse_msgs.msg import FleetState, Look, Scenery, UnitStates, WarehouseObjects
from warehouse_viewer.drawing import markers
from warehouse_viewer.drawing.drawing import Drawing, Moment
from warehouse_viewer.page.model import Model

LANES = {"queue", "service", "exit"}
PAINTED = {"storage", "parking", "charging", "keep_out", "street"} | LANES


def look_of(world, name):
    visuals = world.visuals(name)
    links = list(dict.fromkeys(link for link, _, _ in visuals))
    return Look(
        links=links,
        link_pose=[0, 0, 0, 0, 0, 0, 1] * len(links),
        shape_link=[links.index(link) for link, _, _ in visuals],
        shape_kind=bytes(len(visuals)),
        shape_pose=[n for _, pose, _ in visuals for n in pose],
        shape_size=[n for _, _, size in visuals for n in size],
        shape_colour=[0.5] * 4 * len(visuals),
    )


@pytest.fixture(scope="module")
def world():
    return World.preset("small")


@pytest.fixture(scope="module")
def scenery(world):
    names = ["conveyor_belt1", "floor_markings1", "conveyor_belt2"]
    return Scenery(
        floor=list(world.floor),
        grid_spacing=1.0,
        looks=[look_of(world, name) for name in names[:2]],
        kiva_look=-1,
        storage_unit_look=-1,
        item_look=-1,
        models=names,
        model_look=[0, 1, 0],
        pose=[n for name in names for n in world.pose(name)],
    )


def grid_of(world):
    x, y, spacing, cells = world.occupancy()
    grid = OccupancyGrid(data=cells.astype(np.int8).ravel().tolist())
    grid.info.height, grid.info.width = cells.shape
    grid.info.resolution = spacing
    grid.info.origin.position.x, grid.info.origin.position.y = x - spacing / 2, y - spacing / 2
    return grid


def test_messages_tell_the_same_floor_plan_as_the_world(world, scenery):
    assert same(plan_reader.of_messages(grid_of(world), scenery), plan_reader.of_world(world))


def test_rviz_shows_paint_in_few_triangles_and_names_stations(world, scenery):
    marks = floor_markings.readable(scenery)
    paint, *names = markers.paint(marks)
    assert {name._marker.text for name in names} == {"pick1", "pick2", "replenish1"}
    assert len(paint.points) == 6 * len(marks)
    x0, x1, y0, y1 = world.floor
    assert (paint.points[:, :2] >= (x0, y0)).all() and (paint.points[:, :2] <= (x1, y1)).all()
    assert len(markers.scenery(scenery)) == 1  # the belts


def test_the_page_gets_rectangles_by_kind_and_stations(scenery):
    model = Model()
    objects = WarehouseObjects(belts=["conveyor_belt1", "conveyor_belt2"])
    model.update(objects, UnitStates(), FleetState(), scenery)
    scene = model.scene()
    assert scene["scenery"] == ["conveyor_belt1", "conveyor_belt2"]
    assert [len(look) > 0 for look in scene["looks"]] == [True, False]
    assert {station["name"] for station in scene["stations"]} == {"pick1", "pick2", "replenish1"}
    area = np.reshape(scene["paint"]["storage"], (-1, 4))[:, 2:]
    assert np.round(area + 0.1).prod(axis=1).sum() == 29  # places
    assert set(scene["paint"]) == PAINTED <= set(palette.CELLS)


def test_a_drawing_shows_where_units_are_served(scenery):
    moment = Moment(WarehouseObjects(), UnitStates(), FleetState(), scenery)
    drawing = Drawing(moment, dpi=50)
    drawing.draw(moment)
    colour = palette.rgb("service")
    far = np.abs(drawing.pixels() / 255 - colour).max(axis=2)
    assert (far < 0.02).sum() > 100
