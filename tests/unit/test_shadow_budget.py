"""Who gets shadow maps, of what size and where. SH-09"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.passes.light_pack import light_bounds
from elemental.passes.shadow_budget import HALVINGS, LEAST_SIDE, ShadowBudget, Shares
from elemental.passes.shadow_fit import (
    ViewFrustum,
    cascade_views,
    open_reach,
    point_views,
    spot_view,
)
from elemental.passes.shadow_tiles import Tile, TilePool
from elemental.scene.model import Light

Array = npt.NDArray[Any]
FORWARD = np.array([0.0, 0.0, -1.0], np.float32)


def lamp(x: float, z: float, reach: float = 2.0, **fields: Any) -> Light:
    white, down = np.ones(3, np.float32), np.array([0.0, -1.0, 0.0], np.float32)
    position = np.array([x, 0.0, z], np.float32)
    return replace(Light("lamp", "point", white, 1.0, position, down, range=reach), **fields)


def sun(lux: float) -> Light:
    return lamp(0.0, 0.0, kind="directional", intensity=lux)


def frustum(eye_z: float = 0.0) -> ViewFrustum:
    eye = np.array([0.0, 0.0, eye_z], np.float32)
    return ViewFrustum(eye, FORWARD, 0.1, 100.0, tangent=0.5, corner_tangent=1.0)


def share(budget: ShadowBudget, lights: list[Light], eye_z: float = 0.0) -> Shares:
    bounds = light_bounds(lights, [light.range for light in lights])
    return budget.share(lights, bounds, frustum(eye_z))


def row(count: int) -> list[Light]:
    """Lamps farther and farther down the view."""
    return [lamp(0.0, -1.0 - 2.0 * n) for n in range(count)]


def area(lights: list[Light], sides: list[int], full: int) -> float:
    faces = {"directional": 4, "point": 6, "spot": 1}
    return sum(faces[light.kind] * (s / full) ** 2 for light, s in zip(lights, sides, strict=True))


def test_all_maps_are_whole_where_there_is_room() -> None:
    lights = [sun(3.0), lamp(0, -1), lamp(0, -40), lamp(30, 30, kind="spot")]
    shares = share(ShadowBudget(32, 1024, cascades=3), lights)
    assert shares == Shares([1024] * 4, 0, 4 + 6 + 6 + 1)


def test_who_does_not_cast_gets_nothing() -> None:
    lights = [replace(light, casts_shadow=False) for light in (sun(3.0), lamp(0, -1))]
    assert share(ShadowBudget(32, 1024, 3), [*lights, lamp(0, -3)]) == Shares([0, 0, 1024], 0, 6)


@pytest.mark.parametrize("maps", [0, 4, 5, 8, 16, 100])
def test_maps_keep_to_the_budget_and_follow_the_picture(maps: int) -> None:
    lights = [sun(3.0), *row(40)]
    shares = share(ShadowBudget(maps, 1024, cascades=3), lights)
    assert area(lights, shares.sides, 1024) <= maps
    assert shares.layers <= maps
    local = shares.sides[1:]
    assert local == sorted(local, reverse=True)
    assert all(side == 0 or side >= 1024 >> HALVINGS for side in local)
    assert shares.unshadowed == shares.sides.count(0)
    if maps == 4:
        assert shares.sides == [1024] + 40 * [0]
    if maps in (8, 16):
        assert area(lights, shares.sides, 1024) > 0.5 * maps
    if maps == 5:
        assert 0 < shares.unshadowed < 40
    if maps == 100:
        assert len(set(local)) > 1


def test_the_brightest_sun_comes_first() -> None:
    assert share(ShadowBudget(7, 512, 3), [sun(1.0), sun(9.0), sun(5.0)]).sides == [0, 512, 0]


def test_no_map_is_smaller_than_its_rim_allows() -> None:
    shares = share(ShadowBudget(8, 256, cascades=3), row(40))
    assert min(side for side in shares.sides if side) >= LEAST_SIDE


def test_a_light_behind_the_camera_counts_less() -> None:
    """The two are as far away; only one can be seen."""
    shares = share(ShadowBudget(6, 1024, 3), [lamp(0, 5), lamp(0, -5)])
    assert shares.sides == [128, 512]


def test_a_trembling_camera_changes_no_size() -> None:
    lights, budget = row(40), ShadowBudget(12, 1024, 3)
    places = 1.0 + np.random.default_rng(1).uniform(-0.3, 0.3, 50)  # lamps at 4, 8 and 16 m
    first = share(budget, lights, 1.0)
    for z in places:
        assert share(budget, lights, z).sides == first.sides
    assert share(budget, lights, -20.0).sides != first.sides
    forgetful = [share(ShadowBudget(12, 1024, 3), lights, z).sides for z in places]
    assert any(sides != first.sides for sides in forgetful)


def overlaps(a: Tile, b: Tile) -> bool:
    apart = max(abs(2 * a.x + a.side - 2 * b.x - b.side), abs(2 * a.y + a.side - 2 * b.y - b.side))
    return a.layer == b.layer and apart < a.side + b.side


def test_shares_that_hold_are_those_that_would_be_found_anew() -> None:
    lights, path = row(20), np.linspace(0.0, -30.0, 60)
    keeping, finding = ShadowBudget(16, 1024, 3), ShadowBudget(16, 1024, 3)
    held = [share(keeping, lights, eye_z) for eye_z in path]
    found = [share(finding, [replace(light) for light in lights], eye_z) for eye_z in path]
    assert held == found
    assert 5 < len({id(shares) for shares in held}) < len(path) - 5


def test_tiles_never_overlap_and_stay_where_they_are() -> None:
    rng = np.random.default_rng(2)
    pool, held, moved = TilePool(6, 64), dict[Any, Tile](), 0
    for _ in range(300):
        wanted = {}
        left = 6 * 64 * 64
        for key in rng.permutation(60):
            tile = held.get(key)
            side = tile.side if tile and rng.random() < 0.8 else int(64 >> rng.integers(0, 4))
            if side * side <= left:
                wanted[int(key)] = side
                left -= side * side
        now = dict(pool.assign(wanted))
        assert {key: tile.side for key, tile in now.items()} == wanted
        for key, tile in now.items():
            assert 0 <= tile.layer < 6
            assert 0 <= min(tile.x, tile.y) <= max(tile.x, tile.y) <= 64 - tile.side
            assert tile.x % tile.side == tile.y % tile.side == 0
            assert not any(overlaps(tile, other) for k, other in now.items() if k != key)
        kept = [key for key in now if key in held and held[key].side == now[key].side]
        moved += any(held[key] != now[key] for key in kept)
        held = now
    assert moved < 150  # placed anew only where free tiles are too scattered


def test_tiles_that_do_not_fit_are_refused() -> None:
    with pytest.raises(ValueError, match="larger than the pool"):
        TilePool(1, 64).assign({"a": 64, "b": 8})
    assert TilePool(0, 64).assign({}) == {}
    assert len(TilePool(1, 64).assign(dict.fromkeys(range(64), 8))) == 64


def test_cascades_of_a_large_scene_are_fine_where_the_view_is_close() -> None:
    """A ball seen from 7 m away in a scene of 10 km has a shadow; the scene seen whole, too."""
    bounds = (np.array([-5e3, 0.0, -5e3], np.float32), np.array([5e3, 2.0, 5e3], np.float32))
    diagonal = float(np.linalg.norm(bounds[1] - bounds[0]))
    assert open_reach(bounds, 1e-3 * diagonal) == diagonal
    eye = np.array([4.0, 2.0, 6.0], np.float32)
    close = ViewFrustum(eye, FORWARD, 0.07, diagonal, tangent=0.36, corner_tangent=0.7)
    reach = open_reach(bounds, close.near)
    views = cascade_views(sun(3.0), bounds, close, count=3, reach=reach, resolution=1024)
    assert views[0].texel < 0.05


def test_lights_far_from_the_origin_have_views() -> None:
    """A step of a metre from there is none in 32 bits."""
    far = lamp(1e12, 0.0)
    bounds = (np.full(3, -1.0, np.float32), np.ones(3, np.float32))
    assert len(point_views(far, bounds, 64)) == 6
    assert np.isfinite(spot_view(replace(far, kind="spot"), bounds, 64).clip_from_world).all()
