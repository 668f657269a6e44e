"""Where on Earth a map is."""

from __future__ import annotations

import math
from dataclasses import dataclass

_EQUATOR_M = 6_378_137.0
_ECCENTRICITY_SQUARED = 6.694_379_990_14e-3
"""The ellipsoid of WGS 84."""
_DIGITS = 9
"""Of degrees: 0.1 mm."""


@dataclass(frozen=True, slots=True)
class Anchor:
    """The map's origin (degrees north, degrees east) and where its x axis points.

    `heading_deg`: degrees clockwise from north.
    """

    latitude_deg: float
    longitude_deg: float
    heading_deg: float

    def lon_lat(self, x: float, y: float) -> tuple[float, float]:
        """Longitude and latitude (degrees) of a point of the map frame (m).

        Along the ellipsoid's two radii of curvature at the origin: 100 m from it this is right to
        2 mm at middle latitudes, and the error grows with the square of the distance.
        """
        heading, latitude = math.radians(self.heading_deg), math.radians(self.latitude_deg)
        east = x * math.sin(heading) - y * math.cos(heading)
        north = x * math.cos(heading) + y * math.sin(heading)
        bent = 1 - _ECCENTRICITY_SQUARED * math.sin(latitude) ** 2
        along_meridian = _EQUATOR_M * (1 - _ECCENTRICITY_SQUARED) / bent**1.5
        across = _EQUATOR_M / math.sqrt(bent)
        lat = self.latitude_deg + math.degrees(north / along_meridian)
        lon = self.longitude_deg + math.degrees(east / (across * math.cos(latitude)))
        return round((lon + 180) % 360 - 180, _DIGITS), round(lat, _DIGITS)


def anchor_of(text: object) -> Anchor | None:
    """An anchor written as LAT,LON,HEADING; raises `ValueError` for anything else.

    >>> anchor_of("48.15,11.58,90").heading_deg
    90.0
    """
    if text is None:
        return None
    try:
        latitude, longitude, heading = (float(part) for part in str(text).split(","))
    except ValueError:
        raise ValueError("write it as LAT,LON,HEADING in degrees, as 48.15,11.58,90") from None
    near_pole = not -85 <= latitude <= 85
    if near_pole or not -180 <= longitude <= 180 or not -360 <= heading <= 360:
        raise ValueError("latitude within 85, longitude within 180, heading within 360 degrees")
    return Anchor(latitude, longitude, heading)
