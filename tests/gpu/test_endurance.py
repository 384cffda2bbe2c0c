# PP-02, PP-11
"""Changing settings, sizes and volumes leave nothing behind; tools/endure.py has the long run."""

from __future__ import annotations

import gc
from collections import Counter
from pathlib import Path

from cli.small_scene import write_corner
from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.gpu.recall import GENERATION
from elemental.session import Stage, Viewpoint, set_stage
from endurance.storm import LARGEST, Storm, resident_bytes

STORM_FRAMES = 60
ALLOWED_BYTES = 5_000_000
"""Growth over a storm that is drawn a second time."""
WORDS = ("gi.resolution=64", "shadow.resolution=256")


def corner(folder: Path) -> Stage:
    return set_stage(str(write_corner(folder)), WORDS, Viewpoint(), LARGEST)


def test_a_storm_of_changes_leaves_memory_flat_and_the_driver_content(
    device: Device, tmp_path: Path
) -> None:
    stage = corner(tmp_path)
    said = len(device.messages)
    resident, held = [], []
    for _ in range(3):  # the first compiles what the storm needs, the second settles
        storm = Storm(device, stage, seed=4)
        assert len(list(storm.frames(STORM_FRAMES))) == STORM_FRAMES
        storm.release()
        device.begin_frame()
        device.executor.pool.clear()
        resident.append(resident_bytes())
        held.append(device.bytes())
    assert resident[-1] - resident[-2] < ALLOWED_BYTES
    assert held[0] == held[1] == held[2]
    assert device.executor.pool.stats.bytes == 0
    assert len(device.messages) == said


def objects() -> Counter[str]:
    gc.collect()
    return Counter(type(item).__name__ for item in gc.get_objects())


def test_a_window_that_is_resized_on_and_on_fills_no_cache(device: Device, tmp_path: Path) -> None:
    stage = corner(tmp_path)
    renderer = Renderer(device, stage.scene, stage.settings, LARGEST)
    seen = []
    for turn in range(3):
        for step in range(3 * GENERATION):
            renderer.resize((1 + step, 17 + 30 * turn))  # no size twice
            renderer.render(stage.camera, 0.0, step)
            device.finish()
        seen.append(objects())
    renderer.release()
    grown = seen[2] - seen[1]
    assert sum(grown.values()) < 300, grown.most_common(5)
    assert seen[2]["TextureDesc"] < 1000
    for kind in ("SamplerLook", "ImageLook", "TextureKind"):
        assert grown[kind] == 0, kind  # not of sizes
