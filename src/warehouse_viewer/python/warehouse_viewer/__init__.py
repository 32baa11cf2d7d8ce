# SPDX-License-Identifier: Apache-2.0
"""The warehouse in a browser, in RViz and as a picture.

    page      what the page shows, made from the newest messages, for each browser
    server    the HTTP server: access control, tokens, connections, files
    editor    the layout editor's page, in the viewer or by itself
    api       the HTTP API of a warehouse behind ROS
    ros       the topics that are read and the services that are called
    drawing   the warehouse from above, as a picture or a film
    rviz      markers for RViz

`page`, `server` and `editor` import no ROS: they show a world of this process too.
"""
