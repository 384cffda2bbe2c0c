"""The scene of lights through masks: its files, and what stands in them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from elemental.scene.light_masks import read_light_mask
from elemental.scene.load import load_scene
from make_light_masks import files

SCENES = Path(__file__).resolve().parents[2] / "content" / "scenes"


def test_the_committed_files_are_what_the_tool_makes(tmp_path: Path) -> None:
    for name, content in files().items():
        stored = SCENES / name
        made = tmp_path / stored.name
        made.write_bytes(content)
        if name.endswith(".png"):
            np.testing.assert_allclose(
                read_light_mask(made).pixels, read_light_mask(stored).pixels, atol=0.02
            )
        elif name.endswith(".glb"):
            ours, theirs = (load_scene(str(p), default_lights=False) for p in (made, stored))
            points = [np.concatenate([m.positions for m in s.meshes]) for s in (ours, theirs)]
            np.testing.assert_allclose(*points, atol=1e-5)
        else:
            assert stored.read_bytes() == content


def test_the_leaves_repeat_without_a_seam() -> None:
    """Neighbours across the rim differ no more than inside."""
    pixels = read_light_mask(SCENES / "chapel" / "leaves.png").pixels[..., 0]
    for axis in (0, 1):
        inside = np.abs(np.diff(pixels, axis=axis)).mean()
        rim = np.abs(np.take(pixels, 0, axis) - np.take(pixels, -1, axis)).mean()
        assert rim < 2.0 * inside
    assert pixels.mean() == pytest.approx(0.5, abs=0.2)


def test_the_lights_of_the_scene_have_their_masks() -> None:
    window, sun = load_scene("light_masks", default_lights=False).lights
    assert window.mask is not None
    assert sun.mask is not None
    assert (window.mask.name, sun.mask.name) == ("rose.png", "leaves.png")
    assert (sun.mask_size, sun.mask_scroll) == (2.6, (0.012, 0.006))
