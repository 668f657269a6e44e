"""A figure with what it rests on, and what it is about."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Figure:
    """A probability, smoothed, and what it rests on.

    `successes` of `trials` rooms (or placements); a source's unit may be worth a part of a room.
    `buildings` hold the trials; simulated sources don't tell theirs and count none.
    """

    p: float
    successes: float
    trials: float
    buildings: int
    source: str


@dataclass(frozen=True, slots=True)
class Rate:
    """The mean number of things in a room, smoothed, and what it rests on."""

    mean: float
    things: float
    rooms: float
    buildings: int
    source: str


@dataclass(frozen=True, slots=True)
class InRoom:
    """How likely a category is in a room of a category, and how many there are on average."""

    category: str
    room: str
    figure: Figure
    number: Rate


@dataclass(frozen=True, slots=True)
class Together:
    """How likely a category is in a room that holds the given one."""

    category: str
    given: str
    figure: Figure


@dataclass(frozen=True, slots=True)
class OnSupport:
    """How likely a thing of the category, where it is put, is put there."""

    thing: str
    support: str
    figure: Figure
