"""A map and its certificates with a progress bar, once they have taken over a second."""

from __future__ import annotations

from zwidth.progress import with_bar
from zwidth.study.maps.certificates import z_width_certificate as _certificate
from zwidth.study.maps.lines import robust_boundary as _robust
from zwidth.study.maps.walls import z_width as _map

z_width = with_bar(_map, "chunks")
robust_boundary = with_bar(_robust, "points")
z_width_certificate = with_bar(_certificate, "columns")
