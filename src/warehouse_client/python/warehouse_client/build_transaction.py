# SPDX-License-Identifier: Apache-2.0
"""A change of the whole warehouse, of which no half remains; physics is paused meanwhile."""

BUILDING = "/warehouse/building"


class BuildTransaction:
    """`ros` is rospy, `engine` an engine.Engine.

    The parameter BUILDING stays where a builder dies before it commits. Who comes after it learns
    from there that what stands is half a warehouse, and whether physics shall go on.
    """

    def __init__(self, ros, engine):
        self._ros, self._engine = ros, engine

    @property
    def is_unfinished(self):
        return is_building(self._ros)

    def begin(self, name):
        """Pauses physics, to build the warehouse of that name."""
        resumes = self._resumes()
        self._ros.set_param(BUILDING, {"warehouse": name, "resumes": resumes})
        self._engine.pause()

    def _resumes(self):
        """Whether physics goes on afterwards: as it did before the build."""
        mark = self._ros.get_param(BUILDING, None)
        if isinstance(mark, dict) and "resumes" in mark:
            return bool(mark["resumes"])
        return not self._engine.is_paused()

    def commit(self):
        """What stands is whole. Physics goes on, if it did before."""
        if self._resumes():
            self._engine.resume()
        self._ros.delete_param(BUILDING)


def is_building(ros):
    """Returns whether a builder is at work, or died while building."""
    return ros.has_param(BUILDING)
