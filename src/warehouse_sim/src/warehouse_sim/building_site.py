# SPDX-License-Identifier: Apache-2.0
"""The world while a warehouse is built in it: it stands still, and a parameter says for whom."""

BUILDING = "/warehouse/building"


class BuildingSite:
    """`ros` is rospy, `engine` an engine.Engine.

    The parameter stays where a builder dies before it closes the site; who comes after it learns
    from there that the pause is the builder's, and what stands is half a warehouse.
    """

    def __init__(self, ros, engine):
        self._ros, self._engine = ros, engine

    @property
    def is_open(self):
        return self._ros.has_param(BUILDING)

    def open(self, name):
        """Begins to build the warehouse of that name."""
        resumes = self._resumes()
        self._ros.set_param(BUILDING, {"warehouse": name, "resumes": resumes})
        self._engine.pause()

    def _resumes(self):
        """Whether physics goes on afterwards: as it did before anybody built."""
        mark = self._ros.get_param(BUILDING, None)
        if isinstance(mark, dict) and "resumes" in mark:
            return bool(mark["resumes"])
        return not self._engine.is_paused()

    def close(self):
        """What stands is whole. Physics goes on, if it did before."""
        if self._resumes():
            self._engine.resume()
        self._ros.delete_param(BUILDING)
