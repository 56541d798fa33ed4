"""Distances to a polyline: exact, in any number of dimensions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Nearest", "Polyline"]

BLOCK = 4096
"""Points looked at together, so that memory stays small."""

MOST_CANDIDATES = 1 << 18
"""Segments looked at together: of a point in the middle of an arc, all are equally near."""

ROUNDING = 1e-12

MOST_BETWEEN = 32
"""Vertices between the nearest places of two neighbouring points; with more the path is on another stretch."""

BESIDE = 8
"""Segments on each side that are looked at then."""


@dataclass(frozen=True, eq=False, slots=True)
class Nearest:
    """The nearest places of a polyline to some points.

    Parameters
    ----------
    distances : ndarray, shape (point,)
        How far [unit].
    segments : ndarray of int, shape (point,)
        On which segment the place is.
    places : ndarray, shape (point, axis)
        Where [unit].
    """

    distances: NDArray[np.float64]
    segments: NDArray[np.intp]
    places: NDArray[np.float64]


class Polyline:
    """Straight lines from vertex to vertex.

    Parameters
    ----------
    vertices : ndarray, shape (vertex, axis)
        At least two different ones; repeated ones are left out.

    Examples
    --------
    >>> corner = Polyline(np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0]]))
    >>> corner.nearest(np.array([[1.0, 0.5], [3.0, -1.0]])).distances.round(6).tolist()
    [0.5, 1.414214]
    """

    def __init__(self, vertices: NDArray[np.float64]) -> None:
        from scipy.spatial import cKDTree

        moves = np.append(True, (np.diff(vertices, axis=0) != 0.0).any(axis=1))
        self.vertices = vertices[moves]
        self._ways = np.diff(self.vertices, axis=0)
        self._squares = (self._ways**2).sum(axis=1)
        # Of one class are segments whose lengths differ by less than a factor of two: then few vertices are candidates.
        classes = np.floor(0.5 * np.log2(self._squares)).astype(int)
        self._tree, self._classes = cKDTree(self.vertices), []
        for each in np.unique(classes):
            members = np.flatnonzero(classes == each)
            ends = np.concatenate([self.vertices[members], self.vertices[members + 1]])
            self._classes.append((cKDTree(ends), members, float(np.sqrt(self._squares[members].max()))))

    def nearest(self, points: NDArray[np.float64]) -> Nearest:
        """The nearest places to points, shape (point, axis).

        A segment of length h whose distance is d has an end within sqrt(d^2 + h^2/4); so those with an end that near,
        for the smallest d known, are all that can hold the nearest place.
        """
        distances, segments = np.empty(len(points)), np.empty(len(points), dtype=np.intp)
        for first in range(0, len(points), BLOCK):
            block = points[first : first + BLOCK]
            vertex = self._tree.query(block)[1]
            segment = np.clip(vertex - 1, 0, len(self._ways) - 1)
            best = self._distance(block, segment)
            self._improve(block, np.arange(len(block)), np.clip(vertex, 0, len(self._ways) - 1), best, segment)
            for tree, members, longest in self._classes:
                reach = np.sqrt(best**2 + 0.25 * longest**2) * (1.0 + ROUNDING)
                counts = np.asarray(tree.query_ball_point(block, reach, return_length=True))
                parts = np.where(counts > 0, np.cumsum(counts) // MOST_CANDIDATES, -1)
                for part in np.unique(parts[parts >= 0]):
                    some = np.flatnonzero(parts == part)
                    inside = tree.query_ball_point(block[some], reach[some])
                    which = np.concatenate(list(inside)).astype(np.intp) % members.size
                    self._improve(block, np.repeat(some, counts[some]), members[which], best, segment)
            distances[first : first + BLOCK], segments[first : first + BLOCK] = best, segment
        return Nearest(distances, segments, self._place(points, segments))

    def bounds_between(self, points: NDArray[np.float64], near: Nearest) -> NDArray[np.float64]:
        """What the distance does not exceed on the straight line from each point to the next [unit], shape (point-1,).

        That line is no farther from the chord between the two nearest places than the larger distance, and the chord no
        farther from the polyline than the vertices between the places are from it. Where the nearest place jumps to
        another stretch, such as the next turn of a circle, the one place is looked for near the other. And a distance
        changes no faster than its point moves.
        """
        backwards = Nearest(near.distances[::-1], near.segments[::-1], near.places[::-1])
        either = np.minimum(self._onwards(points, near), self._onwards(points[::-1], backwards)[::-1])
        moved = np.linalg.norm(np.diff(points, axis=0), axis=1)
        return np.asarray(np.minimum(either, 0.5 * (near.distances[:-1] + near.distances[1:] + moved)))

    def _onwards(self, points: NDArray[np.float64], near: Nearest) -> NDArray[np.float64]:
        """The bounds from chords, where a jump is followed beside the place of the first of two points."""
        before, after = near.segments[:-1], near.segments[1:].copy()
        far, places = near.distances[1:].copy(), near.places[1:].copy()
        jumps = np.flatnonzero(np.abs(after - before) > MOST_BETWEEN)
        if jumps.size:
            beside = np.add.outer(np.arange(-BESIDE, BESIDE + 1), before[jumps])
            candidates = np.clip(beside, 0, len(self._ways) - 1)
            found = np.stack([self._distance(points[1:][jumps], row) for row in candidates])
            best = np.argmin(found, axis=0)
            after[jumps], far[jumps] = candidates[best, np.arange(jumps.size)], found.min(axis=0)
            places[jumps] = self._place(points[1:][jumps], after[jumps])
        low, between = np.minimum(before, after), np.abs(after - before)
        begin, way = near.places[:-1], places - near.places[:-1]
        square = np.maximum((way**2).sum(axis=1), np.finfo(float).tiny)
        sag = np.zeros(before.size)
        for step in range(1, int(between.max(initial=0)) + 1):
            here = np.flatnonzero(between >= step)
            away = self.vertices[low[here] + step] - begin[here]
            along = np.clip((away * way[here]).sum(axis=1) / square[here], 0.0, 1.0)
            sag[here] = np.maximum(sag[here], np.linalg.norm(away - along[:, None] * way[here], axis=1))
        return np.maximum(near.distances[:-1], far) + sag

    def _improve(
        self,
        points: NDArray[np.float64],
        which: NDArray[np.intp],
        candidates: NDArray[np.intp],
        best: NDArray[np.float64],
        segment: NDArray[np.intp],
    ) -> None:
        """Take over the candidate segments of points that are nearer than what is known."""
        found = self._distance(points[which], candidates)
        order = np.argsort(-found, kind="stable")  # the last of a point is its nearest
        nearest, where = np.full(len(points), np.inf), np.zeros(len(points), dtype=np.intp)
        nearest[which[order]], where[which[order]] = found[order], candidates[order]
        better = nearest < best
        best[better], segment[better] = nearest[better], where[better]

    def _place(self, points: NDArray[np.float64], segments: NDArray[np.intp]) -> NDArray[np.float64]:
        begin, way = self.vertices[segments], self._ways[segments]
        share = np.clip(((points - begin) * way).sum(axis=1) / self._squares[segments], 0.0, 1.0)
        return np.asarray(begin + share[:, None] * way)

    def _distance(self, points: NDArray[np.float64], segments: NDArray[np.intp]) -> NDArray[np.float64]:
        return np.asarray(np.linalg.norm(points - self._place(points, segments), axis=1))
