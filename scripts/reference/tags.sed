# Tags in comments of C++ are words of SDF, and none of doxygen's.
:again
s,(///.*)<(/?[a-z_][^<>]*)>,\1\&lt;\2\&gt;,
t again
