"""Tracks as the map states them: entities with box, affordances, beliefs and support."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence

from afkb.flow import Entity, NodeKind
from afkb.inference import Network
from afkb_mapping.things.footprint import Outline
from afkb_mapping.things.same_thing import around
from afkb_mapping.things.standing import STANDS_WITHIN_M, support_of
from afkb_mapping.things.track_index import TrackIndex
from afkb_mapping.things.tracks import ObservedTrack
from afkb_mapping.visits.persistence import hazard_of

EXISTS_FROM = 0.5
DOUBTFUL_FROM = 0.2
"""At odds of one to four, surroundings seldom make a thing of what was seen."""
CONVINCING = 0.4
"""A thing whose views, all in all, doubt more than this that it affords anything is none: furniture
that looks like a thing from everywhere, or a false cue that a few views gave."""
SUSTAINED = 0.8
"""A thing seen in one view only is kept if that view was this sure of it."""
FAINT = 0.05
"""What a thing affords less surely than this is not worth stating."""
SMALLEST_SURFACE_M2 = 0.02
SURFACE_THICKNESS_M = 0.02


def doubtful_entities(tracks: Sequence[ObservedTrack], network: Network) -> list[Entity]:
    """Entities of the tracks that are not sure enough by themselves, but may be by context."""
    doubtful = {t.id for t in tracks if is_considered(t) and not is_kept(t)}
    found = observed_entities(tracks, network, is_considered)
    return [e for e in found if e.id in doubtful]


def observed_entities(
    tracks: Sequence[ObservedTrack],
    network: Network,
    keep: Callable[[ObservedTrack], bool] | None = None,
) -> list[Entity]:
    """Entities (V_ao) of the tracks that are sure enough, in order of discovery."""
    kept = [t for t in tracks if (keep or is_kept)(t)]
    index = TrackIndex.of(kept)
    held = {t.id: holder for t in kept if t.is_surface and (holder := _holder(t, index))}
    lids = {held[t.id].id: t for t in kept if t.id in held and _is_lid(t, held[t.id])}
    kept = [t for t in kept if t.id not in held]
    outlines = {t.id: t.footprint.outline() for t in kept}
    index = TrackIndex.of(kept)
    known = {t.id for t in kept}
    return [
        _observed(
            t, outlines[t.id], support_of(t, index.carriers(t)), known, network, lids.get(t.id)
        )
        for t in kept
        if t.is_floor or not t.is_surface or outlines[t.id].area_m2 >= SMALLEST_SURFACE_M2
    ]


def is_considered(track: ObservedTrack) -> bool:
    """Whether its surroundings may make a track sure enough: not where it was seen to be gone."""
    return (
        not track.empty_from.seen_from
        and bool(track.footprint)
        and track.existence >= DOUBTFUL_FROM
        and track.conviction >= CONVINCING
    )


def is_kept(track: ObservedTrack) -> bool:
    """Whether a track is sure enough to be stated in the map."""
    if track.existence < EXISTS_FROM or not track.footprint:
        return False
    if track.conviction < CONVINCING:
        return False
    return track.observations > 1 or track.existence >= SUSTAINED


def _holder(surface: ObservedTrack, index: TrackIndex) -> ObservedTrack | None:
    """The container whose own lid or inside a surface is: one thing is one node."""
    if surface.is_floor:
        return None
    points = surface.footprint.points()
    for thing in index.near(*around(points, surface.footprint.cell_m)):
        if thing.is_surface or thing.affordances.get("ContainAbility", 0.0) < EXISTS_FROM:
            continue
        within = thing.bottom.value < surface.top.value <= thing.top.value + STANDS_WITHIN_M
        if within and thing.footprint.share_within(points, surface.footprint.cell_m) > 0.7:
            return thing
    return None


def _is_lid(surface: ObservedTrack, thing: ObservedTrack) -> bool:
    return abs(surface.top.value - thing.top.value) <= STANDS_WITHIN_M


def _observed(
    track: ObservedTrack,
    outline: Outline,
    support: ObservedTrack | None,
    known: Collection[str],
    network: Network,
    lid: ObservedTrack | None,
) -> Entity:
    """The track as an entity; with a `lid` it supports what its lid does."""
    top = 0.0 if track.is_floor else track.top.value
    bottom = top - SURFACE_THICKNESS_M if track.is_surface else min(track.bottom.value, top)
    size = (*outline.size_xy, top - bottom)
    told = {**(lid.affordances if lid else {}), **track.affordances}
    affordances = {n: p for n, p in sorted(told.items()) if p >= FAINT}
    supports = track.is_surface or affordances.get("SupportAbility", 0.0) >= EXISTS_FROM
    z = top if supports else (top + bottom) / 2
    belief, movability, weight = {"Floor": 1.0}, "Static", 1.0
    if not track.is_floor:
        known_ones = network.known(affordances)
        belief = network.category_posterior(known_ones, size, top, track.extent_known)
        movability, weight = network.movability(belief)
    return Entity(
        id=track.id,
        kind=NodeKind.OBSERVED,
        position_xyz=(*outline.center_xy, z),
        size_xyz=size,
        yaw=outline.yaw,
        affordances=affordances,
        existence=track.existence,
        category_belief=belief,
        movability=movability,
        matching_weight=weight,
        observations=track.observations,
        first_seen=track.first_seen,
        last_seen=track.last_seen,
        seen_from=tuple(track.places),
        generated_by=tuple(track.detectors),
        supported_by=support.id if support else None,
        predicted_from=tuple(i for i in track.predicted_from if i in known),
        predicted_first=track.predicted_first,
        axioms=tuple(track.axioms),
        extent_known=track.extent_known,
        polygon_xy=outline.polygon_xy,
        sightings=tuple(track.sightings),
        history=tuple(track.life.history),
    )


def hazard_of_track(track: ObservedTrack, network: Network) -> float:
    """Rate, 1/s, at which such things are moved: by the movability of what it may be."""
    if not track.footprint:
        return 0.0
    outline, top = track.footprint.outline(), track.top.value
    bottom = top - SURFACE_THICKNESS_M if track.is_surface else min(track.bottom.value, top)
    affordances = {n: p for n, p in track.affordances.items() if p >= FAINT}
    belief = network.category_posterior(
        network.known(affordances), (*outline.size_xy, top - bottom), top, track.extent_known
    )
    return hazard_of(network.movability(belief)[1])
