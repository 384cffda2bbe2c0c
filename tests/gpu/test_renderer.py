"""The renderer as its doors use it: opened, resized, rebuilt and released."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from cli.small_scene import write_corner
from elemental.core.images import check_png
from elemental.frame import VIEWS, Renderer
from elemental.gpu.device import Device
from elemental.picture import save_picture
from elemental.session import Viewpoint, set_stage

SIZE = (40, 30)
WORDS = ("gi.resolution=64", "shadow.resolution=256")


def test_a_released_renderer_leaves_nothing_but_pooled_targets(
    device: Device, tmp_path: Path
) -> None:
    stage = set_stage(str(write_corner(tmp_path)), WORDS, Viewpoint(), SIZE)
    left = []
    for _ in range(3):
        renderer = Renderer(device, stage.scene, stage.settings, SIZE)
        renderer.render(stage.camera, 0.0, 0)
        device.finish()
        renderer.release()
        left.append({name: n for name, n in device.bytes().items() if name != "targets"})
    assert left[0] == left[1] == left[2]


def test_every_view_has_the_size_that_was_asked_for_and_can_be_written(
    device: Device, tmp_path: Path
) -> None:
    stage = set_stage(str(write_corner(tmp_path)), WORDS, Viewpoint(), SIZE)
    renderer = Renderer(device, stage.scene, stage.settings, SIZE)
    for size in ((40, 30), (1, 1), (7, 100)):
        renderer.resize(size)
        for view in VIEWS:
            frame = renderer.render(stage.camera, 0.0, 0, view)
            pixels = renderer.read(frame)
            assert pixels.shape == (size[1], size[0], 4), view
            assert pixels.dtype == (np.float32 if frame.is_linear else np.uint8), view
            assert np.isfinite(pixels).all(), view
            save_picture(tmp_path / "view.png", pixels, frame.is_linear)
            assert check_png(tmp_path / "view.png") == size, view
    renderer.release()


def test_a_rebuilt_octree_gives_the_same_picture(device: Device, tmp_path: Path) -> None:
    stage = set_stage(str(write_corner(tmp_path)), WORDS, Viewpoint(), SIZE)
    renderer = Renderer(device, stage.scene, stage.settings, SIZE)

    def picture() -> bytes:
        return renderer.read(renderer.render(stage.camera, 0.0, 0, "scene_color")).tobytes()

    first = picture()
    for what in ("light", "geometry"):
        renderer.invalidate(what)
        assert picture() == first, what
    renderer.release()
